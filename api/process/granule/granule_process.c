/* One particle on the wall of a rotating cylinder as a process. There is little to derive and little to pay. */
#include "granule_process.h"

#include <math.h>

#include "scene_warnings.h"

/* Bisection follows some 35 motions of a few revolutions. Most of it is starting: eleven jobs took 0.05 s in the mean. */
#define WALL_SECONDS 0.05
#define MEMORY_BYTES 20e6

static void apply_rules(job_spec *spec, uint64_t seed_if_missing, problem_list *problems)
{
    (void)seed_if_missing, (void)problems; /* nothing is random, and every combination of its inputs makes sense */
    granule_inputs *inputs = &spec->granule_inputs;
    const double rpm = inputs->rotation_rate_rpm;
    if (!isnan(rpm)) inputs->rotation_rate = rotation_of_rpm(rpm);
    inputs->rotation_rate_rpm = NAN;
    spec->threads = 1;
    spec->bed_count = 1;
    spec->granule = (dem_granule_definition){
        .friction = inputs->friction,
        .radius = inputs->radius,
        .gravity = inputs->gravity,
        .rotation_rate = fabs(inputs->rotation_rate), /* the other way is the mirror image */
        .revolutions = isnan(inputs->revolutions) ? 1 : (int)inputs->revolutions,
        .tolerance = inputs->tolerance,
    };
}

static job_estimate estimate(const job_spec *spec, const calibration *machine)
{
    (void)spec, (void)machine;
    return (job_estimate){
        .particles = 1,
        .wall_seconds = WALL_SECONDS,
        .memory_bytes = MEMORY_BYTES,
        .snapshots = 0,
        .snapshot_bytes = 0,
        .steps = NAN,
        .simulated_seconds = NAN,
        .settling_seconds = NAN,
        .settling_seconds_low = NAN,
        .settling_seconds_high = NAN,
        .time_step = NAN,
        .stiffness = NAN,
    };
}

static void understand(const job_spec *spec, json_t *words)
{
    const granule_inputs *granule = &spec->granule_inputs;
    if (!isnan(granule->rotation_rate))
        rotation_understand(granule->rotation_rate, froude_number(granule->rotation_rate, granule->radius, granule->gravity),
                            words);
}

const process_type granule_process = {
    .name = "granule",
    .title = "One particle on the wall of a rotating cylinder",
    .description = "A frictional particle starts at the bottom of a horizontal cylinder, turning with it: the least rate "
                   "at which it keeps contact with the wall all the way round, how far it slips, and what becomes of it "
                   "at a given rate. SI units; angles in degrees.",
    .inputs = &granule_fields,
    .inputs_at = offsetof(job_spec, granule_inputs),
    .apply_rules = apply_rules,
    .estimate = estimate,
    .understand = understand,
    .results = &granule_result_fields,
};
