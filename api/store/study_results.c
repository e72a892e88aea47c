#include "study_results.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const study_measure study_measures[STUDY_MEASURES] = {
    { "angle_deg", "standard_error_deg" },
    { "minimum_deg", NULL },
    { "maximum_deg", NULL },
    { "drift_deg_per_revolution", NULL },
    { "interface_fluctuation", NULL },
    { "radial_index", NULL },
    { "axial_index", NULL },
    { "lacey_index", NULL },
    { "solid_fraction", NULL },
    { "coordination_number", NULL },
    { "maximum_overlap", NULL },
    { "torque", "torque_standard_error" },
    { "power", NULL },
    { "slumps_period", NULL },
    { "slumps_start_deg", NULL },
    { "slumps_stop_deg", NULL },
    { "minimum_omega2", "error" },
    { "minimum_rotation_rate", NULL },
    { "slip_per_revolution", NULL },
    { "while_filling_angle_deg", "while_filling_standard_error_deg" },
    { "height", NULL },
    { "base_diameter", NULL },
    { "static_cohesive_index", NULL },
    { "lost", NULL },
};

bool study_table_init(study_table *table)
{
    *table = (study_table){ .cases = json_array() };
    return table->cases != NULL;
}

void study_table_clear(study_table *table)
{
    json_decref(table->cases);
    table->cases = NULL;
}

/* The study's and the case's name are in the row already. */
static json_t *label_of(const char *text)
{
    json_t *label = json_loads(text, 0, NULL);
    json_object_del(label, "study");
    json_object_del(label, "case");
    return label;
}

bool study_table_add_case(void *context, const study_case_row *row)
{
    study_table *table = context;
    json_t *one = json_pack("{s:s, s:o, s:o, s:i, s:i, s:i, s:n, s:n, s:n, s:n, s:i, s:{}}", "case", row->name, "inputs",
                            json_loads(row->inputs, 0, NULL), "label", label_of(row->label), "repeats", 0, "finished", 0, "failed",
                            0, "regime", "certain", "verdict", "steady", "warnings", 0, "results");
    if (!one || json_array_append_new(table->cases, one) != 0) table->failed = true;
    return !table->failed;
}

/* --- summing --- */

static void begin_case(study_summing *summing, int64_t index)
{
    summing->index = index;
    memset(summing->counts, 0, sizeof summing->counts);
    memset(summing->means, 0, sizeof summing->means);
    json_object_clear(summing->regimes);
    json_object_clear(summing->verdicts);
    summing->steady = summing->certain = (truth_of_runs){ 0 };
    summing->warnings = 0;
}

void study_summing_init(study_summing *summing, study_table *table)
{
    summing->table = table;
    summing->regimes = json_object();
    summing->verdicts = json_object();
    begin_case(summing, -1);
}

static void count_word(json_t *words, const json_t *word)
{
    const char *name = json_string_value(word);
    if (name) json_object_set_new(words, name, json_integer(json_integer_value(json_object_get(words, name)) + 1));
}

static void count_truth(truth_of_runs *truth, const json_t *value)
{
    ++*(!json_is_number(value) ? &truth->unknown : json_number_value(value) != 0.0 ? &truth->yes : &truth->no);
}

/* True where every run says so, false where one says not, else null. */
static json_t *truth_to_json(const truth_of_runs *truth)
{
    if (truth->no > 0) return json_false();
    return truth->yes > 0 && truth->unknown == 0 ? json_true() : json_null();
}

/* "rolling"; "rolling 2, slumping 1". */
static json_t *words_to_json(const json_t *words)
{
    char text[300] = "";
    const char *name;
    json_t *runs;
    json_object_foreach((json_t *)words, name, runs)
    {
        const size_t length = strlen(text);
        if (json_object_size(words) == 1) snprintf(text, sizeof text, "%s", name);
        else
            snprintf(text + length, sizeof text - length, "%s%s %lld", length ? ", " : "", name,
                     (long long)json_integer_value(runs));
    }
    return text[0] ? json_string(text) : json_null();
}

static void end_case(study_summing *summing)
{
    json_t *one = json_array_get(summing->table->cases, (size_t)summing->index);
    if (summing->index < 0 || !one) return;
    int64_t all = 0;
    for (int i = 0; i < JOB_STATUSES; i++) all += summing->counts[i];
    json_t *results = json_object();
    for (int m = 0; m < STUDY_MEASURES; m++)
        if (summing->means[m].count > 0)
            json_object_set_new(results, study_measures[m].name, mean_of_runs_to_json(&summing->means[m]));
    if (json_object_set_new(one, "repeats", json_integer(all)) != 0
        || json_object_set_new(one, "finished", json_integer(summing->counts[JOB_SUCCESSFUL])) != 0
        || json_object_set_new(one, "failed", json_integer(summing->counts[JOB_FAILED])) != 0
        || json_object_set_new(one, "regime", words_to_json(summing->regimes)) != 0
        || json_object_set_new(one, "certain", truth_to_json(&summing->certain)) != 0
        || json_object_set_new(one, "verdict", words_to_json(summing->verdicts)) != 0
        || json_object_set_new(one, "steady", truth_to_json(&summing->steady)) != 0
        || json_object_set_new(one, "warnings", json_integer(summing->warnings)) != 0
        || json_object_set_new(one, "results", results) != 0)
        summing->table->failed = true;
}

bool study_summing_add_run(void *context, const study_run_row *row)
{
    study_summing *summing = context;
    if (row->index != summing->index) {
        end_case(summing);
        begin_case(summing, row->index);
    }
    summing->counts[row->status]++;
    if (row->status != JOB_SUCCESSFUL) return true;
    for (int m = 0; m < STUDY_MEASURES; m++) {
        const json_t *value = json_object_get(row->measures, study_measures[m].name);
        if (!json_is_number(value)) continue;
        const json_t *error = study_measures[m].run_error ? json_object_get(row->measures, study_measures[m].run_error) : NULL;
        mean_of_runs_add(&summing->means[m], json_number_value(value), json_is_number(error) ? json_number_value(error) : NAN);
    }
    count_word(summing->regimes, json_object_get(row->measures, "regime"));
    count_word(summing->verdicts, json_object_get(row->measures, "verdict"));
    count_truth(&summing->certain, json_object_get(row->measures, "certain"));
    count_truth(&summing->steady, json_object_get(row->measures, "steady"));
    summing->warnings += (int64_t)json_number_value(json_object_get(row->measures, "warnings"));
    return true;
}

void study_summing_end(study_summing *summing)
{
    end_case(summing);
    json_decref(summing->regimes);
    json_decref(summing->verdicts);
    summing->regimes = summing->verdicts = NULL;
}

/* --- CSV --- */

/* All names that the member (inputs, label, results) has in any row, in order of first sight. */
static json_t *names_of(const study_table *table, const char *member)
{
    json_t *names = json_object();
    size_t i;
    json_t *row, *value;
    const char *name;
    json_array_foreach(table->cases, i, row)
    {
        json_object_foreach(json_object_get(row, member), name, value) { json_object_set_new(names, name, json_null()); }
    }
    return names;
}

/* Another column: a comma and the name. */
static void add_name(text_buffer *out, const char *before, const char *text, const char *after)
{
    char whole[800];
    text_buffer_print(out, ",");
    const int length = snprintf(whole, sizeof whole, "%s%s%s", before, text, after);
    text_buffer_add_csv_field(out, whole, length < (int)sizeof whole ? (size_t)length : sizeof whole - 1);
}

static void add_json(text_buffer *out, const json_t *value)
{
    text_buffer_print(out, ",");
    if (json_is_integer(value)) text_buffer_print(out, "%lld", (long long)json_integer_value(value));
    else if (json_is_real(value)) text_buffer_add_number(out, json_real_value(value));
    else if (json_is_string(value)) text_buffer_add_csv_field(out, json_string_value(value), json_string_length(value));
    else if (json_is_boolean(value)) text_buffer_print(out, json_is_true(value) ? "true" : "false");
    else if (json_is_object(value) || json_is_array(value)) {
        char *text = json_dumps(value, JSON_COMPACT);
        if (text) text_buffer_add_csv_field(out, text, strlen(text));
        free(text);
    }
}

/* Where a run has an error of its own, a column says which error was taken; that of the angle is the last. */
static bool has_error_from(const char *name)
{
    for (int m = 1; m < STUDY_MEASURES; m++)
        if (strcmp(study_measures[m].name, name) == 0) return study_measures[m].run_error;
    return false;
}

static void write_head(const json_t *inputs, const json_t *labels, const json_t *results, text_buffer *out)
{
    const char *name;
    json_t *unused;
    text_buffer_print(out, "case");
    json_object_foreach((json_t *)inputs, name, unused) { add_name(out, "", name, ""); }
    json_object_foreach((json_t *)labels, name, unused) { add_name(out, "label/", name, ""); }
    text_buffer_print(out, ",repeats,finished,failed,regime,certain,verdict,steady,warnings");
    json_object_foreach((json_t *)results, name, unused)
    {
        add_name(out, "", name, "");
        add_name(out, "", name, "_standard_error");
        if (has_error_from(name)) add_name(out, "", name, "_error_from");
    }
    if (json_object_get(results, "angle_deg")) text_buffer_print(out, ",error_from");
    text_buffer_print(out, "\r\n");
}

static void write_row(const json_t *row, const json_t *inputs, const json_t *labels, const json_t *results, text_buffer *out)
{
    const char *name;
    json_t *unused;
    const json_t *one = json_object_get(row, "case");
    text_buffer_add_csv_field(out, json_string_value(one), json_string_length(one));
    json_object_foreach((json_t *)inputs, name, unused) { add_json(out, json_object_get(json_object_get(row, "inputs"), name)); }
    json_object_foreach((json_t *)labels, name, unused) { add_json(out, json_object_get(json_object_get(row, "label"), name)); }
    add_json(out, json_object_get(row, "repeats"));
    add_json(out, json_object_get(row, "finished"));
    add_json(out, json_object_get(row, "failed"));
    add_json(out, json_object_get(row, "regime"));
    add_json(out, json_object_get(row, "certain"));
    add_json(out, json_object_get(row, "verdict"));
    add_json(out, json_object_get(row, "steady"));
    add_json(out, json_object_get(row, "warnings"));
    json_object_foreach((json_t *)results, name, unused)
    {
        const json_t *measure = json_object_get(json_object_get(row, "results"), name);
        add_json(out, json_object_get(measure, "mean"));
        add_json(out, json_object_get(measure, "standard_error"));
        if (has_error_from(name)) add_json(out, json_object_get(measure, "error_from"));
    }
    if (json_object_get(results, "angle_deg"))
        add_json(out, json_object_get(json_object_get(json_object_get(row, "results"), "angle_deg"), "error_from"));
    text_buffer_print(out, "\r\n");
}

void study_table_write_csv(const study_table *table, text_buffer *out)
{
    json_t *inputs = names_of(table, "inputs"), *labels = names_of(table, "label"), *results = names_of(table, "results");
    size_t i;
    json_t *row;
    write_head(inputs, labels, results, out);
    json_array_foreach(table->cases, i, row) { write_row(row, inputs, labels, results, out); }
    json_decref(inputs);
    json_decref(labels);
    json_decref(results);
}
