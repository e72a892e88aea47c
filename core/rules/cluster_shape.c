/* Named shapes of clusters, and whether spheres make one body. */
#include "dem_cluster.h"

#include <math.h>

void dem_cluster_of_shape(dem_cluster *cluster, dem_shape shape, double diameter)
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

void dem_turn(const double wxyz[4], const double r[3], double turned[3])
{
    double q[4] = { 1, 0, 0, 0 }, t[3];
    const double size = sqrt(wxyz[0] * wxyz[0] + wxyz[1] * wxyz[1] + wxyz[2] * wxyz[2] + wxyz[3] * wxyz[3]);
    for (int c = 0; c < 4 && size > 0; c++) q[c] = wxyz[c] / size;
    for (int c = 0; c < 3; c++) t[c] = 2 * (q[1 + (c + 1) % 3] * r[(c + 2) % 3] - q[1 + (c + 2) % 3] * r[(c + 1) % 3]);
    for (int c = 0; c < 3; c++)
        turned[c] = r[c] + q[0] * t[c] + q[1 + (c + 1) % 3] * t[(c + 2) % 3] - q[1 + (c + 2) % 3] * t[(c + 1) % 3];
}

double dem_cluster_distance(const dem_cluster_sphere *a, const dem_cluster_sphere *b)
{
    const double x = b->position[0] - a->position[0], y = b->position[1] - a->position[1], z = b->position[2] - a->position[2];
    return sqrt(x * x + y * y + z * z);
}

int dem_cluster_loose_sphere(const dem_cluster *cluster)
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

int dem_cluster_hidden_sphere(const dem_cluster *cluster, int *in)
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
