/* Whether memory was missing: what the libraries say of it differs, or is nothing at all. */
#ifndef WORKER_MEMORY_H
#define WORKER_MEMORY_H

#include <stdbool.h>

/* From now on. Also: a library that ends the process (OpenMP does, without memory or threads) ends it with WORKER_MACHINE. */
void worker_memory_watch(void);
/* JSON was refused memory since. */
bool worker_memory_was_short(void);

#endif
