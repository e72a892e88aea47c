/* What running a job writes. Every write a worker causes is fenced by `number AND attempt AND status='running'`: a
 * job that was dismissed or put back meanwhile is not touched. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "database.h"
#include "job_folder.h"
#include "job_store.h"
#include "log.h"
#include "machine_error.h"
#include "result_warnings.h"

#define FENCE " WHERE number=? AND attempt=? AND status='running'"

enum { LONGEST_DELAY = 3600 /* s; no job is put off for longer */, LONGEST_WORKER_NAME = 200 };
/* s: no longer, so that a job goes on soon after the machine is sound again */
#define LONGEST_DELAY_OF_SETBACKS 60.0

/* After the number, the id, the attempt and the threads. */
#define CLAIMED                                                                                                                    \
    " estimated_seconds, estimated_memory_bytes, spec, study, attempts_before, bed, starts, more_time, more_memory,"               \
    " coalesce(resources,'')"

void job_claim_clear(job_claim *claim)
{
    free(claim->spec);
    free(claim->resources);
    claim->spec = claim->resources = NULL;
}

/* Sets *claim where it returns STORE_OK. name: of its worker, where the row has that; NULL: not wanted. */
static store_status read_claim(sqlite3_stmt *statement, job_claim *claim, char *name)
{
    const int code = sqlite3_step(statement);
    if (code != SQLITE_ROW) {
        const store_status status = sql_finish(statement, code);
        return status == STORE_OK ? STORE_NOT_FOUND : status;
    }
    *claim = (job_claim){ .number = sqlite3_column_int64(statement, 0),
                          .attempt = sqlite3_column_int(statement, 2),
                          .threads = sqlite3_column_int(statement, 3),
                          .estimated_seconds = sqlite3_column_double(statement, 4),
                          .estimated_memory_bytes = sqlite3_column_double(statement, 5),
                          .saved_in = sqlite3_column_int(statement, 8),
                          .bed = sqlite3_column_int64(statement, 9),
                          .starts = sqlite3_column_int(statement, 10),
                          .more_time = sqlite3_column_int(statement, 11),
                          .more_memory = sqlite3_column_int(statement, 12) };
    snprintf(claim->id, sizeof claim->id, "%s", (const char *)sqlite3_column_text(statement, 1));
    const char *resources = (const char *)sqlite3_column_text(statement, 13); /* NULL: no memory */
    claim->resources = resources ? strdup(resources) : NULL;
    if (name) snprintf(name, LONGEST_WORKER_NAME, "%s", (const char *)sqlite3_column_text(statement, 14));
    const char *spec = (const char *)sqlite3_column_text(statement, 6);
    claim->spec = spec ? study_parts_expand(sqlite3_db_handle(statement), sqlite3_column_int64(statement, 7), spec) : NULL;
    /* The update counts only when the statement has ended well. */
    store_status status = sql_finish(statement, sqlite3_step(statement));
    if (status == STORE_OK && (!claim->spec || !claim->resources)) status = STORE_FAILED;
    if (status != STORE_OK) job_claim_clear(claim);
    return status;
}

/* The job that is to be started next, of those that are due: not one that is put off, but if its time is further ahead than
 * any delay the clock was set back since; nor one whose bed another is settling: that will be there before it could do so
 * itself. */
#define NEXT_JOB(jobs, and, order)                                                                                                 \
    "(SELECT number FROM " jobs " WHERE status='accepted'"                                                                         \
        and " AND not_before NOT BETWEEN ?2 AND ?5"                                                                                \
            " AND (bed IS NULL OR bed NOT IN (SELECT value FROM json_each(?6))) ORDER BY " order " LIMIT 1)"
#define CLAIM(next)                                                                                                                \
    "UPDATE job SET status='running', message='starting', started=coalesce(started,?1), updated=?1, eta_seconds=NULL,"             \
    " starts=starts+1, worker=NULL"                                                                                                \
    " WHERE number=" next " AND min(threads,?3)<=?4"                                                                               \
    " RETURNING number, id, attempt, min(threads,?3)," CLAIMED

static const char *const claims[] = {
    [QUEUE_BY_TURN] = CLAIM(NEXT_JOB("job INDEXED BY job_waiting_turn", "", "priority DESC, turn, number")),
    [QUEUE_BY_SETBACKS] = CLAIM(NEXT_JOB("job INDEXED BY job_waiting", "", "setbacks, number")),
    [QUEUE_SHORT] =
        CLAIM(NEXT_JOB("job INDEXED BY job_waiting_short", " AND estimated_seconds<2.0", "priority DESC, turn, number")),
};

store_status store_claim_job(job_store *store, queue_order order, int free_threads, int all_threads, const char *beds,
                             job_claim *claim)
{
    *claim = (job_claim){ 0 };
    char now[JOB_TIME_SIZE];
    time_text(now);
    const double unix = unix_seconds();
    store_status status = store_begin(store);
    if (status != STORE_OK) return status;
    sqlite3_stmt *statement = sql_prepare(store->writer, claims[order], "tdiidt", now, unix, (int64_t)all_threads,
                                          (int64_t)free_threads, unix + LONGEST_DELAY, beds);
    status = statement ? read_claim(statement, claim, NULL) : STORE_FAILED;
    if (status == STORE_OK && order != QUEUE_SHORT)
        status = sql_run(store->writer, NULL,
                         "INSERT INTO queue_turn SELECT priority, turn FROM job WHERE number=?"
                         " ON CONFLICT DO UPDATE SET turn=max(turn,excluded.turn)",
                         "i", claim->number);
    status = store_end(store, status);
    if (status != STORE_OK) job_claim_clear(claim);
    return status;
}

bool store_claim_holds(job_store *store, const job_claim *claim)
{
    sqlite3 *reader = store_borrow_reader(store);
    sqlite3_stmt *statement = sql_prepare(reader, "SELECT 1 FROM job" FENCE, "ii", claim->number, (int64_t)claim->attempt);
    /* Doubt keeps the worker: each of its writes is fenced anyway. */
    const int code = statement ? sqlite3_step(statement) : SQLITE_ROW;
    if (statement) sql_finish(statement, code);
    store_return_reader(store, reader);
    return code != SQLITE_DONE;
}

/* --- events --- */

/* 0: it is none, or beyond what any run can count. */
static int64_t whole(const json_t *event, const char *name)
{
    const double number = json_number_value(json_object_get(event, name));
    return fabs(number) <= (double)LARGEST_WHOLE_NUMBER ? (int64_t)number : 0;
}

static store_status insert_samples(sqlite3 *writer, int64_t job, const json_t *samples)
{
    store_status status = STORE_OK;
    for (size_t i = 0; status == STORE_OK && i < json_array_size(samples); i++) {
        const json_t *event = json_array_get(samples, i);
        const json_t *values = json_object_get(event, "values");
        if (!json_is_object(values) || !json_is_integer(json_object_get(event, "number"))) continue;
        char *text = json_dumps(values, JSON_COMPACT | JSON_REAL_PRECISION(15)); /* as the worker wrote them */
        /* A later attempt repeats samples with the same numbers: the later line wins. */
        status = text ? sql_run(writer, NULL,
                                "INSERT INTO sample(job,number,step,time,measures) VALUES(?,?,?,?,?)"
                                " ON CONFLICT DO UPDATE SET step=excluded.step, time=excluded.time, measures=excluded.measures",
                                "iiidt", job, whole(event, "number"), whole(event, "step"),
                                json_number_value(json_object_get(event, "time")), text)
                      : STORE_FAILED;
        free(text);
    }
    return status;
}

static bool is_plain_name(const char *name) { return name && name[0] && name[0] != '.' && strlen(name) < 64 && !strchr(name, '/'); }

static store_status insert_snapshots(sqlite3 *writer, int64_t job, const json_t *snapshots)
{
    store_status status = STORE_OK;
    for (size_t i = 0; status == STORE_OK && i < json_array_size(snapshots); i++) {
        const json_t *event = json_array_get(snapshots, i);
        const char *file = json_string_value(json_object_get(event, "file"));
        if (!is_plain_name(file) || !json_is_integer(json_object_get(event, "number"))) continue;
        status = sql_run(writer, NULL,
                         "INSERT OR REPLACE INTO snapshot(job,number,step,time,file,bytes,particles) VALUES(?,?,?,?,?,?,?)",
                         "iiidtii", job, whole(event, "number"), whole(event, "step"),
                         json_number_value(json_object_get(event, "time")), file, whole(event, "bytes"), whole(event, "particles"));
    }
    return status;
}

store_status store_record_events(job_store *store, const job_claim *claim, const event_batch *events)
{
    char now[JOB_TIME_SIZE];
    time_text(now);
    int64_t changed;
    store_status status =
        sql_run(store->writer, &changed,
                "UPDATE job SET updated=?, progress=coalesce(min(max(?,0),100),progress), eta_seconds=coalesce(?,eta_seconds),"
                " message=coalesce(nullif(?,''),message)" FENCE,
                "tddtii", now, events->progress, events->eta_seconds, events->phase, claim->number, (int64_t)claim->attempt);
    if (status == STORE_OK && changed == 0) return STORE_CONFLICT;
    if (status == STORE_OK) status = insert_samples(store->writer, claim->number, events->samples);
    if (status == STORE_OK) status = insert_snapshots(store->writer, claim->number, events->snapshots);
    if (status == STORE_OK && *events->bed) status = store_record_bed(store, claim, events->bed);
    return status;
}

store_status store_record_silence(job_store *store, const job_claim *claim, double seconds)
{
    char now[JOB_TIME_SIZE], message[120];
    time_text(now);
    snprintf(message, sizeof message, "no word from its worker for %.0f s, seen at %s: stopped, or held up", seconds, now);
    int64_t changed;
    const store_status status = sql_run(store->writer, &changed, "UPDATE job SET message=?, eta_seconds=NULL, updated=?" FENCE,
                                        "ttii", message, now, claim->number, (int64_t)claim->attempt);
    return status == STORE_OK && changed == 0 ? STORE_CONFLICT : status;
}

store_status store_record_worker(job_store *store, const job_claim *claim, const char *name, const char *waits_for)
{
    int64_t changed;
    const store_status status =
        sql_run(store->writer, &changed, "UPDATE job SET worker=?, message=coalesce(nullif(?,''),message)" FENCE, "ttii", name,
                waits_for, claim->number, (int64_t)claim->attempt);
    return status == STORE_OK && changed == 0 ? STORE_CONFLICT : status;
}

void job_claim_note(job_claim *claim, const event_batch *events)
{
    for (size_t i = 0; i < json_array_size(events->checkpoints); i++) {
        const json_t *event = json_array_get(events->checkpoints, i);
        const int64_t step = whole(event, "step");
        if (step <= claim->saved_step) continue;
        claim->saved_step = step;
        const int attempt = (int)whole(event, "attempt");
        if (attempt > claim->saved_in) claim->saved_in = attempt;
    }
}

bool job_claim_is_last(const job_claim *claim) { return claim->attempt - claim->saved_in >= JOB_ATTEMPTS; }

/* --- ends --- */

static store_status end_job(job_store *store, const job_claim *claim, job_status end, const char *message, const char *failure)
{
    char now[JOB_TIME_SIZE];
    time_text(now);
    int64_t changed;
    const store_status status =
        sql_run(store->writer, &changed,
                "UPDATE job SET status=?, message=?, failure=?, finished=?, updated=?, eta_seconds=NULL,"
                " progress=CASE WHEN ?1='successful' THEN 100 ELSE progress END" FENCE,
                "tttttii", job_status_name(end), message, failure, now, now, claim->number, (int64_t)claim->attempt);
    return status == STORE_OK && changed == 0 ? STORE_CONFLICT : status;
}

store_status store_record_success(job_store *store, const job_claim *claim, const char *document)
{
    char message[1024];
    json_t *results = json_loads(document, 0, NULL);
    result_message(results, message, sizeof message);
    store_status status = store_begin(store);
    if (status == STORE_OK) {
        status = end_job(store, claim, JOB_SUCCESSFUL, message, NULL);
        if (status == STORE_OK)
            status = field_tables_insert_results(&store->fields, store->writer, claim->number, document, results);
        status = store_end(store, status);
    }
    json_decref(results);
    return status;
}

store_status store_record_failure(job_store *store, const job_claim *claim, const char *message, const json_t *failure)
{
    char *text = failure ? json_dumps(failure, JSON_COMPACT) : NULL;
    store_status status = store_begin(store);
    if (status == STORE_OK) status = store_end(store, end_job(store, claim, JOB_FAILED, message, text));
    free(text);
    return status;
}

static store_status put_back(job_store *store, const job_claim *claim, bool uses_attempt, const char *message)
{
    char now[JOB_TIME_SIZE], text[1024];
    time_text(now);
    if (uses_attempt && job_claim_is_last(claim)) {
        snprintf(text, sizeof text, "%s; %d attempts in a row have come no further", message, JOB_ATTEMPTS);
        return end_job(store, claim, JOB_FAILED, text, NULL);
    }
    int64_t changed;
    const store_status status = sql_run(store->writer, &changed,
                                        "UPDATE job SET status='accepted', attempt=attempt+?, setbacks=0, not_before=0, message=?, "
                                        "updated=?, eta_seconds=NULL, more_time=?, more_memory=?" FENCE,
                                        "ittiiii", (int64_t)uses_attempt, message, now, (int64_t)claim->more_time,
                                        (int64_t)claim->more_memory, claim->number, (int64_t)claim->attempt);
    return status == STORE_OK && changed == 0 ? STORE_CONFLICT : status;
}

store_status store_put_back(job_store *store, const job_claim *claim, bool uses_attempt, const char *message)
{
    const store_status status = store_begin(store);
    return status == STORE_OK ? store_end(store, put_back(store, claim, uses_attempt, message)) : status;
}

static store_status put_off(job_store *store, const job_claim *claim, const char *message)
{
    char now[JOB_TIME_SIZE];
    time_text(now);
    int64_t changed;
    /* 2, 4, 8, ... s */
    const store_status status =
        sql_run(store->writer, &changed,
                "UPDATE job SET status='accepted', setbacks=setbacks+1,"
                " not_before=?+min(?,2<<min(setbacks,16)), message=?, updated=?, eta_seconds=NULL" FENCE,
                "ddttii", unix_seconds(), LONGEST_DELAY_OF_SETBACKS, message, now, claim->number, (int64_t)claim->attempt);
    return status == STORE_OK && changed == 0 ? STORE_CONFLICT : status;
}

store_status store_put_off(job_store *store, const job_claim *claim, const char *message)
{
    const store_status status = store_begin(store);
    return status == STORE_OK ? store_end(store, put_off(store, claim, message)) : status;
}

/* --- after a crash --- */

/* The oldest job still marked running, with a number above `after`, and what its worker is called. */
static store_status next_orphan(job_store *store, int64_t after, job_claim *claim, char name[LONGEST_WORKER_NAME])
{
    sqlite3_stmt *statement = sql_prepare(store->writer,
                                          "SELECT number, id, attempt, threads," CLAIMED ", coalesce(worker,'') FROM job"
                                          " WHERE status='running' AND number>? ORDER BY number LIMIT 1",
                                          "i", after);
    return statement ? read_claim(statement, claim, name) : STORE_FAILED;
}

/* What its worker wrote after the last look of the daemon that died. */
static store_status record_left_events(job_store *store, job_claim *claim)
{
    const int file = job_file_open(store->data, claim->id, NULL, JOB_EVENTS_FILE);
    store_status status = STORE_OK;
    bool more = file >= 0;
    int64_t at = 0;
    while (more && status == STORE_OK) {
        event_batch batch;
        if (!event_tail_read(file, at, &batch)) break;
        status = store_begin(store);
        if (status == STORE_OK) status = store_end(store, batch.any ? store_record_events(store, claim, &batch) : STORE_OK);
        job_claim_note(claim, &batch);
        at = batch.end;
        more = batch.more;
        event_batch_clear(&batch);
    }
    if (file >= 0) close(file);
    return status;
}

/* The worker may have finished in the moment the daemon died: result.json is the last thing it writes. One that was not made
 * from this job's spec, or that does not tell, does not count: the job runs again. */
static store_status recover_result(job_store *store, const job_claim *claim, const char *why)
{
    errno = 0;
    char *text = job_file_read(store->data, claim->id, JOB_RESULT_FILE, LARGEST_RESULT);
    if (!text && machine_error_is(errno)) return STORE_FAILED;
    free(text);
    char *document = job_result_read(store->data, claim->id, claim->spec);
    const store_status status = document ? store_record_success(store, claim, document) : STORE_REFUSED;
    free(document);
    if (status == STORE_OK && why) log_line("job %s: %s; its result is there", claim->id, why);
    return status;
}

static store_status recover_one(job_store *store, job_claim *claim, const char *name, const char *why, worker_adopter *adopt,
                                void *context)
{
    store_status status = record_left_events(store, claim);
    if (status == STORE_OK) status = recover_result(store, claim, why);
    if (status != STORE_REFUSED || adopt(context, claim, name)) return status == STORE_REFUSED ? STORE_OK : status;
    job_result_remove(store->data, claim->id); /* nobody is to take it for one again */
    status = store_put_back(store, claim, false, "the daemon stopped while it ran");
    if (status == STORE_OK && why) log_line("job %s: %s; put back", claim->id, why);
    return status;
}

store_status store_recover(job_store *store, const char *why, worker_adopter *adopt, void *context)
{
    job_claim claim = { 0 };
    char name[LONGEST_WORKER_NAME];
    int64_t after = 0;
    store_status status, worst = STORE_OK;
    while ((status = next_orphan(store, after, &claim, name)) == STORE_OK) {
        after = claim.number;
        status = recover_one(store, &claim, name, why, adopt, context);
        job_claim_clear(&claim);
        if (status == STORE_CONFLICT) status = STORE_OK; /* dismissed meanwhile */
        if (status != STORE_OK) worst = status;
    }
    store_drop_beds(store); /* of jobs that were dismissed or deleted */
    return status == STORE_NOT_FOUND ? worst : status;
}
