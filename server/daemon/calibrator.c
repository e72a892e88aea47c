/* A grandchild, whose parent leaves at once: so it is nobody's to wait for, and no worker of ours. It lives for seconds,
 * also when the daemon ends meanwhile; what it writes appears whole. Only async-signal-safe calls after the fork. */
#include "calibrator.h"

#include <errno.h>
#include <fcntl.h>
#include <sched.h>
#include <signal.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "log.h"

enum { MOST_SECONDS = 60 }; /* of processor time */

static void become_calibrator(const char *program, char *const *arguments)
{
    sigset_t none;
    const struct sched_param no_priority = { .sched_priority = 0 };
    const struct rlimit seconds = { MOST_SECONDS, MOST_SECONDS };
    const int null = open("/dev/null", O_RDWR);
    if (null < 0 || dup2(null, 0) < 0 || dup2(null, 1) < 0) _exit(1);
    /* At once, not at the exec, for which an idle process may wait long: the lock of the data folder is among them. */
    close_range(3, ~0U, 0);
    setpgid(0, 0); /* no session of its own: the scheduler would weigh that against the jobs of ours */
    for (int number = 1; number < 32; number++) signal(number, SIG_DFL);
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, NULL);
    sched_setscheduler(0, SCHED_IDLE, &no_priority); /* jobs have all the time they want */
    setrlimit(RLIMIT_CPU, &seconds);
    prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
    execv(program, arguments);
    _exit(1);
}

void calibrator_start(const char *program, const char *folder)
{
    char *const arguments[] = { (char *)program, "calibrate", "--data", (char *)folder, NULL };
    const pid_t between = fork();
    if (between == 0) {
        if (fork() == 0) become_calibrator(program, arguments);
        _exit(0);
    }
    if (between < 0) log_line("estimates stay rough: %s", strerror(errno));
    while (between > 0 && waitpid(between, NULL, 0) < 0 && errno == EINTR) continue;
}
