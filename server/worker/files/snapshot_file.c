/* Layout:
 *   /VTKHDF  @Version int64[2] {1,0}   @Type "UnstructuredGrid": 16 characters, ASCII, null-padded (ParaView 5.11
 *            refuses any other kind of string)
 *     NumberOfPoints NumberOfCells NumberOfConnectivityIds  int64[1] = N
 *     Points f4[N,3]  Connectivity i8[N] = 0..N-1  Offsets i8[N+1] = 0..N  Types u1[N] = 1 (vertex)
 *     PointData/...   CellData/   FieldData/{time[1], step[1], drum_angle[1]}
 *   /particles/position = hard link to Points    /run @params_json
 */
#include "snapshot_file.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "file_publish.h"
#include "hdf_file.h"
#include "job_folder.h"
#include "mirror.h"
#include "worker_log.h"

#define VERTEX 1 /* VTK_VERTEX */

static void add_reals(hdf_file *file, const char *path, const double *data, size_t rows, size_t columns, const char *unit)
{
    hdf_add_array(file, &(hdf_array){ path, H5T_NATIVE_DOUBLE, H5T_IEEE_F32LE, rows, columns, data, unit }, HDF_COMPRESSED);
}

static void add_integers(hdf_file *file, const char *path, const int32_t *data, size_t rows)
{
    hdf_add_array(file, &(hdf_array){ path, H5T_NATIVE_INT32, H5T_STD_I32LE, rows, 0, data, NULL }, HDF_COMPRESSED);
}

static void add_one(hdf_file *file, const char *path, int64_t number)
{
    hdf_add_array(file, &(hdf_array){ path, H5T_NATIVE_INT64, H5T_STD_I64LE, 1, 0, &number, NULL }, HDF_PLAIN);
}

/* Each sphere is a cell of one point. rising, vertices: room for n + 1 and n. */
static void add_cells(hdf_file *file, size_t n, int64_t *rising, uint8_t *vertices)
{
    for (size_t i = 0; i <= n; i++) rising[i] = (int64_t)i;
    memset(vertices, VERTEX, n);
    add_one(file, "/VTKHDF/NumberOfPoints", (int64_t)n);
    add_one(file, "/VTKHDF/NumberOfCells", (int64_t)n);
    add_one(file, "/VTKHDF/NumberOfConnectivityIds", (int64_t)n);
    hdf_add_array(file, &(hdf_array){ "/VTKHDF/Connectivity", H5T_NATIVE_INT64, H5T_STD_I64LE, n, 0, rising, NULL },
                  HDF_COMPRESSED);
    hdf_add_array(file, &(hdf_array){ "/VTKHDF/Offsets", H5T_NATIVE_INT64, H5T_STD_I64LE, n + 1, 0, rising, NULL }, HDF_COMPRESSED);
    hdf_add_array(file, &(hdf_array){ "/VTKHDF/Types", H5T_NATIVE_UINT8, H5T_STD_U8LE, n, 0, vertices, NULL }, HDF_COMPRESSED);
}

/* reals: room for 4 n, used for one field after the other, as is integers with n. */
static void add_spheres(hdf_file *file, const dem_scene *scene, bool is_mirrored, double *reals, int32_t *integers)
{
    const size_t n = dem_scene_sphere_count(scene);
    dem_scene_particles(scene, &(dem_particle_arrays){ .position = reals });
    if (is_mirrored) mirror_vectors(reals, n);
    add_reals(file, "/VTKHDF/Points", reals, n, 3, "m");
    dem_scene_particles(scene, &(dem_particle_arrays){ .radius = reals });
    add_reals(file, "/VTKHDF/PointData/radius", reals, n, 0, "m");
    dem_scene_particles(scene, &(dem_particle_arrays){ .angular_velocity = reals });
    if (is_mirrored) mirror_spins(reals, n);
    add_reals(file, "/VTKHDF/PointData/angular_velocity", reals, n, 3, "rad/s");
    dem_scene_particles(scene, &(dem_particle_arrays){ .velocity = reals });
    if (is_mirrored) mirror_vectors(reals, n);
    add_reals(file, "/VTKHDF/PointData/velocity", reals, n, 3, "m/s");
    for (size_t i = 0; i < n; i++)
        reals[i] = sqrt(reals[3 * i] * reals[3 * i] + reals[3 * i + 1] * reals[3 * i + 1] + reals[3 * i + 2] * reals[3 * i + 2]);
    add_reals(file, "/VTKHDF/PointData/speed", reals, n, 0, "m/s");

    for (size_t i = 0; i < n; i++) integers[i] = (int32_t)i;
    add_integers(file, "/VTKHDF/PointData/id", integers, n);
    dem_scene_particles(scene, &(dem_particle_arrays){ .species = integers });
    add_integers(file, "/VTKHDF/PointData/species", integers, n);
    dem_scene_particles(scene, &(dem_particle_arrays){ .contacts = integers });
    add_integers(file, "/VTKHDF/PointData/contacts", integers, n);
    dem_scene_particles(scene, &(dem_particle_arrays){ .cluster = integers });
    add_integers(file, "/VTKHDF/PointData/cluster", integers, n);
    /* A sphere by itself turns without anything depending on where it points to: it has none. */
    if (!dem_scene_has_clusters(scene)) return;
    dem_scene_particles(scene, &(dem_particle_arrays){ .orientation = reals });
    if (is_mirrored) mirror_turns(reals, n);
    add_reals(file, "/VTKHDF/PointData/orientation", reals, n, 4, NULL);
}

static void add_groups(hdf_file *file, const char *params)
{
    static const int64_t version[2] = { 1, 0 };
    hdf_add_group(file, "/VTKHDF");
    hdf_add_integers_attribute(file, "/VTKHDF", "Version", version, 2);
    hdf_add_text_attribute(file, "/VTKHDF", "Type", "UnstructuredGrid", H5T_CSET_ASCII);
    hdf_add_group(file, "/VTKHDF/PointData");
    hdf_add_group(file, "/VTKHDF/CellData");
    hdf_add_group(file, "/VTKHDF/FieldData");
    hdf_add_group(file, "/particles");
    hdf_add_group(file, "/run");
    hdf_add_text_attribute(file, "/run", "params_json", params, H5T_CSET_UTF8);
}

static bool write_file(const char *name, const dem_scene *scene, bool is_mirrored, const char *params, double *reals,
                       int64_t *rising, int32_t *integers, uint8_t *vertices)
{
    const double time = dem_scene_time(scene);
    hdf_file file;
    hdf_create(&file, name);
    add_groups(&file, params);
    add_cells(&file, dem_scene_sphere_count(scene), rising, vertices);
    add_spheres(&file, scene, is_mirrored, reals, integers);
    hdf_add_array(&file, &(hdf_array){ "/VTKHDF/FieldData/time", H5T_NATIVE_DOUBLE, H5T_IEEE_F64LE, 1, 0, &time, "s" }, HDF_PLAIN);
    const double turned = is_mirrored ? -dem_scene_turned(scene) : dem_scene_turned(scene);
    hdf_add_array(&file, &(hdf_array){ "/VTKHDF/FieldData/drum_angle", H5T_NATIVE_DOUBLE, H5T_IEEE_F64LE, 1, 0, &turned, "rad" },
                  HDF_PLAIN);
    add_one(&file, "/VTKHDF/FieldData/step", dem_scene_step_count(scene));
    hdf_add_hard_link(&file, "/VTKHDF/Points", "/particles/position");
    return hdf_publish(&file);
}

bool snapshot_folder_is_there(void)
{
    struct stat folder;
    if (lstat(JOB_SNAPSHOT_FOLDER, &folder) == 0 && S_ISDIR(folder.st_mode)) return true;
    worker_warn(JOB_SNAPSHOT_FOLDER " in the job folder is no folder any more: it is not used");
    return false;
}

bool snapshot_file_write(const dem_scene *scene, bool is_mirrored, int64_t number, const char *params, int64_t *bytes)
{
    char name[64];
    snprintf(name, sizeof name, JOB_SNAPSHOT_FOLDER "/" JOB_SNAPSHOT_FILE_FORMAT, (long long)number);
    const size_t n = dem_scene_sphere_count(scene);
    double *reals = malloc(4 * n * sizeof *reals);
    int64_t *rising = malloc((n + 1) * sizeof *rising);
    int32_t *integers = malloc(n * sizeof *integers);
    uint8_t *vertices = malloc(n);
    bool written = false;
    if (reals && rising && integers && vertices)
        written = write_file(name, scene, is_mirrored, params, reals, rising, integers, vertices);
    else worker_warn("can't write %s: out of memory", name);
    free(reals);
    free(rising);
    free(integers);
    free(vertices);
    struct stat status;
    const bool is_there = written && stat(name, &status) == 0;
    if (is_there) *bytes = status.st_size;
    else if (written) file_log_write_failure(name, strerror(errno)); /* somebody took it away, or its folder */
    return is_there;
}

bool snapshot_series_write(const schedule *plan, double time_step, int64_t count)
{
    char *text = NULL;
    size_t length = 0;
    FILE *stream = open_memstream(&text, &length);
    if (!stream) return file_write_stream(JOB_SERIES_FILE, NULL, &text, &length);
    fputs("{\"file-series-version\":\"1.0\",\"files\":[", stream);
    for (int64_t number = 0; number < count; number++)
        fprintf(stream, "%s\n{\"name\":\"" JOB_SNAPSHOT_FOLDER "/" JOB_SNAPSHOT_FILE_FORMAT "\",\"time\":%.9g}", number ? "," : "",
                (long long)number, (double)schedule_snapshot_step(plan, number) * time_step);
    fputs("\n]}\n", stream);
    return file_write_stream(JOB_SERIES_FILE, stream, &text, &length);
}
