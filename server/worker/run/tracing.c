#include "tracing.h"

#include <stdlib.h>
#include <string.h>

#include "mirror.h"
#include "tracers_file.h"

#define TRACING_NAME "tracers"

dem_status tracing_begin(tracing *t, const job_spec *spec, size_t samples)
{
    tracing_clear(t);
    t->count = spec->inputs.tracer_count;
    t->width = 1 + DEM_TRACER_NUMBERS * t->count;
    for (size_t k = 0; k < t->count; k++) t->particle[k] = (int32_t)spec->inputs.tracer[k];
    if (t->count > 0) t->rows = calloc(samples, t->width * sizeof *t->rows);
    return t->count == 0 || t->rows ? DEM_OK : DEM_NO_MEMORY;
}

void tracing_clear(tracing *t)
{
    free(t->rows);
    *t = (tracing){ 0 };
}

void tracing_take(tracing *t, const dem_scene *scene, size_t sample)
{
    if (t->count == 0) return;
    double *row = t->rows + sample * t->width;
    row[0] = dem_scene_time(scene);
    dem_tracers_measure(scene, t->particle, t->count, row + 1);
}

dem_status tracing_save(const tracing *t, size_t samples, dem_state *state)
{
    if (t->count == 0) return DEM_OK;
    double *copy = malloc((samples * t->width + 1) * sizeof *copy);
    if (!copy || state->array_count == DEM_STATE_ARRAYS) {
        free(copy);
        return DEM_NO_MEMORY;
    }
    memcpy(copy, t->rows, samples * t->width * sizeof *copy);
    state->array[state->array_count++] = (dem_state_array){ TRACING_NAME, DEM_FLOAT64, samples, t->width, copy };
    return DEM_OK;
}

bool tracing_restore(tracing *t, size_t samples, const dem_state *state)
{
    if (t->count == 0 || samples == 0) return true;
    for (size_t k = 0; k < state->array_count; k++) {
        const dem_state_array *a = &state->array[k];
        if (strcmp(a->name, TRACING_NAME) != 0 || a->element != DEM_FLOAT64 || a->rows != samples || a->columns != t->width)
            continue;
        memcpy(t->rows, a->data, samples * t->width * sizeof *t->rows);
        return true;
    }
    return false;
}

static void mirror_row(tracing *t, double *row)
{
    for (size_t k = 0; k < t->count; k++) {
        double *numbers = row + 1 + DEM_TRACER_NUMBERS * k;
        mirror_vectors(numbers, 2);
        mirror_spins(numbers + 6, 1);
    }
}

bool tracing_write(tracing *t, const job_spec *spec, size_t samples, const char *params)
{
    if (t->count == 0) return true;
    for (size_t k = 0; spec->is_mirrored && k < samples; k++) mirror_row(t, t->rows + k * t->width);
    const bool written = tracers_file_write(t->particle, t->count, t->rows, samples, params);
    for (size_t k = 0; spec->is_mirrored && k < samples; k++) mirror_row(t, t->rows + k * t->width);
    return written;
}
