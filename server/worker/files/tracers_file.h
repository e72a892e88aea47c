/* tracers.csv and tracers.hdf: the paths of the particles that were asked for. */
#ifndef TRACERS_FILE_H
#define TRACERS_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* particle: (particles) ids. rows: (samples, 1 + 9 particles): time in s, and of each particle its place, velocity and angular
 * velocity, of the scene as it was asked for. params: the canonical spec. False: the disk, or no memory (logged). */
bool tracers_file_write(const int32_t *particle, size_t particles, const double *rows, size_t samples, const char *params);

#endif
