/* What the end of a worker means for its job. */
#ifndef WORKER_ENDS_H
#define WORKER_ENDS_H

#include "dispatcher.h"

/* STORE_CONFLICT: the job is not this worker's any more. Anything but that and STORE_OK: try again later. */
store_status worker_end_record(job_dispatcher *dispatcher, worker_slot *slot);

#endif
