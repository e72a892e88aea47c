/* Memory for arrays. */
#ifndef ARRAY_H
#define ARRAY_H

#include <stddef.h>

#include "dem_types.h"

/* Zeroed, aligned to a cache line, large ones in huge pages where there are any; NULL when out of memory; freed with free(). */
void *array_create(size_t count, size_t size);
/* Once, before other threads are at work: what is freed of large arrays goes back to the system. Their sizes vary, and would
 * leave holes. */
void arrays_prepare(void);

/* A measure that had no memory must not pass for one that could not be taken (not a number). Whoever measures begins with
 * arrays_begin and returns arrays_end(status): DEM_NO_MEMORY where this thread was refused an array since. Who asks the
 * system for memory by itself, and does not get it, calls arrays_refused. */
void arrays_begin(void);
void arrays_refused(void);
dem_status arrays_end(dem_status status);

#endif
