/* Claims about numbers that are given with a unit: what they come to, and what is refused. */
#include "requests.h"

#include "process_type.h"
#include "study_spec.h"
#include "unit_table.h"

static double field_in(const char *unit_of_row, field_kind kind, const char *unit, double number)
{
    const spec_field field = { .kind = kind, .unit = unit_of_row };
    double converted = NAN;
    return unit_convert(&field, unit, number, &converted) ? converted : NAN;
}

/* The right-hand sides are decimals as a person would write them, read by the compiler. */
static void powers_of_ten_give_the_very_number_of_the_decimals(void **unused)
{
    (void)unused;
    assert_true(field_in("m", FIELD_REAL, "mm", 3.78) == 0.00378);
    assert_true(field_in("m", FIELD_REAL, "cm", 12.6) == 0.126);
    assert_true(field_in("m", FIELD_REAL, "um", 250) == 250e-6);
    assert_true(field_in("m", FIELD_REAL, "µm", 0.1) == 0.1e-6);
    assert_true(field_in("m", FIELD_REAL, "in", 5) == 0.127);
    assert_true(field_in("kg/m3", FIELD_REAL, "g/cm3", 2.65) == 2650.0);
    assert_true(field_in("Pa", FIELD_REAL, "MPa", 5.1) == 5.1e6);
    assert_true(field_in("Pa", FIELD_REAL, "GPa", 70.3) == 70.3e9);
    assert_true(field_in("N/m", FIELD_REAL, "N/mm", 4.7) == 4700.0);
    assert_true(field_in("", FIELD_REAL, "%", 35) == 0.35);
    assert_true(field_in("kg/s", FIELD_REAL, "g/s", 3.3) == 0.0033);
    assert_true(field_in("1/m", FIELD_REAL, "1/mm", 0.3) == 300.0);
    for (int i = 1; i < 2000; i++) { /* a thousandth of i hundredths, by the library's own reading of it */
        char text[40];
        snprintf(text, sizeof text, "%d.%02de-3", i / 100, i % 100);
        assert_true(field_in("m", FIELD_REAL, "mm", i / 100.0) == strtod(text, NULL));
    }
}

static void other_factors_are_right_to_rounding(void **unused)
{
    (void)unused;
    static const struct {
        const char *row, *unit;
        double number, expected;
    } cases[] = {
        { "rad/s", "rpm", 15, 1.5707963267948966 },
        { "rad/s", "1/min", 30, 3.1415926535897931 },
        { "rad/s", "rev/s", 2, 12.566370614359172 },
        { "rad/s", "deg/s", 90, 1.5707963267948966 },
        { "1/min", "rad/s", 1.5707963267948966, 15 },
        { "1/min", "rpm", 7, 7 },
        { "s", "min", 2.5, 150 },
        { "s", "h", 0.5, 1800 },
        { "s", "d", 1, 86400 },
        { "degrees", "rad", 0.5, 28.64788975654116 },
        { "revolutions", "deg", 900, 2.5 },
        { "1/s", "1/min", 90, 1.5 },
        { "m/s", "km/h", 36, 10 },
        { "kg/s", "t/h", 7.2, 2 },
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const double seen = field_in(cases[i].row, FIELD_REAL, cases[i].unit, cases[i].number);
        if (!(fabs(seen / cases[i].expected - 1.0) < 5e-16))
            fail_msg("%g %s gives %.17g %s", cases[i].number, cases[i].unit, seen, cases[i].row);
    }
}

static void another_dimension_is_no_unit_of_a_row(void **unused)
{
    (void)unused;
    assert_true(isnan(field_in("m", FIELD_REAL, "kg", 1)) && isnan(field_in("m", FIELD_REAL, "s", 1)));
    assert_true(isnan(field_in("rad/s", FIELD_REAL, "1/s", 1))); /* radians or revolutions? */
    assert_true(isnan(field_in("1/s", FIELD_REAL, "rpm", 1)));
    assert_true(isnan(field_in("m", FIELD_REAL, "MM", 1)) && isnan(field_in("m", FIELD_REAL, "", 1)));
    assert_true(isnan(field_in("", FIELD_INTEGER, "%", 100)) && field_in("", FIELD_INTEGER, "1", 3) == 3.0);
}

static void every_numeric_row_of_every_process_has_units_and_its_own_is_the_first(void **unused)
{
    (void)unused;
    size_t rows = 0;
    for (size_t p = 0; process_types[p]; p++) {
        for (size_t f = 0; f < process_types[p]->inputs->count; f++) {
            const spec_field *field = &process_types[p]->inputs->field[f];
            if (field->kind != FIELD_REAL && field->kind != FIELD_INTEGER && field->kind != FIELD_PLACE) continue;
            json_t *names = unit_names(field);
            const char *first = json_string_value(json_array_get(names, 0));
            if (!first || strcmp(first, *field->unit ? field->unit : "1") != 0)
                fail_msg("%s %s: %s", process_types[p]->name, field->name, first ? first : "no unit");
            json_decref(names);
            rows++;
        }
    }
    assert_true(rows > 100);
}

static void the_canonical_text_is_that_of_the_same_inputs_in_si(void **unused)
{
    (void)unused;
    json_t *with_units =
               load("{\"inputs\": {\"drum\": {\"diameter\": {\"value\": 126, \"unit\": \"mm\"}, \"length\": {\"value\": 1.89, "
                    "\"unit\": \"cm\"}, \"rotation_rate\": {\"value\": 90, \"unit\": \"deg/s\"}}, \"particles\": [{\"diameter\": "
                    "{\"value\": 3780, \"unit\": \"um\"}, \"density\": {\"value\": 2.5, \"unit\": \"g/cm3\"}}], \"fill_fraction\": "
                    "{\"value\": {\"value\": 40, \"unit\": \"%\"}, \"mediaType\": \"application/json\"}, "
                    "\"duration\": {\"seconds\": {\"value\": 0.5, \"unit\": \"min\"}}}}"),
           *in_si =
               load("{\"inputs\": {\"drum\": {\"diameter\": 0.126, \"length\": 0.0189, \"rotation_rate\": 1.5707963267948966}, "
                    "\"particles\": [{\"diameter\": 0.00378, \"density\": 2500}], \"fill_fraction\": 0.4, "
                    "\"duration\": {\"seconds\": 30}}}");
    job_spec a = parse_or_fail(with_units), b = parse_or_fail(in_si);
    char *text_a = job_spec_to_text(&a), *text_b = job_spec_to_text(&b);
    assert_string_equal(text_a, text_b);
    free(text_a), free(text_b);
    job_spec_clear(&a), job_spec_clear(&b);
}

static void what_is_wrong_is_told_with_value_and_units(void **unused)
{
    (void)unused;
    static const char lengths[] = "units allowed: m, cm, mm, um, µm, μm, in\n";
    char expected[300];
    snprintf(expected, sizeof expected, "/inputs/drum/diameter: is 126 with the unit \"kg\"; %s", lengths);
    expect_problem("drum/diameter", "{\"value\": 126, \"unit\": \"kg\"}", expected);
    snprintf(expected, sizeof expected, "/inputs/drum/diameter: has the value 126 and no unit; %s", lengths);
    expect_problem("drum/diameter", "{\"value\": 126}", expected);
    expect_problem("drum/diameter", "{\"value\": 5e6, \"unit\": \"cm\"}",
                   "/inputs/drum/diameter: is 5000000 cm, which is 50000 m; must be in [0.001, 20] m\n");
    expect_problem("contact/friction", "{\"unit\": \"1\"}", "/inputs/contact/friction: has no value; must be a number in [0, 5]\n");
    expect_problem("contact/friction", "{\"value\": \"0.5\", \"unit\": \"1\"}",
                   "/inputs/contact/friction: has the value \"0.5\"; must be a number in [0, 5]\n");
    expect_problem("threads", "{\"value\": 1.5, \"unit\": \"1\"}",
                   "/inputs/threads: is 1.5 1, which is 1.5; must be a whole number in [1, 256]\n");
    expect_problem("contact/friction", "{\"value\": 1, \"unit\": \"1\", \"x\": 2}",
                   "/inputs/contact/friction/x: is not a known member\n");
}

/* Wherever a number may stand: a bed's places, a shape's spheres. */
static void places_have_units_one_by_one_or_all_together(void **unused)
{
    (void)unused;
    job_spec spec = parse_or_fail(minimal_with(
        "particles",
        "[{\"shape\": {\"spheres\": [{\"position\": [0, {\"value\": 1.5, \"unit\": \"mm\"}, 0], \"diameter\": 0.003}, "
        "{\"position\": {\"value\": [0, 2, 0.5], \"unit\": \"mm\"}, \"diameter\": {\"value\": 2, \"unit\": \"mm\"}}]}}]"));
    assert_true(spec.inputs.species[0].sphere[0].position[1] == 0.0015);
    assert_true(spec.inputs.species[0].sphere[1].position[1] == 0.002 && spec.inputs.species[0].sphere[1].position[2] == 0.0005);
    assert_true(spec.inputs.species[0].sphere[1].diameter == 0.002);
    job_spec_clear(&spec);
}

static void cases_of_a_study_have_units_and_are_told_in_si(void **unused)
{
    (void)unused;
    json_t *document = load(
        "{\"base\": {\"inputs\": {\"drum\": {\"diameter\": 0.05, \"length\": 0.02, \"rotation_rate\": 3}, "
        "\"particles\": [{\"diameter\": 0.005}], \"seed\": {\"value\": 5, \"unit\": \"1\"}}}, \"repeats\": 3, "
        "\"vary\": {\"/inputs/drum/rotation_rate\": [{\"value\": 30, \"unit\": \"rpm\"}, 2, {\"value\": 1, \"unit\": \"m\"}]}}");
    const study_options options = { .seed_if_missing = 77, .default_threads = 1, .most_jobs = 100 };
    study_spec study;
    study_estimate estimate;
    problem_list problems;
    problem_list_init(&problems);
    assert_true(study_spec_parse(document, &options, &study, &problems));
    assert_int_equal(json_array_size(study.columns), 1);
    char name[STUDY_NAME_SIZE];
    study_case_name(&study, 0, name);
    assert_string_equal(name, "rotation_rate 30 rpm");
    json_t *inputs = study_case_inputs(&study, 0);
    assert_true(fabs(json_number_value(json_object_get(inputs, "drum/rotation_rate")) - 3.1415926535897931) < 1e-15);
    json_decref(inputs);
    json_t *request = study_job_request(&study, 1, 2);
    assert_int_equal(json_integer_value(json_object_get(json_object_get(request, "inputs"), "seed")), 7);
    json_decref(request);
    assert_false(study_check(&study, NULL, NULL, &estimate, &problems, NULL));
    const json_t *problem = json_array_get(problems.errors, 0);
    assert_int_equal(json_array_size(problems.errors), 1);
    assert_string_equal(json_string_value(json_object_get(problem, "pointer")), "/vary/~1inputs~1drum~1rotation_rate/2");
    assert_string_equal(json_string_value(json_object_get(problem, "detail")),
                        "is 1 with the unit \"m\"; units allowed: rad/s, deg/s, rpm, 1/min, rev/min, rev/s");
    study_spec_clear(&study);
    problem_list_clear(&problems);
    json_decref(document);
}

UNIT_TESTS(powers_of_ten_give_the_very_number_of_the_decimals, other_factors_are_right_to_rounding,
           another_dimension_is_no_unit_of_a_row, every_numeric_row_of_every_process_has_units_and_its_own_is_the_first,
           the_canonical_text_is_that_of_the_same_inputs_in_si, what_is_wrong_is_told_with_value_and_units,
           places_have_units_one_by_one_or_all_together, cases_of_a_study_have_units_and_are_told_in_si)
