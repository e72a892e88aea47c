#include "run_profile.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "progress.h"

static const char *const run_part_names[RUN_PARTS] = { "measures", "snapshots", "checkpoints" };

void run_profile_begin(run_profile *profile, dem_scene *scene)
{
    if (!profile->is_on) return;
    profile->begun = profile->rotation_begun = monotonic_seconds();
    profile->first_step = dem_scene_step_count(scene);
    profile->step = (dem_step_profile){ .clock = monotonic_seconds };
    dem_scene_set_profile(scene, &profile->step);
}

void run_profile_rotating(run_profile *profile, const dem_scene *scene)
{
    if (!profile->is_on) return;
    profile->rotation_begun = monotonic_seconds();
    profile->first_step = dem_scene_step_count(scene);
    profile->step = (dem_step_profile){ .clock = monotonic_seconds };
}

void run_profile_lap_begin(run_profile *profile)
{
    if (profile->is_on) profile->lap_begin = monotonic_seconds();
}

void run_profile_lap(run_profile *profile, run_part part)
{
    if (!profile->is_on) return;
    const double now = monotonic_seconds();
    profile->seconds[part] += now - profile->lap_begin;
    profile->lap_begin = now;
}

void run_profile_look(run_profile *profile, const dem_scene *scene)
{
    const size_t n = dem_scene_sphere_count(scene);
    int32_t *contacts = profile->is_on ? malloc(n * sizeof *contacts) : NULL;
    if (!contacts) return;
    dem_scene_particles(scene, &(dem_particle_arrays){ .contacts = contacts });
    double ends = 0.0; /* those with the wall, some percent of them, among them */
    for (size_t i = 0; i < n; i++) ends += contacts[i];
    free(contacts);
    profile->pairs_touching += 0.5 * ends;
    profile->looks++;
}

/* --- the report --- */

/* Seconds a cycle, of the core as it runs now: operations of one cycle each that wait for one another. The quickest of
 * several, since something else may come between. */
static double seconds_a_cycle(void)
{
    enum { TRIALS = 10, ROUNDS = 300000, OPERATIONS = 6 };
    uint64_t state = 88172645463325252u;
    double least = INFINITY;
    for (int trial = 0; trial < TRIALS; trial++) {
        const double begin = monotonic_seconds();
        for (int k = 0; k < ROUNDS; k++) state ^= state << 13, state ^= state >> 7, state ^= state << 17;
        least = fmin(least, monotonic_seconds() - begin);
    }
    return state ? least / ((double)ROUNDS * OPERATIONS) : NAN; /* never 0: it must be computed to be known */
}

static json_t *part_of(const char *name, double seconds, double all, double sphere_steps)
{
    return json_pack("{s:s, s:f, s:f, s:f}", "part", name, "seconds", seconds, "share", seconds / all, "nanoseconds_a_sphere_step",
                     1e9 * seconds / sphere_steps);
}

json_t *run_profile_report(const run_profile *profile, const dem_scene *scene)
{
    const double all = monotonic_seconds() - profile->begun, bed = profile->rotation_begun - profile->begun;
    const double steps = fmax(1.0, (double)(dem_scene_step_count(scene) - profile->first_step));
    const double spheres = (double)dem_scene_sphere_count(scene), sphere_steps = spheres * steps;
    double rest = all - bed;
    json_t *parts = json_array();
    json_array_append_new(parts, json_pack("{s:s, s:f, s:f}", "part", "making the bed", "seconds", bed, "share", bed / all));
    for (int k = 0; k < DEM_STEP_PARTS; k++) {
        rest -= profile->step.seconds[k];
        json_array_append_new(parts, part_of(dem_step_part_name((dem_step_part)k), profile->step.seconds[k], all, sphere_steps));
    }
    for (int k = 0; k < RUN_PARTS; k++) {
        rest -= profile->seconds[k];
        json_array_append_new(parts, part_of(run_part_names[k], profile->seconds[k], all, sphere_steps));
    }
    json_array_append_new(parts, part_of("everything else", rest, all, sphere_steps));

    json_t *report =
        json_pack("{s:f, s:I, s:f, s:o}", "seconds", all, "spheres", (json_int_t)spheres, "steps", steps, "parts", parts);
    if (report && profile->looks > 0) {
        const double cycle = seconds_a_cycle(), touching = profile->pairs_touching / (double)profile->looks;
        json_object_set_new(report, "touching_pairs_a_sphere", json_real(touching / spheres));
        json_object_set_new(report, "gigahertz", json_real(1e-9 / cycle));
        json_object_set_new(report, "cycles_a_touching_pair",
                            json_real(profile->step.seconds[DEM_PART_PAIRS] / (steps * touching * cycle)));
    }
    return report;
}

void run_profile_print(const json_t *report)
{
    size_t i;
    json_t *part;
    printf("%-16s %9s %7s %18s\n", "part", "seconds", "share", "ns a sphere-step");
    json_array_foreach(json_object_get(report, "parts"), i, part)
    {
        printf("%-16s %9.3f %6.1f%%", json_string_value(json_object_get(part, "part")),
               json_number_value(json_object_get(part, "seconds")), 100.0 * json_number_value(json_object_get(part, "share")));
        const json_t *cost = json_object_get(part, "nanoseconds_a_sphere_step");
        if (cost) printf(" %18.3f", json_number_value(cost));
        printf("\n");
    }
    if (json_object_get(report, "cycles_a_touching_pair"))
        printf("%.3g pairs touch a sphere, %.3g cycles each at %.3g GHz\n",
               json_number_value(json_object_get(report, "touching_pairs_a_sphere")),
               json_number_value(json_object_get(report, "cycles_a_touching_pair")),
               json_number_value(json_object_get(report, "gigahertz")));
}
