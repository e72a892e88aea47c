/* Results of `drum`. This file knows nothing of the core, so that the daemon can describe results without it. */
#include <string.h>

#include "dem_rules.h"
#include "drum_process.h"
#include "drum_result.h"

#define REPOSE(member) offsetof(drum_result, measured.repose.member)
#define ANGLE(member) offsetof(drum_result, measured.repose.angle[DEM_SURFACE_FIT].member)
#define REGIME(member) offsetof(drum_result, measured.regime.member)
#define SEGREGATION(member) offsetof(drum_result, measured.segregation.member)
#define PACKING(member) offsetof(drum_result, measured.packing.member)
#define DRIVE(member) offsetof(drum_result, measured.drive.member)
#define RUN(member) offsetof(drum_result, run.member)
#define TEXT_OF(number) #number
#define LEAST(number) "; least for a verdict: " TEXT_OF(number)

static const result_field fields[] = {
    { "repose", NULL, "angle_deg", RESULT_REAL, ANGLE(mean_deg), "degrees", "dynamic angle of repose, mean" },
    { "repose", NULL, "standard_error_deg", RESULT_REAL, ANGLE(standard_error_deg), "degrees",
      "error of that mean; null: one run cannot tell (slumping beds)" },
    { "repose", NULL, "minimum_deg", RESULT_REAL, ANGLE(minimum_deg), "degrees", "lowest angle of a frame" },
    { "repose", NULL, "maximum_deg", RESULT_REAL, ANGLE(maximum_deg), "degrees", "highest angle of a frame" },
    { "repose", NULL, "steady", RESULT_MAYBE, offsetof(drum_result, steady), "",
      "the angle neither drifts nor moves by falls; null: nobody can know, for the verdict's reason" },
    { "repose", NULL, "verdict", RESULT_TEXT, offsetof(drum_result, verdict), "",
      "steady; drifting, which includes slumps and avalanches; too-short or too-few (particles, layers) to tell; null: the bed "
      "has no surface" },
    { "repose", NULL, "drift_deg_per_revolution", RESULT_REAL, REPOSE(drift_deg_per_revolution), "degrees",
      "slope of the angle over the window; null: too short to tell" },
    { "repose", NULL, "drift_bound_deg_per_revolution", RESULT_REAL, REPOSE(drift_bound_deg_per_revolution), "degrees",
      "what the size of the drift stays below in 97 of 100 cases; null: too short to tell" },
    { "repose", NULL, "interface_fluctuation", RESULT_REAL, REPOSE(interface_fluctuation), "m",
      "mean over x of the standard deviation in time of the surface's height" },
    { "repose", "window", "start", RESULT_REAL, REPOSE(window_start), "s", "measuring window, from rotation start" },
    { "repose", "window", "end", RESULT_REAL, REPOSE(window_end), "s", "its end" },
    { "repose", "window", "revolutions", RESULT_REAL, REPOSE(window_revolutions), "",
      "turned in it" LEAST(DEM_LEAST_WINDOW_REVOLUTIONS) ", of " TEXT_OF(DEM_LEAST_REVOLUTIONS) " in all; or 3 falls" },
    { "repose", "window", "correlation_times", RESULT_REAL, REPOSE(correlation_times), "",
      "of the angle that it is long" LEAST(DEM_LEAST_CORRELATION_TIMES) },
    { "repose", NULL, "correlation_time", RESULT_REAL, REPOSE(correlation_time), "s", "of the angle" },
    { "repose", NULL, "frames", RESULT_SIZE, REPOSE(frames), "", "frames in the window" LEAST(DEM_LEAST_WINDOW_FRAMES) },
    { "repose", NULL, "layers", RESULT_REAL, REPOSE(layers), "",
      "depth of the bed at mid-chord, in mean diameters" LEAST(DEM_LEAST_LAYERS) ", and " TEXT_OF(
          DEM_LEAST_PARTICLES) " particles" },
    { "repose", "slumps", "count", RESULT_WHOLE, REPOSE(slumps.count), "",
      "slumps or avalanches seen from beginning to end; null, as all below, where the bed flows all the time" },
    { "repose", "slumps", "period", RESULT_REAL, REPOSE(slumps.period.mean), "s", "from one beginning to the next, mean" },
    { "repose", "slumps", "period_standard_error", RESULT_REAL, REPOSE(slumps.period.standard_error), "s", "its error" },
    { "repose", "slumps", "start_deg", RESULT_REAL, REPOSE(slumps.start_deg.mean), "degrees",
      "direction of the centre of mass where they begin, mean" },
    { "repose", "slumps", "start_standard_error_deg", RESULT_REAL, REPOSE(slumps.start_deg.standard_error), "degrees",
      "its error; null, as the next two, where the bed slides as a block, so that another bed differs by more" },
    { "repose", "slumps", "stop_deg", RESULT_REAL, REPOSE(slumps.stop_deg.mean), "degrees", "the same where they end" },
    { "repose", "slumps", "stop_standard_error_deg", RESULT_REAL, REPOSE(slumps.stop_deg.standard_error), "degrees", "its error" },
    { "repose", "slumps", "size_deg", RESULT_REAL, REPOSE(slumps.size_deg.mean), "degrees", "start less stop, mean" },
    { "repose", "slumps", "size_standard_error_deg", RESULT_REAL, REPOSE(slumps.size_deg.standard_error), "degrees", "its error" },

    { "regime", NULL, "certain", RESULT_MAYBE, offsetof(drum_result, certain), "",
      "told alike from either half of a window that is long enough, of a bed of enough particles; null: no regime" },
    { "regime", NULL, "omega2_outer", RESULT_REAL, REGIME(omega2_outer), "", "omega^2 R/g at the wall" },
    { "regime", NULL, "omega2_inner", RESULT_REAL, REGIME(omega2_inner), "", "the same at the bed's inner surface" },
    { "regime", "predicted", "stationary_eq33", RESULT_REAL, REGIME(predicted_stationary), "",
      "omega2_inner above which the bed stays on the wall, 1/sin(angle)" },
    { "regime", "predicted", "sliding_eq35", RESULT_REAL, REGIME(predicted_sliding_eq35), "", "boundary of sliding" },
    { "regime", "predicted", "sliding_eq36", RESULT_REAL, REGIME(predicted_sliding_eq36), "", "boundary of sliding, Eqns 36-37" },
    { "regime", "evidence", "wall_slip", RESULT_REAL, REGIME(wall_slip), "", "1 - spin of the outermost layer / spin of the drum" },
    { "regime", "evidence", "wall_slip_fluctuation", RESULT_REAL, REGIME(wall_slip_fluctuation), "",
      "its standard deviation in time" },
    { "regime", "evidence", "angle_fluctuation_deg", RESULT_REAL, REGIME(angle_fluctuation_deg), "degrees",
      "standard deviation in time of the direction of the centre of mass" },
    { "regime", "evidence", "flow_fluctuation", RESULT_REAL, REGIME(flow_fluctuation), "",
      "standard deviation over mean of the surface flow at mid-chord" },
    { "regime", "evidence", "airborne_fraction", RESULT_REAL, REGIME(airborne_fraction), "",
      "share of particles in flight: no contact, 3 diameters above the chord of the fill" },
    { "regime", "evidence", "wall_coverage", RESULT_REAL, REGIME(wall_coverage), "",
      "share of the wall's circumference with particles against it" },
    { "regime", "evidence", "curvature_deg", RESULT_REAL, REGIME(curvature_deg), "degrees", "upper less lower half of the chord" },
    { "regime", "evidence", "fallen_fraction", RESULT_REAL, REGIME(fallen_fraction), "",
      "share of particles lately nearer the axis than the bed's inner surface less 2 diameters" },
    { "regime", "evidence", "surface_lag", RESULT_REAL, REGIME(surface_lag), "rad/revolution",
      "by which the inner surface lags the drum, in the last four revolutions" },

    { "segregation", NULL, "radial_index", RESULT_REAL, SEGREGATION(radial_index), "",
      "mean distance from the axis, largest less smallest species, over the drum's radius; null: one species" },
    { "segregation", NULL, "axial_index", RESULT_REAL, SEGREGATION(axial_index), "", "null: one species" },
    { "segregation", NULL, "lacey_index", RESULT_REAL, SEGREGATION(lacey_index), "",
      "0 segregated, 1 mixed at random; null: one species" },

    { "packing", NULL, "solid_fraction", RESULT_REAL, PACKING(solid_fraction), "", "of the bed's core" },
    { "packing", NULL, "coordination_number", RESULT_REAL, PACKING(coordination_number), "", "contacts a particle" },
    { "packing", NULL, "mean_overlap", RESULT_REAL, PACKING(mean_overlap), "",
      "of contacts between spheres, as a share of the smallest diameter" },
    { "packing", NULL, "overlap_99", RESULT_REAL, PACKING(overlap_99), "", "what 99 of 100 such contacts stay below" },

    { "drive", NULL, "torque", RESULT_REAL, DRIVE(torque.mean), "N m",
      "of the drum on the bed about the axis, for the length simulated, mean" },
    { "drive", NULL, "torque_standard_error", RESULT_REAL, DRIVE(torque.standard_error), "N m", "error of that mean" },
    { "drive", NULL, "weight_torque", RESULT_REAL, DRIVE(weight_torque.mean), "N m",
      "of the bed's weight, m g x of its centre of mass: what a steady drum's torque carries" },
    { "drive", NULL, "weight_torque_standard_error", RESULT_REAL, DRIVE(weight_torque.standard_error), "N m",
      "error of that mean" },
    { "drive", NULL, "torque_number", RESULT_REAL, DRIVE(torque_number), "", "torque over the bed's m g R" },
    { "drive", NULL, "power", RESULT_REAL, DRIVE(power), "W", "torque times rotation rate" },

    { "run", NULL, "particles", RESULT_WHOLE, RUN(particles), "", "mobile particles, a cluster being one" },
    { "run", NULL, "spheres", RESULT_WHOLE, RUN(spheres), "", "spheres that these are made of" },
    { "run", NULL, "steps", RESULT_WHOLE, RUN(steps), "", "time steps, settling included" },
    { "run", NULL, "time_step", RESULT_REAL, RUN(time_step), "s", "length of a step" },
    { "run", NULL, "simulated_seconds", RESULT_REAL, RUN(simulated_seconds), "s", "time of rotation" },
    { "run", NULL, "settling_seconds", RESULT_REAL, RUN(settling_seconds), "s", "simulated before rotation began" },
    { "run", NULL, "wall_seconds", RESULT_REAL, RUN(wall_seconds), "s", "time spent, all attempts" },
    { "run", NULL, "particle_steps_per_second", RESULT_REAL, RUN(particle_steps_per_second), "1/s",
      "speed: spheres times steps a second" },
    { "run", NULL, "maximum_overlap", RESULT_REAL, RUN(maximum_overlap), "",
      "largest overlap while rotating, as a share of the smallest diameter" },
    { "run", NULL, "stiffness", RESULT_REAL, RUN(stiffness), "N/m",
      "normal loading stiffness used; hertz-mindlin: the chord up to the largest overlap expected" },
    { "run", NULL, "fill_fraction", RESULT_REAL, RUN(fill_fraction), "", "as the particles make it" },
    { "run", NULL, "samples", RESULT_WHOLE, RUN(samples), "", "frames of measurement" },
    { "run", NULL, "snapshots", RESULT_WHOLE, RUN(snapshots), "", "snapshot files" },
    { "run", NULL, "threads", RESULT_WHOLE, RUN(threads), "", "threads" },
    { "run", NULL, "isa", RESULT_TEXT, RUN(isa), "",
      "instruction set of the core: avx512, avx2, plain; results do not depend on it" },
    { "run", NULL, "precision", RESULT_TEXT, RUN(precision), "", "of contacts: single or double" },
    { "run", NULL, "seed", RESULT_WHOLE, RUN(seed), "", "of the initial positions" },
    { "run", NULL, "ended_by", RESULT_TEXT, RUN(ended_by), "",
      "duration; standard-error: the angle was steady and known as "
      "well as asked for; at-most-revolutions: it never was" },
    { "run", NULL, "attempt", RESULT_WHOLE, RUN(attempt), "", "the attempt that came to the end" },
};

static const result_output outputs[] = {
    { "repose", "dynamic angle of repose" },
    { "regime", "flow regime, with the numbers it was told from" },
    { "segregation", "segregation of the species" },
    { "packing", "packing of the bed" },
    { "drive", "torque and power that turn the drum" },
    { "run", "how the run went" },
};

/* The members that are words, and the angles by other methods. */
static void describe_words(json_t *properties, const char *output)
{
    if (strcmp(output, "regime") == 0)
        json_object_set_new(properties, "name",
                            json_pack("{s:[s, s], s:s}", "type", "string", "null", "description",
                                      "flow regime; null: too few frames, or no bed, to tell"));
    if (strcmp(output, "repose") != 0) return;
    json_object_set_new(properties, "method",
                        json_pack("{s:s, s:s}", "type", "string", "description", "how angle_deg was measured"));
    json_object_set_new(
        properties, "other_methods",
        json_pack("{s:s, s:s, s:s}", "type", "object", "description", "mean angle by other definitions", "x-unit", "degrees"));
    json_object_set_new(properties, "other_methods_standard_error_deg",
                        json_pack("{s:s, s:s, s:s}", "type", "object", "description", "errors of those", "x-unit", "degrees"));
}

const result_table drum_result_fields = {
    .field = fields,
    .count = sizeof fields / sizeof fields[0],
    .output = outputs,
    .output_count = sizeof outputs / sizeof outputs[0],
    .describe_words = describe_words,
};
