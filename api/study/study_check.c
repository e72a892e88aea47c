/* Every job of a study read as a job's request is, and what is wrong told in terms of the study.
 *
 * A job's problem has a pointer into the job's request. It is the case's own where the case says something at that
 * place; it is the base's where the base alone has the very same problem (told once, not for each case); otherwise
 * base and case don't go together, and the case is named. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "json_pointer.h"
#include "process_type.h"
#include "spec_memory.h"
#include "study_spec.h"

/* s of processor time, ten times what ten thousand usual jobs take; and how long to look for more when something is wrong. */
#define MOST_SECONDS 60.0
#define MOST_SECONDS_OF_WRONG 5.0
#define SECONDS_BETWEEN_LOOKS 0.01

enum { ENOUGH_PROBLEMS = 100, LONG_POINTER = 2 * JSON_POINTER_SIZE };

static bool is_listed(const problem_list *problems, const char *pointer, const char *detail)
{
    size_t i;
    json_t *known;
    json_array_foreach(problems->errors, i, known)
    {
        if (strcmp(json_string_value(json_object_get(known, "pointer")), pointer) == 0
            && strcmp(json_string_value(json_object_get(known, "detail")), detail) == 0)
            return true;
    }
    return false;
}

static void add_once(problem_list *problems, const char *pointer, const char *detail)
{
    if (!is_listed(problems, pointer, detail)) problem_list_add(problems, pointer, "%s", detail);
}

/* Is the place below an input that is varied? Then pointer is that of the value: /vary/~1inputs~1fill_fraction/2. An
 * input that does not exist is wrong in its name, not in its values. */
static bool find_varied(const study_spec *study, size_t index, const char *place, const char *detail, char pointer[LONG_POINTER])
{
    for (size_t c = 0; c < json_array_size(study->columns); c++) {
        char varied[JSON_POINTER_SIZE + 8], head[JSON_POINTER_SIZE] = "/vary", value[24] = "";
        snprintf(varied, sizeof varied, "/inputs/%s", json_string_value(json_array_get(study->columns, c)));
        if (!json_pointer_is_within(place, varied) || !json_pointer_append(head, varied)) continue;
        const bool is_name = strcmp(place, varied) == 0 && strncmp(detail, "is not an input", 15) == 0;
        if (!is_name) snprintf(value, sizeof value, "/%zu", study_value_index(study, index, c));
        snprintf(pointer, LONG_POINTER, "%s%s%s", head, value, place + strlen(varied));
        return true;
    }
    return false;
}

static void tell(const study_spec *study, size_t index, const char *place, const char *detail, const problem_list *of_base,
                 problem_list *problems)
{
    char pointer[LONG_POINTER], name[STUDY_NAME_SIZE], combined[700];
    const json_t *cases = json_object_get(study->document, "cases");
    const bool varied = json_object_get(study->document, "vary") != NULL;
    const bool of_case = cases && json_pointer_find(json_array_get(cases, index), place);
    if (varied && find_varied(study, index, place, detail, pointer)) {
        add_once(problems, pointer, detail);
    } else if (!of_case && ((!cases && !varied) || is_listed(of_base, place, detail))) {
        snprintf(pointer, sizeof pointer, "/base%.*s", JSON_POINTER_SIZE, place);
        add_once(problems, pointer, detail);
    } else if (cases) {
        snprintf(pointer, sizeof pointer, "/cases/%zu%.*s", index, JSON_POINTER_SIZE, place);
        add_once(problems, pointer, detail);
    } else {
        study_case_name(study, index, name);
        snprintf(combined, sizeof combined, "with %s: %.100s %.380s", name, place, detail);
        add_once(problems, "/vary", combined);
    }
}

static void tell_all(const study_spec *study, size_t index, const problem_list *found, const problem_list *of_base,
                     problem_list *problems)
{
    size_t i;
    json_t *problem;
    json_array_foreach(found->errors, i, problem)
    {
        tell(study, index, json_string_value(json_object_get(problem, "pointer")),
             json_string_value(json_object_get(problem, "detail")), of_base, problems);
    }
    if (!found->errors) add_once(problems, "", "could not be checked: out of memory");
}

static void add_estimate(const study_spec *study, const job_spec *spec, const calibration *machine, study_estimate *estimate)
{
    const job_estimate one = job_spec_estimate(spec, machine);
    estimate->jobs += study->repeats;
    /* NaN: the process has no such thing. */
    if (one.steps > 0.0) estimate->steps += one.steps * study->repeats;
    if (one.wall_seconds > 0.0) estimate->wall_seconds += one.wall_seconds * study->repeats;
    if (one.snapshot_bytes > 0.0) estimate->snapshot_bytes += one.snapshot_bytes * study->repeats;
    estimate->disk_bytes += job_estimate_disk_bytes(&one) * study->repeats;
    if (one.memory_bytes > estimate->memory_bytes) estimate->memory_bytes = one.memory_bytes;
}

/* What is to be told of a study's jobs, and what of it its base has, too. */
typedef struct told {
    problem_list *all, of_base;
} told;

static void add_warnings(const study_spec *study, size_t index, const job_spec *spec, const calibration *machine, told *warnings)
{
    problem_list found;
    if (!warnings->all || json_array_size(warnings->all->errors) >= ENOUGH_PROBLEMS || !problem_list_init(&found)) return;
    job_spec_warn(spec, machine, &found);
    tell_all(study, index, &found, &warnings->of_base, warnings->all);
    problem_list_clear(&found);
}

/* One check: what it looks at, what it makes, and whether it goes on. */
typedef struct checking {
    const study_spec *study;
    const calibration *machine;
    const study_taker *taker;
    start_source source; /* the study's own, with a memory */
    study_estimate *estimate;
    told wrong, unusual;
    double started;   /* s of this thread's processor time */
    double next_look; /* at that and at its client, by the clock */
    bool refused;     /* by the taker, or its client has left */
} checking;

/* The repeats of a case that was read with the seed of the last. */
static void give_repeats(checking *check, job_spec *spec, size_t index)
{
    const int repeats = check->study->repeats;
    const double last = spec->inputs.seed;
    for (int repeat = 0; check->taker && repeat < repeats && !check->refused; repeat++) {
        if (check->study->has_seed) {
            spec->inputs.seed = last - (repeats - 1 - repeat);
            spec->scene.seed = (uint64_t)spec->inputs.seed;
        }
        check->refused = !check->taker->take(check->taker->context, spec, index, repeat);
    }
}

/* What the jobs together may take is known at the end. */
static void check_limits(checking *check, size_t index, const job_spec *spec)
{
    problem_list found;
    if (!check->taker || !check->taker->limits || !problem_list_init(&found)) return;
    const job_estimate one = job_spec_estimate(spec, check->machine);
    job_check_limits(check->taker->limits, "/inputs", NAN, one.particles, NAN, spec->threads, &found);
    job_resources_check_allowed(spec->resources, &check->taker->limits->resources, &found);
    tell_all(check->study, index, &found, &check->wrong.of_base, check->wrong.all);
    problem_list_clear(&found);
}

/* The last repeat stands for all: they differ in the seed alone, and its seed is the largest. */
static void check_case(checking *check, size_t index)
{
    const study_spec *study = check->study;
    job_spec spec;
    problem_list found;
    const json_t *cases = json_object_get(study->document, "cases");
    if (cases && !json_is_object(json_array_get(cases, index))) return; /* said already */
    json_t *request = study_job_request(study, index, study->repeats - 1);
    if (!request || !problem_list_init(&found)) {
        add_once(check->wrong.all, "", "could not be expanded: a case leads nowhere in the base, or out of memory");
        json_decref(request);
        return;
    }
    if (job_spec_parse_with(&check->source, NULL, request, 0, &spec, &found)) {
        add_estimate(study, &spec, check->machine, check->estimate);
        add_warnings(study, index, &spec, check->machine, &check->unusual);
        check_limits(check, index, &spec);
        if (problem_list_is_empty(check->wrong.all)) give_repeats(check, &spec, index);
        job_spec_clear(&spec);
    } else {
        tell_all(study, index, &found, &check->wrong.of_base, check->wrong.all);
    }
    problem_list_clear(&found);
    json_decref(request);
}

static double processor_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Both looks are calls of the system, and ten thousand of them are felt. */
static bool is_time_to_look(checking *check)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC_COARSE, &now);
    const double seconds = (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
    if (seconds < check->next_look) return false;
    check->next_look = seconds + SECONDS_BETWEEN_LOOKS;
    return true;
}

static bool goes_on(checking *check)
{
    if (check->refused || json_array_size(check->wrong.all->errors) >= ENOUGH_PROBLEMS) return false;
    if (!is_time_to_look(check)) return true;
    if (check->taker && client_has_left(check->taker->client)) check->refused = true;
    if (check->refused) return false;
    const double limit = problem_list_is_empty(check->wrong.all) ? MOST_SECONDS : MOST_SECONDS_OF_WRONG;
    if (processor_seconds() - check->started < limit) return true;
    if (limit == MOST_SECONDS)
        problem_list_add(check->wrong.all, "", "takes more than %g s to be checked; post it in parts", MOST_SECONDS);
    return false;
}

static void check_base(checking *check)
{
    job_spec spec;
    if (!job_spec_parse_with(&check->source, NULL, json_object_get(check->study->document, "base"), 0, &spec,
                             &check->wrong.of_base))
        return;
    job_spec_warn(&spec, check->machine, &check->unusual.of_base);
    job_spec_clear(&spec);
}

bool study_check(const study_spec *study, const calibration *machine, const study_taker *taker, study_estimate *estimate,
                 problem_list *problems, problem_list *warnings)
{
    *estimate = (study_estimate){ .jobs = 0.0 };
    checking check = {
        .study = study, .machine = machine, .taker = taker, .estimate = estimate, .wrong.all = problems, .unusual.all = warnings
    };
    if (!problem_list_init(&check.wrong.of_base) || !problem_list_init(&check.unusual.of_base)) {
        problem_list_clear(&check.wrong.of_base);
        problem_list_add(problems, "", "could not be checked: out of memory");
        return false;
    }
    if (study->beds) check.source = *study->beds;
    check.source.memory = spec_memory_create();
    check.source.client = taker ? taker->client : NULL;
    check_base(&check);
    for (size_t i = 0; i < study->cases && goes_on(&check); i++) check_case(&check, i);
    spec_memory_free(check.source.memory);
    problem_list_clear(&check.wrong.of_base);
    problem_list_clear(&check.unusual.of_base);
    return problem_list_is_empty(problems) && !check.refused;
}

json_t *study_estimate_to_json(const study_estimate *estimate)
{
    char words[TIME_IN_WORDS_SIZE];
    time_in_words(estimate->wall_seconds, words);
    return json_pack("{s:I, s:I, s:f, s:s, s:I, s:I}", "jobs", (json_int_t)estimate->jobs, "steps", (json_int_t)estimate->steps,
                     "wall_seconds", estimate->wall_seconds, "wall_time", words, "memory_bytes", (json_int_t)estimate->memory_bytes,
                     "snapshot_bytes", (json_int_t)estimate->snapshot_bytes);
}
