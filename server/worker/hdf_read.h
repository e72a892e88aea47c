/* Reading HDF5 files that we wrote: sizes are looked at before memory is taken, and nothing is believed. */
#ifndef HDF_READ_H
#define HDF_READ_H

#include <hdf5.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* To be freed; NULL: not there, no text, or no memory. */
char *hdf_read_text_attribute(hid_t file, const char *path, const char *name);
bool hdf_read_integer_attribute(hid_t file, const char *path, const char *name, int64_t *number);
bool hdf_read_real_attribute(hid_t file, const char *path, const char *name, double *number);

/* rows, columns of a dataset of two dimensions. */
bool hdf_read_extent(hid_t file, const char *path, size_t *rows, size_t *columns);
/* The same for a dataset that must have so many numbers in all. */
bool hdf_read_exactly(hid_t file, const char *path, hid_t memory, size_t count, void *data);
/* The dataset as `memory` type; data: room for all of it. */
bool hdf_read_array(hid_t file, const char *path, hid_t memory, void *data);

#endif
