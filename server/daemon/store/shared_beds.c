/* Jobs of a study that would settle the same bed have the same number in job.bed. The first of them that runs settles it, and its
 * worker tells that bed.hdf is there, and its SHA-256: a row of `bed`. Each further one is given that file, under a name of its
 * own, when its worker starts. A bed is only ever a saving: where the row or the file is gone, or the worker refuses the file, the
 * job settles by itself. */
#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "data_folder.h"
#include "database.h"
#include "job_folder.h"
#include "job_store.h"
#include "log.h"
#include "text_copy.h"

enum { LONGEST_LINE = 2 * JOB_ID_SIZE + 80 };

/* Where one was held up so long that another settled, too, the bed of whoever was first is kept; the other's file is needed by
 * nobody. */
store_status store_record_bed(job_store *store, const job_claim *claim, const char *sha256)
{
    int64_t kept = 0;
    const store_status status = sql_run(store->writer, &kept,
                                        "INSERT INTO bed SELECT bed, number, ? FROM job WHERE number=? AND bed IS NOT NULL"
                                        " ON CONFLICT(key) DO UPDATE SET sha256=excluded.sha256 WHERE job=excluded.job",
                                        "ti", sha256, claim->number);
    if (status == STORE_OK && kept == 0) job_bed_remove(store->data, claim->id);
    return status;
}

/* Whose bed it is, and the line that says so to the worker. False: nobody's yet. */
static bool find_bed(job_store *store, int64_t bed, char from[JOB_ID_SIZE], char line[LONGEST_LINE])
{
    sqlite3 *reader = store_borrow_reader(store);
    sqlite3_stmt *row = sql_prepare(reader, "SELECT id, sha256 FROM bed JOIN job ON job.number=bed.job WHERE bed.key=?", "i", bed);
    const int code = row ? sqlite3_step(row) : SQLITE_ERROR;
    const bool found = code == SQLITE_ROW;
    if (found) {
        text_copy(from, JOB_ID_SIZE, (const char *)sqlite3_column_text(row, 0));
        snprintf(line, LONGEST_LINE, "%.64s  %s\n", (const char *)sqlite3_column_text(row, 1), from);
    }
    if (row) sql_finish(row, code);
    store_return_reader(store, reader);
    return found;
}

bool store_has_bed(job_store *store, int64_t bed)
{
    char from[JOB_ID_SIZE], line[LONGEST_LINE];
    return find_bed(store, bed, from, line);
}

/* Where that fails the next job finds once more that the file is gone. */
static void forget_bed(job_store *store, int64_t bed)
{
    const store_status status = store_begin(store);
    if (status == STORE_OK) store_end(store, sql_run(store->writer, NULL, "DELETE FROM bed WHERE key=?", "i", bed));
}

bool store_bring_bed(job_store *store, const job_claim *claim)
{
    char from[JOB_ID_SIZE], line[LONGEST_LINE];
    if (!find_bed(store, claim->bed, from, line)) return false;
    if (strcmp(from, claim->id) == 0 || job_folder_add_bed(store->data, claim->id, from, line)) return true;
    log_line("job %s: the bed of the job %s can't be had, and is settled again: %s", claim->id, from, strerror(errno));
    forget_bed(store, claim->bed);
    return false;
}

static bool remove_bed(sqlite3_stmt *row, void *context)
{
    job_store *store = context;
    job_bed_remove(store->data, (const char *)sqlite3_column_text(row, 1));
    return true;
}

#define UNUSED                                                                                                                     \
    " NOT EXISTS(SELECT 1 FROM job WHERE job.bed=bed.key AND job.bed IS NOT NULL AND job.status IN ('accepted','running'))"

void store_drop_beds(job_store *store)
{
    int64_t any = 0;
    sqlite3 *reader = store_borrow_reader(store);
    sqlite3_stmt *rows =
        sql_prepare(reader, "SELECT bed.key, maker.id FROM bed JOIN job AS maker ON maker.number=bed.job WHERE" UNUSED, "");
    if (store_walk(store, reader, rows, remove_bed, store) != STORE_OK || store_begin(store) != STORE_OK) return;
    store_end(store, sql_run(store->writer, &any, "DELETE FROM bed WHERE" UNUSED, ""));
}
