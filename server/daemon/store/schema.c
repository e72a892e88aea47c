/* A migration that has been released is never changed; a new one is added below it. Not here: the tables of inputs and
 * results and the view over them, which follow the rows of all processes (field_tables.c).
 *
 * One row of `job` is a job for ever. `result` keeps its results document whole. job_count is kept by triggers, because
 * the list of jobs shows counts at every look and counting 100,000 rows each time would be felt. */
#include "schema.h"

#include <stddef.h>

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
    /* What is done here after an INSERT, study_stage.c does once for all jobs of a study; so with study_job_counted. */
    "CREATE TRIGGER job_counted AFTER INSERT ON job BEGIN"
    "  UPDATE job_count SET jobs=jobs+1 WHERE status=new.status; END;"
    "CREATE TRIGGER job_moved AFTER UPDATE OF status ON job WHEN old.status<>new.status BEGIN"
    "  UPDATE job_count SET jobs=jobs-1 WHERE status=old.status;"
    "  UPDATE job_count SET jobs=jobs+1 WHERE status=new.status; END;"
    "CREATE TRIGGER job_forgotten AFTER DELETE ON job BEGIN"
    "  UPDATE job_count SET jobs=jobs-1 WHERE status=old.status; END;";

static const char result_tables[] =
    "CREATE TABLE result(job INTEGER PRIMARY KEY REFERENCES job(number) ON DELETE CASCADE, document TEXT NOT NULL) STRICT;"
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
    "  PRIMARY KEY(job, number)) STRICT, WITHOUT ROWID;";

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

/* Jobs from before say in their specification what shape their particles have. */
static const char shapes_of_specifications[] =
    "UPDATE drum_input SET shape=coalesce((SELECT CASE json_type(job.spec,'$.inputs.particles[0].shape')"
    "  WHEN 'text' THEN job.spec->>'$.inputs.particles[0].shape' WHEN 'object' THEN 'spheres' END"
    "  FROM job WHERE job.number=drum_input.job), 'sphere');";

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

/* Jobs wait by their setbacks too; by their numbers alone job_by_status has them. */
static const char waiting_by_setbacks[] = "DROP INDEX job_waiting;"
                                          "CREATE INDEX job_waiting ON job(setbacks, number) WHERE status='accepted';";

/* How its results are wanted, JSON; NULL: as ever. */
static const char wanted_results[] = "ALTER TABLE job ADD COLUMN wanted TEXT;";

/* What was posted as a study has a table of its own: it may be long, and each change of a job writes the study's row anew. */
static const char documents_of_studies[] = "CREATE TABLE study_document("
                                           "  study INTEGER PRIMARY KEY REFERENCES study(number) ON DELETE CASCADE,"
                                           "  document TEXT NOT NULL) STRICT;" /* JSON, repeats and seed chosen */
                                           "INSERT INTO study_document SELECT number, document FROM study;"
                                           "ALTER TABLE study DROP COLUMN document;";

/* Jobs that no rule removes. */
static const char pinned_jobs[] = "CREATE TABLE pinned(job INTEGER PRIMARY KEY REFERENCES job(number) ON DELETE CASCADE) STRICT;";

/* Requests with an Idempotency-Key, in the order in which they came, and what they were answered. */
static const char request_keys[] = "CREATE TABLE request_key("
                                   "  number INTEGER PRIMARY KEY,"
                                   "  key TEXT NOT NULL UNIQUE, fingerprint INTEGER NOT NULL, since REAL NOT NULL,"
                                   "  made TEXT NOT NULL,"
                                   "  status INTEGER, location TEXT, body TEXT) STRICT;"
                                   "CREATE INDEX request_key_age ON request_key(since);";

/* Jobs run by priority. Among those of one priority clients, who name themselves in the label, take turns: each job has a turn
 * behind the client's others that wait and behind those that have run (queue_turn). */
static const char turns_of_clients[] =
    "ALTER TABLE job ADD COLUMN priority INTEGER NOT NULL DEFAULT 0;"
    "ALTER TABLE job ADD COLUMN client TEXT NOT NULL DEFAULT '';"
    "ALTER TABLE job ADD COLUMN turn INTEGER NOT NULL DEFAULT 0;"
    "ALTER TABLE study ADD COLUMN priority INTEGER NOT NULL DEFAULT 0;"
    "UPDATE job SET turn=number WHERE status='accepted';"
    "CREATE TABLE queue_turn(priority INTEGER PRIMARY KEY, turn INTEGER NOT NULL) STRICT;"
    "CREATE INDEX job_waiting_turn ON job(priority DESC, turn, number, estimated_seconds) WHERE status='accepted';"
    "CREATE INDEX job_waiting_client ON job(client, priority, turn) WHERE status='accepted';";

/* Who is called back about which jobs, and what there is to tell: the commit that changes a job also says so here (callbacks.h).
 * What is no longer so when it comes to be told is not: how a run goes on once it has ended, its failure once it is tried again. */
#define TELL(kind, address)                                                                                                        \
    "  INSERT INTO callback(job,kind,uri,since) SELECT job, '" kind "', " address ", (julianday('now')-2440587.5)*86400.0"         \
    "   FROM subscriber WHERE job=new.number AND " address " IS NOT NULL"                                                          \
    "   ON CONFLICT(job,kind) DO UPDATE SET news=random(), since=excluded.since;"
#define TELL_PROGRESS TELL("inProgress", "in_progress")
#define TELL_SUCCESS TELL("success", "iif(new.status='successful',success,NULL)")
#define TELL_FAILURE TELL("failed", "iif(new.status IN ('failed','dismissed'),failed,NULL)")
static const char subscribers[] =
    "CREATE TABLE subscriber("
    "  job INTEGER PRIMARY KEY REFERENCES job(number) ON DELETE CASCADE,"
    "  success TEXT, in_progress TEXT, failed TEXT, base TEXT NOT NULL) STRICT;"
    "CREATE TABLE callback("
    "  job INTEGER NOT NULL REFERENCES job(number) ON DELETE CASCADE,"
    "  kind TEXT NOT NULL, uri TEXT NOT NULL, news INTEGER NOT NULL DEFAULT (random()), since REAL NOT NULL,"
    "  due REAL NOT NULL DEFAULT 0, tries INTEGER NOT NULL DEFAULT 0, PRIMARY KEY(job, kind)) STRICT;"
    "CREATE INDEX callback_due ON callback(due);"
    "CREATE TRIGGER job_progress_told AFTER UPDATE OF status, progress ON job WHEN new.status='running'"
    "  AND (old.status<>'running' OR CAST(new.progress/10 AS INTEGER)>CAST(old.progress/10 AS INTEGER))"
    "  AND EXISTS(SELECT 1 FROM subscriber WHERE job=new.number) BEGIN" TELL_PROGRESS " END;"
    "CREATE TRIGGER job_end_told AFTER UPDATE OF status ON job WHEN old.status<>new.status AND new.status<>'running'"
    "  AND EXISTS(SELECT 1 FROM subscriber WHERE job=new.number) BEGIN"
    "  DELETE FROM callback WHERE job=new.number;" TELL_SUCCESS TELL_FAILURE " END;";

/* A short job must not be looked for among a hundred thousand long ones. The figure is that of SHORT_JOB. */
static const char short_jobs[] = "CREATE INDEX job_waiting_short ON job(priority DESC, turn, number, estimated_seconds)"
                                 " WHERE status='accepted' AND estimated_seconds<2.0;";
/* SQLite keeps no checksums of its own: one of each document that is sent as it was written; NULL: of a program from before. */
static const char checksums_of_results[] = "ALTER TABLE result ADD COLUMN checksum INTEGER;";

/* Jobs of a study that would settle the same bed have the same number, and one of them settles it for all (shared_beds.c). */
static const char shared_beds[] = "ALTER TABLE job ADD COLUMN bed INTEGER;"
                                  "CREATE INDEX job_of_bed ON job(bed) WHERE bed IS NOT NULL AND status IN ('accepted','running');"
                                  "CREATE TABLE bed("
                                  "  key INTEGER PRIMARY KEY,"
                                  "  job INTEGER NOT NULL REFERENCES job(number) ON DELETE CASCADE," /* that has settled it */
                                  "  sha256 TEXT NOT NULL) STRICT;"
                                  "CREATE INDEX bed_of_job ON bed(job);";

/* Tables of particles that were sent as comma-separated values, for runs to start from. */
static const char sent_beds[] = "CREATE TABLE sent_bed("
                                "  number INTEGER PRIMARY KEY,"
                                "  id TEXT NOT NULL UNIQUE, created TEXT NOT NULL,"
                                "  particles INTEGER NOT NULL, bytes INTEGER NOT NULL) STRICT;"
                                "CREATE TABLE sent_bed_text("
                                "  bed INTEGER PRIMARY KEY REFERENCES sent_bed(number) ON DELETE CASCADE,"
                                "  text TEXT NOT NULL) STRICT;";

/* The mean interface of drums, a row a point. */
static const char interfaces[] =
    "CREATE VIEW interface AS SELECT result.job AS job, x.key AS point, x.value AS x, height.value AS height, error.value AS "
    "standard_error"
    " FROM result JOIN json_each(result.document,'$.repose.interface.x') AS x"
    " JOIN json_each(result.document,'$.repose.interface.height') AS height ON height.key=x.key"
    " LEFT JOIN json_each(result.document,'$.repose.interface.standard_error') AS error ON error.key=x.key;";

/* What finds a worker again that lives on without its daemon, and what it was given beyond what was expected. */
static const char workers_of_jobs[] = "ALTER TABLE job ADD COLUMN starts INTEGER NOT NULL DEFAULT 0;"
                                      "ALTER TABLE job ADD COLUMN worker TEXT;"
                                      "ALTER TABLE job ADD COLUMN more_time INTEGER NOT NULL DEFAULT 0;"
                                      "ALTER TABLE job ADD COLUMN more_memory INTEGER NOT NULL DEFAULT 0;";

/* What is asked of a cluster (job_resources.h); NULL: nothing. */
static const char resources_of_jobs[] = "ALTER TABLE job ADD COLUMN resources TEXT;";

/* A calibration, what was posted and what the planner said last, and the runs that it asked for. A run has a job as long as that is
 * there; when it is deleted, what became of it is kept, because the planner reads all of them each time. workers: how many runs a
 * batch has, whatever the daemon is started with later. */
static const char calibrations[] =
    "CREATE TABLE calibration("
    "  number INTEGER PRIMARY KEY," /* order of submission */
    "  id TEXT NOT NULL UNIQUE,"
    "  name TEXT NOT NULL,"
    "  status TEXT NOT NULL CHECK(status IN ('accepted','running','successful','failed','dismissed')),"
    "  message TEXT NOT NULL,"
    "  stage TEXT NOT NULL DEFAULT 'start',"
    "  priority INTEGER NOT NULL, workers INTEGER NOT NULL, most_jobs INTEGER NOT NULL,"
    "  estimated_seconds REAL NOT NULL,"
    "  created TEXT NOT NULL, started TEXT, finished TEXT, updated TEXT NOT NULL,"
    "  setbacks INTEGER NOT NULL DEFAULT 0," /* how often in a row it could not be planned */
    "  not_before REAL NOT NULL DEFAULT 0"   /* unix seconds */
    ") STRICT;"
    "CREATE INDEX calibration_at_work ON calibration(number) WHERE status IN ('accepted','running');"
    "CREATE TABLE calibration_document("
    "  calibration INTEGER PRIMARY KEY REFERENCES calibration(number) ON DELETE CASCADE,"
    "  request TEXT NOT NULL, plan TEXT) STRICT;" /* JSON */
    "CREATE TABLE calibration_run("
    "  calibration INTEGER NOT NULL REFERENCES calibration(number) ON DELETE CASCADE,"
    "  number INTEGER NOT NULL,"
    "  stage TEXT NOT NULL, test INTEGER NOT NULL, of_set INTEGER NOT NULL,"
    "  parameters TEXT NOT NULL," /* JSON object */
    "  job INTEGER,"
    "  status TEXT, results TEXT," /* of a job that is gone; failed: of a case that could be none */
    "  PRIMARY KEY(calibration, number)) STRICT, WITHOUT ROWID;"
    "CREATE INDEX calibration_run_of_job ON calibration_run(job) WHERE job IS NOT NULL;"
    "CREATE TRIGGER calibration_job_kept BEFORE DELETE ON job"
    "  WHEN EXISTS(SELECT 1 FROM calibration_run WHERE job=old.number) BEGIN"
    "  UPDATE calibration_run SET status=old.status, job=NULL,"
    "   results=(SELECT document FROM result WHERE result.job=old.number) WHERE job=old.number; END;";

/* Tables of inputs and results were once made by migrations, which therefore have gaps now. A program from then can't fill
 * tables in that have more columns, and is kept out by the last number. */
#define NO_TABLES_OF_ITS_OWN                                                                                                       \
    {                                                                                                                              \
        {                                                                                                                          \
            NULL                                                                                                                   \
        }                                                                                                                          \
    }

/* What jobs from before ran with stands in their specifications. given: JSON, the inputs that the request had; NULL: not known. */
#define WORDS_OF_SPECIFICATIONS(table)                                                                                             \
    "UPDATE " table " SET law=coalesce((SELECT spec->>'$.inputs.contact.law' FROM job WHERE number=job),law),"                     \
    " precision=coalesce((SELECT spec->>'$.inputs.precision' FROM job WHERE number=job),precision);"
static const char given_inputs[] = "ALTER TABLE job ADD COLUMN given TEXT;" WORDS_OF_SPECIFICATIONS("drum_input")
    WORDS_OF_SPECIFICATIONS("fill_input") WORDS_OF_SPECIFICATIONS("heap_input");

const schema_migration schema_migrations[] = {
    { { job_tables, result_tables } },
    NO_TABLES_OF_ITS_OWN,
    { { study_tables } },
    { { shapes_of_specifications } },
    { { what_estimates_need } },
    { { index_of_lists } },
    { { parts_of_studies } },
    NO_TABLES_OF_ITS_OWN,
    { { setbacks } },
    { { retried_and_deleted_jobs } },
    NO_TABLES_OF_ITS_OWN,
    NO_TABLES_OF_ITS_OWN,
    NO_TABLES_OF_ITS_OWN,
    { { waiting_by_setbacks } },
    { { wanted_results } },
    { { documents_of_studies } },
    { { pinned_jobs } },
    { { request_keys } },
    { { turns_of_clients } },
    { { subscribers } },
    { { given_inputs } },
    { { short_jobs } },
    { { checksums_of_results } },
    { { shared_beds } },
    { { sent_beds } },
    { { interfaces } },
    { { workers_of_jobs } },
    { { calibrations } },
    { { resources_of_jobs } },
};
const int schema_version = sizeof schema_migrations / sizeof schema_migrations[0];
