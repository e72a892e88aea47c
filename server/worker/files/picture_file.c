/* The large picture is drawn with a depth for each pixel, in the colours of one palette: so many speeds by so many shades. The small
 * one is made of it by averaging. A picture takes some 10 ms. */
#include "picture_file.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "file_publish.h"
#include "job_folder.h"
#include "mirror.h"
#include "png_image.h"
#include "worker_log.h"

enum {
    LARGE = JOB_PICTURE_LARGE,
    SMALL = JOB_PICTURE_SMALL,
    SPEEDS = 16,
    SHADES = 15,
    OUTSIDE = 0, /* numbers of colours: transparent, */
    INSIDE,      /* where the container is empty, */
    WALL,
    FIRST_SHADE, /* and those of spheres */
};

#define MARGIN 1.03        /* beside the container, of its size */
#define AMBIENT 0.35       /* of the light, from everywhere */
#define WALL_PIXELS 1.5    /* half the thickness of a wall */
#define FASTEST_IN_RMS 2.5 /* this many times the root mean square has the last colour, however fast a few are */

typedef struct canvas {
    uint8_t pixel[LARGE * LARGE];
    float depth[LARGE * LARGE]; /* towards the eye, m */
    double scale;               /* pixels a metre */
    double left, top;           /* m: of the picture's corner */
} canvas;

typedef struct balls {
    size_t count;
    double *position, *velocity; /* (count,3) */
    double *radius;
    bool stands; /* what is seen from the side: z is up, and y leads away from the eye */
} balls;

static double across(const canvas *c, double u) { return (u - c->left) * c->scale; }
static double down(const canvas *c, double v) { return (c->top - v) * c->scale; }
static int first_pixel(double at) { return at < 0.0 ? 0 : (int)fmin(at, LARGE); }
static int end_pixel(double at) { return at < 0.0 ? 0 : (int)fmin(ceil(at) + 1.0, LARGE); }

/* A wall seen from its edge, from one point to another. half: pixels to either side. */
static void draw_wall(canvas *c, double u0, double v0, double u1, double v1, double half)
{
    const double x0 = across(c, u0), y0 = down(c, v0), dx = across(c, u1) - x0, dy = down(c, v1) - y0;
    const double length2 = fmax(dx * dx + dy * dy, 1e-12);
    const int end_x = end_pixel(fmax(x0, x0 + dx) + half), end_y = end_pixel(fmax(y0, y0 + dy) + half);
    for (int y = first_pixel(fmin(y0, y0 + dy) - half); y < end_y; y++)
        for (int x = first_pixel(fmin(x0, x0 + dx) - half); x < end_x; x++) {
            const double px = x + 0.5 - x0, py = y + 0.5 - y0, along = fmin(fmax((px * dx + py * dy) / length2, 0.0), 1.0);
            if (hypot(px - along * dx, py - along * dy) <= half) c->pixel[y * LARGE + x] = WALL;
        }
}

static void draw_drum(canvas *c, const dem_scene_definition *drum, double turned, double side)
{
    const double radius = 0.5 * drum->diameter * c->scale, middle = 0.5 * LARGE;
    for (int y = 0; y < LARGE; y++)
        for (int x = 0; x < LARGE; x++) {
            const double distance = hypot(x + 0.5 - middle, y + 0.5 - middle);
            if (distance < radius) c->pixel[y * LARGE + x] = INSIDE;
            else if (distance < radius + 2 * WALL_PIXELS) c->pixel[y * LARGE + x] = WALL;
        }
    for (size_t k = 0; k < drum->lifters.count; k++) {
        const double angle = turned + 8 * atan(1) * (double)k / (double)drum->lifters.count, lean = angle - drum->lifters.angle;
        const double foot = 0.5 * drum->diameter, u = foot * cos(angle), v = foot * sin(angle), height = drum->lifters.height;
        draw_wall(c, side * u, v, side * (u - height * cos(lean)), v - height * sin(lean), 0.5 * drum->lifters.width * c->scale);
    }
}

static void draw_sides(canvas *c, double half, double low, double high)
{
    for (int side = -1; side <= 1; side += 2) draw_wall(c, side * half, low, side * half, high, WALL_PIXELS);
}

static void draw_container(canvas *c, const dem_scene *scene, const dem_scene_definition *d, double side)
{
    const double half = 0.5 * d->diameter, edge = 0.5 * d->orifice.opening;
    const double rises_for = fmax(dem_scene_time(scene) - d->lift.start, 0.0), lifted = d->lift.speed * rises_for;
    const double top = d->orifice.half_angle > 0 ? (half - edge) / tan(d->orifice.half_angle) : 0.0;
    switch (d->container) {
    case DEM_DRUM: draw_drum(c, d, dem_scene_turned(scene), side); break;
    case DEM_CYLINDER:
        draw_wall(c, -half, 0, half, 0, WALL_PIXELS);
        draw_sides(c, half, 0, d->length);
        break;
    case DEM_TUBE_ON_PLATE:
        draw_wall(c, -0.5 * d->plate.diameter, 0, 0.5 * d->plate.diameter, 0, WALL_PIXELS);
        draw_sides(c, 0.5 * d->plate.diameter, 0, d->plate.rim_height);
        draw_sides(c, half, lifted, lifted + d->length);
        break;
    case DEM_VESSEL:
        draw_sides(c, half, top, d->length);
        for (int s = -1; s <= 1; s += 2) draw_wall(c, s * edge, 0, s * half, top, WALL_PIXELS);
        break;
    }
}

/* What is to be seen: a drum whole; of what stands its width, and as much of its height as the bed and as its width. */
static void aim(canvas *c, const dem_scene_definition *d, const balls *b)
{
    double width = d->diameter, low = -0.5 * width;
    if (b->stands) {
        const double wide = d->container == DEM_TUBE_ON_PLATE ? fmax(d->plate.diameter, d->diameter) : d->diameter;
        double high = wide;
        for (size_t i = 0; i < b->count; i++) high = fmax(high, b->position[3 * i + 2] + b->radius[i]);
        width = fmax(wide, fmin(high, d->length));
        low = -0.02 * width;
    }
    c->scale = LARGE / (MARGIN * width);
    c->left = -0.5 * MARGIN * width;
    c->top = b->stands ? low + MARGIN * width : -c->left;
}

static void draw_ball(canvas *c, double u, double v, double depth, double radius, uint8_t colour)
{
    static const double light[3] = { -0.33, 0.52, 0.79 }; /* from the left and above, of length 1 */
    const double x0 = across(c, u), y0 = down(c, v), r = radius * c->scale;
    if (!(x0 + r > 0 && y0 + r > 0 && x0 - r < LARGE && y0 - r < LARGE)) return; /* nor what is nowhere */
    const int end_x = end_pixel(x0 + r), end_y = end_pixel(y0 + r), begin_x = first_pixel(x0 - r);
    for (int y = first_pixel(y0 - r); y < end_y; y++)
        for (int x = begin_x; x < end_x; x++) {
            const double nx = (x + 0.5 - x0) / r, ny = (y0 - y - 0.5) / r, rest = 1.0 - nx * nx - ny * ny;
            const size_t at = (size_t)(y * LARGE + x);
            if (rest <= 0.0 || depth + radius <= (double)c->depth[at]) continue;
            const double nz = sqrt(rest), here = depth + radius * nz;
            if (here <= (double)c->depth[at]) continue;
            const double lit = fmax(nx * light[0] + ny * light[1] + nz * light[2], 0.0);
            c->depth[at] = (float)here;
            c->pixel[at] = (uint8_t)(colour + (int)(lit * (SHADES - 1) + 0.5));
        }
}

static void draw_balls(canvas *c, const balls *b, double least_fast)
{
    double sum = 0.0;
    for (size_t i = 0; i < 3 * b->count; i++) sum += b->velocity[i] * b->velocity[i];
    const double fast = fmax(FASTEST_IN_RMS * sqrt(sum / fmax((double)b->count, 1.0)), least_fast);
    for (size_t i = 0; i < b->count; i++) {
        const double *x = b->position + 3 * i, *w = b->velocity + 3 * i;
        const double share = fmin(sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]) / fast, 1.0);
        const uint8_t colour = (uint8_t)(FIRST_SHADE + SHADES * (int)(share * (SPEEDS - 1) + 0.5));
        draw_ball(c, x[0], b->stands ? x[2] : x[1], b->stands ? -x[1] : x[2], b->radius[i], colour);
    }
}

/* From dark blue over green to yellow: as it is read in grey, too. */
static void mix_palette(uint8_t palette[PNG_COLOURS][4])
{
    static const uint8_t stops[][3] = { { 70, 40, 120 }, { 59, 82, 139 }, { 33, 145, 140 }, { 94, 201, 98 }, { 253, 231, 37 } };
    static const uint8_t others[FIRST_SHADE][4] = { { 0, 0, 0, 0 }, { 128, 136, 148, 48 }, { 110, 118, 130, 255 } };
    enum { LAST = sizeof stops / sizeof stops[0] - 1 };
    memset(palette, 0, 4 * PNG_COLOURS);
    memcpy(palette, others, sizeof others);
    for (int speed = 0; speed < SPEEDS; speed++)
        for (int shade = 0; shade < SHADES; shade++) {
            const double place = LAST * (double)speed / (SPEEDS - 1);
            const int below = place < LAST ? (int)place : LAST - 1;
            const double light = AMBIENT + (1.0 - AMBIENT) * shade / (SHADES - 1);
            uint8_t *colour = palette[FIRST_SHADE + speed * SHADES + shade];
            for (int k = 0; k < 3; k++)
                colour[k] = (uint8_t)lround(light * (stops[below][k] + (place - below) * (stops[below + 1][k] - stops[below][k])));
            colour[3] = UINT8_MAX;
        }
}

/* small: (SMALL,SMALL,4). Each of its pixels is the mean of those that it stands for. */
static void shrink(const canvas *c, uint8_t palette[PNG_COLOURS][4], uint8_t *small)
{
    for (int y = 0; y < SMALL; y++)
        for (int x = 0; x < SMALL; x++, small += 4) {
            unsigned sum[4] = { 0 }, count = 0;
            for (int j = y * LARGE / SMALL; j < (y + 1) * LARGE / SMALL; j++)
                for (int i = x * LARGE / SMALL; i < (x + 1) * LARGE / SMALL; i++, count++) {
                    const uint8_t *colour = palette[c->pixel[j * LARGE + i]];
                    for (int k = 0; k < 3; k++) sum[k] += (unsigned)colour[k] * colour[3];
                    sum[3] += colour[3];
                }
            for (int k = 0; k < 3; k++) small[k] = (uint8_t)(sum[3] ? (sum[k] + sum[3] / 2) / sum[3] : 0);
            small[3] = (uint8_t)(sum[3] / count);
        }
}

static bool write_image(const char *name, const png_image *image)
{
    size_t length = 0;
    unsigned char *bytes = png_image_encode(image, &length);
    if (!bytes) worker_warn("can't write %s: out of memory", name);
    const bool written = bytes && file_write(name, (const char *)bytes, length);
    free(bytes);
    return written;
}

static bool write_both(const canvas *c, uint8_t *small)
{
    uint8_t palette[PNG_COLOURS][4];
    mix_palette(palette);
    shrink(c, palette, small);
    return write_image(JOB_PICTURE_FILE, &(png_image){ LARGE, LARGE, c->pixel, palette })
           && write_image(JOB_SMALL_PICTURE_FILE, &(png_image){ SMALL, SMALL, small, NULL });
}

static void draw(canvas *c, const dem_scene *scene, const dem_scene_definition *definition, bool is_mirrored, balls *b)
{
    dem_scene_particles(scene, &(dem_particle_arrays){ .position = b->position, .velocity = b->velocity, .radius = b->radius });
    if (is_mirrored) mirror_vectors(b->position, b->count);
    memset(c->pixel, OUTSIDE, sizeof c->pixel);
    for (size_t i = 0; i < LARGE * LARGE; i++) c->depth[i] = -INFINITY;
    aim(c, definition, b);
    draw_container(c, scene, definition, is_mirrored ? -1.0 : 1.0);
    /* A bed at rest is not painted by its last tremble. */
    const double least_fast = 0.1 * sqrt(definition->gravity * (b->count > 0 ? b->radius[0] : 0.0));
    draw_balls(c, b, fmax(least_fast, 1e-9));
}

bool picture_files_write(const dem_scene *scene, const dem_scene_definition *definition, bool is_mirrored)
{
    const size_t n = dem_scene_sphere_count(scene);
    balls b = { .count = n, .stands = definition->container != DEM_DRUM };
    canvas *c = malloc(sizeof *c);
    uint8_t *small = malloc((size_t)4 * SMALL * SMALL);
    b.position = malloc((3 * n + 1) * sizeof *b.position);
    b.velocity = malloc((3 * n + 1) * sizeof *b.velocity);
    b.radius = malloc((n + 1) * sizeof *b.radius);
    const bool has_memory = c && small && b.position && b.velocity && b.radius;
    if (has_memory) draw(c, scene, definition, is_mirrored, &b);
    else worker_warn("can't draw " JOB_PICTURE_FILE ": out of memory");
    const bool written = has_memory && write_both(c, small);
    free(b.position);
    free(b.velocity);
    free(b.radius);
    free(small);
    free(c);
    return written;
}
