/* Specifications of jobs: one that is accepted is written as a text that reads back as itself, and one that is not has a
 * problem. A run may start from the bed of "bed", a specification beside the inputs. */
#include <string.h>

#include "fuzz.h"
#include "job_spec.h"
#include "json_text.h"

static json_t *find_bed(void *context, const start_inputs *start, double *particles, problem_list *problems)
{
    json_t *bed = json_object_get(context, "bed");
    *particles = 100;
    if (!bed) problem_list_add(problems, "/inputs/start/job", "is \"%.40s\", which has no bed", start->job);
    return json_incref(bed);
}

static void reads_back(const char *text)
{
    problem_list problems;
    job_spec spec;
    CLAIM(problem_list_init(&problems));
    json_t *document = json_loads(text, JSON_REJECT_DUPLICATES, NULL);
    CLAIM(document && job_spec_parse(NULL, document, 9, &spec, &problems));
    char *again = job_spec_to_text(&spec);
    CLAIM(again && strcmp(again, text) == 0);
    free(again);
    job_spec_clear(&spec);
    json_decref(document);
    problem_list_clear(&problems);
}

static void is_told(json_t *document)
{
    CLAIM(document);
    json_decref(document);
}

static void accepted(const job_spec *spec)
{
    char *text = job_spec_to_text(spec), *brief = job_spec_to_brief(spec);
    CLAIM(text && brief);
    reads_back(text);
    free(text);
    free(brief);
    const job_estimate estimate = job_spec_estimate(spec, NULL);
    is_told(job_estimate_to_json(&estimate));
    is_told(job_spec_warnings(spec, NULL));
    is_told(job_spec_understood(spec, NULL));
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    problem_list problems;
    job_spec spec;
    CLAIM(problem_list_init(&problems));
    json_t *document = json_text_load((const char *)bytes, size, &problems);
    const start_source beds = { .find = find_bed, .context = document };
    if (document && job_spec_parse_with(&beds, NULL, document, 7, &spec, &problems)) {
        accepted(&spec);
        job_spec_clear(&spec);
    } else {
        CLAIM(!problem_list_is_empty(&problems));
    }
    json_decref(document);
    problem_list_clear(&problems);
    return 0;
}
