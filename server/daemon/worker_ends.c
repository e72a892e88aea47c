/* Exit code or signal -> what becomes of the job:
 *
 *   0  result.json is there     successful
 *   3  stopped in good order    accepted again, the attempt not used up
 *   5  disk                     accepted again, attempt + 1, after a pause in which somebody may make room; failed as below
 *   2, 4, 1, 127                failed: the same worker on the same spec would end the same way
 *   a signal                    accepted again, attempt + 1; failed when three in a row saved no newer checkpoint
 */
#include "worker_ends.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "job_folder.h"
#include "log.h"

enum { LOG_TAIL = 600 };
#define PAUSE_AFTER_FULL_DISK 30.0 /* s */

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
    if (said) snprintf(message, sizeof message, "%s", said);
    else snprintf(message, sizeof message, "%s%s%s", what, words[0] ? "; its last words: " : "", words);
    const store_status status = store_record_failure(dispatcher->store, &slot->claim, message, slot->failure);
    if (status == STORE_OK) {
        dispatcher->ended[JOB_FAILED]++;
        log_line("job %s: failed: %s", slot->claim.id, message);
    }
    return status;
}

static store_status put_back(job_dispatcher *dispatcher, worker_slot *slot, bool uses_attempt, double delay, const char *why)
{
    const store_status status = store_put_back(dispatcher->store, &slot->claim, uses_attempt, delay, why);
    if (status == STORE_OK) {
        const bool was_last = uses_attempt && job_claim_is_last(&slot->claim);
        if (was_last) dispatcher->ended[JOB_FAILED]++;
        else dispatcher->put_back++;
        log_line("job %s: %s; %s", slot->claim.id, why, was_last ? "no attempt is left" : "put back into the queue");
    }
    return status;
}

/* Where its bytes are not those that the worker wrote, the next attempt makes it anew. */
static store_status succeed(job_dispatcher *dispatcher, worker_slot *slot)
{
    char *document = job_result_read(dispatcher->store->data, slot->claim.id);
    const int file = document ? -1 : job_file_open(dispatcher->store->data, slot->claim.id, NULL, JOB_RESULT_SUM_FILE);
    store_status status;
    if (document) {
        status = store_record_success(dispatcher->store, &slot->claim, document);
        if (status == STORE_OK) {
            dispatcher->ended[JOB_SUCCESSFUL]++;
            log_line("job %s: done", slot->claim.id);
        }
    } else if (file >= 0) {
        status = put_back(dispatcher, slot, true, 0.0, "its result.json does not fit its checksum");
    } else {
        status = fail(dispatcher, slot, "the worker ended well but left no readable result.json");
    }
    if (file >= 0) close(file);
    free(document);
    return status;
}

static store_status record_signal(job_dispatcher *dispatcher, worker_slot *slot)
{
    char why[160];
    snprintf(why, sizeof why, "the worker was killed by signal %d (%s)", slot->end.code, strsignal(slot->end.code));
    if (dispatcher->stopping) return put_back(dispatcher, slot, false, 0.0, "stopped with the daemon");
    return put_back(dispatcher, slot, true, 0.0, why);
}

store_status worker_end_record(job_dispatcher *dispatcher, worker_slot *slot)
{
    if (slot->end.by_signal) return record_signal(dispatcher, slot);
    switch (slot->end.code) {
    case WORKER_DONE: return succeed(dispatcher, slot);
    case WORKER_STOPPED: return put_back(dispatcher, slot, false, 0.0, "stopped in good order");
    case WORKER_DISK: return put_back(dispatcher, slot, true, PAUSE_AFTER_FULL_DISK, "the worker could not write to the disk");
    case WORKER_BAD_SPEC: return fail(dispatcher, slot, "the worker refused the specification");
    case WORKER_NUMERICAL: return fail(dispatcher, slot, "the simulation broke down");
    case 127: return fail(dispatcher, slot, "the worker program can't be started");
    default: return fail(dispatcher, slot, "the worker ended with a fault of its own");
    }
}
