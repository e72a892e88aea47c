/* Whether the bars of a drum fit into it. */
#ifndef DRUM_LIFTERS_H
#define DRUM_LIFTERS_H

#include "job_spec.h"
#include "problem.h"

/* Bars whose corners are within the drum, apart from each other, and which leave the largest particle its room. True: no problem. */
bool lifters_check(const scene_inputs *inputs, const dem_scene_definition *drum, problem_list *problems);

#endif
