/* Claims about the order of particles in memory: it is that of their places, nobody outside can tell, and a run has the
 * same bits however it came to its order. */
#include "dem_cluster.h"
#include "scene.h"
#include "small_drum.h"

enum { BETWEEN_SORTS = 8192 };

/* Some 1700 spheres; with clusters, a third of them two by two. Quick: soft, and without much settling. */
static dem_scene_definition long_drum(bool with_clusters)
{
    dem_scene_definition d = small_drum();
    d.length = 0.066;
    d.diameter = 0.042;
    if (with_clusters) {
        d.species_count = 2;
        d.species[0].share = 0.8;
        d.species[1] = (dem_species){ .diameter = 0.003, .density = 2500, .share = 0.2 };
        d.species[1].cluster =
            (dem_cluster){ .sphere_count = 2, .sphere = { { { 0, 0, -0.0012 }, 0.003 }, { { 0, 0, 0.0012 }, 0.003 } } };
        dem_cluster_complete(&d.species[1].cluster);
    }
    d.particle_count = (size_t)dem_particles_of_fill(d.diameter, d.length, d.fill_fraction, d.species, d.species_count);
    follow_rules(&d, 0.04);
    return d;
}

typedef struct picture {
    size_t count;
    double *position, *spin;
    int32_t *species, *contacts, *cluster;
} picture;

static picture picture_of(const dem_scene *scene)
{
    const size_t n = dem_scene_sphere_count(scene);
    picture p = { n,
                  calloc(3 * n, sizeof(double)),
                  calloc(3 * n, sizeof(double)),
                  calloc(n, sizeof(int32_t)),
                  calloc(n, sizeof(int32_t)),
                  calloc(n, sizeof(int32_t)) };
    dem_scene_particles(scene, &(dem_particle_arrays){ .position = p.position,
                                                       .angular_velocity = p.spin,
                                                       .species = p.species,
                                                       .contacts = p.contacts,
                                                       .cluster = p.cluster });
    return p;
}

static void picture_clear(picture *p)
{
    free(p->position);
    free(p->spin);
    free(p->species);
    free(p->contacts);
    free(p->cluster);
}

/* Mean distance in memory, in spheres, between two of a kind that touch: those of clusters lie behind the others. */
static double distance_in_memory(const dem_scene *scene)
{
    const contact_list *pairs = &scene->neighbors.pairs;
    const int32_t singles = (int32_t)scene->spheres.single_count;
    double sum = 0, count = 0;
    for (size_t k = 0; k < pairs->count; k++) {
        if ((pairs->first[k] < singles) != (pairs->second[k] < singles)) continue;
        sum += pairs->second[k] - pairs->first[k];
        count++;
    }
    return sum / count;
}

/* Of all contacts, how many remember friction, and its sum, N. */
static double remembered(const dem_scene *scene, size_t *count)
{
    const contact_list *pairs = &scene->neighbors.pairs;
    double sum = 0;
    *count = 0;
    for (size_t k = 0; k < pairs->count; k++) {
        const contact_history h = contact_list_history(pairs, k);
        const double size = sqrt((double)dot(h.t, h.t));
        *count += size > 0;
        sum += size;
    }
    return sum;
}

/* A bed that turns, right before a sort. */
static dem_scene *before_a_sort(const dem_scene_definition *d)
{
    dem_scene *scene = drum_scene(d);
    run_to_phase(scene, DEM_PHASE_RUNNING);
    run(scene, BETWEEN_SORTS - (dem_scene_step_count(scene) - dem_scene_run_start(scene)));
    return scene;
}

static void nobody_outside_can_tell(bool with_clusters)
{
    const dem_scene_definition d = long_drum(with_clusters);
    dem_scene *scene = before_a_sort(&d);
    const spheres *s = &scene->spheres;
    assert_true(s->mobile_count > 1500);
    picture before = picture_of(scene);
    size_t count_before, count_after, moved = 0;
    const double friction = remembered(scene, &count_before);
    int32_t *ids = calloc(s->mobile_count, sizeof *ids);
    memcpy(ids, s->id, s->mobile_count * sizeof *ids);
    run(scene, 1);
    for (size_t i = 0; i < s->mobile_count; i++) moved += ids[i] != s->id[i];
    assert_true(moved > s->mobile_count / 2);
    /* in random order a third of all; here those of a few cells around */
    CHECK_BETWEEN(distance_in_memory(scene) / (double)s->mobile_count, 0, 0.06);
    picture after = picture_of(scene);
    assert_memory_equal(before.species, after.species, before.count * sizeof *before.species);
    assert_memory_equal(before.cluster, after.cluster, before.count * sizeof *before.cluster);
    /* in one step a particle moves by 1 m/s of a step at most, and friction changes a little */
    for (size_t i = 0; i < before.count; i++)
        for (size_t c = 0; c < 3; c++) {
            const double x = remainder(after.position[3 * i + c] - before.position[3 * i + c], c < 2 ? 1 : d.length);
            CHECK_NEAR(x, 0, d.time_step);
        }
    CHECK_NEAR(remembered(scene, &count_after) / friction, 1, 0.02);
    CHECK_NEAR(count_after, count_before, 0.02 * (double)count_before);
    free(ids);
    picture_clear(&before);
    picture_clear(&after);
    dem_scene_free(scene);
}

static void of_spheres_nobody_outside_can_tell(void **unused)
{
    (void)unused;
    nobody_outside_can_tell(false);
}

static void of_clusters_nobody_outside_can_tell(void **unused)
{
    (void)unused;
    nobody_outside_can_tell(true);
}

/* One sphere's forces in one step do not depend on who is first in memory: seen from the other end, friction turns, of
 * rolling, too. */
static void a_sort_changes_a_step_by_roundings_alone(void **unused)
{
    (void)unused;
    dem_scene_definition d = long_drum(true);
    d.contact.rolling_friction = d.contact.wall_rolling_friction = 0.1;
    dem_scene *sorted = before_a_sort(&d), *as_it_was = drum_scene(&d);
    dem_state state;
    assert_int_equal(dem_scene_save(sorted, &state), DEM_OK);
    assert_int_equal(dem_scene_restore(as_it_was, &state), DEM_OK);
    dem_state_clear(&state);
    as_it_was->steps_before = 1; /* its sort is due one step earlier, and past */
    run(sorted, 1);
    run(as_it_was, 1);
    assert_memory_not_equal(sorted->spheres.id, as_it_was->spheres.id, sorted->spheres.mobile_count * sizeof(int32_t));
    picture a = picture_of(sorted), b = picture_of(as_it_was);
    assert_memory_equal(a.contacts, b.contacts, a.count * sizeof *a.contacts);
    /* a torque is below mu m g 10 times the radius; a step of it changes the spin by so much, of which rounding 1e-6 */
    const double spin = 2.5 * 10 * d.gravity / 0.0015 * d.time_step;
    for (size_t k = 0; k < 3 * a.count; k++) {
        CHECK_NEAR(remainder(a.position[k] - b.position[k], k % 3 < 2 ? 1 : d.length), 0, 1e-13);
        CHECK_NEAR(a.spin[k], b.spin[k], 1e-5 * spin);
    }
    picture_clear(&a);
    picture_clear(&b);
    dem_scene_free(sorted);
    dem_scene_free(as_it_was);
}

static bool same_bits(const dem_scene *a, const dem_scene *b)
{
    const size_t n = a->spheres.mobile_count;
    return memcmp(a->spheres.id, b->spheres.id, n * sizeof *a->spheres.id) == 0
           && memcmp(a->spheres.place, b->spheres.place, n * sizeof *a->spheres.place) == 0
           && memcmp(a->spheres.angular_velocity, b->spheres.angular_velocity, n * sizeof *a->spheres.angular_velocity) == 0;
}

/* Saved before one sort and after another, on other threads, and with what comes next sent for, which many spheres do. */
static void across_sorts_a_run_has_the_same_bits(void **unused)
{
    (void)unused;
    dem_scene_definition d = long_drum(true);
    dem_scene *straight = before_a_sort(&d);
    dem_state state;
    for (d.threads = 1; d.threads <= 3; d.threads += 2) {
        dem_scene *early = drum_scene(&d), *late = drum_scene(&d), *whole = drum_scene(&d);
        assert_int_equal(dem_scene_save(straight, &state), DEM_OK);
        assert_int_equal(dem_scene_restore(whole, &state), DEM_OK);
        assert_int_equal(dem_scene_restore(early, &state), DEM_OK);
        dem_state_clear(&state);
        early->spheres.are_many = late->spheres.are_many = true;
        run(whole, 600);
        run(early, 250);
        assert_int_equal(dem_scene_save(early, &state), DEM_OK);
        assert_int_equal(dem_scene_restore(late, &state), DEM_OK);
        dem_state_clear(&state);
        run(late, 350);
        assert_true(same_bits(whole, late));
        assert_false(same_bits(whole, early));
        dem_scene_free(early);
        dem_scene_free(late);
        dem_scene_free(whole);
    }
    dem_scene_free(straight);
}

/* An order that is not one: an id twice, one that is not there, a cluster among the spheres. */
static void a_saved_order_that_is_none_is_refused(void **unused)
{
    (void)unused;
    const dem_scene_definition d = long_drum(true);
    dem_scene *scene = drum_scene(&d);
    for (int wrong = 0; wrong < 3; wrong++) {
        dem_state state;
        assert_int_equal(dem_scene_save(scene, &state), DEM_OK);
        for (size_t k = 0; k < state.array_count; k++) {
            if (strcmp(state.array[k].name, "particle") != 0) continue;
            int32_t *id = state.array[k].data;
            const size_t n = state.array[k].rows;
            if (wrong == 0) id[3] = id[4];
            if (wrong == 1) id[3] = (int32_t)n;
            if (wrong == 2) {
                id[3] = (int32_t)n - 1;
                id[n - 1] = 3;
            }
        }
        assert_int_equal(dem_scene_restore(scene, &state), DEM_STATE_MISMATCH);
        dem_state_clear(&state);
    }
    dem_scene_free(scene);
}

UNIT_TESTS(of_spheres_nobody_outside_can_tell, of_clusters_nobody_outside_can_tell, a_sort_changes_a_step_by_roundings_alone,
           across_sorts_a_run_has_the_same_bits, a_saved_order_that_is_none_is_refused)
