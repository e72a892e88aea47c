/* What flows out of a vessel through its orifice: results, and the measures over frames. Definitions: core/NUMERICS.md, "Flow through
 * an orifice". */
#ifndef DEM_FLOW_H
#define DEM_FLOW_H

#include "dem_mound.h"

/* NaN where it could not be measured. */
typedef struct dem_flow_results {
    dem_mean mass_rate;          /* kg/s, over the steady part */
    dem_mean number_rate;        /* 1/s */
    double number_fluctuation;   /* 1/s: standard deviation of the number flow over intervals of sqrt(D/g) */
    double steady_start;         /* s since the orifice was opened */
    double steady_end;           /* s */
    double batches;              /* of the steady part, that its error is told from */
    bool clogged;                /* what is left lies over the orifice, at rest */
    double clogged_at;           /* s: when the last particle left; NaN: it is not clogged */
    double last_left_at;         /* s: when the last particle left; NaN: none did */
    size_t passed, left;         /* particles */
    double passed_mass;          /* kg */
    double solid_fraction;       /* of the bed before the orifice was opened */
    double tension_share;        /* of the contacts between spheres, that pull, over the steady part; NaN: nothing coheres */
    bool at_rest;                /* as of dem_standing, but without spin */
    bool drained;                /* nothing is left that could fall through the orifice, and all is at rest */
    double drained_angle_deg[2]; /* of what is left on a flat floor: of a line through its surface, of a pit of its volume */
    double drained_volume;       /* m3, of its particles */
} dem_flow_results;

enum { DEM_FLOW_FRAME = 9 };
const char *dem_flow_frame_name(size_t index); /* NULL beyond the last */
dem_status dem_flow_frame_measure(dem_scene *scene, double *frame);

typedef enum dem_flow_end { DEM_FLOWS_ON, DEM_FLOW_DRAINED, DEM_FLOW_CLOGGED } dem_flow_end;
/* Whether the frames show that nothing will leave any more. */
dem_flow_end dem_flow_ended(const dem_scene *scene, const double *frames, size_t count);

/* A frame of the steady part: after the first transient, of a bed that is not low yet. */
bool dem_flow_is_steady(const dem_scene *scene, const double *frame);

/* Errors: DEM_NO_MEMORY. */
dem_status dem_flow_measure(const dem_scene *scene, const double *frames, size_t count, dem_flow_results *results);

/* Means over the steady part of solid fraction and velocity near the orifice: over the distance from its axis, or from the middle of
 * a slot, and the height. The caller keeps a table of dem_outlet_size numbers, all zero at first, adds to it with each frame, and asks
 * for the fields at the end. Errors: DEM_NO_MEMORY. */
size_t dem_outlet_size(const dem_scene *scene);
void dem_outlet_add(const dem_scene *scene, const double *frame, double *sums);

/* (rows, columns), columns outward from the middle, rows upward from the orifice; freed by the caller. */
typedef struct dem_outlet_grid {
    size_t columns, rows;
    double size;   /* m: side of a cell */
    double frames; /* that the means are over */
} dem_outlet_grid;
dem_outlet_grid dem_outlet_grid_of(const dem_scene *scene, const double *sums);
/* Each (rows, columns); outward and downward in m/s, NaN where no particle was. */
void dem_outlet_fields(const dem_scene *scene, const double *sums, double *solid_fraction, double *outward, double *downward);
/* Along the orifice itself: solid fraction, and the downward velocity. */
void dem_outlet_profile(const dem_scene *scene, const double *sums, dem_profile *solid_fraction, dem_profile *velocity);

#endif
