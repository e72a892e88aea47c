/* The answer of a calibration (api/CALIBRATION.md says what each member is). */
#ifndef ANSWER_H
#define ANSWER_H

#include "plan_fit.h"

/* sets (count,parameters): the family that was verified; count 0: none was. New reference; NULL: no memory. */
json_t *answer_make(const plan_fit *fit, const double *sets, size_t count);

#endif
