/* From a scene to its heap or bed: who belongs to it, frames of measurement, and whether the test is over. */
#include <math.h>

#include "array.h"
#include "dem_mound.h"
#include "dem_rules.h"
#include "drained.h"
#include "grounded.h"
#include "measure.h"
#include "statistics.h"

/* Of a heap: one that touches fewer is in flight, or rolls by itself on the plate. */
enum { LEAST_CONTACTS = 2 };
static const double REST = 1e-4;
enum { FRAMES_AT_REST = 3 };

/* The arrays that a mound is made of, in one block. */
typedef struct gathered {
    double *numbers;
    dem_mound mound;
} gathered;

/* Contacts of each particle, of all its spheres: (particles), freed with free(); NULL: no memory. */
static int32_t *count_contacts(const dem_scene *scene)
{
    const spheres *s = &scene->spheres;
    int32_t *of_spheres = array_create(s->mobile_count, sizeof *of_spheres);
    int32_t *of_particles = array_create(particles_count(s), sizeof *of_particles);
    if (of_spheres && of_particles) {
        neighbor_list_count_contacts(&scene->neighbors, s, &scene->container, NULL, of_spheres);
        for (size_t i = 0; i < s->mobile_count; i++) of_particles[particle_of_sphere(s, i)] += of_spheres[i];
    } else {
        free(of_particles);
        of_particles = NULL;
    }
    free(of_spheres);
    return of_particles;
}

static double mean_grain(const dem_scene *scene)
{
    return cbrt(6 / DEM_PI * dem_mean_volume(scene->definition.species, scene->definition.species_count));
}

/* Who belongs to the mound: (particles). */
static dem_status find_members(const dem_scene *scene, const int32_t *contacts, bool *is_member)
{
    if (scene->container.kind == DEM_CYLINDER) return grounded_find(scene, mean_grain(scene), is_member);
    for (size_t p = 0; p < particles_count(&scene->spheres); p++)
        is_member[p] = contacts[p] >= LEAST_CONTACTS && !particle_is_lost(scene, p);
    return DEM_OK;
}

static dem_status gather(const dem_scene *scene, const bool *is_member, gathered *g)
{
    const spheres *s = &scene->spheres;
    double *numbers = array_create(5 * s->mobile_count, sizeof *numbers);
    if (!numbers) return DEM_NO_MEMORY;
    double *radius = numbers + 3 * s->mobile_count, *volume = numbers + 4 * s->mobile_count;
    size_t n = 0;
    for (size_t i = 0; i < s->mobile_count; i++) {
        if (!is_member[particle_of_sphere(s, i)]) continue;
        memcpy(numbers + 3 * n, sphere_place(s, i), 3 * sizeof *numbers);
        radius[n] = sphere_radius(s, i);
        volume[n++] = volume_of_sphere(scene, i);
    }
    *g = (gathered){ numbers, { n, numbers, radius, volume, mean_grain(scene) } };
    return DEM_OK;
}

static dem_standing look(const dem_scene *scene, const int32_t *contacts, const bool *is_member)
{
    const spheres *s = &scene->spheres;
    dem_standing standing = { .lost = scene->lost_count, .kinetic_energy = spheres_kinetic_energy(s) };
    double weight = 0.0, sum = 0.0;
    for (size_t p = 0; p < particles_count(s); p++) {
        if (particle_is_lost(scene, p)) continue;
        weight += particle_mass(s, p) * scene->definition.gravity;
        standing.inside += is_member[p];
        sum += is_member[p] ? contacts[p] : 0;
    }
    standing.in_flight = particles_count(s) - standing.lost - standing.inside;
    if (scene->stream.particles) standing.waiting = scene->stream.particles - particles_count(s);
    standing.coordination_number = standing.inside ? sum / (double)standing.inside : NAN;
    standing.tension_share = measure_tension_share(scene);
    standing.at_rest = standing.kinetic_energy < REST * weight * s->smallest_diameter;
    return standing;
}

/* Contacts, who belongs to the mound, and how it stands. g: its numbers to be freed. */
static dem_status survey(const dem_scene *scene, gathered *g, dem_standing *standing)
{
    int32_t *contacts = count_contacts(scene);
    if (!contacts) return DEM_NO_MEMORY;
    bool *is_member = array_create(particles_count(&scene->spheres), sizeof *is_member);
    dem_status status = is_member ? find_members(scene, contacts, is_member) : DEM_NO_MEMORY;
    if (status == DEM_OK) {
        *standing = look(scene, contacts, is_member);
        status = gather(scene, is_member, g);
    }
    free(is_member);
    free(contacts);
    return status;
}

dem_status dem_heap_scene_measure(const dem_scene *scene, dem_heap_results *results, dem_standing *standing)
{
    gathered g;
    dem_status status = survey(scene, &g, standing);
    if (status != DEM_OK) return status;
    status = dem_heap_measure(&g.mound, 0.5 * scene->definition.plate.diameter, scene->definition.plate.rim_height, results);
    free(g.numbers);
    return status;
}

static dem_status measure_bed(const dem_scene *scene, dem_fill_results *results, dem_standing *standing)
{
    gathered g;
    dem_status status = survey(scene, &g, standing);
    if (status != DEM_OK) return status;
    status = dem_fill_measure(&g.mound, 0.5 * scene->definition.diameter, results);
    free(g.numbers);
    return status;
}

/* ---- frames ---- */

enum heap_column {
    HEAP_TIME,
    HEAP_ANGLE,
    HEAP_APEX_TO_BASE,
    HEAP_EQUAL_VOLUME,
    HEAP_SILHOUETTE,
    HEAP_HEIGHT,
    HEAP_BASE,
    HEAP_COORDINATION,
    HEAP_LOST,
    HEAP_ENERGY,
    HEAP_TUBE,
    HEAP_AT_REST,
    HEAP_TENSION
};

const char *dem_heap_frame_name(size_t index)
{
    static const char *const name[DEM_HEAP_FRAME] = {
        "time",           "angle_deg",      "apex_to_base_deg", "equal_volume_cone_deg",
        "silhouette_deg", "height",         "base_diameter",    "coordination_number",
        "lost",           "kinetic_energy", "tube_height",      "at_rest",
        "tension_share",
    };
    return index < DEM_HEAP_FRAME ? name[index] : NULL;
}

dem_status dem_heap_frame_measure(dem_scene *scene, double *frame)
{
    dem_heap_results heap;
    dem_standing standing;
    const dem_status status = dem_heap_scene_measure(scene, &heap, &standing);
    if (status != DEM_OK) return status;
    frame[HEAP_TIME] = dem_scene_time(scene);
    frame[HEAP_ANGLE] = heap.angle[DEM_AZIMUTHAL_FIT].mean_deg;
    frame[HEAP_APEX_TO_BASE] = heap.angle[DEM_APEX_TO_BASE].mean_deg;
    frame[HEAP_EQUAL_VOLUME] = heap.angle[DEM_EQUAL_VOLUME].mean_deg;
    frame[HEAP_SILHOUETTE] = heap.angle[DEM_SILHOUETTE].mean_deg;
    frame[HEAP_HEIGHT] = heap.height;
    frame[HEAP_BASE] = heap.base_diameter;
    frame[HEAP_COORDINATION] = standing.coordination_number;
    frame[HEAP_LOST] = (double)standing.lost;
    frame[HEAP_ENERGY] = standing.kinetic_energy;
    frame[HEAP_TUBE] = scene->container.wall[0].low;
    frame[HEAP_AT_REST] = standing.at_rest;
    frame[HEAP_TENSION] = standing.tension_share;
    return DEM_OK;
}

bool dem_heap_is_over(const double *frames, size_t count)
{
    if (count < FRAMES_AT_REST) return false;
    for (size_t k = count - FRAMES_AT_REST; k < count; k++) {
        const double *frame = frames + k * DEM_HEAP_FRAME;
        if (frame[HEAP_AT_REST] == 0 || !(frame[HEAP_TUBE] > frame[HEAP_HEIGHT])) return false;
    }
    return true;
}

enum fill_column {
    FILL_TIME,
    FILL_ANGLE,
    FILL_CENTER_TO_WALL,
    FILL_AREA_FIT,
    FILL_HEIGHT,
    FILL_COORDINATION,
    FILL_ENTERED,
    FILL_IN_FLIGHT,
    FILL_ENERGY,
    FILL_AT_REST,
    FILL_TENSION
};

const char *dem_fill_frame_name(size_t index)
{
    static const char *const name[DEM_FILL_FRAME] = {
        "time",    "angle_deg", "center_to_wall_deg", "area_fit_deg", "height",        "coordination_number",
        "entered", "in_flight", "kinetic_energy",     "at_rest",      "tension_share",
    };
    return index < DEM_FILL_FRAME ? name[index] : NULL;
}

dem_status dem_fill_frame_measure(dem_scene *scene, double *frame)
{
    dem_fill_results fill;
    dem_standing standing;
    const dem_status status = measure_bed(scene, &fill, &standing);
    if (status != DEM_OK) return status;
    frame[FILL_TIME] = dem_scene_time(scene);
    frame[FILL_ANGLE] = fill.angle[DEM_RADIAL_FIT].mean_deg;
    frame[FILL_CENTER_TO_WALL] = fill.angle[DEM_CENTER_TO_WALL].mean_deg;
    frame[FILL_AREA_FIT] = fill.angle[DEM_AREA_FIT].mean_deg;
    frame[FILL_HEIGHT] = fill.height;
    frame[FILL_COORDINATION] = standing.coordination_number;
    frame[FILL_ENTERED] = (double)dem_scene_particle_count(scene);
    frame[FILL_IN_FLIGHT] = (double)standing.in_flight;
    frame[FILL_ENERGY] = standing.kinetic_energy;
    /* Before the last has entered there is no rest, however still the bed. */
    frame[FILL_AT_REST] = standing.at_rest && standing.waiting == 0;
    frame[FILL_TENSION] = standing.tension_share;
    return DEM_OK;
}

bool dem_fill_is_over(const double *frames, size_t count)
{
    if (count < FRAMES_AT_REST) return false;
    for (size_t k = count - FRAMES_AT_REST; k < count; k++)
        if (frames[k * DEM_FILL_FRAME + FILL_AT_REST] == 0) return false;
    return true;
}

/* Over the frames of the stream's second half. */
static dem_angle angle_while_filling(const double *frames, size_t count, double particles)
{
    dem_angle angle = { NAN, NAN, NAN, NAN };
    size_t from = 0, to = 0;
    while (from < count && frames[from * DEM_FILL_FRAME + FILL_ENTERED] < 0.5 * particles) from++;
    for (to = from; to < count && frames[to * DEM_FILL_FRAME + FILL_ENTERED] < particles;) to++;
    double *column = array_create(to - from + 1, sizeof *column);
    if (!column) return angle;
    for (size_t k = from; k < to; k++) {
        column[k - from] = frames[k * DEM_FILL_FRAME + FILL_ANGLE];
        angle.minimum_deg = fmin(angle.minimum_deg, column[k - from]);
        angle.maximum_deg = fmax(angle.maximum_deg, column[k - from]);
    }
    angle.mean_deg = statistics_mean(column, to - from);
    angle.standard_error_deg = statistics_standard_error(column, to - from);
    free(column);
    return angle;
}

dem_status dem_fill_scene_measure(const dem_scene *scene, const double *frames, size_t count, dem_fill_results *results,
                                  dem_angle *while_filling, dem_standing *standing)
{
    arrays_begin();
    *while_filling = angle_while_filling(frames, count, (double)scene->definition.particle_count);
    const dem_status status = arrays_end(DEM_OK);
    return status == DEM_OK ? measure_bed(scene, results, standing) : status;
}
