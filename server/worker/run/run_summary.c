#include "run_summary.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "job_folder.h"

enum { BAR_WIDTH = 30 };

static void write_duration(double seconds, char *text, size_t size)
{
    const long long whole = llround(fmin(fmax(seconds, 0.0), 3e9));
    if (whole >= 3600) snprintf(text, size, "%lld h %02lld min", whole / 3600, whole / 60 % 60);
    else if (whole >= 60) snprintf(text, size, "%lld min %02lld s", whole / 60, whole % 60);
    else snprintf(text, size, "%lld s", whole);
}

void terminal_progress(const progress_report *report, const char *phase, double time)
{
    char bar[BAR_WIDTH + 1], left[40];
    for (int i = 0; i < BAR_WIDTH; i++) bar[i] = report->percent * BAR_WIDTH >= 100.0 * (i + 1) ? '#' : '.';
    bar[BAR_WIDTH] = '\0';
    write_duration(report->eta_seconds, left, sizeof left);
    printf("\r\033[K%s %5.1f %%  %s", bar, report->percent, phase);
    if (time >= 0) printf(" %.2f s", time);
    printf("  %s left  %.1f M particle-steps/s", left, 1e-6 * report->particle_steps_per_second);
    fflush(stdout);
}

void terminal_end_progress(void)
{
    printf("\r\033[K");
    fflush(stdout);
}

static double number_at(const json_t *result, const char *output, const char *name)
{
    const json_t *value = json_object_get(json_object_get(result, output), name);
    return json_is_number(value) ? json_number_value(value) : NAN;
}

/* Of a drum: ", steady"; ", too short to tell whether it is steady". Nothing of what stands. */
static const char *verdict_in_words(const json_t *repose)
{
    static const char *const words[][2] = {
        { "steady", ", steady" },
        { "drifting", ", not steady" },
        { "too-short", ", the run is too short to tell whether it is steady" },
        { "too-few", ", too few particles to tell whether it is steady" },
    };
    const char *verdict = json_string_value(json_object_get(repose, "verdict"));
    for (size_t k = 0; verdict && k < sizeof words / sizeof words[0]; k++)
        if (strcmp(verdict, words[k][0]) == 0) return words[k][1];
    return "";
}

static void write_error(double error, char *text, size_t size)
{
    if (isnan(error)) snprintf(text, size, "degrees, of unknown error");
    else snprintf(text, size, "+- %.2f degrees", error);
}

void summary_angle(const json_t *result)
{
    const json_t *repose = json_object_get(result, "repose");
    const double angle = number_at(result, "repose", "angle_deg");
    if (isnan(angle)) {
        printf("angle of repose   not measured: the run is too short, or there are too few particles\n");
        return;
    }
    const double drift = number_at(result, "repose", "drift_bound_deg_per_revolution");
    char error[40];
    write_error(number_at(result, "repose", "standard_error_deg"), error, sizeof error);
    printf("angle of repose   %.2f %s (%s)%s\n", angle, error, json_string_value(json_object_get(repose, "method")),
           verdict_in_words(repose));
    if (!isnan(drift)) printf("drift             below %.2g degrees a revolution\n", drift);
    printf("%-18s%.2f to %.2f degrees\n", json_object_get(repose, "steady") ? "frames" : "azimuths",
           number_at(result, "repose", "minimum_deg"), number_at(result, "repose", "maximum_deg"));
}

void summary_fact(const json_t *result, const char *output, const char *name, const char *label, const char *unit)
{
    printf("%-18s%.4g %s\n", label, number_at(result, output, name), unit);
}

static void summary_warnings(const json_t *warnings)
{
    size_t i;
    json_t *warning;
    json_array_foreach(warnings, i, warning)
    {
        printf("warning           %s %s\n", json_string_value(json_object_get(warning, "field")),
               json_string_value(json_object_get(warning, "text")));
    }
}

void summary_run(const json_t *result, const char *folder)
{
    char spent[40];
    write_duration(number_at(result, "run", "wall_seconds"), spent, sizeof spent);
    printf("run               %.0f particles, %.0f steps, %s, largest overlap %.2g of a diameter\n",
           number_at(result, "run", "particles"), number_at(result, "run", "steps"), spent,
           number_at(result, "run", "maximum_overlap"));
    summary_warnings(json_object_get(json_object_get(result, "run"), "warnings"));
    printf("files             %s/%s, %s/%s (ParaView)\n", folder, JOB_RESULT_FILE, folder, JOB_SERIES_FILE);
}

void terminal_summary(const json_t *result, const char *folder)
{
    const char *regime = json_string_value(json_object_get(json_object_get(result, "regime"), "name"));
    summary_angle(result);
    const bool certain = json_is_true(json_object_get(json_object_get(result, "regime"), "certain"));
    printf("regime            %s%s\n", regime ? regime : "not known: the run is too short, or there are too few particles",
           regime && !certain ? ", not certain" : "");
    summary_run(result, folder);
}
