/* HDF5 with every return value checked: a file being written remembers its first failure and does nothing after
 * it, so that whoever writes need ask only once, at the end. */
#ifndef HDF_FILE_H
#define HDF_FILE_H

#include <hdf5.h>
#include <stdbool.h>

/* Error stacks go to the log from now on. */
void hdf_init(void);

typedef struct hdf_file {
    hid_t file;
    bool failed;
    const char *name;   /* final name; written as name.tmp */
    const char *before; /* name that the file of before keeps; NULL: it is replaced */
} hdf_file;

typedef enum hdf_packing { HDF_PLAIN, HDF_COMPRESSED } hdf_packing;

/* What to write: rows x columns (columns 0: one dimension) of `memory` type, kept as `stored` type. */
typedef struct hdf_array {
    const char *path; /* groups on the way are made */
    hid_t memory, stored;
    size_t rows, columns;
    const void *data;
    const char *unit; /* kept as the attribute "units"; NULL: "1", a number by itself */
} hdf_array;

void hdf_create(hdf_file *file, const char *name);
void hdf_add_group(hdf_file *file, const char *path);
void hdf_add_array(hdf_file *file, const hdf_array *array, hdf_packing packing);
/* Points of planes one above the other, x fastest: ([layers,] rows, columns[, components]) of f4; layers 0: one plane. */
typedef struct hdf_image {
    const char *path;
    size_t layers, rows, columns, components;
    const double *data;
    const char *unit; /* NULL: none */
} hdf_image;
void hdf_add_image(hdf_file *file, const hdf_image *image);
void hdf_add_hard_link(hdf_file *file, const char *target, const char *path);
/* Attributes of the group or dataset at `path`. The text: fixed length, ASCII or UTF-8, padded with \0. */
void hdf_add_text_attribute(hdf_file *file, const char *path, const char *name, const char *text, H5T_cset_t charset);
void hdf_add_integers_attribute(hdf_file *file, const char *path, const char *name, const int64_t *numbers, size_t count);
void hdf_add_reals_attribute(hdf_file *file, const char *path, const char *name, const double *numbers, size_t count);
void hdf_add_real_attribute(hdf_file *file, const char *path, const char *name, double number);

/* Closes, seals (file_seal.h), syncs and renames to the final name; false if anything failed since hdf_create. */
bool hdf_publish(hdf_file *file);

#endif
