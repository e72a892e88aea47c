/* Rows of the output "run" that fills and heaps have. To be included by a file that defines RUN(member). */
#ifndef RUN_FIELDS_H
#define RUN_FIELDS_H

/* clang-format off */
#define FIELDS_OF_RUN \
    { "run", NULL, "particles", RESULT_WHOLE, RUN(particles), "", "mobile particles, a cluster being one" }, \
    { "run", NULL, "spheres", RESULT_WHOLE, RUN(spheres), "", "spheres that these are made of" }, \
    { "run", NULL, "steps", RESULT_WHOLE, RUN(steps), "", "time steps, settling included" }, \
    { "run", NULL, "time_step", RESULT_REAL, RUN(time_step), "s", "length of a step" }, \
    { "run", NULL, "simulated_seconds", RESULT_REAL, RUN(simulated_seconds), "s", "from when filling or lifting began" }, \
    { "run", NULL, "settling_seconds", RESULT_REAL, RUN(settling_seconds), "s", "simulated before that" }, \
    { "run", NULL, "wall_seconds", RESULT_REAL, RUN(wall_seconds), "s", "time spent, all attempts" }, \
    { "run", NULL, "particle_steps_per_second", RESULT_REAL, RUN(particle_steps_per_second), "1/s", \
      "speed: spheres times steps a second" }, \
    { "run", NULL, "maximum_overlap", RESULT_REAL, RUN(maximum_overlap), "", \
      "largest overlap while filling or lifting, as a share of the smallest diameter" }, \
    { "run", NULL, "stiffness", RESULT_REAL, RUN(stiffness), "N/m", \
      "normal loading stiffness used; hertz-mindlin: the chord up to the largest overlap expected" }, \
    { "run", NULL, "samples", RESULT_WHOLE, RUN(samples), "", "frames of measurement" }, \
    { "run", NULL, "snapshots", RESULT_WHOLE, RUN(snapshots), "", "snapshot files" }, \
    { "run", NULL, "threads", RESULT_WHOLE, RUN(threads), "", "threads" }, \
    { "run", NULL, "isa", RESULT_TEXT, RUN(isa), "", "instruction set of the core: avx512, avx2, plain; results do not depend on it" }, \
    { "run", NULL, "precision", RESULT_TEXT, RUN(precision), "", "of contacts: single or double" }, \
    { "run", NULL, "seed", RESULT_WHOLE, RUN(seed), "", "of the initial positions" }, \
    { "run", NULL, "ended_by", RESULT_TEXT, RUN(ended_by), "", "at-rest; duration: it was not yet at rest" }, \
    { "run", NULL, "attempt", RESULT_WHOLE, RUN(attempt), "", "the attempt that came to the end" }
/* clang-format on */

#endif
