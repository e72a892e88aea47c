/* A list of what is allowed, not of what is forbidden: a worker computes and writes files, for which it needs few calls, and
 * kernels get new ones every year. A call that is not in the list is not executed. It fails as it does on a kernel that does
 * not know it, so that a later C library falls back on an older call; it is told once in the log, and remembered: should the
 * run fail, that is not laid to the job (main.c). */
#include "confine_calls.h"

#include <asm/termbits.h>
#include <errno.h>
#include <fcntl.h>
#include <seccomp.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <ucontext.h>
#include <unistd.h>

#define CALL(name) SCMP_SYS(name)
#define A_THREAD 0x00010000 /* CLONE_THREAD, whose header does not go with the others */

/* With any arguments. */
static const int allowed[] = {
    /* files: which of them, Landlock says */
    CALL(read), CALL(write), CALL(readv), CALL(writev), CALL(pread64), CALL(pwrite64), CALL(preadv), CALL(pwritev), CALL(lseek),
    CALL(open), CALL(openat), CALL(close), CALL(close_range), CALL(fstat), CALL(stat), CALL(lstat), CALL(newfstatat), CALL(statx),
    CALL(access), CALL(faccessat), CALL(faccessat2), CALL(readlink), CALL(readlinkat), CALL(getdents), CALL(getdents64),
    CALL(mkdir), CALL(mkdirat), CALL(unlink), CALL(unlinkat), CALL(rename), CALL(renameat), CALL(renameat2), CALL(link),
    CALL(linkat), CALL(truncate), CALL(ftruncate), CALL(fallocate), CALL(fadvise64), CALL(fsync), CALL(fdatasync), CALL(statfs),
    CALL(fstatfs), CALL(flock), CALL(dup), CALL(dup2), CALL(dup3), CALL(chdir), CALL(fchdir), CALL(getcwd), CALL(umask),
    /* memory */
    CALL(munmap), CALL(mremap), CALL(madvise), CALL(brk),
    /* threads and signals of its own */
    CALL(futex), CALL(set_robust_list), CALL(get_robust_list), CALL(rseq), CALL(membarrier), CALL(gettid), CALL(getpid),
    CALL(getppid), CALL(sched_yield), CALL(sched_getaffinity), CALL(getcpu), CALL(rt_sigaction), CALL(rt_sigprocmask),
    CALL(rt_sigreturn), CALL(sigaltstack), CALL(restart_syscall), CALL(exit), CALL(exit_group),
    /* time, and facts about the process and the machine */
    CALL(nanosleep), CALL(clock_nanosleep), CALL(clock_gettime), CALL(clock_getres), CALL(gettimeofday), CALL(time), CALL(times),
    CALL(poll), CALL(ppoll), CALL(getrusage), CALL(getrlimit), CALL(sysinfo), CALL(uname), CALL(getrandom), CALL(getuid),
    CALL(geteuid), CALL(getgid), CALL(getegid)
};

/* What becoming another program takes, and confining that. */
static const int allowed_before_exec[] = { CALL(execve),
                                           CALL(arch_prctl),
                                           CALL(set_tid_address),
                                           CALL(prctl),
                                           CALL(seccomp),
                                           CALL(landlock_create_ruleset),
                                           CALL(landlock_add_rule),
                                           CALL(landlock_restrict_self) };

/* --- what was refused --- */

static volatile sig_atomic_t refused = -1;

long confine_calls_refused(void) { return refused; }

/* Only async-signal-safe calls. */
static void refuse(int number, siginfo_t *info, void *context)
{
    (void)number;
    char line[] = "warning: the confinement refused system call 0000\n";
    const int reason = errno, call = info->si_syscall;
    ((ucontext_t *)context)->uc_mcontext.gregs[REG_RAX] = -ENOSYS;
    if (call != refused) {
        for (int digit = 0, rest = call; digit < 4; digit++, rest /= 10)
            line[sizeof line - 3 - (size_t)digit] = (char)('0' + rest % 10);
        const ssize_t ignored = write(STDERR_FILENO, line, sizeof line - 1);
        (void)ignored;
    }
    refused = call;
    errno = reason;
}

static void watch_refusals(void)
{
    struct sigaction action = { .sa_sigaction = refuse, .sa_flags = SA_SIGINFO };
    sigaction(SIGSYS, &action, NULL);
}

/* --- the list --- */

static bool allow_all(scmp_filter_ctx filter, const int *calls, size_t count)
{
    bool good = true;
    for (size_t c = 0; c < count; c++) good = seccomp_rule_add(filter, SCMP_ACT_ALLOW, calls[c], 0) == 0 && good;
    return good;
}

#define ALLOW_IF(call, ...) (seccomp_rule_add(filter, SCMP_ACT_ALLOW, call, __VA_ARGS__) == 0)

/* Calls that may do more than a worker needs. */
static bool allow_with_conditions(scmp_filter_ctx filter, bool may_exec)
{
    const scmp_datum_t executable = may_exec ? 0 : PROT_EXEC, self = (scmp_datum_t)getpid();
    return ALLOW_IF(CALL(mmap), 1, SCMP_A2(SCMP_CMP_MASKED_EQ, executable, 0))
           && ALLOW_IF(CALL(mprotect), 1, SCMP_A2(SCMP_CMP_MASKED_EQ, executable, 0))
           && ALLOW_IF(CALL(clone), 1, SCMP_A0(SCMP_CMP_MASKED_EQ, A_THREAD, A_THREAD))
           && ALLOW_IF(CALL(tgkill), 1, SCMP_A0(SCMP_CMP_EQ, self))
           && ALLOW_IF(CALL(prlimit64), 2, SCMP_A0(SCMP_CMP_EQ, 0), SCMP_A2(SCMP_CMP_EQ, 0)) /* asks for one of its own */
           && ALLOW_IF(CALL(fcntl), 1, SCMP_A1(SCMP_CMP_LE, F_SETLKW))
           && ALLOW_IF(CALL(fcntl), 1, SCMP_A1(SCMP_CMP_EQ, F_DUPFD_CLOEXEC))
           && ALLOW_IF(CALL(ioctl), 1, SCMP_A1(SCMP_CMP_EQ, TCGETS))
           && ALLOW_IF(CALL(ioctl), 1, SCMP_A1(SCMP_CMP_EQ, TCGETS2))
           /* Its flags lie in memory, where no filter sees them; the C library takes clone instead. */
           && seccomp_rule_add(filter, SCMP_ACT_ERRNO(ENOSYS), CALL(clone3), 0) == 0;
}

bool confine_calls(bool may_exec, bool *confined)
{
    *confined = prctl(PR_GET_SECCOMP, 0, 0, 0, 0) >= 0; /* EINVAL where the kernel has none */
    if (!*confined) return true;
    scmp_filter_ctx filter = seccomp_init(SCMP_ACT_TRAP);
    bool good = filter && allow_all(filter, allowed, sizeof allowed / sizeof *allowed) && allow_with_conditions(filter, may_exec)
                && (!may_exec || allow_all(filter, allowed_before_exec, sizeof allowed_before_exec / sizeof *allowed_before_exec));
    watch_refusals();
    const int code = good ? seccomp_load(filter) : -ENOMEM;
    seccomp_release(filter);
    if (code == -EINVAL || code == -ENOSYS || code == -EOPNOTSUPP) *confined = false; /* without filters */
    else if (code != 0) {
        errno = -code;
        return false;
    }
    return true;
}
