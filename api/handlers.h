/* One function an address. Each fills the response completely; none keeps anything of the request. */
#ifndef HANDLERS_H
#define HANDLERS_H

#include "routes.h"

/* handlers_service.c */
route_handler show_landing, show_conformance, show_api, show_asset, show_health, show_readiness, show_metrics;
/* handlers_processes.c */
route_handler list_processes, show_process, execute_process;
/* handlers_jobs.c */
route_handler list_jobs, show_job, dismiss_job;
/* handlers_results.c */
route_handler show_results, show_spec, show_log;
/* handlers_series.c */
route_handler list_samples, list_snapshots, send_snapshot;
/* handlers_query.c */
route_handler run_query;

/* For the store's refusals, so that each handler says only what it wanted: "read the job". */
void respond_store_failure(http_response *response, store_status status, const char *wanted);
void respond_no_such_job(http_response *response, const char *id);
/* Finds the job named by the first segment; false: the response says why not. */
bool find_job(api_service *service, const http_request *request, http_response *response, job_record *job);

#endif
