/* Workers as child processes, each the head of its own process group.
 *
 * All calls come from one thread, the supervisor's: PR_SET_PDEATHSIG follows the thread that forked, so a worker
 * forked from a short-lived thread would die with it. Between fork and exec only async-signal-safe calls are made,
 * because other threads may have held any lock at the fork. */
#include <errno.h>
#include <fcntl.h>
#include <linux/close_range.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/epoll.h>
#include <sys/file.h>
#include <sys/pidfd.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "executor.h"
#include "job_folder.h"

enum { EXEC_FAILED = 127, TRIES_FOR_THE_FOLDER = 500 /* of 20 ms */ };

static void limit(int resource, double value)
{
    const struct rlimit bound = { (rlim_t)value, (rlim_t)value };
    setrlimit(resource, &bound);
}

static void reset_signals(void)
{
    sigset_t none;
    sigemptyset(&none);
    for (int number = 1; number < 32; number++) signal(number, SIG_DFL);
    sigprocmask(SIG_SETMASK, &none, NULL);
}

/* Opened before the fork, where a failure can still be told with its reason. */
typedef struct worker_streams {
    int null, log;
} worker_streams;

static bool streams_open(worker_streams *streams, int folder)
{
    *streams = (worker_streams){ open("/dev/null", O_RDWR | O_CLOEXEC), -1 };
    if (streams->null >= 0)
        streams->log = openat(folder, JOB_LOG_FILE, O_WRONLY | O_CREAT | O_APPEND | O_NOFOLLOW | O_CLOEXEC, 0600);
    return streams->log >= 0;
}

static void streams_close(const worker_streams *streams)
{
    const int reason = errno;
    if (streams->null >= 0) close(streams->null);
    if (streams->log >= 0) close(streams->log);
    errno = reason;
}

static void streams_take(const worker_streams *streams)
{
    if (dup2(streams->null, 0) < 0 || dup2(streams->null, 1) < 0 || dup2(streams->log, 2) < 0) _exit(WORKER_MACHINE);
}

static void say(const char *text)
{
    const ssize_t ignored = write(2, text, strlen(text));
    (void)ignored;
}

/* The worker inherits this lock and holds it to its end: after a crash of the daemon the next attempt waits here
 * until the one before is really gone, so that no two ever write in one folder. */
static void lock_folder(int folder)
{
    close_range(3, ~0U, CLOSE_RANGE_CLOEXEC);
    for (int tries = 0; flock(folder, LOCK_EX | LOCK_NB) != 0; tries++) {
        if (tries == TRIES_FOR_THE_FOLDER) {
            say("the worker of an earlier attempt is still there\n");
            _exit(WORKER_MACHINE);
        }
        nanosleep(&(struct timespec){ .tv_nsec = 20000000 }, NULL);
    }
    fcntl(folder, F_SETFD, 0);
}

static void become_worker(const worker_order *order, const worker_streams *streams, const char *program, char *const *arguments,
                          pid_t parent)
{
    setpgid(0, 0);
    reset_signals();
    streams_take(streams);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(WORKER_FAULT); /* the daemon died before the line above */
    lock_folder(order->job_folder_file);
    limit(RLIMIT_AS, order->memory_bytes);
    limit(RLIMIT_CPU, order->cpu_seconds);
    limit(RLIMIT_FSIZE, order->file_bytes);
    limit(RLIMIT_CORE, 0.0);
    prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
    execv(program, arguments);
    say(program);
    say(": ");
    say(strerrordesc_np(errno));
    say("\n");
    _exit(EXEC_FAILED);
}

typedef struct local_executor {
    const char *program;
    bool confine; /* to the job's folder; the worker does it itself */
} local_executor;

/* What a handle has of its own. */
enum { PROCESS, WATCH, OOM_KILLS }; /* the process; a descriptor of it, -1: none; the machine's count when it was started */

/* Processes that the machine has killed for want of memory since it was started; -1: unknown. */
static int64_t oom_kills(void)
{
    char line[128];
    long long kills = -1;
    FILE *file = fopen("/proc/vmstat", "re");
    while (file && fgets(line, sizeof line, file))
        if (sscanf(line, "oom_kill %lld", &kills) == 1) break;
    if (file) fclose(file);
    return kills;
}

static bool start(worker_executor *executor, const worker_order *order, worker_handle *worker)
{
    const local_executor *local = executor->own;
    char spec[4200], attempt[16], threads[16];
    snprintf(spec, sizeof spec, "%s/" JOB_SPEC_FILE, order->job_folder);
    snprintf(attempt, sizeof attempt, "%d", order->attempt);
    snprintf(threads, sizeof threads, "%d", order->threads);
    char *arguments[] = { (char *)local->program,
                          "run",
                          spec,
                          "--out",
                          (char *)order->job_folder,
                          "--attempt",
                          attempt,
                          "--threads",
                          threads,
                          NULL,
                          NULL,
                          NULL };
    size_t next = sizeof arguments / sizeof arguments[0] - 3;
    if (local->confine) arguments[next++] = "--confine";
    if (order->save_bed) arguments[next++] = "--save-bed";
    worker_streams streams;
    const pid_t parent = getpid();
    const int64_t kills = oom_kills();
    const pid_t process = streams_open(&streams, order->job_folder_file) ? fork() : -1;
    if (process == 0) become_worker(order, &streams, local->program, arguments, parent);
    streams_close(&streams);
    if (process < 0) return false;
    setpgid(process, process); /* also here: whoever comes first */
    *worker = (worker_handle){ .own = { [PROCESS] = process, [WATCH] = pidfd_open(process, 0), [OOM_KILLS] = kills } };
    snprintf(worker->name, sizeof worker->name, "process %d", (int)process);
    struct epoll_event ends = { .events = EPOLLIN };
    if (worker->own[WATCH] >= 0) epoll_ctl(executor->bell, EPOLL_CTL_ADD, (int)worker->own[WATCH], &ends);
    return true;
}

static worker_end end_by_signal(const worker_handle *worker, int number)
{
    const int64_t before = worker->own[OOM_KILLS];
    const bool starved = number == SIGKILL && before >= 0 && oom_kills() > before;
    return (worker_end){ .kind = starved ? WORKER_STARVED : WORKER_KILLED, .code = number };
}

static bool has_ended(worker_executor *executor, worker_handle *worker, worker_end *end)
{
    int status;
    const pid_t process = waitpid((pid_t)worker->own[PROCESS], &status, WNOHANG);
    if (process == 0 || (process < 0 && errno == EINTR)) return false;
    if (process < 0) *end = (worker_end){ .code = WORKER_MACHINE }; /* not our child: nothing to wait for */
    else if (WIFSIGNALED(status)) *end = end_by_signal(worker, WTERMSIG(status));
    else *end = (worker_end){ .code = WEXITSTATUS(status) };
    if (worker->own[WATCH] >= 0) {
        /* A child between fork and exec may still have it open, so that closing it alone would not take it off the list. */
        epoll_ctl(executor->bell, EPOLL_CTL_DEL, (int)worker->own[WATCH], NULL);
        close((int)worker->own[WATCH]);
    }
    *worker = (worker_handle){ .own = { [WATCH] = -1 } };
    return true;
}

/* Neither can hit a stranger: until has_ended reaps it, the number stays the worker's. */
static void ask_to_stop(worker_executor *executor, const worker_handle *worker)
{
    (void)executor;
    kill((pid_t)worker->own[PROCESS], SIGTERM);
}

static void kill_worker(worker_executor *executor, const worker_handle *worker)
{
    (void)executor;
    kill(-(pid_t)worker->own[PROCESS], SIGKILL);
    kill((pid_t)worker->own[PROCESS], SIGKILL);
}

bool executor_local_init(worker_executor *executor, const char *program, bool confine, int places)
{
    local_executor *local = malloc(sizeof *local);
    if (local) *local = (local_executor){ program, confine };
    *executor = (worker_executor){ .start = start,
                                   .has_ended = has_ended,
                                   .ask_to_stop = ask_to_stop,
                                   .kill = kill_worker,
                                   .places = places,
                                   .shares_threads = true,
                                   .bell = epoll_create1(EPOLL_CLOEXEC),
                                   .own = local };
    return local && executor->bell >= 0;
}

void executor_local_clear(worker_executor *executor)
{
    if (executor->bell >= 0) close(executor->bell);
    free(executor->own);
}
