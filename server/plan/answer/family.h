/* A few sets of parameters spread over the posterior, which are run with new seeds: they verify the emulators, and foretell hold-outs. */
#ifndef FAMILY_H
#define FAMILY_H

#include "plan_fit.h"

enum { FAMILY_MOST = 9 };

/* sets (count,parameters) in the unit cube: the best first, then each as far as can be from those before it, among the likeliest 95 of
 * 100 draws. Returns how many there are. */
size_t family_choose(const plan_fit *fit, size_t wanted, double *sets);

/* The run of a set by a test; NULL: there is none. */
const plan_run *family_run(const plan_fit *fit, size_t set, size_t test);

/* New references, NULL: no memory. Each set with what its runs gave beside what was foretold; and each hold-out. */
json_t *family_to_json(const plan_fit *fit, const double *sets, size_t count);
/* How far the family's runs are off what the emulators of the targets foretold for them. */
typedef struct family_check {
    double chi_square;
    int runs;        /* values that were compared */
    double worst;    /* the largest square of them: single beds differ by much more than others now and then */
    bool is_refuted; /* chance makes so much, without the worst, in fewer than 3 of 1000 cases */
} family_check;
bool family_compare(const plan_fit *fit, const double *sets, size_t count, family_check *check);
json_t *validation_to_json(const plan_fit *fit, size_t count);
/* {pointer: value} at a place of the unit cube. */
json_t *parameters_to_json(const plan_request *request, const double *x);

#endif
