/* Results of `heap`. This file knows nothing of the core, so that the daemon can describe results without it. */
#include <string.h>

#include "heap_process.h"
#include "heap_result.h"
#include "result_rows.h"
#include "standing_result.h"

#define ANGLE(member) offsetof(heap_result, measured.angle[DEM_AZIMUTHAL_FIT].member)
#define HEAP(member) offsetof(heap_result, measured.member)
#define STANDING(member) offsetof(heap_result, standing.member)
#define RUN(member) offsetof(heap_result, run.member)

static const result_field fields[] = {
    { "repose", NULL, "angle_deg", RESULT_REAL, ANGLE(mean_deg), "degrees", LABEL("angle of repose"),
      .meaning = "static angle of repose, mean over the azimuths; null: too small a heap" },
    { "repose", NULL, "standard_error_deg", RESULT_REAL, ANGLE(standard_error_deg), "degrees", LABEL("its error"), SHOWN(1, "°", 2),
      .meaning = "error of that mean; the other definitions have none, since one heap cannot tell it" },
    { "repose", NULL, "minimum_deg", RESULT_REAL, ANGLE(minimum_deg), "degrees", LABEL("lowest angle"),
      .meaning = "flattest azimuth" },
    { "repose", NULL, "maximum_deg", RESULT_REAL, ANGLE(maximum_deg), "degrees", LABEL("highest angle"),
      .meaning = "steepest azimuth" },
    { "repose", NULL, "method", RESULT_WORD, offsetof(heap_result, method), "", LABEL("definition"),
      .meaning = "how angle_deg was measured" },
    { "repose", NULL, "azimuths", RESULT_WHOLE, offsetof(heap_result, azimuths), "", LABEL("azimuths"),
      .meaning = "sectors, or sides that it is seen from" },

    { "surface", NULL, "height", RESULT_REAL, HEAP(height), "m", LABEL("height"),
      .meaning = "of the highest particle's top over the plate" },
    { "surface", NULL, "base_diameter", RESULT_REAL, HEAP(base_diameter), "m", LABEL("base, across"),
      .meaning = "mean over the azimuths: where the surface is half a grain high, or as high as the rim, or the plate ends",
      IN_VIEW(590), IN_STUDY(220) },
    { "surface", NULL, "volume", RESULT_REAL, HEAP(volume), "m3", LABEL("volume"), SHOWN(1e6, " cm³", 3),
      .meaning = "below the surface", STORED },
    { "surface", NULL, "static_cohesive_index", RESULT_REAL, HEAP(static_cohesive_index), "m", LABEL("static cohesive index"),
      SHOWN(1e6, " µm", 3), .meaning = "mean over the radius of the standard deviation over azimuths of the height", IN_VIEW(600),
      IN_STUDY(230) },

    { "packing", NULL, "solid_fraction", RESULT_REAL, HEAP(solid_fraction), "", LABEL("solid fraction"),
      .meaning = "solid over all that is below the surface, dips between spheres left out: higher than within the heap" },
    { "packing", NULL, "coordination_number", RESULT_REAL, STANDING(coordination_number), "", LABEL("coordination number"),
      .meaning = "contacts a particle of the heap" },
    { "packing", NULL, "tension_share", RESULT_REAL, STANDING(tension_share), "", LABEL("contacts in tension"), SHOWN(100, " %", 3),
      .meaning = "share of the contacts between spheres whose spring and cohesion together pull; null: nothing coheres",
      IN_VIEW(722), IN_STUDY(112) },

    { "heap", NULL, "inside", RESULT_SIZE, STANDING(inside), "", LABEL("in the bed"),
      .meaning = "particles of the heap: with two contacts or more", STORED },
    { "heap", NULL, "apart", RESULT_SIZE, STANDING(in_flight), "", LABEL("apart from it"),
      .meaning = "particles by themselves on the plate, or in flight", STORED },
    { "heap", NULL, "lost", RESULT_SIZE, STANDING(lost), "", LABEL("lost"), .meaning = "particles that fell off the plate",
      IN_VIEW(610), IN_STUDY(240) },
    { "heap", NULL, "at_rest", RESULT_TRUTH, STANDING(at_rest), "", LABEL("at rest"), .meaning = "no angle of repose before it is",
      IN_VIEW(860) },

    FIELDS_OF_RUN("from when filling or lifting began", "that", "while filling or lifting",
                  "at-rest; duration: it was not yet at rest"),
};

static const result_output outputs[] = {
    { "repose", "static angle of repose" }, { "surface", "shape of the heap" }, { "packing", "packing of the heap" },
    { "heap", "where all particles are" },  { "run", "how the run went" },
};

static const char *const other_angles[] = { "apex-to-base", "equal-volume-cone", "silhouette", NULL };

static void describe_words(json_t *properties, const char *output)
{
    if (strcmp(output, "repose") == 0) describe_angle_methods(properties);
    if (strcmp(output, "surface") == 0)
        describe_profile(properties, "profile",
                         "lists over rings: radius (m), height (m, mean over the azimuths) and its standard_error (m)");
}

const result_table heap_result_fields = {
    RESULT_TABLE(fields, outputs),
    .describe_words = describe_words,
    .other_angles = other_angles,
};
