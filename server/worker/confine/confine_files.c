/* Each version of Landlock confines more; what the running kernel's has not is left out. glibc has no functions for it, and
 * the header of an older kernel lacks what came later: hence the numbers here, which are those of the kernel's interface. */
#include "confine_files.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <link.h>
#include <linux/landlock.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#define REFER (1ULL << 13)     /* from version 2 on */
#define TRUNCATE (1ULL << 14)  /* 3 */
#define IOCTL_DEV (1ULL << 15) /* 5 */
#define ALL_TCP 3ULL           /* 4: bind and connect */
#define ALL_SCOPES 3ULL        /* 6: abstract sockets of, and signals to, processes that are not confined by this */
#define OF_VERSION_1 ((1ULL << 13) - 1)

#define EXECUTE ((uint64_t)LANDLOCK_ACCESS_FS_EXECUTE)
#define READ ((uint64_t)LANDLOCK_ACCESS_FS_READ_FILE)
#define LIST ((uint64_t)LANDLOCK_ACCESS_FS_READ_DIR)
#define OF_A_FILE (EXECUTE | READ | (uint64_t)LANDLOCK_ACCESS_FS_WRITE_FILE | TRUNCATE)
#define WORK                                                                                                                       \
    (READ | LIST | TRUNCATE | REFER                                                                                                \
     | (uint64_t)(LANDLOCK_ACCESS_FS_WRITE_FILE | LANDLOCK_ACCESS_FS_MAKE_REG | LANDLOCK_ACCESS_FS_MAKE_DIR                        \
                  | LANDLOCK_ACCESS_FS_REMOVE_FILE))

/* struct landlock_ruleset_attr of version 6; an older kernel takes it as long as what it does not know is 0. */
typedef struct ruleset_facts {
    uint64_t files, tcp, scopes;
} ruleset_facts;

typedef struct ruleset {
    int file;
    uint64_t handled; /* of rights on files */
    bool good;        /* false: errno */
} ruleset;

static int landlock_version(void)
{
    const long version = syscall(SYS_landlock_create_ruleset, NULL, (size_t)0, LANDLOCK_CREATE_RULESET_VERSION);
    return version > 0 ? (int)version : 0; /* not compiled in, or not switched on */
}

static void create(ruleset *rules, int version)
{
    const ruleset_facts facts = {
        .files = OF_VERSION_1 | (version >= 2 ? REFER : 0) | (version >= 3 ? TRUNCATE : 0) | (version >= 5 ? IOCTL_DEV : 0),
        .tcp = version >= 4 ? ALL_TCP : 0,
        .scopes = version >= 6 ? ALL_SCOPES : 0,
    };
    const size_t size = version >= 6 ? sizeof facts : version >= 4 ? offsetof(ruleset_facts, scopes) : sizeof facts.files;
    rules->handled = facts.files;
    rules->file = (int)syscall(SYS_landlock_create_ruleset, &facts, size, 0U);
    rules->good = rules->file >= 0;
}

/* What is not there needs no rule. */
static void allow(ruleset *rules, const char *path, uint64_t rights)
{
    struct stat facts;
    if (!rules->good) return;
    const int file = open(path, O_PATH | O_CLOEXEC);
    if (file < 0) {
        rules->good = errno != EMFILE && errno != ENFILE && errno != ENOMEM;
        return;
    }
    if (fstat(file, &facts) == 0 && !S_ISDIR(facts.st_mode)) rights &= OF_A_FILE;
    const struct landlock_path_beneath_attr rule = { .allowed_access = rights & rules->handled, .parent_fd = file };
    rules->good = syscall(SYS_landlock_add_rule, rules->file, LANDLOCK_RULE_PATH_BENEATH, &rule, 0U) == 0;
    const int reason = errno;
    close(file);
    errno = reason;
}

static void allow_folder_of(ruleset *rules, const char *path)
{
    char real[PATH_MAX];
    if (!realpath(path, real)) return;
    char *name = strrchr(real, '/');
    if (name == real) return; /* no program lies in the root, and that would be all */
    *name = '\0';
    allow(rules, real, EXECUTE | READ);
}

/* The programs of all variants have the same libraries, and the loader, which is in this list, is executed. */
static int allow_library(struct dl_phdr_info *library, size_t size, void *rules)
{
    (void)size;
    if (library->dlpi_name && strchr(library->dlpi_name, '/')) allow_folder_of(rules, library->dlpi_name);
    return 0;
}

bool confine_files(const char *folder, const char *spec, int *version)
{
    *version = landlock_version();
    if (*version == 0) return true;
    ruleset rules;
    create(&rules, *version);
    allow(&rules, folder, WORK);
    allow(&rules, "/sys/devices/system/cpu", READ | LIST); /* OpenMP counts the processors */
    allow(&rules, "/proc/self", READ);
    allow(&rules, "/dev/urandom", READ);
    if (spec) {
        allow(&rules, spec, READ);
        allow(&rules, "/etc/ld.so.cache", READ);
        allow_folder_of(&rules, "/proc/self/exe");
        dl_iterate_phdr(allow_library, &rules);
    }
    if (rules.good) rules.good = syscall(SYS_landlock_restrict_self, rules.file, 0U) == 0;
    const int reason = errno;
    if (rules.file >= 0) close(rules.file);
    errno = reason;
    return rules.good;
}
