/* Whether the targets can be reached: each by itself, and all of them together. */
#ifndef AGREEMENT_H
#define AGREEMENT_H

#include "plan_fit.h"

/* What chance makes in fewer cases than this is not taken for chance. */
#define LEAST_PROBABILITY 0.003

typedef struct agreement {
    double chi_square;    /* at the best place, of measurement and emulator errors */
    int degrees;          /* of freedom */
    double probability;   /* that chance alone makes so much or more of it */
    bool is_contradicted; /* fewer than 3 in 1000 */
    struct {
        double nearest, z;       /* the value nearest to the target's, and by how many errors it is off */
        bool is_out;             /* by more than 3 */
    } reach[PLAN_MOST_MEASURES]; /* of each fitted value that has an emulator, in their order */
    bool is_out;                 /* any of them */
} agreement;

/* False: no memory. */
bool agreement_measure(const plan_fit *fit, agreement *agreement);

/* That a sum of so many squares of normal numbers is larger. */
double chi_square_beyond(double chi_square, int degrees);

#endif
