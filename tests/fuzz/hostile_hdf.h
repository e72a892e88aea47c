/* HDF5 files of strangers. The library itself loses some memory over files that it refuses; what we open in them is closed. */
#ifndef HOSTILE_HDF_H
#define HOSTILE_HDF_H

#include "hdf_file.h"
#include "hostile_file.h"

const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void) { return "leak:libhdf5"; }

static inline void hostile_hdf_begin(void)
{
    hdf_init();
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
}

/* Files, groups, sets, attributes, types, extents and property lists. */
static inline int64_t hostile_hdf_open(void)
{
    static const H5I_type_t kinds[] = { H5I_FILE, H5I_GROUP, H5I_DATASET, H5I_ATTR, H5I_DATATYPE, H5I_DATASPACE, H5I_GENPROP_LST };
    int64_t all = 0;
    for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++) {
        hsize_t members = 0;
        H5Inmembers(kinds[k], &members);
        all += (int64_t)members;
    }
    return all;
}

#endif
