/* The sizes that the particles of a scene have, for its results. */
#ifndef SIZE_FACTS_H
#define SIZE_FACTS_H

#include "dem.h"
#include "job_spec.h"
#include "run_facts.h"

/* All NaN where no species has a size distribution. */
void size_facts_measure(const job_spec *spec, const dem_scene *scene, run_facts *facts);

#endif
