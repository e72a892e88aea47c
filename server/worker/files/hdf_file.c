#include "hdf_file.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "file_publish.h"
#include "file_seal.h"
#include "worker_log.h"
#include "worker_memory.h"

enum { ROWS_OF_A_CHUNK = 16384, GZIP_LEVEL = 4 };

/* Without memory the first failed call is the last: what comes after may crash, and what could not be read for want of it is
 * not damaged. */
static herr_t log_error_stack(hid_t stack, void *unused)
{
    (void)unused;
    if (errno == ENOMEM) worker_memory_end();
    return H5Eprint2(stack, stderr);
}

void hdf_init(void) { H5Eset_auto2(H5E_DEFAULT, log_error_stack, NULL); }

static bool is_good(hdf_file *file, hid_t id)
{
    if (id < 0) file->failed = true;
    return !file->failed;
}

/* The times of creation that HDF5 would keep make equal content unequal bytes. */
static hid_t properties_without_times(hid_t class)
{
    const hid_t properties = H5Pcreate(class);
    if (properties >= 0 && H5Pset_obj_track_times(properties, false) < 0) {
        H5Pclose(properties);
        return H5I_INVALID_HID;
    }
    return properties;
}

void hdf_create(hdf_file *file, const char *name)
{
    char temporary[PATH_MAX];
    snprintf(temporary, sizeof temporary, "%s.tmp", name);
    errno = 0; /* from here on a want of memory is that of HDF5 */
    *file = (hdf_file){ .file = H5I_INVALID_HID, .name = name };
    const hid_t properties = properties_without_times(H5P_FILE_CREATE);
    if (!is_good(file, properties)) return;
    unlink(temporary); /* made anew, and not through a symbolic link */
    file->file = H5Fcreate(temporary, H5F_ACC_EXCL, properties, H5P_DEFAULT);
    is_good(file, file->file);
    H5Pclose(properties);
}

void hdf_add_group(hdf_file *file, const char *path)
{
    if (file->failed) return;
    const hid_t properties = properties_without_times(H5P_GROUP_CREATE);
    if (!is_good(file, properties)) return;
    const hid_t group = H5Gcreate2(file->file, path, H5P_DEFAULT, properties, H5P_DEFAULT);
    if (is_good(file, group)) is_good(file, H5Gclose(group));
    H5Pclose(properties);
}

static hid_t array_properties(const hdf_array *array, hdf_packing packing)
{
    const hid_t properties = properties_without_times(H5P_DATASET_CREATE);
    if (properties < 0 || packing == HDF_PLAIN || array->rows == 0) return properties;
    const hsize_t chunk[2] = { array->rows < ROWS_OF_A_CHUNK ? array->rows : ROWS_OF_A_CHUNK, array->columns };
    if (H5Pset_chunk(properties, array->columns ? 2 : 1, chunk) < 0 || H5Pset_shuffle(properties) < 0
        || H5Pset_deflate(properties, GZIP_LEVEL) < 0) {
        H5Pclose(properties);
        return H5I_INVALID_HID;
    }
    return properties;
}

static void add_set(hdf_file *file, const hdf_array *array, const hsize_t *extent, int rank, hdf_packing packing)
{
    if (file->failed) return;
    const hid_t space = H5Screate_simple(rank, extent, NULL);
    const hid_t properties = array_properties(array, packing);
    if (is_good(file, space) && is_good(file, properties)) {
        const hid_t set = H5Dcreate2(file->file, array->path, array->stored, space, H5P_DEFAULT, properties, H5P_DEFAULT);
        if (is_good(file, set)) {
            if (array->rows) is_good(file, H5Dwrite(set, array->memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, array->data));
            is_good(file, H5Dclose(set));
        }
    }
    if (properties >= 0) H5Pclose(properties);
    if (space >= 0) H5Sclose(space);
    hdf_add_text_attribute(file, array->path, "units", array->unit ? array->unit : "1", H5T_CSET_ASCII);
}

void hdf_add_array(hdf_file *file, const hdf_array *array, hdf_packing packing)
{
    add_set(file, array, (const hsize_t[]){ array->rows, array->columns }, array->columns ? 2 : 1, packing);
}

void hdf_add_image(hdf_file *file, const hdf_image *i)
{
    const hdf_array array = { i->path, H5T_NATIVE_DOUBLE, H5T_IEEE_F32LE, i->rows, i->columns, i->data, i->unit };
    const hsize_t extent[4] = { i->layers, i->rows, i->columns, i->components };
    const int skipped = i->layers > 0 ? 0 : 1;
    add_set(file, &array, extent + skipped, (i->components > 1 ? 4 : 3) - skipped, HDF_PLAIN);
}

void hdf_add_hard_link(hdf_file *file, const char *target, const char *path)
{
    if (file->failed) return;
    is_good(file, H5Lcreate_hard(file->file, target, file->file, path, H5P_DEFAULT, H5P_DEFAULT));
}

static void add_attribute(hdf_file *file, const char *path, const char *name, hid_t type, hid_t space, const void *data)
{
    if (!is_good(file, space) || !is_good(file, type)) return;
    const hid_t attribute = H5Acreate_by_name(file->file, path, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    if (!is_good(file, attribute)) return;
    is_good(file, H5Awrite(attribute, type, data));
    is_good(file, H5Aclose(attribute));
}

void hdf_add_text_attribute(hdf_file *file, const char *path, const char *name, const char *text, H5T_cset_t charset)
{
    if (file->failed) return;
    const hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
    if (is_good(file, type) && is_good(file, space)) {
        is_good(file, H5Tset_size(type, strlen(text) ? strlen(text) : 1));
        is_good(file, H5Tset_strpad(type, H5T_STR_NULLPAD));
        is_good(file, H5Tset_cset(type, charset));
        add_attribute(file, path, name, type, space, text);
    }
    if (type >= 0) H5Tclose(type);
    if (space >= 0) H5Sclose(space);
}

void hdf_add_integers_attribute(hdf_file *file, const char *path, const char *name, const int64_t *numbers, size_t count)
{
    if (file->failed) return;
    const hsize_t extent = count;
    const hid_t space = H5Screate_simple(1, &extent, NULL);
    add_attribute(file, path, name, H5T_NATIVE_INT64, space, numbers);
    if (space >= 0) H5Sclose(space);
}

void hdf_add_reals_attribute(hdf_file *file, const char *path, const char *name, const double *numbers, size_t count)
{
    if (file->failed) return;
    const hsize_t extent = count;
    const hid_t space = H5Screate_simple(1, &extent, NULL);
    add_attribute(file, path, name, H5T_NATIVE_DOUBLE, space, numbers);
    if (space >= 0) H5Sclose(space);
}

void hdf_add_real_attribute(hdf_file *file, const char *path, const char *name, double number)
{
    if (file->failed) return;
    const hid_t space = H5Screate(H5S_SCALAR);
    add_attribute(file, path, name, H5T_NATIVE_DOUBLE, space, &number);
    if (space >= 0) H5Sclose(space);
}

bool hdf_publish(hdf_file *file)
{
    /* On a full disk this is where the failure shows: the file's content is written now. */
    if (file->file >= 0 && H5Fclose(file->file) < 0) file->failed = true;
    file->file = H5I_INVALID_HID;
    char temporary[PATH_MAX];
    snprintf(temporary, sizeof temporary, "%s.tmp", file->name);
    if (!file->failed && file_seal(temporary)) return file_publish_keeping(file->name, file->before);
    unlink(temporary);
    if (file->failed) file_log_write_failure(file->name, "HDF5 reports the errors above");
    return false;
}
