/* bed.hdf: the bed that one job of a study settles for all that would settle the same. It is the checkpoint of the first step of
 * rotation, from which a run with another rate, say, goes on with the bits that it would have had by itself. */
#ifndef SHARED_BED_H
#define SHARED_BED_H

#include "checkpoint_file.h"
#include "job_spec.h"
#include "sha256.h"

/* The checkpoint that was just written becomes bed.hdf, too. False: logged; nobody shares it then. */
bool shared_bed_save(char hash[SHA256_HEX_SIZE]);

/* What another job left. FILE_WHOLE: it is what the daemon was told of, of the same program, and the bed that a run of `spec` would
 * settle; else it is logged why it is not used. */
file_state shared_bed_read(const job_spec *spec, const char *program, checkpoint *saved);

/* Of a job that goes on from it, which is done. */
void shared_bed_remove(void);

#endif
