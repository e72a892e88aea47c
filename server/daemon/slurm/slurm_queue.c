#include "slurm_queue.h"

#include <dirent.h>
#include <errno.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/eventfd.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "log.h"
#include "slurm_answers.h"

#define SECONDS_TO_COLLECT 1.0 /* how long a bundle waits for more jobs */
#define LONGEST_PAUSE 60.0     /* s between tries of what sbatch refuses */
#define BETWEEN_LOOKS 5.0      /* s at least, so that a controller with many users is asked twelve times a minute at most, */
#define SOON 1.5               /* s after something is new there, */
#define SHARE_OF_LOOKING 0.1   /* and not for more than this share of the time */
#define SECONDS_TO_VANISH 10.0 /* a job may be unknown for a moment, while a controller starts again */

enum { MOST_ARGUMENTS = 32, LONGEST_ARGUMENT = 256, MISSES_TO_VANISH = 2 };

/* --- the list --- */

static bool add_bundle(slurm_queue *queue, slurm_bundle *bundle)
{
    if (queue->count == queue->room) {
        const int room = queue->room ? 2 * queue->room : 64;
        slurm_bundle **list = realloc(queue->bundle, (size_t)room * sizeof *list);
        if (!list) return false;
        queue->bundle = list;
        queue->room = room;
    }
    queue->bundle[queue->count++] = bundle;
    return true;
}

slurm_bundle *slurm_queue_open_bundle(slurm_queue *queue, const char *job, int start)
{
    slurm_bundle *bundle = calloc(1, sizeof *bundle);
    if (!bundle || !add_bundle(queue, bundle)) {
        free(bundle);
        return NULL;
    }
    snprintf(bundle->name, sizeof bundle->name, "%s.%d", job, start);
    bundle->opened = monotonic_seconds();
    queue->open = bundle;
    return bundle;
}

void slurm_queue_close_bundle(slurm_queue *queue)
{
    if (queue->open) queue->open->stage = BUNDLE_CLOSED;
    queue->open = NULL;
}

int slurm_queue_length(const slurm_queue *queue)
{
    int length = 0;
    for (int b = 0; b < queue->count; b++) length += queue->bundle[b]->gone == 0.0;
    return length;
}

static int handed_on(const slurm_queue *queue)
{
    int length = 0;
    for (int b = 0; b < queue->count; b++) length += queue->bundle[b]->stage >= BUNDLE_DOUBTFUL && queue->bundle[b]->gone == 0.0;
    return length;
}

static bool is_followed(const slurm_bundle *bundle)
{
    for (int m = 0; m < bundle->count; m++)
        if (bundle->member[m].is_followed) return true;
    return false;
}

/* Nobody waits for any of its jobs any more. */
static bool is_unwanted(const slurm_bundle *bundle)
{
    for (int m = 0; m < bundle->count; m++) {
        const bundle_member *member = &bundle->member[m];
        if (member->is_followed && member->code < 0 && !member->is_asked_to_stop) return false;
    }
    return true;
}

static void drop_ended(slurm_queue *queue)
{
    int kept = 0;
    for (int b = 0; b < queue->count; b++) {
        slurm_bundle *bundle = queue->bundle[b];
        const bool is_over = bundle->gone > 0.0 || (bundle->stage == BUNDLE_CLOSED && is_unwanted(bundle));
        if (queue->is_recovered && is_over && !is_followed(bundle)) {
            slurm_bundle_remove(bundle, queue->data);
            free(bundle);
        } else {
            queue->bundle[kept++] = bundle;
        }
    }
    queue->count = kept;
}

static void ring(const slurm_queue *queue)
{
    const uint64_t one = 1;
    const ssize_t ignored = write(queue->bell, &one, sizeof one);
    (void)ignored;
}

/* --- submitting --- */

typedef struct sbatch_command {
    char text[MOST_ARGUMENTS][LONGEST_ARGUMENT], script[SLURM_PATH_SIZE], words[2 * SLURM_PATH_SIZE];
    const char *argument[MOST_ARGUMENTS + 1];
    int count;
} sbatch_command;

static void add_argument(sbatch_command *command, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void add_argument(sbatch_command *command, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(command->text[command->count], LONGEST_ARGUMENT, format, arguments);
    va_end(arguments);
    command->argument[command->count] = command->text[command->count];
    command->count++;
}

/* Where Slurm says why it kills a script; sbatch takes % for the beginning of a pattern. */
static void add_words(sbatch_command *command, const slurm_bundle *bundle, const data_folder *data)
{
    char path[SLURM_PATH_SIZE];
    slurm_bundle_words_path(bundle, data, path);
    size_t length = (size_t)snprintf(command->words, sizeof command->words, "--error=");
    for (const char *c = path; *c && length + 2 < sizeof command->words; c++) {
        if (*c == '%') command->words[length++] = '%';
        command->words[length++] = *c;
    }
    command->words[length] = '\0';
    command->argument[command->count++] = command->words;
}

/* What the jobs themselves ask for comes after what all are given: of an option that is given twice sbatch takes the last. */
static void add_resources(sbatch_command *command, const char *text)
{
    const char *name;
    json_t *value, *resources = json_loads(*text ? text : "{}", 0, NULL);
    json_object_foreach(resources, name, value) add_argument(command, "--%s=%s", name, json_string_value(value));
    json_decref(resources);
}

static void make_command(const slurm_queue *queue, const slurm_bundle *bundle, sbatch_command *command)
{
    const slurm_settings *s = &queue->settings;
    double seconds = 60.0, memory = 0.0;
    for (int m = 0; m < bundle->count; m++) {
        seconds += bundle->member[m].seconds;
        if (bundle->member[m].memory_bytes > memory) memory = bundle->member[m].memory_bytes;
    }
    if (seconds > s->longest) seconds = s->longest;
    *command = (sbatch_command){ .count = 0 };
    add_argument(command, "sbatch");
    add_argument(command, "--parsable");
    add_argument(command, "--no-requeue");
    add_argument(command, "--job-name=" SLURM_NAME_START "%s", bundle->name);
    add_argument(command, "--comment=%s, attempt %d", bundle->name, bundle->member[0].attempt);
    add_argument(command, "--output=/dev/null");
    add_words(command, bundle, queue->data);
    add_argument(command, "--nodes=1");
    add_argument(command, "--ntasks=1");
    add_argument(command, "--cpus-per-task=%d", bundle->member[0].threads);
    add_argument(command, "--mem=%.0fM", memory / 1048576.0 + 1.0);
    add_argument(command, "--time=%.0f", seconds / 60.0 + 1.0);
    add_argument(command, "--signal=B:TERM@60");
    if (s->partition) add_argument(command, "--partition=%s", s->partition);
    if (s->account) add_argument(command, "--account=%s", s->account);
    if (s->qos) add_argument(command, "--qos=%s", s->qos);
    if (s->constraint) add_argument(command, "--constraint=%s", s->constraint);
    add_resources(command, bundle->resources);
    for (int l = 0; l < s->line_count; l++) add_argument(command, "%s", s->lines[l]);
    snprintf(command->script, sizeof command->script, "%s/slurm/%s.sh", queue->data->path, bundle->name);
    command->argument[command->count++] = command->script;
    command->argument[command->count] = NULL;
}

/* The one that was refused least often, and of these the oldest; NULL: none is due, or no more may be in the queue. */
static slurm_bundle *next_to_submit(const slurm_queue *queue, double now)
{
    slurm_bundle *next = NULL;
    if (now < queue->next_submission || handed_on(queue) >= queue->settings.queue) return NULL;
    for (int b = 0; b < queue->count; b++) {
        slurm_bundle *bundle = queue->bundle[b];
        if (bundle->stage == BUNDLE_CLOSED && bundle->next_try <= now && !is_unwanted(bundle)
            && (!next || bundle->refusals < next->refusals))
            next = bundle;
    }
    return next;
}

static double pause_after(int refusals)
{
    const double pause = refusals < 7 ? (double)(1 << (refusals - 1)) : LONGEST_PAUSE;
    return pause < LONGEST_PAUSE ? pause : LONGEST_PAUSE;
}

static void look_soon(slurm_queue *queue)
{
    const double soon = monotonic_seconds() + SOON;
    if (soon < queue->next_look) queue->next_look = soon;
}

/* Whatever sbatch complains of, it may have told the controller before: so the queue is asked first. One that is refused for what it
 * asks for holds up no other: the pause of all ends with the next that is taken. */
static void note_refusal(slurm_queue *queue, slurm_bundle *bundle, const char *reason)
{
    const double now = monotonic_seconds();
    bundle->stage = BUNDLE_DOUBTFUL;
    bundle->refusals++;
    bundle->next_try = now + pause_after(bundle->refusals);
    queue->pause = queue->pause > 0.0 ? queue->pause * 2.0 : 1.0;
    if (queue->pause > LONGEST_PAUSE) queue->pause = LONGEST_PAUSE;
    queue->next_submission = now + queue->pause;
    look_soon(queue);
    queue->counts.refusals++;
    snprintf(bundle->reason, sizeof bundle->reason, "%s", reason);
    log_line("sbatch refuses %s: %s; tried again in %.0f s", bundle->name, reason, pause_after(bundle->refusals));
}

static void note_submission(slurm_queue *queue, slurm_bundle *bundle, const char *answer)
{
    const size_t digits = strspn(answer, "0123456789");
    snprintf(bundle->id, sizeof bundle->id, "%.*s", (int)(digits < SLURM_ID_SIZE ? digits : 0), answer);
    *bundle->reason = '\0';
    bundle->stage = BUNDLE_QUEUED;
    bundle->state = SLURM_WAITS;
    bundle->refusals = bundle->misses = 0;
    bundle->opened = monotonic_seconds();
    queue->pause = 0.0;
    queue->counts.submissions++;
    look_soon(queue);
    log_line("%s: %d jobs handed to Slurm as job %s", bundle->name, bundle->count, bundle->id);
}

/* The lock is given up while the command runs. False: there was nothing to submit. */
static bool submit_next(slurm_queue *queue)
{
    slurm_bundle *bundle = next_to_submit(queue, monotonic_seconds());
    if (!bundle) return false;
    sbatch_command command;
    char reason[SLURM_REASON_SIZE] = "", *answer = NULL;
    make_command(queue, bundle, &command);
    bundle->stage = BUNDLE_DOUBTFUL;
    const bool is_written = bundle->is_written;
    pthread_mutex_unlock(&queue->lock);
    if (!is_written && !slurm_bundle_write(bundle, queue->data, &queue->worker))
        snprintf(reason, sizeof reason, "its script can't be written: %s", strerror(errno));
    else answer = slurm_run(command.argument, reason);
    pthread_mutex_lock(&queue->lock);
    bundle->is_written = true;
    if (answer && *answer >= '0' && *answer <= '9') note_submission(queue, bundle, answer);
    else note_refusal(queue, bundle, *reason ? reason : "it has not said which job it is");
    free(answer);
    ring(queue);
    return true;
}

/* --- looking --- */

static bool has_begun(const slurm_queue *queue, slurm_bundle *bundle)
{
    bool any = false;
    for (int m = 0; m < bundle->count; m++) {
        bool begun;
        int code;
        slurm_fence_read(queue->data, &bundle->member[m], &begun, &code);
        any = any || begun;
    }
    return any;
}

/* A job that the queue does not have: not there yet, gone with its controller, or ended so long ago that nobody remembers. Nothing
 * of it has begun: it is submitted again, under the same name, and should it be there all the same, the fences let one of both run.
 * Else what has no end yet is put back, by the supervisor. */
static void note_missing(slurm_queue *queue, slurm_bundle *bundle, double now)
{
    bundle->misses++;
    if (bundle->stage == BUNDLE_QUEUED && (bundle->misses < MISSES_TO_VANISH || now - bundle->opened < SECONDS_TO_VANISH)) return;
    if (has_begun(queue, bundle)) {
        bundle->stage = BUNDLE_QUEUED;
        bundle->state = SLURM_UNKNOWN;
        bundle->gone = now;
        return;
    }
    if (bundle->stage == BUNDLE_QUEUED)
        log_line("%s: Slurm knows nothing of job %s any more; submitted again", bundle->name, bundle->id);
    bundle->stage = BUNDLE_CLOSED;
}

static void note_state(slurm_bundle *bundle, const slurm_answer *found, double now)
{
    snprintf(bundle->id, sizeof bundle->id, "%s", found->id);
    snprintf(bundle->reason, sizeof bundle->reason, "%s", found->reason);
    bundle->stage = BUNDLE_QUEUED;
    bundle->state = found->state;
    bundle->misses = 0;
    if (found->state > SLURM_RUNS && bundle->gone == 0.0) bundle->gone = now;
}

static bool is_looked_for(const slurm_bundle *bundle) { return bundle->stage >= BUNDLE_DOUBTFUL && bundle->gone == 0.0; }

static void take_answers(slurm_queue *queue, const slurm_answers *answers)
{
    const double now = monotonic_seconds();
    int waiting = 0, running = 0;
    for (int b = 0; b < queue->count; b++) {
        slurm_bundle *bundle = queue->bundle[b];
        if (!is_looked_for(bundle)) continue;
        const slurm_answer *found = slurm_answers_find(answers, bundle->name);
        if (found) note_state(bundle, found, now);
        else note_missing(queue, bundle, now);
        waiting += bundle->gone == 0.0 && bundle->state == SLURM_WAITS;
        running += bundle->gone == 0.0 && bundle->state == SLURM_RUNS;
    }
    queue->counts.waiting = waiting;
    queue->counts.running = running;
}

static bool anything_is_looked_for(const slurm_queue *queue)
{
    for (int b = 0; b < queue->count; b++)
        if (is_looked_for(queue->bundle[b])) return true;
    return false;
}

/* Those which squeue's answer does not have, as "812,813": the accounts may remember them. */
static void list_missing(const slurm_queue *queue, const slurm_answers *answers, char *ids, size_t size)
{
    size_t length = 0;
    *ids = '\0';
    for (int b = 0; b < queue->count && length + SLURM_ID_SIZE + 1 < size; b++) {
        const slurm_bundle *bundle = queue->bundle[b];
        if (is_looked_for(bundle) && *bundle->id && !slurm_answers_find(answers, bundle->name))
            length += (size_t)snprintf(ids + length, size - length, "%s%s", length ? "," : "", bundle->id);
    }
}

static void look(slurm_queue *queue)
{
    const double asked = monotonic_seconds();
    if (asked < queue->next_look || !anything_is_looked_for(queue)) return;
    slurm_answers answers;
    char reason[SLURM_REASON_SIZE] = "", missing[4096];
    pthread_mutex_unlock(&queue->lock);
    bool good = slurm_answers_ask(&answers, reason);
    pthread_mutex_lock(&queue->lock);
    queue->counts.questions++;
    list_missing(queue, &answers, missing, sizeof missing);
    if (good && *missing) {
        pthread_mutex_unlock(&queue->lock);
        slurm_answers_ask_accounts(&answers, missing);
        pthread_mutex_lock(&queue->lock);
        queue->counts.questions++;
    }
    if (good) take_answers(queue, &answers);
    if (!good && !*queue->trouble) log_line("squeue does not answer: %s", reason);
    snprintf(queue->trouble, sizeof queue->trouble, "%s", reason);
    slurm_answers_clear(&answers);
    const double took = monotonic_seconds() - asked, rest = took / SHARE_OF_LOOKING;
    queue->next_look = monotonic_seconds() + (rest > BETWEEN_LOOKS ? rest : BETWEEN_LOOKS);
    ring(queue);
}

/* --- cancelling --- */

/* One of which every job has an end leaves by itself. */
static bool has_all_ends(const slurm_bundle *bundle)
{
    for (int m = 0; m < bundle->count; m++)
        if (bundle->member[m].code < 0) return false;
    return true;
}

static bool cancel_one(slurm_queue *queue)
{
    for (int b = 0; b < queue->count; b++) {
        slurm_bundle *bundle = queue->bundle[b];
        if (!queue->is_recovered || bundle->stage != BUNDLE_QUEUED || bundle->gone > 0.0 || bundle->is_cancelled
            || !is_unwanted(bundle) || has_all_ends(bundle))
            continue;
        /* One that has ended is only not known to have. */
        char reason[SLURM_REASON_SIZE] = "", id[SLURM_ID_SIZE];
        snprintf(id, sizeof id, "%s", bundle->id);
        bundle->is_cancelled = true;
        look_soon(queue);
        pthread_mutex_unlock(&queue->lock);
        free(slurm_run((const char *const[]){ "scancel", id, NULL }, reason));
        pthread_mutex_lock(&queue->lock);
        return true;
    }
    return false;
}

/* --- the thread --- */

static void *serve(void *context)
{
    slurm_queue *queue = context;
    pthread_mutex_lock(&queue->lock);
    while (!queue->ends) {
        if (queue->open && monotonic_seconds() - queue->open->opened > SECONDS_TO_COLLECT) slurm_queue_close_bundle(queue);
        while (!queue->ends && submit_next(queue)) look(queue);
        while (!queue->ends && cancel_one(queue)) continue;
        if (!queue->ends) look(queue);
        drop_ended(queue);
        if (queue->ends) break;
        struct timespec until;
        clock_gettime(CLOCK_MONOTONIC, &until);
        until.tv_nsec += 250000000;
        until.tv_sec += until.tv_nsec / 1000000000;
        until.tv_nsec %= 1000000000;
        pthread_cond_timedwait(&queue->there_is_work, &queue->lock, &until);
    }
    pthread_mutex_unlock(&queue->lock);
    return NULL;
}

static bool read_earlier(slurm_queue *queue)
{
    char path[SLURM_PATH_SIZE];
    snprintf(path, sizeof path, "%s/slurm", queue->data->path);
    if (mkdir(path, 0700) != 0 && errno != EEXIST) {
        log_line("%s can't be made: %s", path, strerror(errno));
        return false;
    }
    DIR *list = opendir(path);
    for (const struct dirent *entry; list && (entry = readdir(list)) != NULL;) {
        char name[BUNDLE_NAME_SIZE];
        const size_t length = strlen(entry->d_name);
        if (length < 4 || length - 3 >= sizeof name || strcmp(entry->d_name + length - 3, ".sh") != 0) continue;
        snprintf(name, sizeof name, "%.*s", (int)length - 3, entry->d_name);
        slurm_bundle *bundle = slurm_bundle_read(queue->data, name);
        if (bundle && !add_bundle(queue, bundle)) free(bundle);
    }
    if (list) closedir(list);
    return list != NULL;
}

bool slurm_queue_start(slurm_queue *queue)
{
    pthread_condattr_t monotonic;
    pthread_condattr_init(&monotonic);
    pthread_condattr_setclock(&monotonic, CLOCK_MONOTONIC);
    pthread_mutex_init(&queue->lock, NULL);
    pthread_cond_init(&queue->there_is_work, &monotonic);
    pthread_condattr_destroy(&monotonic);
    queue->bell = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    if (queue->bell < 0 || !read_earlier(queue)) return false;
    return pthread_create(&queue->thread, NULL, serve, queue) == 0;
}

void slurm_queue_stop(slurm_queue *queue)
{
    pthread_mutex_lock(&queue->lock);
    queue->ends = true;
    pthread_cond_signal(&queue->there_is_work);
    pthread_mutex_unlock(&queue->lock);
    pthread_join(queue->thread, NULL);
    for (int b = 0; b < queue->count; b++) free(queue->bundle[b]);
    free(queue->bundle);
    close(queue->bell);
}
