/* Tables of numbers as comma-separated text: a bed's particles, the sieves of a size distribution. */
#ifndef CSV_TABLE_H
#define CSV_TABLE_H

#include <jansson.h>

#include "problem.h"

enum { CSV_LONGEST = 64 << 20, CSV_MOST_PARTICLES = 100000 };

/* A header row (x, y, z, and, of each particle, diameter or species or both; vx, vy, vz; wx, wy, wz), then a row for each particle: the
 * list of particles that "start" takes, in the order of the rows. Lines that are empty or begin with # are passed over. New reference;
 * NULL: there are problems, each at "/lines/12/diameter". */
json_t *csv_read_particles(const char *text, size_t length, problem_list *problems);

/* A header row (size, and cumulative or share), then a row for each sieve: {"sizes", "cumulative" or "shares"}. Of share, a row has what
 * is between its size and the next, and the last row has 0 or nothing. Likewise. */
json_t *csv_read_sieves(const char *text, size_t length, problem_list *problems);

/* What is wrong with the file of that name, at the pointer that names it. */
void csv_tell(const problem_list *of_file, const char *name, const char *pointer, problem_list *problems);

#endif
