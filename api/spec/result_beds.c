/* Makes the results of a run of several beds from those of each, as the table's rows say. */
#include <math.h>
#include <string.h>

#include "mean_of_runs.h"
#include "result_fields.h"

void mean_over_beds(const double *value, const double *error, size_t count, double *mean, double *error_of_mean)
{
    mean_of_runs all = { 0 };
    for (size_t k = 0; k < count; k++)
        if (isfinite(value[k])) mean_of_runs_add(&all, value[k], error ? error[k] : NAN);
    *mean = all.count > 0 ? all.mean : NAN;
    if (error_of_mean) *error_of_mean = all.count > 0 ? mean_of_beds_error(&all) : NAN;
}

static const result_field *sibling(const result_table *table, const result_field *field, const char *name)
{
    for (size_t f = 0; f < table->count; f++) {
        const result_field *other = &table->field[f];
        const bool in_group = other->group && field->group ? strcmp(other->group, field->group) == 0 : other->group == field->group;
        if (in_group && strcmp(other->output, field->output) == 0 && strcmp(other->name, name) == 0) return other;
    }
    return NULL;
}

/* The row with the error of this row's mean; NULL: there is none. */
static const result_field *error_row(const result_table *table, const result_field *field)
{
    for (size_t f = 0; f < table->count; f++) {
        const result_field *row = &table->field[f];
        if (row->over_beds == BEDS_ERROR && sibling(table, row, row->of) == field) return row;
    }
    return NULL;
}

static double number_at(const result_field *field, const void *results)
{
    const char *place = (const char *)results + field->offset;
    return field->kind == RESULT_SIZE ? (double)*(const size_t *)place : *(const double *)place;
}

static void set_number(const result_field *field, void *results, double number)
{
    char *place = (char *)results + field->offset;
    if (field->kind == RESULT_SIZE) *(size_t *)place = (size_t)number;
    else *(double *)place = number;
}

static const char *word_at(const result_field *field, const void *results)
{
    return *(const char *const *)((const char *)results + field->offset);
}

static bool is_same_word(const char *a, const char *b) { return a && b ? strcmp(a, b) == 0 : a == b; }

static void set_mean(const result_table *table, const result_field *field, const void *const *bed, size_t count, void *all)
{
    double value[MOST_BEDS], error[MOST_BEDS], mean, error_of_mean;
    const result_field *of_error = error_row(table, field);
    for (size_t k = 0; k < count; k++) {
        value[k] = number_at(field, bed[k]);
        error[k] = of_error ? number_at(of_error, bed[k]) : NAN;
    }
    mean_over_beds(value, error, count, &mean, &error_of_mean);
    set_number(field, all, mean);
    if (of_error) set_number(of_error, all, error_of_mean);
}

/* Of the beds that have such a number. */
static void set_sum_or_extreme(const result_field *field, const void *const *bed, size_t count, void *all)
{
    double found = NAN;
    for (size_t k = 0; k < count; k++) {
        const double value = number_at(field, bed[k]);
        if (isnan(value)) continue;
        if (isnan(found)) found = value;
        else if (field->over_beds == BEDS_SUM) found += value;
        else found = field->over_beds == BEDS_LEAST ? fmin(found, value) : fmax(found, value);
    }
    set_number(field, all, found);
}

/* The word that most beds say; of those that equally many say the first. */
static void set_vote(const result_field *field, const void *const *bed, size_t count, void *all)
{
    size_t most = 0;
    for (size_t k = 0; k < count; k++) {
        size_t votes = 0;
        for (size_t j = 0; j < count; j++) votes += is_same_word(word_at(field, bed[k]), word_at(field, bed[j]));
        if (votes > most) *(const char **)((char *)all + field->offset) = word_at(field, bed[k]);
        if (votes > most) most = votes;
    }
}

/* True where every bed says so, and all say the same word. Not known where that is so of the first. */
static void set_agreed(const result_table *table, const result_field *field, const void *const *bed, size_t count, void *all)
{
    const result_field *word = sibling(table, field, field->of);
    bool agreed = true;
    for (size_t k = 0; k < count; k++)
        agreed = agreed && number_at(field, bed[k]) == 1.0 && is_same_word(word_at(word, bed[0]), word_at(word, bed[k]));
    set_number(field, all, word_at(word, all) ? (double)agreed : NAN);
}

void results_of_beds(const result_table *table, const void *const *bed, size_t count, void *all)
{
    for (size_t f = 0; f < table->count; f++)
        if (table->field[f].over_beds == BEDS_VOTE) set_vote(&table->field[f], bed, count, all);
    for (size_t f = 0; f < table->count; f++) {
        const result_field *field = &table->field[f];
        switch (field->over_beds) {
        case BEDS_MEAN:
            if (field->kind == RESULT_REAL) set_mean(table, field, bed, count, all);
            break;
        case BEDS_SUM:
        case BEDS_LEAST:
        case BEDS_LARGEST: set_sum_or_extreme(field, bed, count, all); break;
        case BEDS_AGREED: set_agreed(table, field, bed, count, all); break;
        case BEDS_ERROR:
        case BEDS_VOTE:
        case BEDS_ALIKE:
        case BEDS_TOGETHER: break;
        }
    }
}

bool beds_to_json(const result_table *table, json_t *const *document, const double *seed, size_t count, json_t *all)
{
    json_t *beds = count > 1 ? json_array() : json_null();
    bool complete = beds;
    for (size_t k = 0; complete && count > 1 && k < count; k++) {
        const json_t *told = json_object_get(document[k], table->output[0].name);
        json_t *bed = json_pack("{s:I}", "seed", (json_int_t)seed[k]);
        for (const char *const *name = table->of_each_bed; *name; name++) json_object_set(bed, *name, json_object_get(told, *name));
        complete = json_array_append_new(beds, bed) == 0;
    }
    return json_object_set_new(json_object_get(all, table->output[0].name), "beds", beds) == 0 && complete;
}

json_t *over_beds_to_json(const result_field *field)
{
    static const char *const words[] = {
        [BEDS_MEAN] = "mean over the beds that have it",
        [BEDS_SUM] = "sum over the beds",
        [BEDS_LEAST] = "least of the beds",
        [BEDS_LARGEST] = "largest of the beds",
        [BEDS_VOTE] = "of most beds, or of the first of equally many",
        [BEDS_ALIKE] = "alike in all beds, or of the run",
        [BEDS_TOGETHER] = "told from all beds together",
    };
    if (field->over_beds == BEDS_ERROR) return json_sprintf("error of the mean of %s", field->of);
    if (field->over_beds == BEDS_AGREED) return json_sprintf("true where every bed says so, and all have the same %s", field->of);
    return json_string(words[field->over_beds]);
}
