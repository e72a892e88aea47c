/* Between the scene that runs and the one that was asked for, where that is its mirror image, x for -x (api/process/drum/drum_rules.c).
 * Signs alone change, so that nothing is lost, and twice is the same as not at all. */
#ifndef MIRROR_H
#define MIRROR_H

#include <stddef.h>

void mirror_vectors(double *vectors, size_t count); /* (count,3): places and velocities */
void mirror_spins(double *spins, size_t count);     /* (count,3): angular velocities */
void mirror_turns(double *turns, size_t count);     /* (count,4): orientations w, x, y, z of clusters */

#endif
