/* What a settled bed depends on. Runs of the same text settle the same bed, to the last bit, so that one may do it for all. */
#ifndef SPEC_BED_H
#define SPEC_BED_H

#include "job_spec.h"

/* To be freed; NULL: the run settles no bed, or there is no memory. */
char *spec_bed_text(const job_spec *spec);

#endif
