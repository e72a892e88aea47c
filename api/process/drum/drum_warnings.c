/* A drum that can be run, but was hardly meant so; and a drum in other words. */
#include <math.h>
#include <stdio.h>

#include "dem_rules.h"
#include "drum_process.h"
#include "scene_warnings.h"

/* The surface of a drum is straight below some 0.05, an S above, and none beyond 0.5 (cataracts). */
#define FAST_FROUDE 0.2

static double froude_of(const job_spec *spec)
{
    return froude_number(spec->rotation_rate, 0.5 * spec->scene.diameter, spec->scene.gravity);
}

/* Revolutions a minute taken for radians a second make nine times the rate. */
static void warn_of_rate(const job_spec *spec, problem_list *warnings)
{
    const double rate = spec->rotation_rate, froude = froude_of(spec);
    const char *what = froude >= 1.0 ? "the drum holds particles against its wall" : "the surface is no longer straight";
    if (froude > FAST_FROUDE && !isnan(spec->inputs.rate_was_rpm))
        problem_list_add(warnings, "/inputs/drum/rotation_rate_rpm", "is %.6g, which is %.4g rad/s and a Froude number of %.3g: %s",
                         spec->inputs.rate_was_rpm, rate, froude, what);
    else if (froude > FAST_FROUDE)
        problem_list_add(warnings, spec->scene.stage_count > 0 ? "/inputs/drum/rotation" : "/inputs/drum/rotation_rate",
                         "is %.6g rad/s, which is %.4g revolutions a minute and a Froude number of %.3g: %s; if %.6g revolutions a "
                         "minute were meant, give that as rotation_rate_rpm, or %.6g rad/s",
                         rate, revolutions_a_minute(rate), froude, what, rate, rotation_of_rpm(rate));
}

/* Of all stages, whichever way. */
static double revolutions_of(const job_spec *spec)
{
    const dem_scene_definition *drum = &spec->scene;
    double turned = drum->stage_count == 0 ? spec->duration * fabs(spec->rotation_rate) : 0.0;
    for (size_t k = 0; k < drum->stage_count; k++) turned += fabs(drum->stage[k].rate) * drum->stage[k].seconds;
    return turned / (2.0 * DEM_PI);
}

/* What its result will say, too, in its verdict. */
static void warn_of_what_cannot_be_told(const job_spec *spec, problem_list *warnings)
{
    const dem_scene_definition *drum = &spec->scene;
    const double revolutions = revolutions_of(spec);
    const double grain = cbrt(6.0 / DEM_PI * dem_mean_volume(drum->species, drum->species_count));
    const double layers = dem_bed_layers(drum->diameter, fmin(drum->fill_fraction, 1.0), grain);
    if (revolutions < DEM_LEAST_REVOLUTIONS)
        problem_list_add(warnings, "/inputs/duration",
                         "is %.3g revolutions: too short to tell whether the angle is steady, which takes %g at least", revolutions,
                         DEM_LEAST_REVOLUTIONS);
    else if (revolutions < 1.0 - 1e-9)
        problem_list_add(warnings, "/inputs/duration",
                         "is %.3g revolutions, less than one: the angle still shows how the bed was made", revolutions);
    if ((double)drum->particle_count < DEM_LEAST_PARTICLES || layers < DEM_LEAST_LAYERS)
        problem_list_add(warnings, "/inputs/particles",
                         "are %zu, in %.3g layers: too few to tell whether the angle is steady, which takes %d, in %d layers, "
                         "at least%s",
                         drum->particle_count, layers, DEM_LEAST_PARTICLES, DEM_LEAST_LAYERS,
                         (double)drum->particle_count < DEM_LEAST_BED_PARTICLES || layers < DEM_LEAST_BED_LAYERS
                             ? "; so few have no angle"
                             : "");
}

void drum_warn(const job_spec *spec, problem_list *warnings)
{
    warn_of_rate(spec, warnings);
    warn_of_what_cannot_be_told(spec, warnings);
    scene_warn(spec, "drum", warnings);
}

void drum_understand(const job_spec *spec, json_t *words)
{
    char time[TIME_IN_WORDS_SIZE];
    const double revolutions = revolutions_of(spec);
    time_in_words(spec->duration, time);
    rotation_understand(spec->rotation_rate, froude_of(spec), words);
    scene_understand(spec, words);
    json_object_set_new(words, "duration",
                        json_sprintf("%s%.4g revolution%s, %s of rotation", spec->until_standard_error > 0.0 ? "at most " : "",
                                     revolutions, revolutions > 0.99999 && revolutions < 1.00001 ? "" : "s", time));
}
