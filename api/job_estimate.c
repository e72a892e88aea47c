/* What a job will cost. Each process has its own way of telling. */
#include <math.h>

#include "process_type.h"

job_estimate job_spec_estimate(const job_spec *spec, const calibration *machine)
{
    return spec->type->estimate(spec, machine);
}

json_t *job_estimate_to_json(const job_estimate *estimate)
{
    const struct {
        const char *name;
        double value;
        bool whole;
    } members[] = {
        { "particles", estimate->particles, true },
        { "steps", estimate->steps, true },
        { "time_step", estimate->time_step, false },
        { "stiffness", estimate->stiffness, false },
        { "simulated_seconds", estimate->simulated_seconds, false },
        { "wall_seconds", estimate->wall_seconds, false },
        { "memory_bytes", estimate->memory_bytes, true },
        { "snapshots", estimate->snapshots, true },
        { "snapshot_bytes", estimate->snapshot_bytes, true },
    };
    json_t *document = json_object();
    for (size_t m = 0; m < sizeof members / sizeof members[0]; m++) {
        if (isnan(members[m].value)) continue;
        json_object_set_new(document, members[m].name,
                            members[m].whole ? json_integer((json_int_t)members[m].value) : json_real(members[m].value));
    }
    return document;
}
