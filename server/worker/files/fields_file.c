/* Layout of a drum, n points a side at the cells' centres, x fastest:
 *   /fields  solid_fraction f4[n,n]   velocity f4[n,n,3]   granular_temperature f4[n,n]   samples f4[n,n]
 *            @frames, @size of a cell in m
 *   /VTKHDF  the same as an image of two equal layers, at both ends of the drum: readers of VTK 9.1 take none of one layer
 *            @Version int64[2] {1,0}   @Type "ImageData"   @WholeExtent int64[6] {0,n-1,0,n-1,0,1}
 *            @Origin f8[3]   @Spacing f8[3]   @Direction f8[9]
 *     PointData/... f4[2,n,n] and f4[2,n,n,3]
 *   /run @params_json
 * Of an outlet [rows,columns] in the place of [n,n], outward from the orifice's middle and upward from its plane, which the middles of
 * the first row are in: solid_fraction, and velocity, whose components are outward, upward, and none.
 * NaN where nothing was seen, or too little. */
#include "fields_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fields_text.h"
#include "hdf_file.h"
#include "job_folder.h"
#include "mirror.h"
#include "worker_log.h"

/* data: (rows, columns, components), with room for as much again behind it. */
static void add_field(hdf_file *file, const char *name, const field_grid *grid, double *data, size_t components, const char *unit)
{
    const size_t count = grid->rows * grid->columns * components;
    char path[64];
    hdf_image image = { path, 0, grid->rows, grid->columns, components, data, unit };
    memcpy(data + count, data, count * sizeof *data);
    snprintf(path, sizeof path, "/fields/%s", name);
    hdf_add_image(file, &image);
    snprintf(path, sizeof path, "/VTKHDF/PointData/%s", name);
    image.layers = 2;
    hdf_add_image(file, &image);
}

static void add_groups(hdf_file *file, const field_grid *grid, const char *params)
{
    static const double upright[9] = { 1, 0, 0, 0, 1, 0, 0, 0, 1 };
    const double origin[3] = { grid->corner[0], grid->corner[1], -0.5 * grid->thickness };
    const double spacing[3] = { grid->size, grid->size, grid->thickness };
    const int64_t version[2] = { 1, 0 }, extent[6] = { 0, (int64_t)grid->columns - 1, 0, (int64_t)grid->rows - 1, 0, 1 };
    hdf_add_group(file, "/VTKHDF");
    hdf_add_integers_attribute(file, "/VTKHDF", "Version", version, 2);
    hdf_add_text_attribute(file, "/VTKHDF", "Type", "ImageData", H5T_CSET_ASCII);
    hdf_add_integers_attribute(file, "/VTKHDF", "WholeExtent", extent, 6);
    hdf_add_reals_attribute(file, "/VTKHDF", "Origin", origin, 3);
    hdf_add_reals_attribute(file, "/VTKHDF", "Spacing", spacing, 3);
    hdf_add_reals_attribute(file, "/VTKHDF", "Direction", upright, 9);
    hdf_add_group(file, "/VTKHDF/PointData");
    hdf_add_group(file, "/fields");
    hdf_add_real_attribute(file, "/fields", "frames", grid->frames);
    hdf_add_real_attribute(file, "/fields", "size", grid->size);
    hdf_add_group(file, "/run");
    hdf_add_text_attribute(file, "/run", "params_json", params, H5T_CSET_UTF8);
}

/* x for -x: the columns of each row in reverse. */
static void mirror_field(double *data, size_t cells, size_t components)
{
    for (size_t y = 0; y < cells; y++)
        for (size_t x = 0; 2 * x + 1 < cells; x++)
            for (size_t c = 0; c < components; c++) {
                double *a = data + (y * cells + x) * components + c, *b = data + (y * cells + cells - 1 - x) * components + c;
                const double kept = *a;
                *a = *b;
                *b = kept;
            }
}

static void mirror_fields(const dem_field_arrays *fields, size_t cells)
{
    mirror_field(fields->solid_fraction, cells, 1);
    mirror_field(fields->temperature, cells, 1);
    mirror_field(fields->samples, cells, 1);
    mirror_field(fields->velocity, cells, 3);
    mirror_vectors(fields->velocity, cells * cells);
}

static double *room_for(size_t numbers)
{
    double *room = malloc(numbers * sizeof *room);
    if (!room) worker_warn("can't write " JOB_FIELDS_FILE ": out of memory");
    return room;
}

bool fields_file_write(const dem_scene *scene, bool is_mirrored, const double *sums, const dem_scene_definition *drum,
                       const char *params)
{
    const size_t cells = dem_fields_cells(scene), n = cells * cells;
    const double size = drum->diameter / (double)cells, corner = 0.5 * (size - drum->diameter);
    const field_grid grid = { cells, cells, size, { corner, corner }, drum->length, sums[0] };
    double *all = room_for(12 * n);
    if (!all) return false;
    const dem_field_arrays fields = {
        .solid_fraction = all, .temperature = all + 2 * n, .samples = all + 4 * n, .velocity = all + 6 * n
    };
    dem_fields_measure(scene, sums, &fields);
    if (is_mirrored) mirror_fields(&fields, cells);
    hdf_file file;
    hdf_create(&file, JOB_FIELDS_FILE);
    add_groups(&file, &grid, params);
    add_field(&file, "solid_fraction", &grid, fields.solid_fraction, 1, NULL);
    add_field(&file, "velocity", &grid, fields.velocity, 3, "m/s");
    add_field(&file, "granular_temperature", &grid, fields.temperature, 1, "m2/s2");
    add_field(&file, "samples", &grid, fields.samples, 1, NULL);
    const field_text texts[] = { { "solid_fraction", "", fields.solid_fraction, 1 },
                                 { "velocity", "m/s", fields.velocity, 3 },
                                 { "granular_temperature", "m2/s2", fields.temperature, 1 },
                                 { "samples", "", fields.samples, 1 } };
    const bool has_text = fields_text_write(&grid, texts, sizeof texts / sizeof texts[0]);
    free(all);
    return hdf_publish(&file) && has_text;
}

bool fields_file_write_outlet(const dem_scene *scene, const double *sums, const dem_orifice *orifice, const char *params)
{
    const dem_outlet_grid outlet = dem_outlet_grid_of(scene, sums);
    const size_t n = outlet.rows * outlet.columns;
    const double thickness = orifice->depth > 0 ? orifice->depth : outlet.size;
    const field_grid grid = { outlet.rows, outlet.columns, outlet.size, { 0.5 * outlet.size, 0 }, thickness, outlet.frames };
    double *solid = room_for(10 * n);
    if (!solid) return false;
    double *velocity = solid + 2 * n, *outward = velocity + 6 * n, *downward = outward + n;
    dem_outlet_fields(scene, sums, solid, outward, downward);
    for (size_t k = 0; k < n; k++) memcpy(velocity + 3 * k, (double[]){ outward[k], -downward[k], 0 }, 3 * sizeof *velocity);
    hdf_file file;
    hdf_create(&file, JOB_FIELDS_FILE);
    add_groups(&file, &grid, params);
    add_field(&file, "solid_fraction", &grid, solid, 1, NULL);
    add_field(&file, "velocity", &grid, velocity, 3, "m/s");
    const field_text texts[] = { { "solid_fraction", "", solid, 1 }, { "velocity", "m/s", velocity, 3 } };
    const bool has_text = fields_text_write(&grid, texts, sizeof texts / sizeof texts[0]);
    free(solid);
    return hdf_publish(&file) && has_text;
}
