#include "problem_kinds.h"

#include <string.h>

const problem_kind problem_kinds[] = {
    { OGC_EXCEPTION "no-such-process", "No such process", "The address names a test that this service does not have." },
    { OGC_EXCEPTION "no-such-job", "No such job", "The address names a job that there is not, or not any more." },
    { OGC_EXCEPTION "result-not-ready", "Result not ready", "The job still waits or runs; its results come later." },
    { "invalid-parameter", "Bad parameter", "A parameter of the query has a value that it may not have; detail says which may." },
    { "unknown-parameter", "Unknown parameter", "The query has a parameter that this address does not know." },
    { "invalid-specification", "The specification can't be run",
      "Inputs of a test are missing, unknown or outside their range; errors has all of them." },
    { "invalid-study", "The study can't be run, and none of its jobs was added",
      "The study or a job of it can't be run; errors has all reasons." },
    { "invalid-json", "Not JSON", "The body is no JSON, or is not said to be." },
    { "numerical-failure", "The job failed in its numbers",
      "The run ended because what it computed can't be trusted: an overlap too large, a number that is none, a particle outside."
      " failure says what, where and when." },
    { "job-failed", "The job failed", "The job ended without results; detail says why." },
    { "job-dismissed", "The job was dismissed", "The job was dismissed before it had results." },
    { "job-not-ended", "The job has not ended", "What was asked for can be done to ended jobs only." },
    { "job-ended", "The job has ended", "What was asked for can be done to jobs only that wait or run." },
    { "job-not-retried", "The job can't be tried again", "Only failed and dismissed jobs can." },
    { "job-not-continued", "The job can't be continued", "There is no state of it from which another could go on." },
    { "no-such-output", "No such output", "The results have no output of this name." },
    { "no-such-snapshot", "No such snapshot", "The job has no snapshot of this number." },
    { "no-such-file", "No such file", "The job does not have this file, or not yet." },
    { "no-such-bed", "No such bed", "The address names a table of particles that there is not, or not any more." },
    { "too-many-beds", "Too many beds", "As many tables of particles are there as are kept." },
    { "not-csv", "Not CSV", "The body is not said to be a table of comma-separated values." },
    { "invalid-bed", "The table can't be a bed", "Lines of the table are wrong; errors has all of them." },
    { "no-such-study", "No such study", "The address names a study that there is not, or not any more." },
    { "study-not-ended", "The study has not ended", "What was asked for can be done to ended studies only." },
    { "study-not-retried", "The study can't be tried again", "None of its jobs has failed." },
    { "study-ended", "The study has ended", "What was asked for can be done to studies only that wait or run." },
    { "no-such-calibration", "No such calibration", "The address names a calibration that there is not, or not any more." },
    { "invalid-calibration", "The calibration can't be run, and nothing was added",
      "The request is wrong, or one of its first runs would be; errors has all of it." },
    { "calibration-not-ended", "The calibration has not ended", "What was asked for can be done to ended calibrations only." },
    { "calibration-ended", "The calibration has ended", "What was asked for can be done to calibrations only that go on." },
    { "calibration-not-retried", "The calibration can't go on", "It has neither failed nor been dismissed." },
    { "no-such-example", "No such example", "The address names an example that there is not." },
    { "invalid-query", "The query can't be run", "The SQL is no single SELECT that can be run here; detail says why." },
    { "query-too-slow", "The query takes too long", "The SQL was stopped at its limit of time." },
    { "answer-too-long", "The answer is too long", "The table is longer than is sent at once; ask for it in parts." },
    { "key-used", "Another request had this key", "An Idempotency-Key came with another address or body than before." },
    { "done-before", "Done before", "A request with this Idempotency-Key was done, and its answer is lost." },
    { "not-found", "Not found", "The service has no such address." },
    { "invalid-address", "Bad address", "The address has characters that it may not have." },
    { "invalid-request", "Bad request", "Headers of the request are missing, given twice or contradict each other." },
    { "method-not-allowed", "Method not allowed", "The address is good, but not with this method; Allow has those that are." },
    { "range-outside", "Range outside the file", "The header Range asks for bytes that the file does not have." },
    { "length-required", "Length required", "The body came without a Content-Length." },
    { "body-too-large", "Body too large", "The body is longer than is read." },
    { "unknown-host", "Not this host", "The header Host does not name this service." },
    { "token-needed", "Token needed", "The service asks for a token, which was not sent or is another." },
    { "token-may-only-read", "The token may only read", "What was asked for needs a token that may write." },
    { "too-many-wrong-tokens", "Too many wrong tokens",
      "The address sent many tokens that are none; none is looked at for a while." },
    { "too-many-requests", "Too many requests", "The address asks faster than one address may." },
    { "too-much-of-one-address", "Too much of one address",
      "What the address sends and has not read yet fills what one address may have of the memory." },
    { "not-a-session", "Not a session", "A session is begun with one token." },
    { "foreign-page", "Foreign page", "A page of another service asked for a change." },
    { "queue-full", "The queue is full", "More jobs would wait than may." },
    { "no-room", "No room on the disk", "The disk of the data folder is full." },
    { "too-busy", "Too many requests that take long", "Others have to be answered first; try again later." },
    { "too-many-bodies", "Too many large bodies at once", "Others send much at this moment; try again later." },
    { "too-much-on-its-way", "Too much on its way", "Others read long answers at this moment; try again later." },
    { "not-answered", "Not answered", "The request waited too long for its turn, or the service is leaving." },
    { "nobody-waits", "Nobody waits", "The client left before its request was done." },
    { "not-ready", "Not ready", "The service can't take or run jobs now." },
    { "store-not-available", "Store not available", "The database can't be read or written now; the daemon's log says why." },
    { "out-of-memory", "Out of memory", "There was no memory for this request." },
    { "no-document", "No OpenAPI document", "The service was started with a document that can't be read." },
};
const size_t problem_kind_count = sizeof problem_kinds / sizeof problem_kinds[0];

const problem_kind *problem_kind_named(const char *name)
{
    for (size_t i = 0; i < problem_kind_count; i++)
        if (strcmp(problem_kinds[i].name, name) == 0) return &problem_kinds[i];
    return NULL;
}

const problem_kind *problem_kind_titled(const char *title)
{
    for (size_t i = 0; i < problem_kind_count; i++)
        if (strcmp(problem_kinds[i].title, title) == 0) return &problem_kinds[i];
    return NULL;
}
