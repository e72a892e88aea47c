/* The flow through an orifice as a process. */
#include "orifice_process.h"

const process_type orifice_process = {
    .name = "orifice",
    .title = "Flow through an orifice",
    .description =
        "A vessel full of particles, round or flat, whose orifice in a flat floor or below a hopper is opened at once: the mass "
        "flow with its error over its steady part, its fluctuation, whether and when it clogs, the angle of what is left, "
        "and solid fraction and velocity at the orifice. SI units; angles in degrees.",
    .inputs_at = offsetof(job_spec, inputs),
    PROCESS_PARTS(orifice),
};
