#include "scene.h"

#include "array.h"
#include "dem_rules.h"
#include "lost.h"
#include "parameters.h"
#include "stream.h"

dem_status dem_scene_create(const dem_scene_definition *definition, dem_scene **out)
{
    *out = NULL;
    arrays_prepare();
    dem_scene *scene = array_create(1, sizeof *scene);
    if (!scene) return DEM_NO_MEMORY;
    scene->definition = *definition;
    stream_complete_species(&scene->definition);
    dem_status status = parameters_complete(&scene->definition);
    if (status != DEM_OK) {
        free(scene);
        return status;
    }
    definition = &scene->definition;
    scene->run_start = -1;
    scene->surface = (surface_meter){ NAN, NAN };
    container_init(&scene->container, definition);
    status = spheres_init(&scene->spheres, definition, container_lining_count(definition));
    if (status == DEM_OK) spheres_set_period(&scene->spheres, definition, scene->container.period);
    if (status == DEM_OK && definition->is_placed) status = filling_leave_out(&scene->filling, &scene->spheres, definition);
    else if (status == DEM_OK && has_stream(definition)) status = stream_init(scene);
    else if (status == DEM_OK) status = filling_place(&scene->filling, &scene->spheres, &scene->container, definition);
    if (status == DEM_OK) container_place_lining(&scene->container, definition, &scene->spheres);
    if (status == DEM_OK) status = lost_init(scene);
    if (status == DEM_OK) status = neighbor_list_init(&scene->neighbors, &scene->spheres, definition);
    if (status != DEM_OK) {
        dem_scene_free(scene);
        return status;
    }
    if (has_stream(definition)) stream_begin(scene);
    else scene_enter_phase(scene, DEM_PHASE_GROWING);
    *out = scene;
    return DEM_OK;
}

void dem_scene_free(dem_scene *scene)
{
    if (!scene) return;
    neighbor_list_clear(&scene->neighbors);
    lost_clear(scene);
    spheres_clear(&scene->spheres);
    free(scene);
}

void scene_enter_phase(dem_scene *scene, dem_phase phase)
{
    const dem_scene_definition *definition = &scene->definition;
    scene->phase = phase;
    scene->contact = definition->contact;
    /* Grown without friction and cohesion, spheres slip into place instead of locking each other. */
    if (phase == DEM_PHASE_GROWING) {
        scene->contact.friction = scene->contact.wall_friction = 0.0;
        scene->contact.rolling_friction = scene->contact.wall_rolling_friction = 0.0;
        scene->contact.cohesion_law = DEM_NO_COHESION;
    }
    container_set_friction(&scene->container, definition, phase != DEM_PHASE_GROWING);
    scene->neighbors.table.has_friction = phase != DEM_PHASE_GROWING;
    container_move(&scene->container, definition, phase == DEM_PHASE_RUNNING, scene_time_in_motion(scene));
    container_rotate_lining(&scene->container, &scene->spheres);
    neighbor_list_invalidate(&scene->neighbors);
}

const dem_failure *dem_scene_failure(const dem_scene *scene) { return &scene->failure; }
void dem_scene_set_profile(dem_scene *scene, dem_step_profile *profile) { scene->profile = profile; }
dem_phase dem_scene_phase(const dem_scene *scene) { return scene->phase; }
int64_t dem_scene_step_count(const dem_scene *scene) { return scene->step_count; }
int64_t dem_scene_run_start(const dem_scene *scene) { return scene->run_start; }
size_t dem_scene_particle_count(const dem_scene *scene) { return particles_count(&scene->spheres); }
size_t dem_scene_sphere_count(const dem_scene *scene) { return scene->spheres.mobile_count; }
size_t dem_scene_lost_count(const dem_scene *scene) { return scene->lost_count; }
bool dem_scene_has_clusters(const dem_scene *scene) { return scene->spheres.clusters.count > 0; }
double dem_scene_turned(const dem_scene *scene) { return scene->container.angle; }
double dem_scene_kinetic_energy(const dem_scene *scene) { return spheres_kinetic_energy(&scene->spheres); }

double dem_scene_time(const dem_scene *scene)
{
    const double dt = scene->definition.time_step;
    return scene->run_start >= 0 ? (double)(scene->step_count - scene->run_start) * dt : -(double)scene->step_count * dt;
}

double dem_scene_maximum_overlap(const dem_scene *scene) { return scene->maximum_overlap / scene->spheres.smallest_diameter; }

const char *dem_scene_phase_name(const dem_scene *scene)
{
    if (scene->phase != DEM_PHASE_RUNNING || scene->container.kind == DEM_DRUM) return dem_phase_name(scene->phase);
    static const char *const running[] = { [DEM_CYLINDER] = "filling", [DEM_TUBE_ON_PLATE] = "lifting", [DEM_VESSEL] = "flowing" };
    return running[scene->container.kind];
}

static void sphere_orientation(const spheres *s, size_t i, double wxyz[4])
{
    static const double none[4] = { 1, 0, 0, 0 };
    if (i < s->single_count) memcpy(wxyz, none, sizeof none);
    else quaternion_to_wxyz(s->clusters.body[particle_of_sphere(s, i) - s->single_count].orientation, wxyz);
}

void dem_scene_particles(const dem_scene *scene, const dem_particle_arrays *arrays)
{
    const spheres *s = &scene->spheres;
    for (size_t i = 0; i < s->mobile_count; i++) {
        const size_t id = (size_t)s->id[i];
        for (size_t c = 0; c < 3; c++) {
            if (arrays->position) arrays->position[3 * id + c] = sphere_place(s, i)[c];
            if (arrays->velocity) arrays->velocity[3 * id + c] = s->velocity[i][c];
            if (arrays->angular_velocity) arrays->angular_velocity[3 * id + c] = s->angular_velocity[i][c];
        }
        if (arrays->radius) arrays->radius[id] = sphere_radius(s, i);
        if (arrays->species) arrays->species[id] = s->species[i];
        if (arrays->cluster) arrays->cluster[id] = particle_id(s, particle_of_sphere(s, i));
        if (arrays->orientation) sphere_orientation(s, i, arrays->orientation + 4 * id);
    }
    if (arrays->contacts) neighbor_list_count_contacts(&scene->neighbors, s, &scene->container, s->id, arrays->contacts);
}
