/* What the end of a worker means for its job. */
#ifndef WORKER_ENDS_H
#define WORKER_ENDS_H

#include "dispatcher.h"

/* Processes that the machine has killed for want of memory since it was started; -1: unknown. */
int64_t worker_end_oom_kills(void);
/* Whether the worker ended for want of something of the machine; then slot->trouble says of what. */
bool worker_end_is_of_the_machine(const job_dispatcher *dispatcher, worker_slot *slot);
/* STORE_CONFLICT: the job is not this worker's any more. Anything but that and STORE_OK: try again later. */
store_status worker_end_record(job_dispatcher *dispatcher, worker_slot *slot);

#endif
