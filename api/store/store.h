/* What the handlers need of a store of jobs. The daemon implements it over SQLite and the job folders; a test may
 * implement it over an array. Times are ISO 8601 in UTC with milliseconds; "" means not yet. */
#ifndef STORE_H
#define STORE_H

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "client_watch.h"
#include "job_id.h"
#include "study_spec.h"

typedef struct job_store job_store;

typedef enum store_status {
    STORE_OK = 0,
    STORE_NOT_FOUND,
    STORE_CONFLICT,   /* the job is not in a state that allows this */
    STORE_FULL,       /* no room on the disk */
    STORE_QUEUE_FULL, /* as many jobs wait as may */
    STORE_REFUSED,    /* a document that does not fit the tables */
    STORE_FAILED      /* anything else the database or the file system refused; the log has the reason */
} store_status;

typedef enum job_status { JOB_ACCEPTED, JOB_RUNNING, JOB_SUCCESSFUL, JOB_FAILED, JOB_DISMISSED, JOB_STATUSES } job_status;

enum { JOB_TIME_SIZE = 28, JOB_CURSOR_SIZE = 100 };

const char *job_status_name(job_status status);
bool job_status_parse(const char *name, size_t length, job_status *status);

/* What is not known yet is left out. */
typedef struct summary_value {
    const char *name; /* of the tables of fields, or a constant */
    enum { SUMMARY_WHOLE, SUMMARY_REAL, SUMMARY_TEXT, SUMMARY_TRUTH } kind;
    int64_t whole; /* of a truth 0 or 1 */
    double real;
    char *text; /* owned; NULL where it is none */
} summary_value;

typedef struct job_record {
    int64_t number; /* order of submission */
    char id[JOB_ID_SIZE], process[16];
    char study[JOB_ID_SIZE]; /* id of the study it belongs to; "": none */
    job_status status;
    int attempt, priority;
    double progress, eta_seconds; /* percent; s, NaN: unknown */
    char created[JOB_TIME_SIZE], started[JOB_TIME_SIZE], finished[JOB_TIME_SIZE], updated[JOB_TIME_SIZE];
    char message[1024];
    bool is_pinned;         /* no rule removes it */
    json_t *label;          /* owned */
    summary_value *summary; /* (summary_count) owned: main inputs, and main results once there are any */
    size_t summary_count;
    char cursor[JOB_CURSOR_SIZE]; /* of a list: what comes after this job begins with this filter->after */
} job_record;

void job_record_clear(job_record *job);

/* What there is of columns; it lives as long as the store. */
struct field_columns;
const struct field_columns *store_columns(const job_store *store);

/* False stops the walk. The record, row or text is only lent. */
typedef bool job_visitor(void *context, const job_record *job);

enum { MOST_RANGES = 8 };

/* Of a column as list_columns.h names them. */
typedef struct value_range {
    const char *name;
    double low, high;  /* both belong to it; infinite: open */
    const char *words; /* of a column of words: these, with commas between them; NULL: numbers */
} value_range;

typedef struct job_filter {
    unsigned statuses;                                               /* bit 1 << job_status; 0: all */
    bool by_process;                                                 /* only jobs of some processes: */
    unsigned processes;                                              /* bit 1 << index in process_types */
    bool by_type, type_is_process;                                   /* by_type: only jobs of that type, or none */
    const char *text;                                                /* to be found in the id or the label; NULL: all */
    const char *study;                                               /* id; NULL: all */
    const char *label_name, *label_value;                            /* a member of the label, and what it is as text; NULL: all */
    char created_from[JOB_TIME_SIZE], created_before[JOB_TIME_SIZE]; /* "": since ever, for ever */
    double least_seconds, most_seconds; /* that a job has run, up to now or its end; NaN: whether it has or not */
    value_range range[MOST_RANGES];
    size_t range_count;
    const char *sort; /* a column as list_columns.h names them; NULL: newest first. Jobs that lack it come last */
    bool sort_falls, sort_is_words;
    /* Where the page begins: after the job of this number, 0: at the beginning. Of a sorted list with what it is sorted by, as
     * text; NULL: that job lacks it. */
    int64_t after;
    const char *after_value;
    int64_t limit;
} job_filter;

/* A table of particles that somebody sent. */
typedef struct bed_record {
    int64_t number; /* order in which they came */
    char id[JOB_ID_SIZE], created[JOB_TIME_SIZE];
    int64_t particles, bytes;
} bed_record;
typedef bool bed_visitor(void *context, const bed_record *bed);
enum { STORE_MOST_BEDS = 1000 };
/* Keeps it. STORE_QUEUE_FULL: there are STORE_MOST_BEDS already. */
store_status store_add_bed(job_store *store, const char *text, size_t length, int64_t particles, bed_record *bed);
store_status store_find_bed(job_store *store, const char *id, bed_record *bed);
store_status store_list_beds(job_store *store, bed_visitor *visit, void *context); /* newest first */
store_status store_read_bed(job_store *store, const char *id, char **text);        /* for free() */
/* Jobs that started from it keep what they have of it. */
store_status store_delete_bed(job_store *store, const char *id);

/* The beds that jobs left, for specs that start from one. The source is good as long as the store. */
start_source store_beds(job_store *store);
/* Returns after the commit. */
store_status store_add_job(job_store *store, const job_spec *spec, char id[JOB_ID_SIZE]);
/* STORE_CONFLICT: it has already ended. */
store_status store_dismiss_job(job_store *store, const char *id);
/* Deletes an ended job: its row, all that the tables have of it, and its folder. STORE_CONFLICT: it has not ended. */
store_status store_delete_job(job_store *store, const char *id);
/* Pinned, no rule of the service (--keep-days, --keep-bytes) removes it; what is asked for still is. */
store_status store_pin_job(job_store *store, const char *id, bool pinned);
/* A failed or dismissed job into the queue once more, to go on from its checkpoint. STORE_CONFLICT: it is neither. */
store_status store_retry_job(job_store *store, const char *id);
/* Of the disk that the folders of jobs are on; NaN: not known. */
double store_free_bytes(const job_store *store);
/* Of a disk that is full, or so nearly that nothing more is taken. */
typedef struct room_to_free {
    double free_bytes, free_inodes, kept_bytes, kept_inodes; /* NaN: not known; kept: for jobs that run */
    int64_t jobs;                                            /* that have ended and are not pinned, and have snapshots: */
    double snapshot_bytes;                                   /* of those */
    bool is_more;                                            /* there are more than were counted */
    int64_t ended;                                           /* jobs */
} room_to_free;
store_status store_look_for_room(job_store *store, room_to_free *room);

/* Those jobs that a filter lets through, whatever it says of the page. deletes: those that have ended and are not pinned are
 * deleted; else those that wait or run are dismissed. only_tell: nothing is changed. tell: called with the ids of those that are
 * found, until it returns false. In pieces, and no longer than a second: then some are left. */
typedef struct job_batch {
    int64_t found, changed, left;
    int64_t unfit, pinned; /* let through too, but not in a state that allows it; kept because they are pinned */
} job_batch;
store_status store_change_jobs(job_store *store, const job_filter *filter, bool deletes, bool only_tell, const client_watch *client,
                               bool (*tell)(void *context, const char *id), void *context, job_batch *result);

store_status store_find_job(job_store *store, const char *id, job_record *job);
/* Of a job that waits: its place among those that do, from 1, and when it is expected to start. STORE_NOT_FOUND: it does not. */
typedef struct queue_place {
    int64_t position;
    char expected_start[JOB_TIME_SIZE];
} queue_place;
store_status store_find_place(job_store *store, const char *id, queue_place *place);
/* Those that the filter lets through, at most limit of them; and how many it lets through of each status, whatever it says of
 * statuses and of the page. */
store_status store_list_jobs(job_store *store, const job_filter *filter, int64_t counts[JOB_STATUSES], job_visitor *visit,
                             void *context);
/* Whether that takes some milliseconds. */
bool store_lists_quickly(job_store *store, const job_filter *filter);
store_status store_count_jobs(job_store *store, int64_t counts[JOB_STATUSES]);

typedef struct study_record {
    int64_t number; /* order of submission */
    char id[JOB_ID_SIZE], process[16], name[STUDY_NAME_SIZE];
    int64_t cases, repeats, jobs, counts[JOB_STATUSES]; /* counts: of its jobs */
    int priority;
    double progress, estimated_seconds; /* percent; s of one worker, when it was submitted */
    char created[JOB_TIME_SIZE], started[JOB_TIME_SIZE], updated[JOB_TIME_SIZE]; /* updated: the last change of a job's state */
} study_record;
typedef bool study_visitor(void *context, const study_record *study);

/* Where the jobs of a study wait, ready to be added, while the rest of it is still being read: nobody else sees or waits for
 * them. The study and the machine live as long. NULL: no memory or no disk. */
typedef struct study_stage study_stage;
study_stage *store_stage_study(job_store *store, const study_spec *study, const calibration *machine);
study_taker store_stage_taker(study_stage *stage);         /* for study_check */
store_status store_stage_status(const study_stage *stage); /* why it did not take a job */
void store_drop_stage(study_stage *stage);
/* All its jobs in one commit, or none. */
store_status store_add_study(job_store *store, study_stage *stage, const study_spec *study, const study_estimate *estimate,
                             char id[JOB_ID_SIZE]);
/* Dismisses its jobs that have not ended. STORE_CONFLICT: all have. */
store_status store_dismiss_study(job_store *store, const char *id);
/* Deletes it with all its jobs, as store_delete_job. STORE_CONFLICT: not all have ended. */
store_status store_delete_study(job_store *store, const char *id);
/* Its failed jobs into the queue once more, all or none, as store_retry_job. STORE_CONFLICT: none has failed. */
store_status store_retry_study(job_store *store, const char *id);
store_status store_find_study(job_store *store, const char *id, study_record *study);
store_status store_list_studies(job_store *store, int64_t before, int64_t limit, study_visitor *visit,
                                void *context);                               /* newest first */
store_status store_read_study(job_store *store, const char *id, char **text); /* its document, for free() */

typedef struct study_case_row {
    int64_t index;
    const char *name, *inputs, *label; /* inputs, label: JSON objects */
} study_case_row;
typedef bool study_case_visitor(void *context, const study_case_row *row);
store_status store_list_study_cases(job_store *store, const char *id, study_case_visitor *visit, void *context); /* in order */

typedef struct study_run_row {
    int64_t index; /* of its case */
    job_status status;
    const json_t *measures; /* {"angle_deg": 23.1, ...}: numbers and texts; what is not known is not in it */
} study_run_row;
typedef bool study_run_visitor(void *context, const study_run_row *row);
store_status store_list_study_runs(job_store *store, const char *id, study_run_visitor *visit,
                                   void *context); /* in order of cases */

/* How many jobs may wait. */
int64_t store_queue_limit(const job_store *store);

/* Texts are for free(). STORE_NOT_FOUND: no such job, or (results, failure) it has none. */
store_status store_read_spec(job_store *store, const char *id, char **text);
store_status store_read_results(job_store *store, const char *id, char **text);
/* How they are wanted (execute_request.h), as JSON. STORE_NOT_FOUND: as ever. */
store_status store_read_wanted(job_store *store, const char *id, char **text);
store_status store_read_failure(job_store *store, const char *id, char **text); /* the worker's failure event */

typedef struct sample_row {
    int64_t number, step;
    double time;          /* s since rotation began */
    const char *measures; /* JSON object of numbers and nulls */
} sample_row;
typedef bool sample_visitor(void *context, const sample_row *row);
store_status store_list_samples(job_store *store, const char *id, int64_t after, int64_t limit, sample_visitor *visit,
                                void *context);

typedef struct snapshot_row {
    int64_t number, step, bytes, particles;
    double time;
    int64_t frame_bytes;    /* of its frame (frame_format.h); 0: it has none */
    uint64_t frame_version; /* another one for other bytes */
} snapshot_row;
typedef bool snapshot_visitor(void *context, const snapshot_row *row);
store_status store_list_snapshots(job_store *store, const char *id, int64_t after, int64_t limit, snapshot_visitor *visit,
                                  void *context);

/* A request that may be sent again, and what is known of it. */
enum { REQUEST_KEY_SIZE = 201 };
typedef struct request_key {
    char key[REQUEST_KEY_SIZE];
    uint64_t fingerprint; /* of what is asked for */
    bool awaited;         /* its answer may be one that comes later, and is not kept */
    bool is_kept;         /* committed, with what the request did */
    bool is_taken;        /* by another request: nothing was done */
} request_key;
/* From now on the next change that this thread commits is that of the request: its key is kept by the same commit. NULL: of none. */
void store_use_key(request_key *key);

typedef struct kept_answer {
    uint64_t fingerprint;
    char made[JOB_ID_SIZE]; /* the job or study that it is about; "": none */
    int status;
    char location[600];
    char *body; /* for free(); NULL: not kept, or not yet */
} kept_answer;
/* STORE_NOT_FOUND: no request had this key in the last seven days. */
store_status store_find_answer(job_store *store, const char *key, kept_answer *answer);
void store_keep_answer(job_store *store, const char *key, int status, const char *location, const char *body);

/* Descriptors for reading, the caller closes. */
store_status store_open_snapshot(job_store *store, const char *id, int64_t number, int *file);
/* Names of all plain files of a job's folder but those that are still being written, and of the folder in it of its snapshots,
 * in order. folder: NULL at the top. take: false ends the list. */
typedef bool job_file_taker(void *context, const char *folder, const char *name);
store_status store_list_files(job_store *store, const char *id, job_file_taker *take, void *context);
/* One of them, never through a symbolic link. */
store_status store_open_file(job_store *store, const char *id, const char *folder, const char *name, int *file);
store_status store_open_log(job_store *store, const char *id, int *file);

/* How fast this machine is: as calibrated and as the latest runs corrected it, or the built-in figures. */
void store_read_calibration(job_store *store, calibration *machine);

/* Read-only SQL of a user. */
typedef enum query_status { QUERY_OK, QUERY_REFUSED, QUERY_TOO_SLOW, QUERY_UNAVAILABLE } query_status;
typedef enum query_value_kind { QUERY_NULL, QUERY_INTEGER, QUERY_REAL, QUERY_TEXT } query_value_kind;
typedef struct query_value {
    query_value_kind kind;
    int64_t integer;
    double real;
    const char *text;
    size_t length;
} query_value;
/* row 0 holds the column names as texts, the rows follow; another row 0: all of it comes once more, from the beginning.
 * False stops, which is no error. */
typedef bool query_visitor(void *context, int64_t row, const query_value *values, int count);
/* The columns of all tables and views that users' SQL may read, those of one table one after the other. False stops, with no error. */
typedef bool column_visitor(void *context, const char *table, const char *column, const char *type);
store_status store_list_columns(job_store *store, column_visitor *visit, void *context);
query_status store_query(job_store *store, const char *sql, const client_watch *client, query_visitor *visit, void *context,
                         char *problem, size_t problem_size);

#endif
