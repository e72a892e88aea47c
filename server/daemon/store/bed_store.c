/* Tables of particles that were sent, for runs to start from. */
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "database.h"
#include "job_store.h"
#include "log.h"

#define SELECT_BEDS "SELECT number, id, created, particles, bytes FROM sent_bed"

static void fill_record(sqlite3_stmt *row, bed_record *bed)
{
    *bed = (bed_record){ .number = sqlite3_column_int64(row, 0),
                         .particles = sqlite3_column_int64(row, 3),
                         .bytes = sqlite3_column_int64(row, 4) };
    snprintf(bed->id, sizeof bed->id, "%s", (const char *)sqlite3_column_text(row, 1));
    snprintf(bed->created, sizeof bed->created, "%s", (const char *)sqlite3_column_text(row, 2));
}

static store_status count_beds(job_store *store, int64_t *count)
{
    sqlite3_stmt *row = sql_prepare(store->writer, "SELECT count(*) FROM sent_bed", "");
    const int code = row ? sqlite3_step(row) : SQLITE_ERROR;
    if (code == SQLITE_ROW) *count = sqlite3_column_int64(row, 0);
    return row ? sql_finish(row, code) : STORE_FAILED;
}

store_status store_add_bed(job_store *store, const char *text, size_t length, int64_t particles, bed_record *bed)
{
    uint32_t bits;
    int64_t count = 0;
    if (data_folder_is_nearly_full(store->data)) return STORE_FULL;
    if (!store_random_bits(&bits)) return STORE_FAILED;
    *bed = (bed_record){ .particles = particles, .bytes = (int64_t)length };
    store_write_id(bed->id, time(NULL), bits);
    time_text(bed->created);
    store_status status = store_begin(store);
    if (status != STORE_OK) return status;
    status = count_beds(store, &count);
    if (status == STORE_OK && count >= STORE_MOST_BEDS) status = STORE_QUEUE_FULL;
    if (status == STORE_OK)
        status = sql_run(store->writer, NULL, "INSERT INTO sent_bed(id,created,particles,bytes) VALUES(?,?,?,?)", "ttii", bed->id,
                         bed->created, particles, (int64_t)length);
    bed->number = sqlite3_last_insert_rowid(store->writer);
    if (status == STORE_OK) status = sql_run(store->writer, NULL, "INSERT INTO sent_bed_text VALUES(?,?)", "it", bed->number, text);
    store_name_made(bed->id);
    return store_end(store, status);
}

store_status store_find_bed(job_store *store, const char *id, bed_record *bed)
{
    sqlite3 *reader = store_borrow_reader(store);
    sqlite3_stmt *row = sql_prepare(reader, SELECT_BEDS " WHERE id=?", "t", id);
    const int code = row ? sqlite3_step(row) : SQLITE_ERROR;
    if (code == SQLITE_ROW) fill_record(row, bed);
    const store_status status = row ? sql_finish(row, code) : STORE_FAILED;
    store_return_reader(store, reader);
    return status == STORE_OK && code != SQLITE_ROW ? STORE_NOT_FOUND : status;
}

typedef struct bed_walk {
    bed_visitor *visit;
    void *context;
} bed_walk;

static bool take_bed(sqlite3_stmt *row, void *context)
{
    const bed_walk *to = context;
    bed_record bed;
    fill_record(row, &bed);
    return to->visit(to->context, &bed);
}

store_status store_list_beds(job_store *store, bed_visitor *visit, void *context)
{
    bed_walk to = { visit, context };
    sqlite3 *reader = store_borrow_reader(store);
    return store_walk(store, reader, sql_prepare(reader, SELECT_BEDS " ORDER BY number DESC", ""), take_bed, &to);
}

store_status store_read_bed(job_store *store, const char *id, char **text)
{
    return store_read_text(store, "SELECT text FROM sent_bed JOIN sent_bed_text ON bed=number WHERE id=?", id, text);
}

store_status store_delete_bed(job_store *store, const char *id)
{
    int64_t deleted = 0;
    store_status status = store_begin(store);
    if (status != STORE_OK) return status;
    status = sql_run(store->writer, &deleted, "DELETE FROM sent_bed WHERE id=?", "t", id);
    if (status == STORE_OK && deleted == 0) status = STORE_NOT_FOUND;
    return store_end(store, status);
}
