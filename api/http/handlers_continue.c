/* A job that goes on from where another one is: a new job, whose specification is the other's with more to do, perhaps at another
 * rate, and which starts from the other's checkpoint. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "handlers.h"
#include "spec_text.h"

/* What may be given, and the input that it becomes. */
static const struct member {
    const char *name, *group;
} members[] = {
    { "revolutions", "duration" }, { "seconds", "duration" }, { "rotation_rate", "drum" }, { "rotation_rate_rpm", "drum" }
};
enum { MEMBERS = sizeof members / sizeof members[0], DURATIONS = 2 };

static void check_members(const json_t *wanted, problem_list *problems)
{
    static const char *const known[] = { "revolutions", "seconds",  "rotation_rate", "rotation_rate_rpm",
                                         "label",       "priority", "resources",     NULL };
    int durations = 0;
    if (!json_is_object(wanted)) {
        problem_list_add(problems, "", "must be an object with \"revolutions\" or \"seconds\"");
        return;
    }
    refuse_unknown_members(wanted, "", known, problems);
    for (int m = 0; m < DURATIONS; m++) durations += json_object_get(wanted, members[m].name) != NULL;
    if (durations != 1)
        problem_list_add(problems, "", "%s; must say how long the job goes on by one of revolutions and seconds",
                         durations ? "has both revolutions and seconds" : "has neither revolutions nor seconds");
    const json_t *label = json_object_get(wanted, "label");
    if (label && !json_is_object(label)) problem_list_add(problems, "/label", "must be an object of texts and numbers");
}

/* A drum that turned in stages goes on at the rate of the last that turned the way of the first, which contacts remember. */
static void end_stages(json_t *drum)
{
    size_t k;
    json_t *stage, *rate = NULL;
    json_array_foreach(json_object_get(drum, "rotation"), k, stage)
    {
        json_t *const one = json_object_get(stage, "rate");
        const double value = json_number_value(one);
        if (rate ? value * json_number_value(rate) > 0.0 : fabs(value) > 0.0) rate = one;
    }
    if (rate) json_object_set(drum, "rotation_rate", rate);
    json_object_del(drum, "rotation");
}

/* In place of how long the parent ran, and at which rate. */
static void set_wanted(json_t *inputs, const json_t *wanted)
{
    json_t *drum = json_object_get(inputs, "drum");
    json_object_set_new(inputs, "duration", json_object());
    end_stages(drum);
    for (int m = 0; m < MEMBERS; m++) {
        json_t *value = json_object_get(wanted, members[m].name);
        if (!value) continue;
        if (m >= DURATIONS) json_object_del(drum, "rotation_rate");
        json_object_set(json_object_get(inputs, members[m].group), members[m].name, value);
    }
    /* Both were given: that is refused as everywhere. */
    if (json_object_get(wanted, "rotation_rate")) json_object_set(drum, "rotation_rate", json_object_get(wanted, "rotation_rate"));
}

/* The parent's specification, as it is to go on. NULL: no memory. */
static json_t *continued(json_t *spec, const job_record *parent, const json_t *wanted)
{
    json_t *inputs = json_object_get(spec, "inputs"), *label = json_object_get(spec, "label");
    json_object_update(label, json_object_get(wanted, "label"));
    json_object_set_new(label, "parent", json_string(parent->id));
    json_object_set_new(inputs, "start", json_pack("{s:s, s:b}", "job", parent->id, "checkpoint", 1));
    json_object_del(inputs, "beds");          /* the first of several goes on */
    json_object_del(inputs, "fill_fraction"); /* as many particles as there are */
    json_object_del(inputs, "particle_count");
    set_wanted(inputs, wanted);
    json_t *priority = json_object_get(wanted, "priority");
    json_object_set_new(spec, "priority", priority ? json_incref(priority) : json_integer(parent->priority));
    json_t *resources = json_object_get(wanted, "resources");
    if (resources) json_object_set(spec, "resources", resources);
    return spec;
}

/* What is wrong with an input is wrong with the member that it was made of. */
static void tell_by_member(problem_list *problems)
{
    size_t i;
    json_t *problem;
    json_array_foreach(problems->errors, i, problem)
    {
        const char *pointer = json_string_value(json_object_get(problem, "pointer"));
        for (int m = 0; m < MEMBERS; m++) {
            char place[80];
            const size_t length = (size_t)snprintf(place, sizeof place, "/inputs/%s/%s", members[m].group, members[m].name);
            if (strncmp(pointer, place, length) != 0 || (pointer[length] && pointer[length] != '/')) continue;
            json_object_set_new(problem, "pointer", json_sprintf("/%s%s", members[m].name, pointer + length));
            break;
        }
    }
}

/* Why there is nothing to go on from; "": there is. */
static void look_for_state(api_service *service, const job_record *parent, char why_not[160])
{
    start_source beds = store_beds(service->store);
    start_inputs start = { .given = 1.0, .snapshot = NAN, .checkpoint = 1.0 };
    problem_list problems;
    double particles;
    snprintf(start.job, sizeof start.job, "%s", parent->id);
    why_not[0] = '\0';
    if (strcmp(parent->process, "drum") != 0) {
        snprintf(why_not, 160, "it is a %s, and only a drum goes on for as long as it is turned", parent->process);
        return;
    }
    if (!problem_list_init(&problems)) return;
    json_decref(beds.find(beds.context, &start, &particles, &problems));
    if (!problem_list_is_empty(&problems))
        snprintf(why_not, 160, "it is %s and has no checkpoint%s", job_status_name(parent->status),
                 parent->status == JOB_ACCEPTED || parent->status == JOB_RUNNING ? " yet" : "");
    problem_list_clear(&problems);
}

static void go_on(api_service *service, const http_request *request, http_response *response, const job_record *parent,
                  const json_t *wanted)
{
    char *text = NULL;
    problem_list problems;
    const store_status status = store_read_spec(service->store, parent->id, &text);
    json_t *spec = status == STORE_OK ? json_loads(text, 0, NULL) : NULL;
    free(text);
    if (!spec || !problem_list_init(&problems)) {
        respond_store_failure(response, status == STORE_OK ? STORE_FAILED : status, "read the job");
        json_decref(spec);
        return;
    }
    execute_document(service, request, response, continued(spec, parent, wanted), &problems);
    if (!problem_list_is_empty(&problems)) {
        tell_by_member(&problems);
        http_respond_problems(response, 400, "The specification can't be run",
                              "each entry of errors names a member, what it is and what it may be", &problems);
    }
    problem_list_clear(&problems);
    json_decref(spec);
}

void continue_job(api_service *service, const http_request *request, http_response *response)
{
    job_record parent;
    problem_list problems;
    char why_not[160];
    json_t *wanted = parse_body(request, response);
    if (!wanted) return;
    if (!problem_list_init(&problems)) {
        json_decref(wanted);
        return;
    }
    check_members(wanted, &problems);
    if (find_job(service, request, response, &parent)) {
        look_for_state(service, &parent, why_not);
        if (why_not[0])
            http_respond_problem(response, 409, NULL, "The job can't be continued", "job %s has no state to go on from: %s",
                                 parent.id, why_not);
        else if (!problem_list_is_empty(&problems))
            http_respond_problems(response, 400, "The specification can't be run",
                                  "each entry of errors names a member, what it is and what it may be", &problems);
        else go_on(service, request, response, &parent, wanted);
        job_record_clear(&parent);
    }
    problem_list_clear(&problems);
    json_decref(wanted);
}
