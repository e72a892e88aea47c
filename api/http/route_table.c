#include "handlers.h"

const http_route route_table[] = {
    { "GET", "/", " status q study cursor open f ", show_landing, .formats = " json html ",
      .open = true }, /* read by the page: what it shows */
    { "GET", "/web/{}", "", show_asset, .open = true },
    { "GET", "/conformance", " f ", show_conformance, .open = true },
    { "GET", "/api", " f version ", show_api, .formats = " json yaml ", .open = true },
    { "GET", "/problems", " f ", list_problems, .open = true },
    { "GET", "/problems/{}", " f ", show_problem, .open = true },
    { "GET", "/processes", " limit cursor f ", list_processes, .open = true },
    { "GET", "/processes/{}", " f ", show_process, .open = true },
    { "POST", "/processes/{}/execution", " f ", execute_process, .open = false },
    { "GET", "/jobs", " status* processID* type* datetime minDuration maxDuration limit cursor q study f ", list_jobs,
      .formats = " json html " },
    { "GET", "/jobs/{}", " wait f ", show_job, .formats = " json html " },
    { "DELETE", "/jobs/{}", " only f ", remove_job, .open = false },
    { "POST", "/jobs/{}/retry", " f ", retry_job, .bodiless = true },
    { "GET", "/jobs/{}/results", " f ", show_results, .open = false },
    { "GET", "/jobs/{}/spec", " f ", show_spec, .open = false },
    { "GET", "/jobs/{}/log", "", show_log, .open = false },
    { "GET", "/jobs/{}/samples", " after limit format f ", list_samples, .formats = " json csv " },
    { "GET", "/jobs/{}/snapshots", " after limit f ", list_snapshots, .open = false },
    { "GET", "/jobs/{}/snapshots/{}", "", send_snapshot, .open = false },
    { "GET", "/jobs/{}/fields.hdf", "", send_fields, .open = false },
    { "GET", "/studies", " limit cursor f ", list_studies, .formats = " json html " },
    { "POST", "/studies", " f ", create_study, .slow = true },
    { "GET", "/studies/{}", " wait f ", show_study, .formats = " json html " },
    { "DELETE", "/studies/{}", " only f ", remove_study, .slow = true },
    { "GET", "/studies/{}/results", " format limit f ", show_study_results, .formats = " json csv " },
    { "GET", "/studies/{}/results.csv", "", show_study_csv, .open = false },
    { "GET", "/studies/{}/spec", " f ", show_study_spec, .open = false },
    { "GET", "/query", " sql format f ", run_query, .formats = " json csv ", .slow = true },
    { "GET", "/healthz", " f ", show_health, .open = true },
    { "GET", "/readyz", " f ", show_readiness, .open = true },
    { "GET", "/metrics", "", show_metrics, .open = false },
};
_Static_assert(sizeof route_table / sizeof route_table[0] <= MOST_ROUTES, "what is counted by route has no room for all of them");
const size_t route_count = sizeof route_table / sizeof route_table[0];
