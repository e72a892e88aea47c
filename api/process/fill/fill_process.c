/* The filling of a cylinder as a process. */
#include "fill_process.h"

const process_type fill_process = {
    .name = "fill",
    .title = "Filling a cylinder",
    .description = "A stream of particles falls into a standing cylinder at a given speed: the mound that it leaves, while it "
                   "runs and at rest, the surface, and the packing of the bed. SI units; angles in degrees.",
    .inputs_at = offsetof(job_spec, inputs),
    PROCESS_PARTS(fill),
};
