/* Warnings: what can be run, but was hardly meant so. And what a job's inputs come to in other words, for whoever wants to
 * see at a glance that they were understood as they were meant. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "dem_rules.h"
#include "process_type.h"
#include "spec_text.h"

#define LONG_JOB 3600.0 /* s: nobody waits for it */
#define MANY_SNAPSHOT_BYTES 2e10
#define EVERY_MACHINE_HAS 1e8 /* bytes of memory: a job that needs less does not ask the system, ten thousand times for a study */

/* In two units, of which the second is rounded; what is shorter than a minute in one. */
void time_in_words(double seconds, char text[TIME_IN_WORDS_SIZE])
{
    static const struct {
        double seconds;
        const char *unit;
    } units[] = { { 86400.0, "days" }, { 3600.0, "h" }, { 60.0, "min" }, { 1.0, "s" } };
    for (size_t u = 0; u + 1 < sizeof units / sizeof units[0]; u++) {
        const double step = units[u + 1].seconds, rounded = step * round(seconds / step), whole = floor(rounded / units[u].seconds);
        const double rest = (rounded - whole * units[u].seconds) / step;
        if (!(rounded >= units[u].seconds)) continue;
        const int length = snprintf(text, TIME_IN_WORDS_SIZE, "%.0f %s", whole, u == 0 && whole < 2.0 ? "day" : units[u].unit);
        if (rest > 0.0) snprintf(text + length, TIME_IN_WORDS_SIZE - (size_t)length, " %.0f %s", rest, units[u + 1].unit);
        return;
    }
    snprintf(text, TIME_IN_WORDS_SIZE, seconds < 1.0 ? "%.3g ms" : "%.3g s", seconds < 1.0 ? 1000.0 * seconds : seconds);
}

double rotation_of_rpm(double rpm) { return rpm * 2.0 * DEM_PI / 60.0; }

static const spec_field *input(const job_spec *spec, const char *name)
{
    return spec_field_find(spec->type->inputs, SPEC_INPUTS, name);
}

static void warn_of_memory(double bytes, problem_list *warnings)
{
    if (!(bytes > EVERY_MACHINE_HAS)) return;
    const double memory = (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE);
    if (memory > 0.0 && bytes > memory)
        problem_list_add(warnings, "/inputs", "need about %.3g GB of memory, but this machine has %.3g GB", 1e-9 * bytes,
                         1e-9 * memory);
}

/* What the job asks of the machine. */
static void warn_of_cost(const job_spec *spec, const calibration *machine, problem_list *warnings)
{
    const job_estimate cost = job_spec_estimate(spec, machine);
    const int cores = machine ? machine->cores : calibration_built_in().cores;
    char words[TIME_IN_WORDS_SIZE];
    time_in_words(cost.wall_seconds, words);
    if (spec->threads > cores)
        problem_list_add(warnings, "/inputs/threads", "is %d, but this machine has %d core%s: more threads bring no speed",
                         spec->threads, cores, cores == 1 ? "" : "s");
    if (cost.wall_seconds > LONG_JOB)
        problem_list_add(warnings, input(spec, "duration") ? "/inputs/duration" : "/inputs",
                         "makes about %.3g steps, which take about %s on this machine", cost.steps, words);
    warn_of_memory(cost.memory_bytes, warnings);
    if (cost.snapshot_bytes > MANY_SNAPSHOT_BYTES)
        problem_list_add(warnings, "/inputs/snapshots/interval", "makes %.0f snapshots, about %.3g GB in all", cost.snapshots,
                         1e-9 * cost.snapshot_bytes);
}

void job_spec_warn(const job_spec *spec, const calibration *machine, problem_list *warnings)
{
    spec_inputs_warn(spec->type->inputs, (const char *)spec + spec->type->inputs_at, warnings);
    if (spec->type->warn) spec->type->warn(spec, warnings);
    warn_of_cost(spec, machine, warnings);
}

json_t *job_warnings_to_json(const problem_list *warnings)
{
    json_t *list = json_array(), *warning;
    size_t i;
    json_array_foreach(warnings->errors, i, warning)
    {
        json_array_append_new(list, json_pack("{s:O, s:O}", "field", json_object_get(warning, "pointer"), "text",
                                              json_object_get(warning, "detail")));
    }
    return list;
}

json_t *job_spec_warnings(const job_spec *spec, const calibration *machine)
{
    problem_list warnings;
    if (!problem_list_init(&warnings)) return NULL;
    job_spec_warn(spec, machine, &warnings);
    json_t *list = job_warnings_to_json(&warnings);
    problem_list_clear(&warnings);
    return list;
}

json_t *job_spec_understood(const job_spec *spec, const calibration *machine)
{
    json_t *words = json_object();
    const job_estimate cost = job_spec_estimate(spec, machine);
    char text[TIME_IN_WORDS_SIZE];
    if (spec->type->understand) spec->type->understand(spec, words);
    time_in_words(cost.wall_seconds, text);
    json_object_set_new(words, "wall_time", json_sprintf("about %s", text));
    return words;
}

json_t *job_spec_report(const job_spec *spec, const calibration *machine)
{
    const job_estimate estimate = job_spec_estimate(spec, machine);
    return json_pack("{s:o, s:o, s:o, s:o}", "spec", job_spec_to_json(spec), "estimate", job_estimate_to_json(&estimate),
                     "understood", job_spec_understood(spec, machine), "warnings", job_spec_warnings(spec, machine));
}
