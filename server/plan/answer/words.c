#include "words.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* A component of less counts for nothing; so does a parameter that moves no target by more of its variance. */
#define LEAST_COMPONENT 0.25
#define LEAST_EFFECT 0.01
/* Errors that a run of a few dozen is off by hardly ever. */
#define FAR_OFF 3.5

static const char *last_step(const char *pointer) { return strrchr(pointer, '/') + 1; }

void parameter_name(const plan_request *request, size_t parameter, char name[SHORT_NAME_SIZE])
{
    const char *pointer = request->parameter[parameter].pointer, *shown = last_step(pointer);
    for (size_t p = 0; p < request->parameters; p++)
        if (p != parameter && strcmp(last_step(request->parameter[p].pointer), shown) == 0) shown = pointer;
    snprintf(name, SHORT_NAME_SIZE, "%.79s", shown);
    for (char *c = name; *c && shown != pointer; c++)
        if (*c == '_') *c = ' ';
}

static void say(json_t *words, json_t *sentence) { json_array_append_new(words, sentence); }

/* --- directions --- */

/* Moves no target: of no emulator's variance more than a hundredth, or of none more than a fifth of the target's error. */
static bool has_no_effect(const findings *f, size_t parameter)
{
    for (size_t v = 0; v < f->fit->values; v++) {
        const sensitivity *s = &f->sensitivity[f->fit->measure_of[v]];
        const double moved = s->spread * sqrt(s->total[parameter]);
        if (s->total[parameter] > LEAST_EFFECT && moved > 0.2 * f->fit->measured[v].error) return false;
    }
    return true;
}

/* "more friction with less rolling friction", of the components that count. */
static void name_mixture(const plan_request *request, const double *vector, char *text, size_t size)
{
    bool is_first = true;
    text[0] = '\0';
    for (size_t p = 0; p < request->parameters; p++) {
        char name[SHORT_NAME_SIZE];
        const size_t length = strlen(text);
        if (fabs(vector[p]) < LEAST_COMPONENT) continue;
        parameter_name(request, p, name);
        snprintf(text + length, size - length, "%s%s %s", is_first ? "" : " with ", vector[p] > 0.0 ? "more" : "less", name);
        is_first = false;
    }
}

static size_t components(const plan_request *request, const double *vector, size_t *largest)
{
    size_t count = 0;
    *largest = 0;
    for (size_t p = 0; p < request->parameters; p++) {
        count += fabs(vector[p]) >= LEAST_COMPONENT;
        if (fabs(vector[p]) > fabs(vector[*largest])) *largest = p;
    }
    return count;
}

json_t *words_of_direction(const findings *f, size_t direction)
{
    const plan_request *request = f->fit->request;
    const shape_direction *d = &f->shape.direction[direction];
    char name[SHORT_NAME_SIZE], mixture[4 * SHORT_NAME_SIZE + 64];
    size_t largest;
    const size_t count = components(request, d->vector, &largest);
    parameter_name(request, largest, name);
    name_mixture(request, d->vector, mixture, sizeof mixture);
    if (count == 1 && d->is_identified)
        return json_sprintf("%s is known to %.2g %% of its range (standard deviation)", name, 100.0 * d->known_to);
    if (count == 1 && has_no_effect(f, largest))
        return json_sprintf("%s has no effect on the targets, which say nothing of it", name);
    if (count == 1) return json_sprintf("%s is hardly known: %.0f %% of its range fits", name, 100.0 * fmin(d->share, 1.0));
    if (d->is_identified)
        return json_sprintf("%s would be noticed: that direction is known to %.2g %% of the ranges (standard deviation)", mixture,
                            100.0 * d->known_to);
    return json_sprintf("they can be traded: %s fits as well, over %.0f %% of the ranges", mixture, 100.0 * fmin(d->share, 1.0));
}

/* --- the whole --- */

static void say_reach(const findings *f, json_t *words)
{
    const agreement *a = &f->agreement;
    for (size_t v = 0; v < f->fit->values; v++) {
        const plan_measure *measure = &f->fit->request->measure[f->fit->measure_of[v]];
        if (a->reach[v].is_out)
            say(words,
                json_sprintf("No values of the parameters within their ranges reach the target \"%s\": it is %.6g, and the nearest "
                             "is %.6g, %.1f errors away.",
                             measure->name, measure->value, a->reach[v].nearest, a->reach[v].z));
    }
    if (a->is_contradicted && !a->is_out)
        say(words,
            json_sprintf("The targets contradict each other: each can be reached, but not all of them by the same values (chi "
                         "square %.3g with %d degree%s of freedom; chance makes that in %.2g of all cases).",
                         a->chi_square, a->degrees, a->degrees == 1 ? "" : "s", a->probability));
}

static void say_unfinished(const findings *f, json_t *words)
{
    const plan_fit *fit = f->fit;
    for (size_t m = 0; m < fit->request->measures; m++)
        if (fit->request->measure[m].use == PLAN_FITTED && fit->of[m].points == 0)
            say(words, json_sprintf("Of the target \"%s\" only %zu runs told a value, too few to know anything of it.",
                                    fit->request->measure[m].name, fit->told[m]));
    for (size_t v = 0; v < fit->values; v++) {
        const plan_measure *measure = &fit->request->measure[fit->measure_of[v]];
        const double error = fit->error_in[fit->measure_of[v]];
        if (error > PLAN_ENOUGH_SLACK * PLAN_ENOUGH * measure->error)
            say(words, json_sprintf(
                           "The target \"%s\" is foretold to %.2g where the posterior is, beside its own error of %.2g: more runs "
                           "would tell more.",
                           measure->name, error, measure->error));
    }
}

static void say_effects(const findings *f, json_t *words)
{
    const plan_fit *fit = f->fit;
    char name[SHORT_NAME_SIZE];
    for (size_t p = 0; fit->values > 0 && p < fit->request->parameters; p++) {
        parameter_name(fit->request, p, name);
        if (has_no_effect(f, p)) say(words, json_sprintf("No target depends on %s within its range.", name));
    }
    for (size_t v = 0; v < fit->values; v++) {
        const size_t m = fit->measure_of[v];
        if (f->sensitivity[m].spread < 0.5 * fit->measured[v].error)
            say(words, json_sprintf("The target \"%s\" says little: over all ranges it varies by %.2g, beside its error of %.2g.",
                                    fit->request->measure[m].name, f->sensitivity[m].spread, fit->measured[v].error));
    }
}

static void say_islands(const findings *f, json_t *words)
{
    const plan_request *request = f->fit->request;
    char text[MOST_ISLANDS * PLAN_MOST_PARAMETERS * (SHORT_NAME_SIZE + 20)] = "";
    if (f->shape.islands < 2) return;
    for (size_t s = 0; s < f->shape.islands; s++) {
        for (size_t p = 0; p < request->parameters; p++) {
            char name[SHORT_NAME_SIZE];
            const size_t length = strlen(text);
            parameter_name(request, p, name);
            snprintf(text + length, sizeof text - length, "%s%s %.3g",
                     p   ? ", "
                     : s ? "; or "
                         : "",
                     name, plan_from_cube(&request->parameter[p], f->shape.island[s][p]));
        }
    }
    say(words, json_sprintf("%zu sets of values, apart from each other, fit: about %s.", f->shape.islands, text));
}

static void say_failed(const findings *f, json_t *words)
{
    size_t failed = 0;
    for (size_t i = 0; i < f->fit->table->count; i++) failed += f->fit->table->run[i].has_failed;
    if (failed > 0)
        say(words, json_sprintf("%zu of the %zu runs failed; what the tests give there is told by the runs around them alone.",
                                failed, f->fit->table->count));
}

static void say_verified(const findings *f, json_t *words)
{
    if (f->verified == 0) say(words, json_string("Nothing was verified by fresh runs: no jobs were left for it."));
    if (!f->check.is_refuted && f->check.worst > FAR_OFF * FAR_OFF)
        say(words, json_sprintf(
                       "One of the fresh runs is %.1f errors off what the emulators foretold, the others are not: a single bed may "
                       "differ by more than the others.",
                       sqrt(f->check.worst)));
    if (f->check.is_refuted)
        say(words,
            json_sprintf("The fresh runs differ from what the emulators foretold by more than their errors (chi square %.3g of %d "
                         "values): the tests vary in ways that these runs have not caught, and the posterior is not to be trusted.",
                         f->check.chi_square, f->check.runs));
}

json_t *words_of_answer(const findings *f)
{
    json_t *words = json_array();
    say_reach(f, words);
    say_unfinished(f, words);
    say_islands(f, words);
    for (size_t d = f->fit->request->parameters; f->fit->values > 0 && d-- > 0;) {
        size_t largest;
        const bool is_single = components(f->fit->request, f->shape.direction[d].vector, &largest) == 1;
        if (!f->shape.direction[d].is_identified && !(is_single && has_no_effect(f, largest))) say(words, words_of_direction(f, d));
    }
    say_effects(f, words);
    say_failed(f, words);
    say_verified(f, words);
    return words;
}
