/* A bed of the paper's spheres in a drum of 20 diameters, and one of tetrahedra, are made and turned until they flow, with
 * the stiffness and the step that a run would have: a soft bed is quicker to make, but bursts when it is made stiff, and
 * few spheres touch then. Each law goes on from the same bed, without what its contacts remembered. How cost grows with
 * size is seen while beds of several sizes grow. All of it by processor time, so that other programs on the machine
 * matter little. */
#include "calibrate.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "dem.h"
#include "job_spec.h"
#include "json_text.h"
#include "measuring_time.h"
#include "processor_name.h"
#include "version.h"
#include "worker_log.h"

/* drum diameter, length, the particle's shape, law, largest overlap, particle_count or fill_fraction */
#define BED                                                                                                                        \
    "{\"inputs\": {\"drum\": {\"diameter\": %g, \"length\": %g, \"rotation_rate\": 2.0}, \"particles\": [{\"shape\": \"%s\","      \
    " \"diameter\": 0.00378}], \"contact\": {\"law\": \"%s\", \"friction\": 0.1, \"maximum_overlap\": %g},"                        \
    " \"duration\": {\"revolutions\": 1}, \"seed\": 1}}"
#define DRUM_DIAMETER 0.0756
#define AS_USUAL 0.01
#define CLUSTERS_USUAL 0.02     /* as in the paper's rows of clusters */
#define FLOWING_SECONDS 0.2     /* of rotation, until the bed flows */
#define GROWING_BY_FLOWING 1.35 /* cost of a flowing bed by that of one that grows */

#define IN_PART ", in part" /* behind the program's name: so it is no current calibration, and measured again */

enum { WARMING_STEPS = 1000, MEASURED_STEPS = 3000, GROWING_STEPS = 400, STEPS_BETWEEN_LOOKS = 200 };

static double processor_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static bool define(double diameter, double length, const char *shape, const char *law, double overlap, dem_scene_definition *drum)
{
    char text[600];
    problem_list problems;
    job_spec spec;
    snprintf(text, sizeof text, BED, diameter, length, shape, law, overlap);
    if (!problem_list_init(&problems)) return false;
    json_t *request = json_loads(text, 0, NULL);
    const bool good = request && job_spec_parse("drum", request, 1, &spec, &problems);
    if (good) {
        *drum = spec.scene;
        job_spec_clear(&spec);
    }
    json_decref(request);
    problem_list_clear(&problems);
    return good;
}

static double median_of_three(const double x[3]) { return fmax(fmin(x[0], x[1]), fmin(fmax(x[0], x[1]), x[2])); }

/* False: it failed, or there is no time left. */
static bool advance(dem_scene *scene, int64_t steps)
{
    bool good = true;
    for (int64_t done = 0; good && done < steps; done += STEPS_BETWEEN_LOOKS) {
        const int64_t rest = steps - done;
        good =
            measuring_time_is_left() && dem_scene_advance(scene, rest < STEPS_BETWEEN_LOOKS ? rest : STEPS_BETWEEN_LOOKS) == DEM_OK;
    }
    return good;
}

static bool advance_anyway(dem_scene *scene, int64_t steps)
{
    measuring_time_is_left(); /* for what it does where there is little */
    return dem_scene_advance(scene, steps) == DEM_OK;
}

/* ns a sphere-step. 0: it failed. */
static double cost_of(dem_scene *scene, int64_t steps, bool (*go)(dem_scene *, int64_t))
{
    double cost[3];
    for (int window = 0; window < 3; window++) {
        const double begin = processor_seconds();
        if (!go(scene, steps)) return 0.0;
        cost[window] = 1e9 * (processor_seconds() - begin) / ((double)steps * (double)dem_scene_sphere_count(scene));
    }
    return median_of_three(cost);
}

/* What a contact remembers means something else to another law or stiffness. */
static void forget_contacts(dem_state *state)
{
    static const char *const names[] = { "pair", "pair_history", "wall_contact", "wall_history" };
    for (size_t k = 0; k < state->array_count; k++)
        for (size_t n = 0; n < sizeof names / sizeof names[0]; n++)
            if (strcmp(state->array[k].name, names[n]) == 0) state->array[k].rows = 0;
}

/* A bed that flows, of which others start. */
static bool make_bed(const dem_scene_definition *drum, dem_state *state)
{
    dem_scene *scene;
    if (dem_scene_create(drum, &scene) != DEM_OK) return false;
    bool good = true;
    while (good && dem_scene_phase(scene) != DEM_PHASE_RUNNING) good = advance(scene, 100);
    good = good && advance(scene, (int64_t)(FLOWING_SECONDS / drum->time_step)) && dem_scene_save(scene, state) == DEM_OK;
    dem_scene_free(scene);
    if (good) forget_contacts(state);
    return good;
}

static double cost_from_bed(const dem_scene_definition *drum, const dem_state *state)
{
    dem_scene *scene;
    double cost = 0.0;
    if (dem_scene_create(drum, &scene) != DEM_OK) return 0.0;
    if (dem_scene_restore(scene, state) == DEM_OK && advance(scene, WARMING_STEPS)) cost = cost_of(scene, MEASURED_STEPS, advance);
    dem_scene_free(scene);
    return cost;
}

/* Each law's cost in one bed of this shape; laws from 0 to `laws`. */
static bool measure_laws(const char *shape, double length, double overlap, int laws, double cost[CALIBRATION_LAWS])
{
    dem_scene_definition drum;
    dem_state state = { .array_count = 0 };
    bool good = define(DRUM_DIAMETER, length, shape, contact_law_names[0], overlap, &drum) && make_bed(&drum, &state);
    for (int law = 0; good && law < laws; law++) {
        good = define(DRUM_DIAMETER, length, shape, contact_law_names[law], overlap, &drum);
        if (good) cost[law] = cost_from_bed(&drum, &state);
        good = good && cost[law] > 0.0;
    }
    dem_state_clear(&state);
    return good;
}

static double cost_of_growing(double diameter, double length, int64_t steps, double *spheres)
{
    dem_scene_definition drum;
    dem_scene *scene;
    if (!define(diameter, length, "sphere", contact_law_names[0], AS_USUAL, &drum)) return 0.0;
    if (dem_scene_create(&drum, &scene) != DEM_OK) return 0.0;
    *spheres = (double)dem_scene_sphere_count(scene);
    const double cost = advance_anyway(scene, 200) ? cost_of(scene, steps, advance_anyway) : 0.0;
    dem_scene_free(scene);
    return cost;
}

/* Relative to the bed in which the laws are measured. The whole takes a third of a second, and gives how fast the machine is
 * beside the one of the built-in figures: all that is known where there is no time for more. */
static bool measure_sizes(calibration *machine)
{
    static const struct {
        double diameter, length;
        int64_t steps;
    } beds[CALIBRATION_SIZES] = { { 0.04, 0.01512, 6 * GROWING_STEPS },
                                  { DRUM_DIAMETER, 0.0252, 2 * GROWING_STEPS },
                                  { 0.126, 0.15, GROWING_STEPS / 4 } };
    double cost[CALIBRATION_SIZES];
    for (size_t k = 0; k < CALIBRATION_SIZES; k++) {
        cost[k] = cost_of_growing(beds[k].diameter, beds[k].length, beds[k].steps, &machine->size[k]);
        if (!(cost[k] > 0.0)) return false;
    }
    for (size_t k = 0; k < CALIBRATION_SIZES; k++) machine->size_factor[k] = cost[k] / cost[1];
    const double pace = cost[1] * GROWING_BY_FLOWING / machine->sphere[0];
    for (int law = 0; law < CALIBRATION_LAWS; law++) {
        machine->sphere[law] *= pace;
        machine->cluster[law] *= pace;
    }
    return true;
}

/* --- whose it is --- */

/* Every build has a time and a size of its own. */
static void name_program(char text[CALIBRATION_TEXT])
{
    struct stat program;
    if (stat("/proc/self/exe", &program) != 0) program = (struct stat){ .st_size = 0 };
    snprintf(text, CALIBRATION_TEXT, "repose " REPOSED_VERSION ", %lld bytes, built at %lld", (long long)program.st_size,
             (long long)program.st_mtim.tv_sec);
}

/* What there was no time for is left as it follows from the sizes. False: not even these were measured. */
static bool measure(calibration *machine, bool *whole)
{
    measuring_time_begin();
    *whole = false;
    *machine = calibration_built_in();
    snprintf(machine->processor, CALIBRATION_TEXT, "%s", processor_name());
    name_program(machine->program);
    const time_t now = time(NULL);
    struct tm utc;
    gmtime_r(&now, &utc);
    strftime(machine->made, sizeof machine->made, "%Y-%m-%dT%H:%M:%S.000Z", &utc);
    if (!measure_sizes(machine)) {
        *machine = calibration_built_in();
        return false;
    }
    calibration better = *machine;
    *whole = measure_laws("sphere", 0.0252, AS_USUAL, CALIBRATION_LAWS, better.sphere)
             && measure_laws("tetrahedron", 0.0264, CLUSTERS_USUAL, 1, better.cluster);
    /* Joining spheres costs the same with any law. */
    for (int law = 1; law < CALIBRATION_LAWS; law++)
        better.cluster[law] = better.cluster[0] + better.sphere[law] - better.sphere[0];
    if (*whole) *machine = better;
    else snprintf(machine->program + strlen(machine->program), CALIBRATION_TEXT - strlen(machine->program), IN_PART);
    return true;
}

bool calibrate_is_current(const calibration *machine)
{
    char program[CALIBRATION_TEXT];
    name_program(program);
    return strcmp(machine->processor, processor_name()) == 0 && strcmp(machine->program, program) == 0;
}

/* --- where it is kept --- */

static bool is_folder(const char *path)
{
    struct stat found;
    return stat(path, &found) == 0 && S_ISDIR(found.st_mode);
}

/* Its parent is there, or made here; private, as caches are. */
static bool make_folder(const char *path) { return mkdir(path, 0700) == 0 || errno == EEXIST; }

/* Where programs of a user keep what they can make again. */
static bool find_cache(char *path, size_t size)
{
    const char *cache = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
    if (cache && cache[0] == '/') snprintf(path, size, "%s", cache);
    else if (home && home[0] == '/') snprintf(path, size, "%s/.cache", home);
    else return false;
    const size_t length = strlen(path);
    const bool there = make_folder(path);
    snprintf(path + length, size - length, "/reposed");
    return there && make_folder(path);
}

/* Whole or not at all: several may be at it. */
static bool keep(const calibration *machine, const char *folder)
{
    char path[4200], temporary[4300];
    snprintf(path, sizeof path, "%s/" CALIBRATION_FILE, folder);
    snprintf(temporary, sizeof temporary, "%s.%d.tmp", path, (int)getpid());
    json_t *document = calibration_to_json(machine);
    char *text = document ? json_text_write(document) : NULL;
    json_decref(document);
    FILE *file = text ? fopen(temporary, "we") : NULL;
    bool good = file && fputs(text, file) >= 0;
    if (file) good = fclose(file) == 0 && good;
    good = good && rename(temporary, path) == 0;
    if (file && !good) unlink(temporary);
    free(text);
    return good;
}

static void load(const char *folder, calibration *machine)
{
    char path[4200];
    snprintf(path, sizeof path, "%s/" CALIBRATION_FILE, folder);
    json_t *document = json_load_file(path, JSON_REJECT_DUPLICATES, NULL);
    calibration_from_json(document, machine);
    json_decref(document);
}

/* Two that measure at once would disturb each other, and many the machine. The lock is on the program itself, to be had
 * without any folder, and goes with the process. */
static bool is_the_only_one(void)
{
    const int program = open("/proc/self/exe", O_RDONLY | O_CLOEXEC); /* stays open */
    return program < 0 || flock(program, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
}

bool calibrate(const char *wish, calibration *machine, bool *is_new)
{
    char cache[4096];
    const char *folder = wish ? wish : is_folder("data") ? "data" : NULL;
    const bool has_folder = folder && make_folder(folder), has_cache = find_cache(cache, sizeof cache);
    *is_new = false;
    if (has_folder) load(folder, machine);
    if (has_folder && calibrate_is_current(machine)) return true;
    if (has_cache) load(cache, machine);
    if (!has_cache || !calibrate_is_current(machine)) {
        if (!is_the_only_one()) {
            *machine = calibration_built_in();
            worker_warn("another process measures this machine's speed: estimates are rough until it is done");
            return false;
        }
        bool whole;
        if (!measure(machine, &whole)) {
            worker_warn("this machine's speed could not be measured: estimates are rough");
            return false;
        }
        *is_new = true;
        if (!whole) worker_warn("this machine has much else to do, and its speed was measured in part: it will be again");
        if (has_cache && whole) keep(machine, cache); /* a convenience: who has no room there has it in the folder */
    }
    if (folder && (!has_folder || !keep(machine, folder)))
        worker_warn("%s can't be kept in %s: %s", CALIBRATION_FILE, folder, strerror(errno));
    return true;
}
