/* The rotating drum as a process. */
#include "drum_process.h"

const process_type drum_process = {
    .name = "drum",
    .title = "Rotating drum",
    .description = "A horizontal drum, part full of particles, turns about its axis: dynamic angle of repose, flow "
                   "regime, segregation and packing of the bed. SI units; angles in degrees.",
    .inputs_at = offsetof(job_spec, inputs),
    PROCESS_PARTS(drum),
};
