/* Results of `fill`. This file knows nothing of the core, so that the daemon can describe results without it. */
#include <string.h>

#include "fill_process.h"
#include "fill_result.h"
#include "run_fields.h"
#include "standing_result.h"

#define ANGLE(member) offsetof(fill_result, measured.angle[DEM_RADIAL_FIT].member)
#define FILLING(member) offsetof(fill_result, while_filling.member)
#define FILL(member) offsetof(fill_result, measured.member)
#define STANDING(member) offsetof(fill_result, standing.member)
#define RUN(member) offsetof(fill_result, run.member)

static const result_field fields[] = {
    { "repose", NULL, "angle_deg", RESULT_REAL, ANGLE(mean_deg), "degrees",
      "slope of the mound at the end, mean over the azimuths; negative: the middle is lower" },
    { "repose", NULL, "standard_error_deg", RESULT_REAL, ANGLE(standard_error_deg), "degrees",
      "error of that mean; the other definitions have none, since one bed cannot tell it" },
    { "repose", NULL, "minimum_deg", RESULT_REAL, ANGLE(minimum_deg), "degrees", "flattest azimuth" },
    { "repose", NULL, "maximum_deg", RESULT_REAL, ANGLE(maximum_deg), "degrees", "steepest azimuth" },
    { "repose", NULL, "azimuths", RESULT_WHOLE, offsetof(fill_result, azimuths), "", "sectors" },
    { "repose", "while_filling", "angle_deg", RESULT_REAL, FILLING(mean_deg), "degrees",
      "the same, mean over the samples of the second half of the stream" },
    { "repose", "while_filling", "standard_error_deg", RESULT_REAL, FILLING(standard_error_deg), "degrees",
      "error of that mean; null: fewer than 8 samples" },
    { "repose", "while_filling", "minimum_deg", RESULT_REAL, FILLING(minimum_deg), "degrees", "lowest of a sample" },
    { "repose", "while_filling", "maximum_deg", RESULT_REAL, FILLING(maximum_deg), "degrees", "highest of a sample" },

    { "surface", NULL, "height", RESULT_REAL, FILL(height), "m", "mean over the floor" },
    { "surface", NULL, "center_height", RESULT_REAL, FILL(center_height), "m", "mean within 20 % of the radius" },
    { "surface", NULL, "wall_height", RESULT_REAL, FILL(wall_height), "m", "mean beyond 80 % of the radius" },

    { "packing", NULL, "solid_fraction", RESULT_REAL, FILL(solid_fraction), "",
      "of the core: two grains off wall, floor and surface; null: too small a bed" },
    { "packing", NULL, "coordination_number", RESULT_REAL, STANDING(coordination_number), "", "contacts a particle of the bed" },

    { "fill", NULL, "inside", RESULT_SIZE, STANDING(inside), "",
      "particles of the bed: joined to the floor, by others if need be" },
    { "fill", NULL, "apart", RESULT_SIZE, STANDING(in_flight), "", "particles in flight" },
    { "fill", NULL, "waiting", RESULT_SIZE, STANDING(waiting), "", "particles that never entered" },
    { "fill", NULL, "at_rest", RESULT_TRUTH, STANDING(at_rest), "", "the bed had come to rest" },

    FIELDS_OF_RUN,
};

static const result_output outputs[] = {
    { "repose", "slope of the mound" },    { "surface", "surface of the bed" }, { "packing", "packing of the bed" },
    { "fill", "where all particles are" }, { "run", "how the run went" },
};

static void describe_words(json_t *properties, const char *output)
{
    if (strcmp(output, "repose") == 0) describe_angle_methods(properties);
    if (strcmp(output, "surface") == 0)
        describe_profile(properties, "profile",
                         "lists over rings: radius (m), height (m, mean over the azimuths) and its standard_error (m)");
    if (strcmp(output, "packing") == 0)
        describe_profile(properties, "profile",
                         "lists over slabs one grain thick: height (m) and solid_fraction, wall layer included");
}

const result_table fill_result_fields = {
    .field = fields,
    .count = sizeof fields / sizeof fields[0],
    .output = outputs,
    .output_count = sizeof outputs / sizeof outputs[0],
    .describe_words = describe_words,
};
