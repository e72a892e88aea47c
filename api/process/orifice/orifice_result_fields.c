/* Results of `orifice`. This file knows nothing of the core, so that the daemon can describe results without it. */
#include <string.h>

#include "orifice_process.h"
#include "orifice_result.h"
#include "result_rows.h"
#include "standing_result.h"

#define FLOW(member) offsetof(orifice_result, measured.member)
#define RUN(member) offsetof(orifice_result, run.member)

static const result_field fields[] = {
    { "flow", NULL, "mass_rate", RESULT_REAL, FLOW(mass_rate.mean), "kg/s", LABEL("mass flow"), SHOWN(1e3, " g/s", 4),
      .meaning = "mean over the steady part; null: there is none", IN_VIEW(611), LISTED, MAIN, IN_STUDY(251),
      RUN_ERROR("mass_rate_standard_error") },
    { "flow", NULL, "mass_rate_standard_error", RESULT_REAL, FLOW(mass_rate.standard_error), "kg/s", LABEL("its error"),
      SHOWN(1e3, " g/s", 2), .meaning = "error of that mean, from the means of 8 to 20 parts; null: too short a steady part",
      IN_VIEW(612) },
    { "flow", NULL, "number_rate", RESULT_REAL, FLOW(number_rate.mean), "1/s", LABEL("particles a second"),
      SHOWN(1, " a second", 4), .meaning = "likewise", IN_VIEW(613), IN_STUDY(252), RUN_ERROR("number_rate_standard_error") },
    { "flow", NULL, "number_rate_standard_error", RESULT_REAL, FLOW(number_rate.standard_error), "1/s", LABEL("its error"),
      SHOWN(1, " a second", 2), .meaning = "likewise", STORED },
    { "flow", NULL, "number_fluctuation", RESULT_REAL, FLOW(number_fluctuation), "1/s", LABEL("fluctuation"),
      SHOWN(1, " a second", 3),
      .meaning = "standard deviation of the particles a second over intervals of sqrt(D/g), D the diameter or width of the orifice",
      STORED },
    { "flow", NULL, "steady_start", RESULT_REAL, FLOW(steady_start), "s", LABEL("steady from"),
      .meaning = "start of the steady part: 5 sqrt(D/g) after the orifice was opened", STORED },
    { "flow", NULL, "steady_end", RESULT_REAL, FLOW(steady_end), "s", LABEL("to"),
      .meaning = "its end: when the bed over the orifice was 2.5 D high, the flow clogged, or the run ended", STORED },
    { "flow", NULL, "batches", RESULT_WHOLE, FLOW(batches), "", LABEL("parts"), .meaning = "parts that the error was told from" },
    { "flow", NULL, "clogged", RESULT_TRUTH, FLOW(clogged), "", LABEL("clogged"),
      .meaning =
          "whether particles lie over the orifice, at rest, and none left for 10 sqrt(D/g) and for 20 mean times between two",
      IN_VIEW(614), LISTED },
    { "flow", NULL, "clogged_at", RESULT_REAL, FLOW(clogged_at), "s", LABEL("clogged after"),
      .meaning = "when the last one left, from when the orifice was opened; null: not clogged", IN_VIEW(615) },
    { "flow", NULL, "last_left_at", RESULT_REAL, FLOW(last_left_at), "s", LABEL("the last one left after"),
      .meaning = "likewise, clogged or not; null: none left", STORED },
    { "flow", NULL, "passed", RESULT_SIZE, FLOW(passed), "", LABEL("passed"), .meaning = "particles that left by the orifice",
      IN_VIEW(616), IN_STUDY(254) },
    { "flow", NULL, "left", RESULT_SIZE, FLOW(left), "", LABEL("left"), .meaning = "particles that are still in the vessel",
      STORED },
    { "flow", NULL, "passed_mass", RESULT_REAL, FLOW(passed_mass), "kg", LABEL("mass that passed"), SHOWN(1e3, " g", 4),
      .meaning = "of those that left", STORED },
    { "flow", NULL, "at_rest", RESULT_TRUTH, FLOW(at_rest), "", LABEL("at rest"), .meaning = "what is left had come to rest",
      STORED },

    { "drained", NULL, "angle_deg", RESULT_REAL, FLOW(drained_angle_deg[0]), "degrees", LABEL("drained angle"),
      .meaning =
          "slope of what is left on a flat floor: of a line through its surface, from 20 to 80 % of the way from the orifice to "
          "the side, mean over 16 sectors; null: a hopper, or not drained",
      IN_VIEW(617), .view_name = "drained_angle_deg", IN_STUDY(255) },
    { "drained", NULL, "equal_volume_deg", RESULT_REAL, FLOW(drained_angle_deg[1]), "degrees", LABEL("by its volume"),
      .meaning = "of the pit with straight sides from the edge of the orifice up that has the volume below the surface",
      IN_VIEW(618), .view_name = "drained_equal_volume_deg", IN_STUDY(256) },
    { "drained", NULL, "complete", RESULT_TRUTH, FLOW(drained), "", LABEL("drained"),
      .meaning = "nothing that is left could fall through the orifice, and all is at rest", STORED },
    { "drained", NULL, "volume", RESULT_REAL, FLOW(drained_volume), "m3", LABEL("solid volume"), SHOWN(1e6, " cm³", 3),
      .meaning = "of the particles that are left" },

    { "packing", NULL, "solid_fraction", RESULT_REAL, FLOW(solid_fraction), "", LABEL("solid fraction"),
      .meaning = "of the bed before the orifice was opened: two grains off floor and surface, the layer along the side included" },
    { "packing", NULL, "tension_share", RESULT_REAL, FLOW(tension_share), "", LABEL("contacts in tension"), SHOWN(100, " %", 3),
      .meaning = "share of the contacts between spheres whose spring and cohesion together pull, over the steady part; null: "
                 "nothing coheres",
      IN_VIEW(722), IN_STUDY(112) },

    { "outlet", NULL, "solid_fraction", RESULT_REAL, offsetof(orifice_result, outlet_solid_fraction), "", LABEL("solid fraction"),
      .meaning = "in the plane of the orifice, mean over it and over the steady part", IN_VIEW(619),
      .view_name = "outlet_solid_fraction" },
    { "outlet", NULL, "velocity", RESULT_REAL, offsetof(orifice_result, outlet_velocity), "m/s", LABEL("velocity"),
      SHOWN(1, " m/s", 3), .meaning = "downward, likewise; mean over the volume of particles", STORED },

    FIELDS_OF_RUN("from when the orifice was opened", "that", "while it was open",
                  "drained; clogged; duration: particles still left, or moved"),
};

static const result_output outputs[] = {
    { "flow", "flow through the orifice" }, { "drained", "what is left in the vessel" },
    { "packing", "packing of the bed" },    { "outlet", "the flow at the orifice" },
    { "run", "how the run went" },
};

static void describe_words(json_t *properties, const char *output)
{
    if (strcmp(output, "outlet") == 0)
        describe_profile(
            properties, "profile",
            "lists over rings, or over strips on either side of a slot's middle: radius (m), solid_fraction, velocity (m/s)");
}

const result_table orifice_result_fields = {
    RESULT_TABLE(fields, outputs),
    .describe_words = describe_words,
};
