/* Claims about the neighbor lists: against a search of all pairs at every step, no contact is ever missed. */
#include "dem_cluster.h"
#include "scene.h"
#include "small_drum.h"

/* All pairs that touch now and are not in the list that the next step computes. */
typedef struct census {
    size_t touching, missed, steps; /* steps looked at */
} census;

/* Which pairs are listed, and all spheres in the order of x, so that "all pairs" need not take all day. */
typedef struct listed {
    uint8_t *pair; /* (mobile, all) */
    size_t *order; /* (all) */
    size_t mobile, all;
} listed;

static listed listed_create(const dem_scene *scene)
{
    listed l = { .mobile = scene->spheres.mobile_count, .all = spheres_count(&scene->spheres) };
    l.pair = calloc(l.mobile * l.all, 1);
    l.order = calloc(l.all, sizeof *l.order);
    assert_non_null(l.pair);
    assert_non_null(l.order);
    for (size_t k = 0; k < l.all; k++) l.order[k] = k;
    return l;
}

/* Nearly sorted from the step before: by insertion. */
static void listed_sort(listed *l, const vector4 *place)
{
    for (size_t k = 1; k < l->all; k++) {
        const size_t moving = l->order[k];
        size_t m = k;
        for (; m > 0 && place[l->order[m - 1]][0] > place[moving][0]; m--) l->order[m] = l->order[m - 1];
        l->order[m] = moving;
    }
}

static void listed_mark(listed *l, const contact_list *pairs, uint8_t mark)
{
    for (size_t k = 0; k < pairs->count; k++) {
        assert_true(pairs->first[k] < pairs->second[k]);
        l->pair[(size_t)pairs->first[k] * l->all + (size_t)pairs->second[k]] = mark;
    }
}

static void count_pairs(const dem_scene *scene, listed *l, census *c)
{
    const spheres *s = &scene->spheres;
    listed_sort(l, s->place);
    const double widest = fmax(s->largest_diameter, scene->definition.lining.diameter);
    for (size_t a = 0; a < l->all; a++)
        for (size_t b = a + 1; b < l->all && s->place[l->order[b]][0] - s->place[l->order[a]][0] < widest; b++) {
            const size_t i = l->order[a] < l->order[b] ? l->order[a] : l->order[b], j = l->order[a] + l->order[b] - i;
            const double *x = sphere_place(s, i), *y = sphere_place(s, j), reach = sphere_radius(s, i) + sphere_radius(s, j);
            const double dx = y[0] - x[0], dy = y[1] - x[1];
            if (i >= l->mobile || fabs(dx) > reach || fabs(dy) > reach) continue;
            if (j < l->mobile && particle_of_sphere(s, i) == particle_of_sphere(s, j)) continue; /* one rigid body */
            const double dz = remainder(y[2] - x[2], scene->container.length);
            if (dx * dx + dy * dy + dz * dz >= reach * reach) continue;
            c->touching++;
            c->missed += !l->pair[i * l->all + j];
        }
}

/* Pairs within one cluster that are listed all the same. */
static size_t count_own_pairs(const dem_scene *scene)
{
    const contact_list *pairs = &scene->neighbors.pairs;
    const spheres *s = &scene->spheres;
    size_t own = 0;
    for (size_t k = 0; k < pairs->count; k++)
        own += (size_t)pairs->second[k] < s->mobile_count
               && particle_of_sphere(s, (size_t)pairs->first[k]) == particle_of_sphere(s, (size_t)pairs->second[k]);
    return own;
}

static void count_walls(const dem_scene *scene, census *c)
{
    const neighbor_list *list = &scene->neighbors;
    for (size_t i = 0; i < scene->spheres.mobile_count; i++) {
        const double *x = sphere_place(&scene->spheres, i);
        if (hypot(x[0], x[1]) + sphere_radius(&scene->spheres, i) <= scene->container.radius) continue;
        bool found = false;
        for (size_t k = list->wall_start[i]; k < list->wall_start[i + 1]; k++) found = found || list->walls.first[k] == (int32_t)i;
        c->touching++;
        c->missed += !found;
    }
}

/* `most` censuses, one every `stride` steps, or until the phase after `last`. A stride that shares no factor with the
 * life of a list meets every age of it. */
static census take_census(dem_scene *scene, dem_phase last, int64_t stride, int64_t most)
{
    census c = { 0 };
    listed l = listed_create(scene);
    for (; dem_scene_phase(scene) <= last && (int64_t)c.steps < most; c.steps++) {
        run(scene, stride);
        listed_mark(&l, &scene->neighbors.pairs, 1);
        count_pairs(scene, &l, &c);
        count_walls(scene, &c);
        assert_int_equal(count_own_pairs(scene), 0);
        listed_mark(&l, &scene->neighbors.pairs, 0);
    }
    free(l.pair);
    free(l.order);
    return c;
}

static void check_run(dem_scene_definition *d)
{
    enum { EVERY = 600, FIFTH = 800 };
    follow_rules(d, 0.06);
    dem_scene *scene = drum_scene(d);
    const census growing = take_census(scene, DEM_PHASE_GROWING, 1, 600);
    run_to_phase(scene, DEM_PHASE_RUNNING);
    const int64_t picks = scene->neighbors.inner_picks;
    const census start = take_census(scene, DEM_PHASE_RUNNING, 1, EVERY);
    const census later = take_census(scene, DEM_PHASE_RUNNING, 5, FIFTH);
    assert_int_equal(growing.missed, 0);
    assert_int_equal(start.missed, 0);
    assert_int_equal(later.missed, 0);
    assert_int_equal(start.steps + later.steps, EVERY + FIFTH);
    CHECK_BETWEEN((double)(start.touching + later.touching), 20.0 * (EVERY + FIFTH), INFINITY); /* there was something to miss */
    /* and lists do outlive a step: missing nothing by picking always would prove nothing */
    CHECK_BETWEEN((double)(scene->neighbors.inner_picks - picks) / (EVERY + 5 * FIFTH), 0, 0.5);
    dem_scene_free(scene);
}

/* Omega^2 = omega^2 R/g of 2.2 from rest: the bed is thrown about the whole drum. */
static double fast_rate(const dem_scene_definition *d) { return sqrt(2.2 * d->gravity / (0.5 * d->diameter)); }

static void no_contact_is_missed_in_a_fast_start_of_two_sizes(void **unused)
{
    (void)unused;
    dem_scene_definition d = two_sizes_drum();
    d.rotation_rate = fast_rate(&d);
    check_run(&d);
}

/* One large sphere to a hundred of a tenth of its size. */
static void no_contact_is_missed_where_sizes_are_ten_times_apart(void **unused)
{
    (void)unused;
    dem_scene_definition d = two_sizes_drum();
    d.species[0] = (dem_species){ .diameter = 0.0006, .density = 2500, .share = 0.99 };
    d.species[1] = (dem_species){ .diameter = 0.006, .density = 25, .share = 0.01 }; /* light, hence longer steps */
    d.fill_fraction = 0.03;
    d.particle_count = (size_t)dem_particles_of_fill(d.diameter, d.length, d.fill_fraction, d.species, 2);
    d.rotation_rate = fast_rate(&d);
    check_run(&d);
}

static void no_contact_is_missed_with_a_lining(void **unused)
{
    (void)unused;
    dem_scene_definition d = two_sizes_drum();
    d.lining = (dem_lining){ .diameter = 0.003, .pitch = 0.0035 };
    d.fill_fraction = 0.3;
    d.particle_count = (size_t)dem_particles_of_fill(d.diameter, d.length, d.fill_fraction, d.species, 2);
    d.rotation_rate = fast_rate(&d);
    check_run(&d);
}

/* The other way round, and slow. */
static void no_contact_is_missed_in_a_slow_drum_turning_backwards(void **unused)
{
    (void)unused;
    dem_scene_definition d = small_drum();
    d.rotation_rate = -1.5;
    check_run(&d);
}

/* A period of three diameters, the least there is: neighbors on both sides along the axis are the same few. */
static void no_contact_is_missed_along_a_very_short_axis(void **unused)
{
    (void)unused;
    dem_scene_definition d = small_drum();
    d.length = 3 * 0.003;
    d.particle_count = (size_t)dem_particles_of_fill(d.diameter, d.length, d.fill_fraction, d.species, 1);
    d.rotation_rate = fast_rate(&d);
    check_run(&d);
}

/* Spheres of a turning cluster leave straight paths all the time, and while clusters grow they move apart: bent
 * clusters of three that overlap, tetrahedra and spheres, thrown about the drum. */
static void no_contact_is_missed_among_tumbling_clusters(void **unused)
{
    (void)unused;
    dem_scene_definition d = small_drum();
    d.diameter = 0.05;
    d.length = 0.02;
    d.species_count = 3;
    for (int k = 0; k < 3; k++) d.species[k] = (dem_species){ .diameter = 0.003, .density = 2500, .share = 1.0 / 3 };
    dem_cluster_of_shape(&d.species[0].cluster, DEM_TETRAHEDRON, 0.002);
    d.species[1].cluster =
        (dem_cluster){ .sphere_count = 3,
                       .sphere = { { { 0, 0, 0 }, 0.004 }, { { 0.003, 0, 0 }, 0.003 }, { { 0.003, 0.002, 0 }, 0.002 } } };
    for (int k = 0; k < 2; k++) dem_cluster_complete(&d.species[k].cluster);
    d.fill_fraction = 0.35;
    d.particle_count = (size_t)dem_particles_of_fill(d.diameter, d.length, d.fill_fraction, d.species, 3);
    d.rotation_rate = fast_rate(&d);
    check_run(&d);
}

/* The order by which every sphere's sum is the same whenever a list was made. */
static void contacts_are_listed_in_the_order_of_their_ids(void **unused)
{
    (void)unused;
    dem_scene_definition d = two_sizes_drum();
    follow_rules(&d, 0.03);
    dem_scene *scene = drum_scene(&d);
    run_to_phase(scene, DEM_PHASE_SETTLING);
    for (int k = 0; k < 200; k++) {
        run(scene, 7);
        const contact_list *pairs = &scene->neighbors.pairs;
        for (size_t m = 1; m < pairs->count; m++)
            assert_true(pairs->first[m] > pairs->first[m - 1]
                        || (pairs->first[m] == pairs->first[m - 1] && pairs->second[m] > pairs->second[m - 1]));
    }
    dem_scene_free(scene);
}

static void contacts_of_each_particle_are_counted_as_by_all_pairs(void **unused)
{
    (void)unused;
    dem_scene_definition d = two_sizes_drum();
    d.lining = (dem_lining){ .diameter = 0.003, .pitch = 0.0035 };
    d.particle_count = 200;
    follow_rules(&d, 0.03);
    dem_scene *scene = drum_scene(&d);
    run_to_phase(scene, DEM_PHASE_RUNNING);
    run(scene, 300);
    const spheres *s = &scene->spheres;
    int32_t counted[200], expected[200] = { 0 };
    dem_scene_particles(scene, &(dem_particle_arrays){ .contacts = counted });
    for (size_t i = 0; i < 200; i++) {
        const double *x = sphere_place(s, i);
        for (size_t j = 0; j < spheres_count(s); j++) {
            const double *y = sphere_place(s, j), dz = remainder(y[2] - x[2], d.length);
            const double distance = sqrt((y[0] - x[0]) * (y[0] - x[0]) + (y[1] - x[1]) * (y[1] - x[1]) + dz * dz);
            expected[i] += j != i && distance < (double)s->full_radius[i] + (double)s->full_radius[j];
        }
        expected[i] += hypot(x[0], x[1]) + s->full_radius[i] > 0.5 * d.diameter;
    }
    assert_memory_equal(counted, expected, sizeof counted);
    dem_scene_free(scene);
}

/* Against the definition's diameters and densities. */
static void check_pair(const dem_scene *scene, size_t k)
{
    const contact_list *pairs = &scene->neighbors.pairs;
    const spheres *s = &scene->spheres;
    const size_t j = (size_t)pairs->second[k];
    const dem_species *a = &scene->definition.species[s->species[pairs->first[k]]], *b = NULL;
    if (j < s->mobile_count) b = &scene->definition.species[s->species[j]];
    const double m_a = dem_sphere_mass(a->diameter, a->density), m_b = b ? dem_sphere_mass(b->diameter, b->density) : INFINITY;
    const double r_a = a->diameter / 2, r_b = (b ? b->diameter : scene->definition.lining.diameter) / 2;
    CHECK_NEAR((double)pairs->root_mass[k] / sqrt(1 / (1 / m_a + 1 / m_b)), 1, 1e-6);
    CHECK_NEAR((double)pairs->radius[k] / (1 / (1 / r_a + 1 / r_b)), 1, 1e-6);
    CHECK_NEAR((double)pairs->first_radius[k] / r_a, 1, 1e-6);
}

static void every_law_finds_masses_and_radii_of_all_pairs(void **unused)
{
    (void)unused;
    const dem_contact_law laws[] = { DEM_WALTON_BRAUN, DEM_SPRING_DASHPOT };
    for (int k = 0; k < 2; k++) {
        dem_scene_definition d = two_sizes_drum();
        d.contact.law = laws[k];
        d.species[1].density = 4000;
        d.lining = (dem_lining){ .diameter = 0.003, .pitch = 0.0035 };
        d.fill_fraction = 0.2;
        d.particle_count = (size_t)dem_particles_of_fill(d.diameter, d.length, d.fill_fraction, d.species, 2);
        follow_rules(&d, 0.03);
        dem_scene *scene = drum_scene(&d);
        run_to_phase(scene, DEM_PHASE_RUNNING);
        const contact_list *pairs = &scene->neighbors.pairs;
        const spheres *s = &scene->spheres;
        size_t mixed = 0, fixed = 0;
        for (size_t p = 0; p < pairs->count; p++) {
            const size_t i = (size_t)pairs->first[p], j = (size_t)pairs->second[p];
            check_pair(scene, p);
            fixed += j >= s->mobile_count;
            mixed += j < s->mobile_count && s->species[i] != s->species[j];
        }
        assert_true(mixed > 10 && fixed > 10);
        dem_scene_free(scene);
    }
}

UNIT_TESTS(no_contact_is_missed_in_a_fast_start_of_two_sizes, no_contact_is_missed_where_sizes_are_ten_times_apart,
           no_contact_is_missed_with_a_lining, no_contact_is_missed_in_a_slow_drum_turning_backwards,
           no_contact_is_missed_along_a_very_short_axis, no_contact_is_missed_among_tumbling_clusters,
           contacts_are_listed_in_the_order_of_their_ids, every_law_finds_masses_and_radii_of_all_pairs,
           contacts_of_each_particle_are_counted_as_by_all_pairs)
