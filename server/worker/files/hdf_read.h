/* Reading HDF5 files that we wrote, or that somebody made to look so. Nothing is believed: a file is looked at by its
 * checksum before HDF5 opens it, and of what is in it the kind of links, the type, the rank, the extent, and how much the
 * file can hold, before memory is taken. */
#ifndef HDF_READ_H
#define HDF_READ_H

#include <hdf5.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "file_seal.h"

/* For reading; negative unless *state becomes FILE_WHOLE. */
hid_t hdf_open_sealed(const char *name, file_state *state);

/* A hard link: what it leads to is in this file. */
bool hdf_is_there(hid_t file, const char *path);

/* One text of fixed length, to be freed; NULL: not there, something else, or no memory. */
char *hdf_read_text_attribute(hid_t file, const char *path, const char *name);
bool hdf_read_integer_attribute(hid_t file, const char *path, const char *name, int64_t *number);
bool hdf_read_real_attribute(hid_t file, const char *path, const char *name, double *number);

/* rows, columns of a dataset of two dimensions, whose product is no more than the file can hold. */
bool hdf_read_extent(hid_t file, const char *path, size_t *rows, size_t *columns);
/* A dataset that must have so many numbers in all, as `memory` type, whole numbers or reals as that. */
bool hdf_read_exactly(hid_t file, const char *path, hid_t memory, size_t count, void *data);

#endif
