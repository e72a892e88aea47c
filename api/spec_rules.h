/* What follows from the inputs, and which inputs can't go together. */
#ifndef SPEC_RULES_H
#define SPEC_RULES_H

#include "job_spec.h"

/* Sets the defaults that depend on other inputs, checks combinations, and derives the definition, duration and
 * intervals of spec from spec->inputs. Nothing derived is of use when there are problems. */
void spec_rules_apply(job_spec *spec, uint64_t seed_if_missing, problem_list *problems);

#endif
