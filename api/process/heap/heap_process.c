/* The heap below a lifted tube as a process. */
#include "heap_process.h"

const process_type heap_process = {
    .name = "heap",
    .title = "Heap below a raised tube",
    .description = "A tube full of particles, standing on a plate, is raised slowly: the angle of the heap that forms, under four "
                   "definitions and over 16 azimuths, its shape, and what the plate loses. SI units; angles in degrees.",
    .inputs_at = offsetof(job_spec, inputs),
    PROCESS_PARTS(heap),
};
