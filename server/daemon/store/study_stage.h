/* The rows of a study on their way into the tables.
 *
 * Reading ten thousand jobs and working out their numbers takes seconds, and nobody shall wait for that: each job's rows
 * are written into a database of the study's own, without a name, in memory and for the rest on the disk, by the same
 * functions as those of a job alone. What is done with the writer's lock held is to copy these rows.
 *
 * A study's jobs get no folder when they are added: their specifications are in the table, and the folder is made
 * when a worker starts. So one commit is the whole study, and what dies before it leaves nothing. Only jobs that start from
 * another's bed have theirs early, with the bed in it. */
#ifndef STUDY_STAGE_H
#define STUDY_STAGE_H

#include "job_store.h"

const char *study_stage_id(const study_stage *stage);

/* The beds that jobs start from, into their folders; safe on the disk on return. */
store_status study_stage_bring_starts(study_stage *stage);
void study_stage_discard_starts(study_stage *stage); /* folders that were made for them */

/* Once all are there: jobs that settle a bed which no other of them does have none to share. */
store_status study_stage_match_beds(study_stage *stage);

/* Between begin and end: every row, as the study of this number. */
store_status study_stage_copy(study_stage *stage, int64_t study);

#endif
