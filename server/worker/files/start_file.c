#include "start_file.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "checkpoint_file.h"
#include "csv_table.h"
#include "dem_cluster.h"
#include "file_publish.h"
#include "hdf_file.h"
#include "hdf_read.h"
#include "job_folder.h"
#include "json_text.h"
#include "mirror.h"
#include "sha256.h"
#include "worker_log.h"

/* --- a file named in a spec --- */

static json_t *spec_of_file(const char *name, bool *is_checkpoint)
{
    file_state state;
    const hid_t file = hdf_open_sealed(name, &state);
    if (file < 0) return NULL;
    const bool ours = hdf_is_there(file, "run") && (hdf_is_there(file, "state") || hdf_is_there(file, "VTKHDF"));
    char *text = ours ? hdf_read_text_attribute(file, "/run", "params_json") : NULL;
    json_t *document = text ? json_loads(text, JSON_REJECT_DUPLICATES, NULL) : NULL;
    *is_checkpoint = ours && hdf_is_there(file, "state");
    free(text);
    H5Fclose(file);
    return document;
}

static json_t *find_file(void *context, const start_inputs *start, double *particles, problem_list *problems)
{
    (void)context;
    if (!*start->file) return NULL;
    bool is_checkpoint = false;
    const int readable = open(start->file, O_RDONLY | O_CLOEXEC | O_NONBLOCK), reason = errno;
    if (readable >= 0) close(readable);
    json_t *origin = readable >= 0 ? spec_of_file(start->file, &is_checkpoint) : NULL;
    problem_list none;
    job_spec made_by;
    if (!origin) {
        static const char strange[] = "is no snapshot or checkpoint of a run, is damaged, or was written by an earlier version";
        problem_list_add(problems, "/inputs/start/file", "is \"%.300s\", which %s", start->file,
                         readable >= 0 ? strange : strerror(reason));
        return NULL;
    }
    /* A bed that was itself placed particle by particle does not tell its number here: the spec must. */
    if (problem_list_init(&none) && job_spec_parse(NULL, origin, 0, &made_by, &none)) {
        *particles = (double)made_by.scene.particle_count;
        job_spec_clear(&made_by);
    }
    problem_list_clear(&none);
    json_object_set_new(origin, "is_checkpoint", json_boolean(is_checkpoint)); /* for start_compare */
    return origin;
}

/* --- tables named in a spec --- */

/* Beside the specification's own file. */
static void path_beside(const char *spec, const char *name, char *path, size_t size)
{
    const char *slash = *name == '/' || !spec ? NULL : strrchr(spec, '/');
    snprintf(path, size, "%.*s%s", slash ? (int)(slash + 1 - spec) : 0, slash ? spec : "", name);
}

static json_t *read_table(void *context, given_table kind, const char *name, const char *pointer, problem_list *problems)
{
    char path[PATH_MAX];
    size_t length = 0;
    if (kind == GIVEN_BED) {
        problem_list_add(problems, pointer, "is \"%.100s\", which is for the service; give file", name);
        return NULL;
    }
    path_beside(context, name, path, sizeof path);
    errno = 0;
    char *text = file_read(path, CSV_LONGEST, &length);
    if (!text) {
        problem_list_add(problems, pointer, "is \"%.100s\", which can't be read: %s", name,
                         errno ? strerror(errno) : "it is longer than 64 MB");
        return NULL;
    }
    problem_list of_file;
    json_t *table = NULL;
    if (problem_list_init(&of_file)) {
        table = (kind == GIVEN_SIEVES ? csv_read_sieves : csv_read_particles)(text, length, &of_file);
        csv_tell(&of_file, name, pointer, problems);
        problem_list_clear(&of_file);
    }
    free(text);
    return table;
}

start_source start_files(const char *spec)
{
    return (start_source){ .find = find_file, .table = read_table, .context = (void *)(uintptr_t)spec };
}

/* --- into the job folder --- */

static bool copy(int from, int to)
{
    char bytes[65536];
    for (;;) {
        const ssize_t got = read(from, bytes, sizeof bytes);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return got == 0;
        for (ssize_t done = 0; done < got;) {
            const ssize_t written = write(to, bytes + done, (size_t)(got - done));
            if (written < 0 && errno != EINTR) return false;
            if (written > 0) done += written;
        }
    }
}

/* Never changed once written, so that a second name for the same file is as good as a copy. */
bool start_file_bring(const char *path)
{
    if (access(JOB_START_FILE, F_OK) == 0 || link(path, JOB_START_FILE) == 0) return true;
    const int from = open(path, O_RDONLY | O_CLOEXEC),
              to = open(JOB_START_FILE ".tmp", O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    bool good = from >= 0 && to >= 0 && copy(from, to);
    if (from >= 0) close(from);
    if (to >= 0) good = close(to) == 0 && good;
    if (good) return file_publish(JOB_START_FILE);
    worker_warn("can't bring %s here as %s: %s", path, JOB_START_FILE, strerror(errno));
    return false;
}

/* --- into the scene --- */

typedef struct snapshot_arrays {
    float *position, *velocity, *spin, *orientation; /* (n,3), orientation (n,4) or NULL */
    float *radius;                                   /* (n) */
    int32_t *species, *cluster;                      /* (n) */
    size_t count;
    double turned; /* rad */
} snapshot_arrays;

static void *read_column(hid_t file, const char *path, hid_t memory, size_t size, size_t count, bool *good)
{
    void *data = *good ? calloc(count ? count : 1, size) : NULL;
    *good = *good && data && hdf_read_exactly(file, path, memory, count, data);
    return data;
}

static bool read_snapshot(hid_t file, snapshot_arrays *s)
{
    size_t columns;
    bool good = hdf_read_extent(file, "/VTKHDF/Points", &s->count, &columns) && columns == 3 && s->count < INT32_MAX;
    s->position = read_column(file, "/VTKHDF/Points", H5T_NATIVE_FLOAT, sizeof(float), 3 * s->count, &good);
    s->velocity = read_column(file, "/VTKHDF/PointData/velocity", H5T_NATIVE_FLOAT, sizeof(float), 3 * s->count, &good);
    s->spin = read_column(file, "/VTKHDF/PointData/angular_velocity", H5T_NATIVE_FLOAT, sizeof(float), 3 * s->count, &good);
    s->radius = read_column(file, "/VTKHDF/PointData/radius", H5T_NATIVE_FLOAT, sizeof(float), s->count, &good);
    s->species = read_column(file, "/VTKHDF/PointData/species", H5T_NATIVE_INT32, sizeof(int32_t), s->count, &good);
    s->cluster = read_column(file, "/VTKHDF/PointData/cluster", H5T_NATIVE_INT32, sizeof(int32_t), s->count, &good);
    if (good && hdf_is_there(file, "/VTKHDF/PointData/orientation"))
        s->orientation = read_column(file, "/VTKHDF/PointData/orientation", H5T_NATIVE_FLOAT, sizeof(float), 4 * s->count, &good);
    return good && hdf_read_exactly(file, "/VTKHDF/FieldData/drum_angle", H5T_NATIVE_DOUBLE, 1, &s->turned);
}

static void snapshot_clear(snapshot_arrays *s)
{
    free(s->position);
    free(s->velocity);
    free(s->spin);
    free(s->orientation);
    free(s->radius);
    free(s->species);
    free(s->cluster);
}

static void mirror_particle(dem_placed_particle *p)
{
    mirror_vectors(p->position, 1);
    mirror_vectors(p->velocity, 1);
    mirror_spins(p->angular_velocity, 1);
    mirror_turns(p->orientation, 1);
}

/* The particle that sphere i, the first of its own, is or is a part of: from the sphere's place, velocity and turn. */
static dem_placed_particle particle_of(const snapshot_arrays *s, size_t i, const dem_species *species, bool is_mirrored)
{
    dem_placed_particle p = { .orientation = { 1, 0, 0, 0 }, .species = s->species[i] };
    double r[3] = { 0 };
    for (int c = 0; c < 3; c++) {
        p.position[c] = (double)s->position[3 * i + (size_t)c];
        p.velocity[c] = (double)s->velocity[3 * i + (size_t)c];
        p.angular_velocity[c] = (double)s->spin[3 * i + (size_t)c];
    }
    for (int c = 0; c < 4 && species->cluster.sphere_count; c++)
        p.orientation[c] = s->orientation ? (double)s->orientation[4 * i + (size_t)c] : p.orientation[c];
    if (species->sizes.law) p.diameter = 2.0 * (double)s->radius[i];
    if (is_mirrored) mirror_particle(&p);
    if (species->cluster.sphere_count == 0) return p;
    dem_turn(p.orientation, species->cluster.sphere[0].position, r);
    const double *w = p.angular_velocity;
    for (int c = 0; c < 3; c++) {
        const int d = (c + 1) % 3, e = (c + 2) % 3;
        p.position[c] -= r[c];
        p.velocity[c] -= w[d] * r[e] - w[e] * r[d];
    }
    return p;
}

static dem_status place_snapshot(const snapshot_arrays *s, const job_spec *spec, dem_scene *scene)
{
    const dem_scene_definition *drum = &spec->scene;
    dem_placed_particle *particles = calloc(s->count ? s->count : 1, sizeof *particles);
    size_t count = 0;
    if (!particles) return DEM_NO_MEMORY;
    dem_status status = DEM_OK;
    for (size_t i = 0; i < s->count && status == DEM_OK; i++) {
        if (i > 0 && s->cluster[i] == s->cluster[i - 1]) continue; /* a cluster's spheres stand together */
        const bool known = s->species[i] >= 0 && (size_t)s->species[i] < drum->species_count;
        if (known) particles[count++] = particle_of(s, i, &drum->species[s->species[i]], spec->is_mirrored);
        else status = DEM_STATE_MISMATCH;
    }
    if (status == DEM_OK) status = dem_scene_place(scene, particles, count, spec->is_mirrored ? -s->turned : s->turned);
    free(particles);
    return status;
}

/* Whether the file is that which the daemon gave to this job, where one did; it has been another job's to write. */
static bool is_what_was_given(char *why_not, size_t size)
{
    size_t length = 0;
    errno = 0;
    char hex[SHA256_HEX_SIZE] = "", *given = file_read(JOB_START_HASH_FILE, SHA256_HEX_SIZE, &length);
    const int file = given ? open(JOB_START_FILE, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOFOLLOW) : -1;
    const bool good =
        given ? length == SHA256_HEX_SIZE && file >= 0 && sha256_of_file(file, hex) && strncmp(hex, given, SHA256_HEX_SIZE - 1) == 0
              : errno == ENOENT;
    if (!good)
        snprintf(why_not, size,
                 "the bed to start from, " JOB_START_FILE ", is not that which the job was given: its SHA-256 is %s, and was %.64s",
                 *hex ? hex : "not to be had", given ? given : "recorded in a file that can't be read");
    if (file >= 0) close(file);
    free(given);
    return good;
}

static dem_status start_from_file(const job_spec *spec, dem_scene *scene, char *why_not, size_t size)
{
    file_state found;
    if (!is_what_was_given(why_not, size)) return DEM_STATE_MISMATCH;
    const hid_t file = hdf_open_sealed(JOB_START_FILE, &found);
    dem_status status = DEM_STATE_MISMATCH;
    if (file < 0) {
        worker_warn("%s, from which the run is to start, is %s", JOB_START_FILE,
                    found == FILE_ABSENT ? "not there" : "damaged, can't be read, or was written by an earlier version");
        return status;
    }
    if (hdf_is_there(file, "state")) {
        dem_state state;
        if (checkpoint_read_state(file, &state)) status = dem_scene_continue(scene, &state);
        checkpoint_clear_state(&state);
    } else {
        snapshot_arrays snapshot = { .count = 0 };
        if (read_snapshot(file, &snapshot)) status = place_snapshot(&snapshot, spec, scene);
        snapshot_clear(&snapshot);
    }
    H5Fclose(file);
    if (status == DEM_STATE_MISMATCH) worker_warn("%s is not whole, or not a rotating bed of these particles", JOB_START_FILE);
    return status;
}

static dem_status start_from_list(const job_spec *spec, dem_scene *scene)
{
    const start_inputs *start = &spec->inputs.start;
    dem_placed_particle *particles = calloc(start->particle_count, sizeof *particles);
    if (!particles) return DEM_NO_MEMORY;
    for (size_t p = 0; p < start->particle_count; p++) {
        const start_particle *from = &start->particles[p];
        particles[p] = (dem_placed_particle){ .orientation = { 1, 0, 0, 0 }, .species = (int32_t)from->species };
        if (!isnan(from->diameter)) particles[p].diameter = from->diameter;
        memcpy(particles[p].position, from->position, sizeof from->position);
        memcpy(particles[p].velocity, from->velocity, sizeof from->velocity);
        memcpy(particles[p].angular_velocity, from->angular_velocity, sizeof from->angular_velocity);
        if (!isnan(from->orientation[0])) memcpy(particles[p].orientation, from->orientation, sizeof from->orientation);
        if (spec->is_mirrored) mirror_particle(&particles[p]);
    }
    const dem_status status = dem_scene_place(scene, particles, start->particle_count, 0.0);
    free(particles);
    return status;
}

dem_status start_scene(const job_spec *spec, dem_scene *scene, char *why_not, size_t size)
{
    *why_not = '\0';
    return spec->inputs.start.particle_count ? start_from_list(spec, scene) : start_from_file(spec, scene, why_not, size);
}
