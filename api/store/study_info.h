/* How a study is doing, in the words of a job's statusInfo. */
#ifndef STUDY_INFO_H
#define STUDY_INFO_H

#include "store.h"

/* accepted: none has started; running: some have not ended; then failed or dismissed where any has, else successful. */
job_status study_status(const study_record *study);
json_t *study_info(const study_record *study); /* new reference; NULL: no memory */

#endif
