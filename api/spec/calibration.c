#include "calibration.h"

#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* A thread more does not bring all of its speed. */
#define THREAD_GAIN 0.7
/* Particles that hold one another by friction touch fewer others: cost falls with the logarithm of friction. */
#define COST_A_DECADE_OF_FRICTION (-0.1)
#define FACTOR_OF_ROLLING_FRICTION 1.3
#define REFERENCE_FRICTION 0.1

/* Contacts in double precision, of which a vector holds half as many: 2.35 by AVX-512, 1.76 by AVX2. */
#define COST_OF_DOUBLE 2.05

#define FORMAT 1

const char *const contact_law_names[] = { "walton-braun", "spring-dashpot", "hertz-mindlin", NULL };
_Static_assert(sizeof contact_law_names / sizeof *contact_law_names == CALIBRATION_LAWS + 1, "each law has a name");

/* Asked once: the answer is read from a file of the system. */
static int cores_here(void)
{
    static atomic_int known;
    if (known == 0) {
        const long cores = sysconf(_SC_NPROCESSORS_ONLN);
        known = cores < 1 ? 1 : (int)cores;
    }
    return known;
}

calibration calibration_built_in(void)
{
    return (calibration){ .program = "built-in figures",
                          .cores = cores_here(),
                          .sphere = { 28.0, 28.0, 31.0 },
                          .cluster = { 26.0, 26.0, 29.0 },
                          .size = { 1e2, 2.5e3, 2.5e4 },
                          .size_factor = { 1.2, 1.0, 1.25 },
                          .correction = 1.0 };
}

/* Between the sizes measured by the logarithm, beyond them as at the last. */
static double factor_of_size(const calibration *machine, double spheres)
{
    const double *size = machine->size, *factor = machine->size_factor;
    if (spheres <= size[0]) return factor[0];
    for (size_t k = 1; k < CALIBRATION_SIZES; k++) {
        if (spheres > size[k]) continue;
        const double share = log(spheres / size[k - 1]) / log(size[k] / size[k - 1]);
        return factor[k - 1] + share * (factor[k] - factor[k - 1]);
    }
    return factor[CALIBRATION_SIZES - 1];
}

static double factor_of_friction(double friction)
{
    return 1.0 + COST_A_DECADE_OF_FRICTION * log10(fmin(fmax(friction, 0.01), 1.0) / REFERENCE_FRICTION);
}

/* A body has work of its own, and the more spheres it is made of, the more of them lie within. Measured: 10 + 73/n ns a
 * sphere of tetrahedra (n = 4) and cubes (8). */
static double factor_of_cluster(double spheres)
{
    static const double OF_SPHERE = 10.0, OF_BODY = 73.0, MEASURED = 4.0;
    return (OF_SPHERE + OF_BODY / spheres) / (OF_SPHERE + OF_BODY / MEASURED);
}

double calibration_seconds_a_step(const calibration *machine, const calibration_load *load)
{
    const calibration built_in = calibration_built_in();
    if (!machine) machine = &built_in;
    const double one =
        load->of_particle > 1.0 ? machine->cluster[load->law] * factor_of_cluster(load->of_particle) : machine->sphere[load->law];
    const double law = (load->in_double ? COST_OF_DOUBLE : 1.0) * (load->rolling_friction ? FACTOR_OF_ROLLING_FRICTION : 1.0);
    const int threads = load->threads < machine->cores ? load->threads : machine->cores;
    return 1e-9 * one * load->spheres * factor_of_size(machine, load->spheres) * factor_of_friction(load->friction) * law
           * machine->correction / (1.0 + THREAD_GAIN * (threads - 1));
}

double calibration_pace(const calibration *machine)
{
    static const double REFERENCE = 22.0; /* ns a sphere-step of the default law on that machine */
    const calibration built_in = calibration_built_in();
    if (!machine) machine = &built_in;
    return machine->sphere[0] / REFERENCE * machine->correction;
}

double calibration_at_once(const calibration *machine, int beds)
{
    const calibration built_in = calibration_built_in();
    const int cores = machine ? machine->cores : built_in.cores;
    return beds < cores ? beds : cores;
}

double calibration_seconds_a_run(const calibration *machine, const calibration_load *load, double steps)
{
    static const double OF_RUN = 0.05, OF_STEP = 4.5e-7; /* s, beside the sphere-steps; they count where spheres are few */
    return calibration_pace(machine) * (OF_RUN + steps * OF_STEP) + steps * calibration_seconds_a_step(machine, load);
}

/* --- the file --- */

static bool read_text(const json_t *document, const char *name, char *text, size_t size)
{
    const char *value = json_string_value(json_object_get(document, name));
    if (value) snprintf(text, size, "%s", value);
    return value;
}

/* What no machine can be beyond: the fastest core takes some 5 ns a sphere-step, the slowest, under a checker, microseconds.
 * A file with other figures is damaged or invented. */
static const double COST_BOUNDS[2] = { 0.5, 1e5 }, SIZE_BOUNDS[2] = { 1.0, 1e9 }, FACTOR_BOUNDS[2] = { 0.05, 50.0 };

static bool read_within(const json_t *value, const double bounds[2], double *number)
{
    *number = json_number_value(value);
    return *number >= bounds[0] && *number <= bounds[1];
}

static bool read_costs(const json_t *costs, double cost[CALIBRATION_LAWS])
{
    bool good = true;
    for (size_t law = 0; law < CALIBRATION_LAWS; law++)
        good = good && read_within(json_object_get(costs, contact_law_names[law]), COST_BOUNDS, &cost[law]);
    return good;
}

static bool read_sizes(const json_t *sizes, calibration *machine)
{
    bool good = json_array_size(sizes) == CALIBRATION_SIZES;
    for (size_t k = 0; good && k < CALIBRATION_SIZES; k++) {
        const json_t *one = json_array_get(sizes, k);
        good = read_within(json_object_get(one, "spheres"), SIZE_BOUNDS, &machine->size[k])
               && read_within(json_object_get(one, "factor"), FACTOR_BOUNDS, &machine->size_factor[k])
               && (k == 0 || machine->size[k] > machine->size[k - 1]);
    }
    return good;
}

bool calibration_from_json(const json_t *document, calibration *machine)
{
    const json_t *costs = json_object_get(document, "nanoseconds_a_sphere_step");
    *machine = calibration_built_in();
    const bool good = json_integer_value(json_object_get(document, "format")) == FORMAT
                      && read_text(document, "processor", machine->processor, CALIBRATION_TEXT)
                      && read_text(document, "program", machine->program, CALIBRATION_TEXT)
                      && read_text(document, "made", machine->made, sizeof machine->made)
                      && read_costs(json_object_get(costs, "spheres"), machine->sphere)
                      && read_costs(json_object_get(costs, "clusters"), machine->cluster)
                      && read_sizes(json_object_get(document, "sizes"), machine);
    if (!good) *machine = calibration_built_in();
    return good;
}

static json_t *costs_to_json(const double cost[CALIBRATION_LAWS])
{
    json_t *costs = json_object();
    for (size_t law = 0; law < CALIBRATION_LAWS; law++) json_object_set_new(costs, contact_law_names[law], json_real(cost[law]));
    return costs;
}

json_t *calibration_to_json(const calibration *machine)
{
    json_t *sizes = json_array();
    for (size_t k = 0; k < CALIBRATION_SIZES; k++)
        json_array_append_new(sizes, json_pack("{s:f, s:f}", "spheres", machine->size[k], "factor", machine->size_factor[k]));
    return json_pack("{s:i, s:s, s:s, s:s, s:{s:o, s:o}, s:o}", "format", FORMAT, "processor", machine->processor, "program",
                     machine->program, "made", machine->made, "nanoseconds_a_sphere_step", "spheres",
                     costs_to_json(machine->sphere), "clusters", costs_to_json(machine->cluster), "sizes", sizes);
}
