/* Files that tell whether they are as they were written. An HDF5 file ends in the line of its checksum, which HDF5 does not
 * look at; a text that others read as JSON has it in a file beside it, NAME.sum, which is written first. */
#ifndef FILE_SEAL_H
#define FILE_SEAL_H

#include <stdbool.h>
#include <stddef.h>

typedef enum file_state {
    FILE_WHOLE,
    FILE_ABSENT,
    FILE_DAMAGED,   /* other bytes than were written, or no file of ours */
    FILE_UNREADABLE /* the machine can't read it now (logged): it may be whole */
} file_state;

/* Appends the line to a file that is closed. False: logged. */
bool file_seal(const char *name);
file_state file_seal_look(const char *name);

/* A text, published with its checksum beside it; with an origin (else NULL), what it was made from, also with that of both.
 * False: logged. */
bool file_write_sealed(const char *name, const char *text, size_t length, const char *origin);
/* NULL unless *state is FILE_WHOLE: with an origin only where it was made from that. With none, a text that has no NAME.sum,
 * which is not written by everybody, is taken as whole. */
char *file_read_sealed(const char *name, size_t most, const char *origin, size_t *length, file_state *state);

#endif
