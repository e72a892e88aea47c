/* A grandchild, whose parent leaves at once: so it is nobody's to wait for, and no worker of ours. It lives for seconds,
 * and ends with the daemon: its standard input is a pipe to which the daemon alone holds the other end, and whose end is a
 * signal. What it writes appears whole. Only async-signal-safe calls after the fork. */
#include "calibrator.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "log.h"

enum { MOST_SECONDS = 60 }; /* of the clock, within which it sees to it that it ends; processor time is no more */

/* SIGIO, which ends the process, comes when the last writer is gone; not if that was before. */
static void end_with_the_daemon(void)
{
    struct pollfd end = { .fd = 0 };
    if (fcntl(0, F_SETOWN, getpid()) != 0 || fcntl(0, F_SETFL, O_ASYNC) != 0) _exit(1);
    if (poll(&end, 1, 0) != 0) _exit(1);
}

static void become_calibrator(int leash, const char *program, char *const *arguments)
{
    sigset_t none;
    const struct sched_param no_priority = { .sched_priority = 0 };
    const struct rlimit seconds = { MOST_SECONDS, MOST_SECONDS };
    const int null = open("/dev/null", O_RDWR);
    if (null < 0 || dup2(leash, 0) < 0 || dup2(null, 1) < 0) _exit(1);
    /* At once, not at the exec, for which an idle process may wait long: the lock of the data folder is among them. */
    close_range(3, ~0U, 0);
    setpgid(0, 0); /* no session of its own: the scheduler would weigh that against the jobs of ours */
    for (int number = 1; number < 32; number++) signal(number, SIG_DFL);
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, NULL);
    end_with_the_daemon();
    sched_setscheduler(0, SCHED_IDLE, &no_priority); /* jobs have all the time they want */
    setrlimit(RLIMIT_CPU, &seconds);
    alarm(MOST_SECONDS); /* holds over the exec */
    prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
    execv(program, arguments);
    _exit(1);
}

void calibrator_start(const char *program, const char *folder)
{
    char *const arguments[] = { (char *)program, "calibrate", "--data", (char *)folder, NULL };
    int leash[2]; /* the writing end stays open as long as the daemon lives */
    const pid_t between = pipe2(leash, O_CLOEXEC) == 0 ? fork() : -1;
    if (between == 0) {
        if (fork() == 0) become_calibrator(leash[0], program, arguments);
        _exit(0);
    }
    if (between > 0) close(leash[0]);
    if (between < 0) log_line("estimates stay rough: %s", strerror(errno));
    while (between > 0 && waitpid(between, NULL, 0) < 0 && errno == EINTR) continue;
}
