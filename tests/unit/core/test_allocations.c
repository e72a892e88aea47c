/* Claims about memory that the machine does not have: whichever allocation of a run fails, the core says DEM_NO_MEMORY, holds
 * nothing back after it, and a scene that is still there goes on as if nothing had been asked for.
 *
 * The linker puts the functions below before those of libc (--wrap). */
#include "dem_cluster.h"
#include "dem_mound.h"
#include "small_drum.h"

static long allocations, failing_at = -1, alive;

static bool fails(void)
{
#pragma omp atomic
    allocations++;
    return allocations - 1 == failing_at;
}

static void *counted(void *memory)
{
    if (memory) {
#pragma omp atomic
        alive++;
    }
    return memory;
}

void *__real_malloc(size_t bytes);
void *__real_calloc(size_t count, size_t bytes);
void *__real_realloc(void *memory, size_t bytes);
void *__real_aligned_alloc(size_t alignment, size_t bytes);
void __real_free(void *memory);
void *__wrap_malloc(size_t bytes);
void *__wrap_calloc(size_t count, size_t bytes);
void *__wrap_realloc(void *memory, size_t bytes);
void *__wrap_aligned_alloc(size_t alignment, size_t bytes);
void __wrap_free(void *memory);

void *__wrap_malloc(size_t bytes) { return fails() ? NULL : counted(__real_malloc(bytes)); }
void *__wrap_calloc(size_t count, size_t bytes) { return fails() ? NULL : counted(__real_calloc(count, bytes)); }
void *__wrap_aligned_alloc(size_t alignment, size_t bytes)
{
    return fails() ? NULL : counted(__real_aligned_alloc(alignment, bytes));
}
void *__wrap_realloc(void *memory, size_t bytes)
{
    if (fails()) return NULL;
    void *grown = __real_realloc(memory, bytes);
    return memory ? grown : counted(grown);
}
void __wrap_free(void *memory)
{
    if (memory) {
#pragma omp atomic
        alive--;
    }
    __real_free(memory);
}

/* A few particles in each container, so that a run costs milliseconds. */
static dem_scene_definition definition_of(dem_container_kind kind)
{
    dem_scene_definition d = small_drum();
    d.container = kind;
    d.particle_count = 12;
    d.species_count = 2;
    d.species[0].share = 0.5;
    d.species[1] = (dem_species){ .diameter = 0.003, .density = 2500, .share = 0.5 };
    dem_cluster_of_shape(&d.species[1].cluster, DEM_DUMBBELL, 0.003);
    dem_cluster_complete(&d.species[1].cluster);
    d.contact.rolling_friction = 0.05;
    d.diameter = 0.025;
    d.length = kind == DEM_DRUM ? 0.015 : 0.03;
    if (kind == DEM_DRUM) d.lining = (dem_lining){ .diameter = 0.002, .pitch = 0.004 };
    if (kind == DEM_TUBE_ON_PLATE) {
        d.lift = (dem_lift){ .speed = 0.2, .start = 0.005 };
        d.plate = (dem_plate){ .diameter = 0.05, .friction = 0.4 };
        d.rotation_rate = 0;
    }
    if (kind == DEM_CYLINDER) d.rotation_rate = 0;
    d.contact.restitution = 0.3; /* soon at rest, in few steps */
    follow_rules(&d, 0.1);
    return d;
}

enum { FRAMES = 9 };

static dem_status measure(dem_scene *scene, dem_container_kind kind, const double *frames)
{
    dem_drum_results drum;
    dem_heap_results heap;
    dem_standing standing;
    if (kind == DEM_DRUM) return dem_drum_results_measure(scene, frames, FRAMES, &drum);
    return kind == DEM_TUBE_ON_PLATE ? dem_heap_scene_measure(scene, &heap, &standing) : DEM_OK;
}

static dem_status frames_of(dem_scene *scene, double *frames, double *sums)
{
    dem_status status = DEM_OK;
    for (int k = 0; k < FRAMES && status == DEM_OK; k++) {
        status = dem_scene_advance(scene, 20);
        if (status == DEM_OK) status = dem_frame_measure(scene, frames + (size_t)k * dem_frame_width(scene));
        if (status == DEM_OK) status = dem_fields_add(scene, sums);
    }
    return status;
}

/* Everything that a job asks of the core. The test's own arrays are libc's, so that they never fail. */
static dem_status whole_run(const dem_scene_definition *d)
{
    dem_scene *scene = NULL, *again = NULL;
    dem_state state = { .array_count = 0 };
    double *frames = NULL, *sums = NULL;
    dem_status status = dem_scene_create(d, &scene);
    if (status == DEM_OK) status = dem_scene_advance_to_run(scene, 1000000);
    if (status == DEM_OK && d->container == DEM_DRUM) {
        frames = __real_calloc(FRAMES * dem_frame_width(scene), sizeof *frames);
        sums = __real_calloc(dem_fields_size(scene), sizeof *sums);
        status = frames_of(scene, frames, sums);
    }
    if (status == DEM_OK) status = measure(scene, d->container, frames);
    if (status == DEM_OK) status = dem_scene_save(scene, &state);
    if (status == DEM_OK) status = dem_scene_create(d, &again);
    if (status == DEM_OK) status = dem_scene_restore(again, &state);
    if (status == DEM_OK) status = dem_scene_advance(again, 50);
    dem_state_clear(&state);
    dem_scene_free(again);
    dem_scene_free(scene);
    __real_free(frames);
    __real_free(sums);
    return status;
}

static void whichever_allocation_fails(dem_container_kind kind)
{
    const dem_scene_definition d = definition_of(kind);
    failing_at = -1;
    allocations = alive = 0;
    assert_int_equal(whole_run(&d), DEM_OK);
    assert_int_equal(alive, 0);
    const long all = allocations;
    assert_true(all > 30);
    for (long n = 0; n < all; n++) {
        failing_at = n;
        allocations = alive = 0;
        const dem_status status = whole_run(&d);
        if (status != DEM_NO_MEMORY) fail_msg("allocation %ld of %ld fails: %s", n, all, dem_status_text(status));
        if (alive != 0) fail_msg("after allocation %ld of %ld failed, %ld pieces of memory are held", n, all, alive);
    }
    failing_at = -1;
}

static void a_drum_says_that_memory_is_missing(void **state)
{
    (void)state;
    whichever_allocation_fails(DEM_DRUM);
}

static void a_heap_says_that_memory_is_missing(void **state)
{
    (void)state;
    whichever_allocation_fails(DEM_TUBE_ON_PLATE);
}

static void a_cylinder_says_that_memory_is_missing(void **state)
{
    (void)state;
    whichever_allocation_fails(DEM_CYLINDER);
}

UNIT_TESTS(a_drum_says_that_memory_is_missing, a_heap_says_that_memory_is_missing, a_cylinder_says_that_memory_is_missing)
