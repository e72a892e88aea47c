/* What stands under gravity down the z axis: a heap on a plate, and the bed in a standing cylinder. Their results, and
 * the measures as functions of spheres alone, wherever these come from. Definitions: core/NUMERICS.md, "Mounds". */
#ifndef DEM_MOUND_H
#define DEM_MOUND_H

#include "dem.h"

enum { DEM_AZIMUTHS = 16, DEM_PROFILE_POINTS = 128 };

/* The spheres that make the mound up, n of them. Those in flight are the caller's to leave out. */
typedef struct dem_mound {
    size_t count;
    const double *position; /* (n,3) m; the axis is x = y = 0, the ground z = 0 */
    const double *radius;   /* (n) m */
    const double *volume;   /* (n) m3 of solid; of a cluster's sphere its share of the cluster */
    double grain;           /* m: mean diameter of the particles */
} dem_mound;

/* Numbers over a coordinate; where one could not be told, NaN. */
typedef struct dem_profile {
    size_t count;
    double place[DEM_PROFILE_POINTS], value[DEM_PROFILE_POINTS], standard_error[DEM_PROFILE_POINTS];
} dem_profile;

typedef enum dem_heap_method {
    DEM_AZIMUTHAL_FIT, /* line through the surface between 80 and 20 % of its height, in each of 16 sectors */
    DEM_APEX_TO_BASE,  /* cone of the height of the highest particle, and the base of each sector */
    DEM_EQUAL_VOLUME,  /* cone of the volume and base of each sector */
    DEM_SILHOUETTE,    /* triangle of the area and base of the outline, seen from 16 sides */
    DEM_HEAP_METHODS
} dem_heap_method;

typedef struct dem_heap_results {
    dem_angle angle[DEM_HEAP_METHODS]; /* over the azimuths; only azimuthal-fit can tell its error */
    double height;                     /* m, of the highest particle's top */
    double base_diameter;              /* m, mean over the azimuths */
    double volume;                     /* m3 below the surface */
    double static_cohesive_index;      /* m: mean over the radius of the standard deviation over azimuths of the height */
    double solid_fraction;             /* of that volume */
    dem_profile surface;               /* m over m from the axis */
} dem_heap_results;

typedef enum dem_fill_method {
    DEM_RADIAL_FIT,     /* line through the surface between 20 and 80 % of the radius, in each of 16 sectors */
    DEM_CENTER_TO_WALL, /* from the mean height within 20 % of the radius to that beyond 80 % */
    DEM_AREA_FIT,       /* line through the whole surface of each sector, but half a grain at the wall */
    DEM_FILL_METHODS
} dem_fill_method;

typedef struct dem_fill_results {
    dem_angle angle[DEM_FILL_METHODS]; /* over the azimuths; negative where the middle is lower; likewise radial-fit */
    double height;                     /* m, mean of the surface */
    double center_height, wall_height; /* m, means within 20 and beyond 80 % of the radius */
    double solid_fraction;             /* of the core: two grains off wall, floor and surface */
    dem_profile surface;               /* m over m from the axis */
    dem_profile packing;               /* solid fraction over m above the floor; its error is not told */
} dem_fill_results;

/* plate_radius: m; the heap ends there at the latest. What is below the rim, or half a grain, is no part of slopes and
 * cones. Measures that fail (a heap of a few grains) are NaN. Errors: DEM_NO_MEMORY. */
dem_status dem_heap_measure(const dem_mound *mound, double plate_radius, double rim_height, dem_heap_results *results);
/* cylinder_radius: m. Likewise. */
dem_status dem_fill_measure(const dem_mound *mound, double cylinder_radius, dem_fill_results *results);

/* What a scene of either kind has beside its shape. */
typedef struct dem_standing {
    double coordination_number; /* contacts a particle, of those that are not in flight */
    double tension_share;       /* of the contacts between spheres, that pull; NaN: nothing coheres */
    size_t inside;              /* in the heap: of at least two contacts; in the bed: joined to the floor by the others */
    size_t in_flight;           /* or lying by themselves on the plate */
    size_t lost, waiting;       /* fell off the plate; did not yet enter */
    double kinetic_energy;      /* J */
    bool at_rest;               /* below 1e-4 of the energy that the particles' fall through one diameter would give */
} dem_standing;

/* Frames, as of a drum (dem.h): all of their numbers have names. */
enum { DEM_HEAP_FRAME = 13, DEM_FILL_FRAME = 11 };
const char *dem_heap_frame_name(size_t index); /* NULL beyond the last */
const char *dem_fill_frame_name(size_t index);
dem_status dem_heap_frame_measure(dem_scene *scene, double *frame);
dem_status dem_fill_frame_measure(dem_scene *scene, double *frame);
/* Whether the last frames of `count` show that all is done and at rest: the tube clear of the heap, the stream ended. */
bool dem_heap_is_over(const double *frames, size_t count);
bool dem_fill_is_over(const double *frames, size_t count);

/* Of the present state; of a fill the frames' mean angle from when half of the particles were in to when all were, too. */
dem_status dem_heap_scene_measure(const dem_scene *scene, dem_heap_results *results, dem_standing *standing);
dem_status dem_fill_scene_measure(const dem_scene *scene, const double *frames, size_t count, dem_fill_results *results,
                                  dem_angle *while_filling, dem_standing *standing);

const char *dem_heap_method_name(dem_heap_method method); /* "azimuthal-fit", ... */
const char *dem_fill_method_name(dem_fill_method method); /* "radial-fit", ... */

#endif
