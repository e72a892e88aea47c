/* Long parts of the specifications of a study's jobs, which are kept once and not with each job.
 *
 * A canonical specification has lists at /inputs/particles and /inputs/start/particles; in the table a text "part 3" stands
 * for one that is long. Nobody else reads these texts: whoever asks for a job's specification gets it whole
 * (study_parts_expand in job_store.h), byte for byte as if the job had been posted alone. */
#ifndef STUDY_PARTS_H
#define STUDY_PARTS_H

#include <sqlite3.h>

#include "store.h"

enum { KNOWN_PARTS = 16 };

/* What a part was made of, to know it again; of the latest few. */
typedef struct known_part {
    int64_t number;
    size_t bytes;
    void *inputs; /* owned */
} known_part;

typedef struct study_parts {
    sqlite3 *database; /* gets a row a part, of study 0 */
    int64_t count;
    known_part known[KNOWN_PARTS];
} study_parts;

void study_parts_init(study_parts *parts, sqlite3 *database);
void study_parts_clear(study_parts *parts);
/* The canonical text of a spec, its long lists made parts. For free(); NULL: no memory, or the database failed. */
char *study_parts_write(study_parts *parts, const job_spec *spec);

#endif
