/* What the answer says in words. */
#ifndef WORDS_H
#define WORDS_H

#include "agreement.h"
#include "family.h"
#include "sensitivity.h"
#include "shape.h"

typedef struct findings {
    const plan_fit *fit;
    agreement agreement;
    shape shape;
    sensitivity sensitivity[PLAN_MOST_MEASURES]; /* of the measures that have an emulator */
    const char *status;
    size_t verified; /* sets */
    family_check check;
} findings;

/* A list of sentences: why the status is what it is, and what else there is to know. New reference. */
json_t *words_of_answer(const findings *f);
/* A sentence on a direction. New reference. */
json_t *words_of_direction(const findings *f, size_t direction);
/* "rolling friction", or the whole pointer where two end alike. */
enum { SHORT_NAME_SIZE = 80 };
void parameter_name(const plan_request *request, size_t parameter, char name[SHORT_NAME_SIZE]);

#endif
