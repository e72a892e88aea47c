/* Which of the tests that might be done next would settle most. They were run at the family's sets alone, which is enough to tell how
 * their results vary along the posterior, with an error that counts against them. */
#ifndef NEXT_TEST_H
#define NEXT_TEST_H

#include "shape.h"

/* The proposed tests, those that would shrink the worst known direction most first. New reference; NULL: no memory. */
json_t *next_test_to_json(const plan_fit *fit, const shape *shape, const double *sets, size_t count);

#endif
