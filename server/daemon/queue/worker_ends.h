/* What the end of a worker means for its job. */
#ifndef WORKER_ENDS_H
#define WORKER_ENDS_H

#include "dispatcher.h"

/* Whether the worker ended for want of something of the machine; then slot->trouble says of what. */
bool worker_end_is_of_the_machine(const job_dispatcher *dispatcher, worker_slot *slot);
/* STORE_CONFLICT: the job is not this worker's any more. Anything but that and STORE_OK: try again later. */
store_status worker_end_record(job_dispatcher *dispatcher, worker_slot *slot);

#endif
