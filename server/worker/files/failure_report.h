/* How a failure of the core is told: a sentence, an event, an exit code. */
#ifndef FAILURE_REPORT_H
#define FAILURE_REPORT_H

#include "dem.h"
#include "event_log.h"
#include "job_folder.h"

/* Writes the failure event, and says the same in the log. failure: NULL when there is no more to say than the
 * status. */
enum worker_exit failure_report(event_log *events, dem_status status, const dem_failure *failure);

/* The same in other words than the core's. */
enum worker_exit failure_report_as(event_log *events, dem_status status, const char *message);

/* A file of the job folder could not be written: the failure event says so, for whoever reads the events alone. */
enum worker_exit failure_report_disk(event_log *events, const char *name);

#endif
