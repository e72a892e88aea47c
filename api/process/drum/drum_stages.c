#include "drum_stages.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "dem_rules.h"
#include "scene_rules.h"
#include "start_rules.h"

enum { LONGEST_PLACE = 60 };
static const double LEAST_RATE = 0.001; /* rad/s, as of rotation_rate */

static double seconds_of(const stage_inputs *s)
{
    return isnan(s->seconds) ? s->revolutions * 2.0 * DEM_PI / fabs(s->rate) : s->seconds;
}

static void check_stage(const stage_inputs *s, size_t k, problem_list *problems)
{
    char pointer[LONGEST_PLACE];
    snprintf(pointer, sizeof pointer, "/inputs/drum/rotation/%zu/rate", k);
    if (fabs(s->rate) > 0.0 && fabs(s->rate) < LEAST_RATE)
        problem_list_add(problems, pointer, "is %g rad/s; must be 0 or at least %g rad/s in size", s->rate, LEAST_RATE);
    pointer[strlen(pointer) - strlen("/rate")] = '\0';
    if (isnan(s->rate)) return; /* refused, or missing */
    if (s->rate == 0.0 && !isnan(s->revolutions))
        problem_list_add(problems, pointer, "has a rate of 0 and revolutions, which take for ever; give its seconds");
    else if (isnan(s->revolutions) && isnan(s->seconds))
        problem_list_add(problems, pointer,
                         "has neither revolutions nor seconds in their ranges; must say by one of them how long "
                         "it is");
}

static void check_beside(const job_spec *spec, problem_list *problems)
{
    size_t k;
    json_t *name;
    json_array_foreach(spec->given, k, name)
    {
        const char *given = json_string_value(name);
        char pointer[LONGEST_PLACE];
        if (strncmp(given, "duration/", strlen("duration/")) != 0) continue;
        snprintf(pointer, sizeof pointer, "/inputs/%.40s", given);
        problem_list_add(problems, pointer,
                         "is given beside /inputs/drum/rotation, whose stages say how long the drum turns; give one "
                         "of the two");
    }
}

void stages_derive(job_spec *spec, problem_list *problems)
{
    scene_inputs *const inputs = &spec->inputs;
    bool turns = false, are_known = true;
    spec->duration = 0.0;
    for (size_t k = 0; k < inputs->stage_count; k++) {
        check_stage(&inputs->stages[k], k, problems);
        spec->duration += seconds_of(&inputs->stages[k]);
        turns = turns || fabs(inputs->stages[k].rate) > 0.0;
        are_known = are_known && !isnan(inputs->stages[k].rate);
    }
    if (are_known && !turns)
        problem_list_add(problems, "/inputs/drum/rotation", "has no stage in which the drum turns; must have one at least");
    check_beside(spec, problems);
    spec->until_standard_error = 0.0;
    inputs->revolutions = inputs->seconds = NAN; /* the stages stand for them */
}

double stages_fastest(const scene_inputs *inputs)
{
    double fastest = NAN;
    for (size_t k = 0; k < inputs->stage_count; k++)
        if (!(fabs(inputs->stages[k].rate) <= fabs(fastest))) fastest = inputs->stages[k].rate;
    return fastest;
}

double stages_sample_interval(const scene_inputs *inputs, double per_revolution)
{
    double interval = INFINITY;
    for (size_t k = 0; k < inputs->stage_count; k++) {
        const double seconds = seconds_of(&inputs->stages[k]), rate = fabs(inputs->stages[k].rate);
        interval = fmin(interval, seconds / SCENE_SAMPLES_PER_RUN);
        if (rate > 0.0) interval = fmin(interval, 2.0 * DEM_PI / rate / per_revolution);
    }
    return interval;
}

void stages_define(const scene_inputs *inputs, dem_scene_definition *drum)
{
    const double sense = turns_back(inputs) ? -1.0 : 1.0;
    drum->stage_count = inputs->stage_count;
    for (size_t k = 0; k < inputs->stage_count; k++)
        drum->stage[k] = (dem_rotation_stage){ sense * inputs->stages[k].rate, seconds_of(&inputs->stages[k]) };
}
