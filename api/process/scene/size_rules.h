/* From the size distribution asked for to the sizes of a species. */
#ifndef SIZE_RULES_H
#define SIZE_RULES_H

#include "job_spec.h"

/* Of species s: the ends where they are not given, and the law; does nothing where there is no distribution. Where there are
 * problems, the species' diameter is NaN. */
void sizes_derive(species_inputs *species, size_t s, dem_species *derived, problem_list *problems);

/* Share of the distribution asked for that is cut off below its minimum and above its maximum. */
double sizes_cut_below(const dem_sizes *sizes);
double sizes_cut_above(const dem_sizes *sizes);

/* A run that the sizes make too long to ever end: the estimate says so. */
void sizes_check_cost(const job_spec *spec, problem_list *problems);

/* [{"d10", "d50", "d90", ...}] of the species that have sizes. */
void sizes_understand(const job_spec *spec, json_t *words);

#endif
