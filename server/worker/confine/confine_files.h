/* Files, by Landlock: what is not allowed here can't be opened, made, removed or executed any more. */
#ifndef CONFINE_FILES_H
#define CONFINE_FILES_H

#include <stdbool.h>

/* spec: may be read, and so may programs and libraries, which may also be executed; NULL: none of these. Where the kernel has
 * no Landlock, *version is 0 and nothing is confined. False: errno says what the machine lacked. */
bool confine_files(const char *folder, const char *spec, int *version);

#endif
