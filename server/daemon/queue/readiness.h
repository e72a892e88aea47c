/* Whether the daemon can take requests: what GET /readyz tells. */
#ifndef READINESS_H
#define READINESS_H

#include <pthread.h>
#include <stdbool.h>
#include <stddef.h>

#include "dispatcher.h"

typedef struct readiness {
    const job_dispatcher *dispatcher;
    pthread_mutex_t lock;
    double looked;     /* monotonic s: when a write was tried last */
    char why_not[160]; /* what became of it; "": it went well */
} readiness;

void readiness_init(readiness *r, const job_dispatcher *dispatcher);
/* From any thread. False: why_not says what is missing. */
bool readiness_look(readiness *r, char *why_not, size_t size);

#endif
