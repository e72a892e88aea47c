/* The tables as migrations made them up to version 12, when those of inputs and results were made by hand, too. Not to be
 * changed: databases of that time are so. */
#ifndef OLDER_SCHEMA_H
#define OLDER_SCHEMA_H

#include "schema.h"

static const char job_tables[] =
    "CREATE TABLE job("
    "  number INTEGER PRIMARY KEY," /* order of submission */
    "  id TEXT NOT NULL UNIQUE,"
    "  process TEXT NOT NULL,"
    "  label TEXT NOT NULL," /* JSON object */
    "  spec TEXT NOT NULL,"  /* canonical JSON */
    "  status TEXT NOT NULL CHECK(status IN ('accepted','running','successful','failed','dismissed')),"
    "  message TEXT NOT NULL,"
    "  attempt INTEGER NOT NULL DEFAULT 1,"
    "  not_before REAL NOT NULL DEFAULT 0," /* unix seconds: a job put back after a full disk waits */
    "  threads INTEGER NOT NULL,"
    "  estimated_seconds REAL NOT NULL,"
    "  estimated_memory_bytes REAL NOT NULL,"
    "  created TEXT NOT NULL, started TEXT, finished TEXT, updated TEXT NOT NULL,"
    "  progress REAL NOT NULL DEFAULT 0,"
    "  eta_seconds REAL,"
    "  failure TEXT" /* the worker's failure event, JSON */
    ") STRICT;"
    "CREATE INDEX job_waiting ON job(number) WHERE status='accepted';"
    "CREATE INDEX job_running ON job(number) WHERE status='running';"
    "CREATE INDEX job_by_status ON job(status, number);"
    "CREATE TABLE job_count(status TEXT PRIMARY KEY, jobs INTEGER NOT NULL) STRICT, WITHOUT ROWID;"
    "INSERT INTO job_count VALUES('accepted',0),('running',0),('successful',0),('failed',0),('dismissed',0);"
    "CREATE TRIGGER job_counted AFTER INSERT ON job BEGIN"
    "  UPDATE job_count SET jobs=jobs+1 WHERE status=new.status; END;"
    "CREATE TRIGGER job_moved AFTER UPDATE OF status ON job WHEN old.status<>new.status BEGIN"
    "  UPDATE job_count SET jobs=jobs-1 WHERE status=old.status;"
    "  UPDATE job_count SET jobs=jobs+1 WHERE status=new.status; END;"
    "CREATE TRIGGER job_forgotten AFTER DELETE ON job BEGIN"
    "  UPDATE job_count SET jobs=jobs-1 WHERE status=old.status; END;"
    "CREATE TABLE drum_input("
    "  job INTEGER PRIMARY KEY REFERENCES job(number) ON DELETE CASCADE,"
    "  drum_diameter REAL NOT NULL, drum_length REAL NOT NULL, rotation_rate REAL NOT NULL, gravity REAL NOT NULL,"
    "  fill_fraction REAL NOT NULL, particles INTEGER NOT NULL, species INTEGER NOT NULL,"
    "  diameter REAL NOT NULL, density REAL NOT NULL," /* of the first species */
    "  friction REAL NOT NULL, restitution REAL NOT NULL, wall_friction REAL NOT NULL,"
    "  tangential_stiffness_ratio REAL NOT NULL, stiffness REAL NOT NULL, lining_diameter REAL NOT NULL,"
    "  time_step REAL NOT NULL, duration REAL NOT NULL, seed INTEGER NOT NULL"
    ") STRICT;";

static const char result_tables[] =
    "CREATE TABLE result(job INTEGER PRIMARY KEY REFERENCES job(number) ON DELETE CASCADE, document TEXT NOT NULL) STRICT;"
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
    "CREATE TABLE sample("
    "  job INTEGER NOT NULL REFERENCES job(number) ON DELETE CASCADE,"
    "  number INTEGER NOT NULL, step INTEGER NOT NULL, time REAL NOT NULL," /* s since rotation began */
    "  measures TEXT NOT NULL,"                                             /* JSON object */
    "  angle_deg REAL GENERATED ALWAYS AS (measures->>'angle_deg') VIRTUAL,"
    "  PRIMARY KEY(job, number)) STRICT, WITHOUT ROWID;"
    "CREATE TABLE snapshot("
    "  job INTEGER NOT NULL REFERENCES job(number) ON DELETE CASCADE,"
    "  number INTEGER NOT NULL, step INTEGER NOT NULL, time REAL NOT NULL,"
    "  file TEXT NOT NULL, bytes INTEGER NOT NULL, particles INTEGER NOT NULL,"
    "  PRIMARY KEY(job, number)) STRICT, WITHOUT ROWID;"
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

/* A study and its cases; its jobs say which case and repeat they are. What a study shows at every look (how many of
 * its jobs are in which state) is kept by triggers, as job_count is. */
static const char study_tables[] =
    "CREATE TABLE study("
    "  number INTEGER PRIMARY KEY," /* order of submission */
    "  id TEXT NOT NULL UNIQUE,"
    "  process TEXT NOT NULL,"
    "  name TEXT NOT NULL,"
    "  document TEXT NOT NULL," /* JSON, repeats and seed chosen */
    "  cases INTEGER NOT NULL, repeats INTEGER NOT NULL, jobs INTEGER NOT NULL,"
    "  estimated_seconds REAL NOT NULL,"
    "  created TEXT NOT NULL, started TEXT, updated TEXT NOT NULL,"
    "  accepted INTEGER NOT NULL DEFAULT 0, running INTEGER NOT NULL DEFAULT 0, successful INTEGER NOT NULL DEFAULT 0,"
    "  failed INTEGER NOT NULL DEFAULT 0, dismissed INTEGER NOT NULL DEFAULT 0"
    ") STRICT;"
    "CREATE TABLE study_case("
    "  study INTEGER NOT NULL REFERENCES study(number) ON DELETE CASCADE,"
    "  position INTEGER NOT NULL,"
    "  name TEXT NOT NULL,"
    "  inputs TEXT NOT NULL," /* JSON object: what differs between cases */
    "  label TEXT NOT NULL,"  /* JSON object */
    "  PRIMARY KEY(study, position)) STRICT, WITHOUT ROWID;"
    "ALTER TABLE job ADD COLUMN study INTEGER REFERENCES study(number);"
    "ALTER TABLE job ADD COLUMN study_case INTEGER;"
    "ALTER TABLE job ADD COLUMN study_repeat INTEGER;"
    "CREATE UNIQUE INDEX job_of_study ON job(study, study_case, study_repeat) WHERE study IS NOT NULL;"
    "CREATE TRIGGER study_job_counted AFTER INSERT ON job WHEN new.study IS NOT NULL BEGIN"
    "  UPDATE study SET accepted=accepted+(new.status='accepted'), running=running+(new.status='running'),"
    "   successful=successful+(new.status='successful'), failed=failed+(new.status='failed'),"
    "   dismissed=dismissed+(new.status='dismissed') WHERE number=new.study; END;"
    "CREATE TRIGGER study_job_moved AFTER UPDATE OF status ON job WHEN old.status<>new.status AND new.study IS NOT NULL BEGIN"
    "  UPDATE study SET accepted=accepted+(new.status='accepted')-(old.status='accepted'),"
    "   running=running+(new.status='running')-(old.status='running'),"
    "   successful=successful+(new.status='successful')-(old.status='successful'),"
    "   failed=failed+(new.status='failed')-(old.status='failed'),"
    "   dismissed=dismissed+(new.status='dismissed')-(old.status='dismissed'),"
    "   started=coalesce(started,new.started), updated=new.updated WHERE number=new.study; END;"
    "CREATE TRIGGER study_job_forgotten AFTER DELETE ON job WHEN old.study IS NOT NULL BEGIN"
    "  UPDATE study SET jobs=jobs-1, accepted=accepted-(old.status='accepted'), running=running-(old.status='running'),"
    "   successful=successful-(old.status='successful'), failed=failed-(old.status='failed'),"
    "   dismissed=dismissed-(old.status='dismissed') WHERE number=old.study; END;";

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
    "ALTER TABLE drum_input ADD COLUMN wall_rolling_friction REAL NOT NULL DEFAULT 0;"
    "UPDATE drum_input SET shape=coalesce((SELECT CASE json_type(job.spec,'$.inputs.particles[0].shape')"
    "  WHEN 'text' THEN job.spec->>'$.inputs.particles[0].shape' WHEN 'object' THEN 'spheres' END"
    "  FROM job WHERE job.number=drum_input.job), 'sphere');";

/* What both have in common stands at the end, in the same order. */
static const char fill_and_heap_tables[] =
    "CREATE TABLE fill_input("
    "  job INTEGER PRIMARY KEY REFERENCES job(number) ON DELETE CASCADE,"
    "  cylinder_diameter REAL NOT NULL, stream_diameter REAL NOT NULL, rate REAL NOT NULL, impact_speed REAL NOT NULL,"
    "  gravity REAL NOT NULL, particles INTEGER NOT NULL, species INTEGER NOT NULL, diameter REAL NOT NULL,"
    "  density REAL NOT NULL, shape TEXT NOT NULL," /* of the first species */
    "  friction REAL NOT NULL, restitution REAL NOT NULL, wall_friction REAL NOT NULL,"
    "  tangential_stiffness_ratio REAL NOT NULL, stiffness REAL NOT NULL, time_step REAL NOT NULL,"
    "  duration REAL NOT NULL, seed INTEGER NOT NULL,"
    "  rolling_friction REAL NOT NULL, wall_rolling_friction REAL NOT NULL) STRICT;"
    "CREATE TABLE heap_input("
    "  job INTEGER PRIMARY KEY REFERENCES job(number) ON DELETE CASCADE,"
    "  tube_diameter REAL NOT NULL, lift_speed REAL NOT NULL, plate_diameter REAL NOT NULL, rim_height REAL NOT NULL,"
    "  plate_friction REAL NOT NULL,"
    "  gravity REAL NOT NULL, particles INTEGER NOT NULL, species INTEGER NOT NULL, diameter REAL NOT NULL,"
    "  density REAL NOT NULL, shape TEXT NOT NULL," /* of the first species */
    "  friction REAL NOT NULL, restitution REAL NOT NULL, wall_friction REAL NOT NULL,"
    "  tangential_stiffness_ratio REAL NOT NULL, stiffness REAL NOT NULL, time_step REAL NOT NULL,"
    "  duration REAL NOT NULL, seed INTEGER NOT NULL,"
    "  rolling_friction REAL NOT NULL, wall_rolling_friction REAL NOT NULL) STRICT;"
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

/* What a step of each job has to do, and its cost over what the calibration says of that: with these numbers the latest
 * runs correct an estimate without a look at their specifications. */
static const char what_estimates_need[] =
    "CREATE TABLE job_load("
    "  job INTEGER PRIMARY KEY REFERENCES job(number) ON DELETE CASCADE,"
    "  spheres REAL NOT NULL, of_particle REAL NOT NULL, law INTEGER NOT NULL, friction REAL NOT NULL,"
    "  rolling_friction INTEGER NOT NULL, in_double INTEGER NOT NULL, threads INTEGER NOT NULL, factor REAL NOT NULL) STRICT;"
    "CREATE INDEX run_that_tells ON run_result(job) WHERE steps>0 AND wall_seconds>0.5;";

/* All that jobs are listed by, in one place: counting what a filter lets through reads no specification. */
static const char index_of_lists[] =
    "CREATE INDEX job_listed ON job(study, status, process, created, started, finished, label, id);";

/* What is long in the specifications of a study's jobs (the list of particles, a bed that is placed particle by particle)
 * is kept once: a job's own text has "part <number>" in its place. */
static const char parts_of_studies[] = "CREATE TABLE study_part("
                                       "  study INTEGER NOT NULL REFERENCES study(number) ON DELETE CASCADE,"
                                       "  number INTEGER NOT NULL, text TEXT NOT NULL,"
                                       "  PRIMARY KEY(study, number)) STRICT, WITHOUT ROWID;";

static const char verdicts[] = "ALTER TABLE repose_result ADD COLUMN verdict TEXT;"
                               "ALTER TABLE repose_result ADD COLUMN drift_bound_deg_per_revolution REAL;"
                               "ALTER TABLE repose_result ADD COLUMN window_revolutions REAL;"
                               "ALTER TABLE repose_result ADD COLUMN window_correlation_times REAL;"
                               "ALTER TABLE repose_result ADD COLUMN layers REAL;"
                               "ALTER TABLE regime_result ADD COLUMN certain INTEGER;";

static const char run_summary_with_verdicts[] =
    RUN_SUMMARY(" a.verdict,", " a.drift_bound_deg_per_revolution, a.layers,", " g.certain,", "");

/* How often in a row an attempt could not go on for want of something of the machine. */
static const char setbacks[] = "ALTER TABLE job ADD COLUMN setbacks INTEGER NOT NULL DEFAULT 0;";

/* leaving: ids of deleted jobs whose folders have to go. A number is never used twice, because what a worker writes is fenced
 * by it. */
static const char retried_and_deleted_jobs[] =
    "ALTER TABLE job ADD COLUMN attempts_before INTEGER NOT NULL DEFAULT 0;" /* made before it was tried again on request */
    "CREATE TABLE leaving(id TEXT PRIMARY KEY, since REAL NOT NULL) STRICT, WITHOUT ROWID;"
    "CREATE TABLE last_deleted(number INTEGER NOT NULL) STRICT;"
    "INSERT INTO last_deleted VALUES(0);"
    "CREATE TRIGGER job_number_kept AFTER DELETE ON job BEGIN"
    "  UPDATE last_deleted SET number=old.number WHERE number<old.number; END;";

/* How many. NULL: a run from before there were any. */
static const char warnings_of_runs[] = "ALTER TABLE run_result ADD COLUMN warnings INTEGER;";

static const char run_summary_with_warnings[] =
    RUN_SUMMARY(" a.verdict,", " a.drift_bound_deg_per_revolution, a.window_revolutions, a.window_correlation_times, a.layers,",
                " g.certain,", ", coalesce(fr.at_rest, hr.at_rest) AS at_rest, r.warnings");

static const schema_migration older_migrations[] = {
    { { job_tables, result_tables } },
    { { granule_tables, run_summary_with_granule } },
    { { study_tables } },
    { { more_measures, drums_closed_and_with_lifters, fill_and_heap_tables, run_summary_with_more_measures } },
    { { what_estimates_need } },
    { { index_of_lists } },
    { { parts_of_studies } },
    { { verdicts, run_summary_with_verdicts } },
    { { setbacks } },
    { { retried_and_deleted_jobs } },
    { { warnings_of_runs } },
    { { run_summary_with_warnings } },
};
enum { OLDER_VERSIONS = sizeof older_migrations / sizeof older_migrations[0] };

#endif
