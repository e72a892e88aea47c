/* How a run went: the output "run" of every process. */
#ifndef RUN_FACTS_H
#define RUN_FACTS_H

/* How the run went; NaN where unknown. Counts are doubles, as in the inputs: all fit exactly. */
typedef struct run_facts {
    double particles, spheres, steps, time_step; /* steps: since creation, settling included; s */
    double simulated_seconds;                    /* s of rotation */
    double settling_seconds;                     /* s simulated before rotation began */
    double wall_seconds;                         /* s, of all attempts */
    double particle_steps_per_second;
    double maximum_overlap; /* while rotating, share of the smallest diameter */
    double stiffness;       /* N/m */
    double fill_fraction;
    double bond_number; /* NaN: particles do not cohere */
    struct {
        double d10, d50, d90, number_d10, number_d50, number_d90, sauter_mean, smallest, largest, cut_off_below, cut_off_above;
    } sizes; /* m, of all particles, where a species has a size distribution; shares of it that are cut off */
    double samples, snapshots;
    double threads, seed, attempt;
    const char *isa, *precision; /* of the program that ran: "avx512", "avx2" or "plain"; "single" or "double" */
    const char *processor;       /* as it calls itself */
    const char *settled_by;      /* id of the job that settled the bed; NULL: this one */
    const char *ended_by;        /* "duration", "standard-error" or "at-most-revolutions" */
} run_facts;

#endif
