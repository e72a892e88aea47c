#include "hdf_read.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

enum {
    LONGEST_PATH = 128,
    LONGEST_TEXT = 32 << 20,
    WIDEST_NUMBER = 8, /* bytes */
    MOST_DIMENSIONS = 8,
    BEST_PACKING = 1100 /* deflate makes of a byte no more than 1032 */
};

hid_t hdf_open_sealed(const char *name, file_state *state)
{
    *state = file_seal_look(name);
    if (*state != FILE_WHOLE) return H5I_INVALID_HID;
    errno = 0;                /* from here on a want of memory is that of HDF5 */
    H5PLset_loading_state(0); /* no file makes us load code */
    const hid_t file = H5Fopen(name, H5F_ACC_RDONLY, H5P_DEFAULT);
    if (file < 0) *state = FILE_DAMAGED;
    return file;
}

bool hdf_is_there(hid_t file, const char *path)
{
    char part[LONGEST_PATH];
    if (strlen(path) >= sizeof part) return false;
    for (size_t length = 1; length <= strlen(path); length++) {
        if (path[length] != '/' && path[length] != '\0') continue;
        H5L_info_t link;
        memcpy(part, path, length);
        part[length] = '\0';
        if (H5Lexists(file, part, H5P_DEFAULT) <= 0) return false;
        if (H5Lget_info(file, part, &link, H5P_DEFAULT) < 0 || link.type != H5L_TYPE_HARD) return false;
    }
    return true;
}

/* The attribute where it has exactly one value; else negative. */
static hid_t open_attribute(hid_t file, const char *path, const char *name)
{
    if (!hdf_is_there(file, path) || H5Aexists_by_name(file, path, name, H5P_DEFAULT) <= 0) return H5I_INVALID_HID;
    const hid_t attribute = H5Aopen_by_name(file, path, name, H5P_DEFAULT, H5P_DEFAULT);
    if (attribute < 0) return attribute;
    const hid_t space = H5Aget_space(attribute);
    const bool one = space >= 0 && H5Sget_simple_extent_npoints(space) == 1;
    if (space >= 0) H5Sclose(space);
    if (one) return attribute;
    H5Aclose(attribute);
    return H5I_INVALID_HID;
}

char *hdf_read_text_attribute(hid_t file, const char *path, const char *name)
{
    const hid_t attribute = open_attribute(file, path, name);
    if (attribute < 0) return NULL;
    const hid_t type = H5Aget_type(attribute);
    const bool is_text = type >= 0 && H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0;
    const size_t size = is_text ? H5Tget_size(type) : 0;
    char *text = size > 0 && size <= LONGEST_TEXT ? calloc(1, size + 1) : NULL;
    if (text && H5Aread(attribute, type, text) < 0) {
        free(text);
        text = NULL;
    }
    if (type >= 0) H5Tclose(type);
    H5Aclose(attribute);
    return text;
}

static bool is_number(hid_t type, H5T_class_t class)
{
    return type >= 0 && H5Tget_class(type) == class && H5Tget_size(type) <= WIDEST_NUMBER;
}

static bool read_one_number(hid_t file, const char *path, const char *name, hid_t memory, void *number)
{
    const hid_t attribute = open_attribute(file, path, name);
    if (attribute < 0) return false;
    const hid_t type = H5Aget_type(attribute);
    const bool read = is_number(type, H5Tget_class(memory)) && H5Aread(attribute, memory, number) >= 0;
    if (type >= 0) H5Tclose(type);
    H5Aclose(attribute);
    return read;
}

bool hdf_read_integer_attribute(hid_t file, const char *path, const char *name, int64_t *number)
{
    return read_one_number(file, path, name, H5T_NATIVE_INT64, number);
}

bool hdf_read_real_attribute(hid_t file, const char *path, const char *name, double *number)
{
    return read_one_number(file, path, name, H5T_NATIVE_DOUBLE, number);
}

static bool is_at_most(const hsize_t *extent, int rank, hsize_t most)
{
    hsize_t count = 1;
    for (int k = 0; k < rank; k++) {
        if (extent[k] > 0 && count > most / extent[k]) return false;
        count *= extent[k];
    }
    return count <= most;
}

/* Kept in the file itself, and packed in no other way than ours: then its bytes bound how many numbers it can hold. */
static bool is_kept_plainly(hid_t properties, hsize_t bytes, hsize_t *most)
{
    hsize_t chunk[MOST_DIMENSIONS];
    const H5D_layout_t layout = H5Pget_layout(properties);
    *most = layout == H5D_CHUNKED ? bytes * BEST_PACKING : bytes;
    if (layout == H5D_CONTIGUOUS) return H5Pget_external_count(properties) == 0;
    if (layout == H5D_COMPACT) return true;
    if (layout != H5D_CHUNKED) return false;
    const int rank = H5Pget_chunk(properties, MOST_DIMENSIONS, chunk);
    bool known = rank > 0 && rank <= MOST_DIMENSIONS && is_at_most(chunk, rank, *most);
    for (int k = 0; known && k < H5Pget_nfilters(properties); k++) {
        unsigned flags;
        size_t values = 0;
        const H5Z_filter_t filter = H5Pget_filter2(properties, (unsigned)k, &flags, &values, NULL, 0, NULL, NULL);
        known = filter == H5Z_FILTER_DEFLATE || filter == H5Z_FILTER_SHUFFLE;
    }
    return known;
}

/* A dataset of numbers of this class that the file can hold; extent: (MOST_DIMENSIONS). Else negative. */
static hid_t open_set(hid_t file, const char *path, const H5T_class_t *class, hsize_t *extent, int *rank)
{
    if (!hdf_is_there(file, path)) return H5I_INVALID_HID;
    const hid_t set = H5Dopen2(file, path, H5P_DEFAULT);
    if (set < 0) return set;
    const hid_t space = H5Dget_space(set), type = H5Dget_type(set), properties = H5Dget_create_plist(set);
    hsize_t most = 0;
    bool good = space >= 0 && type >= 0 && properties >= 0 && is_number(type, class ? *class : H5Tget_class(type))
                && H5Sis_simple(space) > 0 && H5Sget_simple_extent_ndims(space) <= MOST_DIMENSIONS;
    *rank = good ? H5Sget_simple_extent_dims(space, extent, NULL) : 0;
    good = good && *rank > 0 && is_kept_plainly(properties, H5Dget_storage_size(set), &most) && is_at_most(extent, *rank, most);
    if (properties >= 0) H5Pclose(properties);
    if (type >= 0) H5Tclose(type);
    if (space >= 0) H5Sclose(space);
    if (good) return set;
    H5Dclose(set);
    return H5I_INVALID_HID;
}

bool hdf_read_extent(hid_t file, const char *path, size_t *rows, size_t *columns)
{
    hsize_t extent[MOST_DIMENSIONS];
    int rank;
    const hid_t set = open_set(file, path, NULL, extent, &rank);
    if (set < 0) return false;
    *rows = extent[0];
    *columns = rank == 2 ? extent[1] : 0;
    return H5Dclose(set) >= 0 && rank == 2;
}

bool hdf_read_exactly(hid_t file, const char *path, hid_t memory, size_t count, void *data)
{
    hsize_t extent[MOST_DIMENSIONS], all = 1;
    int rank;
    const H5T_class_t class = H5Tget_class(memory);
    const hid_t set = open_set(file, path, &class, extent, &rank);
    if (set < 0) return false;
    for (int k = 0; k < rank; k++) all *= extent[k];
    const bool read = all == count && (count == 0 || H5Dread(set, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0);
    return H5Dclose(set) >= 0 && read;
}
