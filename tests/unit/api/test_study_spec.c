/* Claims about studies: merge patches, pointers, combinations, and where problems are said to be. */
#include "claims.h"
#include "json_pointer.h"
#include "merge_patch.h"
#include "study_spec.h"

static json_t *load(const char *text)
{
    json_error_t error;
    json_t *value = json_loads(text, JSON_REJECT_DUPLICATES | JSON_DECODE_ANY, &error);
    if (!value) fail_msg("test's own JSON: %s in %s", error.text, text);
    return value;
}

/* The table of RFC 7396, Appendix A. */
static void test_merge_patch_follows_the_table_of_its_rfc(void **state)
{
    (void)state;
    static const char *const table[][3] = {
        { "{\"a\":\"b\"}", "{\"a\":\"c\"}", "{\"a\":\"c\"}" },
        { "{\"a\":\"b\"}", "{\"b\":\"c\"}", "{\"a\":\"b\",\"b\":\"c\"}" },
        { "{\"a\":\"b\"}", "{\"a\":null}", "{}" },
        { "{\"a\":\"b\",\"b\":\"c\"}", "{\"a\":null}", "{\"b\":\"c\"}" },
        { "{\"a\":[\"b\"]}", "{\"a\":\"c\"}", "{\"a\":\"c\"}" },
        { "{\"a\":\"c\"}", "{\"a\":[\"b\"]}", "{\"a\":[\"b\"]}" },
        { "{\"a\":{\"b\":\"c\"}}", "{\"a\":{\"b\":\"d\",\"c\":null}}", "{\"a\":{\"b\":\"d\"}}" },
        { "{\"a\":[{\"b\":\"c\"}]}", "{\"a\":[1]}", "{\"a\":[1]}" },
        { "[\"a\",\"b\"]", "[\"c\",\"d\"]", "[\"c\",\"d\"]" },
        { "{\"a\":\"b\"}", "[\"c\"]", "[\"c\"]" },
        { "{\"a\":\"foo\"}", "null", "null" },
        { "{\"a\":\"foo\"}", "\"bar\"", "\"bar\"" },
        { "{\"e\":null}", "{\"a\":1}", "{\"e\":null,\"a\":1}" },
        { "[1,2]", "{\"a\":\"b\",\"c\":null}", "{\"a\":\"b\"}" },
        { "{}", "{\"a\":{\"bb\":{\"ccc\":null}}}", "{\"a\":{\"bb\":{}}}" },
    };
    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++) {
        json_t *target = load(table[i][0]), *patch = load(table[i][1]), *expected = load(table[i][2]), *before = load(table[i][0]);
        json_t *result = json_merge_patch(target, patch);
        if (!json_equal(result, expected)) fail_msg("row %zu: %s patched with %s", i, table[i][0], table[i][1]);
        assert_true(json_equal(target, before));
        json_decref(target), json_decref(patch), json_decref(expected), json_decref(before), json_decref(result);
    }
}

/* The table of RFC 6901, section 5. */
static void test_pointers_follow_the_table_of_their_rfc(void **state)
{
    (void)state;
    json_t *document = load(
        "{\"foo\":[\"bar\",\"baz\"],\"\":0,\"a/b\":1,\"c%d\":2,\"e^f\":3,\"g|h\":4,\"i\\\\j\":5,\"k\\\"l\":6,\" \":7,\"m~n\":8}");
    static const struct {
        const char *pointer;
        int value;
    } table[] = { { "/", 0 },     { "/a~1b", 1 }, { "/c%d", 2 }, { "/e^f", 3 }, { "/g|h", 4 },
                  { "/i\\j", 5 }, { "/k\"l", 6 }, { "/ ", 7 },   { "/m~0n", 8 } };
    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++) {
        const json_t *found = json_pointer_find(document, table[i].pointer);
        assert_non_null(found);
        assert_int_equal(json_integer_value(found), table[i].value);
    }
    assert_ptr_equal(json_pointer_find(document, ""), document);
    assert_string_equal(json_string_value(json_pointer_find(document, "/foo/0")), "bar");
    static const char *const nowhere[] = { "/foo/2", "/foo/-", "/foo/00", "/foo/0/x", "/fo", "foo", "/foo/99999999999999999999",
                                           "/m~2n",  "/m~" };
    for (size_t i = 0; i < sizeof nowhere / sizeof nowhere[0]; i++) assert_null(json_pointer_find(document, nowhere[i]));
    json_decref(document);
}

static void test_setting_makes_objects_on_the_way_and_no_entries_of_lists(void **state)
{
    (void)state;
    json_t *document = load("{\"list\":[{\"a\":1},2],\"number\":3}"), *value = json_integer(9);
    assert_true(json_pointer_set(document, "/list/0/a", value));
    assert_true(json_pointer_set(document, "/new/deep~1er", value));
    assert_true(json_pointer_set(document, "/list/1", value));
    assert_false(json_pointer_set(document, "/list/2", value));
    assert_false(json_pointer_set(document, "/list/-", value));
    assert_false(json_pointer_set(document, "/number/x", value));
    assert_false(json_pointer_set(document, "", value));
    json_t *expected = load("{\"list\":[{\"a\":9},9],\"number\":3,\"new\":{\"deep/er\":9}}");
    assert_true(json_equal(document, expected));
    json_decref(document), json_decref(value), json_decref(expected);
}

/* --- studies --- */

#define BASE                                                                                                                       \
    "\"base\":{\"inputs\":{\"drum\":{\"diameter\":0.05,\"length\":0.02,\"rotation_rate\":3},\"particles\":[{\"diameter\":0.005}]," \
    "\"seed\":5}}"

static bool parse(const char *text, int64_t most_jobs, study_spec *study, study_estimate *estimate, problem_list *problems)
{
    const study_options options = { .seed_if_missing = 77, .default_threads = 2, .most_jobs = most_jobs };
    json_t *document = load(text);
    assert_true(problem_list_init(problems));
    study_spec_parse(document, &options, study, problems);
    json_decref(document);
    return study_check(study, NULL, NULL, estimate, problems, NULL);
}

static void take(const char *text, study_spec *study)
{
    study_estimate estimate;
    problem_list problems;
    if (!parse(text, 1000, study, &estimate, &problems)) fail_msg("refused: %s", json_dumps(problems.errors, 0));
    problem_list_clear(&problems);
}

/* The text of all problems, "pointer: detail", one a line, against what is expected. */
static void expect_problems(const char *text, const char *expected)
{
    study_spec study;
    study_estimate estimate;
    problem_list problems;
    char found[20000] = "";
    assert_false(parse(text, 1000, &study, &estimate, &problems));
    size_t i;
    json_t *problem;
    json_array_foreach(problems.errors, i, problem)
    {
        strcat(found, json_string_value(json_object_get(problem, "pointer")));
        strcat(found, ": ");
        strcat(found, json_string_value(json_object_get(problem, "detail")));
        strcat(found, "\n");
    }
    if (strcmp(found, expected) != 0) fail_msg("%s\ngives:\n%sexpected:\n%s", text, found, expected);
    problem_list_clear(&problems);
    study_spec_clear(&study);
}

static double input_of(const study_spec *study, size_t index, int repeat, const char *pointer)
{
    json_t *request = study_job_request(study, index, repeat);
    const json_t *value = json_pointer_find(request, pointer);
    assert_non_null(value);
    const double number = json_number_value(value);
    json_decref(request);
    return number;
}

static void test_all_combinations_come_once_and_the_last_varies_fastest(void **state)
{
    (void)state;
    study_spec study;
    take("{" BASE ",\"vary\":{\"/inputs/contact/friction\":[0.1,0.2],\"/inputs/drum/rotation_rate\":[1,2,4],\"/inputs/wall/"
         "friction\":[0.3,0.6]}}",
         &study);
    assert_int_equal(study.cases, 12);
    static const double friction[] = { 0.1, 0.2 }, rate[] = { 1, 2, 4 }, wall[] = { 0.3, 0.6 };
    for (size_t i = 0; i < 12; i++) { /* three nested loops, written out */
        assert_true(input_of(&study, i, 0, "/inputs/contact/friction") == friction[i / 6]);
        assert_true(input_of(&study, i, 0, "/inputs/drum/rotation_rate") == rate[i / 2 % 3]);
        assert_true(input_of(&study, i, 0, "/inputs/wall/friction") == wall[i % 2]);
        assert_true(input_of(&study, i, 0, "/inputs/drum/diameter") == 0.05);
    }
    char name[STUDY_NAME_SIZE];
    study_case_name(&study, 7, name); /* two inputs are called friction: then the whole way is told */
    assert_string_equal(name, "contact/friction 0.2, rotation_rate 1, wall/friction 0.6");
    json_t *inputs = study_case_inputs(&study, 7),
           *expected = load("{\"contact/friction\":0.2,\"drum/rotation_rate\":1,\"wall/friction\":0.6}");
    assert_true(json_equal(inputs, expected));
    json_decref(inputs), json_decref(expected);
    study_spec_clear(&study);
}

static void test_cases_are_patches_and_show_what_any_of_them_changes(void **state)
{
    (void)state;
    study_spec study;
    take("{\"name\":\"s\"," BASE
         ",\"cases\":[{\"name\":\"a\",\"inputs\":{\"contact\":{\"friction\":0.1}},\"label\":{\"paper\":\"23\"}},"
         "{\"name\":\"b\",\"inputs\":{\"drum\":{\"rotation_rate\":6}}}]}",
         &study);
    json_t *first = study_case_inputs(&study, 0), *second = study_case_inputs(&study, 1);
    json_t *of_first = load("{\"contact/friction\":0.1,\"drum/rotation_rate\":3}"),
           *of_second = load("{\"contact/friction\":null,\"drum/rotation_rate\":6}");
    assert_true(json_equal(first, of_first) && json_equal(second, of_second));
    json_t *request = study_job_request(&study, 0, 0), *label = load("{\"paper\":\"23\",\"study\":\"s\",\"case\":\"a\"}");
    assert_true(json_equal(json_object_get(request, "label"), label));
    assert_true(input_of(&study, 0, 0, "/inputs/threads") == 2.0); /* the daemon's own default */
    json_decref(first), json_decref(second), json_decref(of_first), json_decref(of_second), json_decref(request),
        json_decref(label);
    study_spec_clear(&study);
}

static void test_repeats_differ_in_the_seed_alone(void **state)
{
    (void)state;
    study_spec study;
    take("{" BASE ",\"repeats\":3}", &study);
    assert_int_equal(study.cases, 1);
    json_t *first = study_job_request(&study, 0, 0);
    for (int repeat = 0; repeat < 3; repeat++) {
        json_t *request = study_job_request(&study, 0, repeat);
        assert_int_equal(json_integer_value(json_pointer_find(request, "/inputs/seed")), 5 + repeat);
        json_object_set(json_object_get(request, "inputs"), "seed", json_pointer_find(first, "/inputs/seed"));
        assert_true(json_equal(request, first));
        json_decref(request);
    }
    json_decref(first);
    study_spec_clear(&study);
}

static void test_a_seed_that_is_missing_is_chosen_once_and_kept(void **state)
{
    (void)state;
    study_spec study, again;
    static const char text[] = "{\"base\":{\"inputs\":{\"drum\":{\"diameter\":0.05,\"length\":0.02,\"rotation_rate\":3},"
                               "\"particles\":[{\"diameter\":0.005}]}},\"repeats\":2}";
    take(text, &study);
    assert_true(input_of(&study, 0, 0, "/inputs/seed") == 77.0 && input_of(&study, 0, 1, "/inputs/seed") == 78.0);
    char *kept = json_dumps(study.document, 0); /* posted again it gives the same jobs */
    take(kept, &again);
    json_t *before = study_job_request(&study, 0, 1), *after = study_job_request(&again, 0, 1);
    assert_true(json_equal(before, after));
    json_decref(before), json_decref(after);
    free(kept);
    study_spec_clear(&study);
    study_spec_clear(&again);
}

static void test_a_study_costs_what_its_jobs_cost(void **state)
{
    (void)state;
    study_spec study;
    study_estimate estimate;
    problem_list problems;
    assert_true(parse("{" BASE ",\"vary\":{\"/inputs/drum/rotation_rate\":[2,3]},\"repeats\":4}", 8, &study, &estimate, &problems));
    double steps = 0.0, seconds = 0.0;
    for (size_t i = 0; i < 2; i++) {
        json_t *request = study_job_request(&study, i, 0);
        problem_list none;
        job_spec spec;
        assert_true(problem_list_init(&none) && job_spec_parse(NULL, request, 0, &spec, &none));
        const job_estimate one = job_spec_estimate(&spec, NULL);
        steps += 4 * one.steps;
        seconds += 4 * one.wall_seconds;
        job_spec_clear(&spec);
        problem_list_clear(&none);
        json_decref(request);
    }
    assert_true(estimate.jobs == 8.0 && estimate.steps == steps);
    assert_true(estimate.wall_seconds > seconds * 0.999999
                && estimate.wall_seconds < seconds * 1.000001); /* sums in another order */
    problem_list_clear(&problems);
    study_spec_clear(&study);
}

static void test_problems_point_into_the_study(void **state)
{
    (void)state;
    expect_problems("{" BASE ",\"cases\":[{\"name\":\"a\"},{\"name\":\"b\",\"inputs\":{\"contact\":{\"friction\":-1}}},{\"name\":"
                    "\"c\",\"inputs\":{\"contakt\":{}}}]}",
                    "/cases/1/inputs/contact/friction: is -1; must be in [0, 5]\n"
                    "/cases/2/inputs/contakt: is not an input; did you mean inputs/contact?\n");
    /* Of the base: once, however many cases. */
    expect_problems("{\"base\":{\"inputs\":{\"drum\":{\"diameter\":0.05,\"length\":0.02,\"rotation_rate\":3},\"particles\":[{"
                    "\"diameter\":0.005}],\"gravity\":-2}},"
                    "\"cases\":[{\"name\":\"a\"},{\"name\":\"b\"}]}",
                    "/base/inputs/gravity: is -2 m/s2; must be in [0.01, 1000] m/s2\n");
    expect_problems("{" BASE ",\"vary\":{\"/inputs/contact/friction\":[0.1,7,\"x\"]}}",
                    "/vary/~1inputs~1contact~1friction/1: is 7; must be in [0, 5]\n"
                    "/vary/~1inputs~1contact~1friction/2: is \"x\"; must be a number in [0, 5]\n");
    expect_problems("{" BASE ",\"vary\":{\"/inputs/contact/frction\":[0.1,0.2]}}",
                    "/vary/~1inputs~1contact~1frction: is not an input; did you mean inputs/contact/friction?\n");
    /* Good values that don't go together: the combination is named. */
    expect_problems(
        "{" BASE ",\"vary\":{\"/inputs/particles/0/diameter\":[0.005,0.04]}}",
        "/vary: with diameter 0.04: /inputs/drum/diameter is 0.05 m; must be at least 0.32 m, 8 of the largest particle diameter\n"
        "/vary: with diameter 0.04: /inputs/drum/length is 0.02 m; must be at least 0.12 m, 3 of the largest particle diameter\n"
        "/vary: with diameter 0.04: /inputs/fill_fraction is 0.5, which makes 0 particles; must make 8 to 5000000\n");
}

static void test_bad_shapes_and_bad_jobs_are_told_together(void **state)
{
    (void)state;
    expect_problems(
        "{\"nam\":\"x\"," BASE
        ",\"repeats\":0,\"cases\":[{\"name\":\"a\",\"inputs\":{\"fill_fraction\":2}},{\"name\":\"a\"},3,{\"inputs\":{}}]}",
        "/nam: is not a known member\n"
        "/repeats: is 0; must be a whole number in [1, 1000]\n"
        "/cases/1/name: is the name of an earlier case, too; each must have its own\n"
        "/cases/2: is 3; must be an object with \"name\" and \"inputs\"\n"
        "/cases/3/name: is missing; must be a text\n"
        "/cases/0/inputs/fill_fraction: is 2; must be in (0, 0.95]\n");
    expect_problems("[]", ": must be an object with \"base\" and, if wanted, \"name\", \"cases\" or \"vary\", and \"repeats\"\n");
    expect_problems("{}", "/base: is missing; must be an object with \"inputs\" and, if wanted, \"label\"\n");
    expect_problems("{" BASE ",\"cases\":[],\"vary\":{}}", "/vary: is given beside cases; give one of the two\n");
    expect_problems(
        "{" BASE ",\"vary\":{\"/label/x\":[1],\"/inputs/particles/1/diameter\":[1],\"/inputs/gravity\":[]}}",
        "/vary/~1label~1x: names no input; must be a JSON Pointer as /inputs/contact/friction\n"
        "/vary/~1inputs~1particles~11~1diameter: names no input: it leads through something in the base that has no such member\n"
        "/vary/~1inputs~1gravity: is a list; must be a list of at least one value\n");
}

static void test_no_study_is_larger_than_the_queue(void **state)
{
    (void)state;
    expect_problems("{" BASE ",\"vary\":{\"/inputs/gravity\":[1,2,3]},\"repeats\":334}",
                    ": makes 1002 jobs, 3 cases of 334; at most 1000 may wait\n");
    /* A product beyond any integer. */
    char text[200000] = "{" BASE ",\"vary\":{", *end = text + strlen(text);
    for (int list = 0; list < 8; list++) {
        end += sprintf(end, "%s\"/inputs/contact/x%d\":[0", list ? "," : "", list);
        for (int i = 0; i < 1000; i++) end += sprintf(end, ",0");
        end += sprintf(end, "]");
    }
    strcat(end, "}}");
    study_spec study;
    study_estimate estimate;
    problem_list problems;
    assert_false(parse(text, 1000000, &study, &estimate, &problems));
    assert_int_equal(json_array_size(problems.errors), 1);
    problem_list_clear(&problems);
    study_spec_clear(&study);
}

static void test_the_largest_seed_leaves_no_room_for_repeats(void **state)
{
    (void)state;
    expect_problems("{\"base\":{\"inputs\":{\"drum\":{\"diameter\":0.05,\"length\":0.02,\"rotation_rate\":3},\"particles\":[{"
                    "\"diameter\":0.005}],"
                    "\"seed\":9007199254740991}},\"repeats\":2}",
                    "/base/inputs/seed: is 9007199254740992; must be in [0, 9007199254740991]\n");
}

UNIT_TESTS(test_merge_patch_follows_the_table_of_its_rfc, test_pointers_follow_the_table_of_their_rfc,
           test_setting_makes_objects_on_the_way_and_no_entries_of_lists,
           test_all_combinations_come_once_and_the_last_varies_fastest, test_cases_are_patches_and_show_what_any_of_them_changes,
           test_repeats_differ_in_the_seed_alone, test_a_seed_that_is_missing_is_chosen_once_and_kept,
           test_a_study_costs_what_its_jobs_cost, test_problems_point_into_the_study,
           test_bad_shapes_and_bad_jobs_are_told_together, test_no_study_is_larger_than_the_queue,
           test_the_largest_seed_leaves_no_room_for_repeats)
