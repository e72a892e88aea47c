#include "spec_memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

spec_memory *spec_memory_create(void) { return calloc(1, sizeof(spec_memory)); }

void spec_memory_free(spec_memory *memory)
{
    if (!memory) return;
    json_decref(memory->placed_list);
    json_decref(memory->origin);
    json_decref(memory->list);
    free(memory->list_name);
    free(memory->placed);
    free(memory);
}

/* --- placed particles --- */

static json_t *list_of(const json_t *inputs) { return json_object_get(json_object_get(inputs, "start"), "particles"); }

json_t *spec_memory_without_placed(const spec_memory *memory, const json_t *inputs)
{
    if (!memory || !memory->placed_list || list_of(inputs) != memory->placed_list) return NULL;
    json_t *rest = json_copy((json_t *)inputs), *start = json_copy(json_object_get(inputs, "start"));
    json_object_del(start, "particles");
    if (rest && json_object_set_new(rest, "start", start) == 0) return rest;
    json_decref(rest);
    return NULL;
}

bool spec_memory_place(const spec_memory *memory, start_inputs *start)
{
    start->particles = malloc(memory->placed_count * sizeof *start->particles);
    if (!start->particles) return false;
    memcpy(start->particles, memory->placed, memory->placed_count * sizeof *start->particles);
    start->particle_count = memory->placed_count;
    return true;
}

void spec_memory_keep_placed(spec_memory *memory, const json_t *inputs, const start_inputs *start)
{
    if (!memory || start->particle_count == 0) return;
    start_particle *placed = malloc(start->particle_count * sizeof *placed);
    if (!placed) return;
    memcpy(placed, start->particles, start->particle_count * sizeof *placed);
    free(memory->placed);
    json_decref(memory->placed_list);
    memory->placed = placed;
    memory->placed_count = start->particle_count;
    memory->placed_list = json_incref(list_of(inputs));
    memory->placed_apart = false;
}

static bool are_remembered(const spec_memory *memory, const start_inputs *start)
{
    return memory && memory->placed && memory->placed_count == start->particle_count
           && memcmp(memory->placed, start->particles, start->particle_count * sizeof *start->particles) == 0;
}

static double period_of(const dem_scene_definition *drum) { return drum->ends.are_walls ? 0.0 : drum->length; }

static bool have_the_same_spheres(const dem_species *a, const dem_species *b)
{
    return a->diameter == b->diameter && memcmp(&a->sizes, &b->sizes, sizeof a->sizes) == 0
           && memcmp(&a->cluster, &b->cluster, sizeof a->cluster) == 0;
}

bool spec_memory_knows_apart(const spec_memory *memory, const start_inputs *start, const dem_scene_definition *drum)
{
    if (!memory || !memory->placed_apart || memory->placed_period != period_of(drum)
        || memory->placed_species_count != drum->species_count)
        return false;
    for (size_t s = 0; s < drum->species_count; s++)
        if (!have_the_same_spheres(&memory->placed_species[s], &drum->species[s])) return false;
    return are_remembered(memory, start);
}

bool spec_memory_knows_inside(const spec_memory *memory, const start_inputs *start, const dem_scene_definition *drum)
{
    return memory && memory->placed_diameter == drum->diameter && memory->placed_length == drum->length
           && spec_memory_knows_apart(memory, start, drum);
}

void spec_memory_keep_sound(spec_memory *memory, const start_inputs *start, const dem_scene_definition *drum)
{
    if (!are_remembered(memory, start)) return;
    memory->placed_apart = true;
    memory->placed_diameter = drum->diameter;
    memory->placed_length = drum->length;
    memory->placed_period = period_of(drum);
    memory->placed_species_count = drum->species_count;
    memcpy(memory->placed_species, drum->species, drum->species_count * sizeof drum->species[0]);
}

/* --- beds that stand elsewhere --- */

json_t *spec_memory_find_list(const spec_memory *memory, const char *name)
{
    return memory && memory->list_name && strcmp(memory->list_name, name) == 0 ? json_incref(memory->list) : NULL;
}

void spec_memory_keep_list(spec_memory *memory, const char *name, json_t *list)
{
    if (!memory || !list) return;
    json_decref(memory->list);
    free(memory->list_name);
    memory->list = json_incref(list);
    memory->list_name = strdup(name);
}

/* --- beds of other jobs --- */

json_t *spec_memory_find_bed(const spec_memory *memory, const start_inputs *start, double *particles)
{
    if (!memory || !memory->origin || !*start->job || strcmp(memory->origin_job, start->job) != 0) return NULL;
    if (isnan(start->snapshot) ? !isnan(memory->origin_snapshot) : start->snapshot != memory->origin_snapshot) return NULL;
    *particles = memory->origin_particles;
    return json_incref(memory->origin);
}

void spec_memory_keep_bed(spec_memory *memory, const start_inputs *start, json_t *origin, double particles)
{
    if (!memory || !origin || !*start->job) return;
    json_decref(memory->origin);
    memory->origin = json_incref(origin);
    memcpy(memory->origin_job, start->job, sizeof memory->origin_job);
    memory->origin_snapshot = start->snapshot;
    memory->origin_particles = particles;
}

/* --- clusters --- */

static bool ask_for_the_same(const dem_cluster *a, const dem_cluster *b)
{
    return a->sphere_count == b->sphere_count && memcmp(a->sphere, b->sphere, a->sphere_count * sizeof a->sphere[0]) == 0;
}

bool spec_memory_find_cluster(const spec_memory *memory, const dem_cluster *asked, dem_cluster *derived)
{
    for (size_t k = 0; memory && k < memory->clusters && k < REMEMBERED_CLUSTERS; k++) {
        if (!ask_for_the_same(&memory->cluster_asked[k], asked)) continue;
        *derived = memory->cluster_derived[k];
        return true;
    }
    return false;
}

void spec_memory_keep_cluster(spec_memory *memory, const dem_cluster *asked, const dem_cluster *derived)
{
    if (!memory) return;
    const size_t k = memory->clusters++ % REMEMBERED_CLUSTERS; /* the oldest gives way */
    memory->cluster_asked[k] = *asked;
    memory->cluster_derived[k] = *derived;
}
