#include "grounded.h"

#include "array.h"

static const double GAP = 0.1; /* of the grain */

/* Spheres in linked cells over the box that they take up, and those found whose neighbors are still to be looked at. */
typedef struct search {
    const dem_scene *scene;
    double gap, low[3], size[3]; /* m */
    int cells[3];
    int32_t *head, *next, *found; /* (cells), (spheres), (spheres) */
    size_t found_count;
    bool *is_grounded; /* (particles) */
} search;

/* Few spheres in a tall or wide box: larger cells are right, too. */
enum { MOST_CELLS_A_SIDE = 256, MOST_CELLS_A_SPHERE = 32 };

/* Cells no smaller than `size`, from f->low to `high`. Returns how many. */
static size_t set_cells(search *f, const double high[3], double size)
{
    size_t cells = 1;
    for (int a = 0; a < 3; a++) {
        const double side = fmax(high[a] - f->low[a], 1e-12);
        f->cells[a] = (int)fmax(1.0, fmin(MOST_CELLS_A_SIDE, floor(side / size)));
        f->size[a] = side / f->cells[a];
        cells *= (size_t)f->cells[a];
    }
    return cells;
}

static void set_box(search *f)
{
    const spheres *s = &f->scene->spheres;
    double high[3] = { -INFINITY, -INFINITY, -INFINITY };
    for (int a = 0; a < 3; a++) f->low[a] = INFINITY;
    for (size_t i = 0; i < s->mobile_count; i++)
        for (int a = 0; a < 3; a++) {
            f->low[a] = fmin(f->low[a], sphere_place(s, i)[a]);
            high[a] = fmax(high[a], sphere_place(s, i)[a]);
        }
    double size = s->largest_diameter + f->gap;
    while (set_cells(f, high, size) > MOST_CELLS_A_SPHERE * s->mobile_count) size *= 1.26;
}

static int cell_along(const search *f, const double x[3], int axis)
{
    const int c = (int)((x[axis] - f->low[axis]) / f->size[axis]);
    return c < 0 ? 0 : c >= f->cells[axis] ? f->cells[axis] - 1 : c;
}

static size_t cell_at(const search *f, int x, int y, int z)
{
    return ((size_t)x * (size_t)f->cells[1] + (size_t)y) * (size_t)f->cells[2] + (size_t)z;
}

/* All spheres of the particle, once. */
static void ground(search *f, size_t sphere)
{
    const spheres *s = &f->scene->spheres;
    const size_t p = particle_of_sphere(s, sphere);
    if (f->is_grounded[p]) return;
    f->is_grounded[p] = true;
    size_t first = sphere, end = sphere + 1;
    if (p >= s->single_count) {
        const cluster_body *body = &s->clusters.body[p - s->single_count];
        first = (size_t)body->first_sphere;
        end = first + s->clusters.shape[body->species].sphere_count;
    }
    for (size_t i = first; i < end; i++) f->found[f->found_count++] = (int32_t)i;
}

static void ground_neighbors(search *f, size_t i)
{
    const spheres *s = &f->scene->spheres;
    const double *x = sphere_place(s, i);
    const int c[3] = { cell_along(f, x, 0), cell_along(f, x, 1), cell_along(f, x, 2) };
    for (int a = c[0] > 0 ? c[0] - 1 : 0; a <= c[0] + 1 && a < f->cells[0]; a++)
        for (int b = c[1] > 0 ? c[1] - 1 : 0; b <= c[1] + 1 && b < f->cells[1]; b++)
            for (int d = c[2] > 0 ? c[2] - 1 : 0; d <= c[2] + 1 && d < f->cells[2]; d++)
                for (int32_t j = f->head[cell_at(f, a, b, d)]; j >= 0; j = f->next[j]) {
                    const double *y = sphere_place(s, (size_t)j), e[3] = { y[0] - x[0], y[1] - x[1], y[2] - x[2] };
                    const double near = sphere_radius(s, i) + sphere_radius(s, (size_t)j) + f->gap;
                    if (e[0] * e[0] + e[1] * e[1] + e[2] * e[2] < near * near) ground(f, (size_t)j);
                }
}

static void fill_cells(search *f, size_t cells)
{
    const spheres *s = &f->scene->spheres;
    for (size_t c = 0; c < cells; c++) f->head[c] = -1;
    for (size_t i = 0; i < s->mobile_count; i++) {
        const double *x = sphere_place(s, i);
        const size_t cell = cell_at(f, cell_along(f, x, 0), cell_along(f, x, 1), cell_along(f, x, 2));
        f->next[i] = f->head[cell];
        f->head[cell] = (int32_t)i;
    }
}

dem_status grounded_find(const dem_scene *scene, double grain, bool *is_grounded)
{
    const spheres *s = &scene->spheres;
    search f = { .scene = scene, .gap = GAP * grain, .is_grounded = is_grounded };
    memset(is_grounded, 0, particles_count(s) * sizeof *is_grounded);
    set_box(&f);
    const size_t cells = (size_t)f.cells[0] * (size_t)f.cells[1] * (size_t)f.cells[2];
    f.head = array_create(cells, sizeof *f.head);
    f.next = array_create(s->mobile_count, sizeof *f.next);
    f.found = array_create(s->mobile_count, sizeof *f.found);
    const bool enough = f.head && f.next && f.found;
    if (enough) {
        fill_cells(&f, cells);
        for (size_t i = 0; i < s->mobile_count; i++)
            if (sphere_place(s, i)[2] < sphere_radius(s, i) + f.gap) ground(&f, i);
        for (size_t k = 0; k < f.found_count; k++) ground_neighbors(&f, (size_t)f.found[k]);
    }
    free(f.head);
    free(f.next);
    free(f.found);
    return enough ? DEM_OK : DEM_NO_MEMORY;
}
