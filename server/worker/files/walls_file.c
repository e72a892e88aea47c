#include "walls_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "file_publish.h"
#include "job_folder.h"
#include "worker_log.h"

enum {
    SIDES = 96, /* of what is round: as many as do not show */
    CORNERS_OF_BAR = 8,
    SIDES_OF_BAR = 6,
    MOST_POINTS = 6 * SIDES + DEM_MAXIMUM_LIFTERS * CORNERS_OF_BAR,
    MOST_CORNERS = 3 * 4 * SIDES + 2 * SIDES + DEM_MAXIMUM_LIFTERS * 4 * SIDES_OF_BAR,
    MOST_POLYGONS = 3 * SIDES + 2 + DEM_MAXIMUM_LIFTERS * SIDES_OF_BAR
};

/* Polygons, whose corners are points by number. */
typedef struct surface {
    double point[MOST_POINTS][3]; /* m */
    int corner[MOST_CORNERS];
    int end[MOST_POLYGONS]; /* of its corners */
    int part[MOST_POLYGONS];
    int points, corners, polygons;
} surface;

static int add_point(surface *s, double x, double y, double z)
{
    double *point = s->point[s->points];
    point[0] = x;
    point[1] = y;
    point[2] = z;
    return s->points++;
}

static void add_corner(surface *s, int point) { s->corner[s->corners++] = point; }

static void end_polygon(surface *s, walls_part part)
{
    s->part[s->polygons] = (int)part;
    s->end[s->polygons++] = s->corners;
}

static void add_quad(surface *s, int a, int b, int c, int d, walls_part part)
{
    add_corner(s, a);
    add_corner(s, b);
    add_corner(s, c);
    add_corner(s, d);
    end_polygon(s, part);
}

/* The first of SIDES points about the axis, from the angle `turned` on. */
static int add_ring(surface *s, double radius, double z, double turned)
{
    const int first = s->points;
    for (int k = 0; k < SIDES; k++) {
        const double angle = turned + 8 * atan(1) * k / SIDES;
        add_point(s, radius * cos(angle), radius * sin(angle), z);
    }
    return first;
}

static void add_shell(surface *s, double radius, double low, double high, double turned, walls_part part)
{
    const int below = add_ring(s, radius, low, turned), above = add_ring(s, radius, high, turned);
    for (int k = 0; k < SIDES; k++) {
        const int next = (k + 1) % SIDES;
        add_quad(s, below + k, below + next, above + next, above + k, part);
    }
}

static void add_disc(surface *s, double radius, double z, double turned, walls_part part)
{
    const int ring = add_ring(s, radius, z, turned);
    for (int k = 0; k < SIDES; k++) add_corner(s, ring + k);
    end_polygon(s, part);
}

/* A bar along the drum, whose foot is at this angle. */
static void add_bar(surface *s, const dem_scene_definition *drum, double angle)
{
    static const int sides[SIDES_OF_BAR][4] = { { 0, 1, 3, 2 }, { 4, 5, 7, 6 }, { 0, 1, 5, 4 },
                                                { 2, 3, 7, 6 }, { 0, 2, 6, 4 }, { 1, 3, 7, 5 } };
    const int first = s->points;
    const double lean = drum->lifters.angle, half = 0.5 * drum->lifters.width, outer = 0.5 * drum->diameter;
    const double cosine = cos(angle - lean), sine = sin(angle - lean), aside = outer * sin(lean);
    for (int k = 0; k < CORNERS_OF_BAR; k++) {
        const double across = aside + (k & 1 ? half : -half), z = k & 4 ? 0.5 * drum->length : -0.5 * drum->length;
        const double out = k & 2 ? sqrt(fmax(outer * outer - across * across, 0.0)) : outer * cos(lean) - drum->lifters.height;
        add_point(s, out * cosine - across * sine, out * sine + across * cosine, z);
    }
    for (int k = 0; k < SIDES_OF_BAR; k++)
        add_quad(s, first + sides[k][0], first + sides[k][1], first + sides[k][2], first + sides[k][3], WALLS_LIFTER);
}

static void add_drum(surface *s, const dem_scene_definition *drum, double turned)
{
    const double radius = 0.5 * drum->diameter, half = 0.5 * drum->length;
    add_shell(s, radius, -half, half, turned, WALLS_SHELL);
    if (drum->ends.are_walls) {
        add_disc(s, radius, -half, turned, WALLS_END);
        add_disc(s, radius, half, turned, WALLS_END);
    }
    for (size_t k = 0; k < drum->lifters.count; k++)
        add_bar(s, drum, turned + 8 * atan(1) * (double)k / (double)drum->lifters.count);
}

static void add_tube_on_plate(surface *s, const dem_scene_definition *heap, double time)
{
    const double rises_for = fmax(time - heap->lift.start, 0.0), low = heap->lift.speed * rises_for;
    add_shell(s, 0.5 * heap->diameter, low, low + heap->length, 0.0, WALLS_SHELL);
    add_disc(s, 0.5 * heap->plate.diameter, 0.0, 0.0, WALLS_PLATE);
    if (heap->plate.rim_height > 0) add_shell(s, 0.5 * heap->plate.diameter, 0.0, heap->plate.rim_height, 0.0, WALLS_RIM);
}

static void add_box(surface *s, double half_width, double half_depth, double low, double high)
{
    int at[2][4];
    for (int k = 0; k < 8; k++) {
        const double x = k % 4 == 1 || k % 4 == 2 ? half_width : -half_width, y = k % 4 < 2 ? -half_depth : half_depth;
        at[k / 4][k % 4] = add_point(s, x, y, k < 4 ? low : high);
    }
    for (int k = 0; k < 4; k++) add_quad(s, at[0][k], at[0][(k + 1) % 4], at[1][(k + 1) % 4], at[1][k], WALLS_SHELL);
}

/* Its floor or hopper, from the orifice's edge to the side. */
static void add_vessel(surface *s, const dem_scene_definition *vessel)
{
    const dem_orifice *o = &vessel->orifice;
    const double wide = 0.5 * vessel->diameter, edge = 0.5 * o->opening, deep = 0.5 * o->depth;
    const double top = o->half_angle > 0 ? (wide - edge) / tan(o->half_angle) : 0.0;
    if (deep > 0) {
        add_box(s, wide, deep, top, vessel->length);
        for (int side = -1; side <= 1; side += 2)
            add_quad(s, add_point(s, side * edge, -deep, 0), add_point(s, side * wide, -deep, top),
                     add_point(s, side * wide, deep, top), add_point(s, side * edge, deep, 0), WALLS_END);
        return;
    }
    add_shell(s, wide, top, vessel->length, 0.0, WALLS_SHELL);
    const int below = add_ring(s, edge, 0.0, 0.0), above = add_ring(s, wide, top, 0.0);
    for (int k = 0; k < SIDES; k++) {
        const int next = (k + 1) % SIDES;
        add_quad(s, below + k, below + next, above + next, above + k, WALLS_END);
    }
}

static void add_walls(surface *s, const dem_scene *scene, const dem_scene_definition *definition)
{
    switch (definition->container) {
    case DEM_DRUM: add_drum(s, definition, dem_scene_turned(scene)); break;
    case DEM_CYLINDER:
        add_shell(s, 0.5 * definition->diameter, 0.0, definition->length, 0.0, WALLS_SHELL);
        add_disc(s, 0.5 * definition->diameter, 0.0, 0.0, WALLS_END);
        break;
    case DEM_TUBE_ON_PLATE: add_tube_on_plate(s, definition, dem_scene_time(scene)); break;
    case DEM_VESSEL: add_vessel(s, definition); break;
    }
}

static void print_array(FILE *stream, const char *name, const int *numbers, int count)
{
    fprintf(stream, "<DataArray type=\"Int32\" Name=\"%s\" format=\"ascii\">\n", name);
    for (int k = 0; k < count; k++) fprintf(stream, "%d%c", numbers[k], k % 16 == 15 ? '\n' : ' ');
    fputs("</DataArray>\n", stream);
}

static void print_field(FILE *stream, const char *name, double number)
{
    fprintf(stream, "<DataArray type=\"Float64\" Name=\"%s\" NumberOfTuples=\"1\" format=\"ascii\">%.17g</DataArray>\n", name,
            number);
}

static void print(FILE *stream, const surface *s, double time, double turned, bool is_mirrored)
{
    fputs("<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" "
          "byte_order=\"LittleEndian\">\n<PolyData>\n<FieldData>\n",
          stream);
    print_field(stream, "time", time);
    print_field(stream, "drum_angle", is_mirrored ? -turned : turned);
    fprintf(stream,
            "</FieldData>\n<Piece NumberOfPoints=\"%d\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" "
            "NumberOfPolys=\"%d\">\n"
            "<Points>\n<DataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\" format=\"ascii\">\n",
            s->points, s->polygons);
    for (int k = 0; k < s->points; k++)
        fprintf(stream, "%.9g %.9g %.9g\n", is_mirrored ? -s->point[k][0] : s->point[k][0], s->point[k][1], s->point[k][2]);
    fputs("</DataArray>\n</Points>\n<CellData>\n", stream);
    print_array(stream, "part", s->part, s->polygons);
    fputs("</CellData>\n<Polys>\n", stream);
    print_array(stream, "connectivity", s->corner, s->corners);
    print_array(stream, "offsets", s->end, s->polygons);
    fputs("</Polys>\n</Piece>\n</PolyData>\n</VTKFile>\n", stream);
}

bool walls_file_write(const dem_scene *scene, const dem_scene_definition *definition, bool is_mirrored)
{
    surface *s = calloc(1, sizeof *s);
    char *text = NULL;
    size_t length = 0;
    FILE *stream = s ? open_memstream(&text, &length) : NULL;
    if (stream) {
        add_walls(s, scene, definition);
        print(stream, s, dem_scene_time(scene), dem_scene_turned(scene), is_mirrored);
    }
    free(s);
    return file_write_stream(JOB_WALLS_FILE, stream, &text, &length);
}
