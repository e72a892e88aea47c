/* Studies of up to some twenty jobs: each case of one that is accepted has a name, inputs and jobs that are accepted by
 * themselves. */
#include <string.h>

#include "fuzz.h"
#include "json_text.h"
#include "study_spec.h"

enum { MOST_JOBS = 20 };

static void job_is_accepted(const study_spec *study, size_t index, int repeat)
{
    problem_list problems;
    job_spec spec;
    json_t *request = study_job_request(study, index, repeat);
    CLAIM(request && problem_list_init(&problems));
    CLAIM(job_spec_parse(study->process, request, 0, &spec, &problems));
    job_spec_clear(&spec);
    problem_list_clear(&problems);
    json_decref(request);
}

static void accepted(const study_spec *study, const study_estimate *estimate)
{
    CLAIM(study->cases >= 1 && study->repeats >= 1 && (double)study->cases * study->repeats <= MOST_JOBS);
    for (size_t i = 0; i < study->cases; i++) {
        char name[STUDY_NAME_SIZE];
        study_case_name(study, i, name);
        CLAIM(strlen(name) < sizeof name);
        json_t *inputs = study_case_inputs(study, i);
        CLAIM(json_is_object(inputs));
        json_decref(inputs);
        job_is_accepted(study, i, study->repeats - 1);
    }
    json_t *told = study_estimate_to_json(estimate);
    CLAIM(told);
    json_decref(told);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    static const study_options options = { .seed_if_missing = 3, .default_threads = 1, .most_jobs = MOST_JOBS };
    problem_list problems, warnings;
    CLAIM(problem_list_init(&problems) && problem_list_init(&warnings));
    json_t *document = json_text_load((const char *)bytes, size, &problems);
    if (document) {
        study_spec study;
        study_estimate estimate;
        const bool parsed = study_spec_parse(document, &options, &study, &problems);
        const bool checked = study_check(&study, NULL, NULL, &estimate, &problems, &warnings);
        if (parsed && checked) accepted(&study, &estimate);
        else CLAIM(!problem_list_is_empty(&problems));
        study_spec_clear(&study);
    }
    json_decref(document);
    problem_list_clear(&problems);
    problem_list_clear(&warnings);
    return 0;
}
