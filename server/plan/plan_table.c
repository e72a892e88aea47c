#include "plan_table.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "spec_text.h"

const char *const plan_stage_names[STAGES] = { "start", "refine", "verify" };

double plan_to_cube(const plan_parameter *parameter, double value)
{
    const double x = parameter->is_log ? log(value / parameter->low) / log(parameter->high / parameter->low)
                                       : (value - parameter->low) / (parameter->high - parameter->low);
    return fmin(fmax(x, 0.0), 1.0);
}

double plan_from_cube(const plan_parameter *parameter, double x)
{
    const double value = parameter->is_log ? parameter->low * pow(parameter->high / parameter->low, x)
                                           : parameter->low + x * (parameter->high - parameter->low);
    return fmin(fmax(value, parameter->low), parameter->high);
}

static bool read_index(const json_t *value, size_t count, size_t *index)
{
    if (!json_is_integer(value) || json_integer_value(value) < 0 || json_integer_value(value) >= (json_int_t)count) return false;
    *index = (size_t)json_integer_value(value);
    return true;
}

static bool read_values(const plan_request *request, const json_t *values, plan_run *run)
{
    for (size_t p = 0; p < request->parameters; p++) {
        const json_t *value = json_object_get(values, request->parameter[p].pointer);
        if (!json_is_number(value)) return false;
        run->value[p] = json_number_value(value);
        run->x[p] = plan_to_cube(&request->parameter[p], run->value[p]);
        if (!isfinite(run->x[p])) return false;
    }
    return true;
}

/* What job statuses of the service say. Results of a job that was not successful count for nothing. */
static bool read_status(const char *status, const json_t *results, plan_run *run)
{
    static const char *const over[] = { "successful", "failed", "dismissed", NULL }, *const under_way[] = { "accepted", "running",
                                                                                                            NULL };
    for (size_t k = 0; status && under_way[k]; k++)
        if (strcmp(status, under_way[k]) == 0) return true;
    for (size_t k = 0; status && over[k]; k++) {
        if (strcmp(status, over[k]) != 0) continue;
        run->is_over = true;
        run->has_failed = k > 0;
        run->results = k == 0 && json_is_object(results) ? results : NULL;
        return true;
    }
    return false;
}

static void read_run(const plan_request *request, const json_t *given, size_t index, plan_run *run, problem_list *problems)
{
    char place[48];
    snprintf(place, sizeof place, "/runs/%zu", index);
    const json_t *number = json_object_get(given, "number"), *set = json_object_get(given, "set");
    const char *stage = json_string_value(json_object_get(given, "stage"));
    size_t s = 0;
    *run = (plan_run){ .number = json_integer_value(number) };
    while (s < STAGES && !(stage && strcmp(stage, plan_stage_names[s]) == 0)) s++;
    run->stage = (plan_stage)s;
    if (!json_is_integer(number) || s == STAGES || !read_index(json_object_get(given, "test"), request->tests, &run->test)
        || (set && !read_index(set, SIZE_MAX / 4, &run->set)) || !read_values(request, json_object_get(given, "parameters"), run)
        || !read_status(json_string_value(json_object_get(given, "status")), json_object_get(given, "results"), run))
        problem_list_add(problems, place,
                         "is no run of this calibration: must be a case as the planner wrote it, with its \"status\" "
                         "(accepted, running, successful, failed or dismissed) and its \"results\"");
}

static int by_number(const void *a, const void *b)
{
    const plan_run *one = a, *other = b;
    return (one->number > other->number) - (one->number < other->number);
}

bool plan_table_read(const plan_request *request, const json_t *runs, plan_table *table, problem_list *problems)
{
    *table = (plan_table){ .count = json_array_size(runs) };
    if (runs && !json_is_array(runs)) problem_list_add(problems, "/runs", "must be a list");
    table->run = calloc(table->count + 1, sizeof *table->run);
    if (!table->run) problem_list_add(problems, "/runs", "can't be read: out of memory");
    for (size_t i = 0; table->run && i < table->count; i++) {
        read_run(request, json_array_get(runs, i), i, &table->run[i], problems);
        table->waiting += !table->run[i].is_over;
    }
    if (!table->run || !problem_list_is_empty(problems)) return false;
    qsort(table->run, table->count, sizeof *table->run, by_number);
    for (size_t i = 1; i < table->count; i++)
        if (table->run[i].number == table->run[i - 1].number)
            problem_list_add(problems, "/runs", "has number %lld twice", (long long)table->run[i].number);
    return problem_list_is_empty(problems);
}

void plan_table_clear(plan_table *table)
{
    free(table->run);
    *table = (plan_table){ .count = 0 };
}

int64_t plan_table_next_number(const plan_table *table) { return table->count ? table->run[table->count - 1].number + 1 : 0; }

size_t plan_table_count(const plan_table *table, plan_stage stage)
{
    size_t count = 0;
    for (size_t i = 0; i < table->count; i++) count += table->run[i].stage == stage;
    return count;
}

/* --- what a run tells --- */

static bool find_number(const json_t *results, const char *pointer, double *number)
{
    const json_t *value = json_pointer_find(results, pointer);
    if (!json_is_number(value)) return false;
    *number = json_number_value(value);
    return isfinite(*number);
}

/* Where results have the error of a result: "standard_error_deg" of "angle_deg", "period_standard_error" of "period",
 * "start_standard_error_deg" of "start_deg", and a list of their own for the other methods. */
static double own_error(const json_t *results, const char *pointer)
{
    char folder[JSON_POINTER_SIZE], at[2 * JSON_POINTER_SIZE + 40];
    double error;
    snprintf(folder, sizeof folder, "%s", pointer);
    char *name = strrchr(folder, '/');
    *name++ = '\0';
    const size_t length = strlen(name);
    const bool is_deg = length > 4 && strcmp(name + length - 4, "_deg") == 0;
    if (strcmp(name, "angle_deg") == 0) snprintf(at, sizeof at, "%s/standard_error_deg", folder);
    else if (is_deg) snprintf(at, sizeof at, "%s/%.*s_standard_error_deg", folder, (int)length - 4, name);
    else if (strcmp(folder, "/repose/other_methods") == 0) snprintf(at, sizeof at, "%s_standard_error_deg/%s", folder, name);
    else snprintf(at, sizeof at, "%s/%s_standard_error", folder, name);
    return strlen(at) < JSON_POINTER_SIZE && find_number(results, at, &error) ? fabs(error) : NAN;
}

/* Between the two entries of the list `across`, which grows, that the place lies between; at its ends, the end's. */
static bool along_curve(const json_t *curve, const plan_measure *measure, double *value, double *error)
{
    const json_t *across = json_object_get(curve, measure->across), *along = json_object_get(curve, measure->along);
    const json_t *errors = json_object_get(curve, "standard_error");
    const size_t count = json_array_size(across);
    if (count == 0 || json_array_size(along) != count) return false;
    size_t after = 0;
    while (after < count && json_number_value(json_array_get(across, after)) < measure->at) after++;
    const size_t before = after ? after - 1 : 0;
    if (after == count) after = count - 1;
    const json_t *ends[2] = { json_array_get(along, before), json_array_get(along, after) };
    if (!json_is_number(ends[0]) || !json_is_number(ends[1])) return false;
    const double from = json_number_value(json_array_get(across, before)), to = json_number_value(json_array_get(across, after));
    const double share = to > from ? fmin(fmax((measure->at - from) / (to - from), 0.0), 1.0) : 0.0;
    *value = (1.0 - share) * json_number_value(ends[0]) + share * json_number_value(ends[1]);
    const json_t *own[2] = { json_array_get(errors, before), json_array_get(errors, after) };
    const bool known = json_is_number(own[0]) && json_is_number(own[1]);
    *error = known ? (1.0 - share) * json_number_value(own[0]) + share * json_number_value(own[1]) : NAN;
    return true;
}

bool plan_run_tells(const plan_run *run, const plan_measure *measure, double *value, double *error)
{
    if (!run->results || run->test != measure->test) return false;
    if (measure->across) return along_curve(json_pointer_find(run->results, measure->pointer), measure, value, error);
    if (!find_number(run->results, measure->pointer, value)) return false;
    *error = own_error(run->results, measure->pointer);
    return true;
}

double plan_run_number(const plan_run *run, const char *name, double fallback)
{
    const json_t *value = json_object_get(json_object_get(run->results, "run"), name);
    return json_is_number(value) ? json_number_value(value) : fallback;
}

double plan_run_work(const plan_run *run)
{
    const double particles = plan_run_number(run, "particles", 0.0);
    return plan_run_number(run, "spheres", particles) * plan_run_number(run, "steps", 0.0);
}
