/* What processes that advance a scene say of it beside their own: in warnings, and in other words. */
#ifndef SCENE_WARNINGS_H
#define SCENE_WARNINGS_H

#include "job_spec.h"

/* Contacts so soft that overlaps change what is measured, and containers so narrow that single particles do. container: the
 * input that has its diameter. */
void scene_warn(const job_spec *spec, const char *container, problem_list *warnings);
/* How many of the largest particle diameters the container is wide, and the overlap to be expected. */
void scene_understand(const job_spec *spec, json_t *words);

/* omega^2 R/g, of either sense of rotation. */
double froude_number(double rotation_rate, double radius, double gravity);
double revolutions_a_minute(double rotation_rate);
void rotation_understand(double rotation_rate, double froude, json_t *words);

#endif
