/* Claims about what particles of a shape can be packed to: what was seen to fail is refused, what was grown is accepted, and who
 * gives a tube or cylinder too low for a loose bed is told so. */
#include "claims.h"
#include "job_spec.h"

#define SPHERE "{\"diameter\": 0.002}"
#define DUMBBELL "{\"shape\": \"dumbbell\", \"diameter\": 0.002}"
#define TETRAHEDRON "{\"shape\": \"tetrahedron\", \"diameter\": 0.002}"
#define CUBE "{\"shape\": \"cube\", \"diameter\": 0.002}"

/* Problems and then warnings of a request, one a line; it is freed by the caller. */
static char *said_of(const char *process, const char *text)
{
    json_t *request = json_loads(text, 0, NULL);
    if (!request) fail_msg("test's own JSON: %s", text);
    job_spec spec;
    problem_list problems;
    assert_true(problem_list_init(&problems));
    if (job_spec_parse(process, request, 1, &spec, &problems)) {
        job_spec_warn(&spec, NULL, &problems);
        job_spec_clear(&spec);
    }
    char *said = json_dumps(problems.errors, 0);
    problem_list_clear(&problems);
    json_decref(request);
    return said;
}

static bool is_refused(const char *particle, double solid)
{
    char text[8000];
    snprintf(text, sizeof text,
             "{\"inputs\": {\"drum\": {\"diameter\": 0.12, \"length\": 0.03, \"rotation_rate\": 6}, "
             "\"particles\": [%s], \"duration\": {\"seconds\": 0.05}, \"fill_fraction\": %.5f}}",
             particle, solid / 0.6);
    char *said = said_of("drum", text);
    const bool is_refused = strstr(said, "makes a fill of") != NULL;
    if (!is_refused && strstr(said, "must be")) fail_msg("%s is refused for another reason: %s", particle, said);
    free(said);
    return is_refused;
}

/* A particle of touching spheres on a lattice of so many by so many by so many. */
static void write_block(char *text, size_t size, const int count[3])
{
    int length = snprintf(text, size, "{\"shape\": {\"spheres\": [");
    for (int k = 0; k < count[0] * count[1] * count[2]; k++)
        length +=
            snprintf(text + length, size - (size_t)length, "%s{\"position\": [%g, %g, %g], \"diameter\": 0.002}", k ? ", " : "",
                     0.002 * (k % count[0]), 0.002 * (k / count[0] % count[1]), 0.002 * (k / count[0] / count[1]));
    snprintf(text + length, size - (size_t)length, "]}}");
}

#define AT(x, y, z) "{\"position\": [" #x ", " #y ", " #z "], \"diameter\": 0.002}"
#define CROSS                                                                                                                      \
    "{\"shape\": {\"spheres\": [" AT(0, 0, 0) ", " AT(0.002, 0, 0) ", " AT(-0.002, 0, 0) ", " AT(0, 0.002, 0) ", " AT(             \
        0, -0.002, 0) ", " AT(0, 0, 0.002) ", " AT(0, 0, -0.002) "]}}"

/* Solid fractions that beds were grown to in drums, and those at which an overlap went beyond what fails. */
static void named_shapes_are_refused_only_where_they_failed(void **state)
{
    (void)state;
    assert_false(is_refused(SPHERE, 0.57));
    assert_false(is_refused(DUMBBELL, 0.57));
    assert_false(is_refused(TETRAHEDRON, 0.57));
    assert_false(is_refused(CUBE, 0.87 * 0.6));
    assert_true(is_refused(CUBE, 0.54));
    assert_false(is_refused(CROSS, 0.40));
    assert_true(is_refused(CROSS, 0.50));
}

static void blocks_are_refused_only_where_they_failed(void **state)
{
    (void)state;
    static const struct {
        int count[3];
        double grown, failed; /* 0: not known */
    } blocks[] = {
        { { 4, 1, 1 }, 0.55, 0.0 }, { { 3, 3, 1 }, 0.499, 0.522 }, { { 2, 2, 4 }, 0.45, 0.52 }, { { 3, 3, 3 }, 0.0, 0.45 }
    };
    for (size_t k = 0; k < sizeof blocks / sizeof blocks[0]; k++) {
        char particle[6000];
        write_block(particle, sizeof particle, blocks[k].count);
        if (is_refused(particle, blocks[k].grown > 0 ? blocks[k].grown : 0.35)) fail_msg("block %zu is refused", k);
        if (blocks[k].failed > 0 && !is_refused(particle, blocks[k].failed)) fail_msg("block %zu is accepted", k);
    }
}

/* Poured between walls five of their widths apart, spheres fill 0.506, tetrahedra 0.433 and cubes 0.365: the bed of more than
 * that stands over the top. */
static void a_loose_bed_that_may_stand_over_the_top_is_told(void **state)
{
    (void)state;
    static const struct {
        const char *particle;
        double widest, poured; /* m; solid fraction */
    } beds[] = { { SPHERE, 0.002, 0.506 }, { TETRAHEDRON, 0.00445, 0.433 }, { CUBE, 0.00547, 0.365 } };
    for (size_t k = 0; k < sizeof beds / sizeof beds[0]; k++)
        for (int process = 0; process < 2; process++) {
            const double diameter = (process ? 6.05 : 5.05) * beds[k].widest, height = 12 * diameter;
            const char *name = process ? "fill" : "heap", *container = process ? "cylinder" : "tube";
            char text[600], field[40];
            snprintf(text, sizeof text,
                     "{\"process\": \"%s\", \"inputs\": {\"%s\": {\"diameter\": %g, \"height\": %g}, \"particles\": [%s], "
                     "\"fill_height\": %g}}",
                     name, container, diameter, height, beds[k].particle, 1.1 * height * beds[k].poured / 0.6);
            snprintf(field, sizeof field, "/inputs/%s/height", container);
            char *said = said_of(name, text);
            if (!strstr(said, field)) fail_msg("%s: %s", text, said);
            free(said);
        }
}

/* Of a tube without a height, whatever the shape. */
static void a_tube_is_high_enough_for_a_loose_bed(void **state)
{
    (void)state;
    static const char *const particles[] = { SPHERE, DUMBBELL, TETRAHEDRON, CUBE, CROSS };
    for (size_t k = 0; k < sizeof particles / sizeof particles[0]; k++) {
        char text[1200];
        snprintf(text, sizeof text, "{\"process\": \"heap\", \"inputs\": {\"tube\": {\"diameter\": 0.04}, \"particles\": [%s]}}",
                 particles[k]);
        char *said = said_of("heap", text);
        if (strstr(said, "tube/height")) fail_msg("%s: %s", text, said);
        free(said);
    }
}

UNIT_TESTS(named_shapes_are_refused_only_where_they_failed, blocks_are_refused_only_where_they_failed,
           a_loose_bed_that_may_stand_over_the_top_is_told, a_tube_is_high_enough_for_a_loose_bed)
