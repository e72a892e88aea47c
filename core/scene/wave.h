/* Several steps in one pass through memory, for beds that no cache holds: while a sphere and its contacts are at hand they take
 * all the steps for which the list holds, not one.
 *
 * Each step is a stage, and goes through the list behind the one before it: a block of contacts is computed once all spheres
 * in it, and all that these might touch, have taken the step before. Spheres are sorted along the drum (sorting.h), so the
 * stages follow each other at the distance of a layer or two. Each stage does in the same order what a step by itself does:
 * the same bits.
 *
 * How far spheres stray from the paths that the list was picked for is known only when they have moved. A list that does not
 * hold any more for a stage stops this and the later ones where they are. Those before go on to the end; then the list is
 * picked again from spheres of which some are ahead of others, and the stages go on from their last contacts, one after the
 * other. */
#ifndef WAVE_H
#define WAVE_H

#include "contact_forces.h"
#include "scene.h"

typedef struct wave_stage {
    list_cursor cursor;
    size_t ready; /* spheres before it, and all that these might touch, have taken the step before */
    /* where it stopped; of contacts with walls, those that have a row which is in no load yet */
    int32_t first, second; /* of the last pair that was computed; -1: none was */
    size_t wall_count;
    int32_t wall_first[BLOCK], wall_second[BLOCK];
    contact_row wall_row[BLOCK];
} wave_stage;

typedef struct wave {
    neighbor_list *list;
    spheres *spheres;
    int steps, whole; /* the latter: as many of the first go, or went, to the end by the list of the beginning */
    double overlap_limit;
    pair_work work;
    contact_block block;
    wave_stage stage[HORIZON];
} wave;

/* Steps from here on, at most `left`, that can be one wave: lists are up to date. 1: the step is one by itself. */
int wave_length(const dem_scene *scene, int64_t left);
/* The first step's contacts with walls have their rows: are_walls_done. */
void wave_begin(wave *wave, dem_scene *scene, int steps, bool are_walls_done);
/* All steps, or as many as the list holds for: wave.whole. */
void wave_run(wave *wave);
/* Step k, behind those, from where it stopped to the end: lists are up to date. */
void wave_resume(wave *wave, int k);
double wave_largest_overlap(const wave *wave, int k); /* m, of step k */
/* m/s, of step k: the largest |v - v at the pick|, of spheres that moved since the last pick. */
double wave_deviation(const wave *wave, int k);

#endif
