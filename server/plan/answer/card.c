#include "card.h"

#include <stdlib.h>
#include <string.h>

#include "json_text.h"

bool card_spec(const plan_fit *fit, job_spec *spec)
{
    double values[PLAN_MOST_PARAMETERS];
    problem_list problems;
    bool good = false;
    for (size_t p = 0; p < fit->request->parameters; p++)
        values[p] = plan_from_cube(&fit->request->parameter[p], fit->posterior.best[p]);
    json_t *job = plan_test_request(fit->request, 0, values);
    if (problem_list_init(&problems)) good = job && job_spec_parse(NULL, job, 1, spec, &problems);
    problem_list_clear(&problems);
    json_decref(job);
    return good;
}

/* Of each parameter its likeliest value, and the regions that hold it. */
static json_t *found_of(const plan_fit *fit, const json_t *credible)
{
    json_t *found = json_object();
    for (size_t p = 0; p < fit->request->parameters; p++) {
        const plan_parameter *parameter = &fit->request->parameter[p];
        json_t *one = json_copy(json_object_get(credible, parameter->pointer));
        json_object_set_new(one, "value", json_real(plan_from_cube(parameter, fit->posterior.best[p])));
        json_object_set_new(found, parameter->pointer, one);
    }
    return found;
}

static json_t *told_by(const plan_fit *fit)
{
    json_t *targets = json_array();
    for (size_t v = 0; v < fit->values; v++) {
        const plan_measure *measure = &fit->request->measure[fit->measure_of[v]];
        json_array_append_new(targets, json_pack("{s:s, s:O, s:f, s:f}", "target", measure->name, "process",
                                                 json_object_get(fit->request->test[measure->test].request, "process"), "value",
                                                 measure->value, "standard_error", measure->error));
    }
    return targets;
}

json_t *card_to_json(const plan_fit *fit, const json_t *credible)
{
    static const char *const of_material[] = { "particles", "share_by", "materials", "pairs", "contact", "wall", "friction" };
    job_spec spec;
    if (!card_spec(fit, &spec)) return NULL;
    char *text = job_spec_to_text(&spec);
    json_t *document = text ? json_loads(text, 0, NULL) : NULL, *inputs = json_object_get(document, "inputs"),
           *card = json_object();
    json_object_set(card, "process", json_object_get(document, "process"));
    for (size_t i = 0; i < sizeof of_material / sizeof of_material[0]; i++)
        if (json_object_get(inputs, of_material[i])) json_object_set(card, of_material[i], json_object_get(inputs, of_material[i]));
    if (strcmp(spec.process, "granule") != 0) {
        json_object_set_new(card, "stiffness", json_real_or_null(spec.scene.contact.stiffness));
        json_object_set_new(card, "time_step", json_real_or_null(spec.scene.time_step));
    }
    json_object_set_new(card, "found", found_of(fit, credible));
    json_object_set_new(card, "told_by", told_by(fit));
    json_decref(document);
    free(text);
    job_spec_clear(&spec);
    return card;
}
