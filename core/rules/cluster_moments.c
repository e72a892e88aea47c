/* Volume, centre and principal moments of a cluster.
 *
 * They are those of the union: the exact sums over the spheres, less what is in several of them. That excess is integrated over
 * columns along z, exactly within each column; it is nothing where spheres only touch. */
#include "dem_cluster.h"

#include <math.h>

/* Integrals over a body of density 1: 1, x, and the products of two coordinates, xx yy zz xy xz yz. */
typedef struct moments {
    double volume, first[3], second[6];
} moments;

/* A sphere that reaches into a row of columns of one x. */
typedef struct in_row {
    size_t sphere;
    double left; /* its radius squared less its distance from the row squared */
} in_row;

/* The part of a column that is within that sphere. */
typedef struct segment {
    double low, high;
    in_row of;
} segment;

/* Columns across the widest side. What the ends of the columns miss goes down as its power -3/2: 400 give moments to
 * a few millionths (core/NUMERICS.md, "Clusters"). */
enum { CLUSTER_COLUMNS = 400 };

static void moments_add_sphere(moments *m, const dem_cluster_sphere *s)
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

/* A segment of a column of the given cross-section at (x, y). */
static void moments_add_column(moments *m, double area, double x, double y, double low, double high)
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

static size_t cluster_row(const dem_cluster *cluster, double x, in_row *row)
{
    size_t count = 0;
    for (size_t i = 0; i < cluster->sphere_count; i++) {
        const dem_cluster_sphere *s = &cluster->sphere[i];
        const double dx = x - s->position[0], rest = 0.25 * s->diameter * s->diameter - dx * dx;
        if (rest > 0) row[count++] = (in_row){ i, rest };
    }
    return count;
}

/* By their lower ends, then by the spheres' numbers: one order, however they come. Few steps where most are in it. */
static void segments_sort(segment *segments, size_t count)
{
    for (size_t k = 1; k < count; k++) {
        const segment s = segments[k];
        size_t j = k;
        for (; j > 0; j--) {
            const segment *before = &segments[j - 1];
            if (before->low < s.low || (before->low == s.low && before->of.sphere < s.of.sphere)) break;
            segments[j] = *before;
        }
        segments[j] = s;
    }
}

/* In order. The row is left in that order, too, which is nearly that of the next column. */
static size_t cluster_column(const dem_cluster *cluster, double y, in_row *row, size_t row_count, segment *segments)
{
    size_t count = 0, outside = 0;
    for (size_t k = 0; k < row_count; k++) {
        const dem_cluster_sphere *s = &cluster->sphere[row[k].sphere];
        const double dy = y - s->position[1], h2 = row[k].left - dy * dy, h = h2 > 0 ? sqrt(h2) : 0;
        if (h2 > 0) segments[count++] = (segment){ s->position[2] - h, s->position[2] + h, row[k] };
        else row[outside++] = row[k];
    }
    segments_sort(segments, count);
    for (size_t k = 0; k < count; k++) row[outside + k] = segments[k].of;
    return count;
}

/* What spheres count twice in one column: of the segments in order of their lower ends, each one's part below the
 * highest end before it. */
static void moments_add_excess(moments *m, double area, double x, double y, const segment *segments, size_t count)
{
    double covered = -INFINITY;
    for (size_t k = 0; k < count; k++) {
        const double end = fmin(segments[k].high, covered);
        if (end > segments[k].low) moments_add_column(m, area, x, y, segments[k].low, end);
        covered = fmax(covered, segments[k].high);
    }
}

static moments cluster_excess(const dem_cluster *cluster)
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
    moments excess = { 0 };
    const double step = fmax(high[0] - low[0], high[1] - low[1]) / CLUSTER_COLUMNS;
    for (int a = 0; overlap && a < CLUSTER_COLUMNS; a++) {
        in_row row[DEM_MAXIMUM_CLUSTER];
        const double x = low[0] + (a + 0.5) * step;
        const size_t row_count = cluster_row(cluster, x, row);
        for (int b = 0; b < CLUSTER_COLUMNS; b++) {
            segment segments[DEM_MAXIMUM_CLUSTER];
            const double y = low[1] + (b + 0.5) * step;
            const size_t count = cluster_column(cluster, y, row, row_count, segments);
            moments_add_excess(&excess, step * step, x, y, segments, count);
        }
    }
    return excess;
}

/* Eigenvectors of a symmetric matrix, the columns of `axes`, by Jacobi's rotations; `m` becomes diagonal. What is off
 * the diagonal by rounding alone stays: a shape's own axes are kept where they are principal ones. */
static void principal_axes(double m[3][3], double axes[3][3])
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
static void into_frame(dem_cluster *cluster, const double centre[3], double axes[3][3])
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

void dem_cluster_complete(dem_cluster *cluster)
{
    if (cluster->sphere_count == 0) return;
    moments m = { 0 };
    for (size_t i = 0; i < cluster->sphere_count; i++) moments_add_sphere(&m, &cluster->sphere[i]);
    const moments excess = cluster_excess(cluster);
    m.volume -= excess.volume;
    for (int c = 0; c < 3; c++) m.first[c] -= excess.first[c];
    for (int c = 0; c < 6; c++) m.second[c] -= excess.second[c];

    double centre[3], s[6], axes[3][3];
    static const int pair[6][2] = { { 0, 0 }, { 1, 1 }, { 2, 2 }, { 0, 1 }, { 0, 2 }, { 1, 2 } };
    for (int c = 0; c < 3; c++) centre[c] = m.first[c] / m.volume;
    for (int k = 0; k < 6; k++) s[k] = m.second[k] - m.volume * centre[pair[k][0]] * centre[pair[k][1]];
    double inertia[3][3] = { { s[1] + s[2], -s[3], -s[4] }, { -s[3], s[0] + s[2], -s[5] }, { -s[4], -s[5], s[0] + s[1] } };
    principal_axes(inertia, axes);
    cluster->volume = m.volume;
    for (int c = 0; c < 3; c++) cluster->inertia[c] = inertia[c][c];
    into_frame(cluster, centre, axes);
}
