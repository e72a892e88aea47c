#include "confinement.h"

#include <errno.h>
#include <seccomp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include "confine_calls.h"
#include "confine_files.h"
#include "worker_log.h"

static bool confine(const char *folder, const char *spec, int *landlock, bool *seccomp)
{
    *landlock = 0;
    *seccomp = false;
    if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && confine_files(folder, spec, landlock) && confine_calls(spec, seccomp))
        return true;
    worker_warn("can't be confined to its folder: %s", strerror(errno));
    return false;
}

bool confinement_begin(const char *folder, const char *spec)
{
    int landlock;
    bool seccomp;
    if (mkdir(folder, 0755) == 0 || errno == EEXIST) return confine(folder, spec, &landlock, &seccomp);
    worker_warn("can't make the folder %s: %s", folder, strerror(errno));
    return false;
}

static void add_limit(char *text, size_t size, int resource, const char *name, double unit, const char *unit_name)
{
    struct rlimit limit;
    if (getrlimit(resource, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return;
    const size_t used = strlen(text);
    snprintf(text + used, size - used, "%s%s %.1f %s", used ? ", " : "", name, (double)limit.rlim_cur / unit, unit_name);
}

static void tell(int landlock, bool seccomp)
{
    char files[64] = "not confined, this kernel has no Landlock", limits[160] = "";
    if (landlock) snprintf(files, sizeof files, "the job folder alone (Landlock %d)", landlock);
    add_limit(limits, sizeof limits, RLIMIT_AS, "memory", 1e9, "GB");
    add_limit(limits, sizeof limits, RLIMIT_CPU, "processor time", 3600.0, "h");
    add_limit(limits, sizeof limits, RLIMIT_FSIZE, "a file", 1e9, "GB");
    worker_log("confinement: no new privileges; files: %s; system calls: %s; limits: %s", files,
               seccomp ? "those of a list (seccomp)" : "not confined, this kernel has no seccomp", limits[0] ? limits : "none");
}

bool confinement_complete(const char *folder)
{
    int landlock;
    bool seccomp;
    if (!confine(folder, NULL, &landlock, &seccomp)) return false;
    tell(landlock, seccomp);
    return true;
}

bool confinement_has_refused(void)
{
    const long call = confine_calls_refused();
    if (call < 0) return false;
    char *name = seccomp_syscall_resolve_num_arch(SCMP_ARCH_NATIVE, (int)call);
    worker_warn("the confinement refused the system call %s (%ld), which may be why this run failed; `reposed serve --confine no` "
                "runs workers without it",
                name ? name : "?", call);
    free(name);
    return true;
}
