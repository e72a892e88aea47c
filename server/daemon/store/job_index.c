/* Reading the index in, and keeping it as the database is. */
#include "job_index.h"

#include <stdlib.h>
#include <string.h>

#include "database.h"
#include "job_index_rows.h"
#include "log.h"

enum {
    VALUES_AT_ONCE = 10000, /* of jobs that changed; some 3 us each where they are scattered */
    LABELS_AT_ONCE = 10000, /* some 3 us each, where members are looked for */
    MOST_CHANGES = 50000,   /* beyond that all is read anew */
    ROWS_AT_ONCE = 150000,  /* some 0.3 us each, of one column */
    FEW_REMOVED = 1000
};

/* --- changes --- */

/* Called for each row that the writer changes. */
static void note_row(void *context, int kind, const char *database, const char *table, sqlite3_int64 number)
{
    (void)kind, (void)database;
    job_index *index = context;
    const char *end = strrchr(table, '_');
    if (strcmp(table, "job") != 0 && !(end && (strcmp(end, "_input") == 0 || strcmp(end, "_result") == 0))) return;
    if (index->pendings > 0 && index->pending[index->pendings - 1] == number) return;
    if (index->pendings == index->pending_room) {
        const size_t room = 2 * index->pending_room + 64;
        int64_t *pending = room < 4 * MOST_CHANGES ? realloc(index->pending, room * sizeof *pending) : NULL;
        if (!pending) {
            index->lost_track = true;
            return;
        }
        index->pending = pending;
        index->pending_room = room;
    }
    index->pending[index->pendings++] = number;
}

static int compare_numbers(const void *a, const void *b)
{
    const int64_t x = *(const int64_t *)a, y = *(const int64_t *)b;
    return (x > y) - (x < y);
}

static void sort_changes(job_index *index)
{
    size_t kept = 0;
    if (index->changes > 1) qsort(index->changed, index->changes, sizeof *index->changed, compare_numbers);
    for (size_t i = 0; i < index->changes; i++)
        if (kept == 0 || index->changed[i] != index->changed[kept - 1]) index->changed[kept++] = index->changed[i];
    index->changes = kept;
}

/* With the changes' lock held. Running jobs change every second: the same few again and again. */
static bool keep_changes(job_index *index)
{
    if (index->changes + index->pendings > index->changes_room) {
        sort_changes(index);
        const size_t room = 2 * (index->changes + index->pendings) + 256;
        int64_t *changed =
            index->changes + index->pendings <= MOST_CHANGES ? realloc(index->changed, room * sizeof *changed) : NULL;
        if (!changed) return false;
        index->changed = changed;
        index->changes_room = room;
    }
    if (index->pendings > 0) memcpy(index->changed + index->changes, index->pending, index->pendings * sizeof *index->pending);
    index->changes += index->pendings;
    return true;
}

static void forget_changes(job_index *index)
{
    free(index->changed);
    index->changed = NULL;
    index->changes = index->changes_room = 0;
}

const int64_t *job_index_changing(const job_index *index, size_t *count, bool *are_more)
{
    *count = index->pendings;
    *are_more = index->lost_track;
    return index->pending;
}

void job_index_note_end(job_index *index, bool is_committed)
{
    if (index->pendings > 0 || index->lost_track) {
        pthread_mutex_lock(&index->changes_lock);
        /* Of a commit that failed nobody knows what came of it. */
        if (index->is_loaded && (!is_committed || index->lost_track || !keep_changes(index))) {
            index->is_loaded = false; /* to be read anew */
            forget_changes(index);
        }
        pthread_mutex_unlock(&index->changes_lock);
    }
    index->pendings = 0;
    index->lost_track = false;
    if (index->pending_room < 4096) return;
    free(index->pending);
    index->pending = NULL;
    index->pending_room = 0;
}

/* --- rows --- */

size_t index_rows_from(const index_rows *rows, int64_t number)
{
    size_t low = 0, high = rows->count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (rows->number[middle] < number) low = middle + 1;
        else high = middle;
    }
    return low;
}

size_t index_rows_find(const index_rows *rows, int64_t number)
{
    const size_t row = index_rows_from(rows, number);
    return row < rows->count && rows->number[row] == number ? row : rows->count;
}

#define GROW(array)                                                                                                                \
    do {                                                                                                                           \
        void *grown = realloc(rows->array, most * sizeof *rows->array);                                                            \
        if (grown) rows->array = grown;                                                                                            \
        good = good && grown;                                                                                                      \
    } while (0)

static bool make_room(job_index *index)
{
    index_rows *rows = &index->rows;
    if (rows->count < rows->most) return true;
    const size_t most = rows->most + rows->most / 4 + 1000;
    bool good = value_columns_grow(index, most);
    GROW(number);
    GROW(stamp);
    GROW(bits);
    GROW(label);
    GROW(study);
    GROW(kind);
    if (good) rows->most = most;
    return good;
}

static void drop_rows(job_index *index)
{
    index_rows *rows = &index->rows;
    free(rows->number);
    free(rows->stamp);
    free(rows->bits);
    free(rows->label);
    free(rows->study);
    free(rows->kind);
    *rows = (index_rows){ .count = 0 };
    text_pool_clear(&index->labels);
    text_search_clear(&index->search);
    value_columns_drop(index);
}

/* "20261130-104310-0badcafe" */
static void split_id(const char *id, uint64_t *stamp, uint32_t *bits)
{
    *stamp = 0;
    for (int i = 0; i < 15; i++)
        if (id[i] != '-') *stamp = 10 * *stamp + (uint64_t)(id[i] - '0');
    *bits = (uint32_t)strtoul(id + 16, NULL, 16);
}

static uint8_t kind_of(const char *process, const char *status)
{
    job_status state = JOB_ACCEPTED;
    uint8_t p = 0;
    job_status_parse(status, strlen(status), &state);
    while (process_types[p] && strcmp(process_types[p]->name, process) != 0) p++;
    return (uint8_t)((p << ROW_PROCESS_SHIFT) | (uint8_t)state);
}

#define ROW "number, id, process, status, label, coalesce(study,0)"

/* false: no memory. */
static bool set_row(job_index *index, size_t row, sqlite3_stmt *from)
{
    index_rows *rows = &index->rows;
    const char *id = (const char *)sqlite3_column_text(from, 1), *label = (const char *)sqlite3_column_text(from, 4);
    if (!id || !label || !job_id_is_valid(id) || !text_pool_add(&index->labels, label, &rows->label[row])) return false;
    rows->number[row] = sqlite3_column_int64(from, 0);
    split_id(id, &rows->stamp[row], &rows->bits[row]);
    rows->study[row] = (uint32_t)sqlite3_column_int64(from, 5);
    rows->kind[row] = kind_of((const char *)sqlite3_column_text(from, 2), (const char *)sqlite3_column_text(from, 3));
    return true;
}

/* --- all of them --- */

typedef struct sort_row {
    int64_t number;
    size_t row;
} sort_row;

static int compare_rows(const void *a, const void *b)
{
    const int64_t x = ((const sort_row *)a)->number, y = ((const sort_row *)b)->number;
    return (x > y) - (x < y);
}

#define PERMUTE(array, type)                                                                                                       \
    do {                                                                                                                           \
        type *copy = scratch;                                                                                                      \
        for (size_t i = 0; i < rows->count; i++) copy[i] = rows->array[order[i].row];                                              \
        memcpy(rows->array, copy, rows->count * sizeof *copy);                                                                     \
    } while (0)

/* The database gives them in the order of the index that holds all that is needed of them. */
static bool sort_rows(index_rows *rows)
{
    bool is_sorted = true;
    for (size_t i = 1; i < rows->count; i++) is_sorted = is_sorted && rows->number[i - 1] < rows->number[i];
    if (is_sorted) return true;
    sort_row *order = malloc(rows->count * sizeof *order);
    void *scratch = malloc(rows->count * sizeof(uint64_t));
    const bool good = order && scratch;
    if (good) {
        for (size_t i = 0; i < rows->count; i++) order[i] = (sort_row){ rows->number[i], i };
        qsort(order, rows->count, sizeof *order, compare_rows);
        PERMUTE(number, int64_t);
        PERMUTE(stamp, uint64_t);
        PERMUTE(bits, uint32_t);
        PERMUTE(label, uint32_t);
        PERMUTE(study, uint32_t);
        PERMUTE(kind, uint8_t);
    }
    free(order);
    free(scratch);
    return good;
}

static store_status read_all(job_index *index, sqlite3 *reader)
{
    drop_rows(index);
    /* From here on changes are kept: of what is read now, too. */
    pthread_mutex_lock(&index->changes_lock);
    forget_changes(index);
    index->is_loaded = true;
    pthread_mutex_unlock(&index->changes_lock);
    sqlite3_stmt *row = sql_prepare(reader, "SELECT " ROW " FROM job INDEXED BY job_listed", "");
    bool good = row != NULL;
    int code = SQLITE_ERROR;
    while (good && (code = sqlite3_step(row)) == SQLITE_ROW) {
        good = make_room(index) && set_row(index, index->rows.count, row);
        if (good) index->rows.count++;
    }
    if (row) good = sql_finish(row, code) == STORE_OK && good;
    good = good && sort_rows(&index->rows);
    if (good) return STORE_OK;
    log_line("the list of jobs can't be kept in memory");
    pthread_mutex_lock(&index->changes_lock);
    index->is_loaded = false;
    pthread_mutex_unlock(&index->changes_lock);
    drop_rows(index);
    return STORE_FAILED;
}

/* --- those that changed --- */

static void remove_row(job_index *index, size_t row)
{
    index_rows *rows = &index->rows;
    if (row == rows->count || (rows->kind[row] & ROW_STATUS) == ROW_REMOVED) return;
    rows->kind[row] = ROW_REMOVED;
    rows->removed++;
    text_pool_leave(&index->labels, rows->label[row]);
}

/* from is at the job's row. */
static bool change_row(job_index *index, int64_t number, sqlite3_stmt *from, size_t *row)
{
    index_rows *rows = &index->rows;
    const bool is_new = *row == rows->count;
    if (is_new && rows->count > 0 && number <= rows->number[rows->count - 1]) return false; /* numbers only grow */
    if (is_new && !make_room(index)) return false;
    const uint32_t label = is_new ? 0 : rows->label[*row];
    if (!set_row(index, *row, from)) return false;
    if (is_new) rows->count++;
    else text_pool_leave(&index->labels, label);
    return true;
}

/* Jobs whose numbers follow each other, as those of a study do. */
static store_status read_again(job_index *index, sqlite3 *reader, int64_t first, int64_t last)
{
    sqlite3_stmt *from =
        sql_prepare(reader, "SELECT " ROW " FROM job WHERE number BETWEEN ? AND ? ORDER BY number", "ii", first, last);
    if (!from) return STORE_FAILED;
    bool good = true;
    int code = SQLITE_ROW;
    int64_t expected = first;
    while (good && (code = sqlite3_step(from)) == SQLITE_ROW) {
        const int64_t number = sqlite3_column_int64(from, 0);
        for (; expected < number; expected++) remove_row(index, index_rows_find(&index->rows, expected));
        size_t row = index_rows_find(&index->rows, number);
        good = change_row(index, number, from, &row);
        expected = number + 1;
    }
    for (; good && code == SQLITE_DONE && expected <= last; expected++) remove_row(index, index_rows_find(&index->rows, expected));
    if (sql_finish(from, code) != STORE_OK || !good) return STORE_FAILED;
    return value_columns_refresh(index, reader, first, last);
}

/* More gaps than jobs, or texts that nobody has: reading it anew is the way to smaller arrays. */
static bool is_worn(const job_index *index)
{
    return index->rows.removed > index->rows.count / 2 + FEW_REMOVED
           || index->labels.unused > index->labels.count / 2 + FEW_REMOVED;
}

static store_status take_changes(job_index *index, sqlite3 *reader)
{
    pthread_mutex_lock(&index->changes_lock);
    sort_changes(index);
    const bool is_loaded = index->is_loaded;
    int64_t *changed = index->changed;
    const size_t changes = index->changes;
    index->changed = NULL;
    index->changes = index->changes_room = 0;
    pthread_mutex_unlock(&index->changes_lock);
    store_status status = is_loaded && !is_worn(index) ? STORE_OK : STORE_FAILED;
    for (size_t c = 0, next; status == STORE_OK && c < changes; c = next) {
        for (next = c + 1; next < changes && changed[next] == changed[next - 1] + 1;) next++;
        status = read_again(index, reader, changed[c], changed[next - 1]);
    }
    free(changed);
    return status == STORE_OK ? STORE_OK : read_all(index, reader);
}

/* --- as the filter needs it --- */

typedef struct reading {
    job_index *index;
    sqlite3 *reader;
    store_status status;
    size_t missing;
} reading;

static bool read_column(void *context, const char *name)
{
    reading *all = context;
    value_column *column = value_column_find(all->index, name);
    if (!column) all->status = value_column_read(all->index, all->reader, name);
    if (all->status == STORE_OK) value_column_find(all->index, name)->used_at = ++all->index->looks;
    return all->status == STORE_OK;
}

static store_status bring_up_to_date(job_index *index, sqlite3 *reader, const job_filter *filter)
{
    reading all = { index, reader, STORE_OK, 0 };
    all.status = take_changes(index, reader);
    if (all.status == STORE_OK && filter) filter_columns(filter, read_column, &all);
    return all.status;
}

store_status job_index_lock(job_index *index, sqlite3 *reader, const job_filter *filter)
{
    const bool is_quick = job_index_is_ready(index, filter);
    if (!is_quick) atomic_fetch_add(&index->readers, 1); /* from now on others do not wait for the lock */
    pthread_mutex_lock(&index->lock);
    const store_status status = bring_up_to_date(index, reader, filter);
    if (!is_quick) atomic_fetch_sub(&index->readers, 1);
    if (status != STORE_OK) pthread_mutex_unlock(&index->lock);
    return status;
}

void job_index_unlock(job_index *index) { pthread_mutex_unlock(&index->lock); }

static bool count_missing(void *context, const char *name)
{
    reading *all = context;
    all->missing += value_column_find(all->index, name) == NULL;
    return true;
}

bool job_index_is_ready(job_index *index, const job_filter *filter)
{
    if (atomic_load(&index->readers) > 0) return false;
    reading all = { .index = index };
    pthread_mutex_lock(&index->changes_lock);
    const bool is_loaded = index->is_loaded;
    const size_t changes = index->changes;
    pthread_mutex_unlock(&index->changes_lock);
    pthread_mutex_lock(&index->lock);
    if (filter) filter_columns(filter, count_missing, &all);
    const bool is_worn_out = is_worn(index) || (filter && filter->label_name && index->labels.count > LABELS_AT_ONCE);
    const size_t to_read = all.missing * index->rows.count, to_read_again = changes * (3 + index->columns);
    pthread_mutex_unlock(&index->lock);
    return is_loaded && !is_worn_out && to_read_again <= VALUES_AT_ONCE && to_read <= ROWS_AT_ONCE;
}

void job_index_warm(job_index *index, sqlite3 *reader)
{
    if (job_index_lock(index, reader, NULL) == STORE_OK) job_index_unlock(index);
}

job_index *job_index_create(const field_columns *columns, sqlite3 *writer)
{
    job_index *index = calloc(1, sizeof *index);
    if (!index) return NULL;
    index->fields = columns;
    pthread_mutex_init(&index->lock, NULL);
    pthread_mutex_init(&index->changes_lock, NULL);
    sqlite3_update_hook(writer, note_row, index);
    return index;
}

void job_index_free(job_index *index)
{
    if (!index) return;
    drop_rows(index);
    forget_changes(index);
    free(index->pending);
    pthread_mutex_destroy(&index->lock);
    pthread_mutex_destroy(&index->changes_lock);
    free(index);
}
