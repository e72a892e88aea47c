/* Files that appear whole or not at all: written as NAME.tmp, synced, renamed, the folder synced.
 *
 * All names are relative to the job folder, which is the working directory of a worker at work. Failures are
 * logged here, with the reason. */
#ifndef FILE_PUBLISH_H
#define FILE_PUBLISH_H

#include <dirent.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* NAME.tmp, already written and closed, becomes NAME. */
bool file_publish(const char *name);
/* The same, and a file that was NAME before becomes BEFORE; NULL: it is gone. There is one of the two at any moment. */
bool file_publish_keeping(const char *name, const char *before);
bool file_write(const char *name, const char *text, size_t length);
/* The same of what was printed to a stream of open_memstream (NULL: there was no memory for it), which is closed, and its text freed. */
bool file_write_stream(const char *name, FILE *stream, char **text, const size_t *length);

/* The whole file, with a \0 after it; to be freed. NULL: not there or not readable (logged unless not there). */
char *file_read(const char *name, size_t most, size_t *length);

/* NULL: not there, or no folder but a symbolic link. */
DIR *file_list_folder(const char *folder);

/* Left over from a worker that died while writing. */
void file_sweep_temporary(const char *folder);

/* Says why writing NAME failed and how much room the disk has. */
void file_log_write_failure(const char *name, const char *reason);

#endif
