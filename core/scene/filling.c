#include "filling.h"

#include "array.h"
#include "dem_rules.h"
#include "sizing.h"

/* Solid fraction of the region that spheres grow into, and the one at which random placing one after the other
 * is still quick (it jams at 0.38). */
static const double REGION_FRACTION = 0.5, PLACING_FRACTION = 0.28;

/* Spheres by themselves, from id `first` on. */
static void assign_spheres(spheres *s, const dem_species *species, size_t k, size_t first, size_t count)
{
    const double mass = dem_sphere_mass(species->diameter, species->density);
    const real radius = (real)(0.5 * species->diameter);
    const double r = (double)radius;
    s->inverse_mass[k] = 1.0 / mass;
    s->inverse_inertia[k] = 1.0 / (0.4 * mass * r * r);
    for (size_t i = first; i < first + count; i++) {
        s->species[i] = s->kind[i] = (int32_t)k;
        s->full_radius[i] = radius;
    }
}

/* Clusters from `body` on, their spheres from `sphere` on. */
static void assign_clusters(spheres *s, const dem_species *species, size_t k, size_t body, size_t sphere, size_t count)
{
    const dem_cluster *cluster = &species->cluster;
    s->inverse_mass[k] = 1.0 / s->clusters.shape[k].mass;
    for (size_t b = body; b < body + count; b++) {
        s->clusters.body[b].species = (int32_t)k;
        s->clusters.body[b].first_sphere = (int32_t)sphere;
        for (size_t m = 0; m < cluster->sphere_count; m++, sphere++) {
            s->species[sphere] = s->kind[sphere] = (int32_t)k;
            s->full_radius[sphere] = (real)(0.5 * cluster->sphere[m].diameter);
            s->clusters.of_sphere[sphere - s->single_count] = (int32_t)b;
        }
    }
}

/* What else follows once each has its species. */
static dem_status assign_sizes(spheres *s, const dem_scene_definition *definition)
{
    const dem_status status = sizing_draw(s, definition);
    return status == DEM_OK ? sizing_complete(s, definition) : status;
}

static dem_status assign_species(spheres *s, const dem_scene_definition *definition)
{
    size_t single = 0, body = 0, joined = s->single_count;
    for (size_t k = 0; k < definition->species_count; k++) {
        const dem_species *species = &definition->species[k];
        const size_t count = species_particles(definition, k);
        if (species->cluster.sphere_count == 0) {
            assign_spheres(s, species, k, single, count);
            single += count;
        } else {
            assign_clusters(s, species, k, body, joined, count);
            body += count;
            joined += count * species->cluster.sphere_count;
        }
    }
    return assign_sizes(s, definition);
}

dem_status filling_assign_in_order(spheres *s, const dem_scene_definition *definition, const int32_t *order)
{
    size_t single = 0, body = 0, joined = s->single_count;
    for (size_t p = 0; p < definition->particle_count; p++) {
        const size_t k = (size_t)order[p];
        const dem_species *species = &definition->species[k];
        if (species->cluster.sphere_count == 0) {
            assign_spheres(s, species, k, single++, 1);
        } else {
            assign_clusters(s, species, k, body++, joined, 1);
            joined += species->cluster.sphere_count;
        }
    }
    return assign_sizes(s, definition);
}

/* Particles placed so far, each as the sphere that holds it, in linked cells. */
typedef struct placing {
    int cells[3];
    double low[3], size[3], period, inverse_period; /* m, 1/m */
    int32_t *head, *next;
    int32_t *order; /* of particles, the largest first; NULL: by species, which are each of one size */
} placing;

static int cell_index(const placing *p, const double x[3], int axis)
{
    const int c = (int)((x[axis] - p->low[axis]) / p->size[axis]);
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
                    const double *o = particle_place(s, (size_t)j);
                    const double ex = o[0] - x[0], ey = o[1] - x[1], ez = wrap_axial(o[2] - x[2], p->period, p->inverse_period);
                    const double reach = radius + scale * particle_reach(s, (size_t)j);
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

/* One for places, one for orientations: a particle's place does not depend on whether others have an orientation. */
typedef struct random_streams {
    random_stream place, turn;
} random_streams;

/* Evenly over all orientations (Shoemake 1992). */
quaternion filling_random_orientation(random_stream *random)
{
    const double u = random_uniform(random), a = 2 * DEM_PI * random_uniform(random), b = 2 * DEM_PI * random_uniform(random);
    return (quaternion){ sqrt(1 - u) * sin(a), sqrt(1 - u) * cos(a), sqrt(u) * sin(b), sqrt(u) * cos(b) };
}

/* Where centres may be: the lower part of a lying drum, or of an upright container. */
typedef struct region {
    const container *container;
    double room;   /* m, free radius about the axis */
    double level;  /* lying: height of the region's surface, as a share of the room; 1: all of it */
    double height; /* m, upright: of the region */
} region;

/* A place in the box about the region, for the centre of a particle of that reach; level or height allowing. */
static void random_place(const region *r, double reach, random_stream *random, double x[3])
{
    const double outer = r->room - reach, length = r->container->length;
    const bool is_closed = r->container->period == 0;
    x[0] = (2 * random_uniform(random) - 1) * outer;
    if (r->container->kind == DEM_DRUM) {
        x[1] = -outer + random_uniform(random) * (outer + fmin(r->level * r->room, outer));
        x[2] = (random_uniform(random) - 0.5) * (is_closed ? length - 2 * reach : length);
    } else {
        x[1] = (2 * random_uniform(random) - 1) * (r->container->half_depth > 0 ? r->container->half_depth - reach : outer);
        x[2] = reach + random_uniform(random) * fmax(r->height - 2 * reach, 0);
    }
}

/* With room for the particle at full size; the first wall is the one about the axis, or a side of a flat vessel. */
static bool is_inside(const region *r, const double x[3], double reach)
{
    const double outer = r->room - reach;
    if (r->container->half_depth == 0 && x[0] * x[0] + x[1] * x[1] > outer * outer) return false;
    for (int k = r->container->half_depth > 0 ? 0 : 1; k < r->container->wall_count; k++) {
        const container_wall *w = &r->container->wall[k];
        if (wall_seen_from(w, x).distance < reach || (w->kind == WALL_FUNNEL && wall_is_beneath_funnel(w, x))) return false;
    }
    return true;
}

/* One particle at a random place of the region; false when many tries found none free. */
static bool place_one(placing *p, spheres *s, size_t i, const region *r, double scale, random_streams *random)
{
    const double radius = scale * particle_reach(s, i);
    for (int attempt = 0; attempt < 20000; attempt++) {
        double x[3];
        random_place(r, particle_reach(s, i), &random->place, x);
        if (!is_inside(r, x, particle_reach(s, i)) || !is_free(p, s, x, radius, scale)) continue;
        if (i < s->single_count) {
            sphere_set_place(s, i, x);
        } else {
            cluster_body *body = &s->clusters.body[i - s->single_count];
            memcpy(body->x, x, sizeof x);
            body->orientation = filling_random_orientation(&random->turn);
        }
        insert(p, x, (int32_t)i);
        return true;
    }
    return false;
}

static void clusters_place_spheres(spheres *s, const container *vessel)
{
    for (size_t b = 0; b < s->clusters.count; b++) {
        const cluster_body *body = &s->clusters.body[b];
        const cluster_shape *shape = &s->clusters.shape[body->species];
        double a[3][3];
        quaternion_matrix(body->orientation, a);
        for (size_t k = 0; k < shape->sphere_count; k++) {
            const vector4 r = cluster_offset(shape, k, a, s->scale);
            double x[3] = { body->x[0] + r[0], body->x[1] + r[1], body->x[2] + r[2] };
            x[2] = wrap_axial(x[2], vessel->period, vessel->inverse_period);
            sphere_set_place(s, (size_t)body->first_sphere + k, x);
        }
    }
}

/* Few small particles in a wide container: larger cells are right, too, and cost less than many empty ones. */
enum { MOST_CELLS_A_SIDE = 512, MOST_CELLS_A_PARTICLE = 32 };

/* Cells no smaller than `size`. Returns how many. */
static size_t placing_cells(placing *p, const container *vessel, double size)
{
    size_t cells = 1;
    for (int a = 0; a < 3; a++) {
        const double side = vessel->high[a] - vessel->low[a];
        p->low[a] = vessel->low[a];
        p->cells[a] = (int)fmax(1.0, fmin(MOST_CELLS_A_SIDE, floor(side / size)));
        p->size[a] = side / p->cells[a];
        cells *= (size_t)p->cells[a];
    }
    return cells;
}

static dem_status placing_init(placing *p, const spheres *s, const container *vessel)
{
    *p = (placing){ .period = vessel->period, .inverse_period = vessel->inverse_period };
    size_t cells;
    double size = 2 * s->largest_reach;
    while ((cells = placing_cells(p, vessel, size)) > MOST_CELLS_A_PARTICLE * particles_count(s)) size *= 1.26;
    p->head = array_create(cells, sizeof *p->head);
    p->next = array_create(particles_count(s), sizeof *p->next);
    if (s->have_sizes) p->order = sizing_order(s);
    if (!p->head || !p->next || (s->have_sizes && !p->order)) return DEM_NO_MEMORY;
    for (size_t c = 0; c < cells; c++) p->head[c] = -1;
    return DEM_OK;
}

/* The large first, since they find room the hardest. */
static bool place_all(placing *p, spheres *s, const dem_scene_definition *definition, const region *region_of_centres, double scale,
                      random_streams *random)
{
    bool placed[DEM_MAXIMUM_SPECIES] = { false };
    if (p->order) {
        for (size_t i = 0; i < particles_count(s); i++)
            if (!place_one(p, s, (size_t)p->order[i], region_of_centres, scale, random)) return false;
        return true;
    }
    for (size_t round = 0; round < definition->species_count; round++) {
        size_t largest = 0;
        while (placed[largest]) largest++; /* one is left in each round */
        for (size_t k = largest + 1; k < definition->species_count; k++)
            if (!placed[k] && dem_species_reach(&definition->species[k]) > dem_species_reach(&definition->species[largest]))
                largest = k;
        placed[largest] = true;
        for (size_t i = 0; i < particles_count(s); i++)
            if (particle_species(s, i) == (int32_t)largest && !place_one(p, s, i, region_of_centres, scale, random)) return false;
    }
    return true;
}

/* Of the particles themselves, and of the spheres that hold them. */
static double total_volume(const spheres *s, const dem_scene_definition *definition, double *held)
{
    double volume = 0.0;
    *held = 0.0;
    for (size_t p = 0; p < particles_count(s); p++) {
        const double holding = dem_sphere_mass(2 * particle_reach(s, p), 1.0);
        *held += holding;
        volume += p < s->single_count ? holding : definition->species[particle_species(s, p)].cluster.volume;
    }
    return volume;
}

/* Times and drags of growing and settling, from the time a particle takes to fall through a container of that size. */
static void set_schedule(filling *f, const spheres *s, double size, const dem_scene_definition *definition)
{
    const double fall = sqrt(size / definition->gravity);
    const double speed = 0.1 * size / fall;
    const double growing = 4 * (1.001 - f->start_scale) * (2 * s->largest_reach) / speed;
    f->growing_steps = (int64_t)ceil(growing / definition->time_step);
    f->growing_drag = 10 / growing;
    f->settling_drag = 4 / fall;
    f->settling_steps_least = (int64_t)ceil(0.5 * fall / definition->time_step);
    f->settling_steps_most = (int64_t)ceil(40 * fall / definition->time_step);
    double mass = 0.0;
    for (size_t p = 0; p < particles_count(s); p++) mass += particle_mass(s, p);
    f->rest_energy = 1e-4 * mass * definition->gravity * s->smallest_diameter;
}

/* m3 that particles can share: without the lining's layer and the bars. */
static double free_volume(const container *c, const dem_scene_definition *definition)
{
    if (c->kind == DEM_VESSEL) return container_volume_below(c, c->length);
    const double room = c->inner_radius,
                 bars = (double)definition->lifters.count * definition->lifters.height * definition->lifters.width;
    return (DEM_PI * room * room - bars) * c->length;
}

/* Up to which that share of the volume is; a hopper is narrower than what is above it. */
static double height_of_share(const container *c, double share)
{
    if (c->hopper_height == 0) return share * c->length;
    const double above = container_volume_below(c, c->length) - container_volume_below(c, c->hopper_height);
    const double left_out = (1 - share) * container_volume_below(c, c->length);
    return fmax(c->hopper_height, c->length - left_out / above * (c->length - c->hopper_height));
}

static region region_of_share(const container *c, const spheres *s, double share)
{
    region r = { .container = c, .room = c->kind == DEM_VESSEL ? c->radius : c->inner_radius, .level = 1.0, .height = c->length };
    /* at least as high as one sphere needs */
    if (share < 1 && c->kind == DEM_DRUM)
        r.level = fmax(dem_circle_level(share), fmin(1.0, 1.5 * s->largest_diameter / r.room - 1));
    if (share < 1 && c->kind != DEM_DRUM) r.height = fmin(c->length, fmax(height_of_share(c, share), 3 * s->largest_reach));
    return r;
}

dem_status filling_place(filling *f, spheres *s, const container *vessel, const dem_scene_definition *definition)
{
    dem_status status = assign_species(s, definition);
    if (status != DEM_OK) return status;
    double held;
    const double volume = total_volume(s, definition, &held), fraction = volume / free_volume(vessel, definition);
    if (vessel->bars_from < 3 * s->largest_reach || vessel->inner_radius < 3 * s->largest_reach
        || fraction > dem_most_placed(definition))
        return DEM_DOES_NOT_FIT;
    const double share = fmin(1.0, fraction / REGION_FRACTION), region_fraction = fmax(REGION_FRACTION, fraction);
    const region region_of_centres = region_of_share(vessel, s, share);

    random_streams random;
    random_seed(&random.place, definition->seed);
    random_seed(&random.turn, ~definition->seed);
    placing p;
    status = placing_init(&p, s, vessel);
    /* A region few diameters across holds fewer: try again with smaller spheres that grow further. */
    double target = PLACING_FRACTION;
    for (bool done = false; status == DEM_OK && !done; target *= 0.7) {
        f->start_scale = fmin(1.0, cbrt(target / (region_fraction * (held / volume))));
        done = place_all(&p, s, definition, &region_of_centres, f->start_scale, &random);
        if (!done && target < 0.05) status = DEM_DOES_NOT_FIT;
        if (!done) {
            const size_t cells = (size_t)p.cells[0] * (size_t)p.cells[1] * (size_t)p.cells[2];
            for (size_t c = 0; c < cells; c++) p.head[c] = -1;
        }
    }
    free(p.head);
    free(p.next);
    free(p.order);
    if (status != DEM_OK) return status;
    spheres_set_scale(s, f->start_scale);
    clusters_place_spheres(s, vessel);
    const double size = vessel->kind != DEM_DRUM ? fmax(definition->diameter, region_of_centres.height)
                        : definition->tilt > 0   ? fmax(definition->diameter, definition->length)
                                                 : definition->diameter;
    set_schedule(f, s, size, definition);
    return DEM_OK;
}

dem_status filling_leave_out(filling *f, spheres *s, const dem_scene_definition *definition)
{
    const dem_status status = assign_species(s, definition);
    *f = (filling){ .start_scale = 1, .growing_steps = 1 };
    spheres_set_scale(s, 1);
    return status;
}

double filling_scale(const filling *f, int64_t steps)
{
    const double share = (double)steps / (double)f->growing_steps;
    return share < 1 ? f->start_scale + (1 - f->start_scale) * share : 1.0;
}
