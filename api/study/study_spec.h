/* A study: many jobs from one document.
 *
 *   {"name": "friction", "description": "...",
 *    "base":    {"inputs": {...}, "label": {...}},                        as a job's request
 *    "cases":   [{"name": "rough", "inputs": {...}, "label": {...}}]      each a merge patch (RFC 7396) on the base
 *    or "vary": {"/inputs/contact/friction": [0.1, 0.2, 0.5], ...}        all combinations; the last varies fastest
 *    "repeats": 3}                                                        with seeds s, s + 1, s + 2
 *
 * Without cases and vary the base alone is the one case. Nothing is expanded that is not looked at: a study of ten
 * thousand jobs takes the room of its document. */
#ifndef STUDY_SPEC_H
#define STUDY_SPEC_H

#include <jansson.h>
#include <stdbool.h>

#include "client_watch.h"
#include "job_spec.h"

enum { STUDY_NAME_SIZE = 201, STUDY_MOST_REPEATS = 1000, STUDY_MOST_VARIED = 8 };

typedef struct study_spec {
    char process[16], name[STUDY_NAME_SIZE];
    json_t *document; /* as posted, with repeats and seed chosen: posting it again gives the same jobs; owned */
    json_t *columns;  /* (n) pointers below /inputs, as "contact/friction", in which cases differ; owned */
    size_t cases;
    int repeats, priority;
    const start_source *beds; /* what its jobs may start from; NULL: starts are taken for good */
    bool has_seed;            /* the process begins at random, so that repeats differ */
} study_spec;

typedef struct study_options {
    uint64_t seed_if_missing; /* its low 53 bits */
    int default_threads;      /* of a job that does not ask */
    int64_t most_jobs;
    const start_source *beds; /* lives as long as the study */
} study_options;

/* Looks at the document's shape alone; study_check looks at each job. False: problems say why, with pointers into the
 * document; jobs that can be told all the same are there to be checked, so that every problem is heard at once
 * (cases is 0 where none can). Clear the study either way. */
bool study_spec_parse(const json_t *document, const study_options *options, study_spec *study, problem_list *problems);
void study_spec_clear(study_spec *study);

/* The request of one job, as job_spec_parse reads it. New reference; NULL: no memory, or a varied pointer that leads
 * nowhere in the base. */
json_t *study_job_request(const study_spec *study, size_t index, int repeat);
void study_case_name(const study_spec *study, size_t index, char name[STUDY_NAME_SIZE]);
/* {column: value} of the case, as its request has them, but for numbers with units: those in the column's own; null: not
 * given. New reference. */
json_t *study_case_inputs(const study_spec *study, size_t index);
/* Where the value of this column stands in its list, for this case of all combinations. */
size_t study_value_index(const study_spec *study, size_t index, size_t column);

typedef struct study_estimate {
    double jobs, steps, wall_seconds, memory_bytes, snapshot_bytes; /* sums; memory: of the largest job; wall: one job at a time */
    double disk_bytes;                                              /* of all files */
} study_estimate;

/* Takes the jobs as they are read, each once: of each case its repeats. They count only when study_check says true. When the
 * client has left, nobody wants them any more and the check ends. */
typedef struct study_taker {
    const post_limits *limits; /* of each job alone: particles and threads; NULL: none */
    const client_watch *client;
    bool (*take)(void *context, const job_spec *spec, size_t index, int repeat); /* false: it can't; the check ends */
    void *context;
} study_taker;

/* study_check.c: reads every job. False: problems is not empty; it lists what is wrong, each thing once, with a pointer to the place
 * in the study that it comes from; or the taker could not go on. warnings: of what can be run; NULL: not wanted. taker: NULL
 * where nobody wants the jobs. */
bool study_check(const study_spec *study, const calibration *machine, const study_taker *taker, study_estimate *estimate,
                 problem_list *problems, problem_list *warnings);
json_t *study_estimate_to_json(const study_estimate *estimate);

#endif
