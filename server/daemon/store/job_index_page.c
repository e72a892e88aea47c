/* The order of a list, and the page of it that a filter asks for. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "job_index_rows.h"

/* What a row is sorted by. */
typedef struct sort_key {
    double value; /* NaN: none */
    int64_t number;
} sort_key;

typedef struct sorting {
    const value_column *column; /* NULL: by number alone */
    double *rank;               /* of each word; owned */
    bool falls;
    sort_key after; /* number 0: from the beginning */
} sorting;

static double value_at(const sorting *order, size_t row)
{
    const double value = order->column ? order->column->value[row] : NAN;
    return order->rank && !isnan(value) ? order->rank[(size_t)value] : value;
}

/* Whether a comes before b: by value, those that lack it last; then the newer first. */
static bool is_before(const sorting *order, sort_key a, sort_key b)
{
    const bool a_lacks = isnan(a.value), b_lacks = isnan(b.value);
    if (a_lacks != b_lacks) return b_lacks;
    if (!a_lacks && a.value != b.value) return order->falls ? a.value > b.value : a.value < b.value;
    return a.number > b.number;
}

/* Ranks by the alphabet; the word of the cursor, which may be gone, stands between those before and after it. */
static bool rank_words(sorting *order, const char *after)
{
    const text_pool *words = &order->column->words;
    order->rank = malloc((words->count + 1) * sizeof *order->rank);
    if (!order->rank) return false;
    double below = 0.0;
    bool is_there = false;
    for (uint32_t w = 0; w < words->count; w++) {
        const char *word = text_pool_text(words, w);
        order->rank[w] = 0.0;
        for (uint32_t v = 0; v < words->count; v++) order->rank[w] += strcmp(text_pool_text(words, v), word) < 0;
        if (!after) continue;
        below += strcmp(word, after) < 0;
        is_there = is_there || strcmp(word, after) == 0;
    }
    order->after.value = after ? below - (is_there ? 0.0 : 0.5) : NAN;
    return true;
}

static bool prepare_order(job_index *index, const job_filter *filter, sorting *order)
{
    *order = (sorting){ .column = filter->sort ? value_column_find(index, filter->sort) : NULL,
                        .falls = filter->sort_falls,
                        .after = { NAN, filter->after } };
    if (!order->column) return true;
    if (order->column->is_words) return rank_words(order, filter->after_value);
    if (filter->after_value) order->after.value = strtod(filter->after_value, NULL);
    return true;
}

/* A heap of the best so far, the last of them on top. */
typedef struct best_rows {
    size_t *row;
    sort_key *key;
    size_t count, most;
} best_rows;

static void swap(best_rows *best, size_t a, size_t b)
{
    const size_t row = best->row[a];
    const sort_key key = best->key[a];
    best->row[a] = best->row[b];
    best->key[a] = best->key[b];
    best->row[b] = row;
    best->key[b] = key;
}

static void sink(const sorting *order, best_rows *best, size_t at, size_t count)
{
    for (size_t child; (child = 2 * at + 1) < count; at = child) {
        if (child + 1 < count && is_before(order, best->key[child], best->key[child + 1])) child++;
        if (!is_before(order, best->key[at], best->key[child])) return;
        swap(best, at, child);
    }
}

static void offer(const sorting *order, best_rows *best, size_t row, sort_key key)
{
    if (order->after.number && !is_before(order, order->after, key)) return;
    if (best->count < best->most) {
        size_t at = best->count++;
        best->row[at] = row;
        best->key[at] = key;
        for (; at > 0 && is_before(order, best->key[(at - 1) / 2], best->key[at]); at = (at - 1) / 2) swap(best, at, (at - 1) / 2);
    } else if (is_before(order, key, best->key[0])) {
        best->row[0] = row;
        best->key[0] = key;
        sink(order, best, 0, best->count);
    }
}

static void write_cursor(const sorting *order, size_t row, sort_key key, char cursor[JOB_CURSOR_SIZE])
{
    if (!order->column) snprintf(cursor, JOB_CURSOR_SIZE, "%lld", (long long)key.number);
    else if (isnan(key.value)) snprintf(cursor, JOB_CURSOR_SIZE, "%lld:", (long long)key.number);
    else if (order->rank)
        snprintf(cursor, JOB_CURSOR_SIZE, "%lld:%.70s", (long long)key.number,
                 text_pool_text(&order->column->words, (uint32_t)order->column->value[row]));
    else snprintf(cursor, JOB_CURSOR_SIZE, "%lld:%.17g", (long long)key.number, key.value);
}

/* Whether the oldest that is kept comes before the newest. Whoever begins where the page does, has it soon, and passes over the
 * rest. */
static bool oldest_is_first(const index_rows *rows, const sorting *order, const uint8_t *kept)
{
    size_t oldest = 0, newest = rows->count;
    while (oldest < rows->count && !kept[oldest]) oldest++;
    while (newest > oldest && !kept[newest - 1]) newest--;
    return oldest < newest
           && is_before(order, (sort_key){ value_at(order, oldest), rows->number[oldest] },
                        (sort_key){ value_at(order, newest - 1), rows->number[newest - 1] });
}

static bool choose_page(const index_rows *rows, const sorting *order, const uint8_t *kept, size_t most, found_job *found,
                        size_t *count)
{
    best_rows best = { malloc(most * sizeof *best.row), malloc(most * sizeof *best.key), 0, most };
    const bool good = best.row && best.key;
    const bool from_oldest = good && order->column && oldest_is_first(rows, order, kept);
    for (size_t k = 0; good && k < rows->count; k++) {
        const size_t row = from_oldest ? k : rows->count - 1 - k;
        if (!kept[row]) continue;
        if (!order->column && best.count == most) break; /* the newest first, which is how they come */
        const sort_key key = { value_at(order, row), rows->number[row] };
        if (best.count < most || is_before(order, key, best.key[0])) offer(order, &best, row, key);
    }
    *count = best.count;
    for (size_t left = best.count; good && left > 0; left--) { /* the last of those that are left is on top */
        found[left - 1].number = best.key[0].number;
        write_cursor(order, best.row[0], best.key[0], found[left - 1].cursor);
        swap(&best, 0, left - 1);
        sink(order, &best, 0, left - 1);
    }
    free(best.row);
    free(best.key);
    return good;
}

bool keep_page(job_index *index, const job_filter *filter, const uint8_t *kept, found_job *found, size_t *count)
{
    sorting order;
    const bool good =
        prepare_order(index, filter, &order) && choose_page(&index->rows, &order, kept, (size_t)filter->limit, found, count);
    free(order.rank);
    return good;
}
