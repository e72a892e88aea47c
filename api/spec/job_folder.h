/* The names of what a job folder holds: the whole contract between the daemon and a worker.
 *
 *   spec.json        canonical spec, written by the daemon before the worker starts
 *   start.hdf.sha256 the SHA-256 of start.hdf, in hexadecimal and a newline, which the daemon took when it gave the job that
 *                    file: a worker reads no other bytes
 *   start.hdf        where the run starts from another's bed: that run's snapshot or checkpoint, under a name of its own
 *   bed.hdf          of a job that shares its bed with others of its study: the checkpoint of the moment at which the bed was
 *                    settled, from which those others go on; in their folders a second name for the same file
 *   bed.hdf.sha256   there: its SHA-256, as the daemon was told by the job that settled it, two spaces and that job's id. What
 *                    has another is not used: the job then settles the bed itself
 *   events.ndjson    append-only, one JSON object a line; every line ends in \n (a last line without it is not
 *                    yet written). Each has "event" and, but for start, "step" and "time" (s since rotation
 *                    began, negative before):
 *       {"event":"start","attempt":2,"step":120000,"resumed":true,"particles":2500,"time_step":1e-5,"total_steps":520000}
 *       {"event":"progress","phase":"settling","step":..,"time":..,"progress":37.5,"eta_seconds":41.0,
 *        "particle_steps_per_second":2.1e7}                                    about once a second
 *       {"event":"sample","number":0,"step":..,"time":..,"values":{"angle_deg":22.7, ...}}   NaN becomes null
 *       {"event":"snapshot","number":0,"step":..,"time":..,"file":"000000.hdf","bytes":..,"particles":..}
 *       {"event":"checkpoint","step":..,"time":..,"attempt":..}
 *       {"event":"bed","step":..,"time":..,"sha256":"..."}       bed.hdf is there
 *       {"event":"failure","status":"overlap-too-large","message":"...","detail":{...}}
 *           status: not-a-number, overlap-too-large, particle-escaped, never-settled (all with detail: step, time,
 *           particle, other, position, quantity, value, limit, unit, likely_cause); does-not-fit, bad-parameter,
 *           no-memory, disk
 *     A process without steps (granule) writes start alone, without time_step and total_steps.
 *     Of several beds, samples, snapshots and failures have a bed's step, all else the steps of all beds together.
 *     total_steps of start is an estimate: when rotation begins is not known before.
 *     A later attempt goes on from the checkpoint and repeats what came after it with the same numbers: readers
 *     key samples and snapshots by "number" and let the later line win.
 *   snapshots/000000.hdf ...   written as .tmp, closed, fsynced, renamed; never changed after
 *   snapshots/000000.bin ...   what programs that show a run need of each, in few bytes (frame_format.h); there before it
 *   snapshots.hdf.series       opens them in ParaView as one time series
 *   walls.vtp                  the container's walls, where they are at the newest snapshot; rewritten with that
 *   picture.png                the bed as it was a minute ago or less, and in the end: 640 pixels a side; picture-96.png: 96
 *   fields.hdf                 a drum's fields over the cross-section, or those at an orifice, averaged over the run; before
 *   fields.json                the same as a short document, just before it
 *                              result.json
 *   tracers.hdf, tracers.csv   the paths of the particles that were asked for (tracers); before result.json
 *   checkpoint.hdf             newest full state; checkpoint.before.hdf: the one before, should that be damaged
 *   beds/001.hdf ...           of a run of several beds the checkpoint of each but the first, and 001.before.hdf; gone once
 *                              result.json is there. Samples, snapshots, walls and checkpoint.hdf are of the first bed
 *   result.json                the document of GET /jobs/{id}/results; written last, by rename. A worker that finds
 *                              it, of the same spec, has nothing to do and ends with 0
 *   result.json.sum            its checksum (checksum.h), and that of its text followed by the canonical spec, so that nothing
 *                              else is taken for the result of this spec; written just before it. spec.json has the first
 *                              of these where a worker wrote it.
 *                              All .hdf files end in such a line. What does not fit its checksum is not believed
 *   profile.json               what the time went into, where `repose run --profile` was asked for it
 *   log.txt                    the worker's stderr
 *   fence.000001 ...           of each start of a worker on another machine, who may write here (attempt_fence.h)
 */
#ifndef JOB_FOLDER_H
#define JOB_FOLDER_H

#define JOB_START_FILE "start.hdf"
#define JOB_START_HASH_FILE JOB_START_FILE ".sha256"
#define JOB_BED_FILE "bed.hdf"
#define JOB_BED_HASH_FILE JOB_BED_FILE ".sha256"
#define JOB_SPEC_FILE "spec.json"
#define JOB_EVENTS_FILE "events.ndjson"
#define JOB_SNAPSHOT_FOLDER "snapshots"
#define JOB_SNAPSHOT_FILE_FORMAT "%06lld.hdf"
#define JOB_FRAME_FILE_FORMAT "%06lld.bin"
#define JOB_SERIES_FILE "snapshots.hdf.series"
#define JOB_WALLS_FILE "walls.vtp"
#define JOB_PICTURE_FILE "picture.png"
#define JOB_SMALL_PICTURE_FILE "picture-96.png"
enum { JOB_PICTURE_LARGE = 640, JOB_PICTURE_SMALL = 96 }; /* pixels a side */
#define JOB_FIELDS_FILE "fields.hdf"
#define JOB_FIELDS_TEXT_FILE "fields.json"
#define JOB_TRACERS_FILE "tracers.hdf"
#define JOB_TRACERS_TABLE "tracers.csv"
#define JOB_CHECKPOINT_FILE "checkpoint.hdf"
#define JOB_EARLIER_CHECKPOINT_FILE "checkpoint.before.hdf"
#define JOB_BEDS_FOLDER "beds"
#define JOB_RESULT_FILE "result.json"
#define JOB_RESULT_SUM_FILE JOB_RESULT_FILE ".sum"
#define JOB_PROFILE_FILE "profile.json"
#define JOB_LOG_FILE "log.txt"
/* Of a study that was split into folders, from 1. */
#define JOB_NUMBERED_FORMAT "%06zu"
#define JOB_NUMBERED_SQL "%06d"
#define JOB_FENCE_START "fence."
#define JOB_FENCE_FORMAT JOB_FENCE_START "%06d"

/* Signals on which either program saves what it has and leaves in good order: all that end a program from outside, but for
 * SIGKILL and those that tell of its own faults. Batch systems warn by some of them. The real-time signals are meant, too. */
#define JOB_STOP_SIGNALS                                                                                                           \
    SIGTERM, SIGINT, SIGHUP, SIGQUIT, SIGUSR1, SIGUSR2, SIGXCPU, SIGALRM, SIGVTALRM, SIGPROF, SIGPOLL, SIGPWR, SIGSTKFLT

/* How `repose run` ends. */
enum worker_exit {
    WORKER_DONE = 0,
    WORKER_FAULT = 1, /* our own bug or a missing file */
    WORKER_BAD_SPEC = 2,
    WORKER_STOPPED = 3,   /* JOB_STOP_SIGNALS: checkpoint written, to be continued (or dismissed: the daemon knows which) */
    WORKER_NUMERICAL = 4, /* the failure event says what, where, when */
    WORKER_DISK = 5,
    WORKER_SUPERSEDED = 7, /* another start of the same job has the folder: this one has nothing to say of it */
    WORKER_MACHINE = 6     /* memory, descriptors, threads or the like that the machine did not give */
};

#endif
