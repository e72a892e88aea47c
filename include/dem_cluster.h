/* Clusters: spheres joined for good. Their shapes by name, whether spheres make one body, and the body's volume, centre
 * and principal moments. Inline, because the daemon, which counts particles of a fill, does not link the core.
 *
 * Volume and moments are those of the union: the exact sums over the spheres, less what is in several of them. That
 * excess is integrated over columns along z, exactly within each column; it is nothing where spheres only touch. */
#ifndef DEM_CLUSTER_H
#define DEM_CLUSTER_H

#include "dem_rules.h"

typedef enum dem_shape { DEM_SPHERE, DEM_DUMBBELL, DEM_TETRAHEDRON, DEM_CUBE, DEM_NAMED_SHAPES } dem_shape;

/* The touching spheres of a named shape: none for a sphere, which is no cluster. */
static inline void dem_cluster_of_shape(dem_cluster *cluster, dem_shape shape, double diameter)
{
    static const int sphere_count[DEM_NAMED_SHAPES] = { 0, 2, 4, 8 };
    static const double corner[8][3] = { { 1, 1, 1 },    { 1, -1, -1 }, { -1, 1, -1 }, { -1, -1, 1 },
                                         { -1, -1, -1 }, { -1, 1, 1 },  { 1, -1, 1 },  { 1, 1, -1 } };
    /* Every second corner of a cube makes a tetrahedron, whose edges are the diagonals of the cube's faces. */
    const double a = shape == DEM_TETRAHEDRON ? 0.5 * diameter / sqrt(2.0) : 0.5 * diameter;
    *cluster = (dem_cluster){ .sphere_count = (size_t)sphere_count[shape] };
    for (size_t k = 0; k < cluster->sphere_count; k++) {
        dem_cluster_sphere *s = &cluster->sphere[k];
        s->diameter = diameter;
        for (int c = 0; c < 3; c++) s->position[c] = a * corner[k][c];
        if (shape == DEM_DUMBBELL) {
            s->position[0] = k ? -a : a;
            s->position[1] = s->position[2] = 0.0;
        }
    }
}

/* r turned by w, x, y, z of a quaternion of any length but 0: r + 2 w (u x r) + 2 u x (u x r), u its vector part. */
static inline void dem_turn(const double wxyz[4], const double r[3], double turned[3])
{
    double q[4] = { 1, 0, 0, 0 }, t[3];
    const double size = sqrt(wxyz[0] * wxyz[0] + wxyz[1] * wxyz[1] + wxyz[2] * wxyz[2] + wxyz[3] * wxyz[3]);
    for (int c = 0; c < 4 && size > 0; c++) q[c] = wxyz[c] / size;
    for (int c = 0; c < 3; c++) t[c] = 2 * (q[1 + (c + 1) % 3] * r[(c + 2) % 3] - q[1 + (c + 2) % 3] * r[(c + 1) % 3]);
    for (int c = 0; c < 3; c++)
        turned[c] = r[c] + q[0] * t[c] + q[1 + (c + 1) % 3] * t[(c + 2) % 3] - q[1 + (c + 2) % 3] * t[(c + 1) % 3];
}

static inline double dem_cluster_distance(const dem_cluster_sphere *a, const dem_cluster_sphere *b)
{
    const double x = b->position[0] - a->position[0], y = b->position[1] - a->position[1], z = b->position[2] - a->position[2];
    return sqrt(x * x + y * y + z * z);
}

/* The first sphere that no chain of touching spheres joins to sphere 0; -1: all are one body. Positions are given in so
 * many digits: a gap below a millionth of the diameters is a touch. */
static inline int dem_cluster_loose_sphere(const dem_cluster *cluster)
{
    bool joined[DEM_MAXIMUM_CLUSTER] = { true };
    for (size_t round = 1; round < cluster->sphere_count; round++)
        for (size_t i = 0; i < cluster->sphere_count; i++)
            for (size_t j = 0; j < cluster->sphere_count && !joined[i]; j++) {
                const dem_cluster_sphere *a = &cluster->sphere[i], *b = &cluster->sphere[j];
                joined[i] = joined[j] && dem_cluster_distance(a, b) <= 0.5 * (1 + 1e-6) * (a->diameter + b->diameter);
            }
    for (size_t i = 0; i < cluster->sphere_count; i++)
        if (!joined[i]) return (int)i;
    return -1;
}

/* The first sphere that lies wholly within another, *in: it adds nothing (a sphere given twice, mostly). -1: none. */
static inline int dem_cluster_hidden_sphere(const dem_cluster *cluster, int *in)
{
    for (size_t i = 0; i < cluster->sphere_count; i++)
        for (size_t j = 0; j < cluster->sphere_count; j++) {
            const dem_cluster_sphere *a = &cluster->sphere[i], *b = &cluster->sphere[j];
            const bool inside = dem_cluster_distance(a, b) + 0.5 * a->diameter <= 0.5 * b->diameter * (1 + 1e-9);
            /* of two alike, the later */
            if (i == j || !inside || (a->diameter == b->diameter && i < j)) continue;
            *in = (int)j;
            return (int)i;
        }
    return -1;
}

/* Integrals over a body of density 1: 1, x, and the products of two coordinates, xx yy zz xy xz yz. */
typedef struct dem_moments {
    double volume, first[3], second[6];
} dem_moments;

static inline void dem_moments_add_sphere(dem_moments *m, const dem_cluster_sphere *s)
{
    const double r = 0.5 * s->diameter, v = dem_sphere_mass(s->diameter, 1.0), *c = s->position;
    const double own = 0.2 * v * r * r;
    m->volume += v;
    for (int a = 0; a < 3; a++) m->first[a] += v * c[a];
    for (int a = 0; a < 3; a++) m->second[a] += own + v * c[a] * c[a];
    m->second[3] += v * c[0] * c[1];
    m->second[4] += v * c[0] * c[2];
    m->second[5] += v * c[1] * c[2];
}

/* A stretch of a column of the given cross-section at (x, y). */
static inline void dem_moments_add_column(dem_moments *m, double area, double x, double y, double low, double high)
{
    const double v = area * (high - low), z = 0.5 * (low + high), zz = (low * low + low * high + high * high) / 3.0;
    m->volume += v;
    m->first[0] += v * x;
    m->first[1] += v * y;
    m->first[2] += v * z;
    m->second[0] += v * x * x;
    m->second[1] += v * y * y;
    m->second[2] += v * zz;
    m->second[3] += v * x * y;
    m->second[4] += v * x * z;
    m->second[5] += v * y * z;
}

/* A sphere that reaches into a row of columns of one x. */
typedef struct dem_in_row {
    size_t sphere;
    double rest; /* its radius squared less its distance from the row squared */
} dem_in_row;

/* The part of a column that is within that sphere. */
typedef struct dem_stretch {
    double low, high;
    dem_in_row of;
} dem_stretch;

static inline size_t dem_cluster_row(const dem_cluster *cluster, double x, dem_in_row *row)
{
    size_t count = 0;
    for (size_t i = 0; i < cluster->sphere_count; i++) {
        const dem_cluster_sphere *s = &cluster->sphere[i];
        const double dx = x - s->position[0], rest = 0.25 * s->diameter * s->diameter - dx * dx;
        if (rest > 0) row[count++] = (dem_in_row){ i, rest };
    }
    return count;
}

/* By their lower ends, then by the spheres' numbers: one order, however they come. Few steps where most are in it. */
static inline void dem_stretches_sort(dem_stretch *stretch, size_t count)
{
    for (size_t k = 1; k < count; k++) {
        const dem_stretch s = stretch[k];
        size_t j = k;
        for (; j > 0; j--) {
            const dem_stretch *before = &stretch[j - 1];
            if (before->low < s.low || (before->low == s.low && before->of.sphere < s.of.sphere)) break;
            stretch[j] = *before;
        }
        stretch[j] = s;
    }
}

/* In order. The row is left in that order, too, which is nearly that of the next column. */
static inline size_t dem_cluster_column(const dem_cluster *cluster, double y, dem_in_row *row, size_t row_count,
                                        dem_stretch *stretch)
{
    size_t count = 0, outside = 0;
    for (size_t k = 0; k < row_count; k++) {
        const dem_cluster_sphere *s = &cluster->sphere[row[k].sphere];
        const double dy = y - s->position[1], h2 = row[k].rest - dy * dy, h = h2 > 0 ? sqrt(h2) : 0;
        if (h2 > 0) stretch[count++] = (dem_stretch){ s->position[2] - h, s->position[2] + h, row[k] };
        else row[outside++] = row[k];
    }
    dem_stretches_sort(stretch, count);
    for (size_t k = 0; k < count; k++) row[outside + k] = stretch[k].of;
    return count;
}

/* What spheres count twice in one column: of the stretches in order of their lower ends, each one's part below the
 * highest end before it. */
static inline void dem_moments_add_excess(dem_moments *m, double area, double x, double y, const dem_stretch *stretch, size_t count)
{
    double covered = -INFINITY;
    for (size_t k = 0; k < count; k++) {
        const double end = fmin(stretch[k].high, covered);
        if (end > stretch[k].low) dem_moments_add_column(m, area, x, y, stretch[k].low, end);
        covered = fmax(covered, stretch[k].high);
    }
}

/* Columns across the widest side. What the ends of the columns miss goes down as its power -3/2: 400 give moments to
 * a few millionths (core/NUMERICS.md, "Clusters"). */
enum { DEM_CLUSTER_COLUMNS = 400 };

static inline dem_moments dem_cluster_excess(const dem_cluster *cluster)
{
    double low[2] = { INFINITY, INFINITY }, high[2] = { -INFINITY, -INFINITY };
    bool overlap = false;
    for (size_t i = 0; i < cluster->sphere_count; i++) {
        const dem_cluster_sphere *s = &cluster->sphere[i];
        for (int c = 0; c < 2; c++) {
            low[c] = fmin(low[c], s->position[c] - 0.5 * s->diameter);
            high[c] = fmax(high[c], s->position[c] + 0.5 * s->diameter);
        }
        for (size_t j = 0; j < i; j++)
            overlap =
                overlap
                || dem_cluster_distance(s, &cluster->sphere[j]) < 0.5 * (1 - 1e-9) * (s->diameter + cluster->sphere[j].diameter);
    }
    dem_moments excess = { 0 };
    const double step = fmax(high[0] - low[0], high[1] - low[1]) / DEM_CLUSTER_COLUMNS;
    for (int a = 0; overlap && a < DEM_CLUSTER_COLUMNS; a++) {
        dem_in_row row[DEM_MAXIMUM_CLUSTER];
        const double x = low[0] + (a + 0.5) * step;
        const size_t row_count = dem_cluster_row(cluster, x, row);
        for (int b = 0; b < DEM_CLUSTER_COLUMNS; b++) {
            dem_stretch stretch[DEM_MAXIMUM_CLUSTER];
            const double y = low[1] + (b + 0.5) * step;
            const size_t count = dem_cluster_column(cluster, y, row, row_count, stretch);
            dem_moments_add_excess(&excess, step * step, x, y, stretch, count);
        }
    }
    return excess;
}

/* Eigenvectors of a symmetric matrix, the columns of `axes`, by Jacobi's rotations; `m` becomes diagonal. What is off
 * the diagonal by rounding alone stays: a shape's own axes are kept where they are principal ones. */
static inline void dem_principal_axes(double m[3][3], double axes[3][3])
{
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) axes[a][b] = a == b;
    const double size = fabs(m[0][0]) + fabs(m[1][1]) + fabs(m[2][2]);
    for (int turn = 0; turn < 60; turn++) {
        int p = 0, q = 1;
        if (fabs(m[0][2]) > fabs(m[p][q])) q = 2;
        if (fabs(m[1][2]) > fabs(m[p][q])) p = 1, q = 2;
        if (fabs(m[p][q]) <= 1e-14 * size) return;
        const double theta = 0.5 * atan2(2 * m[p][q], m[q][q] - m[p][p]), c = cos(theta), s = sin(theta);
        for (int k = 0; k < 3; k++) {
            const double mp = m[k][p], mq = m[k][q], ap = axes[k][p], aq = axes[k][q];
            m[k][p] = c * mp - s * mq;
            m[k][q] = s * mp + c * mq;
            axes[k][p] = c * ap - s * aq;
            axes[k][q] = s * ap + c * aq;
        }
        for (int k = 0; k < 3; k++) {
            const double mp = m[p][k], mq = m[q][k];
            m[p][k] = c * mp - s * mq;
            m[q][k] = s * mp + c * mq;
        }
    }
}

/* Into the frame of the centre and the axes, which are made right-handed. */
static inline void dem_cluster_turn(dem_cluster *cluster, const double centre[3], double axes[3][3])
{
    const double handed = axes[0][0] * (axes[1][1] * axes[2][2] - axes[2][1] * axes[1][2])
                          - axes[0][1] * (axes[1][0] * axes[2][2] - axes[2][0] * axes[1][2])
                          + axes[0][2] * (axes[1][0] * axes[2][1] - axes[2][0] * axes[1][1]);
    for (int k = 0; k < 3 && handed < 0; k++) axes[k][2] = -axes[k][2];
    cluster->reach = 0.0;
    for (size_t i = 0; i < cluster->sphere_count; i++) {
        double *x = cluster->sphere[i].position, from[3], r2 = 0.0;
        for (int c = 0; c < 3; c++) from[c] = x[c] - centre[c];
        for (int c = 0; c < 3; c++) {
            x[c] = axes[0][c] * from[0] + axes[1][c] * from[1] + axes[2][c] * from[2];
            r2 += x[c] * x[c];
        }
        cluster->reach = fmax(cluster->reach, sqrt(r2) + 0.5 * cluster->sphere[i].diameter);
    }
}

/* Volume, principal moments and reach of the spheres given; positions into the principal frame. */
static inline void dem_cluster_complete(dem_cluster *cluster)
{
    if (cluster->sphere_count == 0) return;
    dem_moments m = { 0 };
    for (size_t i = 0; i < cluster->sphere_count; i++) dem_moments_add_sphere(&m, &cluster->sphere[i]);
    const dem_moments excess = dem_cluster_excess(cluster);
    m.volume -= excess.volume;
    for (int c = 0; c < 3; c++) m.first[c] -= excess.first[c];
    for (int c = 0; c < 6; c++) m.second[c] -= excess.second[c];

    double centre[3], s[6], axes[3][3];
    static const int pair[6][2] = { { 0, 0 }, { 1, 1 }, { 2, 2 }, { 0, 1 }, { 0, 2 }, { 1, 2 } };
    for (int c = 0; c < 3; c++) centre[c] = m.first[c] / m.volume;
    for (int k = 0; k < 6; k++) s[k] = m.second[k] - m.volume * centre[pair[k][0]] * centre[pair[k][1]];
    double inertia[3][3] = { { s[1] + s[2], -s[3], -s[4] }, { -s[3], s[0] + s[2], -s[5] }, { -s[4], -s[5], s[0] + s[1] } };
    dem_principal_axes(inertia, axes);
    cluster->volume = m.volume;
    for (int c = 0; c < 3; c++) cluster->inertia[c] = inertia[c][c];
    dem_cluster_turn(cluster, centre, axes);
}

#endif
