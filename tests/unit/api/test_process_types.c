/* Claims about the table of processes, and about the specification of a granule. */
#include "claims.h"
#include "granule_process.h"

static void every_field_has_its_own_name_and_a_meaning(void **state)
{
    (void)state;
    for (size_t p = 0; process_types[p]; p++) {
        const spec_table *inputs = process_types[p]->inputs;
        for (size_t f = 0; f < inputs->count; f++) {
            /* The first of that name in its group is itself: no other stands before it. */
            assert_ptr_equal(spec_field_find(inputs, inputs->field[f].group, inputs->field[f].name), &inputs->field[f]);
            assert_true(inputs->field[f].meaning && *inputs->field[f].meaning);
        }
        const result_table *results = process_types[p]->results;
        for (size_t f = 0; f < results->count; f++) {
            const result_field *field = &results->field[f];
            size_t known = 0;
            for (size_t o = 0; o < results->output_count; o++) known += strcmp(results->output[o].name, field->output) == 0;
            assert_int_equal(known, 1);
            /* of several beds a word, a truth or a count has no mean */
            if (results->of_each_bed && field->over_beds == BEDS_MEAN)
                assert_true(field->kind == RESULT_REAL || field->kind == RESULT_WARNINGS);
            assert_int_equal(field->of != NULL, field->over_beds == BEDS_ERROR || field->over_beds == BEDS_AGREED);
            for (size_t g = 0; g < f; g++) {
                const result_field *other = &results->field[g];
                const bool same_group =
                    field->group && other->group ? strcmp(field->group, other->group) == 0 : field->group == other->group;
                assert_false(strcmp(field->output, other->output) == 0 && same_group && strcmp(field->name, other->name) == 0);
            }
        }
    }
}

static bool parse(const char *process, const char *text, job_spec *spec, char **problems_text)
{
    json_t *request = json_loads(text, 0, NULL);
    assert_non_null(request);
    problem_list problems;
    assert_true(problem_list_init(&problems));
    const bool good = job_spec_parse(process, request, 1, spec, &problems);
    if (problems_text) *problems_text = json_dumps(problems.errors, 0);
    problem_list_clear(&problems);
    json_decref(request);
    return good;
}

static void a_granule_needs_its_friction_alone(void **state)
{
    (void)state;
    job_spec spec;
    assert_true(parse("granule", "{\"inputs\": {\"friction\": 0.5}}", &spec, NULL));
    assert_string_equal(spec.process, "granule");
    assert_true(spec.granule.friction == 0.5 && spec.granule.radius == 0.063 && spec.granule.gravity == 9.81);
    assert_true(isnan(spec.granule.rotation_rate) && spec.granule.tolerance == 1e-9);
    assert_int_equal(spec.granule.revolutions, 30);
    assert_int_equal(spec.threads, 1);
    job_spec_clear(&spec);
}

static void a_canonical_granule_is_read_and_written_with_the_same_bytes(void **state)
{
    (void)state;
    const char *const texts[] = {
        "{\"inputs\": {\"friction\": 0.1}}",
        "{\"inputs\": {\"friction\": 0.7, \"rotation_rate\": 17.3, \"revolutions\": 3, \"tolerance\": 1e-12}, \"label\": {\"a\": "
        "1}}",
    };
    for (size_t t = 0; t < 2; t++) {
        job_spec first, second;
        assert_true(parse("granule", texts[t], &first, NULL));
        char *text = job_spec_to_text(&first);
        assert_true(parse(NULL, text, &second, NULL)); /* it names its own process */
        char *again = job_spec_to_text(&second);
        assert_string_equal(text, again);
        free(text);
        free(again);
        job_spec_clear(&first);
        job_spec_clear(&second);
    }
}

static void an_unknown_process_is_told_which_there_are(void **state)
{
    (void)state;
    job_spec spec;
    char *problems;
    assert_false(parse(NULL, "{\"process\": \"hopper\", \"inputs\": {\"friction\": 0.5}}", &spec, &problems));
    assert_non_null(strstr(
        problems, "is \\\"hopper\\\"; available: \\\"drum\\\", \\\"fill\\\", \\\"heap\\\", \\\"granule\\\", \\\"orifice\\\""));
    assert_null(strstr(problems, "/inputs")); /* nobody can tell what a hopper's inputs are */
    free(problems);
    assert_null(process_description("hopper"));
    assert_false(parse("drum", "{\"process\": \"granule\", \"inputs\": {\"friction\": 0.5}}", &spec, &problems));
    assert_non_null(strstr(problems, "/process"));
    free(problems);
}

UNIT_TESTS(every_field_has_its_own_name_and_a_meaning, a_granule_needs_its_friction_alone,
           a_canonical_granule_is_read_and_written_with_the_same_bytes, an_unknown_process_is_told_which_there_are)
