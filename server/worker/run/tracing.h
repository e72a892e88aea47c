/* The paths of a few particles, taken with each sample of a run's first bed and kept with its checkpoint. */
#ifndef TRACING_H
#define TRACING_H

#include "dem.h"
#include "job_spec.h"

typedef struct tracing {
    int32_t particle[MOST_TRACERS]; /* ids */
    size_t count;                   /* 0: none are followed */
    size_t width;                   /* of a row: time in s, and what dem_tracers_measure gives */
    double *rows;                   /* (samples, width) */
} tracing;

/* In the place of what there may be. Errors: DEM_NO_MEMORY. */
dem_status tracing_begin(tracing *tracing, const job_spec *spec, size_t samples);
void tracing_clear(tracing *tracing);
void tracing_take(tracing *tracing, const dem_scene *scene, size_t sample);
/* As one more array of the state, of the rows so far. Errors: DEM_NO_MEMORY. */
dem_status tracing_save(const tracing *tracing, size_t samples, dem_state *state);
/* False: the state has other rows. */
bool tracing_restore(tracing *tracing, size_t samples, const dem_state *state);
/* The files, mirrored where the scene is. False: the disk, or no memory. */
bool tracing_write(tracing *tracing, const job_spec *spec, size_t samples, const char *params);

#endif
