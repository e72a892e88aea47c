#include "executor_slurm.h"

#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "job_folder.h"
#include "log.h"
#include "slurm_queue.h"

/* What a job is given: so many times what it is expected to take, and something for its start. */
#define TIME_FACTOR 3.0
#define TIME_TO_START 60.0 /* s */
#define MEMORY_FACTOR 2.0
#define MEMORY_TO_START 268435456.0
#define SECONDS_TO_APPEAR 60.0  /* what was written on another machine may be seen so much later */
#define SECONDS_TO_BE_GONE 30.0 /* after which a worker that was told to leave is not waited for */

enum { MOST_PLACES = 50000, LONGEST_PATH = 4200 };

/* What a handle has of its own. */
enum { BUNDLE, MEMBER };

static slurm_bundle *bundle_of(const worker_handle *worker) { return (slurm_bundle *)(intptr_t)worker->own[BUNDLE]; }
static bundle_member *member_of(const worker_handle *worker) { return &bundle_of(worker)->member[worker->own[MEMBER]]; }

/* --- starting --- */

static void write_name(const slurm_bundle *bundle, worker_handle *worker)
{
    if (*bundle->id) snprintf(worker->name, sizeof worker->name, "Slurm job %s (%s)", bundle->id, bundle->name);
    else snprintf(worker->name, sizeof worker->name, "Slurm job (%s)", bundle->name);
}

static bundle_member member_for(const slurm_settings *settings, const worker_order *order)
{
    bundle_member member = { .start = order->start,
                             .attempt = order->attempt,
                             .threads = order->threads,
                             .save_bed = order->save_bed,
                             .is_followed = true,
                             .code = -1 };
    snprintf(member.job, sizeof member.job, "%s", order->job);
    member.seconds = fmin(settings->longest, ldexp(TIME_TO_START + TIME_FACTOR * order->estimated_seconds, order->more_time));
    member.memory_bytes = ldexp(MEMORY_TO_START + MEMORY_FACTOR * order->estimated_memory_bytes, order->more_memory);
    return member;
}

static double expected_seconds(const slurm_bundle *bundle)
{
    double seconds = 0.0;
    for (int m = 0; m < bundle->count; m++) seconds += bundle->member[m].seconds;
    return (seconds - bundle->count * TIME_TO_START) / TIME_FACTOR;
}

/* One that was cut short or needs more than it was given is alone. */
static bool fits(const slurm_settings *settings, const slurm_bundle *bundle, const worker_order *order)
{
    return bundle->count < BUNDLE_MOST && bundle->member[0].threads == order->threads && order->more_time == 0
           && order->more_memory == 0 && strcmp(bundle->resources, order->resources) == 0
           && expected_seconds(bundle) + order->estimated_seconds <= settings->bundle_seconds;
}

static bool start(worker_executor *executor, const worker_order *order, worker_handle *worker)
{
    slurm_queue *queue = executor->own;
    pthread_mutex_lock(&queue->lock);
    if (queue->open && !fits(&queue->settings, queue->open, order)) slurm_queue_close_bundle(queue);
    slurm_bundle *bundle = queue->open ? queue->open : slurm_queue_open_bundle(queue, order->job, order->start);
    if (bundle) {
        snprintf(bundle->resources, sizeof bundle->resources, "%s", order->resources);
        bundle->member[bundle->count] = member_for(&queue->settings, order);
        *worker = (worker_handle){ .own = { [BUNDLE] = (int64_t)(intptr_t)bundle, [MEMBER] = bundle->count } };
        snprintf(worker->waits_for, sizeof worker->waits_for, "to be handed to Slurm");
        write_name(bundle, worker);
        bundle->count++;
        const bool is_alone = order->more_time > 0 || order->more_memory > 0;
        if (is_alone || expected_seconds(bundle) >= queue->settings.bundle_seconds) slurm_queue_close_bundle(queue);
        pthread_cond_signal(&queue->there_is_work);
    }
    pthread_mutex_unlock(&queue->lock);
    return bundle != NULL;
}

static bool has_room(worker_executor *executor)
{
    slurm_queue *queue = executor->own;
    pthread_mutex_lock(&queue->lock);
    queue->is_recovered = true; /* nothing is started before */
    const bool has = queue->open || slurm_queue_length(queue) < queue->settings.queue;
    pthread_mutex_unlock(&queue->lock);
    return has;
}

/* --- how it goes --- */

/* A worker that was stopped or killed: why, Slurm says. */
static bool tells_all(int code) { return code >= 0 && code != WORKER_STOPPED && code < 128; }

/* One before it ended so that the script did not go on. */
static bool was_cut_off(const slurm_bundle *bundle, int index)
{
    for (int m = 0; m < index; m++)
        if (bundle->member[m].code >= 0 && !tells_all(bundle->member[m].code)) return true;
    return false;
}

static bool result_is_there(const slurm_queue *queue, const bundle_member *member)
{
    char path[LONGEST_PATH];
    snprintf(path, sizeof path, "%s/jobs/%s/" JOB_RESULT_FILE, queue->data->path, member->job);
    const int file = open(path, O_RDONLY | O_CLOEXEC | O_NOFOLLOW); /* opening asks the server, where a look may not */
    if (file >= 0) close(file);
    return file >= 0;
}

static worker_end end_because(worker_end_kind kind, int code, const char *format, const char *id)
{
    worker_end end = { .kind = kind, .code = code };
    snprintf(end.why, sizeof end.why, format, id);
    return end;
}
#define END_BECAUSE(kind, code, text) end_because(kind, code, text, bundle->id)

/* Of one that has begun, and whose script was killed before it could say how it ended: that may be the job's own fault, so it
 * counts. */
static void judge_wordless(const slurm_queue *queue, const slurm_bundle *bundle, worker_end *end)
{
    if (slurm_bundle_took_too_much_memory(bundle, queue->data))
        *end = END_BECAUSE(WORKER_OUT_OF_MEMORY, 0, "Slurm job %s took more memory than it was given");
    else *end = END_BECAUSE(WORKER_KILLED, SIGKILL, "Slurm job %s was killed and has left no word of how");
}

/* Of one whose script has ended, by itself as Slurm has it. False: what it wrote may still be on its way. */
static bool judge_done(const slurm_queue *queue, const slurm_bundle *bundle, const bundle_member *member, bool is_late,
                       worker_end *end)
{
    const int index = (int)(member - bundle->member);
    if (member->code >= 128) *end = (worker_end){ .kind = WORKER_KILLED, .code = member->code - 128 };
    else if (member->code == WORKER_STOPPED)
        *end = END_BECAUSE(WORKER_OUT_OF_TIME, 0, "the time that Slurm job %s was given was too short; it goes on with more");
    else if (was_cut_off(bundle, index) || (is_late && index > 0 && bundle->member[index - 1].has_begun && !member->has_begun))
        *end = END_BECAUSE(WORKER_LOST, 0, "Slurm job %s ended before its turn");
    else if (is_late && member->has_begun) judge_wordless(queue, bundle, end);
    else if (is_late) *end = END_BECAUSE(WORKER_LEFT, WORKER_MACHINE, "Slurm job %s ended and has left no word of how");
    else return false;
    return true;
}

/* Of one whose Slurm job has ended. False: not yet to be said. */
static bool judge_gone(const slurm_queue *queue, const slurm_bundle *bundle, const bundle_member *member, worker_end *end)
{
    const bool is_late = monotonic_seconds() - bundle->gone > SECONDS_TO_APPEAR;
    switch (bundle->state) {
    case SLURM_CANCELLED:
        *end = END_BECAUSE(WORKER_WITHDRAWN, 0, "Slurm job %s was cancelled, and not by this service; not tried again");
        return true;
    case SLURM_LOST: *end = END_BECAUSE(WORKER_LOST, 0, "Slurm job %s was lost with its node or preempted"); return true;
    case SLURM_OUT_OF_TIME:
    case SLURM_OUT_OF_MEMORY:
        if (!member->has_begun) *end = END_BECAUSE(WORKER_LOST, 0, "Slurm job %s ended before its turn");
        else if (bundle->state == SLURM_OUT_OF_TIME)
            *end = END_BECAUSE(WORKER_OUT_OF_TIME, 0, "the time that Slurm job %s was given was too short; it goes on with more");
        else *end = END_BECAUSE(WORKER_OUT_OF_MEMORY, 0, "Slurm job %s took more memory than it was given");
        return true;
    case SLURM_DONE: return judge_done(queue, bundle, member, is_late, end);
    default: *end = END_BECAUSE(WORKER_LOST, 0, "Slurm knows nothing of job %s any more"); return is_late;
    }
}

/* False: it has not ended, or nobody can tell how yet. */
static bool judge(const slurm_queue *queue, const slurm_bundle *bundle, bundle_member *member, worker_end *end)
{
    const double now = monotonic_seconds();
    if (member->code >= 0 && member->code_since == 0.0) member->code_since = now;
    if (member->is_asked_to_stop && (member->code >= 0 || bundle->gone > 0.0 || now - member->stop_asked > SECONDS_TO_BE_GONE)) {
        *end = (worker_end){ .code = WORKER_STOPPED };
        return true;
    }
    if (!tells_all(member->code)) return bundle->gone > 0.0 && judge_gone(queue, bundle, member, end);
    *end = (worker_end){ .code = member->code };
    return member->code != WORKER_DONE || result_is_there(queue, member) || now - member->code_since > SECONDS_TO_APPEAR;
}

static void write_news(const slurm_queue *queue, const slurm_bundle *bundle, const bundle_member *member, worker_handle *worker)
{
    char *news = worker->waits_for;
    const size_t size = sizeof worker->waits_for;
    *news = '\0';
    if (member->has_begun) return;
    if (bundle->stage < BUNDLE_QUEUED && *bundle->reason)
        snprintf(news, size, "sbatch refuses it, and is tried again: %s", bundle->reason);
    else if (bundle->stage < BUNDLE_QUEUED)
        snprintf(news, size, "to be handed to Slurm%s%s", *queue->trouble ? ", which does not answer: " : "", queue->trouble);
    else if (bundle->state == SLURM_WAITS)
        snprintf(news, size, "waits in Slurm's queue as job %s%s%s", bundle->id, *bundle->reason ? ": " : "", bundle->reason);
    else snprintf(news, size, "waits for its turn in Slurm job %s", bundle->id);
}

/* Jobs of a bundle run one after the other: only the first without an end can have a new one. */
static bool is_its_turn(slurm_bundle *bundle, int index)
{
    while (bundle->current < bundle->count && bundle->member[bundle->current].code >= 0) bundle->current++;
    return bundle->gone > 0.0 || (bundle->state == SLURM_RUNS && index == bundle->current) || bundle->member[index].has_begun;
}

/* However it ended for us, should it still be at work somewhere, it is to leave. */
static void forget(slurm_queue *queue, bundle_member *member)
{
    bool has_begun;
    member->is_followed = false;
    if (!tells_all(member->code)) slurm_fence_tell(queue->data, member, "leave", &has_begun);
}

static bool has_ended(worker_executor *executor, worker_handle *worker, worker_end *end)
{
    slurm_queue *queue = executor->own;
    slurm_bundle *bundle = bundle_of(worker);
    bundle_member *member = member_of(worker);
    uint64_t rung;
    const ssize_t ignored = read(queue->bell, &rung, sizeof rung);
    (void)ignored;
    pthread_mutex_lock(&queue->lock);
    if (bundle->stage == BUNDLE_QUEUED && member->code < 0 && is_its_turn(bundle, (int)worker->own[MEMBER]))
        slurm_fence_read(queue->data, member, &member->has_begun, &member->code);
    const bool ended = judge(queue, bundle, member, end);
    if (ended) {
        forget(queue, member);
    } else {
        write_name(bundle, worker);
        write_news(queue, bundle, member, worker);
    }
    pthread_mutex_unlock(&queue->lock);
    if (ended) *worker = (worker_handle){ .own = { 0 } };
    return ended;
}

/* --- stopping --- */

static void tell(worker_executor *executor, const worker_handle *worker, const char *word)
{
    slurm_queue *queue = executor->own;
    bundle_member *member = member_of(worker);
    bool has_begun;
    slurm_fence_tell(queue->data, member, word, &has_begun);
    if (!has_begun) member->code = WORKER_STOPPED;
}

static void ask_to_stop(worker_executor *executor, const worker_handle *worker)
{
    slurm_queue *queue = executor->own;
    bundle_member *member = member_of(worker);
    pthread_mutex_lock(&queue->lock);
    if (!member->is_asked_to_stop) {
        member->is_asked_to_stop = true;
        member->stop_asked = monotonic_seconds();
        tell(executor, worker, "stop");
        pthread_cond_signal(&queue->there_is_work);
    }
    pthread_mutex_unlock(&queue->lock);
}

static void kill_worker(worker_executor *executor, const worker_handle *worker)
{
    slurm_queue *queue = executor->own;
    bundle_member *member = member_of(worker);
    pthread_mutex_lock(&queue->lock);
    if (!member->is_sent_away) tell(executor, worker, "leave");
    member->is_sent_away = true;
    pthread_mutex_unlock(&queue->lock);
}

/* --- after another daemon --- */

static bool adopt(worker_executor *executor, const worker_order *order, const char *name, worker_handle *worker)
{
    slurm_queue *queue = executor->own;
    (void)name; /* it stands in no row yet where the daemon died at once: a bundle's script is there earlier */
    bool found = false;
    pthread_mutex_lock(&queue->lock);
    for (int b = 0; b < queue->count && !found; b++) {
        slurm_bundle *bundle = queue->bundle[b];
        for (int m = 0; m < bundle->count && !found; m++) {
            bundle_member *member = &bundle->member[m];
            if (member->start != order->start || strcmp(member->job, order->job) != 0) continue;
            found = member->is_followed = true;
            *worker = (worker_handle){ .own = { [BUNDLE] = (int64_t)(intptr_t)bundle, [MEMBER] = m } };
            slurm_fence_read(queue->data, member, &member->has_begun, &member->code);
            write_name(bundle, worker);
            write_news(queue, bundle, member, worker);
        }
    }
    pthread_mutex_unlock(&queue->lock);
    return found;
}

static void count(worker_executor *executor, executor_counts *counts)
{
    slurm_queue *queue = executor->own;
    pthread_mutex_lock(&queue->lock);
    *counts = queue->counts;
    counts->pause = queue->pause;
    pthread_mutex_unlock(&queue->lock);
}

bool executor_slurm_init(worker_executor *executor, const slurm_settings *settings, const data_folder *data, const char *program,
                         bool confine)
{
    slurm_queue *queue = calloc(1, sizeof *queue);
    if (!queue) return false;
    *queue = (slurm_queue){ .settings = *settings, .data = data, .worker = { program, confine } };
    if (!slurm_queue_start(queue)) {
        free(queue);
        return false;
    }
    const int most = settings->bundle_seconds > 0 ? BUNDLE_MOST * settings->queue : settings->queue;
    *executor = (worker_executor){ .start = start,
                                   .has_ended = has_ended,
                                   .ask_to_stop = ask_to_stop,
                                   .kill = kill_worker,
                                   .adopt = adopt,
                                   .has_room = has_room,
                                   .count = count,
                                   .places = most < MOST_PLACES ? most : MOST_PLACES,
                                   .bell = queue->bell,
                                   .own = queue };
    return true;
}

void executor_slurm_clear(worker_executor *executor)
{
    slurm_queue_stop(executor->own);
    free(executor->own);
}
