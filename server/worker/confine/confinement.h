/* What a worker may still do once it knows its folder: a job's files are data, and a fault in a library that reads them must
 * not give anybody more than that folder. In two steps, because a worker may become another program (variant.h):
 *
 *                     | to begin                                        | complete
 *   files (Landlock)  | the job folder; the spec, the programs and      | the job folder
 *                     | libraries are read and executed                 |
 *   calls (seccomp)   | those of a list                                 | without exec, and without memory that is executed
 *
 * Both are inherited and can't be taken back. A kernel that lacks one of them confines by the other; the log says so. */
#ifndef CONFINEMENT_H
#define CONFINEMENT_H

#include <stdbool.h>

/* folder is made where it is missing. False: the machine lacked something for it (logged). */
bool confinement_begin(const char *folder, const char *spec);
/* After the last exec, and before any file of another run is read. */
bool confinement_complete(const char *folder);
/* Whether a system call was refused: then a failure is not the job's. It is named in the log. */
bool confinement_has_refused(void);

#endif
