/* Claims about warnings: slips that can be run are told with the field that they are in, and good specifications are not
 * grumbled at. */
#include "claims.h"
#include "job_spec.h"
#include "process_type.h"
#include "result_warnings.h"
#include "study_spec.h"

static json_t *load(const char *text)
{
    json_error_t error;
    json_t *document = json_loads(text, JSON_REJECT_DUPLICATES, &error);
    if (!document) fail_msg("test's own JSON: %s in %s", error.text, text);
    return document;
}

static calibration machine_of_two_cores(void)
{
    calibration machine = calibration_built_in();
    machine.cores = 2;
    return machine;
}

static const char *const base[] = {
    [0] = "{\"inputs\": {\"drum\": {\"diameter\": 0.126, \"length\": 0.0189, \"rotation_rate\": 1.5708},"
          " \"particles\": [{\"diameter\": 0.00378}]}}",
    [1] = "{\"process\": \"fill\", \"inputs\": {\"cylinder\": {\"diameter\": 0.06}, \"particles\": [{\"diameter\": 0.003}]}}",
    [2] = "{\"process\": \"heap\", \"inputs\": {\"tube\": {\"diameter\": 0.03}, \"particles\": [{\"diameter\": 0.003}]}}",
    [3] = "{\"process\": \"granule\", \"inputs\": {\"friction\": 0.5, \"rotation_rate\": 18.0}}",
};
enum { DRUM, FILL, HEAP, GRANULE };

static void merge(json_t *into, const json_t *patch)
{
    const char *name;
    json_t *value;
    json_object_foreach((json_t *)patch, name, value)
    {
        json_t *there = json_object_get(into, name);
        if (json_is_object(there) && json_is_object(value)) merge(there, value);
        else json_object_set(into, name, value);
    }
}

/* The warnings of a base with these inputs in place of its own: [{"field", "text"}]. */
static json_t *warnings_of(int process, const char *inputs)
{
    json_t *request = load(base[process]), *patch = load(inputs);
    merge(json_object_get(request, "inputs"), patch);
    job_spec spec;
    problem_list problems;
    problem_list_init(&problems);
    if (!job_spec_parse(NULL, request, 1, &spec, &problems)) fail_msg("%s is refused: %s", inputs, json_dumps(problems.errors, 0));
    const calibration machine = machine_of_two_cores();
    json_t *warnings = job_spec_warnings(&spec, &machine);
    job_spec_clear(&spec);
    problem_list_clear(&problems);
    json_decref(request);
    json_decref(patch);
    return warnings;
}

static const char *text_of(const json_t *warnings, const char *field)
{
    size_t i;
    json_t *warning;
    json_array_foreach(warnings, i, warning)
    {
        if (strcmp(json_string_value(json_object_get(warning, "field")), field) == 0)
            return json_string_value(json_object_get(warning, "text"));
    }
    return "";
}

static void every_slip_is_told_with_its_field(void **state)
{
    (void)state;
    static const struct {
        int process;
        const char *inputs, *field, *told;
    } slips[] = {
        { DRUM, "{\"drum\": {\"rotation_rate\": 15}}", "drum/rotation_rate", "or 1.5708 rad/s" },
        { DRUM, "{\"drum\": {\"rotation_rate\": 10}}", "drum/rotation_rate", "95.49 revolutions a minute" },
        { DRUM, "{\"drum\": {\"diameter\": 12.6, \"length\": 1.89}, \"particles\": [{\"diameter\": 0.378}]}", "drum/diameter",
          "give 0.126 m" },
        { DRUM, "{\"drum\": {\"diameter\": 12.6, \"length\": 1.89}, \"particles\": [{\"diameter\": 0.378}]}", "drum/length",
          "give 0.0189 m" },
        { DRUM, "{\"drum\": {\"diameter\": 12.6, \"length\": 1.89}, \"particles\": [{\"diameter\": 0.378}]}",
          "particles/0/diameter", "give 0.00378 m" },
        { DRUM, "{\"particles\": [{\"diameter\": 0.00378, \"density\": 2.5}]}", "particles/0/density", "give 2500 kg/m3" },
        { DRUM, "{\"particles\": [{\"diameter\": 0.00378}, {\"diameter\": 0.00378, \"density\": 7.8}]}", "particles/1/density",
          "give 7800 kg/m3" },
        { DRUM,
          "{\"particles\": [{\"density\": 2500, \"shape\": {\"spheres\": [{\"position\": [0, 0, 0], \"diameter\": 0.09}]}}],"
          " \"drum\": {\"diameter\": 0.9, \"length\": 0.5}}",
          "particles/0/shape/spheres/0/diameter", "give 0.0009 m" },
        { DRUM, "{\"threads\": 64}", "threads", "has 2 cores" },
        { DRUM, "{\"threads\": 3}", "threads", "has 2 cores" },
        { DRUM, "{\"drum\": {\"length\": 0.3}, \"duration\": {\"revolutions\": 500}}", "duration", " days " },
        { DRUM, "{\"drum\": {\"length\": 0.3}, \"duration\": {\"revolutions\": 100}}", "duration", " min on this machine" },
        { DRUM, "{\"duration\": {\"seconds\": 3000}}", "duration", " h" },
        { DRUM, "{\"duration\": {\"revolutions\": 0.9}}", "duration", "is 0.9 revolutions, less than one" },
        { DRUM, "{\"duration\": {\"revolutions\": 0.4}}", "duration", "too short" },
        { DRUM, "{\"drum\": {\"diameter\": 2.1, \"length\": 0.2}, \"particles\": [{\"diameter\": 0.05}]}", "drum/diameter",
          "usual is 0.005 to 2 m" },
        { DRUM, "{\"drum\": {\"diameter\": 0.036}}", "drum/diameter", "9.52 of the largest particle" },
        { FILL, "{\"cylinder\": {\"diameter\": 0.027}}", "cylinder/diameter", "is 9 of the largest particle" },
        { HEAP, "{\"tube\": {\"diameter\": 0.027}}", "tube/diameter", "is 9 of the largest particle" },
        { DRUM, "{\"particles\": [{\"diameter\": 0.00378, \"density\": 99}]}", "particles/0/density", "usual is 100 to 23000" },
        { DRUM, "{\"gravity\": 981}", "gravity", "give 9.81 m/s2" },
        { DRUM, "{\"contact\": {\"friction\": 3}}", "contact/friction", "usual is 0 to 1.5" },
        { DRUM, "{\"contact\": {\"stiffness\": 100}}", "contact/stiffness", "so soft" },
        { DRUM, "{\"contact\": {\"law\": \"hertz-mindlin\", \"youngs_modulus\": 100000}}", "contact/youngs_modulus", "so soft" },
        { DRUM,
          "{\"snapshots\": {\"interval\": 0.002}, \"duration\": {\"revolutions\": 48}, \"fill_fraction\": 0.9, \"drum\": "
          "{\"length\": 0.1}}",
          "snapshots/interval", "GB" },
        { FILL, "{\"stream\": {\"impact_speed\": 45}}", "stream/impact_speed", "give 0.45 m/s" },
        { FILL, "{\"cylinder\": {\"diameter\": 6}, \"particles\": [{\"diameter\": 0.3}], \"stream\": {\"impact_speed\": 9}}",
          "cylinder/diameter", "give 0.06 m" },
        { HEAP, "{\"tube\": {\"lift_speed\": 2}}", "tube/lift_speed", "falls" },
        { HEAP, "{\"tube\": {\"diameter\": 3}, \"particles\": [{\"diameter\": 0.3}]}", "tube/diameter", "give 0.03 m" },
        { GRANULE, "{\"radius\": 6.3}", "radius", "give 0.063 m" },
    };
    for (size_t i = 0; i < sizeof slips / sizeof slips[0]; i++) {
        char field[120];
        snprintf(field, sizeof field, "/inputs/%s", slips[i].field);
        json_t *warnings = warnings_of(slips[i].process, slips[i].inputs);
        if (!strstr(text_of(warnings, field), slips[i].told) || !*text_of(warnings, field))
            fail_msg("%s: %s says \"%s\", not \"%s\"", slips[i].inputs, field, text_of(warnings, field), slips[i].told);
        json_decref(warnings);
    }
}

static void what_is_usual_is_not_warned_of(void **state)
{
    (void)state;
    for (int process = DRUM; process <= GRANULE; process++) {
        json_t *warnings = warnings_of(process, "{}");
        if (json_array_size(warnings) != 0) fail_msg("%s: %s", base[process], json_dumps(warnings, 0));
        json_decref(warnings);
    }
    static const char *const usual[] = {
        "{\"drum\": {\"rotation_rate\": 4}, \"threads\": 2, \"contact\": {\"maximum_overlap\": 0.05}}",
        "{\"drum\": {\"rotation_rate\": 0.1}, \"contact\": {\"friction\": 1.0}, \"gravity\": 1.62, \"fill_fraction\": 0.9}",
        "{\"particles\": [{\"diameter\": 0.006, \"density\": 101}], \"drum\": {\"diameter\": 0.5, \"length\": 0.02}}",
    };
    for (size_t i = 0; i < sizeof usual / sizeof usual[0]; i++) {
        json_t *warnings = warnings_of(DRUM, usual[i]);
        if (json_array_size(warnings) != 0) fail_msg("%s: %s", usual[i], json_dumps(warnings, 0));
        json_decref(warnings);
    }
}

static void a_drum_is_understood_in_other_words(void **state)
{
    (void)state;
    job_spec spec;
    problem_list problems;
    problem_list_init(&problems);
    json_t *request = load(base[DRUM]);
    assert_true(job_spec_parse(NULL, request, 1, &spec, &problems));
    const calibration machine = machine_of_two_cores();
    json_t *words = job_spec_understood(&spec, &machine);
    /* 1.5708 rad/s is a quarter of a revolution a second: 15 a minute. */
    assert_true(fabs(json_number_value(json_object_get(words, "rotation_rate_rpm")) - 15.0) < 1e-3);
    assert_true(fabs(json_number_value(json_object_get(words, "froude_number")) - 1.5708 * 1.5708 * 0.063 / 9.81) < 1e-12);
    assert_true(fabs(json_number_value(json_object_get(words, "diameter_ratio")) - 0.126 / 0.00378) < 1e-9);
    assert_string_equal(json_string_value(json_object_get(words, "duration")), "1.25 revolutions, 5 s of rotation");
    assert_true(fabs(json_number_value(json_object_get(words, "expected_overlap")) / 0.01 - 1.0)
                < 1e-9); /* what is asked for by default */
    assert_memory_equal(json_string_value(json_object_get(words, "wall_time")), "about ", 6);
    json_decref(words);
    job_spec_clear(&spec);
    problem_list_clear(&problems);
    json_decref(request);
}

static void times_are_told_in_two_units(void **state)
{
    (void)state;
    static const struct {
        double seconds;
        const char *words;
    } times[] = {
        { 0.0123, "12.3 ms" },
        { 1.0, "1 s" },
        { 12.34, "12.3 s" },
        { 59.9, "1 min" },
        { 300.0, "5 min" },
        { 301.0, "5 min 1 s" },
        { 3599.7, "1 h" },
        { 5400.0, "1 h 30 min" },
        { 86399.0, "1 day" },
        { 90000.0, "1 day 1 h" },
        { 10 * 86400.0 + 2 * 3600.0, "10 days 2 h" },
        { 1e9, "11574 days 2 h" },
    };
    for (size_t i = 0; i < sizeof times / sizeof times[0]; i++) {
        char words[TIME_IN_WORDS_SIZE];
        time_in_words(times[i].seconds, words);
        assert_string_equal(words, times[i].words);
    }
}

static void a_study_tells_a_warning_once_and_where_it_comes_from(void **state)
{
    (void)state;
    json_t *document =
        load("{\"base\": {\"inputs\": {\"drum\": {\"diameter\": 0.126, \"length\": 0.0189, \"rotation_rate\": 1.5708},"
             " \"particles\": [{\"diameter\": 0.00378, \"density\": 2.5}]}},"
             " \"vary\": {\"/inputs/drum/rotation_rate\": [1, 15, 20]}, \"repeats\": 3}");
    const study_options options = { .seed_if_missing = 1, .default_threads = 1, .most_jobs = 100 };
    const calibration machine = machine_of_two_cores();
    study_spec study;
    study_estimate estimate;
    problem_list problems, warnings;
    problem_list_init(&problems);
    problem_list_init(&warnings);
    study_spec_parse(document, &options, &study, &problems);
    assert_true(study_check(&study, &machine, NULL, &estimate, &problems, &warnings));
    json_t *told = job_warnings_to_json(&warnings);
    assert_int_equal(json_array_size(told), 3);
    assert_non_null(strstr(text_of(told, "/base/inputs/particles/0/density"), "2500"));
    assert_non_null(strstr(text_of(told, "/vary/~1inputs~1drum~1rotation_rate/1"), "15 rad/s"));
    assert_non_null(strstr(text_of(told, "/vary/~1inputs~1drum~1rotation_rate/2"), "20 rad/s"));
    json_decref(told);
    study_spec_clear(&study);
    problem_list_clear(&problems);
    problem_list_clear(&warnings);
    json_decref(document);
}

/* How many warnings a run with this contact has whose largest overlap was this. */
static size_t warnings_of_overlap(const char *contact, double largest)
{
    char text[300];
    snprintf(text, sizeof text,
             "{\"inputs\": {\"drum\": {\"diameter\": 0.126, \"length\": 0.0189, \"rotation_rate\": 1.5708},"
             " \"particles\": [{\"diameter\": 0.00378}], \"contact\": {%s}}}",
             contact);
    json_t *request = load(text), *results = json_pack("{s:{s:f}}", "run", "maximum_overlap", largest);
    job_spec spec;
    problem_list problems;
    problem_list_init(&problems);
    assert_true(job_spec_parse(NULL, request, 1, &spec, &problems));
    assert_true(result_warnings_add(&spec, results));
    const size_t count = json_array_size(json_object_get(json_object_get(results, "run"), "warnings"));
    job_spec_clear(&spec);
    problem_list_clear(&problems);
    json_decref(request);
    json_decref(results);
    return count;
}

static void an_overlap_above_what_was_asked_for_by_half_is_told(void **unused)
{
    (void)unused;
    assert_int_equal(warnings_of_overlap("\"maximum_overlap\": 0.02", 0.0299), 0);
    assert_int_equal(warnings_of_overlap("\"maximum_overlap\": 0.02", 0.0301), 1);
    /* An impact of 1 m/s, v sqrt(m/K1): some 0.035 and a tenth of it. */
    assert_int_equal(warnings_of_overlap("\"stiffness\": 4e3", 0.02), 0);
    assert_int_equal(warnings_of_overlap("\"stiffness\": 4e5", 0.02), 1);
}

UNIT_TESTS(every_slip_is_told_with_its_field, what_is_usual_is_not_warned_of, a_drum_is_understood_in_other_words,
           times_are_told_in_two_units, a_study_tells_a_warning_once_and_where_it_comes_from,
           an_overlap_above_what_was_asked_for_by_half_is_told)
