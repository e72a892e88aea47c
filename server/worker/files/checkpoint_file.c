/* Layout:
 *   /run      @format, @params_json, @next_sample, @next_snapshot, @wall_seconds, @time_step, @stiffness, @program;
 *             @settled_by where another job settled the bed
 *   /frames   f8[next_sample, frame_width]
 *   /state/0, 1, ...  the state's arrays in order  [rows, columns]   @name, @element
 * This file does not know what the arrays of the state mean. */
#include "checkpoint_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hdf_file.h"
#include "hdf_read.h"
#include "job_folder.h"
#include "worker_log.h"

enum { FORMAT = 1, LONGEST_PATH = 128 };

static hid_t memory_type(dem_element element)
{
    return element == DEM_FLOAT64 ? H5T_NATIVE_DOUBLE : element == DEM_INT64 ? H5T_NATIVE_INT64 : H5T_NATIVE_INT32;
}

static size_t element_size(dem_element element) { return element == DEM_INT32 ? 4 : 8; }

static void add_number(hdf_file *file, const char *path, const char *name, int64_t number)
{
    hdf_add_integers_attribute(file, path, name, &number, 1);
}

static void add_state(hdf_file *file, const dem_state *state)
{
    hdf_add_group(file, "/state");
    add_number(file, "/state", "arrays", (int64_t)state->array_count);
    for (size_t a = 0; a < state->array_count; a++) {
        const dem_state_array *array = &state->array[a];
        const hid_t type = memory_type(array->element);
        char path[LONGEST_PATH];
        snprintf(path, sizeof path, "/state/%zu", a);
        hdf_add_array(file, &(hdf_array){ path, type, type, array->rows, array->columns, array->data, "SI, by column" }, HDF_PLAIN);
        hdf_add_text_attribute(file, path, "name", array->name, H5T_CSET_ASCII);
        add_number(file, path, "element", array->element);
    }
}

checkpoint_names checkpoint_names_of(size_t bed)
{
    checkpoint_names names = { JOB_CHECKPOINT_FILE, JOB_EARLIER_CHECKPOINT_FILE };
    if (bed == 0) return names;
    snprintf(names.newest, sizeof names.newest, JOB_BEDS_FOLDER "/%03zu.hdf", bed);
    snprintf(names.before, sizeof names.before, JOB_BEDS_FOLDER "/%03zu.before.hdf", bed);
    return names;
}

bool checkpoint_write(const checkpoint *saved, const checkpoint_names *names, const char *params)
{
    hdf_file file;
    hdf_create(&file, names->newest);
    file.before = names->before;
    hdf_add_group(&file, "/run");
    add_number(&file, "/run", "format", FORMAT);
    hdf_add_text_attribute(&file, "/run", "params_json", params, H5T_CSET_UTF8);
    add_number(&file, "/run", "next_sample", saved->next_sample);
    add_number(&file, "/run", "next_snapshot", saved->next_snapshot);
    hdf_add_real_attribute(&file, "/run", "wall_seconds", saved->wall_seconds);
    hdf_add_real_attribute(&file, "/run", "time_step", saved->time_step);
    hdf_add_real_attribute(&file, "/run", "stiffness", saved->stiffness);
    if (*saved->program) hdf_add_text_attribute(&file, "/run", "program", saved->program, H5T_CSET_UTF8);
    if (*saved->settled_by) hdf_add_text_attribute(&file, "/run", "settled_by", saved->settled_by, H5T_CSET_ASCII);
    hdf_add_array(&file,
                  &(hdf_array){ "/frames", H5T_NATIVE_DOUBLE, H5T_IEEE_F64LE, (size_t)saved->next_sample, saved->frame_width,
                                saved->frames, "SI, by column" },
                  HDF_PLAIN);
    add_state(&file, &saved->state);
    return hdf_publish(&file);
}

static bool read_state_array(hid_t file, size_t place, dem_state_array *array)
{
    char path[LONGEST_PATH];
    snprintf(path, sizeof path, "/state/%zu", place);
    int64_t element;
    if (!hdf_read_integer_attribute(file, path, "element", &element) || element < DEM_FLOAT64 || element > DEM_INT32
        || !hdf_read_extent(file, path, &array->rows, &array->columns))
        return false;
    array->element = (dem_element)element;
    array->name = hdf_read_text_attribute(file, path, "name");
    const size_t count = array->rows * array->columns;
    array->data = calloc(count ? count : 1, element_size(array->element));
    return array->name && array->data && hdf_read_exactly(file, path, memory_type(array->element), count, array->data);
}

bool checkpoint_read_state(hid_t file, dem_state *state)
{
    int64_t count;
    memset(state, 0, sizeof *state);
    if (!hdf_read_integer_attribute(file, "/state", "arrays", &count) || count < 0 || count > DEM_STATE_ARRAYS) return false;
    for (int64_t a = 0; a < count; a++) {
        state->array_count = (size_t)a + 1; /* counted before it is whole, so that clearing frees what there is */
        if (!read_state_array(file, (size_t)a, &state->array[a])) return false;
    }
    return true;
}

static bool read_frames(hid_t file, checkpoint *saved)
{
    size_t rows;
    if (!hdf_read_extent(file, "/frames", &rows, &saved->frame_width)) return false;
    if (saved->next_sample < 0 || rows != (size_t)saved->next_sample) return false;
    const size_t count = rows * saved->frame_width;
    saved->frames = calloc(count ? count : 1, sizeof *saved->frames);
    return saved->frames && hdf_read_exactly(file, "/frames", H5T_NATIVE_DOUBLE, count, saved->frames);
}

static bool has_format(hid_t file)
{
    int64_t format;
    return hdf_read_integer_attribute(file, "/run", "format", &format) && format == FORMAT;
}

static bool is_of(hid_t file, const char *params)
{
    if (!has_format(file)) return false;
    char *written = hdf_read_text_attribute(file, "/run", "params_json");
    const bool same = written && strcmp(written, params) == 0;
    free(written);
    return same;
}

/* "" where there is none. */
static void read_text(hid_t file, const char *name, char *text, size_t size)
{
    char *found = hdf_read_text_attribute(file, "/run", name);
    snprintf(text, size, "%s", found ? found : "");
    free(found);
}

static bool read_run(hid_t file, checkpoint *saved)
{
    read_text(file, "program", saved->program, sizeof saved->program);
    read_text(file, "settled_by", saved->settled_by, sizeof saved->settled_by);
    return hdf_read_integer_attribute(file, "/run", "next_sample", &saved->next_sample)
           && hdf_read_integer_attribute(file, "/run", "next_snapshot", &saved->next_snapshot)
           && hdf_read_real_attribute(file, "/run", "wall_seconds", &saved->wall_seconds)
           && hdf_read_real_attribute(file, "/run", "time_step", &saved->time_step)
           && hdf_read_real_attribute(file, "/run", "stiffness", &saved->stiffness);
}

file_state checkpoint_read(checkpoint *saved, const char *name, const char *params)
{
    file_state state;
    memset(saved, 0, sizeof *saved);
    const hid_t file = hdf_open_sealed(name, &state);
    if (file >= 0) {
        if (!params && has_format(file)) saved->params = hdf_read_text_attribute(file, "/run", "params_json");
        const bool read = (params ? is_of(file, params) : saved->params != NULL) && read_run(file, saved)
                          && read_frames(file, saved) && checkpoint_read_state(file, &saved->state);
        if (!read) state = FILE_DAMAGED;
        H5Fclose(file);
    }
    if (state == FILE_DAMAGED) worker_warn("%s is damaged or of another run, and is not used", name);
    if (state != FILE_WHOLE) checkpoint_clear(saved);
    return state;
}

bool checkpoint_is_of(const char *params)
{
    static const char *const names[] = { JOB_CHECKPOINT_FILE, JOB_EARLIER_CHECKPOINT_FILE };
    bool same = false;
    for (size_t k = 0; k < 2 && !same; k++) {
        file_state state;
        const hid_t file = hdf_open_sealed(names[k], &state);
        if (file < 0) continue;
        same = is_of(file, params);
        H5Fclose(file);
    }
    return same;
}

void checkpoint_clear_state(dem_state *state)
{
    for (size_t a = 0; a < state->array_count; a++) {
        free((char *)state->array[a].name);
        free(state->array[a].data);
    }
    memset(state, 0, sizeof *state);
}

void checkpoint_clear(checkpoint *saved)
{
    checkpoint_clear_state(&saved->state);
    free(saved->frames);
    free(saved->params);
    memset(saved, 0, sizeof *saved);
}
