/* What results of several processes have in common: profiles as lists, angles under several definitions. */
#ifndef STANDING_RESULT_H
#define STANDING_RESULT_H

#include <jansson.h>
#include <stdbool.h>

#include "dem_mound.h"

/* Adds "other_methods" and "other_methods_standard_error_deg" to an object of angles: all but the first, which is the
 * object's own. False: no memory. */
bool angle_methods_add(json_t *repose, const dem_angle *angle, int count, const char *const *name);
/* {<place>: [...], <value>: [...], "standard_error": [...]}; errors that are not known are left out as a whole. New
 * reference; NULL: no memory. */
json_t *profile_to_json(const dem_profile *profile, const char *place, const char *value);

/* The members that these add, described. */
void describe_angle_methods(json_t *properties);
void describe_profile(json_t *properties, const char *name, const char *meaning);

#endif
