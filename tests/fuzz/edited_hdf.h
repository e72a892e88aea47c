/* A file of HDF5 that a worker wrote, and in which a stranger has changed what it holds, by the library itself: values, types,
 * extents, ways of keeping them, attributes, links. How the library stores all that is its own affair: a file is read only
 * where its checksum fits, and by a worker that can reach nothing else. */
#ifndef EDITED_HDF_H
#define EDITED_HDF_H

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "checksum.h"
#include "file_seal.h"
#include "hostile_hdf.h"

enum { MOST_PATHS = 120, LONGEST_PATH_HERE = 80, MOST_EDITS = 16, MOST_VALUES = 1 << 17, MOST_RANK = 3 };

/* A file as it was written, and the links in it. */
typedef struct hdf_original {
    uint8_t *bytes;
    size_t size, path_count;
    char path[MOST_PATHS][LONGEST_PATH_HERE];
} hdf_original;

/* The stranger's bytes are such changes, one after the other. */
typedef struct hdf_edit {
    uint8_t what, path, other, type, extent, keeping, more, number;
    uint32_t place, run;
    uint64_t value;
} hdf_edit;

static herr_t note_path(hid_t file, const char *name, const H5L_info_t *link, void *context)
{
    hdf_original *o = context;
    (void)file;
    (void)link;
    CLAIM(o->path_count < MOST_PATHS && strlen(name) < LONGEST_PATH_HERE);
    strcpy(o->path[o->path_count++], name);
    return 0;
}

static inline void hdf_original_read(hdf_original *o, const char *name)
{
    FILE *file = fopen(name, "re");
    CLAIM(file && fseek(file, 0, SEEK_END) == 0 && ftell(file) > CHECKSUM_LINE);
    memset(o, 0, sizeof *o);
    o->size = (size_t)ftell(file) - CHECKSUM_LINE;
    rewind(file);
    CLAIM((o->bytes = malloc(o->size)) && fread(o->bytes, 1, o->size, file) == o->size);
    fclose(file);
    const hid_t opened = H5Fopen(name, H5F_ACC_RDONLY, H5P_DEFAULT);
    CLAIM(opened >= 0 && H5Lvisit(opened, H5_INDEX_NAME, H5_ITER_INC, note_path, o) >= 0 && o->path_count > 0);
    H5Fclose(opened);
}

/* ---- what numbers, types and extents there are ---- */

static inline double real_of(const hdf_edit *e)
{
    static const double reals[] = { 0, -0.0, 1, -1, NAN, INFINITY, -INFINITY, 1e308, -1e308, 5e-324, 1e-9, 1e9, 2147483648.0, 0.5 };
    double real;
    memcpy(&real, &e->value, sizeof real);
    return e->number < 128 ? reals[e->number % (sizeof reals / sizeof *reals)] : real;
}

static inline int64_t integer_of(const hdf_edit *e)
{
    static const int64_t integers[] = {
        0, 1, -1, 2, 3, 7, INT32_MAX, INT32_MIN, INT64_MAX, INT64_MIN, 1 << 16, 1LL << 32, 1LL << 60
    };
    return e->number < 128 ? integers[e->number % (sizeof integers / sizeof *integers)] : (int64_t)e->value;
}

static inline hid_t text_type(const hdf_edit *e, size_t size)
{
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, e->more % 8 == 7 ? H5T_VARIABLE : size);
    H5Tset_strpad(type, (H5T_str_t)(e->more % 3));
    return type;
}

/* `before`: the one that it had. */
static inline hid_t type_of(const hdf_edit *e, hid_t before)
{
    const hid_t plain[] = { before,       H5T_IEEE_F64LE, H5T_IEEE_F64BE, H5T_IEEE_F32LE,     H5T_STD_I64LE, H5T_STD_I32LE,
                            H5T_STD_I8LE, H5T_STD_U64LE,  H5T_STD_I16BE,  H5T_NATIVE_LDOUBLE, H5T_STD_B32LE, H5T_STD_REF_OBJ };
    const size_t kinds = sizeof plain / sizeof *plain;
    const hsize_t two = 2;
    if (e->type % 16 < kinds) return H5Tcopy(plain[e->type % 16]);
    switch (e->type % 16) {
    case 12: return text_type(e, 1 + e->value % 300);
    case 13: return H5Tarray_create2(before, 1, &two);
    case 14: return H5Tvlen_create(H5T_IEEE_F64LE);
    default: return H5Tcreate(H5T_OPAQUE, 1 + e->value % 300);
    }
}

/* One dimension more or less, longer or shorter: of the extent that it had. */
static inline hid_t space_of(const hdf_edit *e, hid_t before)
{
    hsize_t n[MOST_RANK] = { 1, 1, 1 };
    int rank = H5Sget_simple_extent_ndims(before);
    if (rank < 0 || rank > MOST_RANK || H5Sget_simple_extent_dims(before, n, NULL) < 0) return H5Screate(H5S_SCALAR);
    hsize_t *one = &n[e->more % MOST_RANK];
    switch (e->extent % 12) {
    case 0: break;
    case 1: *one += 1; break;
    case 2: *one -= *one > 0; break;
    case 3: *one = 0; break;
    case 4: *one = e->value % 1000; break;
    case 5: *one = (hsize_t)1 << e->value % 63; break;
    case 6: rank = rank < MOST_RANK ? rank + 1 : 1; break;
    case 7: rank = rank > 1 ? rank - 1 : MOST_RANK; break;
    case 8: n[0] *= n[1], n[1] = 1; break;
    case 9: n[1] *= n[0], n[0] = 1; break;
    case 10: return H5Screate(H5S_NULL);
    default: return H5Screate(H5S_SCALAR);
    }
    return rank > 0 ? H5Screate_simple(rank, n, NULL) : H5Screate(H5S_SCALAR);
}

static inline hid_t keeping_of(const hdf_edit *e, hid_t space)
{
    const hid_t kept = H5Pcreate(H5P_DATASET_CREATE);
    const hsize_t chunk[MOST_RANK] = { 1 + e->value % 5000, 1 + e->more % 4, 1 };
    const int rank = H5Sget_simple_extent_ndims(space), how = e->keeping % 12;
    if (how == 1) H5Pset_layout(kept, H5D_COMPACT);
    if (how == 2) H5Pset_external(kept, "/proc/self/maps", 0, H5F_UNLIMITED);
    if (how == 3) H5Pset_layout(kept, H5D_VIRTUAL);
    if (how >= 4 && rank > 0) H5Pset_chunk(kept, rank, chunk);
    if (how == 5) H5Pset_shuffle(kept);
    if (how == 5 || how == 6) H5Pset_deflate(kept, e->more % 10);
    if (how == 7) H5Pset_fletcher32(kept);
    if (how == 8) H5Pset_scaleoffset(kept, H5Z_SO_INT, 3);
    if (how == 9) H5Pset_nbit(kept);
    if (e->keeping >= 128) H5Pset_fill_value(kept, H5T_NATIVE_DOUBLE, (const double[]){ real_of(e) });
    return kept;
}

/* ---- the changes ---- */

/* The numbers of a dataset as its class has them in memory, eight bytes each; NULL: it has none, or too many. */
static inline uint64_t *numbers_of(hid_t set, hid_t *memory, size_t *count)
{
    const hid_t space = H5Dget_space(set), type = H5Dget_type(set);
    const hssize_t points = H5Sget_simple_extent_npoints(space);
    const H5T_class_t class = H5Tget_class(type);
    *memory = class == H5T_INTEGER ? H5T_NATIVE_INT64 : H5T_NATIVE_DOUBLE;
    *count = points > 0 ? (size_t)points : 0;
    uint64_t *numbers = NULL;
    if ((class == H5T_INTEGER || class == H5T_FLOAT) && *count > 0 && *count <= MOST_VALUES)
        numbers = calloc(*count, sizeof *numbers);
    if (numbers && H5Dread(set, *memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers) < 0) {
        free(numbers);
        numbers = NULL;
    }
    H5Tclose(type);
    H5Sclose(space);
    return numbers;
}

static inline void change_values(hid_t file, const char *path, const hdf_edit *e)
{
    const hid_t set = H5Dopen2(file, path, H5P_DEFAULT);
    hid_t memory;
    size_t count;
    uint64_t *numbers = set >= 0 ? numbers_of(set, &memory, &count) : NULL;
    if (numbers) {
        const double real = real_of(e);
        const int64_t integer = integer_of(e);
        const size_t first = e->place % count, run = e->more % 4 ? 1 : e->run % count + 1;
        for (size_t k = first; k < count && k < first + run; k++)
            memcpy(&numbers[k], memory == H5T_NATIVE_INT64 ? (const void *)&integer : (const void *)&real, sizeof *numbers);
        H5Dwrite(set, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers);
    }
    free(numbers);
    if (set >= 0) H5Dclose(set);
}

static inline void write_what_fits(hid_t set, hid_t memory, const uint64_t *numbers, size_t count)
{
    const hid_t space = H5Dget_space(set);
    const hssize_t points = H5Sget_simple_extent_npoints(space);
    uint64_t *all = points > 0 && points <= MOST_VALUES ? calloc((size_t)points, sizeof *all) : NULL;
    if (all) {
        memcpy(all, numbers, (count < (size_t)points ? count : (size_t)points) * sizeof *all);
        H5Dwrite(set, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, all);
    }
    free(all);
    H5Sclose(space);
}

/* The same numbers in a dataset of another type or extent, or that is kept otherwise. */
static inline void make_anew(hid_t file, const char *path, const hdf_edit *e)
{
    const hid_t set = H5Dopen2(file, path, H5P_DEFAULT);
    if (set < 0) return;
    hid_t memory;
    size_t count;
    uint64_t *numbers = numbers_of(set, &memory, &count);
    const hid_t space_before = H5Dget_space(set), type_before = H5Dget_type(set);
    const hid_t space = space_of(e, space_before), type = type_of(e, type_before), kept = keeping_of(e, space);
    H5Dclose(set);
    H5Ldelete(file, path, H5P_DEFAULT);
    const hid_t made = H5Dcreate2(file, path, type, space, H5P_DEFAULT, kept, H5P_DEFAULT);
    if (made >= 0 && numbers) write_what_fits(made, memory, numbers, count);
    if (made >= 0) H5Dclose(made);
    H5Pclose(kept);
    H5Tclose(type);
    H5Tclose(type_before);
    H5Sclose(space);
    H5Sclose(space_before);
    free(numbers);
}

/* A text with other letters from `place` on, or a number. */
static inline void write_attribute(hid_t attribute, hid_t type, const hdf_edit *e, const char *text, size_t size)
{
    if (H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0) {
        char *written = calloc(1, H5Tget_size(type) + 1);
        CLAIM(written);
        const size_t length = H5Tget_size(type), at = e->place % length, letters = 1 + e->run % sizeof e->value;
        memcpy(written, text, size < length ? size : length);
        memcpy(written + at, &e->value, letters < length - at ? letters : length - at);
        H5Awrite(attribute, type, written);
        free(written);
    } else if (H5Tget_class(type) == H5T_INTEGER) {
        H5Awrite(attribute, H5T_NATIVE_INT64, (const int64_t[]){ integer_of(e), 1, 2, 3 });
    } else if (H5Tget_class(type) == H5T_FLOAT) {
        H5Awrite(attribute, H5T_NATIVE_DOUBLE, (const double[]){ real_of(e), 1, 2, 3 });
    }
}

static inline void change_attribute_named(hid_t object, const char *name, const hdf_edit *e)
{
    const hid_t before = H5Aopen(object, name, H5P_DEFAULT);
    if (before < 0) return;
    const hid_t type_before = H5Aget_type(before), space_before = H5Aget_space(before);
    const size_t size =
        H5Tget_class(type_before) == H5T_STRING && H5Tis_variable_str(type_before) == 0 ? H5Tget_size(type_before) : 0;
    char *text = calloc(1, size + 1);
    CLAIM(text);
    if (size > 0) H5Aread(before, type_before, text);
    H5Aclose(before);
    H5Adelete(object, name);
    const bool resized = size > 0 && e->type % 16 == 12;
    const hid_t type = resized ? text_type(e, 1 + e->value % (size + 2)) : type_of(e, type_before),
                space = space_of(e, space_before);
    const hid_t made = e->keeping % 8 == 7 ? H5I_INVALID_HID : H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    if (made >= 0 && H5Sget_simple_extent_npoints(space) == 1) write_attribute(made, type, e, text, size);
    if (made >= 0) H5Aclose(made);
    H5Tclose(type);
    H5Tclose(type_before);
    H5Sclose(space);
    H5Sclose(space_before);
    free(text);
}

static inline void change_attribute(hid_t file, const char *path, const hdf_edit *e)
{
    char name[LONGEST_PATH_HERE];
    const hid_t object = H5Oopen(file, path, H5P_DEFAULT);
    if (object < 0) return;
    const int count = H5Aget_num_attrs(object);
    if (count > 0
        && H5Aget_name_by_idx(object, ".", H5_INDEX_NAME, H5_ITER_INC, e->other % (hsize_t)count, name, sizeof name, H5P_DEFAULT)
               > 0)
        change_attribute_named(object, name, e);
    H5Oclose(object);
}

/* Gone, or leading elsewhere. */
static inline void change_link(hid_t file, const char *path, const char *other, const hdf_edit *e)
{
    H5Ldelete(file, path, H5P_DEFAULT);
    switch (e->more % 6) {
    case 0: H5Lcreate_soft(other, file, path, H5P_DEFAULT, H5P_DEFAULT); break;
    case 1: H5Lcreate_external("run/checkpoint.hdf", other, file, path, H5P_DEFAULT, H5P_DEFAULT); break;
    case 2: H5Lcreate_hard(file, other, file, path, H5P_DEFAULT, H5P_DEFAULT); break;
    case 3: H5Lcreate_hard(file, "/", file, path, H5P_DEFAULT, H5P_DEFAULT); break;
    case 4: H5Gclose(H5Gcreate2(file, path, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT)); break;
    default: break;
    }
}

/* The original with these changes, of which HDF5 refuses some, and a checksum that fits. False: it can't write the file so. */
static inline bool hdf_edited(const char *name, const hdf_original *o, const uint8_t *bytes, size_t size)
{
    hdf_edit e;
    hostile_bytes(name, o->bytes, o->size);
    const hid_t file = H5Fopen(name, H5F_ACC_RDWR, H5P_DEFAULT);
    CLAIM(file >= 0);
    for (size_t k = 0; k < MOST_EDITS && (k + 1) * sizeof e <= size; k++) {
        memcpy(&e, bytes + k * sizeof e, sizeof e);
        const char *path = o->path[e.path % o->path_count], *other = o->path[e.other % o->path_count];
        switch (e.what % 8) {
        case 0:
        case 1:
        case 2: change_values(file, path, &e); break;
        case 3:
        case 4: make_anew(file, path, &e); break;
        case 5:
        case 6: change_attribute(file, path, &e); break;
        default: change_link(file, path, other, &e); break;
        }
    }
    if (H5Fclose(file) < 0) return false;
    CLAIM(file_seal(name));
    return true;
}

#endif
