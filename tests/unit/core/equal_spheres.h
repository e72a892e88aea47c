/* What scenes that a test makes by hand have in common, whatever they are in. */
#ifndef EQUAL_SPHERES_H
#define EQUAL_SPHERES_H

#include "core_claims.h"
#include "dem.h"
#include "dem_rules.h"

/* n equal spheres of 4 mm, in a container of no size yet. */
static inline dem_scene_definition equal_spheres(size_t n)
{
    return (dem_scene_definition){
        .gravity = 9.81,
        .fill_fraction = 0.5,
        .particle_count = n,
        .species_count = 1,
        .species = { { .diameter = 0.004, .density = 2500, .share = 1 } },
        .contact = { .stiffness = 4000,
                     .restitution = 0.8,
                     .friction = 0.3,
                     .wall_friction = 0.5,
                     .tangential_stiffness_ratio = 0.8 },
        .time_step = 1e-5,
        .seed = 1,
        .threads = 1,
    };
}

#endif
