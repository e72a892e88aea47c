#include "planner.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/close_range.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/eventfd.h>
#include <sys/mman.h>
#include <sys/pidfd.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "json_text.h"
#include "log.h"
#include "plan_store.h"
#include "plan_work.h"

/* Against a planner gone wild: a plan takes less than a second for a hundred runs. */
#define MOST_MEMORY 4294967296.0 /* bytes */
#define MOST_SECONDS 3600.0      /* of processor time */
#define LONGEST_PLAN 200000000.0 /* bytes */

/* TRIES: of a plan that fails by itself; what the machine does to it never counts. */
enum { TRIES = 3, EXIT_MACHINE = 6, EXIT_REFUSED = 2, PUT_OFF_MS = 1000, IDLE_MS = 60000, LONGEST_MESSAGE = 400 };

struct run_planner {
    api_service *service;
    const char *program;
    bool confine;
    int wake; /* eventfd */
    atomic_bool stopping;
    pthread_t thread;
};

/* One plan in the making: what the program reads, says and complains of, in memory. */
typedef struct planning {
    int in, out, complaints;
    pid_t process;
    int status; /* of waitpid */
    bool given_up;
} planning;

/* --- the program --- */

static void limit(int resource, double value)
{
    const struct rlimit bound = { (rlim_t)value, (rlim_t)value };
    setrlimit(resource, &bound);
}

/* Only async-signal-safe calls: other threads may have held any lock at the fork. */
static void become_planner(const planning *p, const char *program, char *const *arguments, char *const *environment, pid_t parent)
{
    sigset_t none;
    sigemptyset(&none);
    setpgid(0, 0);
    for (int number = 1; number < 32; number++) signal(number, SIG_DFL);
    sigprocmask(SIG_SETMASK, &none, NULL);
    if (dup2(p->in, 0) < 0 || dup2(p->out, 1) < 0 || dup2(p->complaints, 2) < 0) _exit(EXIT_MACHINE);
    close_range(3, ~0U, CLOSE_RANGE_CLOEXEC);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(EXIT_MACHINE);
    limit(RLIMIT_AS, MOST_MEMORY);
    limit(RLIMIT_CPU, MOST_SECONDS);
    limit(RLIMIT_FSIZE, LONGEST_PLAN);
    limit(RLIMIT_CORE, 0.0);
    prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
    execve(program, arguments, environment);
    _exit(EXIT_MACHINE);
}

/* Ours, but for the threads of linear algebra, without which the program would start once more to have it so. To be freed; NULL: no
 * memory. */
static char **environment_of_planner(void)
{
    static char one_for_blas[] = "OPENBLAS_NUM_THREADS=1", one_for_all[] = "OMP_NUM_THREADS=1";
    size_t count = 0, kept = 2;
    while (environ[count]) count++;
    char **environment = calloc(count + 3, sizeof *environment);
    if (!environment) return NULL;
    environment[0] = one_for_blas;
    environment[1] = one_for_all;
    for (size_t i = 0; i < count; i++)
        if (strncmp(environ[i], "OPENBLAS_NUM_THREADS=", 21) != 0 && strncmp(environ[i], "OMP_NUM_THREADS=", 16) != 0)
            environment[kept++] = environ[i];
    return environment;
}

/* True when it has ended; false: the daemon leaves, and it was killed. */
static bool await(run_planner *planner, planning *p)
{
    const int watch = pidfd_open(p->process, 0);
    struct pollfd watched[2] = { { .fd = watch, .events = POLLIN }, { .fd = planner->wake, .events = POLLIN } };
    pid_t ended = 0;
    while (ended == 0 && !planner->stopping) {
        uint64_t ignored;
        poll(watched, 2, watch < 0 ? 20 : PUT_OFF_MS);
        while (read(planner->wake, &ignored, sizeof ignored) > 0) continue;
        ended = waitpid(p->process, &p->status, WNOHANG);
    }
    if (ended == 0) {
        kill(-p->process, SIGKILL);
        kill(p->process, SIGKILL);
        while (waitpid(p->process, &p->status, 0) < 0 && errno == EINTR) continue;
        p->given_up = true;
    }
    if (watch >= 0) close(watch);
    return !p->given_up;
}

static bool run_program(run_planner *planner, planning *p)
{
    char *const arguments[] = { (char *)planner->program, "plan", "-", planner->confine ? "--confine" : NULL, NULL };
    char **environment = environment_of_planner();
    const pid_t parent = getpid();
    p->process = environment ? fork() : -1;
    if (p->process == 0) become_planner(p, planner->program, arguments, environment, parent);
    free(environment);
    if (p->process < 0) return false;
    setpgid(p->process, p->process); /* also here: whoever comes first */
    return await(planner, p);
}

/* --- what it reads and says --- */

static bool write_all(int file, const char *text, size_t length)
{
    while (length > 0) {
        const ssize_t written = write(file, text, length);
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return false;
        text += written;
        length -= (size_t)written;
    }
    return lseek(file, 0, SEEK_SET) == 0;
}

/* To be freed; NULL: no memory. */
static char *read_back(int file, size_t *length)
{
    struct stat facts;
    *length = 0;
    char *text = fstat(file, &facts) == 0 ? malloc((size_t)facts.st_size + 1) : NULL;
    while (text && *length < (size_t)facts.st_size) {
        const ssize_t more = pread(file, text + *length, (size_t)facts.st_size - *length, (off_t)*length);
        if (more <= 0) break;
        *length += (size_t)more;
    }
    if (text) text[*length] = '\0';
    return text;
}

/* {"request", "runs", "workers"}; NULL: the store refuses, or no memory. */
static char *document_of(run_planner *planner, const plan_claim *claim)
{
    char *request = NULL, *text = NULL;
    json_t *runs = NULL;
    if (store_read_plan_request(planner->service->store, claim->id, &request) == STORE_OK
        && store_read_plan_runs(planner->service->store, claim->id, &runs) == STORE_OK) {
        json_t *document = json_pack("{s:o, s:O, s:I}", "request", json_loads(request, 0, NULL), "runs", runs, "workers",
                                     (json_int_t)claim->workers);
        text = document ? json_dumps(document, JSON_COMPACT | JSON_REAL_PRECISION(17)) : NULL;
        json_decref(document);
    }
    json_decref(runs);
    free(request);
    return text;
}

static bool begin(run_planner *planner, const plan_claim *claim, planning *p)
{
    *p = (planning){ .in = memfd_create("plan-in", MFD_CLOEXEC), .out = -1, .complaints = -1 };
    if (p->in >= 0) p->out = memfd_create("plan-out", MFD_CLOEXEC);
    if (p->out >= 0) p->complaints = memfd_create("plan-complaints", MFD_CLOEXEC);
    char *text = p->complaints >= 0 ? document_of(planner, claim) : NULL;
    const bool good = text && write_all(p->in, text, strlen(text));
    free(text);
    return good;
}

static void clear(const planning *p)
{
    if (p->in >= 0) close(p->in);
    if (p->out >= 0) close(p->out);
    if (p->complaints >= 0) close(p->complaints);
}

/* --- what becomes of it --- */

static void put_off(run_planner *planner, const plan_claim *claim, const char *why)
{
    char message[LONGEST_MESSAGE + 60];
    snprintf(message, sizeof message, "planning is put off: %.*s", LONGEST_MESSAGE, why);
    log_line("calibration %s: %s", claim->id, message);
    store_put_off_plan(planner->service->store, claim, message);
    planner->service->jobs_changed(planner->service->daemon);
}

static void fail(run_planner *planner, const plan_claim *claim, const char *why)
{
    char message[LONGEST_MESSAGE + 60];
    snprintf(message, sizeof message, "it can't be planned: %.*s", LONGEST_MESSAGE, why);
    log_line("calibration %s: %s", claim->id, message);
    store_fail_plan(planner->service->store, claim, message);
    planner->service->jobs_changed(planner->service->daemon);
}

static const char *reason_of(store_status status)
{
    if (status == STORE_FULL) return "there is no room on the disk";
    if (status == STORE_QUEUE_FULL) return "as many jobs wait as may";
    return "its jobs can't be kept; the daemon's log says why";
}

static void take(run_planner *planner, const plan_claim *claim, const json_t *plan)
{
    const size_t cases = json_array_size(json_object_get(plan, "cases"));
    const bool is_done = json_object_get(plan, "answer") != NULL;
    if (cases == 0 && !is_done) { /* it waits for a job that was put into the queue again just now */
        put_off(planner, claim, "a run of it has begun again");
        return;
    }
    const store_status status = store_take_plan(planner->service->store, claim, plan, planner->service->default_threads);
    if (status == STORE_CONFLICT) return;
    if (status != STORE_OK) {
        put_off(planner, claim, reason_of(status));
        return;
    }
    log_line("calibration %s: %s, %zu runs more", claim->id, is_done ? "answered" : "planned", cases);
    planner->service->jobs_changed(planner->service->daemon);
}

/* The first problem, or the last line of the complaints. */
static void explain(const planning *p, const json_t *said, char why[LONGEST_MESSAGE])
{
    const json_t *first = json_array_get(json_object_get(said, "errors"), 0);
    size_t length;
    char *complaints = read_back(p->complaints, &length);
    while (complaints && length > 0 && complaints[length - 1] == '\n') complaints[--length] = '\0';
    const char *line = complaints && length > 0 ? strrchr(complaints, '\n') : NULL;
    line = line ? line + 1 : complaints && length > 0 ? complaints : "it says nothing";
    if (first)
        snprintf(why, LONGEST_MESSAGE, "%.150s %.200s", json_string_value(json_object_get(first, "pointer")),
                 json_string_value(json_object_get(first, "detail")));
    else if (WIFSIGNALED(p->status)) snprintf(why, LONGEST_MESSAGE, "the planner was ended by signal %d", WTERMSIG(p->status));
    else snprintf(why, LONGEST_MESSAGE, "the planner ended with %d: %.300s", WEXITSTATUS(p->status), line);
    free(complaints);
}

/* The machine's, or somebody's who kills it. */
static bool is_of_the_machine(int status)
{
    if (WIFSIGNALED(status)) return WTERMSIG(status) == SIGKILL || WTERMSIG(status) == SIGTERM || WTERMSIG(status) == SIGINT;
    return WEXITSTATUS(status) == EXIT_MACHINE || WEXITSTATUS(status) > 100;
}

static void conclude(run_planner *planner, const plan_claim *claim, const planning *p)
{
    char why[LONGEST_MESSAGE];
    size_t length;
    problem_list problems;
    char *text = read_back(p->out, &length);
    json_t *said = text && problem_list_init(&problems) ? json_text_load(text, length, &problems) : NULL;
    if (text) problem_list_clear(&problems);
    free(text);
    const bool has_ended_well = WIFEXITED(p->status) && WEXITSTATUS(p->status) == 0;
    explain(p, has_ended_well ? NULL : said, why);
    if (has_ended_well && said) take(planner, claim, said);
    else if (is_of_the_machine(p->status)) put_off(planner, claim, why);
    else if (WIFEXITED(p->status) && WEXITSTATUS(p->status) == EXIT_REFUSED) fail(planner, claim, why);
    else if (claim->setbacks + 1 < TRIES) put_off(planner, claim, why);
    else fail(planner, claim, why);
    json_decref(said);
}

static void plan(run_planner *planner, const plan_claim *claim)
{
    planning p;
    if (!begin(planner, claim, &p)) put_off(planner, claim, "its runs can't be read, or there is no memory");
    else if (run_program(planner, &p)) conclude(planner, claim, &p);
    else if (!p.given_up) put_off(planner, claim, strerror(errno));
    clear(&p);
}

/* --- the thread --- */

static void *plan_all(void *context)
{
    run_planner *planner = context;
    while (!planner->stopping) {
        plan_claim claim;
        bool put_off;
        if (store_next_plan(planner->service->store, &claim, &put_off) == STORE_OK) {
            plan(planner, &claim);
            continue;
        }
        struct pollfd wake = { .fd = planner->wake, .events = POLLIN };
        uint64_t ignored;
        poll(&wake, 1, put_off ? PUT_OFF_MS : IDLE_MS);
        while (read(planner->wake, &ignored, sizeof ignored) > 0) continue;
    }
    return NULL;
}

run_planner *planner_start(api_service *service, const char *program, bool confine)
{
    run_planner *planner = calloc(1, sizeof *planner);
    if (!planner) return NULL;
    planner->service = service;
    planner->program = program;
    planner->confine = confine;
    planner->wake = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    if (planner->wake >= 0 && pthread_create(&planner->thread, NULL, plan_all, planner) == 0) return planner;
    log_line("no thread is to be had for calibrations");
    if (planner->wake >= 0) close(planner->wake);
    free(planner);
    return NULL;
}

void planner_wake(run_planner *planner)
{
    const uint64_t one = 1;
    if (!planner) return;
    const ssize_t ignored = write(planner->wake, &one, sizeof one); /* full: it is awake already */
    (void)ignored;
}

void planner_stop(run_planner *planner)
{
    if (!planner) return;
    planner->stopping = true;
    planner_wake(planner);
    pthread_join(planner->thread, NULL);
    close(planner->wake);
    free(planner);
}
