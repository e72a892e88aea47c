#include "readiness.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "log.h"

#define ROUND_TOO_LONG 30.0 /* s without a round of the supervisor: something hangs */
#define LEAST_FREE_BYTES 67108864.0
#define BETWEEN_WRITES 1.0 /* s, so that who asks often does not wear the disk */

void readiness_init(readiness *r, const job_dispatcher *dispatcher)
{
    *r = (readiness){ .dispatcher = dispatcher, .looked = -BETWEEN_WRITES };
    pthread_mutex_init(&r->lock, NULL);
}

/* Writes for the sake of it: a disk that takes no more shows in nothing else. */
static void try_to_write(readiness *r)
{
    job_store *store = r->dispatcher->store;
    r->why_not[0] = '\0';
    if (!data_folder_try_write(store->data))
        snprintf(r->why_not, sizeof r->why_not, "no file can be written in the data folder: %s", strerror(errno));
    else if (store_try_write(store) != STORE_OK)
        snprintf(r->why_not, sizeof r->why_not, "the database can't be written; the daemon's log says why");
    r->looked = monotonic_seconds();
}

bool readiness_look(readiness *r, char *why_not, size_t size)
{
    int64_t counts[JOB_STATUSES];
    const double silence = monotonic_seconds() - r->dispatcher->last_round;
    const double room = data_folder_free_bytes(r->dispatcher->store->data);
    pthread_mutex_lock(&r->lock);
    if (monotonic_seconds() - r->looked >= BETWEEN_WRITES) try_to_write(r);
    snprintf(why_not, size, "%s", r->why_not);
    pthread_mutex_unlock(&r->lock);
    if (why_not[0]) return false;
    if (store_count_jobs(r->dispatcher->store, counts) != STORE_OK) snprintf(why_not, size, "the database can't be read");
    else if (silence > ROUND_TOO_LONG) snprintf(why_not, size, "the supervisor has been silent for %.0f s", silence);
    else if (!r->dispatcher->recovered)
        snprintf(why_not, size, "jobs that an earlier daemon left running could not be put back yet: the disk can't be written");
    else if (room < LEAST_FREE_BYTES)
        snprintf(why_not, size, "the data folder's disk has %.0f MB left; needs %.0f MB", room / 1e6, LEAST_FREE_BYTES / 1e6);
    else return true;
    return false;
}
