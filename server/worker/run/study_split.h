/* `repose split`: a study as numbered folders, for a batch system or a shell to run where no daemon may. DIR/study.json is the study,
 * with its seeds chosen; DIR/jobs/000001/spec.json and so on are its jobs, by case and repeat; DIR/job.sbatch runs them. */
#ifndef STUDY_SPLIT_H
#define STUDY_SPLIT_H

#include <jansson.h>
#include <stdbool.h>
#include <stdint.h>

#include "job_spec.h"
#include "problem.h"

/* program: what runs a job. False: problems say why where there are any; else something can't be written, which was told on stderr. */
bool study_split(const json_t *document, const start_source *beds, uint64_t seed_if_missing, const calibration *machine,
                 const char *program, const char *folder, problem_list *problems);

#endif
