/* The store over SQLite and the job folders. Handlers use it through api/store/store.h; the dispatcher through this. */
#ifndef JOB_STORE_H
#define JOB_STORE_H

#include <pthread.h>
#include <sqlite3.h>
#include <stdatomic.h>
#include <time.h>

#include "data_folder.h"
#include "event_tail.h"
#include "field_tables.h"
#include "job_changes.h"
#include "job_index.h"
#include "query_functions.h"
#include "store.h"

enum { STORE_READERS = 4, JOB_ATTEMPTS = 3 };

typedef struct write_group write_group;

/* Everything below is private to job_store*.c and query.c. */
struct job_store {
    data_folder *data;
    field_tables fields;
    job_index *index;
    job_changes *changes;
    _Atomic int64_t queue_limit; /* jobs that may wait */
    int places;                  /* jobs that may run at once */
    pthread_mutex_t write_lock;  /* held by who writes, from begin to end */
    sqlite3 *writer;
    atomic_int writers_waiting;
    write_group *group; /* whose transaction is open; NULL: none is. With the lock held, as is_joined */
    bool is_joined;     /* who writes has a savepoint in the transaction of others */
    pthread_mutex_t group_lock;
    pthread_cond_t group_is_over;
    pthread_mutex_t readers_lock;
    pthread_cond_t reader_is_free;
    sqlite3 *reader[STORE_READERS]; /* the first readers_free are free */
    int readers_free;
    sqlite3 *query; /* for users' SQL alone: it has an authorizer and limits; the lane of what reads is its only thread */
    query_watch query_watch;
    char *query_tables; /* names of all tables and views of the schema */
};

job_store *store_open(data_folder *data, int64_t queue_limit);
void store_close(job_store *store);

/* STORE_NOT_FOUND: it is not there any more. */
store_status store_find_numbered_job(job_store *store, int64_t number, job_record *job);

sqlite3 *store_borrow_reader(job_store *store);
void store_return_reader(job_store *store, sqlite3 *reader);
/* Takes one row; false ends the walk. */
typedef bool store_row_taker(sqlite3_stmt *row, void *context);
/* Steps through a statement, which may be NULL, and gives the reader back. */
store_status store_walk(job_store *store, sqlite3 *reader, sqlite3_stmt *statement, store_row_taker *take, void *context);
/* write_group.c. Between begin and end this thread owns the writer. end commits where status is STORE_OK, together with what others
 * do at the same time, else rolls back; returns what became of it. */
store_status store_begin(job_store *store);
store_status store_end(job_store *store, store_status status);

/* Reads what jobs are listed by into memory, before somebody has to wait for it. */
void store_warm(job_store *store);

/* The numbers of all jobs that a filter lets through, oldest first; *numbers is the caller's to free. counts: as those of a list. */
store_status store_find_all(job_store *store, const job_filter *filter, int64_t counts[JOB_STATUSES], int64_t **numbers,
                            size_t *count);
/* job_store_delete.c: the folders of jobs that were deleted at this time, out of the way. */
void store_put_folders_aside(job_store *store, double since);

/* request_keys.c, between begin and end: keeps the key of this thread's request, if it has one, and the id of what it is about. */
store_status store_keep_key(job_store *store);
void store_name_made(const char *id);

/* Commits a change that changes nothing, to see whether that can be done; not while somebody else writes. */
store_status store_try_write(job_store *store);

/* An id of this second; bits tell it from others of the same second. */
void store_write_id(char id[JOB_ID_SIZE], time_t second, uint32_t bits);
bool store_random_bits(uint32_t *bits);
/* Where a job stands: which of which study (0: of none), and its turn in the queue, which of a study counts from 1. */
typedef struct job_place {
    int64_t study, index, repeat, turn;
    int64_t bed; /* which it settles, alike in all jobs that settle the same; 0: no other does */
} job_place;
/* The bed of that job, into the folder of this one; snapshot NaN: its checkpoint. Safe on the disk after job_folder_sync
 * or data_folder_sync. False: errno says why. */
bool store_bring_start(job_store *store, const char *from, double snapshot, const char *id);
/* The job that a spec starts from; NULL: none. */
const char *job_started_from(const job_spec *spec);
/* Between begin and end: one job's rows. text: its canonical specification. number: 0 takes the next. */
store_status store_insert_job(const field_tables *fields, sqlite3 *writer, int64_t number, const job_spec *spec, const char *id,
                              const char *text, const job_place *place, const calibration *machine);
/* Between begin and end: a job of no study, as the last in the queue; *number: its own. */
store_status store_insert_next(job_store *store, const job_spec *spec, const char *id, const char *text, const calibration *machine,
                               int64_t *number);
/* Jobs into the queue as their next attempt, of which the earlier ones do not count; what a dying worker of one of these still writes
 * is fenced off by the new number. ?: now; the rest says which jobs. */
#define STORE_TRY_AGAIN                                                                                                            \
    "UPDATE job SET status='accepted', message='waiting for a free worker: to be tried again', attempts_before=attempt,"           \
    " attempt=attempt+1, setbacks=0, not_before=0, failure=NULL, finished=NULL, eta_seconds=NULL, updated=? "
/* study_parts.c: a text of the table with the long parts of its study in it; NULL: no memory, or a part is missing. */
char *study_parts_expand(sqlite3 *database, int64_t study, const char *text);
/* machine_speed.c, between begin and end: what its steps have to do, for when it has run. */
store_status store_insert_load(sqlite3 *writer, int64_t job, const job_estimate *estimate, const calibration *machine);
/* Between begin and end: the last of this client's waiting jobs of that priority, or of those that have run. */
store_status store_last_turn(job_store *store, const char *client, int64_t priority, int64_t *turn);
/* Between begin and end: STORE_QUEUE_FULL where `jobs` more would be too many. */
store_status store_check_queue(job_store *store, int64_t jobs);
store_status store_read_text(job_store *store, const char *sql, const char *id, char **text);

/* One attempt of one job: what every write a worker causes is fenced by. */
typedef struct job_claim {
    int64_t number;
    char id[JOB_ID_SIZE];
    int attempt, threads;
    int starts; /* with this one: no two of the job have the same number */
    double estimated_seconds, estimated_memory_bytes;
    int more_time, more_memory; /* how often an attempt had too little, and was given twice as much */
    int64_t bed;                /* the number of the bed that others would settle, too; 0: none would */
    char *spec, *resources; /* owned; NULL once the worker has started. What is asked of a cluster (job_resources.h); "": nothing */
    int64_t saved_step;     /* of the furthest checkpoint that any attempt told of, */
    int saved_in;           /* and the attempt that told, or the last one before it was tried again on request; 0: none yet */
} job_claim;
/* Of what only the start of a worker needs. */
void job_claim_clear(job_claim *claim);

#define SHORT_JOB 2.0 /* s of estimate: what takes less has a lane */
/* Which of the jobs that wait comes first. */
typedef enum queue_order {
    QUEUE_BY_TURN,     /* by priority, then as clients take turns */
    QUEUE_BY_SETBACKS, /* the oldest of those with the fewest */
    QUEUE_SHORT        /* of short jobs alone, by turn; whoever comes later is not put behind it for that */
} queue_order;

/* Takes the first job that waits, if it needs no more threads than are free (a job of more than `all_threads` counts as that
 * many). beds: JSON, the numbers of those that are being settled, for which jobs wait. STORE_NOT_FOUND: none. */
store_status store_claim_job(job_store *store, queue_order order, int free_threads, int all_threads, const char *beds,
                             job_claim *claim);

/* shared_beds.c. The bed that the job's worker told of; between begin and end. */
store_status store_record_bed(job_store *store, const job_claim *claim, const char *sha256);
/* Gives the job the bed that another has settled. False: nobody has; the job settles it for the others, too. */
bool store_bring_bed(job_store *store, const job_claim *claim);
bool store_has_bed(job_store *store, int64_t bed);
/* Beds that no job waits for any more. */
void store_drop_beds(job_store *store);

/* Takes in how far checkpoints have come; the same events again change nothing. */
void job_claim_note(job_claim *claim, const event_batch *events);
/* Whether the job fails if this attempt dies: the last JOB_ATTEMPTS of them have all died without coming further. */
bool job_claim_is_last(const job_claim *claim);

/* The calls below return STORE_CONFLICT when the claim no longer holds (the job was dismissed): then nothing was
 * written. store_record_events is for use between begin and end. */
store_status store_record_events(job_store *store, const job_claim *claim, const event_batch *events);
/* The worker has written nothing for so long; between begin and end, too. */
store_status store_record_silence(job_store *store, const job_claim *claim, double seconds);
store_status store_record_success(job_store *store, const job_claim *claim, const char *document);
store_status store_record_failure(job_store *store, const job_claim *claim, const char *message, const json_t *failure);
/* Back into the queue. uses_attempt: the worker died; the death of the last attempt fails
 * the job. */
store_status store_put_back(job_store *store, const job_claim *claim, bool uses_attempt, const char *message);
/* Back into the queue after a setback that was the machine's: no attempt is used, and the job waits the longer the more
 * setbacks it has had in a row, so that others come before it. */
store_status store_put_off(job_store *store, const job_claim *claim, const char *message);
bool store_claim_holds(job_store *store, const job_claim *claim);

/* What its worker is called, by which the next daemon finds it again, and why that has not begun to work ("": it has). Between
 * begin and end. */
store_status store_record_worker(job_store *store, const job_claim *claim, const char *name, const char *waits_for);
/* Jobs that a dead daemon left running are recorded as done where the result is there, left as they are where `adopt` goes on with
 * the worker of that name, or else put back, with no attempt used. Anything but STORE_OK: to be called again. The claim's spec is
 * only lent. why: what the log says of each; NULL: nothing. */
typedef bool worker_adopter(void *context, const job_claim *claim, const char *name);
store_status store_recover(job_store *store, const char *why, worker_adopter *adopt, void *context);
/* unused_folders.c: those that a POST made which a crash has cut off. Before the first request: one that is being posted has no
 * row either. */
store_status store_remove_unused_folders(job_store *store);
/* s that the oldest of the jobs that wait has waited; 0: none waits. */
double store_queue_age(job_store *store);
store_status store_has_job(job_store *store, const char *id); /* STORE_NOT_FOUND: there is none */

/* query.c: the limits, the authorizer and the functions of users' SQL, on store->query. False: no memory. */
bool query_connection_restrict(job_store *store);

#endif
