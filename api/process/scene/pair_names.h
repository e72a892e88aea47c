/* The names that partners of a pair have: those of materials, and those of a container's surfaces. */
#ifndef PAIR_NAMES_H
#define PAIR_NAMES_H

#include "job_spec.h"

enum { NO_PARTNER = -1 };

bool surface_is_there(const dem_scene_definition *scene, dem_surface surface);
/* A column of dem_scene_definition's pairs: a species, or a surface behind the largest number of species. */
bool partner_is_there(const dem_scene_definition *scene, size_t partner);
/* Of any container: no material may be called so. */
bool is_surface_name(const char *name);
/* NO_PARTNER: nobody has the name. */
int material_index(const scene_inputs *inputs, const char *name);
int surface_index(const dem_scene_definition *scene, const char *name); /* a dem_surface, perhaps one that is not there */
/* "glass", "steel", "wall": all that a pair may name. scene NULL: materials alone. */
void partner_names(const scene_inputs *inputs, const dem_scene_definition *scene, char *text, size_t size);

#endif
