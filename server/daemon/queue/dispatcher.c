/* Rounds: sleep until a worker ends, somebody wakes us or a second has passed; then record what the workers wrote
 * (one transaction for all), record the ends, and start what fits. A round that can't write to the database changes
 * nothing and the next one tries again: an ended worker keeps its slot until its end is recorded. */
#include "dispatcher.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include "checksum.h"
#include "job_folder.h"
#include "log.h"
#include "worker_ends.h"

#define SECONDS_TO_LEAVE 5.0        /* between SIGTERM and SIGKILL */
#define SECONDS_TO_RECORD 10.0      /* after which the daemon leaves although the store refuses */
#define SECONDS_OF_SILENCE 15.0     /* workers report every second, but for some steps that may take long */
#define SECONDS_OF_A_SHORT_JOB 30.0 /* after which it is none, whatever was expected */
#define GIGABYTE 1073741824.0
#define MOST_THREADS 1000000 /* of workers that share no machine */

#define SECONDS_OF_STARTING 0.5 /* in a round: what workers write is recorded meanwhile, too */

enum { BUSY_ROUND_MS = 1000, IDLE_ROUND_MS = 5000, BATCHES_A_ROUND = 8, LONGEST_NUMBER = 21 };

/* Under nohup SIGHUP is ignored, and a blocked signal would come through all the same. */
void dispatcher_end_signals(sigset_t *ends)
{
    static const int signals[] = { JOB_STOP_SIGNALS };
    struct sigaction action;
    sigemptyset(ends);
    for (size_t s = 0; s < sizeof signals / sizeof signals[0]; s++)
        if (signals[s] != SIGHUP || (sigaction(SIGHUP, NULL, &action) == 0 && action.sa_handler != SIG_IGN))
            sigaddset(ends, signals[s]);
    for (int real_time = SIGRTMIN; real_time <= SIGRTMAX; real_time++) sigaddset(ends, real_time);
}

bool dispatcher_init(job_dispatcher *dispatcher, job_store *store, worker_executor *executor, int threads_per_job, int signals)
{
    const int workers = executor->places, slots = workers + 1;
    *dispatcher = (job_dispatcher){ .store = store, .executor = executor, .workers = workers, .slots = slots, .signals = signals };
    dispatcher->threads = executor->shares_threads ? workers * threads_per_job : MOST_THREADS;
    dispatcher->wake = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    dispatcher->slot = calloc((size_t)slots, sizeof dispatcher->slot[0]);
    dispatcher->beds = malloc(4 + (size_t)slots * LONGEST_NUMBER);
    dispatcher->last_round = monotonic_seconds();
    return dispatcher->slot && dispatcher->beds && dispatcher->wake >= 0;
}

void dispatcher_set_threads(job_dispatcher *dispatcher, int threads_per_job)
{
    if (dispatcher->executor->shares_threads) dispatcher->threads = dispatcher->workers * threads_per_job;
    dispatcher_wake(dispatcher);
}

void dispatcher_clear(job_dispatcher *dispatcher)
{
    close(dispatcher->wake);
    free(dispatcher->slot);
    free(dispatcher->beds);
}

void dispatcher_wake(job_dispatcher *dispatcher)
{
    const uint64_t one = 1;
    const ssize_t ignored = write(dispatcher->wake, &one, sizeof one); /* full: it is awake already */
    (void)ignored;
}

/* --- starting --- */

/* Of all that are in use: the first of them, and the one after. NULL: no more. */
static worker_slot *next_slot(const job_dispatcher *dispatcher, const worker_slot *after)
{
    const worker_slot *lane = &dispatcher->slot[dispatcher->workers];
    worker_slot *slot = after ? dispatcher->slot + (after - dispatcher->slot) + 1 : dispatcher->slot;
    for (; slot < dispatcher->slot + dispatcher->used; slot++)
        if (slot->state != SLOT_FREE) return slot;
    if (after == lane || lane->state == SLOT_FREE) return NULL;
    return dispatcher->slot + dispatcher->workers;
}

static int threads_in_use(const job_dispatcher *dispatcher)
{
    int threads = 0;
    for (int i = 0; dispatcher->executor->shares_threads && i < dispatcher->used; i++)
        if (dispatcher->slot[i].state != SLOT_FREE) threads += dispatcher->slot[i].claim.threads;
    return threads;
}

static worker_slot *free_slot(job_dispatcher *dispatcher)
{
    worker_executor *executor = dispatcher->executor;
    if (executor->has_room && !executor->has_room(executor)) return NULL;
    const bool lane_taken = dispatcher->slot[dispatcher->workers].state != SLOT_FREE;
    const bool has_gaps = dispatcher->taken - lane_taken < dispatcher->used;
    for (int i = has_gaps ? 0 : dispatcher->used; i < dispatcher->workers; i++)
        if (dispatcher->slot[i].state == SLOT_FREE) return &dispatcher->slot[i];
    return NULL;
}

static void take_slot(job_dispatcher *dispatcher, worker_slot *slot, const job_claim *claim)
{
    const double now = monotonic_seconds();
    const int index = (int)(slot - dispatcher->slot);
    *slot = (worker_slot){ .state = SLOT_WORKING, .claim = *claim, .events = -1, .speed = NAN, .started = now, .last_word = now };
    if (index < dispatcher->workers && index >= dispatcher->used) dispatcher->used = index + 1;
    dispatcher->taken++;
}

/* Bounds against a worker gone wild, far above what a sound one needs. */
static void set_limits(const job_claim *claim, worker_order *order)
{
    order->memory_bytes = 2.0 * GIGABYTE + 4.0 * claim->estimated_memory_bytes + 0.125 * GIGABYTE * claim->threads;
    order->cpu_seconds = fmin(1e9, 86400.0 + 50.0 * claim->estimated_seconds * claim->threads);
    order->file_bytes = 16.0 * GIGABYTE;
}

/* JSON: a list of the beds that workers are settling and other jobs wait for. Not for a worker that is held up. */
static const char *beds_in_work(const job_dispatcher *dispatcher)
{
    const size_t room = 4 + (size_t)dispatcher->slots * LONGEST_NUMBER;
    size_t length = (size_t)snprintf(dispatcher->beds, room, "[0");
    for (const worker_slot *slot = next_slot(dispatcher, NULL); slot; slot = next_slot(dispatcher, slot))
        if (slot->state == SLOT_WORKING && slot->settles && !slot->silent && !slot->claim_lost)
            length += (size_t)snprintf(dispatcher->beds + length, room - length, ",%" PRId64, slot->claim.bed);
    snprintf(dispatcher->beds + length, room - length, "]");
    return dispatcher->beds;
}

static worker_order order_of(const job_claim *claim, const char *folder, int file)
{
    worker_order order = { .job = claim->id,
                           .job_folder = folder,
                           .job_folder_file = file,
                           .attempt = claim->attempt,
                           .threads = claim->threads,
                           .start = claim->starts,
                           .estimated_seconds = claim->estimated_seconds,
                           .estimated_memory_bytes = claim->estimated_memory_bytes,
                           .more_time = claim->more_time,
                           .more_memory = claim->more_memory,
                           .resources = claim->resources };
    set_limits(claim, &order);
    return order;
}

static bool start_worker(job_dispatcher *dispatcher, worker_slot *slot)
{
    const data_folder *data = dispatcher->store->data;
    const job_claim *claim = &slot->claim;
    char folder[4096];
    snprintf(folder, sizeof folder, "%s/jobs/%s", data->path, claim->id);
    job_folder_tidy(data, claim->id);
    /* Somebody may have tidied the folder away while the job waited. */
    const bool is_there = job_folder_create(data, claim->id, claim->spec) && job_folder_sync(data, claim->id);
    const int file = is_there ? job_folder_open(data, claim->id) : -1;
    if (file < 0) return false;
    slot->settles = claim->bed && !store_bring_bed(dispatcher->store, claim);
    worker_order order = order_of(claim, folder, file);
    order.save_bed = slot->settles;
    const bool started = dispatcher->executor->start(dispatcher->executor, &order, &slot->worker);
    close(file);
    return started;
}

/* Not while the machine can't run jobs; then one after the other, until a worker is well. */
static bool may_start(const job_dispatcher *dispatcher)
{
    if (!dispatcher->recovered || queue_pause_holds(&dispatcher->pause, monotonic_seconds())) return false;
    if (dispatcher->pause.setbacks == 0) return true;
    for (const worker_slot *slot = next_slot(dispatcher, NULL); slot; slot = next_slot(dispatcher, slot))
        if (queue_pause_is_trying(&dispatcher->pause, slot->started)) return false;
    return true;
}

/* A short job does not wait for long ones: where nothing else is at work, one of them runs beside these. It is a place of its own,
 * since one kept free of long jobs would stand empty most of the time; and what it takes from the others is two seconds now
 * and then. A job that should have been short and is not counts as long after a while. */
static worker_slot *free_lane(job_dispatcher *dispatcher)
{
    const double now = monotonic_seconds();
    worker_slot *lane = &dispatcher->slot[dispatcher->workers];
    if (!dispatcher->executor->shares_threads || lane->state != SLOT_FREE || dispatcher->pause.setbacks > 0) return NULL;
    for (int i = 0; i < dispatcher->used; i++) {
        const worker_slot *slot = &dispatcher->slot[i];
        if (slot->state == SLOT_FREE) continue;
        if (slot->claim.estimated_seconds < SHORT_JOB && now - slot->started < SECONDS_OF_A_SHORT_JOB) return NULL;
    }
    return lane;
}

/* The slot that has got a job; NULL: no job waits that fits, or the store refuses. */
static worker_slot *claim_next_job(job_dispatcher *dispatcher, job_claim *claim)
{
    /* One that tries after a pause is the least suspect: a few that this machine can't run would be in all others' way. */
    const queue_order order = dispatcher->pause.setbacks > 0 ? QUEUE_BY_SETBACKS : QUEUE_BY_TURN;
    const int all = dispatcher->threads, left = all - threads_in_use(dispatcher);
    const char *beds = beds_in_work(dispatcher);
    worker_slot *slot = free_slot(dispatcher);
    if (slot && store_claim_job(dispatcher->store, order, left, all, beds, claim) == STORE_OK) return slot;
    worker_slot *lane = free_lane(dispatcher);
    return lane && store_claim_job(dispatcher->store, QUEUE_SHORT, all, all, beds, claim) == STORE_OK ? lane : NULL;
}

/* False: none was started. */
static bool start_next_job(job_dispatcher *dispatcher)
{
    job_claim claim;
    worker_slot *slot = may_start(dispatcher) ? claim_next_job(dispatcher, &claim) : NULL;
    if (!slot) return false;
    take_slot(dispatcher, slot, &claim);
    const bool started = start_worker(dispatcher, slot);
    const int reason = errno;
    job_claim_clear(&slot->claim);
    if (started) {
        dispatcher->started++;
        log_line("job %s: attempt %d started, %s", claim.id, claim.attempt, slot->worker.name);
    } else { /* no folder or no process to be had */
        slot->state = SLOT_ENDED;
        slot->end = (worker_end){ .code = WORKER_MACHINE };
        snprintf(slot->trouble, sizeof slot->trouble, "its worker can't be started: %s", strerror(reason));
        queue_pause_add(&dispatcher->pause, monotonic_seconds());
    }
    dispatcher->jobs_changed(dispatcher->context);
    return true;
}

static void start_jobs(job_dispatcher *dispatcher)
{
    const double until = monotonic_seconds() + SECONDS_OF_STARTING;
    while (start_next_job(dispatcher))
        if (monotonic_seconds() > until) {
            dispatcher_wake(dispatcher);
            return;
        }
}

/* --- following --- */

static store_status record_batch(job_dispatcher *dispatcher, worker_slot *slot, bool *more)
{
    if (slot->events < 0) slot->events = job_file_open(dispatcher->store->data, slot->claim.id, NULL, JOB_EVENTS_FILE);
    event_batch batch;
    *more = false;
    if (slot->events < 0 || !event_tail_read(slot->events, slot->events_at, &batch)) return STORE_OK;
    const store_status status = batch.any ? store_record_events(dispatcher->store, &slot->claim, &batch) : STORE_OK;
    if (status == STORE_OK) {
        *more = batch.more;
        job_claim_note(&slot->claim, &batch);
        slot->events_at = batch.end;
        if (batch.any) {
            slot->last_word = monotonic_seconds();
            slot->silent = false;
            queue_pause_note_well(&dispatcher->pause, slot->started, slot->last_word);
        }
        if (isfinite(batch.speed)) slot->speed = batch.speed;
        if (*batch.bed) slot->settles = false;
        if (batch.failure) {
            json_decref(slot->failure);
            slot->failure = json_incref(batch.failure);
        }
    }
    event_batch_clear(&batch);
    return status;
}

/* Somebody may have stopped it to have the machine for himself, or swapping may hold it up: it is not killed for that, but
 * who looks at the job is told. Its next progress takes the message's place. */
static store_status record_silence(job_dispatcher *dispatcher, worker_slot *slot)
{
    const double seconds = monotonic_seconds() - slot->last_word;
    if (slot->silent || slot->state != SLOT_WORKING || slot->worker.waits_for[0] || seconds < SECONDS_OF_SILENCE) return STORE_OK;
    const store_status status = store_record_silence(dispatcher->store, &slot->claim, seconds);
    if (status != STORE_OK) return status;
    slot->silent = true;
    log_line("job %s: no word from %s for %.0f s", slot->claim.id, slot->worker.name, seconds);
    return STORE_OK;
}

/* What the next daemon finds the worker by, and why it has not begun to work. */
static store_status record_worker(job_dispatcher *dispatcher, worker_slot *slot)
{
    const worker_handle *worker = &slot->worker;
    if (!dispatcher->executor->adopt || slot->state != SLOT_WORKING) return STORE_OK;
    if (worker->waits_for[0]) slot->last_word = monotonic_seconds();
    const uint64_t told =
        checksum_of(worker->name, strlen(worker->name)) ^ checksum_of(worker->waits_for, strlen(worker->waits_for));
    if (told == slot->told) return STORE_OK;
    const store_status status = store_record_worker(dispatcher->store, &slot->claim, worker->name, worker->waits_for);
    if (status == STORE_OK) slot->told = told;
    return status;
}

static store_status record_events_of(job_dispatcher *dispatcher, worker_slot *slot)
{
    bool more = !slot->worker.waits_for[0];
    store_status status = record_worker(dispatcher, slot);
    for (int i = 0; more && status == STORE_OK && i < BATCHES_A_ROUND; i++) status = record_batch(dispatcher, slot, &more);
    if (status == STORE_OK) status = record_silence(dispatcher, slot);
    if (status == STORE_CONFLICT) slot->claim_lost = true;
    return status == STORE_CONFLICT ? STORE_OK : status;
}

/* One transaction for what all workers wrote. If it fails nothing is forgotten: the files still have it. */
static void record_events(job_dispatcher *dispatcher)
{
    bool any = false;
    for (worker_slot *slot = next_slot(dispatcher, NULL); slot; slot = next_slot(dispatcher, slot)) {
        slot->events_before = slot->events_at;
        slot->told_before = slot->told;
        any = any || !slot->claim_lost;
    }
    if (!any) return;
    store_status status = store_begin(dispatcher->store);
    if (status == STORE_OK) {
        for (worker_slot *slot = next_slot(dispatcher, NULL); status == STORE_OK && slot; slot = next_slot(dispatcher, slot))
            if (!slot->claim_lost) status = record_events_of(dispatcher, slot);
        status = store_end(dispatcher->store, status);
    }
    if (status == STORE_OK) return;
    dispatcher->store_failures++;
    for (worker_slot *slot = next_slot(dispatcher, NULL); slot; slot = next_slot(dispatcher, slot)) {
        slot->events_at = slot->events_before;
        slot->told = slot->told_before;
    }
}

/* --- stopping and ending --- */

static void stop_worker(job_dispatcher *dispatcher, worker_slot *slot)
{
    const double now = monotonic_seconds();
    if (slot->stop_asked == 0.0) {
        slot->stop_asked = now;
        dispatcher->executor->ask_to_stop(dispatcher->executor, &slot->worker);
    } else if (now - slot->stop_asked > SECONDS_TO_LEAVE) {
        dispatcher->executor->kill(dispatcher->executor, &slot->worker);
    }
}

/* Workers that outlive the daemon are left to the next. */
static bool takes_workers_along(const job_dispatcher *dispatcher) { return dispatcher->stopping && !dispatcher->executor->adopt; }

static void stop_unwanted(job_dispatcher *dispatcher)
{
    for (worker_slot *slot = next_slot(dispatcher, NULL); slot; slot = next_slot(dispatcher, slot)) {
        if (slot->state != SLOT_WORKING) continue;
        /* Leaving asks nobody: the store may be what hangs. */
        if (!dispatcher->stopping && !slot->claim_lost && !store_claim_holds(dispatcher->store, &slot->claim))
            slot->claim_lost = true;
        if (slot->claim_lost || takes_workers_along(dispatcher)) stop_worker(dispatcher, slot);
    }
}

static void notice_ends(job_dispatcher *dispatcher)
{
    for (worker_slot *slot = next_slot(dispatcher, NULL); slot; slot = next_slot(dispatcher, slot)) {
        if (slot->state != SLOT_WORKING || !dispatcher->executor->has_ended(dispatcher->executor, &slot->worker, &slot->end))
            continue;
        slot->state = SLOT_ENDED;
        if (worker_end_is_of_the_machine(dispatcher, slot)) queue_pause_add(&dispatcher->pause, monotonic_seconds());
        else queue_pause_note_end(&dispatcher->pause, slot->started);
    }
}

static void release_slot(job_dispatcher *dispatcher, worker_slot *slot)
{
    if (slot->events >= 0) close(slot->events);
    json_decref(slot->failure);
    *slot = (worker_slot){ .state = SLOT_FREE, .events = -1 };
    dispatcher->taken--;
    while (dispatcher->used > 0 && dispatcher->slot[dispatcher->used - 1].state == SLOT_FREE) dispatcher->used--;
}

static void record_ends(job_dispatcher *dispatcher)
{
    for (worker_slot *slot = next_slot(dispatcher, NULL); slot; slot = next_slot(dispatcher, slot)) {
        if (slot->state != SLOT_ENDED) continue;
        const store_status status = slot->claim_lost ? STORE_CONFLICT : worker_end_record(dispatcher, slot);
        if (status != STORE_OK && status != STORE_CONFLICT) {
            dispatcher->store_failures++;
            continue;
        }
        if (status == STORE_CONFLICT) log_line("job %s: dismissed, its worker has left", slot->claim.id);
        if (slot->claim.bed) store_drop_beds(dispatcher->store);
        release_slot(dispatcher, slot);
        dispatcher->jobs_changed(dispatcher->context);
    }
}

/* --- the rounds --- */

static void count_work(job_dispatcher *dispatcher)
{
    double speed = 0.0;
    int running = 0;
    for (const worker_slot *slot = next_slot(dispatcher, NULL); slot; slot = next_slot(dispatcher, slot)) {
        if (slot->state != SLOT_WORKING || slot->worker.waits_for[0]) continue;
        running++;
        if (isfinite(slot->speed)) speed += slot->speed;
    }
    dispatcher->running = running;
    dispatcher->speed = speed;
    dispatcher->last_round = monotonic_seconds();
}

static bool is_idle(const job_dispatcher *dispatcher) { return dispatcher->taken == 0; }

static bool take_signal(job_dispatcher *dispatcher)
{
    uint64_t count;
    return read(dispatcher->signals, &count, sizeof count) == (ssize_t)sizeof count;
}

static void sleep_until_needed(job_dispatcher *dispatcher)
{
    struct pollfd watched[] = { { .fd = dispatcher->wake, .events = POLLIN },
                                { .fd = dispatcher->signals, .events = POLLIN },
                                { .fd = dispatcher->executor->bell, .events = POLLIN } };
    const bool calm = is_idle(dispatcher) && dispatcher->recovered && dispatcher->pause.setbacks == 0;
    poll(watched, sizeof watched / sizeof watched[0], calm ? IDLE_ROUND_MS : BUSY_ROUND_MS);
    uint64_t ignored;
    while (read(dispatcher->wake, &ignored, sizeof ignored) > 0) continue;
}

/* --- after another daemon --- */

/* A job that was left running, whose worker may still be at work. */
static bool adopt(void *context, const job_claim *claim, const char *name)
{
    job_dispatcher *dispatcher = context;
    worker_executor *executor = dispatcher->executor;
    worker_slot *slot = dispatcher->used < dispatcher->workers ? &dispatcher->slot[dispatcher->used] : NULL;
    char folder[4096];
    worker_handle worker;
    snprintf(folder, sizeof folder, "%s/jobs/%s", dispatcher->store->data->path, claim->id);
    const worker_order order = order_of(claim, folder, -1);
    if (!executor->adopt || !slot || !executor->adopt(executor, &order, name, &worker)) return false;
    take_slot(dispatcher, slot, claim);
    slot->claim.spec = slot->claim.resources = NULL;
    slot->worker = worker;
    slot->settles = claim->bed && !store_has_bed(dispatcher->store, claim->bed);
    log_line("job %s: left running by an earlier daemon; gone on with, %s", claim->id, worker.name);
    return true;
}

static bool is_followed(const job_dispatcher *dispatcher, int64_t number)
{
    for (const worker_slot *slot = next_slot(dispatcher, NULL); slot; slot = next_slot(dispatcher, slot))
        if (slot->claim.number == number) return true;
    return false;
}

/* A second try finds those that the first has taken. */
static bool adopt_once(void *context, const job_claim *claim, const char *name)
{
    return is_followed(context, claim->number) || adopt(context, claim, name);
}

bool dispatcher_recover(job_dispatcher *dispatcher)
{
    dispatcher->recovered =
        store_recover(dispatcher->store, "left running by an earlier daemon", adopt_once, dispatcher) == STORE_OK;
    return dispatcher->recovered;
}

/* What an earlier daemon left running goes first; on a full disk that has to wait, and reads are served meanwhile. */
static void recover(job_dispatcher *dispatcher)
{
    if (dispatcher->recovered || dispatcher->stopping) return;
    if (dispatcher_recover(dispatcher)) dispatcher->jobs_changed(dispatcher->context);
    else dispatcher->store_failures++;
}

static void record(job_dispatcher *dispatcher, double *recorded)
{
    bool ended = false;
    notice_ends(dispatcher);
    for (const worker_slot *slot = next_slot(dispatcher, NULL); slot; slot = next_slot(dispatcher, slot))
        ended = ended || slot->state == SLOT_ENDED;
    if (!ended && monotonic_seconds() - *recorded < 0.95) return; /* progress reaches the disk once a second, not at every wake */
    record_events(dispatcher);
    *recorded = monotonic_seconds();
}

static void begin_to_leave(job_dispatcher *dispatcher, void (*leaving)(void *context))
{
    dispatcher->stopping = true;
    dispatcher->stopping_from = monotonic_seconds();
    log_line("leaving: %s", takes_workers_along(dispatcher) ? "workers are asked to save their state" : "workers go on without it");
    stop_unwanted(dispatcher);
    leaving(dispatcher->context);
}

/* Ends that can't be recorded, on a full disk say, are not waited for longer than that. */
static bool may_leave(const job_dispatcher *dispatcher)
{
    if (!dispatcher->stopping) return false;
    bool all_recorded = true;
    for (const worker_slot *slot = next_slot(dispatcher, NULL); slot; slot = next_slot(dispatcher, slot)) {
        if (slot->state == SLOT_WORKING && takes_workers_along(dispatcher)) return false;
        all_recorded = all_recorded && slot->state != SLOT_ENDED;
    }
    if (all_recorded) return true;
    if (monotonic_seconds() - dispatcher->stopping_from < SECONDS_TO_RECORD) return false;
    log_line("leaving: what became of the last workers can't be recorded now; the next start does it");
    return true;
}

void dispatcher_run(job_dispatcher *dispatcher, void (*leaving)(void *context))
{
    double recorded = 0.0;
    while (!may_leave(dispatcher)) {
        recover(dispatcher);
        record(dispatcher, &recorded);
        stop_unwanted(dispatcher);
        record_ends(dispatcher);
        if (!dispatcher->stopping) start_jobs(dispatcher);
        count_work(dispatcher);
        if (may_leave(dispatcher)) break;
        sleep_until_needed(dispatcher);
        if (take_signal(dispatcher) && !dispatcher->stopping) begin_to_leave(dispatcher, leaving);
    }
}
