#include "pair_names.h"

#include <stdio.h>
#include <string.h>

static const struct {
    const char *name;
    dem_container_kind kind;
    dem_surface surface;
} surface_names[] = {
    { "wall", DEM_DRUM, DEM_WALL },          { "ends", DEM_DRUM, DEM_ENDS },          { "lifters", DEM_DRUM, DEM_LIFTERS },
    { "lining", DEM_DRUM, DEM_LINING },      { "wall", DEM_CYLINDER, DEM_WALL },      { "floor", DEM_CYLINDER, DEM_ENDS },
    { "tube", DEM_TUBE_ON_PLATE, DEM_WALL }, { "wall", DEM_TUBE_ON_PLATE, DEM_WALL }, { "plate", DEM_TUBE_ON_PLATE, DEM_PLATE },
    { "wall", DEM_VESSEL, DEM_WALL },        { "floor", DEM_VESSEL, DEM_ENDS },
};
enum { SURFACE_NAMES = sizeof surface_names / sizeof *surface_names };

bool surface_is_there(const dem_scene_definition *scene, dem_surface surface)
{
    switch (surface) {
    case DEM_ENDS:
        return scene->container == DEM_CYLINDER || scene->container == DEM_VESSEL
               || (scene->container == DEM_DRUM && scene->ends.are_walls);
    case DEM_LIFTERS: return scene->lifters.count > 0;
    case DEM_LINING: return scene->lining.diameter > 0;
    case DEM_PLATE: return scene->container == DEM_TUBE_ON_PLATE;
    default: return true;
    }
}

bool partner_is_there(const dem_scene_definition *scene, size_t partner)
{
    return partner < DEM_MAXIMUM_SPECIES ? partner < scene->species_count
                                         : surface_is_there(scene, (dem_surface)(partner - DEM_MAXIMUM_SPECIES));
}

bool is_surface_name(const char *name)
{
    for (size_t k = 0; k < SURFACE_NAMES; k++)
        if (strcmp(surface_names[k].name, name) == 0) return true;
    return false;
}

int material_index(const scene_inputs *inputs, const char *name)
{
    for (size_t k = 0; *name && k < inputs->material_count; k++)
        if (strcmp(inputs->materials[k].name, name) == 0) return (int)k;
    return NO_PARTNER;
}

int surface_index(const dem_scene_definition *scene, const char *name)
{
    for (size_t k = 0; k < SURFACE_NAMES; k++)
        if (surface_names[k].kind == scene->container && strcmp(surface_names[k].name, name) == 0)
            return (int)surface_names[k].surface;
    return NO_PARTNER;
}

static void add_name(char *text, size_t size, const char *name)
{
    const size_t length = strlen(text);
    snprintf(text + length, size - length, "%s\"%s\"", length ? ", " : "", name);
}

void partner_names(const scene_inputs *inputs, const dem_scene_definition *scene, char *text, size_t size)
{
    *text = '\0';
    for (size_t k = 0; k < inputs->material_count; k++) add_name(text, size, inputs->materials[k].name);
    for (size_t k = 0; scene && k < SURFACE_NAMES; k++)
        if (surface_names[k].kind == scene->container && surface_is_there(scene, surface_names[k].surface))
            add_name(text, size, surface_names[k].name);
}
