/* Results of `granule`. This file knows nothing of the core, so that the daemon can describe results without it. */
#include "granule_process.h"
#include "granule_result.h"
#include "result_rows.h"

#define SOLVED(member) offsetof(granule_result, solved.member)
#define MOTION(member) offsetof(granule_result, solved.motion.member)
#define HERE(member) offsetof(granule_result, member)
#define RUN(member) offsetof(granule_result, run.member)

static const char *const regimes[] = { "slipping", "raining", "sliding", "centrifuging", NULL };

static const result_field fields[] = {
    { "granule", NULL, "minimum_omega2", RESULT_REAL, SOLVED(minimum_omega2), "", LABEL("least ω²R/g"), SHOWN(1, "", 7),
      .meaning = "least omega^2 R/g at which the particle keeps contact round the cylinder", IN_VIEW(770), LISTED, MAIN,
      IN_STUDY(170), RUN_ERROR("error") },
    { "granule", NULL, "error", RESULT_REAL, SOLVED(error), "", LABEL("within ±"), SHOWN(1, "", 2),
      .meaning = "bound on the error of minimum_omega2", STORED },
    { "granule", NULL, "minimum_rotation_rate", RESULT_REAL, SOLVED(minimum_rotation_rate), "rad/s", LABEL("least rate"),
      SHOWN(1, " rad/s", 7), .meaning = "the same as a rate", IN_VIEW(780), LISTED, IN_STUDY(180) },
    { "granule", NULL, "slip_per_revolution", RESULT_REAL, SOLVED(slip_per_revolution), "rad/revolution", LABEL("slip"),
      SHOWN(1, " rad a revolution", 3), .meaning = "by which the particle lags the wall at that rate", IN_VIEW(790),
      IN_STUDY(190) },
    { "granule", NULL, "slip_onset_deg", RESULT_REAL, HERE(slip_onset_deg), "degrees", LABEL("slips from"),
      SHOWN(1, "° above the horizontal", 3),
      .meaning = "where it begins to slip at that rate, above the horizontal on the rising side", STORED },
    { "granule", "fits", "stationary_eq33", RESULT_REAL, SOLVED(stationary_eq33), "", LABEL("Eq 33"),
      .meaning = "omega^2 R/g above which nothing slips, Eq 33 with tan(angle of repose) = friction" },
    { "granule", "fits", "sliding_eq34", RESULT_REAL, SOLVED(sliding_eq34), "", LABEL("Eq 34"),
      .meaning = "fit of minimum_omega2, Eq 34 (Eq 35 for a bed)" },
    { "granule", "fits", "sliding_eq36", RESULT_REAL, SOLVED(sliding_eq36), "", LABEL("Eqns 36–37"),
      .meaning = "fit of minimum_omega2, Eqns 36-37" },
    { "granule", "deviations", "stationary_eq33", RESULT_REAL, SOLVED(stationary_deviation_eq33), "", LABEL("Eq 33"),
      .meaning = "Eq 33 over minimum_omega2, less 1" },
    { "granule", "deviations", "sliding_eq34", RESULT_REAL, SOLVED(sliding_deviation_eq34), "", LABEL("Eq 34"),
      .meaning = "of Eq 34, likewise" },
    { "granule", "deviations", "sliding_eq36", RESULT_REAL, SOLVED(sliding_deviation_eq36), "", LABEL("Eqns 36–37"),
      .meaning = "of Eqns 36-37, likewise" },

    { "regime", NULL, "name", RESULT_TEXT, HERE(regime), "", .choices = regimes, LABEL("regime"),
      .meaning =
          "slipping: slides back before the horizontal and never goes round; raining: falls off the wall; sliding: goes round, "
          "slipping; centrifuging: never slips; null: no rotation_rate was given" },
    { "regime", NULL, "omega2_outer", RESULT_REAL, MOTION(omega2), "", LABEL("ω²R/g at the wall"),
      .meaning = "omega^2 R/g at the rate given" },
    { "regime", "evidence", "keeps_contact", RESULT_MAYBE, HERE(keeps_contact), "", LABEL("keeps contact"),
      .meaning = "the wall pushes it at all times" },
    { "regime", "evidence", "goes_round", RESULT_MAYBE, HERE(goes_round), "", LABEL("goes round"),
      .meaning = "all the way, in contact" },
    { "regime", "evidence", "revolutions", RESULT_WHOLE, HERE(revolutions), "", LABEL("revolutions followed"),
      .meaning = "completed; fewer than asked for where the motion repeats itself or ends" },
    { "regime", "evidence", "slip_per_revolution", RESULT_REAL, MOTION(slip_per_revolution), "rad/revolution", LABEL("slip"),
      SHOWN(1, " rad a revolution", 3), .meaning = "by which it lags the wall in the last revolution; null: none was completed" },
    { "regime", "evidence", "slip_onset_deg", RESULT_REAL, HERE(motion_slip_onset_deg), "degrees", LABEL("slips from"),
      SHOWN(1, "° above the horizontal", 3),
      .meaning = "where it begins to slip, above the horizontal on the rising side; null: nowhere" },
    { "regime", "evidence", "least_normal_force", RESULT_REAL, MOTION(least_normal_force), "", LABEL("least force on the wall"),
      SHOWN(1, " of the weight", 3), .meaning = "least force between wall and particle, over its weight" },

    { "run", NULL, "particles", RESULT_WHOLE, RUN(particles), "", LABEL("particles"), .meaning = "one" },
    { "run", NULL, "wall_seconds", RESULT_REAL, RUN(wall_seconds), "s", LABEL("wall clock"), .meaning = "time spent" },
    { "run", NULL, "threads", RESULT_WHOLE, RUN(threads), "", LABEL("threads"), .meaning = "threads" },
    { "run", NULL, "attempt", RESULT_WHOLE, RUN(attempt), "", LABEL("attempt"), .meaning = "the attempt that came to the end" },
    RUN_WARNINGS,
};

static const result_output outputs[] = {
    { "granule", "the least rate that keeps the particle on the wall" },
    { "regime", "what becomes of it at the rate given, with the numbers it was told from" },
    { "run", "how the run went" },
};

const result_table granule_result_fields = {
    RESULT_TABLE(fields, outputs),
};
