#include "mirror.h"

void mirror_vectors(double *vectors, size_t count)
{
    for (size_t i = 0; i < count; i++) vectors[3 * i] = 0.0 - vectors[3 * i]; /* no -0 of 0 */
}

void mirror_spins(double *spins, size_t count)
{
    for (size_t i = 0; i < count; i++)
        for (size_t c = 1; c < 3; c++) spins[3 * i + c] = 0.0 - spins[3 * i + c];
}

void mirror_turns(double *turns, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        double *q = turns + 4 * i;
        const double w = q[0], x = q[1];
        q[0] = q[2];
        q[1] = q[3];
        q[2] = w;
        q[3] = x;
    }
}
