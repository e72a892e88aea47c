/* To be preloaded: calls of one kind fail in one program, from the n-th on, as on a machine that has run out of something.
 *
 *   FAILING_PROGRAM  its file name begins like this, and goes on with nothing or "-"
 *   FAILING_CALL     malloc, open, read, write, fsync, rename, mkdir, fork
 *   FAILING_FIRST    1: the first call fails
 *   FAILING_COUNT    how many fail one after the other
 *   FAILING_ERROR    the number of the error
 *
 * read and write mean those of regular files. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char *failing;
static long first, count;
static int error;
static atomic_long calls;

static long number_of(const char *name)
{
    const char *text = getenv(name);
    return text ? atol(text) : 0;
}

__attribute__((constructor)) static void choose(void)
{
    char path[4096] = "";
    const char *program = getenv("FAILING_PROGRAM");
    if (!program || readlink("/proc/self/exe", path, sizeof path - 1) < 0) return;
    const char *name = strrchr(path, '/') + 1;
    const size_t length = strlen(program);
    if (strncmp(name, program, length) != 0 || (name[length] && name[length] != '-')) return;
    first = number_of("FAILING_FIRST");
    count = number_of("FAILING_COUNT");
    error = (int)number_of("FAILING_ERROR");
    failing = getenv("FAILING_CALL");
}

static bool fails(const char *call)
{
    if (!failing || strcmp(failing, call) != 0) return false;
    const long number = atomic_fetch_add(&calls, 1) + 1;
    if (number < first || number >= first + count) return false;
    errno = error;
    return true;
}

static bool is_regular(int file)
{
    struct stat facts;
    const int before = errno;
    const bool regular = file > 2 && fstat(file, &facts) == 0 && S_ISREG(facts.st_mode);
    errno = before;
    return regular;
}

/* A function NAME of ours around the one of the C library. */
#define AROUND(type, name, arguments, values, call, is_meant, failure)                                                             \
    type name arguments                                                                                                            \
    {                                                                                                                              \
        static type(*next) arguments;                                                                                              \
        if (!next) next = (type(*) arguments)dlsym(RTLD_NEXT, #name);                                                              \
        if ((is_meant) && fails(call)) return failure;                                                                             \
        return next values;                                                                                                        \
    }

AROUND(void *, malloc, (size_t size), (size), "malloc", true, NULL)
AROUND(ssize_t, read, (int file, void *to, size_t size), (file, to, size), "read", is_regular(file), -1)
AROUND(ssize_t, pread, (int file, void *to, size_t size, off_t at), (file, to, size, at), "read", is_regular(file), -1)
AROUND(ssize_t, pread64, (int file, void *to, size_t size, off_t at), (file, to, size, at), "read", is_regular(file), -1)
AROUND(ssize_t, write, (int file, const void *from, size_t size), (file, from, size), "write", is_regular(file), -1)
AROUND(ssize_t, pwrite, (int file, const void *from, size_t size, off_t at), (file, from, size, at), "write", is_regular(file), -1)
AROUND(ssize_t, pwrite64, (int file, const void *from, size_t size, off_t at), (file, from, size, at), "write", is_regular(file),
       -1)
AROUND(int, fsync, (int file), (file), "fsync", true, -1)
AROUND(int, fdatasync, (int file), (file), "fsync", true, -1)
AROUND(int, rename, (const char *from, const char *to), (from, to), "rename", true, -1)
AROUND(int, renameat, (int a, const char *from, int b, const char *to), (a, from, b, to), "rename", true, -1)
AROUND(int, mkdir, (const char *name, mode_t mode), (name, mode), "mkdir", true, -1)
AROUND(int, mkdirat, (int folder, const char *name, mode_t mode), (folder, name, mode), "mkdir", true, -1)
AROUND(pid_t, fork, (void), (), "fork", true, -1)

/* The mode is there where a file may be made. */
#define AROUND_OPEN(name, arguments, ...)                                                                                          \
    int name arguments                                                                                                             \
    {                                                                                                                              \
        static int(*next) arguments;                                                                                               \
        va_list more;                                                                                                              \
        va_start(more, flags);                                                                                                     \
        const mode_t mode = flags & (O_CREAT | __O_TMPFILE) ? va_arg(more, mode_t) : 0;                                            \
        va_end(more);                                                                                                              \
        if (!next) next = (int(*) arguments)dlsym(RTLD_NEXT, #name);                                                               \
        return fails("open") ? -1 : next(__VA_ARGS__, flags, mode);                                                                \
    }

AROUND_OPEN(open, (const char *name, int flags, ...), name)
AROUND_OPEN(open64, (const char *name, int flags, ...), name)
AROUND_OPEN(openat, (int folder, const char *name, int flags, ...), folder, name)
