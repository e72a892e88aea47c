/* Claims about which runs settle the same bed. */
#include "dem_types.h"
#include "requests.h"
#include "spec_bed.h"

/* All that the core is given, but for what it looks at only once the run has begun, or never. */
static dem_scene_definition before_the_run(const job_spec *spec)
{
    dem_scene_definition scene;
    memcpy(&scene, &spec->scene, sizeof scene);
    scene.rotation_rate = 0;
    scene.lift.speed = 0;
    scene.threads = 0;
    return scene;
}

static json_t *with(const char *base, const char *changes)
{
    json_t *request = load(base), *inputs = json_object_get(request, "inputs"), *more = load(changes), *value;
    const char *name;
    json_object_foreach(more, name, value)
    {
        json_t *member = json_object_get(inputs, name);
        if (json_is_object(member)) json_object_update(member, value);
        else json_object_set(inputs, name, value);
    }
    json_decref(more);
    return request;
}

static const char *const bases[] = {
    "{\"inputs\": {\"drum\": {\"diameter\": 0.05, \"length\": 0.02, \"rotation_rate\": 3}, \"seed\": 1,"
    " \"particles\": [{\"diameter\": 0.005}], \"contact\": {\"friction\": 0.3}, \"wall\": {}}}",
    "{\"process\": \"heap\", \"inputs\": {\"tube\": {\"diameter\": 0.05}, \"seed\": 1, \"particles\": [{\"diameter\": 0.005}],"
    " \"contact\": {\"friction\": 0.3}, \"wall\": {}}}",
};

/* What each base is changed to; {} where it stays. Not every process takes all. */
static const char *const changes[] = {
    "{}",
    "{\"drum\": {\"rotation_rate\": 2}}",
    "{\"drum\": {\"rotation_rate\": -2}}",
    "{\"drum\": {\"rotation_rate\": 40}}",
    "{\"drum\": {\"rotation_rate\": 40}, \"contact\": {\"stiffness\": 5000}}",
    "{\"contact\": {\"stiffness\": 5000}}",
    "{\"drum\": {\"rotation_rate\": 40}, \"contact\": {\"unloading\": \"variable\", \"stiffness\": 5000}}",
    "{\"contact\": {\"unloading\": \"variable\", \"stiffness\": 5000}}",
    "{\"drum\": {\"rotation_rate\": 40}, \"contact\": {\"law\": \"hertz-mindlin\"}}",
    "{\"contact\": {\"law\": \"hertz-mindlin\"}}",
    "{\"drum\": {\"rotation_rate\": 40}, \"contact\": {\"law\": \"hertz-mindlin\", \"youngs_modulus\": 1e7}}",
    "{\"contact\": {\"law\": \"hertz-mindlin\", \"youngs_modulus\": 1e7}}",
    "{\"drum\": {\"rotation_rate\": 2}, \"particles\": [{\"shape\": \"tetrahedron\", \"diameter\": 0.002}]}",
    "{\"drum\": {\"rotation_rate\": -2}, \"particles\": [{\"shape\": \"tetrahedron\", \"diameter\": 0.002}]}",
    "{\"drum\": {\"rotation_rate\": 2, \"lifters\": {\"count\": 4, \"height\": 0.004, \"width\": 0.002, \"angle_deg\": 20}}}",
    "{\"drum\": {\"rotation_rate\": -2, \"lifters\": {\"count\": 4, \"height\": 0.004, \"width\": 0.002, \"angle_deg\": 20}}}",
    "{\"drum\": {\"rotation_rate\": 2.5, \"lifters\": {\"count\": 4, \"height\": 0.004, \"width\": 0.002, \"angle_deg\": 20}}}",
    "{\"duration\": {\"seconds\": 0.5}}",
    "{\"duration\": {\"at_most_seconds\": 0.5}}",
    "{\"tube\": {\"lift_speed\": 0.02}}",
    "{\"tube\": {\"lift_speed\": 3}}",
    "{\"snapshots\": {\"interval\": 0.5}, \"samples\": {\"interval\": 0.01}, \"threads\": 3}",
    "{\"seed\": 2}",
    "{\"precision\": \"double\"}",
    "{\"wall\": {\"friction\": 0.4}}",
    "{\"integration\": {\"corrector_passes\": 2}}",
    "{\"drum\": {\"rotation_rate\": 40}, \"materials\": {\"a\": {}}, \"particles\": [{\"diameter\": 0.005, \"material\": \"a\"}],"
    " \"pairs\": [{\"between\": [\"a\", \"wall\"], \"friction\": 0.1}]}",
    "{\"materials\": {\"a\": {}}, \"particles\": [{\"diameter\": 0.005, \"material\": \"a\"}],"
    " \"pairs\": [{\"between\": [\"a\", \"wall\"], \"friction\": 0.1}]}",
};
enum { CHANGES = sizeof changes / sizeof *changes };

static bool parse(const char *base, const char *change, job_spec *spec)
{
    problem_list problems;
    json_t *request = with(base, change);
    problem_list_init(&problems);
    const bool good = job_spec_parse(NULL, request, 0, spec, &problems);
    problem_list_clear(&problems);
    json_decref(request);
    return good;
}

/* The core is the oracle: what it is given before the run begins, and the precision it computes in, make the bed. */
static void runs_share_a_bed_where_the_core_is_given_the_same_until_then(void **state)
{
    (void)state;
    for (size_t b = 0; b < sizeof bases / sizeof *bases; b++) {
        static job_spec spec[CHANGES];
        char *text[CHANGES] = { NULL };
        int taken = 0, shared = 0;
        for (int k = 0; k < CHANGES; k++) {
            if (!parse(bases[b], changes[k], &spec[k])) continue;
            text[k] = spec_bed_text(&spec[k]);
            assert_non_null(text[k]);
            taken++;
            for (int j = 0; j < k; j++) {
                if (!text[j]) continue;
                const dem_scene_definition one = before_the_run(&spec[j]), other = before_the_run(&spec[k]);
                const bool same = memcmp(&one, &other, sizeof one) == 0 && spec[j].inputs.precision == spec[k].inputs.precision;
                if (same != (strcmp(text[j], text[k]) == 0)) fail_msg("%s and %s: the core says %d", changes[j], changes[k], same);
                shared += same;
            }
        }
        assert_in_range(taken, 12 - 2 * (int)b, CHANGES);
        assert_in_range(shared, 4, CHANGES * CHANGES);
        for (int k = 0; k < CHANGES; k++) {
            if (text[k]) job_spec_clear(&spec[k]);
            free(text[k]);
        }
    }
}

static void what_settles_no_bed_has_none(void **state)
{
    (void)state;
    static const char *const none[] = {
        "{\"process\": \"granule\", \"inputs\": {\"friction\": 0.5, \"radius\": 0.1, \"rotation_rate\": 3}}",
        "{\"process\": \"fill\", \"inputs\": {\"cylinder\": {\"diameter\": 0.05}, \"particles\": [{\"diameter\": 0.005}]}}",
        "{\"inputs\": {\"drum\": {\"diameter\": 0.05, \"length\": 0.02, \"rotation_rate\": 3}, \"particles\": [{\"diameter\": "
        "0.005}],"
        " \"start\": {\"particles\": [{\"position\": [0, 0, 0]}]}}}",
    };
    for (size_t k = 0; k < sizeof none / sizeof *none; k++) {
        job_spec spec = parse_or_fail(load(none[k]));
        assert_null(spec_bed_text(&spec));
        job_spec_clear(&spec);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(runs_share_a_bed_where_the_core_is_given_the_same_until_then),
        cmocka_unit_test(what_settles_no_bed_has_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
