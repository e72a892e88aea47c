#include "job_changes.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <time.h>

#include "log.h"

struct job_changes {
    pthread_mutex_t lock;
    pthread_cond_t wakes;
    changed_jobs now;
};

job_changes *job_changes_create(void)
{
    job_changes *changes = calloc(1, sizeof *changes);
    if (!changes) return NULL;
    pthread_condattr_t monotonic;
    pthread_condattr_init(&monotonic);
    pthread_condattr_setclock(&monotonic, CLOCK_MONOTONIC);
    pthread_mutex_init(&changes->lock, NULL);
    pthread_cond_init(&changes->wakes, &monotonic);
    pthread_condattr_destroy(&monotonic);
    return changes;
}

void job_changes_free(job_changes *changes)
{
    if (!changes) return;
    pthread_cond_destroy(&changes->wakes);
    pthread_mutex_destroy(&changes->lock);
    free(changes);
}

static void note_one(changed_jobs *now, int64_t number)
{
    for (size_t i = 0; i < now->count; i++)
        if (now->number[i] == number) return;
    if (now->count < MOST_CHANGED_JOBS) now->number[now->count++] = number;
    else now->are_more = true;
}

void job_changes_note(job_changes *changes, const int64_t *number, size_t count, bool are_more)
{
    pthread_mutex_lock(&changes->lock);
    changed_jobs *now = &changes->now;
    now->are_more = now->are_more || are_more;
    for (size_t i = 0; i < count && !now->are_more; i++) note_one(now, number[i]);
    pthread_cond_signal(&changes->wakes);
    pthread_mutex_unlock(&changes->lock);
}

void job_changes_take(job_changes *changes, double seconds, changed_jobs *taken)
{
    const double at = monotonic_seconds() + seconds;
    const struct timespec until = { (time_t)at, (long)((at - floor(at)) * 1e9) };
    pthread_mutex_lock(&changes->lock);
    int code = 0;
    while (code == 0 && changes->now.count == 0 && !changes->now.are_more && !changes->now.is_over)
        code = pthread_cond_timedwait(&changes->wakes, &changes->lock, &until);
    *taken = changes->now;
    changes->now.count = 0;
    changes->now.are_more = false;
    pthread_mutex_unlock(&changes->lock);
}

void job_changes_end(job_changes *changes)
{
    pthread_mutex_lock(&changes->lock);
    changes->now.is_over = true;
    pthread_cond_signal(&changes->wakes);
    pthread_mutex_unlock(&changes->lock);
}
