/* A file of the job folder that has the bytes of a stranger, and a checksum that fits them. */
#ifndef HOSTILE_FILE_H
#define HOSTILE_FILE_H

#include <fcntl.h>
#include <unistd.h>

#include "checksum.h"
#include "fuzz.h"

static inline void hostile_bytes(const char *name, const void *bytes, size_t size)
{
    const int file = open(name, O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
    CLAIM(file >= 0 && pwrite(file, bytes, size, 0) == (ssize_t)size && ftruncate(file, (off_t)size) == 0);
    close(file);
}

/* The checksum is the last line of the file itself. */
static inline void hostile_sealed(const char *name, const uint8_t *bytes, size_t size)
{
    char line[CHECKSUM_LINE + 1];
    checksum_write_line(checksum_of(bytes, size), line);
    const int file = open(name, O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
    CLAIM(file >= 0 && pwrite(file, bytes, size, 0) == (ssize_t)size);
    CLAIM(pwrite(file, line, CHECKSUM_LINE, (off_t)size) == CHECKSUM_LINE && ftruncate(file, (off_t)size + CHECKSUM_LINE) == 0);
    close(file);
}

#endif
