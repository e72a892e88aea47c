/* Layout of tracers.hdf, m samples of n particles:
 *   /tracers  time f8[m]   particle i4[n]   position f4[m,n,3]   velocity f4[m,n,3]   angular_velocity f4[m,n,3]
 *   /run      @params_json
 * tracers.csv has the same, a line for each particle at each sample. NaN, in the table nothing, where the particle is not there: it has
 * not yet entered, or has left. */
#include "tracers_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "dem.h"
#include "file_publish.h"
#include "hdf_file.h"
#include "job_folder.h"
#include "worker_log.h"

static bool write_table(const int32_t *particle, size_t particles, const double *rows, size_t samples)
{
    char *text = NULL;
    size_t length = 0;
    FILE *stream = open_memstream(&text, &length);
    if (!stream) {
        worker_warn("can't write " JOB_TRACERS_TABLE ": out of memory");
        return false;
    }
    fprintf(stream, "time,particle,x,y,z,vx,vy,vz,wx,wy,wz\n");
    for (size_t k = 0; k < samples; k++) {
        const double *row = rows + k * (1 + DEM_TRACER_NUMBERS * particles);
        for (size_t p = 0; p < particles; p++) {
            fprintf(stream, "%.12g,%d", row[0], (int)particle[p]);
            for (size_t c = 0; c < DEM_TRACER_NUMBERS; c++) {
                const double number = row[1 + DEM_TRACER_NUMBERS * p + c];
                if (isnan(number)) fputc(',', stream);
                else fprintf(stream, ",%.9g", number);
            }
            fputc('\n', stream);
        }
    }
    return file_write_stream(JOB_TRACERS_TABLE, stream, &text, &length);
}

/* numbers: (samples, particles, 3), filled from the third of each particle's numbers that begins at `from`. */
static void add_vectors(hdf_file *file, const char *path, const double *rows, size_t samples, size_t particles, size_t from,
                        const char *unit, double *numbers)
{
    for (size_t k = 0; k < samples; k++)
        for (size_t p = 0; p < particles; p++)
            memcpy(numbers + 3 * (k * particles + p),
                   rows + k * (1 + DEM_TRACER_NUMBERS * particles) + 1 + DEM_TRACER_NUMBERS * p + from, 3 * sizeof *numbers);
    hdf_add_image(file, &(hdf_image){ path, samples, particles, 3, 1, numbers, unit });
}

static bool write_file(const int32_t *particle, size_t particles, const double *rows, size_t samples, const char *params)
{
    double *numbers = malloc((3 * samples * particles + 1) * sizeof *numbers);
    if (!numbers) {
        worker_warn("can't write " JOB_TRACERS_FILE ": out of memory");
        return false;
    }
    hdf_file file;
    hdf_create(&file, JOB_TRACERS_FILE);
    hdf_add_group(&file, "/tracers");
    for (size_t k = 0; k < samples; k++) numbers[k] = rows[k * (1 + DEM_TRACER_NUMBERS * particles)];
    hdf_add_array(&file, &(hdf_array){ "/tracers/time", H5T_NATIVE_DOUBLE, H5T_IEEE_F64LE, samples, 0, numbers, "s" }, HDF_PLAIN);
    hdf_add_array(&file, &(hdf_array){ "/tracers/particle", H5T_NATIVE_INT32, H5T_STD_I32LE, particles, 0, particle, NULL },
                  HDF_PLAIN);
    add_vectors(&file, "/tracers/position", rows, samples, particles, 0, "m", numbers);
    add_vectors(&file, "/tracers/velocity", rows, samples, particles, 3, "m/s", numbers);
    add_vectors(&file, "/tracers/angular_velocity", rows, samples, particles, 6, "rad/s", numbers);
    hdf_add_group(&file, "/run");
    hdf_add_text_attribute(&file, "/run", "params_json", params, H5T_CSET_UTF8);
    free(numbers);
    return hdf_publish(&file);
}

bool tracers_file_write(const int32_t *particle, size_t particles, const double *rows, size_t samples, const char *params)
{
    return write_table(particle, particles, rows, samples) && write_file(particle, particles, rows, samples, params);
}
