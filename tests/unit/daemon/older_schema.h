/* The tables of inputs and results as migrations made them up to version 12, each before the rest of its version. Not to be
 * changed: databases of that time are so. */
#ifndef OLDER_SCHEMA_H
#define OLDER_SCHEMA_H

#include <stddef.h>

#include "schema.h"

static const char older_inputs[] =
    "CREATE TABLE drum_input("
    "  job INTEGER PRIMARY KEY REFERENCES job(number) ON DELETE CASCADE,"
    "  drum_diameter REAL NOT NULL, drum_length REAL NOT NULL, rotation_rate REAL NOT NULL, gravity REAL NOT NULL,"
    "  fill_fraction REAL NOT NULL, particles INTEGER NOT NULL, species INTEGER NOT NULL,"
    "  diameter REAL NOT NULL, density REAL NOT NULL," /* of the first species */
    "  friction REAL NOT NULL, restitution REAL NOT NULL, wall_friction REAL NOT NULL,"
    "  tangential_stiffness_ratio REAL NOT NULL, stiffness REAL NOT NULL, lining_diameter REAL NOT NULL,"
    "  time_step REAL NOT NULL, duration REAL NOT NULL, seed INTEGER NOT NULL"
    ") STRICT;";

static const char older_results[] =
    "CREATE TABLE repose_result("
    "  job INTEGER PRIMARY KEY REFERENCES job(number) ON DELETE CASCADE,"
    "  angle_deg REAL, standard_error_deg REAL, minimum_deg REAL, maximum_deg REAL, steady INTEGER,"
    "  drift_deg_per_revolution REAL, method TEXT, interface_fluctuation REAL) STRICT;"
    "CREATE TABLE regime_result("
    "  job INTEGER PRIMARY KEY REFERENCES job(number) ON DELETE CASCADE,"
    "  name TEXT, omega2_outer REAL, omega2_inner REAL) STRICT;"
    "CREATE TABLE segregation_result("
    "  job INTEGER PRIMARY KEY REFERENCES job(number) ON DELETE CASCADE,"
    "  radial_index REAL, axial_index REAL, lacey_index REAL) STRICT;"
    "CREATE TABLE packing_result("
    "  job INTEGER PRIMARY KEY REFERENCES job(number) ON DELETE CASCADE,"
    "  solid_fraction REAL, coordination_number REAL) STRICT;"
    "CREATE TABLE run_result("
    "  job INTEGER PRIMARY KEY REFERENCES job(number) ON DELETE CASCADE,"
    "  particles INTEGER, steps INTEGER, time_step REAL, simulated_seconds REAL, wall_seconds REAL,"
    "  particle_steps_per_second REAL, maximum_overlap REAL, threads INTEGER, seed INTEGER) STRICT;"
    /* One row a finished run: its main inputs and results. */
    "CREATE VIEW run_summary AS SELECT"
    "  job.id, job.process, job.label, job.status, job.created, job.started, job.finished, job.attempt,"
    "  i.drum_diameter, i.drum_length, i.rotation_rate, i.gravity, i.fill_fraction, i.particles, i.species, i.diameter,"
    "  i.density, i.friction, i.restitution, i.wall_friction, i.tangential_stiffness_ratio, i.stiffness,"
    "  i.lining_diameter, i.time_step, i.duration, i.seed,"
    "  a.angle_deg, a.standard_error_deg, a.minimum_deg, a.maximum_deg, a.steady, a.drift_deg_per_revolution,"
    "  a.interface_fluctuation, g.name AS regime, g.omega2_outer, g.omega2_inner,"
    "  s.radial_index, s.axial_index, s.lacey_index, p.solid_fraction, p.coordination_number,"
    "  r.steps, r.simulated_seconds, r.wall_seconds, r.particle_steps_per_second, r.maximum_overlap, r.threads"
    " FROM job JOIN run_result r ON r.job=job.number LEFT JOIN drum_input i ON i.job=job.number"
    " LEFT JOIN repose_result a ON a.job=job.number LEFT JOIN regime_result g ON g.job=job.number"
    " LEFT JOIN segregation_result s ON s.job=job.number LEFT JOIN packing_result p ON p.job=job.number"
    " WHERE job.status='successful';";

static const char granule_tables[] =
    "CREATE TABLE granule_input("
    "  job INTEGER PRIMARY KEY REFERENCES job(number) ON DELETE CASCADE,"
    "  friction REAL NOT NULL, radius REAL NOT NULL, rotation_rate REAL," /* null: none was asked about */
    "  revolutions INTEGER NOT NULL, gravity REAL NOT NULL, tolerance REAL NOT NULL) STRICT;"
    "CREATE TABLE granule_result("
    "  job INTEGER PRIMARY KEY REFERENCES job(number) ON DELETE CASCADE,"
    "  minimum_omega2 REAL, error REAL, minimum_rotation_rate REAL, slip_per_revolution REAL, slip_onset_deg REAL) STRICT;";

/* As before, with what a granule has; what both have stands in one column. */
static const char run_summary_with_granule[] =
    "DROP VIEW run_summary;"
    "CREATE VIEW run_summary AS SELECT"
    "  job.id, job.process, job.label, job.status, job.created, job.started, job.finished, job.attempt,"
    "  i.drum_diameter, i.drum_length, coalesce(i.rotation_rate, gi.rotation_rate) AS rotation_rate,"
    "  coalesce(i.gravity, gi.gravity) AS gravity, i.fill_fraction, r.particles, i.species, i.diameter,"
    "  i.density, coalesce(i.friction, gi.friction) AS friction, i.restitution, i.wall_friction,"
    "  i.tangential_stiffness_ratio, i.stiffness, i.lining_diameter, i.time_step, i.duration, i.seed, gi.radius,"
    "  a.angle_deg, a.standard_error_deg, a.minimum_deg, a.maximum_deg, a.steady, a.drift_deg_per_revolution,"
    "  a.interface_fluctuation, g.name AS regime, g.omega2_outer, g.omega2_inner,"
    "  s.radial_index, s.axial_index, s.lacey_index, p.solid_fraction, p.coordination_number,"
    "  gr.minimum_omega2, gr.minimum_rotation_rate, gr.slip_per_revolution,"
    "  r.steps, r.simulated_seconds, r.wall_seconds, r.particle_steps_per_second, r.maximum_overlap, r.threads"
    " FROM job JOIN run_result r ON r.job=job.number LEFT JOIN drum_input i ON i.job=job.number"
    " LEFT JOIN granule_input gi ON gi.job=job.number LEFT JOIN granule_result gr ON gr.job=job.number"
    " LEFT JOIN repose_result a ON a.job=job.number LEFT JOIN regime_result g ON g.job=job.number"
    " LEFT JOIN segregation_result s ON s.job=job.number LEFT JOIN packing_result p ON p.job=job.number"
    " WHERE job.status='successful';";

static const char more_measures[] =
    "ALTER TABLE repose_result ADD COLUMN slumps_count INTEGER;"
    "ALTER TABLE repose_result ADD COLUMN slumps_period REAL;"
    "ALTER TABLE repose_result ADD COLUMN slumps_start_deg REAL;"
    "ALTER TABLE repose_result ADD COLUMN slumps_stop_deg REAL;"
    "ALTER TABLE repose_result ADD COLUMN slumps_size_deg REAL;"
    "ALTER TABLE packing_result ADD COLUMN mean_overlap REAL;"
    "ALTER TABLE packing_result ADD COLUMN overlap_99 REAL;"
    "CREATE TABLE drive_result("
    "  job INTEGER PRIMARY KEY REFERENCES job(number) ON DELETE CASCADE,"
    "  torque REAL, torque_standard_error REAL, weight_torque REAL, weight_torque_standard_error REAL, torque_number REAL,"
    "  power REAL) STRICT;";

/* Jobs from before say in their specification what shape their particles have. */
static const char drums_closed_and_with_lifters[] =
    "ALTER TABLE drum_input ADD COLUMN ends TEXT NOT NULL DEFAULT 'periodic';"
    "ALTER TABLE drum_input ADD COLUMN lifters INTEGER NOT NULL DEFAULT 0;"   /* how many */
    "ALTER TABLE drum_input ADD COLUMN shape TEXT NOT NULL DEFAULT 'sphere';" /* of the first species */
    "ALTER TABLE drum_input ADD COLUMN rolling_friction REAL NOT NULL DEFAULT 0;"
    "ALTER TABLE drum_input ADD COLUMN wall_rolling_friction REAL NOT NULL DEFAULT 0;";

/* What both have in common stands at the end, in the same order. */
#define COLUMNS_OF_A_BED                                                                                                           \
    ", gravity REAL NOT NULL, particles INTEGER NOT NULL, species INTEGER NOT NULL, diameter REAL NOT NULL,"                       \
    "  density REAL NOT NULL, shape TEXT NOT NULL," /* of the first species */                                                     \
    "  friction REAL NOT NULL, restitution REAL NOT NULL, wall_friction REAL NOT NULL,"                                            \
    "  tangential_stiffness_ratio REAL NOT NULL, stiffness REAL NOT NULL, time_step REAL NOT NULL,"                                \
    "  duration REAL NOT NULL, seed INTEGER NOT NULL,"                                                                             \
    "  rolling_friction REAL NOT NULL, wall_rolling_friction REAL NOT NULL"
static const char fill_and_heap_tables[] =
    "CREATE TABLE fill_input("
    "  job INTEGER PRIMARY KEY REFERENCES job(number) ON DELETE CASCADE,"
    "  cylinder_diameter REAL NOT NULL, stream_diameter REAL NOT NULL, rate REAL NOT NULL,"
    "  impact_speed REAL NOT NULL" COLUMNS_OF_A_BED ") STRICT;"
    "CREATE TABLE heap_input("
    "  job INTEGER PRIMARY KEY REFERENCES job(number) ON DELETE CASCADE,"
    "  tube_diameter REAL NOT NULL, lift_speed REAL NOT NULL, plate_diameter REAL NOT NULL, rim_height REAL NOT NULL,"
    "  plate_friction REAL NOT NULL" COLUMNS_OF_A_BED ") STRICT;"
    "CREATE TABLE surface_result("
    "  job INTEGER PRIMARY KEY REFERENCES job(number) ON DELETE CASCADE,"
    "  height REAL, center_height REAL, wall_height REAL, base_diameter REAL, volume REAL, static_cohesive_index REAL) STRICT;"
    "CREATE TABLE fill_result("
    "  job INTEGER PRIMARY KEY REFERENCES job(number) ON DELETE CASCADE,"
    "  inside INTEGER, apart INTEGER, waiting INTEGER, at_rest INTEGER) STRICT;"
    "CREATE TABLE heap_result("
    "  job INTEGER PRIMARY KEY REFERENCES job(number) ON DELETE CASCADE,"
    "  inside INTEGER, apart INTEGER, lost INTEGER, at_rest INTEGER) STRICT;"
    "ALTER TABLE repose_result ADD COLUMN while_filling_angle_deg REAL;"
    "ALTER TABLE repose_result ADD COLUMN while_filling_standard_error_deg REAL;";

/* A row a finished run. Since there were verdicts and warnings these stand where the arguments are, each with its comma. */
#define RUN_SUMMARY(verdict, drift, certain, run)                                                                                  \
    "DROP VIEW run_summary;"                                                                                                       \
    "CREATE VIEW run_summary AS SELECT"                                                                                            \
    "  job.id, job.process, job.label, job.status, job.created, job.started, job.finished, job.attempt,"                           \
    "  i.drum_diameter, i.drum_length, i.ends, i.lifters, coalesce(i.shape, fi.shape, hi.shape) AS shape,"                         \
    "  fi.cylinder_diameter, fi.stream_diameter, fi.rate, fi.impact_speed,"                                                        \
    "  hi.tube_diameter, hi.lift_speed, hi.plate_diameter, hi.rim_height, hi.plate_friction,"                                      \
    "  coalesce(i.rotation_rate, gi.rotation_rate) AS rotation_rate,"                                                              \
    "  coalesce(i.gravity, fi.gravity, hi.gravity, gi.gravity) AS gravity, i.fill_fraction, r.particles,"                          \
    "  coalesce(i.species, fi.species, hi.species) AS species, coalesce(i.diameter, fi.diameter, hi.diameter) AS diameter,"        \
    "  coalesce(i.density, fi.density, hi.density) AS density,"                                                                    \
    "  coalesce(i.friction, fi.friction, hi.friction, gi.friction) AS friction,"                                                   \
    "  coalesce(i.restitution, fi.restitution, hi.restitution) AS restitution,"                                                    \
    "  coalesce(i.wall_friction, fi.wall_friction, hi.wall_friction) AS wall_friction,"                                            \
    "  coalesce(i.rolling_friction, fi.rolling_friction, hi.rolling_friction) AS rolling_friction,"                                \
    "  coalesce(i.wall_rolling_friction, fi.wall_rolling_friction, hi.wall_rolling_friction) AS wall_rolling_friction,"            \
    "  coalesce(i.tangential_stiffness_ratio, fi.tangential_stiffness_ratio, hi.tangential_stiffness_ratio)"                       \
    "   AS tangential_stiffness_ratio,"                                                                                            \
    "  coalesce(i.stiffness, fi.stiffness, hi.stiffness) AS stiffness, i.lining_diameter,"                                         \
    "  coalesce(i.time_step, fi.time_step, hi.time_step) AS time_step,"                                                            \
    "  coalesce(i.duration, fi.duration, hi.duration) AS duration, coalesce(i.seed, fi.seed, hi.seed) AS seed, gi.radius,"         \
    "  a.angle_deg, a.standard_error_deg, a.minimum_deg, a.maximum_deg, a.steady," verdict " a.drift_deg_per_revolution,"          \
    " " drift " a.interface_fluctuation, a.slumps_count, a.slumps_period, a.slumps_start_deg, a.slumps_stop_deg,"                  \
    "  a.while_filling_angle_deg, a.while_filling_standard_error_deg,"                                                             \
    "  f.height, f.center_height, f.wall_height, f.base_diameter, f.static_cohesive_index, hr.lost,"                               \
    "  g.name AS regime," certain " g.omega2_outer, g.omega2_inner,"                                                               \
    "  s.radial_index, s.axial_index, s.lacey_index, p.solid_fraction, p.coordination_number, p.mean_overlap, p.overlap_99,"       \
    "  d.torque, d.torque_standard_error, d.torque_number, d.power,"                                                               \
    "  gr.minimum_omega2, gr.minimum_rotation_rate, gr.slip_per_revolution,"                                                       \
    "  r.steps, r.simulated_seconds, r.wall_seconds, r.particle_steps_per_second, r.maximum_overlap, r.threads" run                \
    " FROM job JOIN run_result r ON r.job=job.number LEFT JOIN drum_input i ON i.job=job.number"                                   \
    " LEFT JOIN granule_input gi ON gi.job=job.number LEFT JOIN granule_result gr ON gr.job=job.number"                            \
    " LEFT JOIN repose_result a ON a.job=job.number LEFT JOIN regime_result g ON g.job=job.number"                                 \
    " LEFT JOIN segregation_result s ON s.job=job.number LEFT JOIN packing_result p ON p.job=job.number"                           \
    " LEFT JOIN drive_result d ON d.job=job.number LEFT JOIN fill_input fi ON fi.job=job.number"                                   \
    " LEFT JOIN heap_input hi ON hi.job=job.number LEFT JOIN surface_result f ON f.job=job.number"                                 \
    " LEFT JOIN heap_result hr ON hr.job=job.number LEFT JOIN fill_result fr ON fr.job=job.number"                                 \
    " WHERE job.status='successful';"

static const char run_summary_with_more_measures[] = RUN_SUMMARY("", "", "", "");

static const char verdicts[] = "ALTER TABLE repose_result ADD COLUMN verdict TEXT;"
                               "ALTER TABLE repose_result ADD COLUMN drift_bound_deg_per_revolution REAL;"
                               "ALTER TABLE repose_result ADD COLUMN window_revolutions REAL;"
                               "ALTER TABLE repose_result ADD COLUMN window_correlation_times REAL;"
                               "ALTER TABLE repose_result ADD COLUMN layers REAL;"
                               "ALTER TABLE regime_result ADD COLUMN certain INTEGER;";

static const char run_summary_with_verdicts[] =
    RUN_SUMMARY(" a.verdict,", " a.drift_bound_deg_per_revolution, a.layers,", " g.certain,", "");

/* How many. NULL: a run from before there were any. */
static const char warnings_of_runs[] = "ALTER TABLE run_result ADD COLUMN warnings INTEGER;";

static const char run_summary_with_warnings[] =
    RUN_SUMMARY(" a.verdict,", " a.drift_bound_deg_per_revolution, a.window_revolutions, a.window_correlation_times, a.layers,",
                " g.certain,", ", coalesce(fr.at_rest, hr.at_rest) AS at_rest, r.warnings");

static const schema_migration older_migrations[] = {
    { { older_inputs, older_results } },
    { { granule_tables, run_summary_with_granule } },
    { { NULL } },
    { { more_measures, drums_closed_and_with_lifters, fill_and_heap_tables, run_summary_with_more_measures } },
    { { NULL } },
    { { NULL } },
    { { NULL } },
    { { verdicts, run_summary_with_verdicts } },
    { { NULL } },
    { { NULL } },
    { { warnings_of_runs } },
    { { run_summary_with_warnings } },
};
enum { OLDER_VERSIONS = sizeof older_migrations / sizeof older_migrations[0] };

#endif
