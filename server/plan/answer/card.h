/* The material that was found, for whoever uses it: as a card, and in the language of other programs. */
#ifndef CARD_H
#define CARD_H

#include "plan_fit.h"

/* {"law", "particles", "contact", ..., "found", "told_by"}: the specification of the first test at the best place, but for what is of
 * the test, with how well each parameter is known and what told it. NULL: no memory, or no such job. New reference. */
json_t *card_to_json(const plan_fit *fit, const json_t *credible);
/* {"lammps", "liggghts", "mercurydpm", "yade"}: each {"text", "does_not_carry_over": [sentences]}. New reference; NULL likewise. */
json_t *snippets_to_json(const plan_fit *fit);

/* The job of the first test at the best place. False: there is none. */
bool card_spec(const plan_fit *fit, job_spec *spec);

#endif
