#include "sorting.h"

#include "array.h"

/* Between two sorts a drum turns by a tenth of a radian or so. Fewer than LEAST fit into the cache in any order. */
enum { STEPS_BETWEEN_SORTS = 8192, LEAST = 1500, MOST_CELLS_A_SIDE = 512 };

int64_t sorting_steps_left(const dem_scene *scene)
{
    if (scene->container.kind != DEM_DRUM || scene->spheres.mobile_count < LEAST) return INT64_MAX;
    const int64_t steps = scene->phase == DEM_PHASE_RUNNING ? scene->step_count - scene->run_start + scene->steps_before
                                                            : scene->step_count - scene->phase_start;
    return STEPS_BETWEEN_SORTS - steps % STEPS_BETWEEN_SORTS;
}

/* ---- the order ---- */

/* Cells of a sphere's size; the longest axis is the slowest to change, so that neighbors along it are not too far away.
 * Where it is periodic and waves go along it (wave.h), it is folded: the first layer, the last, the second, the last but
 * one, so that no two that touch are far apart. */
typedef struct sorting_cells {
    const double *low;
    double inverse_size[3];
    int count[3], axis[3]; /* axis: slowest first */
    bool is_folded;        /* the slowest */
} sorting_cells;

static sorting_cells cells_of(const dem_scene *scene)
{
    const container *vessel = &scene->container;
    sorting_cells cells = { .low = vessel->low, .axis = { 0, 1, 2 } };
    for (int a = 0; a < 3; a++) {
        const double side = vessel->high[a] - vessel->low[a];
        cells.count[a] = (int)fmax(1, fmin(MOST_CELLS_A_SIDE, floor(side / scene->spheres.largest_diameter)));
        cells.inverse_size[a] = cells.count[a] / side;
    }
    if (cells.count[2] > cells.count[0]) memcpy(cells.axis, (const int[]){ 2, 0, 1 }, sizeof cells.axis);
    cells.is_folded = scene->spheres.in_waves && vessel->period > 0 && cells.axis[0] == 2;
    return cells;
}

static int32_t cell_of(const sorting_cells *cells, const double x[3])
{
    int32_t cell = 0;
    for (int k = 0; k < 3; k++) {
        const int a = cells->axis[k], last = cells->count[a] - 1;
        const double along = (x[a] - cells->low[a]) * cells->inverse_size[a];
        const int layer = along > 0 ? (along < last ? (int)along : last) : 0;
        const bool folds = k == 0 && cells->is_folded;
        cell = cell * cells->count[a] + (!folds ? layer : 2 * layer <= last ? 2 * layer : 2 * (last - layer) + 1);
    }
    return cell;
}

/* order[from..to-1] by cell, those of one cell as they were. */
static dem_status order_by_cell(const spheres *s, const sorting_cells *cells, size_t from, size_t to, int32_t *order)
{
    const size_t all = (size_t)cells->count[0] * (size_t)cells->count[1] * (size_t)cells->count[2];
    int32_t *start = array_create(all + 1, sizeof *start);
    if (!start) return DEM_NO_MEMORY;
    for (size_t p = from; p < to; p++) start[cell_of(cells, particle_place(s, p)) + 1]++;
    for (size_t c = 0; c < all; c++) start[c + 1] += start[c];
    for (size_t p = from; p < to; p++) order[from + (size_t)start[cell_of(cells, particle_place(s, p))]++] = (int32_t)p;
    free(start);
    return DEM_OK;
}

/* ---- spheres and clusters ---- */

/* array[k] = what was at order[k] */
static void rearrange(void *array, size_t size, const int32_t *order, size_t count, void *scratch)
{
    char *to = scratch;
    const char *from = array;
    for (size_t k = 0; k < count; k++) memcpy(to + k * size, from + (size_t)order[k] * size, size);
    memcpy(array, scratch, count * size);
}

static void rearrange_clusters(spheres *s, const int32_t *order, int32_t *sphere_order, void *scratch)
{
    clusters *c = &s->clusters;
    rearrange(c->body, sizeof *c->body, order, c->count, scratch);
    size_t next = s->single_count;
    for (size_t b = 0; b < c->count; b++) {
        cluster_body *body = &c->body[b];
        const size_t spheres_of_it = c->shape[body->species].sphere_count;
        for (size_t k = 0; k < spheres_of_it; k++) {
            sphere_order[next + k] = body->first_sphere + (int32_t)k;
            c->of_sphere[next + k - s->single_count] = (int32_t)b;
        }
        body->first_sphere = (int32_t)next;
        next += spheres_of_it;
    }
}

dem_status sorting_apply(spheres *s, const int32_t *order, int32_t *sphere_order)
{
    const size_t n = s->mobile_count, singles = s->single_count;
    const size_t bytes = n * (sizeof *s->row > sizeof *s->place ? sizeof *s->row : sizeof *s->place),
                 of_bodies = s->clusters.count * sizeof *s->clusters.body;
    void *scratch = array_create(bytes > of_bodies ? bytes : of_bodies, 1);
    int32_t *body_order = array_create(s->clusters.count, sizeof *body_order);
    if (!scratch || !body_order) {
        free(scratch);
        free(body_order);
        return DEM_NO_MEMORY;
    }
    memcpy(sphere_order, order, singles * sizeof *order);
    for (size_t b = 0; b < s->clusters.count; b++) body_order[b] = order[singles + b] - (int32_t)singles;
    rearrange_clusters(s, body_order, sphere_order, scratch);
    for (int k = 0; k < SPHERE_ARRAYS; k++)
        if (sphere_arrays[k].is_sorted)
            rearrange(sphere_array_of(s, &sphere_arrays[k]), sphere_arrays[k].size, sphere_order, n, scratch);
    free(scratch);
    free(body_order);
    return DEM_OK;
}

/* ---- what contacts remember ---- */

/* The contacts of `from`, whose spheres have moved to now_at in memory (those from `mobile` on stay), in order of first,
 * then second, in `to`. Seen from the other sphere, friction points the other way. */
static void contacts_move(contact_list *to, const contact_list *from, const int32_t *now_at, size_t mobile, bool between_spheres,
                          int32_t *start)
{
    memset(start, 0, (mobile + 1) * sizeof *start);
    for (int pass = 0; pass < 2; pass++) {
        for (size_t k = 0; k < from->count; k++) {
            int32_t first = now_at[from->first[k]], second = from->second[k];
            if (between_spheres && (size_t)second < mobile) second = now_at[second];
            contact_history history = contact_list_history(from, k);
            if (between_spheres && second < first) {
                const int32_t other = second;
                second = first;
                first = other;
                contact_history_reverse(&history);
            }
            if (pass == 0) {
                start[first + 1]++;
                continue;
            }
            size_t slot = (size_t)start[first]++;
            for (; slot > 0 && to->first[slot - 1] == first && to->second[slot - 1] > second; slot--) {
                const contact_history later = contact_list_history(to, slot - 1);
                to->first[slot] = first;
                to->second[slot] = to->second[slot - 1];
                contact_list_set_history(to, slot, &later);
            }
            to->first[slot] = first;
            to->second[slot] = second;
            contact_list_set_history(to, slot, &history);
        }
        if (pass == 1) break;
        for (size_t i = 0; i < mobile; i++) start[i + 1] += start[i];
        for (size_t k = 0; k < from->count; k++) to->first[k] = -1; /* not filled yet */
    }
    to->count = from->count;
}

static dem_status sort(dem_scene *scene, int32_t *order, int32_t *sphere_order, int32_t *now_at, int32_t *start)
{
    spheres *s = &scene->spheres;
    neighbor_list *list = &scene->neighbors;
    const sorting_cells cells = cells_of(scene);
    if (order_by_cell(s, &cells, 0, s->single_count, order) != DEM_OK
        || order_by_cell(s, &cells, s->single_count, particles_count(s), order) != DEM_OK
        || contact_list_reserve(&list->pairs_before, list->pairs.count) != DEM_OK
        || contact_list_reserve(&list->walls_before, list->walls.count) != DEM_OK
        || sorting_apply(s, order, sphere_order) != DEM_OK)
        return DEM_NO_MEMORY;
    for (size_t k = 0; k < s->mobile_count; k++) now_at[sphere_order[k]] = (int32_t)k;
    contacts_move(&list->pairs_before, &list->pairs, now_at, s->mobile_count, true, start);
    contacts_move(&list->walls_before, &list->walls, now_at, s->mobile_count, false, start);
    contact_list_swap(&list->pairs, &list->pairs_before);
    contact_list_swap(&list->walls, &list->walls_before);
    neighbor_list_invalidate(list);
    return DEM_OK;
}

dem_status sorting_look(dem_scene *scene)
{
    if (sorting_steps_left(scene) != STEPS_BETWEEN_SORTS) return DEM_OK;
    const size_t n = scene->spheres.mobile_count;
    int32_t *numbers = array_create(4 * n + 1, sizeof *numbers);
    const dem_status status = numbers ? sort(scene, numbers, numbers + n, numbers + 2 * n, numbers + 3 * n) : DEM_NO_MEMORY;
    free(numbers);
    return status;
}
