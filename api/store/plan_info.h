/* What is told of a calibration, as JSON. */
#ifndef PLAN_INFO_H
#define PLAN_INFO_H

#include "plan_store.h"

/* New reference; NULL: no memory. */
json_t *plan_info(const plan_record *plan);

#endif
