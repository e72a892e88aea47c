#include "handlers.h"

const http_route route_table[] = {
    { "GET", "/", " status q study cursor open ", show_landing, .open = true }, /* read by the page: what it shows */
    { "GET", "/web/{}", "", show_asset, .open = true },
    { "GET", "/conformance", "", show_conformance, .open = true },
    { "GET", "/api", "", show_api, .open = true },
    { "GET", "/processes", "", list_processes, .open = true },
    { "GET", "/processes/{}", "", show_process, .open = true },
    { "POST", "/processes/{}/execution", "", execute_process, .open = false },
    { "GET", "/jobs", " status processID limit cursor q study ", list_jobs, .open = false },
    { "GET", "/jobs/{}", " wait ", show_job, .open = false },
    { "DELETE", "/jobs/{}", "", dismiss_job, .open = false },
    { "GET", "/jobs/{}/results", "", show_results, .open = false },
    { "GET", "/jobs/{}/spec", "", show_spec, .open = false },
    { "GET", "/jobs/{}/log", "", show_log, .open = false },
    { "GET", "/jobs/{}/samples", " after limit format ", list_samples, .open = false },
    { "GET", "/jobs/{}/snapshots", " after limit ", list_snapshots, .open = false },
    { "GET", "/jobs/{}/snapshots/{}", "", send_snapshot, .open = false },
    { "GET", "/jobs/{}/fields.hdf", "", send_fields, .open = false },
    { "GET", "/studies", " limit cursor ", list_studies, .open = false },
    { "POST", "/studies", "", create_study, .slow = true },
    { "GET", "/studies/{}", " wait ", show_study, .open = false },
    { "DELETE", "/studies/{}", "", dismiss_study, .open = false },
    { "GET", "/studies/{}/results", " format ", show_study_results, .open = false },
    { "GET", "/studies/{}/results.csv", "", show_study_csv, .open = false },
    { "GET", "/studies/{}/spec", "", show_study_spec, .open = false },
    { "GET", "/query", " sql format ", run_query, .slow = true },
    { "GET", "/healthz", "", show_health, .open = true },
    { "GET", "/readyz", "", show_readiness, .open = true },
    { "GET", "/metrics", "", show_metrics, .open = false },
};
const size_t route_count = sizeof route_table / sizeof route_table[0];
