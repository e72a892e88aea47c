/* What subscribers are still to be told. A trigger of the database makes a row where a job changes, in the commit that changes it,
 * and the row goes once its address has taken it: so it is told at least once, whatever dies in between. */
#ifndef CALLBACKS_H
#define CALLBACKS_H

#include "job_store.h"

/* Of how a run goes on there is one at most of a job, the latest. */
typedef struct callback {
    int64_t job, news;              /* job: its number; news: another number each time, so that what comes meanwhile stays */
    int tries;                      /* in vain so far */
    char id[JOB_ID_SIZE], kind[16]; /* "inProgress", "success", "failed" */
    char uri[1024], base[400];      /* base: what addresses of the service begin with */
} callback;

/* Between begin and end: of a job that was just inserted. Its subscriber may be NULL. */
store_status store_insert_subscriber(sqlite3 *writer, int64_t job, const json_t *subscriber);
/* The one that is due for longest. STORE_NOT_FOUND: none is. */
store_status store_next_callback(job_store *store, callback *next);
/* It was taken, or nobody will ever take it. */
store_status store_end_callback(job_store *store, const callback *told);
/* To be tried again after these seconds, as is all that goes to addresses which begin like that. */
store_status store_put_off_callback(job_store *store, const callback *told, bool was_tried, double seconds, const char *same_host);
/* Those that were tried for three days in vain, and the oldest of too many; their number in *forgotten. */
store_status store_forget_callbacks(job_store *store, int64_t *forgotten);

#endif
