#include "frame_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "file_publish.h"
#include "frame_format.h"
#include "job_folder.h"
#include "mirror.h"
#include "worker_log.h"

/* Arrays of count spheres. */
typedef struct spheres {
    size_t count;
    double *position; /* (count,3) m */
    double *speed, *spin, *radius;
    int32_t *species, *cluster, *contacts;
} spheres;

static void spheres_free(spheres *s)
{
    free(s->position);
    free(s->speed);
    free(s->spin);
    free(s->radius);
    free(s->species);
    free(s->cluster);
    free(s->contacts);
}

/* vectors: (count,3), whose lengths take their place at its beginning. */
static void lengths_of(double *vectors, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const double *v = vectors + 3 * i;
        vectors[i] = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    }
}

/* False: no memory. */
static bool spheres_take(spheres *s, const dem_scene *scene, bool is_mirrored)
{
    const size_t n = dem_scene_sphere_count(scene), room = n ? n : 1;
    *s = (spheres){ .count = n,
                    .position = malloc(3 * room * sizeof(double)),
                    .speed = malloc(3 * room * sizeof(double)),
                    .spin = malloc(3 * room * sizeof(double)),
                    .radius = malloc(room * sizeof(double)),
                    .species = malloc(room * sizeof(int32_t)),
                    .cluster = malloc(room * sizeof(int32_t)),
                    .contacts = malloc(room * sizeof(int32_t)) };
    if (!s->position || !s->speed || !s->spin || !s->radius || !s->species || !s->cluster || !s->contacts) return false;
    dem_scene_particles(scene, &(dem_particle_arrays){ .position = s->position,
                                                       .velocity = s->speed,
                                                       .angular_velocity = s->spin,
                                                       .radius = s->radius,
                                                       .species = s->species,
                                                       .cluster = s->cluster,
                                                       .contacts = s->contacts });
    if (is_mirrored) mirror_vectors(s->position, n);
    lengths_of(s->speed, n);
    lengths_of(s->spin, n);
    return true;
}

static double largest(const double *numbers, size_t count)
{
    double most = 0.0;
    for (size_t i = 0; i < count; i++)
        if (numbers[i] > most) most = numbers[i];
    return most;
}

static bool all_are(const int32_t *numbers, size_t count, int32_t number)
{
    for (size_t i = 0; i < count; i++)
        if (numbers[i] != number) return false;
    return true;
}

/* The box is that of the spheres' centres: nothing is outside, and no digit is spent on where nobody is. */
static frame_head head_of(const spheres *s, const dem_scene *scene, bool is_mirrored)
{
    const double turned = dem_scene_turned(scene), most = largest(s->radius, s->count);
    frame_head head = { .count = (uint32_t)s->count,
                        .time = dem_scene_time(scene),
                        .drum_angle = is_mirrored ? -turned : turned,
                        .speed = (float)largest(s->speed, s->count),
                        .radius = (float)most };
    for (size_t c = 0; c < 3 && s->count > 0; c++) {
        double low = s->position[c], high = low;
        for (size_t i = 1; i < s->count; i++) {
            low = fmin(low, s->position[3 * i + c]);
            high = fmax(high, s->position[3 * i + c]);
        }
        head.low[c] = (float)low;
        head.high[c] = (float)high;
    }
    bool one_size = true;
    for (size_t i = 0; i < s->count && one_size; i++) one_size = s->radius[i] == most;
    if (!all_are(s->species, s->count, s->count ? s->species[0] : 0)) head.flags |= FRAME_SPECIES;
    if (!one_size) head.flags |= FRAME_RADIUS;
    if (dem_scene_has_clusters(scene)) head.flags |= FRAME_CLUSTER;
    if (largest(s->spin, s->count) > 0.0) head.flags |= FRAME_SPIN;
    if (!all_are(s->contacts, s->count, 0)) head.flags |= FRAME_CONTACTS;
    return head;
}

/* Between 0 and most, the nearest whole number. */
static uint16_t share_of(double number, double whole, double most)
{
    return whole > 0.0 ? (uint16_t)lround(fmin(fmax(number / whole, 0.0), 1.0) * most) : 0;
}

static uint16_t place_between(double x, double low, double high)
{
    return (uint16_t)((int32_t)share_of(x - low, high - low, FRAME_MOST_STEPS) - FRAME_MOST_STEPS / 2);
}

static unsigned char *pad(const unsigned char *bytes, unsigned char *at)
{
    while ((at - bytes) % 4) *at++ = 0;
    return at;
}

static unsigned char *add_shares(const unsigned char *bytes, unsigned char *at, const double *numbers, size_t count, double whole)
{
    for (size_t i = 0; i < count; i++) *at++ = (unsigned char)share_of(numbers[i], whole, UINT8_MAX);
    return pad(bytes, at);
}

/* Of larger numbers: 255. */
static unsigned char *add_numbers(const unsigned char *bytes, unsigned char *at, const int32_t *numbers, size_t count)
{
    for (size_t i = 0; i < count; i++) *at++ = (unsigned char)(numbers[i] < UINT8_MAX ? numbers[i] : UINT8_MAX);
    return pad(bytes, at);
}

static void encode(const frame_head *head, const spheres *s, unsigned char *bytes)
{
    const size_t n = s->count;
    frame_head_write(head, bytes);
    unsigned char *at = bytes + FRAME_HEAD_BYTES;
    for (size_t i = 0; i < n; i++)
        for (size_t c = 0; c < 3; c++) at = frame_put_16(at, place_between(s->position[3 * i + c], head->low[c], head->high[c]));
    at = add_shares(bytes, pad(bytes, at), s->speed, n, head->speed);
    if (head->flags & FRAME_SPECIES) at = add_numbers(bytes, at, s->species, n);
    if (head->flags & FRAME_RADIUS) {
        for (size_t i = 0; i < n; i++) at = frame_put_16(at, share_of(s->radius[i], head->radius, UINT16_MAX));
        at = pad(bytes, at);
    }
    for (size_t i = 0; (head->flags & FRAME_CLUSTER) && i < n; i++) at = frame_put_32(at, (uint32_t)s->cluster[i]);
    if (head->flags & FRAME_SPIN) at = add_shares(bytes, at, s->spin, n, (double)head->speed / head->radius);
    if (head->flags & FRAME_CONTACTS) add_numbers(bytes, at, s->contacts, n);
}

bool frame_file_write(const dem_scene *scene, bool is_mirrored, int64_t number)
{
    char name[64];
    snprintf(name, sizeof name, JOB_SNAPSHOT_FOLDER "/" JOB_FRAME_FILE_FORMAT, (long long)number);
    spheres s;
    unsigned char *bytes = NULL;
    size_t length = 0;
    if (spheres_take(&s, scene, is_mirrored)) {
        const frame_head head = head_of(&s, scene, is_mirrored);
        length = frame_bytes(head.count, head.flags);
        bytes = malloc(length);
        if (bytes) encode(&head, &s, bytes);
    }
    spheres_free(&s);
    if (!bytes) worker_warn("can't write %s: out of memory", name);
    const bool written = bytes && file_write(name, (const char *)bytes, length);
    free(bytes);
    return written;
}
