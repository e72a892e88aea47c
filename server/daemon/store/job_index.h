/* What jobs are found, counted and sorted by, in memory: some 40 bytes a job, and 8 for each column that is asked for. Any
 * filter is then one walk over arrays, 0.3 to 3 ms for 100,000 jobs, where the database would look at each job for
 * 2 microseconds, and count again at every look.
 *
 * It is a copy: made of the database when it is first needed, and made anew whenever that is easier than mending it. The
 * writer's connection tells which rows a transaction changed; whoever looks next reads those again. */
#ifndef JOB_INDEX_H
#define JOB_INDEX_H

#include <sqlite3.h>

#include "field_tables.h"
#include "store.h"

typedef struct job_index job_index;

/* Follows what this connection writes. NULL: no memory. */
job_index *job_index_create(const field_columns *columns, sqlite3 *writer);
void job_index_free(job_index *index);

/* The numbers of the jobs whose rows the writer's open transaction has changed; *are_more: these are not all. */
const int64_t *job_index_changing(const job_index *index, size_t *count, bool *are_more);
/* The writer's transaction has ended. */
void job_index_note_end(job_index *index, bool is_committed);

/* Whether looking through this filter takes some milliseconds; else there is much to be read before. */
bool job_index_is_ready(job_index *index, const job_filter *filter);

/* A job of a page. */
typedef struct found_job {
    int64_t number;
    char cursor[JOB_CURSOR_SIZE];
} found_job;

/* The jobs of a page, in its order, `*count` of them: at most filter->limit, for which there is room; and how many the filter
 * lets through of each status, whatever it says of statuses. study: its number, 0: any, below 0: there is none. */
store_status job_index_find(job_index *index, sqlite3 *reader, const job_filter *filter, int64_t study,
                            int64_t counts[JOB_STATUSES], found_job *found, size_t *count);
/* The numbers of all jobs that it lets through, oldest first; *numbers is the caller's to free. */
store_status job_index_find_all(job_index *index, sqlite3 *reader, const job_filter *filter, int64_t study,
                                int64_t counts[JOB_STATUSES], int64_t **numbers, size_t *count);

/* Reads it in now, so that nobody has to wait for it. */
void job_index_warm(job_index *index, sqlite3 *reader);

#endif
