#include "plan_fit.h"

#include <math.h>
#include <stdlib.h>

/* A run that does not tell its error is taken to be as good as the others. */
static double fill_in_errors(double *error, size_t count)
{
    double sum = 0.0;
    size_t known = 0;
    for (size_t i = 0; i < count; i++) {
        if (isnan(error[i])) continue;
        sum += error[i] * error[i];
        known++;
    }
    const double usual = known ? sqrt(sum / (double)known) : 0.0;
    for (size_t i = 0; i < count; i++)
        if (isnan(error[i])) error[i] = usual;
    return usual;
}

double plan_fit_run_deviation(const plan_fit *fit, size_t measure, double error)
{
    return emulator_run_deviation(&fit->of[measure], isnan(error) ? fit->usual_error[measure] : error);
}

/* Of all runs of its test that were made to know it, not to verify. */
static bool fit_measure(plan_fit *fit, size_t m)
{
    const plan_table *table = fit->table;
    const size_t d = fit->request->parameters;
    double *x = malloc((table->count + 1) * (d + 2) * sizeof *x), *y = x ? x + table->count * d : NULL;
    if (!x) return false;
    double *error = y + table->count;
    size_t count = 0;
    for (size_t i = 0; i < table->count; i++) {
        const plan_run *run = &table->run[i];
        if (run->stage == STAGE_VERIFY || !plan_run_tells(run, &fit->request->measure[m], &y[count], &error[count])) continue;
        for (size_t k = 0; k < d; k++) x[count * d + k] = run->x[k];
        count++;
    }
    fit->told[m] = count;
    fit->usual_error[m] = fill_in_errors(error, count);
    emulator_fit(&fit->of[m], d, count, x, y, error);
    free(x);
    return true;
}

static bool measure_errors(plan_fit *fit)
{
    const posterior *p = &fit->posterior;
    double *mean = malloc(2 * p->draws * sizeof *mean);
    bool good = mean != NULL;
    for (size_t m = 0; good && m < fit->request->measures; m++) {
        if (fit->of[m].points == 0) continue;
        double *variance = mean + p->draws, sum = 0.0;
        good = emulator_predict(&fit->of[m], p->draws, p->x, mean, variance);
        for (size_t i = 0; good && i < p->draws; i++) sum += variance[i];
        fit->error_in[m] = sqrt(sum / (double)p->draws);
    }
    free(mean);
    return good;
}

bool plan_fit_make(plan_fit *fit, const plan_request *request, const plan_table *table, size_t draws)
{
    *fit = (plan_fit){ .request = request, .table = table, .is_complete = true };
    bool good = true;
    for (size_t m = 0; good && m < request->measures; m++) {
        fit->error_in[m] = INFINITY;
        good = fit_measure(fit, m);
        if (request->measure[m].use != PLAN_FITTED) continue;
        if (fit->of[m].points == 0) {
            fit->is_complete = false;
            continue;
        }
        fit->measure_of[fit->values] = m;
        fit->measured[fit->values++] = (measured_value){ &fit->of[m], request->measure[m].value, request->measure[m].error };
    }
    good = good && posterior_draw(&fit->posterior, request->parameters, fit->measured, fit->values, draws, request->seed);
    return good && measure_errors(fit);
}

void plan_fit_clear(plan_fit *fit)
{
    for (size_t m = 0; m < PLAN_MOST_MEASURES; m++) emulator_clear(&fit->of[m]);
    posterior_clear(&fit->posterior);
}

double plan_fit_deviation(const plan_fit *fit, size_t parameter)
{
    const posterior *p = &fit->posterior;
    double sum = 0.0, squares = 0.0;
    for (size_t i = 0; i < p->draws; i++)
        sum += plan_from_cube(&fit->request->parameter[parameter], p->x[i * p->parameters + parameter]);
    const double mean = sum / (double)p->draws;
    for (size_t i = 0; i < p->draws; i++) {
        const double apart = plan_from_cube(&fit->request->parameter[parameter], p->x[i * p->parameters + parameter]) - mean;
        squares += apart * apart;
    }
    return sqrt(squares / (double)p->draws);
}

/* As well as the request asks where it asks for some accuracy of parameters. */
static bool is_known_to(const plan_fit *fit)
{
    bool is_asked = false;
    for (size_t p = 0; p < fit->request->parameters; p++) {
        const double wanted = fit->request->parameter[p].known_to;
        if (isnan(wanted)) continue;
        if (plan_fit_deviation(fit, p) > wanted) return false;
        is_asked = true;
    }
    return is_asked;
}

bool plan_fit_is_enough(const plan_fit *fit, double factor)
{
    const double share = factor * (is_known_to(fit) ? 1.0 : PLAN_ENOUGH);
    for (size_t v = 0; v < fit->values; v++)
        if (!(fit->error_in[fit->measure_of[v]] <= share * fit->measured[v].error)) return false;
    return fit->is_complete;
}
