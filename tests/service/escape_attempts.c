/* To be preloaded; a daemon is left alone. In a worker, at its first fsync, in the midst of the run, it tries what somebody
 * would who has got hold of the process, and writes to attempts.txt in the working directory what came of it: a line each,
 * "name 0" or "name errno".
 *
 *   ESCAPE_OUTSIDE  a folder that is not the job's, with a file "secret"
 *   ESCAPE_CALL     a system call, as its number, that is made once more at that place and whose failure is the run's: the fsync
 *                   fails with its error
 *   LACKING_KERNEL  "landlock", "seccomp" or both: what the kernel is to lack. Nothing is tried then */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

static FILE *report;

static void tell(const char *name, long result) { fprintf(report, "%s %d\n", name, result < 0 ? errno : 0); }

static long open_at(const char *folder, const char *name, int flags)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    const int file = open(path, flags, 0600);
    if (file >= 0) close(file);
    return file;
}

/* A child must not go on with the run. */
static long fork_once(void)
{
    const long child = syscall(SYS_fork);
    if (child == 0) _exit(0);
    if (child > 0) waitpid((pid_t)child, NULL, 0);
    return child;
}

static void try_everything(const char *outside)
{
    char target[4096], other[4096];
    char *const nothing[] = { NULL };
    const struct rlimit limit = { 1 << 20, 1 << 20 };
    snprintf(target, sizeof target, "%s/secret", outside);
    snprintf(other, sizeof other, "%s/link", outside);
    report = fopen("attempts.txt", "w");
    tell("own file", open_at(".", "own", O_RDWR | O_CREAT));
    tell("socket", socket(AF_INET, SOCK_STREAM, 0));
    tell("unix socket", socket(AF_UNIX, SOCK_STREAM, 0));
    tell("execve", execve("/nonexistent", nothing, nothing));
    tell("execveat", syscall(SYS_execveat, AT_FDCWD, "/nonexistent", nothing, nothing, 0));
    tell("fork", fork_once());
    tell("ptrace", ptrace(PTRACE_PEEKUSER, getppid(), NULL, NULL));
    tell("signal to another", kill(getppid(), 0));
    tell("read outside", open_at(outside, "secret", O_RDONLY));
    tell("list the folder above", open_at("..", ".", O_RDONLY | O_DIRECTORY));
    tell("write outside", open_at(outside, "new", O_RDWR | O_CREAT));
    tell("list outside", open_at(outside, ".", O_RDONLY | O_DIRECTORY));
    tell("link from outside", link(target, "stolen"));
    tell("link to outside", link("own", other));
    tell("truncate outside", truncate(target, 3));
    tell("symlink", symlink(target, "pointer"));
    tell("chmod", chmod("own", 0777));
    tell("memory to execute", mmap(NULL, 4096, PROT_READ | PROT_EXEC, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0) == MAP_FAILED ? -1 : 0);
    tell("higher limits", setrlimit(RLIMIT_CORE, &limit));
    tell("not to die with the daemon", prctl(PR_SET_PDEATHSIG, 0));
    tell("io_uring", syscall(SYS_io_uring_setup, 1, NULL));
    tell("open_by_handle_at", syscall(SYS_open_by_handle_at, AT_FDCWD, NULL, 0));
    fclose(report);
}

int fsync(int file)
{
    static int (*real)(int);
    static int tried;
    const char *outside = getenv("ESCAPE_OUTSIDE"), *call = getenv("ESCAPE_CALL");
    if (!real) *(void **)&real = dlsym(RTLD_NEXT, "fsync");
    if (strcmp(program_invocation_short_name, "repose") != 0) return real(file);
    if (outside && !tried) {
        tried = 1;
        try_everything(outside);
    }
    if (call && syscall(atol(call), 0, 0, 0) < 0) return -1;
    return real(file);
}

/* --- a kernel that lacks something --- */

static int lacks(const char *what)
{
    const char *list = getenv("LACKING_KERNEL");
    return list && strstr(list, what);
}

int prctl(int option, ...)
{
    static int (*real)(int, unsigned long, unsigned long, unsigned long, unsigned long);
    if (!real) *(void **)&real = dlsym(RTLD_NEXT, "prctl");
    if (option == PR_GET_SECCOMP && lacks("seccomp")) {
        errno = EINVAL;
        return -1;
    }
    va_list more;
    unsigned long argument[4];
    va_start(more, option);
    for (int k = 0; k < 4; k++) argument[k] = va_arg(more, unsigned long);
    va_end(more);
    return real(option, argument[0], argument[1], argument[2], argument[3]);
}

long syscall(long number, ...)
{
    static long (*real)(long, long, long, long, long, long, long);
    if (!real) *(void **)&real = dlsym(RTLD_NEXT, "syscall");
    if (number == SYS_landlock_create_ruleset && lacks("landlock")) {
        errno = ENOSYS;
        return -1;
    }
    va_list more;
    long argument[6];
    va_start(more, number);
    for (int k = 0; k < 6; k++) argument[k] = va_arg(more, long);
    va_end(more);
    return real(number, argument[0], argument[1], argument[2], argument[3], argument[4], argument[5]);
}
