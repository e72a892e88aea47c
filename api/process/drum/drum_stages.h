/* A drum whose rotation is a list of stages. */
#ifndef DRUM_STAGES_H
#define DRUM_STAGES_H

#include "job_spec.h"
#include "problem.h"

/* Says what is wrong with them, and with what stands beside them. Where all is well: sets spec->duration. */
void stages_derive(job_spec *spec, problem_list *problems);
/* rad/s, with its sign: the fastest of them. NaN: none is known. */
double stages_fastest(const scene_inputs *inputs);
/* s: so that each of them has its frames, so many a revolution. */
double stages_sample_interval(const scene_inputs *inputs, double per_revolution);
/* In the scene, which is mirrored where the first that turns has a rate below 0. */
void stages_define(const scene_inputs *inputs, dem_scene_definition *drum);

#endif
