#ifndef VERSION_H
#define VERSION_H

#define REPOSED_VERSION "0.1.0" /* of both programs */

/* The commit that a program was made from, "(commit 0123456789ab)"; "": not known. Linked to programs alone (Makefile), so that a
 * commit compiles and links nothing else again. */
extern const char reposed_commit[];

#endif
