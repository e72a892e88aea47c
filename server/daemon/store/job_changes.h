/* Which jobs have changed, for whoever follows them: numbers of rows, noted by the commit that changed them. */
#ifndef JOB_CHANGES_H
#define JOB_CHANGES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { MOST_CHANGED_JOBS = 64 };

typedef struct job_changes job_changes;

typedef struct changed_jobs {
    int64_t number[MOST_CHANGED_JOBS]; /* each once */
    size_t count;
    bool are_more; /* than there is room for: any may have changed */
    bool is_over;  /* nobody notes any more */
} changed_jobs;

job_changes *job_changes_create(void); /* NULL: no memory */
void job_changes_free(job_changes *changes);
/* are_more: these are not all. */
void job_changes_note(job_changes *changes, const int64_t *number, size_t count, bool are_more);
/* Waits for the first change, at most so long, and takes what there is. */
void job_changes_take(job_changes *changes, double seconds, changed_jobs *taken);
/* Ends the wait, for good. */
void job_changes_end(job_changes *changes);

#endif
