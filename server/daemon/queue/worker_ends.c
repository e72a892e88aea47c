/* Exit code or signal -> what becomes of the job:
 *
 *   0  result.json is there        successful; one that can't be read for want of something is read again
 *   3  stopped in good order       accepted again
 *   2, 4, 1                        failed: the same worker on the same spec would end the same way
 *   5, 6, 127, no worker at all    accepted again, after a pause: the machine had no room, memory, descriptors or program for it
 *   SIGBUS, killed out of memory   likewise
 *   SIGSYS                         likewise: a call that its confinement refuses is no fault of the job
 *   SIGTERM and the like           accepted again: somebody stopped it
 *   another signal                 accepted again, attempt + 1; failed when three in a row saved no newer checkpoint
 *   lost with its machine          accepted again
 *   out of the time it was given   accepted again with twice the time, as after another signal
 *   out of the memory likewise     accepted again with twice the memory, once; then failed
 *   withdrawn by somebody else     failed, and said so
 */
#include "worker_ends.h"

#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "job_folder.h"
#include "log.h"
#include "machine_error.h"
#include "text_copy.h"

enum { LOG_TAIL = 400, EXEC_FAILED = 127, MOST_DOUBTS = 3 };

/* The last line the worker wrote to its log, for messages. */
static void last_words(const job_dispatcher *dispatcher, const worker_slot *slot, char *text, size_t size)
{
    char tail[LOG_TAIL + 1] = "";
    const int file = job_file_open(dispatcher->store->data, slot->claim.id, NULL, JOB_LOG_FILE);
    if (file >= 0) {
        const off_t end = lseek(file, 0, SEEK_END);
        const ssize_t got = pread(file, tail, LOG_TAIL, end > LOG_TAIL ? end - LOG_TAIL : 0);
        tail[got > 0 ? got : 0] = '\0';
        close(file);
    }
    size_t length = strlen(tail);
    while (length > 0 && tail[length - 1] == '\n') tail[--length] = '\0';
    const char *line = strrchr(tail, '\n');
    json_t *check = json_string(line ? line + 1 : tail); /* a cut or strange log may be no UTF-8 */
    snprintf(text, size, "%s", check ? json_string_value(check) : "");
    json_decref(check);
}

static store_status fail(job_dispatcher *dispatcher, worker_slot *slot, const char *what)
{
    const char *said = json_string_value(json_object_get(slot->failure, "message"));
    char words[LOG_TAIL + 1], message[1000];
    last_words(dispatcher, slot, words, sizeof words);
    if (said) text_copy(message, sizeof message, said);
    else snprintf(message, sizeof message, "%s%s%s", what, words[0] ? "; its last words: " : "", words);
    const store_status status = store_record_failure(dispatcher->store, &slot->claim, message, slot->failure);
    if (status == STORE_OK) {
        dispatcher->ended[JOB_FAILED]++;
        log_line("job %s: failed: %s", slot->claim.id, message);
    }
    return status;
}

static store_status put_back(job_dispatcher *dispatcher, worker_slot *slot, bool uses_attempt, const char *why)
{
    const store_status status = store_put_back(dispatcher->store, &slot->claim, uses_attempt, why);
    if (status == STORE_OK) {
        const bool was_last = uses_attempt && job_claim_is_last(&slot->claim);
        if (was_last) dispatcher->ended[JOB_FAILED]++;
        else dispatcher->put_back++;
        log_line("job %s: %s; %s", slot->claim.id, why, was_last ? "no attempt is left" : "put back into the queue");
    }
    return status;
}

/* A verdict only on what was read: not while reading fails, nor for want of memory. STORE_FAILED: look again later. Where its
 * bytes are not those that the worker wrote, the next attempt makes it anew. */
static store_status succeed(job_dispatcher *dispatcher, worker_slot *slot)
{
    const data_folder *data = dispatcher->store->data;
    errno = 0;
    char *text = job_file_read(data, slot->claim.id, JOB_RESULT_FILE, LARGEST_RESULT);
    if (!text && machine_error_is(errno)) return STORE_FAILED;
    const bool is_there = text;
    free(text);
    char *document = job_result_read(data, slot->claim.id, NULL);
    store_status status = document ? store_record_success(dispatcher->store, &slot->claim, document) : STORE_REFUSED;
    free(document);
    if (status == STORE_OK) {
        dispatcher->ended[JOB_SUCCESSFUL]++;
        log_line("job %s: done", slot->claim.id);
    }
    if (status != STORE_REFUSED) return status;
    if (is_there && ++slot->doubts < MOST_DOUBTS) return STORE_FAILED;
    const int file = job_file_open(data, slot->claim.id, NULL, JOB_RESULT_SUM_FILE);
    if (file < 0) return fail(dispatcher, slot, "the worker ended well but left no readable result.json");
    close(file);
    return put_back(dispatcher, slot, true, "its result.json does not fit its checksum");
}

static store_status put_off(job_dispatcher *dispatcher, worker_slot *slot)
{
    const store_status status = store_put_off(dispatcher->store, &slot->claim, slot->trouble);
    if (status == STORE_OK) {
        dispatcher->put_back++;
        log_line("job %s: %s; put off", slot->claim.id, slot->trouble);
    }
    return status;
}

/* --- whose fault it was --- */

static const char *trouble_of_signal(int number)
{
    if (number == SIGBUS) return "a file that the worker needs could not be read from the disk";
    return number == SIGSYS ? "the worker's confinement refused it a system call" : NULL;
}

static const char *trouble_of_exit(int code)
{
    switch (code) {
    case WORKER_DISK: return "the worker could not write to the disk";
    case WORKER_MACHINE: return "the machine did not give the worker what it needs";
    case EXEC_FAILED: return "the worker program can't be started";
    default: return NULL;
    }
}

static const char *trouble_of(const worker_end *end)
{
    switch (end->kind) {
    case WORKER_LEFT: return trouble_of_exit(end->code);
    case WORKER_KILLED: return trouble_of_signal(end->code);
    case WORKER_STARVED: return "the machine ran out of memory, and the worker was killed";
    default: return NULL;
    }
}

bool worker_end_is_of_the_machine(const job_dispatcher *dispatcher, worker_slot *slot)
{
    const char *what = trouble_of(&slot->end);
    char words[LOG_TAIL + 1] = "";
    if (!what) return false;
    if (slot->end.why[0]) what = slot->end.why;
    if (slot->end.kind == WORKER_LEFT) last_words(dispatcher, slot, words, sizeof words);
    snprintf(slot->trouble, sizeof slot->trouble, "%s%s%s", what, words[0] ? "; its last words: " : "", words);
    return true;
}

static bool is_a_request_to_stop(int number)
{
    static const int requests[] = { JOB_STOP_SIGNALS };
    for (size_t i = 0; i < sizeof requests / sizeof requests[0]; i++)
        if (requests[i] == number) return true;
    return false;
}

static store_status record_signal(job_dispatcher *dispatcher, worker_slot *slot)
{
    char why[160];
    snprintf(why, sizeof why, "the worker was killed by signal %d (%s)", slot->end.code, strsignal(slot->end.code));
    if (dispatcher->stopping) return put_back(dispatcher, slot, false, "stopped with the daemon");
    return put_back(dispatcher, slot, !is_a_request_to_stop(slot->end.code), why);
}

/* Twice as much each time; where the run comes no further for some attempts, more does not help. */
static store_status record_lack_of_time(job_dispatcher *dispatcher, worker_slot *slot)
{
    slot->claim.more_time++;
    const store_status status = put_back(dispatcher, slot, true, slot->end.why);
    if (status != STORE_OK) slot->claim.more_time--; /* tried again */
    return status;
}

static store_status record_lack_of_memory(job_dispatcher *dispatcher, worker_slot *slot)
{
    if (slot->claim.more_memory > 0) return fail(dispatcher, slot, slot->end.why);
    slot->claim.more_memory++;
    const store_status status = put_back(dispatcher, slot, false, slot->end.why);
    if (status != STORE_OK) slot->claim.more_memory--;
    return status;
}

static store_status record_exit(job_dispatcher *dispatcher, worker_slot *slot)
{
    switch (slot->end.code) {
    case WORKER_DONE: return succeed(dispatcher, slot);
    case WORKER_STOPPED: return put_back(dispatcher, slot, false, "stopped in good order");
    case WORKER_BAD_SPEC: return fail(dispatcher, slot, "the worker refused the specification");
    case WORKER_NUMERICAL: return fail(dispatcher, slot, "the simulation broke down");
    default: return fail(dispatcher, slot, "the worker ended with a fault of its own");
    }
}

store_status worker_end_record(job_dispatcher *dispatcher, worker_slot *slot)
{
    if (slot->trouble[0]) return put_off(dispatcher, slot);
    switch (slot->end.kind) {
    case WORKER_KILLED: return record_signal(dispatcher, slot);
    case WORKER_LOST: return put_back(dispatcher, slot, false, slot->end.why);
    case WORKER_WITHDRAWN: return fail(dispatcher, slot, slot->end.why);
    case WORKER_OUT_OF_TIME: return record_lack_of_time(dispatcher, slot);
    case WORKER_OUT_OF_MEMORY: return record_lack_of_memory(dispatcher, slot);
    default: return record_exit(dispatcher, slot);
    }
}
