#include "study_results.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool study_table_init(study_table *table)
{
    *table = (study_table){ .cases = json_array() };
    if (!field_columns_gather(&table->columns)) return false;
    table->told = calloc(table->columns.count, sizeof *table->told);
    if (table->told) table->told_count = field_columns_select(&table->columns, COLUMNS_IN_STUDY, table->told);
    return table->told && table->cases;
}

void study_table_clear(study_table *table)
{
    json_decref(table->cases);
    free(table->told);
    field_columns_clear(&table->columns);
    *table = (study_table){ .cases = NULL };
}

/* A mean over the runs stands among a case's results; all else is a member of the case itself. */
static bool is_mean(const field_column *column)
{
    const result_kind kind = column->result->kind;
    return kind == RESULT_REAL || kind == RESULT_WHOLE || kind == RESULT_SIZE;
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
    json_t *one = json_pack("{s:s, s:o, s:o, s:i, s:i, s:i}", "case", row->name, "inputs", json_loads(row->inputs, 0, NULL),
                            "label", label_of(row->label), "repeats", 0, "finished", 0, "failed", 0);
    for (size_t t = 0; one && t < table->told_count; t++) {
        const field_column *column = table->told[t];
        if (is_mean(column)) continue;
        json_object_set_new(one, column->shown_as, column->result->kind == RESULT_WARNINGS ? json_integer(0) : json_null());
    }
    if (one) json_object_set_new(one, "results", json_object());
    if (!one || json_array_append_new(table->cases, one) != 0) table->failed = true;
    return !table->failed;
}

/* --- summing --- */

static void forget_told(study_summing *summing)
{
    for (size_t t = 0; summing->told && t < summing->table->told_count; t++) {
        json_decref(summing->told[t].words);
        summing->told[t] = (told_of_runs){ .words = NULL };
    }
}

static void begin_case(study_summing *summing, int64_t index)
{
    summing->index = index;
    memset(summing->counts, 0, sizeof summing->counts);
    forget_told(summing);
}

void study_summing_init(study_summing *summing, study_table *table)
{
    *summing = (study_summing){ .table = table, .told = calloc(table->told_count, sizeof *summing->told) };
    if (!summing->told) table->failed = true;
    begin_case(summing, -1);
}

static void count_word(json_t **words, const json_t *word)
{
    const char *name = json_string_value(word);
    if (name && !*words) *words = json_object();
    if (name) json_object_set_new(*words, name, json_integer(json_integer_value(json_object_get(*words, name)) + 1));
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

static json_t *told_to_json(const field_column *column, const told_of_runs *told)
{
    switch (column->result->kind) {
    case RESULT_WARNINGS: return json_integer(told->sum);
    case RESULT_TRUTH:
    case RESULT_MAYBE: return truth_to_json(&told->truth);
    case RESULT_TEXT:
    case RESULT_WORD: return words_to_json(told->words);
    default: return mean_of_runs_to_json(&told->mean);
    }
}

static void end_case(study_summing *summing)
{
    json_t *one = json_array_get(summing->table->cases, (size_t)summing->index);
    if (summing->index < 0 || !one) return;
    int64_t all = 0;
    for (int i = 0; i < JOB_STATUSES; i++) all += summing->counts[i];
    int failed = json_object_set_new(one, "repeats", json_integer(all))
                 | json_object_set_new(one, "finished", json_integer(summing->counts[JOB_SUCCESSFUL]))
                 | json_object_set_new(one, "failed", json_integer(summing->counts[JOB_FAILED]));
    for (size_t t = 0; t < summing->table->told_count; t++) {
        const field_column *column = summing->table->told[t];
        if (is_mean(column) && summing->told[t].mean.count == 0) continue;
        json_t *to = is_mean(column) ? json_object_get(one, "results") : one;
        failed |= json_object_set_new(to, column->shown_as, told_to_json(column, &summing->told[t]));
    }
    if (failed) summing->table->failed = true;
}

static void add_told(const field_column *column, const json_t *measures, told_of_runs *told)
{
    const json_t *value = json_object_get(measures, column->shown_as);
    const json_t *error = column->run_error ? json_object_get(measures, column->run_error) : NULL;
    switch (column->result->kind) {
    case RESULT_WARNINGS: told->sum += (int64_t)json_number_value(value); break;
    case RESULT_TRUTH:
    case RESULT_MAYBE: count_truth(&told->truth, value); break;
    case RESULT_TEXT:
    case RESULT_WORD: count_word(&told->words, value); break;
    default:
        if (json_is_number(value))
            mean_of_runs_add(&told->mean, json_number_value(value), json_is_number(error) ? json_number_value(error) : NAN);
    }
}

bool study_summing_add_run(void *context, const study_run_row *row)
{
    study_summing *summing = context;
    if (!summing->told) return false;
    if (row->index != summing->index) {
        end_case(summing);
        begin_case(summing, row->index);
    }
    summing->counts[row->status]++;
    for (size_t t = 0; row->status == JOB_SUCCESSFUL && t < summing->table->told_count; t++)
        add_told(summing->table->told[t], row->measures, &summing->told[t]);
    return true;
}

void study_summing_end(study_summing *summing)
{
    if (summing->told) end_case(summing);
    forget_told(summing);
    free(summing->told);
    summing->told = NULL;
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

/* The first measure's error_from stands at the end of the line, under no other name. */
static const field_column *first_mean(const study_table *table)
{
    size_t t = 0;
    while (t < table->told_count && !is_mean(table->told[t])) t++;
    assert(t < table->told_count);
    return table->told[t];
}

/* Where a run has an error of its own, a column says which error was taken. */
static bool has_error_from(const study_table *table, const char *name)
{
    for (size_t t = 0; t < table->told_count; t++)
        if (is_mean(table->told[t]) && table->told[t] != first_mean(table) && strcmp(table->told[t]->shown_as, name) == 0)
            return table->told[t]->run_error;
    return false;
}

/* Members that all rows have, before the results. */
static void write_told(const study_table *table, const json_t *row, text_buffer *out)
{
    static const char *const counts[] = { "repeats", "finished", "failed" };
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++)
        if (row) add_json(out, json_object_get(row, counts[i]));
        else add_name(out, "", counts[i], "");
    for (size_t t = 0; t < table->told_count; t++) {
        const char *name = table->told[t]->shown_as;
        if (is_mean(table->told[t])) continue;
        if (row) add_json(out, json_object_get(row, name));
        else add_name(out, "", name, "");
    }
}

static void write_head(const study_table *table, const json_t *inputs, const json_t *labels, const json_t *results,
                       text_buffer *out)
{
    const char *name;
    json_t *unused;
    text_buffer_print(out, "case");
    json_object_foreach((json_t *)inputs, name, unused) { add_name(out, "", name, ""); }
    json_object_foreach((json_t *)labels, name, unused) { add_name(out, "label/", name, ""); }
    write_told(table, NULL, out);
    json_object_foreach((json_t *)results, name, unused)
    {
        add_name(out, "", name, "");
        add_name(out, "", name, "_standard_error");
        if (has_error_from(table, name)) add_name(out, "", name, "_error_from");
    }
    if (json_object_get(results, first_mean(table)->shown_as)) text_buffer_print(out, ",error_from");
    text_buffer_print(out, "\r\n");
}

static void write_row(const study_table *table, const json_t *row, const json_t *inputs, const json_t *labels,
                      const json_t *results, text_buffer *out)
{
    const char *name, *first = first_mean(table)->shown_as;
    json_t *unused;
    const json_t *one = json_object_get(row, "case");
    text_buffer_add_csv_field(out, json_string_value(one), json_string_length(one));
    json_object_foreach((json_t *)inputs, name, unused) { add_json(out, json_object_get(json_object_get(row, "inputs"), name)); }
    json_object_foreach((json_t *)labels, name, unused) { add_json(out, json_object_get(json_object_get(row, "label"), name)); }
    write_told(table, row, out);
    json_object_foreach((json_t *)results, name, unused)
    {
        const json_t *measure = json_object_get(json_object_get(row, "results"), name);
        add_json(out, json_object_get(measure, "mean"));
        add_json(out, json_object_get(measure, "standard_error"));
        if (has_error_from(table, name)) add_json(out, json_object_get(measure, "error_from"));
    }
    if (json_object_get(results, first))
        add_json(out, json_object_get(json_object_get(json_object_get(row, "results"), first), "error_from"));
    text_buffer_print(out, "\r\n");
}

void study_table_write_csv(const study_table *table, text_buffer *out)
{
    json_t *inputs = names_of(table, "inputs"), *labels = names_of(table, "label"), *results = names_of(table, "results");
    size_t i;
    json_t *row;
    write_head(table, inputs, labels, results, out);
    json_array_foreach(table->cases, i, row) { write_row(table, row, inputs, labels, results, out); }
    json_decref(inputs);
    json_decref(labels);
    json_decref(results);
}
