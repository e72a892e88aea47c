/* Words in which rows of results are written, and the rows of the output "run". To be included by a file that defines RUN(member).
 * simulated, began, meanwhile, ended: words for what the process does: what simulated_seconds counts, "rotation began",
 * "while rotating", and the ways in which a run ends. */
#ifndef RESULT_ROWS_H
#define RESULT_ROWS_H

#include "result_fields.h"

/* Words in which rows are written; a row that says any of them is a column. */
#define LABEL(text) .label = (text)
#define SHOWN(by, suffix_, digits_) .factor = (by), .suffix = (suffix_), .digits = (digits_)
#define MAIN .is_main = true
#define STORED .is_stored = true
#define LISTED .is_listed = true
#define IN_VIEW(place) .is_stored = true, .in_view = (place)
#define IN_STUDY(place) .in_study = (place)
#define OVER_BEDS(rule) .over_beds = BEDS_##rule
#define ERROR_OF(name) .over_beds = BEDS_ERROR, .of = (name)
#define AGREED_ON(name) .over_beds = BEDS_AGREED, .of = (name)
#define RUN_ERROR(column) .run_error = (column)

/* clang-format off */
#define FIELDS_OF_RUN(simulated, began, meanwhile, ended) \
    { "run", NULL, "particles", RESULT_WHOLE, RUN(particles), "", \
      LABEL("particles"), OVER_BEDS(ALIKE), .meaning = "mobile particles, a cluster being one; of several beds, in each", \
      IN_VIEW(180) }, \
    { "run", NULL, "spheres", RESULT_WHOLE, RUN(spheres), "", \
      LABEL("spheres"), OVER_BEDS(ALIKE), .meaning = "spheres that these are made of" }, \
    { "run", NULL, "steps", RESULT_WHOLE, RUN(steps), "", \
      LABEL("steps"), OVER_BEDS(SUM), .meaning = "time steps, settling included", \
      IN_VIEW(800) }, \
    { "run", NULL, "time_step", RESULT_REAL, RUN(time_step), "s", \
      LABEL("time step"), OVER_BEDS(ALIKE), SHOWN(1e6, " µs", 3), .meaning = "length of a step", \
      STORED }, \
    { "run", NULL, "simulated_seconds", RESULT_REAL, RUN(simulated_seconds), "s", \
      LABEL("simulated"), .meaning = simulated, \
      IN_VIEW(810) }, \
    { "run", NULL, "settling_seconds", RESULT_REAL, RUN(settling_seconds), "s", \
      LABEL("settling"), .meaning = "simulated before " began }, \
    { "run", NULL, "wall_seconds", RESULT_REAL, RUN(wall_seconds), "s", \
      LABEL("wall clock"), OVER_BEDS(ALIKE), .meaning = "time spent, all attempts, with that of the job that settled the bed, where another did", \
      IN_VIEW(820), LISTED }, \
    { "run", NULL, "particle_steps_per_second", RESULT_REAL, RUN(particle_steps_per_second), "1/s", \
      LABEL("particle steps a second"), OVER_BEDS(SUM), SHOWN(1, "", 3), .meaning = "speed: spheres times steps a second", \
      IN_VIEW(830) }, \
    { "run", NULL, "maximum_overlap", RESULT_REAL, RUN(maximum_overlap), "", \
      LABEL("largest overlap"), OVER_BEDS(LARGEST), SHOWN(100, " % of the smallest diameter", 3), \
      .meaning = "largest overlap " meanwhile ", as a share of the smallest diameter", \
      IN_VIEW(840), MAIN, IN_STUDY(110) }, \
    { "run", NULL, "stiffness", RESULT_REAL, RUN(stiffness), "N/m", \
      LABEL("stiffness"), OVER_BEDS(ALIKE), SHOWN(1, " N/m", 4), \
      .meaning = "normal loading stiffness used; hertz-mindlin: the chord up to the largest overlap expected" }, \
    { "run", NULL, "bond_number", RESULT_REAL, RUN(bond_number), "", LABEL("Bond number"), OVER_BEDS(ALIKE), SHOWN(1, "", 3), \
      .meaning = "largest pull-off between particles over the weight of the mean one; null: they do not cohere" }, \
    { "run", "sizes", "d10", RESULT_REAL, RUN(sizes.d10), "m", LABEL("D10 by volume"), \
      .meaning = "of the particles of a size distribution, that a tenth of their volume is in smaller ones; null, as all below, " \
                 "where there is none", IN_VIEW(890) }, \
    { "run", "sizes", "d50", RESULT_REAL, RUN(sizes.d50), "m", LABEL("D50 by volume"), .meaning = "half of the volume", IN_VIEW(892) }, \
    { "run", "sizes", "d90", RESULT_REAL, RUN(sizes.d90), "m", LABEL("D90 by volume"), .meaning = "nine tenths of it", IN_VIEW(894) }, \
    { "run", "sizes", "number_d10", RESULT_REAL, RUN(sizes.number_d10), "m", LABEL("D10 by number"), \
      .meaning = "the same by number", STORED }, \
    { "run", "sizes", "number_d50", RESULT_REAL, RUN(sizes.number_d50), "m", LABEL("D50 by number"), \
      .meaning = "the same by number", STORED }, \
    { "run", "sizes", "number_d90", RESULT_REAL, RUN(sizes.number_d90), "m", LABEL("D90 by number"), \
      .meaning = "the same by number", STORED }, \
    { "run", "sizes", "sauter_mean", RESULT_REAL, RUN(sizes.sauter_mean), "m", LABEL("Sauter mean"), \
      .meaning = "sum of d^3 over sum of d^2", IN_VIEW(896) }, \
    { "run", "sizes", "smallest", RESULT_REAL, RUN(sizes.smallest), "m", LABEL("smallest"), OVER_BEDS(LEAST), .meaning = "smallest diameter", STORED }, \
    { "run", "sizes", "largest", RESULT_REAL, RUN(sizes.largest), "m", LABEL("largest"), OVER_BEDS(LARGEST), .meaning = "largest diameter", STORED }, \
    { "run", "sizes", "cut_off_below", RESULT_REAL, RUN(sizes.cut_off_below), "", LABEL("cut off below"), SHOWN(100, " %", 3), \
      .meaning = "share of the distribution asked for that is below its minimum; of several the largest", STORED }, \
    { "run", "sizes", "cut_off_above", RESULT_REAL, RUN(sizes.cut_off_above), "", LABEL("cut off above"), SHOWN(100, " %", 3), \
      .meaning = "likewise above its maximum", STORED }, \
    { "run", NULL, "samples", RESULT_WHOLE, RUN(samples), "", \
      LABEL("samples"), OVER_BEDS(SUM), .meaning = "frames of measurement" }, \
    { "run", NULL, "snapshots", RESULT_WHOLE, RUN(snapshots), "", \
      LABEL("snapshots"), OVER_BEDS(SUM), .meaning = "snapshot files" }, \
    { "run", NULL, "threads", RESULT_WHOLE, RUN(threads), "", \
      LABEL("threads"), OVER_BEDS(ALIKE), .meaning = "threads", \
      IN_VIEW(850) }, \
    { "run", NULL, "isa", RESULT_TEXT, RUN(isa), "", \
      LABEL("instruction set"), OVER_BEDS(ALIKE), .meaning = "instruction set of the core: avx512, avx2, plain; results do not depend on it" }, \
    { "run", NULL, "processor", RESULT_TEXT, RUN(processor), "", \
      LABEL("processor"), OVER_BEDS(ALIKE), .meaning = "what the processor calls itself on which it ran; results do not depend on it", \
      STORED }, \
    { "run", NULL, "precision", RESULT_TEXT, RUN(precision), "", \
      LABEL("precision of contacts"), OVER_BEDS(ALIKE), .meaning = "of contacts: single or double" }, \
    { "run", NULL, "seed", RESULT_WHOLE, RUN(seed), "", \
      LABEL("seed"), OVER_BEDS(ALIKE), SHOWN(1, "", 0), .meaning = "of the initial positions", \
      STORED }, \
    { "run", NULL, "ended_by", RESULT_TEXT, RUN(ended_by), "", \
      LABEL("ended"), OVER_BEDS(ALIKE), .meaning = ended }, \
    { "run", NULL, "attempt", RESULT_WHOLE, RUN(attempt), "", \
      LABEL("attempt"), OVER_BEDS(ALIKE), .meaning = "the attempt that came to the end" }, \
    { "run", NULL, "settled_by", RESULT_TEXT, RUN(settled_by), "", \
      LABEL("bed settled by"), OVER_BEDS(ALIKE), .meaning = "id of the job of the same study that settled the bed for this one, too; null: it did so itself", \
      STORED }, \
    RUN_WARNINGS

#define RUN_WARNINGS \
    { "run", NULL, "warnings", RESULT_WARNINGS, 0, "", \
      .meaning = "what the run knows of itself and its numbers do not show at a glance", \
      IN_VIEW(870), LISTED, IN_STUDY(5) }
/* clang-format on */

#endif
