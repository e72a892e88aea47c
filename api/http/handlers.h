/* One function an address. Each fills the response completely; none keeps anything of the request. */
#ifndef HANDLERS_H
#define HANDLERS_H

#include "plan_store.h"
#include "routes.h"

enum { LONGEST_WAIT = 60 }; /* s that a request may wait for a job */

/* handlers_service.c */
route_handler show_landing, show_conformance, show_asset, show_vendor_asset, show_health, show_readiness, show_metrics;
route_handler list_problems, show_problem;
/* handlers_api.c */
route_handler show_api;
/* handlers_processes.c */
route_handler list_processes, show_process, execute_process;
/* handlers_jobs.c */
route_handler list_jobs, show_job, remove_job, retry_job, pin_job, unpin_job;
/* handlers_jobs_csv.c */
void respond_jobs_csv(api_service *service, const http_request *request, http_response *response, const job_filter *filter);
/* handlers_batch.c */
route_handler cancel_jobs, delete_jobs;
/* handlers_examples.c */
route_handler list_examples, show_example;
/* handlers_results.c */
route_handler show_results, show_output, show_spec, show_log;
/* handlers_series.c */
route_handler list_samples, list_snapshots;
/* handlers_samples.c */
route_handler respond_thinned_samples;
/* handlers_snapshots.c */
route_handler send_snapshot, send_frames;
/* handlers_files.c */
route_handler send_fields, send_fields_text, send_tracers, send_tracers_table, send_walls, send_snapshot_series, send_picture,
    send_archive;
/* handlers_events.c */
route_handler send_events;
/* handlers_studies.c */
route_handler create_study, list_studies, show_study, remove_study, retry_study, show_study_results, show_study_csv,
    show_study_spec;
/* handlers_calibrations.c */
route_handler create_calibration, list_calibrations, show_calibration, remove_calibration, retry_calibration, show_calibration_spec;
/* handlers_calibration_results.c */
route_handler show_calibration_results, show_calibration_csv;
/* handlers_beds.c */
route_handler create_bed, list_beds, show_bed, remove_bed;
/* handlers_continue.c */
route_handler continue_job;
/* handlers_session.c */
route_handler begin_session, end_session;
/* handlers_query.c */
route_handler run_query;
/* handlers_tables.c */
route_handler show_tables;
/* "; job has id, ...": what there is instead of the table or column that a problem says there is not; owned by the caller, NULL: the
 * problem is another. */
char *names_for_error(api_service *service, const char *sql, const char *problem);

/* handlers_processes.c: adds the job of this request, and answers with it; or there are problems, and nothing is answered. */
void execute_document(api_service *service, const http_request *request, http_response *response, json_t *document,
                      problem_list *problems);

/* For the store's refusals, so that each handler says only what it wanted: "read the job". */
/* The same of something that was to be added: on a full disk it tells what would make room, and how much. */
void respond_not_kept(api_service *service, http_response *response, store_status status, const char *wanted);
void respond_store_failure(http_response *response, store_status status, const char *wanted);
void respond_no_such_job(http_response *response, const char *id);
/* The results of an ended job as its request and this one want them; failed: the status that tells of a failed job. */
void respond_results(api_service *service, const http_request *request, http_response *response, const job_record *job, int failed);
/* Finds the job, or the calibration, named by the first segment; false: the response says why not. */
bool find_plan(api_service *service, const http_request *request, http_response *response, plan_record *plan);
bool find_job(api_service *service, const http_request *request, http_response *response, job_record *job);

/* Shared between handlers of lists: the address of this list with the filters it was asked with; cursor NULL: as it was
 * asked. And of tables: is CSV asked for? */
json_t *list_link(const http_request *request, const char *rel, const char *cursor);
bool wants_csv(const http_request *request);
/* The page shows it: true, and the answer leads there, where f=html asks for that. printf-like. */
bool leads_to_page(const http_request *request, http_response *response, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* The file name under which the answer may be kept, which begins with the id of the job or study; see http_response. */
void name_file(http_response *response, const char *id, const char *end, bool is_attachment);
/* The query of GET /jobs (job_filter.c); what is wrong with it goes into the list. */
void read_job_filter(api_service *service, const http_request *request, job_filter *filter, problem_list *problems);
void respond_bad_parameters(http_response *response, const problem_list *problems);
/* Shared between handlers that take a document. parse_body: NULL, and the response says why. */
json_t *parse_body(const http_request *request, http_response *response);
uint64_t choose_seed(void);
/* Shared between handlers of DELETE. ?only=dismiss keeps what has ended, ?only=delete lets go on what has not. False: it is
 * neither, and the response says so. */
typedef struct removal {
    bool may_dismiss, may_delete;
} removal;
bool read_removal(const http_request *request, http_response *response, removal *asked);

#endif
