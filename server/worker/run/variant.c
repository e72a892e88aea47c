#include "variant.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "dem.h"
#include "worker_log.h"

/* Best first. */
static const char *const isas[] = { "avx512", "avx2", "plain" };
enum { ISAS = sizeof isas / sizeof isas[0] };

/* As the compiler groups them: levels 4 and 3 of x86-64. */
static bool processor_has(size_t isa)
{
    __builtin_cpu_init();
    if (isa == 0) return __builtin_cpu_supports("x86-64-v4");
    if (isa == 1) return __builtin_cpu_supports("x86-64-v3");
    return true;
}

static const char *best_isa(void)
{
    size_t isa = 0;
    while (!processor_has(isa)) isa++;
    return isas[isa];
}

bool variant_isa_is_usable(const char *isa)
{
    if (!isa) return true;
    size_t k = 0;
    while (k < ISAS && strcmp(isa, isas[k]) != 0) k++;
    if (k == ISAS)
        fprintf(stderr, "repose: --isa is \"%s\"; must be one of avx512, avx2, plain; on this processor %s is best\n", isa,
                best_isa());
    else if (!processor_has(k))
        fprintf(stderr, "repose: --isa is \"%s\", which this processor has not; %s is the best that it has\n", isa, best_isa());
    return k < ISAS && processor_has(k);
}

bool variant_take_over(const char *isa, const char *precision, char *const *argv)
{
    if (!isa) isa = best_isa();
    const bool same_precision = strcmp(precision, dem_build_precision()) == 0;
    if (same_precision && strcmp(isa, dem_build_isa()) == 0) return true;
    char own[PATH_MAX] = "", other[PATH_MAX + 64];
    if (readlink("/proc/self/exe", own, sizeof own - 1) < 0) own[0] = '\0';
    char *name = strrchr(own, '/');
    const int folder = name ? (int)(name - own) : 0;
    if (strcmp(isa, "plain") == 0 && strcmp(precision, "single") == 0) snprintf(other, sizeof other, "%.*s/repose", folder, own);
    else snprintf(other, sizeof other, "%.*s/repose-%s-%s", folder, own, precision, isa);
    errno = ENOEXEC; /* a program under another's name would hand over to itself for ever */
    if (strcmp(other, own) != 0) execv(other, argv);
    const int reason = errno;
    if (same_precision) worker_warn("%s: %s; going on with %s, which is slower", other, strerror(reason), dem_build_isa());
    else fprintf(stderr, "repose: %s: %s; it is needed for %s precision\n", other, strerror(reason), precision);
    errno = reason;
    return same_precision;
}

bool variant_keep_stdin(void)
{
    char text[65536];
    const int kept = memfd_create("stdin", 0);
    ssize_t length = kept < 0 ? -1 : 1;
    while (length > 0) {
        length = read(STDIN_FILENO, text, sizeof text);
        if (length < 0 && errno == EINTR) length = 1;
        else if (length > 0 && write(kept, text, (size_t)length) != length) length = -1;
    }
    const bool good = length == 0 && lseek(kept, 0, SEEK_SET) == 0 && dup2(kept, STDIN_FILENO) == STDIN_FILENO;
    if (!good) fprintf(stderr, "repose: can't read standard input: %s\n", strerror(errno));
    if (kept >= 0) close(kept);
    return good;
}
