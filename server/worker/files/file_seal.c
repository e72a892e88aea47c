#include "file_seal.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "checksum.h"
#include "file_publish.h"
#include "worker_log.h"

enum { PIECE = 1 << 16 };

/* Of the first `length` bytes; false: errno says why, 0: there are fewer. */
static bool sum_of(int file, off_t length, uint64_t *sum)
{
    char piece[PIECE];
    checksum state;
    checksum_begin(&state);
    for (off_t at = 0; at < length;) {
        const size_t wanted = length - at < PIECE ? (size_t)(length - at) : PIECE;
        errno = 0;
        const ssize_t got = pread(file, piece, wanted, at);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return false;
        checksum_add(&state, piece, (size_t)got);
        at += got;
    }
    *sum = checksum_end(&state);
    return true;
}

bool file_seal(const char *name)
{
    const int file = open(name, O_RDWR | O_CLOEXEC);
    struct stat facts;
    uint64_t sum;
    char line[CHECKSUM_LINE + 1];
    bool sealed = file >= 0 && fstat(file, &facts) == 0 && sum_of(file, facts.st_size, &sum);
    if (sealed) {
        checksum_write_line(sum, line);
        sealed = pwrite(file, line, CHECKSUM_LINE, facts.st_size) == CHECKSUM_LINE;
    }
    if (!sealed) file_log_write_failure(name, errno ? strerror(errno) : "no room for its checksum");
    if (file >= 0) sealed = close(file) == 0 && sealed;
    return sealed;
}

/* What a failed call tells of a file. A sector that can't be read any more is damage. */
static file_state state_of_failure(const char *name, int reason)
{
    if (reason == ENOENT) return FILE_ABSENT;
    if (reason == 0 || reason == EIO || reason == ELOOP || reason == ENXIO) return FILE_DAMAGED;
    worker_warn("can't read %s: %s", name, strerror(reason));
    return FILE_UNREADABLE;
}

file_state file_seal_look(const char *name)
{
    struct stat facts;
    uint64_t sum;
    char line[CHECKSUM_LINE + 1], expected[CHECKSUM_LINE + 1];
    const int file = open(name, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (file < 0) return state_of_failure(name, errno);
    file_state state = FILE_DAMAGED;
    if (fstat(file, &facts) == 0 && S_ISREG(facts.st_mode) && facts.st_size > CHECKSUM_LINE) {
        const off_t length = facts.st_size - CHECKSUM_LINE;
        if (sum_of(file, length, &sum) && pread(file, line, CHECKSUM_LINE, length) == CHECKSUM_LINE) {
            checksum_write_line(sum, expected);
            state = memcmp(line, expected, CHECKSUM_LINE) == 0 ? FILE_WHOLE : FILE_DAMAGED;
        } else {
            state = state_of_failure(name, errno);
        }
    }
    close(file);
    return state;
}

bool file_write_sealed(const char *name, const char *text, size_t length, const char *origin)
{
    char beside[PATH_MAX], lines[CHECKSUM_LINES + 1];
    snprintf(beside, sizeof beside, "%s.sum", name);
    checksum_write_lines(text, length, origin ? origin : "", lines);
    return file_write(beside, lines, origin ? CHECKSUM_LINES : CHECKSUM_LINE) && file_write(name, text, length);
}

static bool seal_fits(const char *seal, size_t seal_length, const char *text, size_t length, const char *origin)
{
    char lines[CHECKSUM_LINES + 1];
    if (!origin) return checksum_line_fits(seal, seal_length, text, length);
    checksum_write_lines(text, length, origin, lines);
    return seal_length == CHECKSUM_LINES && memcmp(seal, lines, CHECKSUM_LINES) == 0;
}

/* file_read, and why not. */
static char *read_whole(const char *name, size_t most, size_t *length, file_state *state)
{
    errno = 0;
    char *text = file_read(name, most, length);
    *state = text ? FILE_WHOLE : state_of_failure(name, errno);
    return text;
}

char *file_read_sealed(const char *name, size_t most, const char *origin, size_t *length, file_state *state)
{
    char beside[PATH_MAX];
    size_t seal_length;
    file_state of_seal;
    char *text = read_whole(name, most, length, state);
    if (!text) return NULL;
    snprintf(beside, sizeof beside, "%s.sum", name);
    char *seal = read_whole(beside, CHECKSUM_LINES, &seal_length, &of_seal);
    const bool fits = seal ? seal_fits(seal, seal_length, text, *length, origin) : of_seal == FILE_ABSENT && !origin;
    if (!fits) *state = of_seal == FILE_UNREADABLE ? FILE_UNREADABLE : FILE_DAMAGED;
    free(seal);
    if (*state == FILE_WHOLE) return text;
    free(text);
    return NULL;
}
