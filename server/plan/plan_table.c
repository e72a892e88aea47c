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

bool plan_run_tells(const plan_run *run, const plan_measure *measure, double *value, double *error)
{
    return run->results && run->test == measure->test && plan_measure_read(measure, run->results, value, error);
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
