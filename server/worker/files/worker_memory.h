/* Whether memory was missing: what the libraries say of it differs, or is nothing at all. */
#ifndef WORKER_MEMORY_H
#define WORKER_MEMORY_H

#include <stdbool.h>

/* From now on. Also: a library that ends the process (OpenMP does, without memory or threads), or crashes after it was refused
 * memory (HDF5 does), ends it with WORKER_MACHINE. */
void worker_memory_watch(void);
/* Ends the process with WORKER_MACHINE, at once: nothing that cleans up is trusted any more. */
_Noreturn void worker_memory_end(void);
/* JSON was refused memory since. */
bool worker_memory_was_short(void);

#endif
