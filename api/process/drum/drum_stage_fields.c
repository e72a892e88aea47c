/* What each entry of the list of stages has. */
#include "drum_process.h"
#include "drum_result.h"
#include "result_rows.h"

#define STAGE(member) offsetof(drum_stage_result, member)
#define ANGLE(method, member) offsetof(drum_stage_result, measured.repose.angle[method].member)

static const result_field fields[] = {
    { "stages", NULL, "rate", RESULT_REAL, STAGE(rate), "rad/s", .meaning = "rate of rotation, as asked for" },
    { "stages", NULL, "from", RESULT_REAL, STAGE(begins), "s", .meaning = "when it began, since rotation began",
      .view_name = "begins" },
    { "stages", NULL, "to", RESULT_REAL, STAGE(ends), "s", .meaning = "when it ended", .view_name = "ends" },
    { "stages", NULL, "angle_deg", RESULT_REAL, ANGLE(DEM_SURFACE_FIT, mean_deg), "degrees",
      .meaning = "angle of repose, mean; positive where the surface rises the way that the drum turns, or, at rest, last turned" },
    { "stages", NULL, "standard_error_deg", RESULT_REAL, ANGLE(DEM_SURFACE_FIT, standard_error_deg), "degrees",
      .meaning = "error of that mean; null: one run cannot tell (slumping beds, and beds at rest)" },
    { "stages", NULL, "minimum_deg", RESULT_REAL, ANGLE(DEM_SURFACE_FIT, minimum_deg), "degrees",
      .meaning = "lowest angle of a frame" },
    { "stages", NULL, "maximum_deg", RESULT_REAL, ANGLE(DEM_SURFACE_FIT, maximum_deg), "degrees",
      .meaning = "highest angle of a frame" },
    { "stages", NULL, "chord_deg", RESULT_REAL, ANGLE(DEM_CHORD, mean_deg), "degrees",
      .meaning = "the same from the mean interface between -D/10 and D/10" },
    { "stages", NULL, "chord_standard_error_deg", RESULT_REAL, ANGLE(DEM_CHORD, standard_error_deg), "degrees",
      .meaning = "its error" },
    { "stages", NULL, "center_of_mass_deg", RESULT_REAL, ANGLE(DEM_CENTER_OF_MASS, mean_deg), "degrees",
      .meaning = "the same of the direction of the centre of mass" },
    { "stages", NULL, "center_of_mass_standard_error_deg", RESULT_REAL, ANGLE(DEM_CENTER_OF_MASS, standard_error_deg), "degrees",
      .meaning = "its error" },
    { "stages", NULL, "interface_fluctuation", RESULT_REAL, STAGE(measured.repose.interface_fluctuation), "m",
      .meaning = "mean over x of the standard deviation in time of the surface's height" },
    { "stages", NULL, "verdict", RESULT_TEXT, STAGE(verdict), "", .meaning = "as in repose; null: at rest, or without a surface",
      .choices = drum_verdicts },
    { "stages", NULL, "steady", RESULT_MAYBE, STAGE(steady), "", .meaning = "as in repose" },
    { "stages", NULL, "regime", RESULT_TEXT, STAGE(regime), "",
      .meaning = "flow regime; null: at rest, too few frames, or a bed all around the wall" },
    { "stages", NULL, "certain", RESULT_MAYBE, STAGE(certain), "", .meaning = "of the regime, as there" },
    { "stages", NULL, "torque", RESULT_REAL, STAGE(measured.drive.torque.mean), "N m",
      .meaning = "of the drum on the bed, mean; positive the way that it turns" },
    { "stages", NULL, "torque_standard_error", RESULT_REAL, STAGE(measured.drive.torque.standard_error), "N m",
      .meaning = "error of that mean" },
    { "stages", NULL, "window_start", RESULT_REAL, STAGE(measured.repose.window_start), "s",
      .meaning = "measured from, since rotation began" },
    { "stages", NULL, "window_end", RESULT_REAL, STAGE(measured.repose.window_end), "s", .meaning = "measured to" },
    { "stages", NULL, "frames", RESULT_SIZE, STAGE(measured.repose.frames), "", .meaning = "frames in that window" },
};

const result_table drum_stage_fields = { .field = fields, .count = sizeof fields / sizeof fields[0] };
