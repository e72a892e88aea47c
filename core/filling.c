#include "filling.h"

#include "dem_rules.h"
#include "random.h"

/* Solid fraction of the region that spheres grow into, and the one at which random placing one after the other
 * is still quick (it jams at 0.38). */
static const double REGION_FRACTION = 0.5, PLACING_FRACTION = 0.28;

static void assign_species(spheres *s, const dem_drum_definition *definition)
{
    /* Cumulative rounding: every species within one particle of its share, the total exact. */
    double share = 0.0;
    size_t i = 0;
    for (size_t k = 0; k < definition->species_count; k++) {
        const dem_species *species = &definition->species[k];
        share += species->share;
        const size_t end = k + 1 == definition->species_count ? s->mobile_count
                                                              : (size_t)floor(share * (double)s->mobile_count + 0.5);
        for (; i < end; i++) {
            const double mass = dem_sphere_mass(species->diameter, species->density), r = (double)(real)(0.5 * species->diameter);
            s->species[i] = (int32_t)k;
            s->full_radius[i] = r;
            s->inverse_mass[i] = 1.0 / mass;
            s->inverse_inertia[i] = 1.0 / (0.4 * mass * r * r);
        }
    }
    s->smallest_diameter = INFINITY;
    for (i = 0; i < s->mobile_count; i++) {
        s->smallest_diameter = fmin(s->smallest_diameter, 2 * s->full_radius[i]);
        s->largest_diameter = fmax(s->largest_diameter, 2 * s->full_radius[i]);
    }
}

/* Spheres placed so far, in linked cells. */
typedef struct placing {
    int cells[3];
    double size[3], radius, length;
    int32_t *head, *next;
} placing;

static int cell_index(const placing *p, const double x[3], int axis)
{
    const double origin = axis == 2 ? 0.5 * p->length : p->radius;
    const int c = (int)((x[axis] + origin) / p->size[axis]);
    return c < 0 ? 0 : c >= p->cells[axis] ? p->cells[axis] - 1 : c;
}

static size_t cell_of(const placing *p, int x, int y, int z)
{
    return ((size_t)x * (size_t)p->cells[1] + (size_t)y) * (size_t)p->cells[2] + (size_t)z;
}

static bool is_free(const placing *p, const spheres *s, const double x[3], double radius, double scale)
{
    const int cx = cell_index(p, x, 0), cy = cell_index(p, x, 1), cz = cell_index(p, x, 2);
    for (int dx = cx > 0 ? -1 : 0; dx <= 1 && cx + dx < p->cells[0]; dx++)
        for (int dy = cy > 0 ? -1 : 0; dy <= 1 && cy + dy < p->cells[1]; dy++)
            for (int dz = -1; dz <= 1; dz++) {
                const size_t cell = cell_of(p, cx + dx, cy + dy, (cz + dz + p->cells[2]) % p->cells[2]);
                for (int32_t j = p->head[cell]; j >= 0; j = p->next[j]) {
                    const double *o = s->row[j].x;
                    const double ex = o[0] - x[0], ey = o[1] - x[1], ez = wrap_axial(o[2] - x[2], p->length, 1 / p->length);
                    const double reach = radius + scale * s->full_radius[j];
                    if (ex * ex + ey * ey + ez * ez < reach * reach) return false;
                }
            }
    return true;
}

static void insert(placing *p, const double x[3], int32_t i)
{
    const size_t cell = cell_of(p, cell_index(p, x, 0), cell_index(p, x, 1), cell_index(p, x, 2));
    p->next[i] = p->head[cell];
    p->head[cell] = i;
}

/* One sphere at a random place of the region below `level`; false when many tries found none free. */
static bool place_one(placing *p, spheres *s, size_t i, double room, double level, double scale, random_stream *random)
{
    const double radius = scale * s->full_radius[i], outer = room - s->full_radius[i];
    for (int attempt = 0; attempt < 20000; attempt++) {
        const double x[3] = { (2 * random_uniform(random) - 1) * outer,
                              -outer + random_uniform(random) * (outer + fmin(level * room, outer)),
                              (random_uniform(random) - 0.5) * p->length };
        if (x[0] * x[0] + x[1] * x[1] > outer * outer || !is_free(p, s, x, radius, scale)) continue;
        memcpy(s->row[i].x, x, sizeof x);
        insert(p, x, (int32_t)i);
        return true;
    }
    return false;
}

static dem_status placing_init(placing *p, const spheres *s, const container *drum)
{
    *p = (placing){ .radius = drum->radius, .length = drum->length };
    const double side[3] = { 2 * drum->radius, 2 * drum->radius, drum->length };
    size_t cells = 1;
    for (int a = 0; a < 3; a++) {
        p->cells[a] = (int)fmax(1.0, fmin(512.0, floor(side[a] / s->largest_diameter)));
        p->size[a] = side[a] / p->cells[a];
        cells *= (size_t)p->cells[a];
    }
    p->head = array_create(cells, sizeof *p->head);
    p->next = array_create(s->mobile_count, sizeof *p->next);
    if (!p->head || !p->next) return DEM_NO_MEMORY;
    for (size_t c = 0; c < cells; c++) p->head[c] = -1;
    return DEM_OK;
}

/* The large first, since they find room the hardest. Species are contiguous in id. */
static bool place_all(placing *p, spheres *s, const dem_drum_definition *definition, double room, double level,
                      double scale, random_stream *random)
{
    bool placed[DEM_MAXIMUM_SPECIES] = { false };
    for (size_t round = 0; round < definition->species_count; round++) {
        size_t largest = DEM_MAXIMUM_SPECIES;
        for (size_t k = 0; k < definition->species_count; k++)
            if (!placed[k] && (largest == DEM_MAXIMUM_SPECIES
                               || definition->species[k].diameter > definition->species[largest].diameter)) largest = k;
        placed[largest] = true;
        for (size_t i = 0; i < s->mobile_count; i++)
            if (s->species[i] == (int32_t)largest && !place_one(p, s, i, room, level, scale, random)) return false;
    }
    return true;
}

static double total_volume(const spheres *s)
{
    double volume = 0.0;
    for (size_t i = 0; i < s->mobile_count; i++) volume += dem_sphere_mass(2 * s->full_radius[i], 1.0);
    return volume;
}

/* Times and drags of growing and settling, from the time a particle takes to fall through the drum. */
static void set_schedule(filling *f, const spheres *s, const dem_drum_definition *definition)
{
    const double fall = sqrt(definition->diameter / definition->gravity);
    const double speed = 0.1 * definition->diameter / fall;
    const double growing = 4 * (1.001 - f->start_scale) * s->largest_diameter / speed;
    f->growing_steps = (int64_t)ceil(growing / definition->time_step);
    f->growing_drag = 10 / growing;
    f->settling_drag = 4 / fall;
    f->settling_steps_least = (int64_t)ceil(0.5 * fall / definition->time_step);
    f->settling_steps_most = (int64_t)ceil(40 * fall / definition->time_step);
    double mass = 0.0;
    for (size_t i = 0; i < s->mobile_count; i++) mass += 1 / s->inverse_mass[i];
    f->rest_energy = 1e-4 * mass * definition->gravity * s->smallest_diameter;
}

dem_status filling_place(filling *f, spheres *s, const container *drum, const dem_drum_definition *definition)
{
    assign_species(s, definition);
    const double room = drum->inner_radius;
    const double fraction = total_volume(s) / (DEM_PI * room * room * drum->length);
    if (room < 1.5 * s->largest_diameter || fraction > 0.62) return DEM_DOES_NOT_FIT;
    const double share = fmin(1.0, fraction / REGION_FRACTION), region_fraction = fmax(REGION_FRACTION, fraction);
    /* at least as high as one sphere needs */
    const double level = share < 1 ? fmax(circle_level(share), fmin(1.0, 1.5 * s->largest_diameter / room - 1)) : 1.0;

    random_stream random;
    random_seed(&random, definition->seed);
    placing p;
    dem_status status = placing_init(&p, s, drum);
    /* A region few diameters across holds fewer: try again with smaller spheres that grow further. */
    double target = PLACING_FRACTION;
    for (bool done = false; status == DEM_OK && !done; target *= 0.7) {
        f->start_scale = fmin(1.0, cbrt(target / region_fraction));
        done = place_all(&p, s, definition, room, level, f->start_scale, &random);
        if (!done && target < 0.05) status = DEM_DOES_NOT_FIT;
        if (!done) {
            const size_t cells = (size_t)p.cells[0] * (size_t)p.cells[1] * (size_t)p.cells[2];
            for (size_t c = 0; c < cells; c++) p.head[c] = -1;
        }
    }
    free(p.head);
    free(p.next);
    if (status != DEM_OK) return status;
    spheres_set_scale(s, f->start_scale);
    set_schedule(f, s, definition);
    return DEM_OK;
}

double filling_scale(const filling *f, int64_t steps)
{
    const double share = (double)steps / (double)f->growing_steps;
    return share < 1 ? f->start_scale + (1 - f->start_scale) * share : 1.0;
}
