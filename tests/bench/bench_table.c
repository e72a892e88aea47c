/* How fast the core is, on beds in steady flow: bench_table [CASE...], all but the last two when none is named. Windows of all
 * cases are interleaved in rounds, so that a machine that slows down slows all of them. Prints one JSON line a case. */
#include <malloc.h>

#include "bed.h"

#define DRUM                                                                                                                       \
    "{\"drum\": {\"diameter\": 0.126, \"length\": %s, \"rotation_rate\": %s}, \"particles\": [%s],"                                \
    " \"contact\": {\"law\": \"%s\", \"friction\": %s}, \"duration\": {\"revolutions\": 1}, \"seed\": 1}"
#define LARGE "{\"diameter\": 0.00378}"
#define SMALL "{\"diameter\": 0.003}"
#define HALF_PI "1.5707963267948966"
/* the rate of Omega_i^2 = 2.2 */
#define CENTRIFUGING "22.0107"

enum { ROUNDS = 7, BEDS = 9 };
#define WINDOW_SECONDS 0.3

typedef struct bed {
    const char *name, *length, *rate, *particle, *law, *friction;
    double rotation; /* s before the flow is steady */
    dem_scene_definition drum;
    dem_scene *scene;
    double settling_wall, rotation_wall; /* s it took */
} bed;

#define BED(n, l, r, p, w, f, s)                                                                                                   \
    {                                                                                                                              \
        .name = n, .length = l, .rate = r, .particle = p, .law = w, .friction = f, .rotation = s                                   \
    }
static bed beds[BEDS] = {
    BED("1500", "0.01134", HALF_PI, LARGE, "walton-braun", "0.1", 0.6),
    BED("2300", "0.017388", HALF_PI, LARGE, "walton-braun", "0.1", 0.6),
    BED("3000", "0.011338", HALF_PI, SMALL, "walton-braun", "0.1", 0.6),
    BED("spring-dashpot", "0.017388", HALF_PI, LARGE, "spring-dashpot", "0.1", 0.6),
    BED("hertz-mindlin", "0.017388", HALF_PI, LARGE, "hertz-mindlin", "0.1", 0.6),
    BED("rough", "0.017388", "3.141592653589793", LARGE, "walton-braun", "1", 0.6),
    BED("centrifuging", "0.017388", CENTRIFUGING, LARGE, "walton-braun", "0.2", 0.6),
    BED("tetrahedra", "0.0378", HALF_PI, "{\"shape\": \"tetrahedron\", \"diameter\": 0.00378}", "walton-braun", "0.1", 0.4),
    BED("cubes", "0.0378", HALF_PI, "{\"shape\": \"cube\", \"diameter\": 0.00378}", "walton-braun", "0.1", 0.4),
};

typedef struct bench_case {
    const char *name, *bed;
    size_t copies;
    int threads;
    dem_scene *scene;
    int64_t steps;        /* of a window */
    double speed[ROUNDS]; /* sphere-steps/s */
} bench_case;

#define CASE(n, b, c, t)                                                                                                           \
    {                                                                                                                              \
        .name = n, .bed = b, .copies = c, .threads = t                                                                             \
    }
static bench_case cases[] = {
    CASE("1500", "1500", 1, 1),
    CASE("2300", "2300", 1, 1),
    CASE("3000", "3000", 1, 1),
    CASE("24000", "3000", 8, 1),
    CASE("100000", "3000", 33, 1),
    CASE("2300, 2 threads", "2300", 1, 2),
    CASE("3000, 2 threads", "3000", 1, 2),
    CASE("24000, 2 threads", "3000", 8, 2),
    CASE("100000, 2 threads", "3000", 33, 2),
    CASE("spring-dashpot, 2300", "spring-dashpot", 1, 1),
    CASE("hertz-mindlin, 2300", "hertz-mindlin", 1, 1),
    CASE("friction 1, pi rad/s, 2300", "rough", 1, 1),
    CASE("centrifuging, 2300", "centrifuging", 1, 1),
    CASE("tetrahedra", "tetrahedra", 1, 1),
    CASE("cubes", "cubes", 1, 1),
    CASE("1000000", "3000", 333, 1), /* only when named, like the next: its memory is the process's */
    CASE("1000000, 2 threads", "3000", 333, 2),
};
enum { CASES = sizeof cases / sizeof cases[0], NAMED_ONLY = 2 };

static bed *bed_of(const bench_case *c)
{
    for (size_t k = 0; k < BEDS; k++)
        if (strcmp(beds[k].name, c->bed) == 0) return &beds[k];
    give_up("no such bed", c->bed);
    return NULL;
}

static void make_bed(bed *b)
{
    if (b->scene) return;
    char inputs[1000];
    snprintf(inputs, sizeof inputs, DRUM, b->length, b->rate, b->particle, b->law, b->friction);
    b->drum = bed_definition(inputs);
    b->scene = bed_create(&b->drum);
    const double begin = now();
    while (dem_scene_phase(b->scene) != DEM_PHASE_RUNNING) bed_advance(b->scene, 100);
    b->settling_wall = now() - begin;
    bed_advance(b->scene, (int64_t)(b->rotation / b->drum.time_step));
    b->rotation_wall = now() - begin - b->settling_wall;
}

static void prepare(bench_case *c)
{
    bed *b = bed_of(c);
    make_bed(b);
    c->scene = c->copies == 1 && c->threads == 1 ? b->scene : bed_repeat(b->scene, &b->drum, c->copies, c->threads);
    const double count = (double)dem_scene_sphere_count(c->scene), begin = now();
    const int64_t first = (int64_t)(2e6 / count) + 20;
    bed_advance(c->scene, first); /* warms up, too */
    c->steps = (int64_t)(WINDOW_SECONDS * (double)first / (now() - begin)) + 1;
    if (c->steps < 24) c->steps = 24; /* a pick of the inner list at least */
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double touching_a_sphere(const dem_scene *scene)
{
    const size_t n = dem_scene_sphere_count(scene);
    int32_t *contacts = malloc(n * sizeof *contacts);
    dem_scene_particles(scene, &(dem_particle_arrays){ .contacts = contacts });
    double sum = 0;
    for (size_t i = 0; i < n; i++) sum += contacts[i];
    free(contacts);
    return 0.5 * sum / (double)n;
}

static double resident_most(void)
{
    double kilobytes = 0;
    char line[200];
    FILE *file = fopen("/proc/self/status", "r");
    while (file && fgets(line, sizeof line, file))
        if (sscanf(line, "VmHWM: %lf", &kilobytes) == 1) break;
    if (file) fclose(file);
    return 1024 * kilobytes;
}

/* From here on: what making the beds took and gave back does not count. */
static void forget_resident_most(void)
{
    malloc_trim(0);
    FILE *file = fopen("/proc/self/clear_refs", "w");
    if (!file || fputs("5", file) < 0) give_up("/proc/self/clear_refs", "can't be written");
    fclose(file);
}

static void print_case(bench_case *c)
{
    const bed *b = bed_of(c);
    const double count = (double)dem_scene_sphere_count(c->scene);
    qsort(c->speed, ROUNDS, sizeof c->speed[0], ascending);
    printf("{\"case\": \"%s\", \"spheres\": %.0f, \"threads\": %d, \"time_step\": %.4g, \"pairs_a_sphere\": %.3g, "
           "\"sphere_steps_per_second\": {\"minimum\": %.5g, \"median\": %.5g, \"maximum\": %.5g}, "
           "\"bed\": {\"settling_seconds\": %.3g, \"settling_steps\": %lld}, \"resident_bytes\": %.0f}\n",
           c->name, count, c->threads, b->drum.time_step, touching_a_sphere(c->scene), c->speed[0], c->speed[ROUNDS / 2],
           c->speed[ROUNDS - 1], b->settling_wall, (long long)dem_scene_run_start(b->scene), resident_most());
}

static bool is_wanted(const bench_case *c, int argc, char **argv)
{
    for (int k = 1; k < argc; k++)
        if (strcmp(argv[k], c->name) == 0) return true;
    return argc == 1 && c < &cases[CASES - NAMED_ONLY];
}

int main(int argc, char **argv)
{
    size_t wanted = 0;
    for (size_t k = 0; k < CASES; k++) {
        if (!is_wanted(&cases[k], argc, argv)) continue;
        const double begin = now();
        prepare(&cases[k]);
        fprintf(stderr, "%s: prepared in %.1f s\n", cases[k].name, now() - begin);
        wanted++;
    }
    if (wanted == 0) give_up("no such case", argv[1]);
    forget_resident_most();
    for (int round = 0; round < ROUNDS; round++)
        for (size_t k = 0; k < CASES; k++) {
            bench_case *c = &cases[k];
            if (!c->scene) continue;
            const double begin = now();
            bed_advance(c->scene, c->steps);
            c->speed[round] = (double)dem_scene_sphere_count(c->scene) * (double)c->steps / (now() - begin);
        }
    for (size_t k = 0; k < CASES; k++)
        if (cases[k].scene) print_case(&cases[k]);
    return 0;
}
