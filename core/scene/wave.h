/* Several steps in one pass through memory, for beds that no cache holds: while a sphere and its contacts are at hand they take
 * all the steps for which the list holds, not one.
 *
 * Each step is a stage, and goes through the list behind the one before it: a block of contacts is computed once all spheres
 * in it, and all that these might touch, have taken the step before. Spheres are sorted along the drum (sorting.h), so the
 * stages follow each other at the distance of a layer or two. Each stage does in the same order what a step by itself does:
 * the same bits.
 *
 * Several threads share the stages: the first takes the first ones, the next those that follow behind, so that what a sphere
 * and its contacts are at that place goes from one core to the other once a wave. A stage is some thread's alone while it goes
 * on by a portion of the list. A thread whose own stages have to wait takes any other that can go on, so one thread alone ends
 * the wave, too.
 *
 * How far spheres stray from the paths that the list was picked for is known only when they have moved. A list that does not
 * hold any more for a stage stops this and the later ones where they are. Those before go on to the end; then the list is
 * picked again from spheres of which some are ahead of others, and the stages go on from their last contacts, one after the
 * other. */
#ifndef WAVE_H
#define WAVE_H

#include <stdatomic.h>

#include "contact_forces.h"
#include "scene.h"

typedef struct wave_stage {
    list_cursor cursor;
    contact_block block;
    atomic_flag is_taken; /* a thread works on it */
    /* What other threads see of the cursor. Each is stored before `complete`, so who has seen that sees what led to it. */
    _Atomic double deviation, overlap; /* wave_deviation, wave_largest_overlap */
    atomic_size_t complete;
    size_t ready; /* the spheres before this one, and all that they might touch, have taken the step before */
    /* Where the stage stopped, if it did: the last pair that was computed, and the contacts with walls whose row is computed
     * but not yet added to a load. */
    int32_t first, second; /* spheres of that pair; -1: none was computed */
    size_t wall_count;
    int32_t wall_first[BLOCK], wall_second[BLOCK];
    contact_row wall_row[BLOCK];
} wave_stage;

typedef struct wave {
    neighbor_list *list;
    spheres *spheres;
    int steps;            /* in the wave */
    atomic_int whole;     /* how many of them, from the first on, go to the end with the list of the beginning */
    double overlap_limit; /* m: a larger overlap may be a failure (failure_least_overlap) */
    int threads;
    pair_work work;
    wave_stage stage[HORIZON];
} wave;

/* Whether the next steps may be in waves. The pairs are dealt to one part then, whatever the number of threads. */
bool wave_is_possible(const dem_scene *scene);
/* How many of the next `left` steps can be one wave. 1: the next step is taken by itself. The lists must be up to date. */
int wave_length(const dem_scene *scene, int64_t left);
/* are_walls_done: the contacts with walls of the first step have been computed already. */
void wave_begin(wave *wave, dem_scene *scene, int steps, bool are_walls_done);
/* Takes all steps, or as many as the list holds for: wave.whole. The later ones stop on the way. */
void wave_run(wave *wave);
/* Takes step k, one that stopped, to its end. All steps before it are at their ends, and the lists are up to date. */
void wave_resume(wave *wave, int k);
double wave_largest_overlap(const wave *wave, int k); /* m, of step k */
/* m/s: the largest |v - v at the pick| after step k, of the spheres that have moved since the last pick. */
double wave_deviation(const wave *wave, int k);

#endif
