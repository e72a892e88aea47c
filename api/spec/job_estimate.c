/* What a job will cost. Each process has its own way of telling. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "process_type.h"
#include "spec_text.h"

job_estimate job_spec_estimate(const job_spec *spec, const calibration *machine)
{
    job_estimate estimate = spec->type->estimate(spec, machine);
    if (machine) memcpy(estimate.processor, machine->processor, sizeof estimate.processor);
    return estimate;
}

/* The file's structure; each sphere with its three contacts. */
#define CHECKPOINT_FILE_BYTES 100e3
#define CHECKPOINT_SPHERE_BYTES 350.0
/* Less than that is not too much for any disk: where it doesn't fit the disk is full, and that is said. */
#define SMALL_JOB_BYTES 2e6

double scene_checkpoint_bytes(double spheres, double frame_bytes)
{
    return CHECKPOINT_FILE_BYTES + CHECKPOINT_SPHERE_BYTES * spheres + frame_bytes;
}

double job_estimate_disk_bytes(const job_estimate *estimate)
{
    return fmax(0.0, estimate->snapshot_bytes) + 3.0 * fmax(0.0, estimate->checkpoint_bytes); /* NaN counts for nothing */
}

void job_check_disk(double bytes, double free_bytes, const char *pointer, problem_list *problems)
{
    if (bytes > free_bytes && bytes > SMALL_JOB_BYTES)
        problem_list_add(
            problems, pointer,
            "makes about %.3g GB of snapshots and checkpoints; must be less than the %.3g GB that are free on the data "
            "folder's disk",
            1e-9 * bytes, 1e-9 * free_bytes);
}

static void check_limit(double value, double limit, const char *at, const char *place, const char *format, const char *option,
                        problem_list *problems)
{
    char pointer[120], said[160];
    if (!(limit > 0.0) || !(value > limit)) return;
    snprintf(pointer, sizeof pointer, "%.60s%s", at, place);
    snprintf(said, sizeof said, format, value, limit);
    problem_list_add(problems, pointer, "%s, the service's --%s", said, option);
}

void job_check_limits(const post_limits *limits, const char *at, double wall_seconds, double particles, double snapshot_bytes,
                      double threads, problem_list *problems)
{
    char words[TIME_IN_WORDS_SIZE], most[TIME_IN_WORDS_SIZE];
    if (limits->estimate_seconds > 0.0 && wall_seconds > limits->estimate_seconds) {
        time_in_words(wall_seconds, words);
        time_in_words(limits->estimate_seconds, most);
        problem_list_add(problems, at,
                         "take about %s (%.6g s) on this machine; must take at most %s (%.6g s), the service's "
                         "--max-estimate-seconds",
                         words, wall_seconds, most, limits->estimate_seconds);
    }
    check_limit(particles, limits->particles, at, "/particles", "are %.0f; must be at most %.0f", "max-particles", problems);
    check_limit(snapshot_bytes, limits->snapshot_bytes, at, "/snapshots/interval",
                "makes about %.4g bytes of snapshots; must make at most %.4g", "max-snapshot-bytes", problems);
    check_limit(threads, limits->threads, at, "/threads", "is %.0f; must be at most %.0f", "max-threads", problems);
}

json_t *job_estimate_to_json(const job_estimate *estimate)
{
    const struct {
        const char *name;
        double value;
        bool whole;
    } members[] = {
        { "particles", estimate->particles, true },
        { "steps", estimate->steps, true },
        { "time_step", estimate->time_step, false },
        { "stiffness", estimate->stiffness, false },
        { "simulated_seconds", estimate->simulated_seconds, false },
        { "settling_seconds", estimate->settling_seconds, false },
        { "settling_seconds_low", estimate->settling_seconds_low, false },
        { "settling_seconds_high", estimate->settling_seconds_high, false },
        { "wall_seconds", estimate->wall_seconds, false },
        { "memory_bytes", estimate->memory_bytes, true },
        { "snapshots", estimate->snapshots, true },
        { "snapshot_bytes", estimate->snapshot_bytes, true },
        { "checkpoint_bytes", estimate->checkpoint_bytes, true },
    };
    json_t *document = json_object();
    for (size_t m = 0; m < sizeof members / sizeof members[0]; m++) {
        if (isnan(members[m].value)) continue;
        json_object_set_new(document, members[m].name,
                            members[m].whole ? json_integer((json_int_t)members[m].value) : json_real(members[m].value));
    }
    if (*estimate->processor) json_object_set_new(document, "processor", json_string(estimate->processor));
    return document;
}
