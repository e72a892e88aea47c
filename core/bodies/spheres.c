#include "spheres.h"

#include "array.h"
#include "dem_rules.h"

/* From how many spheres on prefetching pays, prefetching of arrays read in order, and waves. All that a step needs of 2,300 spheres
 * is in the second-level cache; of 24,000 it is in the third; of 100,000 it is in none. */
enum { MANY = 10000, VERY_MANY = 50000, FOR_WAVES = 200000 };

size_t spheres_count(const spheres *s) { return s->mobile_count + s->lining_count; }

static size_t particles_before(const dem_scene_definition *definition, size_t species)
{
    double share = 0.0;
    for (size_t k = 0; k < species; k++) share += definition->species[k].share;
    return species == definition->species_count ? definition->particle_count
                                                : (size_t)floor(share * (double)definition->particle_count + 0.5);
}

size_t species_particles(const dem_scene_definition *definition, size_t species)
{
    return particles_before(definition, species + 1) - particles_before(definition, species);
}

#define ARRAY(member) .offset = offsetof(spheres, member), .size = sizeof *((spheres *)NULL)->member
const sphere_array sphere_arrays[] = {
    { ARRAY(row), OF_ROWS, .is_sorted = true },
    { ARRAY(rest), OF_ROWS, .is_sorted = true },
    { ARRAY(place), OF_PLACES, .is_sorted = true, .saved = "position", .columns = 3 },
    { ARRAY(fallen_time), OF_MOBILE, .is_sorted = true, .saved = "fallen_time", .columns = 1, .is_float = true },
    { ARRAY(id), OF_MOBILE, .is_sorted = true },
    { ARRAY(species), OF_MOBILE, .is_sorted = true },
    { ARRAY(kind), OF_MOBILE, .is_sorted = true },
    { ARRAY(full_radius), OF_MOBILE_AND_LINING, .is_sorted = true },
    { ARRAY(load), OF_LOADS },
    { ARRAY(velocity), OF_MOBILE, .is_sorted = true, .saved = "velocity", .columns = 3 },
    { ARRAY(angular_velocity), OF_MOBILE, .is_sorted = true, .saved = "angular_velocity", .columns = 3 },
    { ARRAY(inverse_mass), OF_KINDS },
    { ARRAY(inverse_inertia), OF_KINDS },
    { ARRAY(surface_track), OF_MOBILE, .is_sorted = true, .saved = "surface_track", .columns = 2, .is_float = true,
      .is_optional = true },
    { ARRAY(lining_place), OF_LINING },
};
_Static_assert(sizeof(surface_track) == 2 * sizeof(float), "saved as so many floats");

/* Through memcpy: pointers of several types. */
void *sphere_array_of(const spheres *s, const sphere_array *array)
{
    void *memory;
    memcpy(&memory, (const char *)s + array->offset, sizeof memory);
    return memory;
}

static void set_array(spheres *s, const sphere_array *array, void *memory)
{
    memcpy((char *)s + array->offset, &memory, sizeof memory);
}

static size_t length_of(const spheres *s, sphere_array_length length)
{
    const size_t all = spheres_count(s);
    const size_t kinds = s->species_count + (s->have_sizes ? s->single_count : 0);
    const size_t lengths[] = {
        [OF_MOBILE] = s->mobile_count, [OF_MOBILE_AND_LINING] = all, [OF_PLACES] = all + 2,      [OF_ROWS] = s->row_count,
        [OF_LINING] = s->lining_count, [OF_KINDS] = kinds,           [OF_LOADS] = s->load_count,
    };
    return lengths[length];
}

void spheres_forget_surface(spheres *s)
{
    for (size_t i = 0; i < s->mobile_count; i++) s->surface_track[i] = (surface_track){ 0, NAN };
}

dem_status spheres_init(spheres *s, const dem_scene_definition *definition, size_t lining_count)
{
    size_t singles = 0, bodies = 0, joined = 0;
    for (size_t k = 0; k < definition->species_count; k++) {
        const size_t count = species_particles(definition, k), of_each = definition->species[k].cluster.sphere_count;
        *(of_each ? &bodies : &singles) += count;
        joined += count * of_each;
    }
    const size_t n = singles + joined, all = n + lining_count;
    memset(s, 0, sizeof *s);
    s->mobile_count = n;
    s->single_count = singles;
    s->lining_count = lining_count;
    s->species_count = definition->species_count;
    s->have_sizes = dem_have_sizes(definition->species, definition->species_count);
    s->of_one_kind = definition->species_count == 1 && !s->have_sizes;
    s->are_many = n >= MANY;
    s->exceed_caches = n >= VERY_MANY;
    s->in_waves = n >= FOR_WAVES;
    s->row_count = s->first_copy = all + 2;
    const dem_status status = clusters_init(&s->clusters, definition, bodies, joined);
    s->load_count = n + n % 2 + PADDING_LOADS; /* two to a line */
    bool enough = status == DEM_OK;
    for (int k = 0; k < SPHERE_ARRAYS; k++) {
        void *memory = array_create(length_of(s, sphere_arrays[k].length), sphere_arrays[k].size);
        set_array(s, &sphere_arrays[k], memory);
        enough = enough && memory;
    }
    if (!enough) {
        spheres_clear(s);
        return DEM_NO_MEMORY;
    }
    for (size_t i = 0; i < n; i++) {
        s->fallen_time[i] = -1e30f;
        s->id[i] = (int32_t)i;
    }
    spheres_forget_surface(s);
    for (size_t b = 0; b < bodies; b++) s->clusters.body[b].id = (int32_t)(singles + b);
    return DEM_OK;
}

void spheres_clear(spheres *s)
{
    clusters_clear(&s->clusters);
    for (int k = 0; k < SPHERE_ARRAYS; k++) free(sphere_array_of(s, &sphere_arrays[k]));
    memset(s, 0, sizeof *s);
}

void spheres_set_period(spheres *s, const dem_scene_definition *definition, double period)
{
    /* Half a ring is at least one and a half of the largest diameters: a period has three. Listed pairs are within 1.8, and
     * those that can touch before the next pick within 1.4, by the skin of 0.4: the others may be seen on the wrong side. */
    const double least = 4 * dem_largest_sphere(definition), along = period > 0 ? period / fmax(1, floor(period / least)) : least;
    s->ring_units = RING_UNITS / along;
    spheres_pad(s);
}

void spheres_pad(spheres *s)
{
    const vector4 nothing = { 0 }, half_way_round = { 0.49 * RING_UNITS };
    const int32_t zeros = sphere_of_zeros(s), far = sphere_far_away(s);
    sphere_row_store(&s->row[zeros], &s->rest[zeros], nothing, nothing, nothing);
    sphere_row_store(&s->row[far], &s->rest[far], half_way_round, nothing, nothing);
}

dem_status spheres_reserve_copies(spheres *s, size_t count)
{
    if (s->first_copy + count <= s->row_count) return DEM_OK;
    const size_t rows = s->first_copy + count + count / 4;
    sphere_row *row = array_create(rows, sizeof *row);
    sphere_rest *rest = array_create(rows, sizeof *rest);
    if (!row || !rest) {
        free(row);
        free(rest);
        return DEM_NO_MEMORY;
    }
    memcpy(row, s->row, s->first_copy * sizeof *row);
    memcpy(rest, s->rest, s->first_copy * sizeof *rest);
    free(s->row);
    free(s->rest);
    s->row = row;
    s->rest = rest;
    s->row_count = rows;
    return DEM_OK;
}

void spheres_set_scale(spheres *s, double scale)
{
    s->scale = scale;
    s->copies_hold = false;
    for (size_t i = 0; i < s->mobile_count; i++) s->rest[i].radius = (real)(scale * (double)s->full_radius[i]);
}

double spheres_kinetic_energy(const spheres *s)
{
    double energy = clusters_kinetic_energy(&s->clusters);
    for (size_t i = 0; i < s->single_count; i++) {
        const vector4 v = s->velocity[i], w = s->angular_velocity[i];
        energy += 0.5 * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) / s->inverse_mass[s->kind[i]]
                  + 0.5 * (w[0] * w[0] + w[1] * w[1] + w[2] * w[2]) / s->inverse_inertia[s->kind[i]];
    }
    return energy;
}
