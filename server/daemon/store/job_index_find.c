/* Looking through the index: each condition is a walk over arrays, and clears the marks of the jobs that do not fit. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "job_index_rows.h"

/* --- numbers --- */

bool filter_columns(const job_filter *filter, column_name_taker *take, void *context)
{
    bool good = true;
    for (size_t r = 0; good && r < filter->range_count; r++) good = take(context, filter->range[r].name);
    if (good && filter->sort) good = take(context, filter->sort);
    if (good && (filter->created_from[0] || filter->created_before[0])) good = take(context, "created");
    if (good && (!isnan(filter->least_seconds) || !isnan(filter->most_seconds)))
        good = take(context, "started") && take(context, "finished");
    return good;
}

static bool is_listed(const char *list, const char *word)
{
    const size_t length = strlen(word);
    for (const char *at = list;; at += strcspn(at, ",") + 1) {
        if (strncmp(at, word, length) == 0 && (at[length] == ',' || !at[length])) return true;
        if (!at[strcspn(at, ",")]) return false;
    }
}

static bool keep_words(const index_rows *rows, const value_column *column, const char *words, uint8_t *kept)
{
    uint8_t *wanted = calloc(column->words.count + 1, 1);
    if (!wanted) return false;
    for (uint32_t w = 0; w < column->words.count; w++) wanted[w] = is_listed(words, text_pool_text(&column->words, w));
    for (size_t row = 0; row < rows->count; row++)
        if (kept[row]) kept[row] = !isnan(column->value[row]) && wanted[(size_t)column->value[row]];
    free(wanted);
    return true;
}

/* A value that there is not is in no range. */
static void keep_between(const index_rows *rows, const double *value, double low, double high, uint8_t *kept)
{
    for (size_t row = 0; row < rows->count; row++) kept[row] &= value[row] >= low && value[row] <= high;
}

static double ms_of(const char *time, double missing)
{
    struct tm parts = { .tm_isdst = 0 };
    int ms = 0;
    if (sscanf(time, "%d-%d-%dT%d:%d:%d.%dZ", &parts.tm_year, &parts.tm_mon, &parts.tm_mday, &parts.tm_hour, &parts.tm_min,
               &parts.tm_sec, &ms)
        != 7)
        return missing;
    parts.tm_year -= 1900;
    parts.tm_mon--;
    return 1000.0 * (double)timegm(&parts) + ms;
}

static void keep_durations(job_index *index, const job_filter *filter, uint8_t *kept)
{
    const index_rows *rows = &index->rows;
    const double *started = value_column_find(index, "started")->value, *finished = value_column_find(index, "finished")->value;
    const double low = isnan(filter->least_seconds) ? 0.0 : filter->least_seconds,
                 high = isnan(filter->most_seconds) ? INFINITY : filter->most_seconds;
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    const double until = 1000.0 * (double)now.tv_sec + (double)(now.tv_nsec / 1000000);
    for (size_t row = 0; row < rows->count; row++) {
        const double seconds = ((isnan(finished[row]) ? until : finished[row]) - started[row]) / 1000.0;
        const bool has_begun = (rows->kind[row] & ROW_STATUS) != JOB_ACCEPTED; /* one that waits again is not running */
        kept[row] &= has_begun && seconds >= low && seconds <= high;
    }
}

static bool keep_values(job_index *index, const job_filter *filter, uint8_t *kept)
{
    const index_rows *rows = &index->rows;
    bool good = true;
    for (size_t r = 0; good && r < filter->range_count; r++) {
        const value_range *range = &filter->range[r];
        const value_column *column = value_column_find(index, range->name);
        if (column->is_words) good = keep_words(rows, column, range->words ? range->words : "", kept);
        else keep_between(rows, column->value, range->low, range->high, kept);
    }
    if (filter->created_from[0] || filter->created_before[0]) /* before: itself does not belong to it */
        keep_between(rows, value_column_find(index, "created")->value, ms_of(filter->created_from, -INFINITY),
                     ms_of(filter->created_before, filter->created_before[0] ? -INFINITY : INFINITY) - 0.5, kept);
    if (!isnan(filter->least_seconds) || !isnan(filter->most_seconds)) keep_durations(index, filter, kept);
    return good;
}

/* --- all conditions --- */

static void keep_kinds(const index_rows *rows, const job_filter *filter, uint8_t *kept)
{
    uint8_t is_wanted[256];
    for (unsigned kind = 0; kind < 256; kind++)
        is_wanted[kind] = (kind & ROW_STATUS) != ROW_REMOVED && (!filter->by_type || filter->type_is_process)
                          && (!filter->by_process || (filter->processes & (1U << (kind >> ROW_PROCESS_SHIFT))));
    for (size_t row = 0; row < rows->count; row++) kept[row] = is_wanted[rows->kind[row]];
}

/* What the filter lets through but for the statuses: (rows) marks, which the caller frees; NULL: no memory. */
static uint8_t *keep_fitting(job_index *index, const job_filter *filter, int64_t study)
{
    const index_rows *rows = &index->rows;
    uint8_t *kept = malloc(rows->count + 1);
    if (!kept) return NULL;
    keep_kinds(rows, filter, kept);
    for (size_t row = 0; study != 0 && row < rows->count; row++) kept[row] &= study > 0 && rows->study[row] == (uint32_t)study;
    if (keep_values(index, filter, kept) && (!filter->text || keep_text(index, filter->text, kept))
        && (!filter->label_name || keep_label_member(index, filter, kept)))
        return kept;
    free(kept);
    return NULL;
}

/* Counts what is kept, then keeps what has one of the statuses. */
static void count_kinds(const index_rows *rows, const job_filter *filter, uint8_t *kept, int64_t counts[JOB_STATUSES])
{
    int64_t all[4][ROW_STATUS + 1] = { { 0 } }; /* jobs beside each other have one status, and would wait for one count */
    for (size_t row = 0; row < rows->count; row++) all[row % 4][rows->kind[row] & ROW_STATUS] += kept[row];
    for (int s = 0; s < JOB_STATUSES; s++) counts[s] = all[0][s] + all[1][s] + all[2][s] + all[3][s];
    const unsigned wanted = filter->statuses ? filter->statuses : ~0U;
    for (size_t row = 0; row < rows->count; row++) kept[row] &= (wanted >> (rows->kind[row] & ROW_STATUS)) & 1U;
}

store_status job_index_find(job_index *index, sqlite3 *reader, const job_filter *filter, int64_t study,
                            int64_t counts[JOB_STATUSES], found_job *found, size_t *count)
{
    store_status status = job_index_lock(index, reader, filter);
    if (status != STORE_OK) return status;
    uint8_t *kept = keep_fitting(index, filter, study);
    if (kept) count_kinds(&index->rows, filter, kept, counts);
    const bool good = kept && keep_page(index, filter, kept, found, count);
    free(kept);
    job_index_unlock(index);
    return good ? STORE_OK : STORE_FAILED;
}

store_status job_index_find_all(job_index *index, sqlite3 *reader, const job_filter *filter, int64_t study,
                                int64_t counts[JOB_STATUSES], int64_t **numbers, size_t *count)
{
    *numbers = NULL;
    *count = 0;
    const store_status status = job_index_lock(index, reader, filter);
    if (status != STORE_OK) return status;
    const index_rows *rows = &index->rows;
    uint8_t *kept = keep_fitting(index, filter, study);
    if (kept) count_kinds(rows, filter, kept, counts);
    for (size_t row = 0; kept && row < rows->count; row++) *count += kept[row];
    if (kept) *numbers = malloc((*count + 1) * sizeof **numbers);
    for (size_t row = 0, n = 0; *numbers && row < rows->count; row++)
        if (kept[row]) (*numbers)[n++] = rows->number[row];
    free(kept);
    job_index_unlock(index);
    return *numbers ? STORE_OK : STORE_FAILED;
}
