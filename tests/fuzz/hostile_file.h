/* A file of the job folder that has the bytes of a stranger. */
#ifndef HOSTILE_FILE_H
#define HOSTILE_FILE_H

#include <fcntl.h>
#include <unistd.h>

#include "fuzz.h"

static inline void hostile_bytes(const char *name, const void *bytes, size_t size)
{
    const int file = open(name, O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
    CLAIM(file >= 0 && pwrite(file, bytes, size, 0) == (ssize_t)size && ftruncate(file, (off_t)size) == 0);
    close(file);
}

#endif
