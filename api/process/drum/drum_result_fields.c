/* Results of `drum`. This file knows nothing of the core, so that the daemon can describe results without it. */
#include <string.h>

#include "dem_rules.h"
#include "drum_process.h"
#include "drum_result.h"
#include "result_rows.h"
#include "standing_result.h"

#define REPOSE(member) offsetof(drum_result, measured.repose.member)
#define ANGLE(member) offsetof(drum_result, measured.repose.angle[DEM_SURFACE_FIT].member)
#define REGIME(member) offsetof(drum_result, measured.regime.member)
#define SEGREGATION(member) offsetof(drum_result, measured.segregation.member)
#define PACKING(member) offsetof(drum_result, measured.packing.member)
#define DRIVE(member) offsetof(drum_result, measured.drive.member)
#define RUN(member) offsetof(drum_result, run.member)
#define TEXT_OF(number) #number
#define LEAST(number) "; least for a verdict: " TEXT_OF(number)

const char *const drum_verdicts[] = { "steady", "drifting", "too-short", "too-few", NULL };

static const result_field fields[] = {
    { "repose", NULL, "angle_deg", RESULT_REAL, ANGLE(mean_deg), "degrees", LABEL("angle of repose"),
      .meaning = "dynamic angle of repose, mean", IN_VIEW(400), LISTED, MAIN, IN_STUDY(10), RUN_ERROR("standard_error_deg") },
    { "repose", NULL, "standard_error_deg", RESULT_REAL, ANGLE(standard_error_deg), "degrees", LABEL("its error"), SHOWN(1, "°", 2),
      ERROR_OF("angle_deg"), .meaning = "error of that mean; null: one run cannot tell (slumping beds)", IN_VIEW(410), LISTED },
    { "repose", NULL, "minimum_deg", RESULT_REAL, ANGLE(minimum_deg), "degrees", LABEL("lowest angle"), OVER_BEDS(LEAST),
      .meaning = "lowest angle of a frame", IN_VIEW(420), IN_STUDY(20) },
    { "repose", NULL, "maximum_deg", RESULT_REAL, ANGLE(maximum_deg), "degrees", LABEL("highest angle"), OVER_BEDS(LARGEST),
      .meaning = "highest angle of a frame", IN_VIEW(430), MAIN, IN_STUDY(30) },
    { "repose", NULL, "steady", RESULT_MAYBE, offsetof(drum_result, steady), "", LABEL("steady"), OVER_BEDS(TOGETHER),
      .meaning = "the angle neither drifts nor moves by falls; null: nobody can know, for the verdict's reason", IN_VIEW(440),
      LISTED, IN_STUDY(4) },
    { "repose", NULL, "verdict", RESULT_TEXT, offsetof(drum_result, verdict), "", LABEL("verdict"), OVER_BEDS(TOGETHER),
      .meaning =
          "steady; drifting, which includes slumps and avalanches; too-short or too-few (particles, layers) to tell; null: the bed "
          "has no surface",
      .choices = drum_verdicts, IN_VIEW(450), LISTED, IN_STUDY(3) },
    { "repose", NULL, "drift_deg_per_revolution", RESULT_REAL, REPOSE(drift_deg_per_revolution), "degrees", LABEL("drift"),
      SHOWN(1, "° a revolution", 2), OVER_BEDS(TOGETHER), .meaning = "slope of the angle over the window; null: too short to tell",
      IN_VIEW(460), IN_STUDY(40) },
    { "repose", NULL, "drift_bound_deg_per_revolution", RESULT_REAL, REPOSE(drift_bound_deg_per_revolution), "degrees",
      LABEL("drift at most"), SHOWN(1, "° a revolution", 2), OVER_BEDS(TOGETHER),
      .meaning = "what the size of the drift stays below in 97 of 100 cases; null: too short to tell", IN_VIEW(470) },
    { "repose", NULL, "interface_fluctuation", RESULT_REAL, REPOSE(interface_fluctuation), "m",
      LABEL("fluctuation of the interface"), SHOWN(1e6, " µm", 3),
      .meaning = "mean over x of the standard deviation in time of the surface's height", IN_VIEW(490), IN_STUDY(50) },
    { "repose", NULL, "dynamic_cohesive_index", RESULT_REAL, REPOSE(interface_fluctuation), "m", LABEL("dynamic cohesive index"),
      SHOWN(1e6, " µm", 3),
      .meaning =
          "the fluctuation of the interface as a GranuDrum reports it (ASTM D8648): the same number as interface_fluctuation",
      IN_VIEW(492) },
    { "repose", "window", "start", RESULT_REAL, REPOSE(window_start), "s", LABEL("measured from"), SHOWN(1, " s", 3),
      .meaning = "measuring window, from rotation start" },
    { "repose", "window", "end", RESULT_REAL, REPOSE(window_end), "s", LABEL("measured to"), SHOWN(1, " s", 3),
      .meaning = "its end" },
    { "repose", "window", "revolutions", RESULT_REAL, REPOSE(window_revolutions), "", LABEL("revolutions measured"),
      .meaning = "turned in it" LEAST(DEM_LEAST_WINDOW_REVOLUTIONS) ", of " TEXT_OF(DEM_LEAST_REVOLUTIONS) " in all; or 3 falls",
      IN_VIEW(472) },
    { "repose", "window", "correlation_times", RESULT_REAL, REPOSE(correlation_times), "", LABEL("correlation times measured"),
      OVER_BEDS(SUM), .meaning = "of the angle that it is long" LEAST(DEM_LEAST_CORRELATION_TIMES), IN_VIEW(474) },
    { "repose", NULL, "correlation_time", RESULT_REAL, REPOSE(correlation_time), "s", LABEL("correlation time"), SHOWN(1, " s", 3),
      .meaning = "of the angle" },
    { "repose", NULL, "frames", RESULT_SIZE, REPOSE(frames), "", LABEL("frames in the window"), OVER_BEDS(SUM),
      .meaning = "frames in the window" LEAST(DEM_LEAST_WINDOW_FRAMES) },
    { "repose", NULL, "layers", RESULT_REAL, REPOSE(layers), "", LABEL("bed, in particle diameters deep"),
      .meaning = "depth of the bed at mid-chord, in mean diameters" LEAST(DEM_LEAST_LAYERS) ", and " TEXT_OF(
          DEM_LEAST_PARTICLES) " particles",
      IN_VIEW(480) },
    { "repose", "slumps", "count", RESULT_WHOLE, REPOSE(slumps.count), "", LABEL("seen from beginning to end"), OVER_BEDS(SUM),
      .meaning = "slumps or avalanches seen from beginning to end; null, as all below, where the bed flows all the time",
      IN_VIEW(500) },
    { "repose", "slumps", "period", RESULT_REAL, REPOSE(slumps.period.mean), "s", LABEL("period of slumps"), SHOWN(1, " s", 3),
      .meaning = "from one beginning to the next, mean", IN_VIEW(510), MAIN, IN_STUDY(140) },
    { "repose", "slumps", "period_standard_error", RESULT_REAL, REPOSE(slumps.period.standard_error), "s", LABEL("its error"),
      SHOWN(1, " s", 3), ERROR_OF("period"), .meaning = "its error" },
    { "repose", "slumps", "start_deg", RESULT_REAL, REPOSE(slumps.start_deg.mean), "degrees", LABEL("they begin at"),
      .meaning = "direction of the centre of mass where they begin, mean", IN_VIEW(520), IN_STUDY(150) },
    { "repose", "slumps", "start_standard_error_deg", RESULT_REAL, REPOSE(slumps.start_deg.standard_error), "degrees",
      LABEL("its error"), SHOWN(1, "°", 2), ERROR_OF("start_deg"),
      .meaning = "its error; null, as the next two, where the bed slides as a block, so that another bed differs by more" },
    { "repose", "slumps", "stop_deg", RESULT_REAL, REPOSE(slumps.stop_deg.mean), "degrees", LABEL("they end at"),
      .meaning = "the same where they end", IN_VIEW(530), IN_STUDY(160) },
    { "repose", "slumps", "stop_standard_error_deg", RESULT_REAL, REPOSE(slumps.stop_deg.standard_error), "degrees",
      LABEL("its error"), SHOWN(1, "°", 2), ERROR_OF("stop_deg"), .meaning = "its error" },
    { "repose", "slumps", "size_deg", RESULT_REAL, REPOSE(slumps.size_deg.mean), "degrees", LABEL("size"),
      .meaning = "start less stop, mean", STORED },
    { "repose", "slumps", "size_standard_error_deg", RESULT_REAL, REPOSE(slumps.size_deg.standard_error), "degrees",
      LABEL("its error"), SHOWN(1, "°", 2), ERROR_OF("size_deg"), .meaning = "its error" },
    { "repose", NULL, "hysteresis_deg", RESULT_REAL, REPOSE(slumps.hysteresis_deg), "degrees", LABEL("hysteresis"),
      OVER_BEDS(LARGEST),
      .meaning = "largest less smallest of the angles that slumps start and stop at; null: none was seen from beginning to end",
      IN_VIEW(880), IN_STUDY(250) },
    { "repose", NULL, "method", RESULT_WORD, offsetof(drum_result, method), "", LABEL("definition"), OVER_BEDS(ALIKE),
      .meaning = "how angle_deg was measured", IN_VIEW(405), .view_name = "angle_definition" },

    { "regime", NULL, "certain", RESULT_MAYBE, offsetof(drum_result, certain), "", LABEL("certain"), AGREED_ON("name"),
      .meaning = "told alike from either half of a window that is long enough, of a bed of enough particles; null: no regime",
      IN_VIEW(630), LISTED, IN_STUDY(2) },
    { "regime", NULL, "omega2_outer", RESULT_REAL, REGIME(omega2_outer), "", LABEL("ω²R/g at the wall"),
      .meaning = "omega^2 R/g at the wall", IN_VIEW(640) },
    { "regime", NULL, "omega2_inner", RESULT_REAL, REGIME(omega2_inner), "", LABEL("ω²R/g at the inner surface"),
      .meaning = "the same at the bed's inner surface", IN_VIEW(650) },
    { "regime", "predicted", "stationary_eq33", RESULT_REAL, REGIME(predicted_stationary), "",
      LABEL("stationary on the wall, Eq 33"), .meaning = "omega2_inner above which the bed stays on the wall, 1/sin(angle)" },
    { "regime", "predicted", "sliding_eq35", RESULT_REAL, REGIME(predicted_sliding_eq35), "", LABEL("sliding, Eq 35"),
      .meaning = "boundary of sliding" },
    { "regime", "predicted", "sliding_eq36", RESULT_REAL, REGIME(predicted_sliding_eq36), "", LABEL("sliding, Eqns 36–37"),
      .meaning = "boundary of sliding, Eqns 36-37" },
    { "regime", "evidence", "wall_slip", RESULT_REAL, REGIME(wall_slip), "", LABEL("slip at the wall"),
      .meaning = "1 - spin of the outermost layer / spin of the drum" },
    { "regime", "evidence", "wall_slip_fluctuation", RESULT_REAL, REGIME(wall_slip_fluctuation), "",
      LABEL("fluctuation of the slip at the wall"), .meaning = "its standard deviation in time" },
    { "regime", "evidence", "angle_fluctuation_deg", RESULT_REAL, REGIME(angle_fluctuation_deg), "degrees",
      LABEL("fluctuation of the angle"), .meaning = "standard deviation in time of the direction of the centre of mass" },
    { "regime", "evidence", "flow_fluctuation", RESULT_REAL, REGIME(flow_fluctuation), "", LABEL("fluctuation of the surface flow"),
      .meaning = "standard deviation over mean of the surface flow at mid-chord" },
    { "regime", "evidence", "airborne_fraction", RESULT_REAL, REGIME(airborne_fraction), "", LABEL("airborne"), SHOWN(100, " %", 3),
      .meaning = "share of particles in flight: no contact, 3 diameters above the chord of the fill" },
    { "regime", "evidence", "wall_coverage", RESULT_REAL, REGIME(wall_coverage), "", LABEL("wall covered"), SHOWN(100, " %", 3),
      .meaning = "share of the wall's circumference with particles against it" },
    { "regime", "evidence", "curvature_deg", RESULT_REAL, REGIME(curvature_deg), "degrees",
      LABEL("upper less lower half of the chord"), .meaning = "upper less lower half of the chord" },
    { "regime", "evidence", "fallen_fraction", RESULT_REAL, REGIME(fallen_fraction), "", LABEL("lately fallen"),
      SHOWN(100, " %", 3), .meaning = "share of particles lately nearer the axis than the bed's inner surface less 2 diameters" },
    { "regime", "evidence", "surface_lag", RESULT_REAL, REGIME(surface_lag), "rad/revolution", LABEL("inner surface lags by"),
      SHOWN(1, " rad a revolution", 3), .meaning = "by which the inner surface lags the drum, in the last four revolutions" },
    { "regime", NULL, "name", RESULT_TEXT, offsetof(drum_result, regime), "", LABEL("regime"), OVER_BEDS(VOTE),
      .meaning = "flow regime; null: too few frames, or no bed, to tell", IN_VIEW(620), .view_name = "regime", LISTED,
      IN_STUDY(1) },

    { "segregation", NULL, "radial_index", RESULT_REAL, SEGREGATION(radial_index), "", LABEL("radial index"),
      .meaning = "mean distance from the axis, largest less smallest species, over the drum's radius; null: one species",
      IN_VIEW(660), MAIN, IN_STUDY(60) },
    { "segregation", NULL, "axial_index", RESULT_REAL, SEGREGATION(axial_index), "", LABEL("axial index"),
      .meaning = "null: one species", IN_VIEW(670), IN_STUDY(70) },
    { "segregation", NULL, "lacey_index", RESULT_REAL, SEGREGATION(lacey_index), "", LABEL("Lacey index"),
      .meaning = "0 segregated, 1 mixed at random; null: one species", IN_VIEW(680), MAIN, IN_STUDY(80) },

    { "packing", NULL, "solid_fraction", RESULT_REAL, PACKING(solid_fraction), "", LABEL("solid fraction"),
      .meaning = "of the bed's core", IN_VIEW(690), MAIN, IN_STUDY(90) },
    { "packing", NULL, "coordination_number", RESULT_REAL, PACKING(coordination_number), "", LABEL("coordination number"),
      .meaning = "contacts a particle", IN_VIEW(700), IN_STUDY(100) },
    { "packing", NULL, "mean_overlap", RESULT_REAL, PACKING(mean_overlap), "", LABEL("mean overlap"),
      SHOWN(100, " % of the smallest diameter", 3), .meaning = "of contacts between spheres, as a share of the smallest diameter",
      IN_VIEW(710) },
    { "packing", NULL, "overlap_99", RESULT_REAL, PACKING(overlap_99), "", LABEL("99 of 100 overlaps below"),
      SHOWN(100, " % of the smallest diameter", 3), .meaning = "what 99 of 100 such contacts stay below", IN_VIEW(720) },
    { "packing", NULL, "tension_share", RESULT_REAL, PACKING(tension_share), "", LABEL("contacts in tension"), SHOWN(100, " %", 3),
      .meaning = "share of the contacts between spheres whose spring and cohesion together pull; null: nothing coheres",
      IN_VIEW(722), IN_STUDY(112) },

    { "drive", NULL, "torque", RESULT_REAL, DRIVE(torque.mean), "N m", LABEL("torque"),
      .meaning = "of the drum on the bed about the axis, for the length simulated, mean", IN_VIEW(730), MAIN, IN_STUDY(120),
      RUN_ERROR("torque_standard_error") },
    { "drive", NULL, "torque_standard_error", RESULT_REAL, DRIVE(torque.standard_error), "N m", LABEL("its error"),
      ERROR_OF("torque"), .meaning = "error of that mean", IN_VIEW(740) },
    { "drive", NULL, "weight_torque", RESULT_REAL, DRIVE(weight_torque.mean), "N m", LABEL("torque of the bed’s weight"),
      .meaning = "of the bed's weight, m g x of its centre of mass: what a steady drum's torque carries", STORED },
    { "drive", NULL, "weight_torque_standard_error", RESULT_REAL, DRIVE(weight_torque.standard_error), "N m", LABEL("its error"),
      ERROR_OF("weight_torque"), .meaning = "error of that mean", STORED },
    { "drive", NULL, "torque_number", RESULT_REAL, DRIVE(torque_number), "", LABEL("torque over m g R"), SHOWN(1, "", 3),
      .meaning = "torque over the bed's m g R", IN_VIEW(750) },
    { "drive", NULL, "power", RESULT_REAL, DRIVE(power), "W", LABEL("power"), .meaning = "torque times rotation rate", IN_VIEW(760),
      IN_STUDY(130) },

    FIELDS_OF_RUN("time of rotation", "rotation began", "while rotating",
                  "duration; standard-error: the angle was steady and known as well as asked for; at-most-revolutions: it "
                  "never was"),
    { "run", NULL, "fill_fraction", RESULT_REAL, RUN(fill_fraction), "", LABEL("fill fraction"), SHOWN(100, " %", 3),
      OVER_BEDS(ALIKE), .meaning = "as the particles make it" },
};

static const result_output outputs[] = {
    { "repose", "dynamic angle of repose" },
    { "regime", "flow regime, with the numbers it was told from" },
    { "segregation", "segregation of the species" },
    { "packing", "packing of the bed" },
    { "drive", "torque and power that turn the drum" },
    { "stages",
      "each stage of the drum's rotation, as if it were a run of its own; empty where it turns at one rate. All else in the "
      "results is of the last stage that turns" },
    { "run", "how the run went" },
};

static const char *const other_angles[] = { "center-of-mass", "chord", "theil-sen", "upper-chord", "lower-chord", NULL };

static const char *const of_each_bed[] = { "angle_deg", "standard_error_deg", "verdict", NULL };

/* Each with its times and angles. */
static void describe_slumps(json_t *properties)
{
    json_t *number = json_pack("{s:s}", "type", "number");
    json_t *slumps = json_object();
    json_object_set_new(properties, "slumps", json_pack("{s:s, s:O}", "type", "object", "properties", slumps));
    json_object_set_new(
        slumps, "events",
        json_pack("{s:[ss], s:s, s:s, s:{s:s, s:[ssss], s:b, s:{s:O, s:O, s:O, s:O}}}", "type", "array", "null", "title",
                  "each slump", "description",
                  "one by one, in order: start and stop in s since rotation began, and the angles then; of several beds "
                  "those of the first; null where count is, and in a drum of several stages",
                  "items", "type", "object", "required", "start", "stop", "start_deg", "stop_deg", "additionalProperties", 0,
                  "properties", "start", number, "stop", number, "start_deg", number, "stop_deg", number));
    json_decref(number);
    json_decref(slumps);
}

static void describe_words(json_t *properties, const char *output)
{
    if (strcmp(output, "repose") != 0) return;
    describe_angle_methods(properties);
    describe_slumps(properties);
    describe_profile(
        properties, "interface",
        "mean height (m) of the bed's surface over x (m), in a drum that turns counter-clockwise, with its standard_error");
}

const result_table drum_result_fields = {
    RESULT_TABLE(fields, outputs), .of_each_bed = of_each_bed,   .describe_words = describe_words, .list = "stages",
    .entries = &drum_stage_fields, .other_angles = other_angles,
};
