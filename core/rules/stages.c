/* The stages of a drum's rotation, as functions of time alone: so that a run which was interrupted finds its place. */
#include "dem_rules.h"

size_t dem_stage_at(const dem_scene_definition *d, double time, double *since)
{
    size_t k = 0;
    *since = 0;
    for (; k + 1 < d->stage_count && time >= *since + d->stage[k].seconds; k++) *since += d->stage[k].seconds;
    return k;
}

size_t dem_last_turning_stage(const dem_scene_definition *d, double *since)
{
    size_t last = d->stage_count;
    double begins = 0;
    *since = 0;
    for (size_t k = 0; k < d->stage_count; k++) {
        if (d->stage[k].rate != 0) last = k, *since = begins;
        begins += d->stage[k].seconds;
    }
    return last;
}
