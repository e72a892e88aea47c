/* A spec from a file, as a user or the daemon wrote it. */
#ifndef SPEC_FILE_H
#define SPEC_FILE_H

#include "job_spec.h"

enum { SPEC_FILE_LONGEST = 20000000 }; /* a bed of ten thousand particles, each in full, is some 6 MB */

/* The JSON of a file of at most 20 MB. New reference; NULL: problems say why. */
json_t *spec_file_read(const char *name, problem_list *problems);

/* False when it can't be read or has problems, which are listed. beds: as job_spec_parse_with has them. */
bool spec_file_load(const char *name, const start_source *beds, uint64_t seed_if_missing, job_spec *spec, problem_list *problems);

#endif
