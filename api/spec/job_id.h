/* The id of a job or a study, "20261122-014455-3f9a2c71": the time of submission and 32 random bits, so that folders sort by age. */
#ifndef JOB_ID_H
#define JOB_ID_H

#include <stdbool.h>

enum { JOB_ID_SIZE = 25 };

bool job_id_is_valid(const char *id);

#endif
