#include "study_report.h"

#include "study_spec.h"

enum { MOST_JOBS = 1000000 }; /* a daemon's own limit may be lower */

bool study_report_is_study(const json_t *document) { return json_object_get(document, "base") != NULL; }

static json_t *cases_of(const study_spec *study)
{
    json_t *cases = json_array();
    for (size_t i = 0; i < study->cases; i++) {
        char name[STUDY_NAME_SIZE];
        study_case_name(study, i, name);
        json_array_append_new(cases, json_pack("{s:s, s:o}", "case", name, "inputs", study_case_inputs(study, i)));
    }
    return cases;
}

json_t *study_report(const json_t *document, const start_source *beds, uint64_t seed_if_missing, const calibration *machine,
                     problem_list *problems)
{
    const study_options options = {
        .seed_if_missing = seed_if_missing, .default_threads = 1, .most_jobs = MOST_JOBS, .beds = beds
    };
    study_spec study;
    study_estimate estimate;
    json_t *report = NULL;
    problem_list warnings;
    problem_list_init(&warnings);
    study_spec_parse(document, &options, &study, problems);
    if (study_check(&study, machine, NULL, &estimate, problems, &warnings))
        report = json_pack("{s:s, s:o, s:i, s:o, s:o}", "name", study.name, "cases", cases_of(&study), "repeats", study.repeats,
                           "estimate", study_estimate_to_json(&estimate), "warnings", job_warnings_to_json(&warnings));
    problem_list_clear(&warnings);
    study_spec_clear(&study);
    return report;
}
