/* Results of `fill`. This file knows nothing of the core, so that the daemon can describe results without it. */
#include <string.h>

#include "fill_process.h"
#include "fill_result.h"
#include "result_rows.h"
#include "standing_result.h"

#define ANGLE(member) offsetof(fill_result, measured.angle[DEM_RADIAL_FIT].member)
#define FILLING(member) offsetof(fill_result, while_filling.member)
#define FILL(member) offsetof(fill_result, measured.member)
#define STANDING(member) offsetof(fill_result, standing.member)
#define RUN(member) offsetof(fill_result, run.member)

static const result_field fields[] = {
    { "repose", NULL, "angle_deg", RESULT_REAL, ANGLE(mean_deg), "degrees", LABEL("angle of repose"),
      .meaning = "slope of the mound at the end, mean over the azimuths; negative: the middle is lower" },
    { "repose", NULL, "standard_error_deg", RESULT_REAL, ANGLE(standard_error_deg), "degrees", LABEL("its error"), SHOWN(1, "°", 2),
      .meaning = "error of that mean; the other definitions have none, since one bed cannot tell it" },
    { "repose", NULL, "minimum_deg", RESULT_REAL, ANGLE(minimum_deg), "degrees", LABEL("lowest angle"),
      .meaning = "flattest azimuth" },
    { "repose", NULL, "maximum_deg", RESULT_REAL, ANGLE(maximum_deg), "degrees", LABEL("highest angle"),
      .meaning = "steepest azimuth" },
    { "repose", NULL, "method", RESULT_WORD, offsetof(fill_result, method), "", LABEL("definition"),
      .meaning = "how angle_deg was measured" },
    { "repose", NULL, "azimuths", RESULT_WHOLE, offsetof(fill_result, azimuths), "", LABEL("azimuths"), .meaning = "sectors" },
    { "repose", "while_filling", "angle_deg", RESULT_REAL, FILLING(mean_deg), "degrees", LABEL("angle"),
      .meaning = "the same, mean over the samples of the second half of the stream", IN_VIEW(540), IN_STUDY(200),
      RUN_ERROR("while_filling_standard_error_deg") },
    { "repose", "while_filling", "standard_error_deg", RESULT_REAL, FILLING(standard_error_deg), "degrees", LABEL("its error"),
      SHOWN(1, "°", 2), .meaning = "error of that mean; null: fewer than 8 samples", IN_VIEW(550) },
    { "repose", "while_filling", "minimum_deg", RESULT_REAL, FILLING(minimum_deg), "degrees", LABEL("lowest angle"),
      .meaning = "lowest of a sample" },
    { "repose", "while_filling", "maximum_deg", RESULT_REAL, FILLING(maximum_deg), "degrees", LABEL("highest angle"),
      .meaning = "highest of a sample" },

    { "surface", NULL, "height", RESULT_REAL, FILL(height), "m", LABEL("height"), .meaning = "mean over the floor", IN_VIEW(560),
      IN_STUDY(210) },
    { "surface", NULL, "center_height", RESULT_REAL, FILL(center_height), "m", LABEL("height in the middle"),
      .meaning = "mean within 20 % of the radius", IN_VIEW(570) },
    { "surface", NULL, "wall_height", RESULT_REAL, FILL(wall_height), "m", LABEL("height at the wall"),
      .meaning = "mean beyond 80 % of the radius", IN_VIEW(580) },

    { "packing", NULL, "solid_fraction", RESULT_REAL, FILL(solid_fraction), "", LABEL("solid fraction"),
      .meaning = "of the core: two grains off wall, floor and surface; null: too small a bed" },
    { "packing", NULL, "coordination_number", RESULT_REAL, STANDING(coordination_number), "", LABEL("coordination number"),
      .meaning = "contacts a particle of the bed" },
    { "packing", NULL, "tension_share", RESULT_REAL, STANDING(tension_share), "", LABEL("contacts in tension"), SHOWN(100, " %", 3),
      .meaning = "share of the contacts between spheres whose spring and cohesion together pull; null: nothing coheres",
      IN_VIEW(722), IN_STUDY(112) },

    { "fill", NULL, "inside", RESULT_SIZE, STANDING(inside), "", LABEL("in the bed"),
      .meaning = "particles of the bed: joined to the floor, by others if need be", STORED },
    { "fill", NULL, "apart", RESULT_SIZE, STANDING(in_flight), "", LABEL("apart from it"), .meaning = "particles in flight",
      STORED },
    { "fill", NULL, "waiting", RESULT_SIZE, STANDING(waiting), "", LABEL("never entered"),
      .meaning = "particles that never entered", STORED },
    { "fill", NULL, "at_rest", RESULT_TRUTH, STANDING(at_rest), "", LABEL("at rest"), .meaning = "the bed had come to rest",
      IN_VIEW(860) },

    FIELDS_OF_RUN("from when filling or lifting began", "that", "while filling or lifting",
                  "at-rest; duration: it was not yet at rest"),
};

static const result_output outputs[] = {
    { "repose", "slope of the mound" },    { "surface", "surface of the bed" }, { "packing", "packing of the bed" },
    { "fill", "where all particles are" }, { "run", "how the run went" },
};

static const char *const other_angles[] = { "center-to-wall", "area-fit", NULL };

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
    RESULT_TABLE(fields, outputs),
    .describe_words = describe_words,
    .other_angles = other_angles,
};
