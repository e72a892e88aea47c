/* How soft the bed is: overlaps of the contacts between its spheres. */
#include "measure.h"

#include "array.h"

/* Share of the touching contacts that the percentile leaves above it. */
static const double TAIL = 0.01;

double measure_overlap_of(const dem_scene *scene, size_t i, size_t j)
{
    const spheres *s = &scene->spheres;
    const double *a = sphere_place(s, i), *b = sphere_place(s, j);
    return sphere_radius(s, i) + sphere_radius(s, j)
           - sqrt(squared_distance(a, b, scene->container.period, scene->container.inverse_period));
}

static int descending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x < y) - (x > y);
}

dem_status measure_overlap_frame(const dem_scene *scene, double *frame)
{
    const contact_list *pairs = &scene->neighbors.pairs;
    double *overlap = array_create(pairs->count, sizeof *overlap), sum = 0.0;
    if (!overlap) return DEM_NO_MEMORY;
    size_t touching = 0;
    for (size_t k = 0; k < pairs->count; k++) {
        overlap[touching] = measure_overlap_of(scene, (size_t)pairs->first[k], (size_t)pairs->second[k]);
        if (overlap[touching] > 0) sum += overlap[touching++];
    }
    qsort(overlap, touching, sizeof *overlap, descending);
    const double unit = scene->spheres.smallest_diameter;
    frame[FRAME_MEAN_OVERLAP] = touching ? sum / (double)touching / unit : NAN;
    frame[FRAME_OVERLAP_99] = touching ? overlap[(size_t)(TAIL * (double)touching)] / unit : NAN;
    free(overlap);
    return DEM_OK;
}
