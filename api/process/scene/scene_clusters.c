/* From a shape as asked for to a rigid cluster, or to what keeps its spheres from being one. */
#include <math.h>
#include <stdio.h>

#include "dem_cluster.h"
#include "scene_rules.h"

enum { LONGEST_POINTER = 80 };

static void sphere_pointer(char pointer[LONGEST_POINTER], size_t species, size_t sphere)
{
    snprintf(pointer, LONGEST_POINTER, "/inputs/particles/%zu/shape/spheres/%zu", species, sphere);
}

/* Spheres without a diameter have the particle's. False: one has neither, or was refused. */
static bool fill_diameters(species_inputs *inputs, size_t species, problem_list *problems)
{
    bool complete = true;
    for (size_t k = 0; k < inputs->sphere_count; k++) {
        dem_cluster_sphere *s = &inputs->sphere[k];
        if (isnan(s->diameter)) s->diameter = inputs->diameter;
        complete = complete && !isnan(s->diameter + s->position[0] + s->position[1] + s->position[2]);
        char pointer[LONGEST_POINTER];
        sphere_pointer(pointer, species, k);
        /* Beside other problems it may be one of those that were refused, and said so. */
        if (isnan(s->diameter) && problem_list_is_empty(problems))
            problem_list_add(problems, pointer, "has no diameter; must have one, in m, or the particle must");
    }
    return complete;
}

static bool is_one_body(const dem_cluster *cluster, size_t species, problem_list *problems)
{
    char pointer[LONGEST_POINTER];
    int in = 0;
    const int hidden = dem_cluster_hidden_sphere(cluster, &in), loose = dem_cluster_loose_sphere(cluster);
    if (hidden >= 0) {
        sphere_pointer(pointer, species, (size_t)hidden);
        problem_list_add(problems, pointer, "lies within sphere %d; each sphere of a cluster must reach beyond every other", in);
    }
    if (loose >= 0) {
        sphere_pointer(pointer, species, (size_t)loose);
        problem_list_add(problems, pointer, "is joined to sphere 0 by no chain of touching spheres; a cluster must be one body");
    }
    return hidden < 0 && loose < 0;
}

void scene_cluster_derive(spec_memory *memory, species_inputs *inputs, size_t species, dem_cluster *cluster, problem_list *problems)
{
    const bool is_named = inputs->shape < DEM_NAMED_SHAPES;
    bool known = !isnan(inputs->diameter);
    *cluster = (dem_cluster){ .sphere_count = 0 };
    if (is_named) {
        dem_cluster_of_shape(cluster, (dem_shape)inputs->shape, inputs->diameter);
    } else {
        known = fill_diameters(inputs, species, problems);
        cluster->sphere_count = inputs->sphere_count;
        for (size_t k = 0; k < inputs->sphere_count; k++) cluster->sphere[k] = inputs->sphere[k];
    }
    /* Not a number unless they are known, so that nothing is said of what would follow from them. */
    cluster->volume = cluster->reach = cluster->inertia[0] = cluster->inertia[1] = cluster->inertia[2] = NAN;
    const dem_cluster asked = *cluster;
    if (!known || spec_memory_find_cluster(memory, &asked, cluster) || !is_one_body(cluster, species, problems)) return;
    dem_cluster_complete(cluster);
    spec_memory_keep_cluster(memory, &asked, cluster);
}
