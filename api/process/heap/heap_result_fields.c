/* Results of `heap`. This file knows nothing of the core, so that the daemon can describe results without it. */
#include <string.h>

#include "heap_process.h"
#include "heap_result.h"
#include "run_fields.h"
#include "standing_result.h"

#define ANGLE(member) offsetof(heap_result, measured.angle[DEM_AZIMUTHAL_FIT].member)
#define HEAP(member) offsetof(heap_result, measured.member)
#define STANDING(member) offsetof(heap_result, standing.member)
#define RUN(member) offsetof(heap_result, run.member)

static const result_field fields[] = {
    { "repose", NULL, "angle_deg", RESULT_REAL, ANGLE(mean_deg), "degrees",
      "static angle of repose, mean over the azimuths; null: too small a heap" },
    { "repose", NULL, "standard_error_deg", RESULT_REAL, ANGLE(standard_error_deg), "degrees",
      "error of that mean; the other definitions have none, since one heap cannot tell it" },
    { "repose", NULL, "minimum_deg", RESULT_REAL, ANGLE(minimum_deg), "degrees", "flattest azimuth" },
    { "repose", NULL, "maximum_deg", RESULT_REAL, ANGLE(maximum_deg), "degrees", "steepest azimuth" },
    { "repose", NULL, "azimuths", RESULT_WHOLE, offsetof(heap_result, azimuths), "", "sectors, or sides that it is seen from" },

    { "surface", NULL, "height", RESULT_REAL, HEAP(height), "m", "of the highest particle's top over the plate" },
    { "surface", NULL, "base_diameter", RESULT_REAL, HEAP(base_diameter), "m",
      "mean over the azimuths: where the surface is half a grain high, or as high as the rim, or the plate ends" },
    { "surface", NULL, "volume", RESULT_REAL, HEAP(volume), "m3", "below the surface" },
    { "surface", NULL, "static_cohesive_index", RESULT_REAL, HEAP(static_cohesive_index), "m",
      "mean over the radius of the standard deviation over azimuths of the height" },

    { "packing", NULL, "solid_fraction", RESULT_REAL, HEAP(solid_fraction), "",
      "solid over all that is below the surface, dips between spheres left out: higher than within the heap" },
    { "packing", NULL, "coordination_number", RESULT_REAL, STANDING(coordination_number), "", "contacts a particle of the heap" },

    { "heap", NULL, "inside", RESULT_SIZE, STANDING(inside), "", "particles of the heap: with two contacts or more" },
    { "heap", NULL, "apart", RESULT_SIZE, STANDING(in_flight), "", "particles by themselves on the plate, or in flight" },
    { "heap", NULL, "lost", RESULT_SIZE, STANDING(lost), "", "particles that fell off the plate" },
    { "heap", NULL, "at_rest", RESULT_TRUTH, STANDING(at_rest), "", "no angle of repose before it is" },

    FIELDS_OF_RUN,
};

static const result_output outputs[] = {
    { "repose", "static angle of repose" }, { "surface", "shape of the heap" }, { "packing", "packing of the heap" },
    { "heap", "where all particles are" },  { "run", "how the run went" },
};

static void describe_words(json_t *properties, const char *output)
{
    if (strcmp(output, "repose") == 0) describe_angle_methods(properties);
    if (strcmp(output, "surface") == 0)
        describe_profile(properties, "profile",
                         "lists over rings: radius (m), height (m, mean over the azimuths) and its standard_error (m)");
}

const result_table heap_result_fields = {
    .field = fields,
    .count = sizeof fields / sizeof fields[0],
    .output = outputs,
    .output_count = sizeof outputs / sizeof outputs[0],
    .describe_words = describe_words,
};
