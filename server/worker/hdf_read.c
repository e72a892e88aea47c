#include "hdf_read.h"

#include <stdlib.h>

char *hdf_read_text_attribute(hid_t file, const char *path, const char *name)
{
    const hid_t attribute = H5Aopen_by_name(file, path, name, H5P_DEFAULT, H5P_DEFAULT);
    if (attribute < 0) return NULL;
    const hid_t type = H5Aget_type(attribute);
    const size_t size = H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0 ? H5Tget_size(type) : 0;
    char *text = size ? calloc(1, size + 1) : NULL;
    if (text && H5Aread(attribute, type, text) < 0) {
        free(text);
        text = NULL;
    }
    H5Tclose(type);
    H5Aclose(attribute);
    return text;
}

static bool read_one_number(hid_t file, const char *path, const char *name, hid_t memory, void *number)
{
    const hid_t attribute = H5Aopen_by_name(file, path, name, H5P_DEFAULT, H5P_DEFAULT);
    if (attribute < 0) return false;
    const hid_t space = H5Aget_space(attribute);
    const bool read = space >= 0 && H5Sget_simple_extent_npoints(space) == 1 && H5Aread(attribute, memory, number) >= 0;
    if (space >= 0) H5Sclose(space);
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

bool hdf_read_extent(hid_t file, const char *path, size_t *rows, size_t *columns)
{
    const hid_t set = H5Dopen2(file, path, H5P_DEFAULT);
    if (set < 0) return false;
    const hid_t space = H5Dget_space(set);
    hsize_t extent[2];
    const bool plain = space >= 0 && H5Sget_simple_extent_ndims(space) == 2 && H5Sget_simple_extent_dims(space, extent, NULL) == 2;
    if (space >= 0) H5Sclose(space);
    H5Dclose(set);
    if (!plain) return false;
    *rows = extent[0];
    *columns = extent[1];
    return true;
}

bool hdf_read_array(hid_t file, const char *path, hid_t memory, void *data)
{
    const hid_t set = H5Dopen2(file, path, H5P_DEFAULT);
    if (set < 0) return false;
    const bool read = H5Dread(set, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0;
    return H5Dclose(set) >= 0 && read;
}

bool hdf_read_exactly(hid_t file, const char *path, hid_t memory, size_t count, void *data)
{
    const hid_t set = H5Dopen2(file, path, H5P_DEFAULT);
    if (set < 0) return false;
    const hid_t space = H5Dget_space(set);
    const bool fits = space >= 0 && H5Sget_simple_extent_npoints(space) == (hssize_t)count;
    const bool read = fits && H5Dread(set, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0;
    if (space >= 0) H5Sclose(space);
    return H5Dclose(set) >= 0 && read;
}
