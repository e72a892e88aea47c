/* The store's connections, and what the handlers ask of it (api/store/store.h). */
#include "job_store.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>
#include <time.h>
#include <unistd.h>

#include "callbacks.h"
#include "checksum.h"
#include "database.h"
#include "job_folder.h"
#include "log.h"

job_store *store_open(data_folder *data, int64_t queue_limit)
{
    job_store *store = calloc(1, sizeof *store);
    if (!store) return NULL;
    store->data = data;
    store->queue_limit = queue_limit;
    store->places = 1;
    pthread_mutex_init(&store->write_lock, NULL);
    pthread_mutex_init(&store->readers_lock, NULL);
    pthread_cond_init(&store->reader_is_free, NULL);
    pthread_mutex_init(&store->group_lock, NULL);
    pthread_cond_init(&store->group_is_over, NULL);
    char path[4096];
    snprintf(path, sizeof path, "%s/reposed.sqlite", data->path);
    bool good = field_tables_init(&store->fields);
    if (!good) log_line("database: out of memory for the tables of fields");
    good = good && (store->writer = database_open_writer(path)) != NULL;
    if (good) good = (store->index = job_index_create(&store->fields.columns, store->writer)) != NULL;
    if (good) good = (store->changes = job_changes_create()) != NULL;
    for (; good && store->readers_free < STORE_READERS; store->readers_free++)
        good = (store->reader[store->readers_free] = database_open_reader(path)) != NULL;
    if (good) good = (store->query = database_open_reader(path)) != NULL && query_connection_restrict(store);
    if (!good) {
        if (store->query) log_line("%s can't be asked: there is no memory", path);
        store_close(store);
        return NULL;
    }
    return store;
}

void store_close(job_store *store)
{
    database_close(store->query);
    for (int i = 0; i < STORE_READERS; i++) database_close(store->reader[i]);
    database_close(store->writer); /* last, so that the checkpoint at the end is the writer's */
    pthread_cond_destroy(&store->reader_is_free);
    pthread_mutex_destroy(&store->readers_lock);
    pthread_mutex_destroy(&store->write_lock);
    pthread_cond_destroy(&store->group_is_over);
    pthread_mutex_destroy(&store->group_lock);
    free(store->query_tables);
    job_index_free(store->index);
    job_changes_free(store->changes);
    field_tables_clear(&store->fields);
    free(store);
}

sqlite3 *store_borrow_reader(job_store *store)
{
    pthread_mutex_lock(&store->readers_lock);
    while (store->readers_free == 0) pthread_cond_wait(&store->reader_is_free, &store->readers_lock);
    sqlite3 *reader = store->reader[--store->readers_free];
    pthread_mutex_unlock(&store->readers_lock);
    return reader;
}

void store_return_reader(job_store *store, sqlite3 *reader)
{
    pthread_mutex_lock(&store->readers_lock);
    store->reader[store->readers_free++] = reader;
    pthread_cond_signal(&store->reader_is_free);
    pthread_mutex_unlock(&store->readers_lock);
}

store_status store_walk(job_store *store, sqlite3 *reader, sqlite3_stmt *statement, store_row_taker *take, void *context)
{
    store_status status = STORE_FAILED;
    if (statement) {
        int code;
        while ((code = sqlite3_step(statement)) == SQLITE_ROW && take(statement, context)) continue;
        status = sql_finish(statement, code);
    }
    store_return_reader(store, reader);
    return status;
}

/* --- adding and dismissing --- */

bool store_random_bits(uint32_t *bits) { return getrandom(bits, sizeof *bits, 0) == (ssize_t)sizeof *bits; }

void store_write_id(char id[JOB_ID_SIZE], time_t second, uint32_t bits)
{
    struct tm parts;
    gmtime_r(&second, &parts);
    const size_t length = strftime(id, JOB_ID_SIZE, "%Y%m%d-%H%M%S-", &parts);
    snprintf(id + length, JOB_ID_SIZE - length, "%08x", bits);
}

int64_t store_queue_limit(const job_store *store) { return store->queue_limit; }

double store_free_bytes(const job_store *store) { return data_folder_free_bytes(store->data); }

store_status store_check_queue(job_store *store, int64_t jobs)
{
    sqlite3_stmt *statement = sql_prepare(store->writer, "SELECT jobs FROM job_count WHERE status='accepted'", "");
    if (!statement) return STORE_FAILED;
    const int code = sqlite3_step(statement);
    const int64_t waiting = code == SQLITE_ROW ? sqlite3_column_int64(statement, 0) : 0;
    const store_status status = sql_finish(statement, code);
    return status == STORE_OK && waiting + jobs > store->queue_limit ? STORE_QUEUE_FULL : status;
}

/* Who takes turns with others: "" where the label does not say. */
static const char *client_of(const job_spec *spec)
{
    const char *client = json_string_value(json_object_get(spec->label, "client"));
    return client ? client : "";
}

static store_status insert_row(sqlite3 *writer, int64_t number, const job_spec *spec, const char *id, const char *text,
                               const char *label, const char *wanted, const char *given, const job_place *place,
                               const job_estimate *estimate)
{
    char now[JOB_TIME_SIZE], resources[RESOURCES_SIZE];
    time_text(now);
    if (!job_resources_write(spec->resources, resources)) return STORE_FAILED;
    return sql_run(
        writer, NULL,
        "INSERT INTO "
        "job(number,id,process,label,spec,status,message,threads,estimated_seconds,estimated_memory_bytes,created,updated,"
        "study,study_case,study_repeat,priority,client,turn,wanted,given,bed,resources) "
        "VALUES(nullif(?12,0),?1,?2,?3,?4,'accepted',"
        "'waiting for a free worker',?5,?6,?7,?8,?8,"
        "nullif(?9,0),iif(?9=0,NULL,?10),iif(?9=0,NULL,?11),?13,?14,?15,?16,?17,nullif(?18,0),nullif(?19,''))",
        "ttttiddtiiiiitittit", id, spec->process, label, text, (int64_t)spec->threads, estimate->wall_seconds,
        estimate->memory_bytes, now, place->study, place->index, place->repeat, number, (int64_t)spec->priority, client_of(spec),
        place->turn, wanted, given, place->bed, resources);
}

store_status store_insert_job(const field_tables *fields, sqlite3 *writer, int64_t number, const job_spec *spec, const char *id,
                              const char *text, const job_place *place, const calibration *machine)
{
    char *label = json_dumps(spec->label, JSON_COMPACT | JSON_REAL_PRECISION(15)); /* 0.1, not 0.10000000000000001 */
    char *wanted = spec->wanted ? json_dumps(spec->wanted, JSON_COMPACT) : NULL;
    char *given = spec->given ? json_dumps(spec->given, JSON_COMPACT) : NULL;
    const job_estimate estimate = job_spec_estimate(spec, machine);
    store_status status = !label || (spec->wanted && !wanted)
                              ? STORE_FAILED
                              : insert_row(writer, number, spec, id, text, label, wanted, given, place, &estimate);
    if (number == 0) number = sqlite3_last_insert_rowid(writer);
    if (status == STORE_OK) status = field_tables_insert_inputs(fields, writer, number, spec);
    if (status == STORE_OK) status = store_insert_load(writer, number, &estimate, machine);
    if (status == STORE_OK) status = store_insert_subscriber(writer, number, spec->subscriber);
    free(label);
    free(wanted);
    free(given);
    return status;
}

const char *job_started_from(const job_spec *spec)
{
    return strcmp(spec->process, "drum") == 0 && *spec->inputs.start.job ? spec->inputs.start.job : NULL;
}

bool store_bring_start(job_store *store, const char *from, double snapshot, const char *id)
{
    char name[32] = JOB_CHECKPOINT_FILE;
    const bool is_snapshot = !isnan(snapshot);
    if (is_snapshot) snprintf(name, sizeof name, JOB_SNAPSHOT_FILE_FORMAT, (long long)snapshot);
    return job_folder_add_start(store->data, id, from, is_snapshot ? JOB_SNAPSHOT_FOLDER : NULL, name);
}

store_status store_last_turn(job_store *store, const char *client, int64_t priority, int64_t *turn)
{
    sqlite3_stmt *row =
        sql_prepare(store->writer,
                    "SELECT max(coalesce((SELECT turn FROM queue_turn WHERE priority=?2),0),"
                    " coalesce((SELECT max(turn) FROM job WHERE status='accepted' AND client=?1 AND priority=?2),0))",
                    "ti", client, priority);
    const int code = row ? sqlite3_step(row) : SQLITE_ERROR;
    if (code == SQLITE_ROW) *turn = sqlite3_column_int64(row, 0);
    return row ? sql_finish(row, code) : STORE_FAILED;
}

/* The largest that a job ever had. */
static store_status last_number(job_store *store, int64_t *number)
{
    sqlite3_stmt *row =
        sql_prepare(store->writer, "SELECT max(number,coalesce((SELECT max(number) FROM job),0)) FROM last_deleted", "");
    const int code = row ? sqlite3_step(row) : SQLITE_ERROR;
    if (code == SQLITE_ROW) *number = sqlite3_column_int64(row, 0);
    return row ? sql_finish(row, code) : STORE_FAILED;
}

/* The folder of a job is made when its worker starts, but for one that starts from another's bed. */
static store_status bring_bed(job_store *store, const job_spec *spec, const char *id)
{
    const char *from = job_started_from(spec);
    if (!from || (store_bring_start(store, from, spec->inputs.start.snapshot, id) && job_folder_sync(store->data, id)))
        return STORE_OK;
    const store_status reason = errno == ENOSPC || errno == EDQUOT ? STORE_FULL : STORE_FAILED;
    log_line("job %s: its folder can't be written: %s", id, strerror(errno));
    job_folder_discard(store->data, id);
    return reason;
}

store_status store_insert_next(job_store *store, const job_spec *spec, const char *id, const char *text, const calibration *machine,
                               int64_t *number)
{
    job_place place = { .study = 0 };
    int64_t last = 0, last_turn = 0;
    store_status status = last_number(store, &last);
    if (status == STORE_OK) status = store_last_turn(store, client_of(spec), spec->priority, &last_turn);
    place.turn = last_turn + 1;
    *number = last + 1;
    return status == STORE_OK ? store_insert_job(&store->fields, store->writer, *number, spec, id, text, &place, machine) : status;
}

static store_status insert_alone(job_store *store, const job_spec *spec, const char *text, const char *id)
{
    calibration machine;
    int64_t number;
    store_read_calibration(store, &machine);
    store_status status = store_begin(store);
    if (status != STORE_OK) return status;
    status = store_check_queue(store, 1);
    if (status == STORE_OK) status = store_insert_next(store, spec, id, text, &machine, &number);
    store_name_made(id);
    return store_end(store, status);
}

static store_status add_with_text(job_store *store, const job_spec *spec, const char *text, char id[JOB_ID_SIZE])
{
    uint32_t bits;
    if (data_folder_is_nearly_full(store->data)) return STORE_FULL;
    if (!text || !store_random_bits(&bits)) return STORE_FAILED;
    store_write_id(id, time(NULL), bits);
    store_status status = bring_bed(store, spec, id);
    if (status != STORE_OK) return status;
    status = insert_alone(store, spec, text, id);
    if (status != STORE_OK && job_started_from(spec)) job_folder_discard(store->data, id);
    return status;
}

store_status store_add_job(job_store *store, const job_spec *spec, char id[JOB_ID_SIZE])
{
    char *text = job_spec_to_text(spec);
    const store_status status = add_with_text(store, spec, text, id);
    free(text);
    return status;
}

store_status store_has_job(job_store *store, const char *id)
{
    sqlite3 *reader = store_borrow_reader(store);
    sqlite3_stmt *statement = sql_prepare(reader, "SELECT 1 FROM job WHERE id=?", "t", id);
    const int code = statement ? sqlite3_step(statement) : SQLITE_ERROR;
    const store_status status = statement ? sql_finish(statement, code) : STORE_FAILED;
    store_return_reader(store, reader);
    return status == STORE_OK && code != SQLITE_ROW ? STORE_NOT_FOUND : status;
}

double store_queue_age(job_store *store)
{
    sqlite3 *reader = store_borrow_reader(store);
    sqlite3_stmt *row = sql_prepare(reader,
                                    "SELECT max(0.0,(julianday('now')-julianday(updated))*86400.0) FROM job"
                                    " WHERE status='accepted' ORDER BY number LIMIT 1",
                                    "");
    const int code = row ? sqlite3_step(row) : SQLITE_ERROR;
    const double age = code == SQLITE_ROW ? sqlite3_column_double(row, 0) : 0.0;
    if (row) sql_finish(row, code);
    store_return_reader(store, reader);
    return age;
}

store_status store_dismiss_job(job_store *store, const char *id)
{
    char now[JOB_TIME_SIZE];
    time_text(now);
    int64_t changed = 0;
    store_status status = store_begin(store);
    if (status != STORE_OK) return status;
    status = sql_run(store->writer, &changed,
                     "UPDATE job SET status='dismissed', message='dismissed on request', eta_seconds=NULL, finished=?, updated=?"
                     " WHERE id=? AND status IN ('accepted','running')",
                     "ttt", now, now, id);
    status = store_end(store, status);
    if (status != STORE_OK || changed > 0) return status;
    const store_status found = store_has_job(store, id);
    return found == STORE_OK ? STORE_CONFLICT : found;
}

/* --- texts, counts, files --- */

store_status store_read_text(job_store *store, const char *sql, const char *id, char **text)
{
    *text = NULL;
    sqlite3 *reader = store_borrow_reader(store);
    sqlite3_stmt *statement = sql_prepare(reader, sql, "t", id);
    store_status status = STORE_FAILED;
    if (statement) {
        const int code = sqlite3_step(statement);
        const char *value = code == SQLITE_ROW ? (const char *)sqlite3_column_text(statement, 0) : NULL;
        if (value) *text = strdup(value);
        status = sql_finish(statement, code);
        if (status == STORE_OK && !*text) status = value ? STORE_FAILED : STORE_NOT_FOUND;
    }
    store_return_reader(store, reader);
    return status;
}

store_status store_read_spec(job_store *store, const char *id, char **text)
{
    *text = NULL;
    sqlite3 *reader = store_borrow_reader(store);
    sqlite3_stmt *statement = sql_prepare(reader, "SELECT spec, study FROM job WHERE id=?", "t", id);
    store_status status = STORE_FAILED;
    if (statement) {
        const int code = sqlite3_step(statement);
        const char *spec = code == SQLITE_ROW ? (const char *)sqlite3_column_text(statement, 0) : NULL;
        if (spec) *text = study_parts_expand(reader, sqlite3_column_int64(statement, 1), spec);
        status = sql_finish(statement, code);
        if (status == STORE_OK && !*text) status = code == SQLITE_ROW ? STORE_FAILED : STORE_NOT_FOUND;
    }
    store_return_reader(store, reader);
    return status;
}

/* A document that was damaged in the table is in the job's folder, too. */
store_status store_read_results(job_store *store, const char *id, char **text)
{
    *text = NULL;
    sqlite3 *reader = store_borrow_reader(store);
    sqlite3_stmt *row =
        sql_prepare(reader, "SELECT document, checksum FROM result JOIN job ON result.job=job.number WHERE job.id=?", "t", id);
    const int code = row ? sqlite3_step(row) : SQLITE_ERROR;
    const char *document = code == SQLITE_ROW ? (const char *)sqlite3_column_text(row, 0) : NULL;
    const bool is_sealed = document && sqlite3_column_type(row, 1) != SQLITE_NULL;
    const bool sound = !is_sealed || (uint64_t)sqlite3_column_int64(row, 1) == checksum_of(document, strlen(document));
    if (document && sound) *text = strdup(document);
    store_status status = row ? sql_finish(row, code) : STORE_FAILED;
    store_return_reader(store, reader);
    if (status == STORE_OK && !sound) {
        *text = job_result_read(store->data, id, NULL);
        log_line("job %s: its results in the database are damaged; %s", id,
                 *text ? "those of its folder are sent" : "ask reposed check");
        return *text ? STORE_OK : STORE_FAILED;
    }
    if (status == STORE_OK && !*text) status = code == SQLITE_ROW ? STORE_FAILED : STORE_NOT_FOUND;
    return status;
}

store_status store_read_wanted(job_store *store, const char *id, char **text)
{
    return store_read_text(store, "SELECT wanted FROM job WHERE id=?", id, text);
}

store_status store_read_failure(job_store *store, const char *id, char **text)
{
    return store_read_text(store, "SELECT failure FROM job WHERE id=?", id, text);
}

store_status store_count_jobs(job_store *store, int64_t counts[JOB_STATUSES])
{
    memset(counts, 0, JOB_STATUSES * sizeof counts[0]);
    sqlite3 *reader = store_borrow_reader(store);
    sqlite3_stmt *statement = sql_prepare(reader, "SELECT status, jobs FROM job_count", "");
    store_status result = STORE_FAILED;
    if (statement) {
        int code;
        while ((code = sqlite3_step(statement)) == SQLITE_ROW) {
            const char *name = (const char *)sqlite3_column_text(statement, 0);
            job_status status;
            if (name && job_status_parse(name, strlen(name), &status)) counts[status] = sqlite3_column_int64(statement, 1);
        }
        result = sql_finish(statement, code);
    }
    store_return_reader(store, reader);
    return result;
}

store_status store_open_log(job_store *store, const char *id, int *file)
{
    *file = job_file_open(store->data, id, NULL, JOB_LOG_FILE);
    return *file >= 0 ? STORE_OK : STORE_NOT_FOUND;
}

store_status store_open_snapshot(job_store *store, const char *id, int64_t number, int *file)
{
    sqlite3 *reader = store_borrow_reader(store);
    sqlite3_stmt *statement = sql_prepare(
        reader, "SELECT file FROM snapshot WHERE job=(SELECT number FROM job WHERE id=?) AND number=?", "ti", id, number);
    store_status status = STORE_FAILED;
    if (statement) {
        const int code = sqlite3_step(statement);
        const char *name = code == SQLITE_ROW ? (const char *)sqlite3_column_text(statement, 0) : NULL;
        *file = name && !strchr(name, '/') ? job_file_open(store->data, id, JOB_SNAPSHOT_FOLDER, name) : -1;
        status = sql_finish(statement, code);
        if (status == STORE_OK && *file < 0) status = STORE_NOT_FOUND;
    }
    store_return_reader(store, reader);
    return status;
}
