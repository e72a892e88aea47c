#include "neighbor_list.h"

#include <stdbool.h>

/* Shares of the smallest diameter, chosen by measurement: core/NUMERICS.md, "Neighbor lists". */
static const double SKIN = 0.4, MARGIN = 0.015;

dem_status neighbor_list_init(neighbor_list *list, const spheres *s)
{
    memset(list, 0, sizeof *list);
    list->skin = SKIN * s->smallest_diameter;
    list->margin = MARGIN * s->smallest_diameter;
    cell_grid_init(&list->grid);
    const size_t n = s->mobile_count;
    list->start = array_create(n + 1, sizeof *list->start);
    list->built_at = array_create(n, sizeof *list->built_at);
    list->picked_velocity = array_create(n, sizeof *list->picked_velocity);
    list->incoming_start = array_create(n + 1, sizeof *list->incoming_start);
    bool enough = list->start && list->built_at && list->picked_velocity && list->incoming_start;
    contact_list *const all[] = { &list->pairs, &list->pairs_before, &list->walls, &list->walls_before };
    for (int k = 0; k < 4; k++) enough = contact_list_init(all[k], n) == DEM_OK && enough;
    if (enough) return DEM_OK;
    neighbor_list_clear(list);
    return DEM_NO_MEMORY;
}

void neighbor_list_clear(neighbor_list *list)
{
    free(list->start);
    free(list->second);
    free(list->in_reach);
    free(list->built_at);
    free(list->picked_velocity);
    free(list->incoming_start);
    free(list->incoming);
    cell_grid_clear(&list->grid);
    contact_list_clear(&list->pairs);
    contact_list_clear(&list->pairs_before);
    contact_list_clear(&list->walls);
    contact_list_clear(&list->walls_before);
    memset(list, 0, sizeof *list);
}

void neighbor_list_invalidate(neighbor_list *list)
{
    list->outer_valid = false;
    list->inner_valid = false;
}

/* ---- outer list ---- */

static inline double squared_distance(const double a[3], const double b[3], double period, double inverse_period)
{
    const double dx = b[0] - a[0], dy = b[1] - a[1], dz = wrap_axial(b[2] - a[2], period, inverse_period);
    return dx * dx + dy * dy + dz * dz;
}

/* Spheres after i within the skin of it; written to `second` when that is not NULL. */
static size_t outer_neighbors(const neighbor_list *list, const spheres *s, size_t i, double period, int32_t *second)
{
    int32_t cells[27];
    const int cell_count = cell_grid_neighborhood(&list->grid, list->grid.cell_of[i], cells);
    const double own = s->full_radius[i] + list->skin, inverse_period = 1.0 / period;
    size_t count = 0;
    for (int c = 0; c < cell_count; c++) {
        for (int32_t m = list->grid.start[cells[c]]; m < list->grid.start[cells[c] + 1]; m++) {
            const int32_t j = list->grid.sphere[m];
            if ((size_t)j <= i) continue;
            const double reach = own + s->full_radius[j];
            if (squared_distance(s->row[i].x, s->row[j].x, period, inverse_period) >= reach * reach) continue;
            if (second) {
                size_t k = count; /* insertion keeps the seconds ascending */
                for (; k > 0 && second[k - 1] > j; k--) second[k] = second[k - 1];
                second[k] = j;
            }
            count++;
        }
    }
    return count;
}

static dem_status outer_reserve(neighbor_list *list, size_t count)
{
    if (count <= list->pair_capacity) return DEM_OK;
    const size_t capacity = count + count / 4;
    int32_t *second = array_create(capacity, sizeof *second);
    uint8_t *in_reach = array_create(capacity, sizeof *in_reach);
    if (!second || !in_reach) {
        free(second);
        free(in_reach);
        return DEM_NO_MEMORY;
    }
    free(list->second);
    free(list->in_reach);
    list->second = second;
    list->in_reach = in_reach;
    list->pair_capacity = capacity;
    return DEM_OK;
}

static dem_status outer_build(neighbor_list *list, const spheres *s, const container *drum, int threads)
{
    const size_t n = s->mobile_count;
    const double reach = fmax(s->largest_diameter, 2 * s->full_radius[spheres_count(s) - 1]) + list->skin;
    dem_status status = cell_grid_fill(&list->grid, s, drum->radius, drum->length, reach);
    if (status != DEM_OK) return status;
    list->start[0] = 0;
#pragma omp parallel for schedule(static) num_threads(threads) if (threads > 1)
    for (size_t i = 0; i < n; i++) list->start[i + 1] = outer_neighbors(list, s, i, drum->length, NULL);
    for (size_t i = 0; i < n; i++) list->start[i + 1] += list->start[i];
    list->pair_count = list->start[n];
    status = outer_reserve(list, list->pair_count);
    if (status != DEM_OK) return status;
#pragma omp parallel for schedule(static) num_threads(threads) if (threads > 1)
    for (size_t i = 0; i < n; i++) {
        outer_neighbors(list, s, i, drum->length, list->second + list->start[i]);
        for (int c = 0; c < 3; c++) list->built_at[i][c] = s->row[i].x[c];
    }
    list->turned_at_build = drum->angle;
    list->outer_valid = true;
    list->outer_builds++;
    return DEM_OK;
}

/* ---- inner list ---- */

typedef struct outlook {
    double largest_displacement; /* m since the outer list was made */
    double largest_speed;        /* m/s */
} outlook;

static outlook outlook_measure(const neighbor_list *list, const spheres *s, const container *drum)
{
    double displacement2 = 0.0, speed2 = 0.0;
    const double inverse_length = 1.0 / drum->length;
    for (size_t i = 0; i < s->mobile_count; i++) {
        const double *v = s->velocity[i];
        displacement2 = fmax(displacement2, squared_distance(list->built_at[i], s->row[i].x, drum->length, inverse_length));
        speed2 = fmax(speed2, v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    }
    outlook out = { sqrt(displacement2), sqrt(speed2) };
    if (s->lining_count) {
        out.largest_speed = fmax(out.largest_speed, fabs(drum->rotation_rate) * drum->radius);
        out.largest_displacement = fmax(out.largest_displacement, fabs(drum->angle - list->turned_at_build) * drum->radius);
    }
    return out;
}

/* Steps for which every pair outside the outer list stays apart, at most HORIZON; 0: not even now. */
static int safe_steps(const neighbor_list *list, const outlook *now, double time_step)
{
    const double room = 0.5 * list->skin - list->margin - now->largest_displacement;
    if (!(room > 0)) return 0;
    return (int)fmin(HORIZON, 1 + room / (now->largest_speed * time_step + 1e-300));
}

/* Could the pair touch within `duration`, both ends straying at most `margin` from straight paths? Along the
 * line of centres now, the distance is never less than gap + duration * (closing speed): a bound from below. */
static inline bool pair_in_reach(const sphere_row *a, const sphere_row *b, double radii, double duration,
                                 double margin, double period, double inverse_period)
{
    const double dx = b->x[0] - a->x[0], dy = b->x[1] - a->x[1];
    const double dz = wrap_axial(b->x[2] - a->x[2], period, inverse_period);
    const double distance = sqrt(dx * dx + dy * dy + dz * dz);
    const double parting = ((double)(b->v[0] - a->v[0]) * dx + (double)(b->v[1] - a->v[1]) * dy
                            + (double)(b->v[2] - a->v[2]) * dz) / distance;
    return distance - radii + duration * fmin(parting, 0.0) < 2 * margin;
}

/* A straight path's distance from the axis is largest at one of its ends. */
static inline bool wall_in_reach(const sphere_row *a, double radius, double duration, double margin, double wall)
{
    const double x = a->x[0] + duration * (double)a->v[0], y = a->x[1] + duration * (double)a->v[1];
    const double rho2 = fmax(x * x + y * y, a->x[0] * a->x[0] + a->x[1] * a->x[1]);
    const double limit = wall - radius - margin;
    return limit < 0 || rho2 > limit * limit;
}

static void mark_pairs_in_reach(neighbor_list *list, const spheres *s, const container *drum, double duration, int threads)
{
    const size_t n = s->mobile_count;
    const double inverse_length = 1.0 / drum->length;
#pragma omp parallel for schedule(static) num_threads(threads) if (threads > 1)
    for (size_t i = 0; i < n; i++) {
        size_t count = 0;
        for (size_t p = list->start[i]; p < list->start[i + 1]; p++) {
            const int32_t j = list->second[p];
            list->in_reach[p] = pair_in_reach(&s->row[i], &s->row[j], s->full_radius[i] + s->full_radius[j], duration,
                                              list->margin, drum->length, inverse_length);
            count += list->in_reach[p];
        }
        list->pairs.start[i + 1] = count;
        list->walls.start[i + 1] = wall_in_reach(&s->row[i], s->full_radius[i], duration, list->margin, drum->radius);
        for (int c = 0; c < 3; c++) list->picked_velocity[i][c] = s->velocity[i][c];
    }
}

static void swap_lists(contact_list *a, contact_list *b)
{
    const contact_list c = *a;
    *a = *b;
    *b = c;
}

static void starts_from_counts(contact_list *list, size_t n)
{
    list->start[0] = 0;
    for (size_t i = 0; i < n; i++) list->start[i + 1] += list->start[i];
    list->count = list->start[n];
}

/* The slots in which each mobile sphere is the second of a pair, ascending: by id of the first. */
static dem_status incoming_build(neighbor_list *list, size_t n)
{
    if (list->pairs.count > list->incoming_capacity) {
        int32_t *incoming = array_create(list->pairs.capacity, sizeof *incoming);
        if (!incoming) return DEM_NO_MEMORY;
        free(list->incoming);
        list->incoming = incoming;
        list->incoming_capacity = list->pairs.capacity;
    }
    memset(list->incoming_start, 0, (n + 1) * sizeof *list->incoming_start);
    for (size_t k = 0; k < list->pairs.count; k++)
        if ((size_t)list->pairs.second[k] < n) list->incoming_start[list->pairs.second[k] + 1]++;
    for (size_t i = 0; i < n; i++) list->incoming_start[i + 1] += list->incoming_start[i];
    for (size_t k = 0; k < list->pairs.count; k++)
        if ((size_t)list->pairs.second[k] < n) list->incoming[list->incoming_start[list->pairs.second[k]]++] = (int32_t)k;
    memmove(list->incoming_start + 1, list->incoming_start, n * sizeof *list->incoming_start);
    list->incoming_start[0] = 0;
    return DEM_OK;
}

static void fill_slots_of(neighbor_list *list, const spheres *s, const dem_contact_parameters *contact, size_t i)
{
    size_t k = list->pairs.start[i];
    for (size_t p = list->start[i]; p < list->start[i + 1]; p++) {
        if (!list->in_reach[p]) continue;
        const int32_t j = list->second[p];
        list->pairs.first[k] = (int32_t)i;
        list->pairs.second[k] = j;
        list->pairs.friction[k] = (real)((size_t)j < s->mobile_count ? contact->friction : contact->wall_friction);
        k++;
    }
    contact_list_carry(&list->pairs, &list->pairs_before, i);
    for (size_t w = list->walls.start[i]; w < list->walls.start[i + 1]; w++) {
        list->walls.first[w] = (int32_t)i;
        list->walls.friction[w] = (real)contact->wall_friction;
    }
    contact_list_carry(&list->walls, &list->walls_before, i);
}

static dem_status inner_pick(neighbor_list *list, const spheres *s, const container *drum,
                             const dem_contact_parameters *contact, double duration, int threads)
{
    const size_t n = s->mobile_count;
    swap_lists(&list->pairs, &list->pairs_before);
    swap_lists(&list->walls, &list->walls_before);
    mark_pairs_in_reach(list, s, drum, duration, threads);
    starts_from_counts(&list->pairs, n);
    starts_from_counts(&list->walls, n);
    if (contact_list_reserve(&list->pairs, list->pairs.count) != DEM_OK
        || contact_list_reserve(&list->walls, list->walls.count) != DEM_OK) return DEM_NO_MEMORY;
#pragma omp parallel for schedule(static) num_threads(threads) if (threads > 1)
    for (size_t i = 0; i < n; i++) fill_slots_of(list, s, contact, i);
    contact_list_pad(&list->pairs, (int32_t)spheres_count(s), 0);
    contact_list_pad(&list->walls, 0, 0);
    /* The lining's paths are arcs: they leave their straight paths by this much at most. */
    list->strayed = s->lining_count ? 0.5 * drum->rotation_rate * drum->rotation_rate * drum->radius * duration * duration : 0.0;
    list->steps_since_pick = 0;
    list->inner_valid = true;
    list->inner_picks++;
    return incoming_build(list, n);
}

dem_status neighbor_list_update(neighbor_list *list, const spheres *s, const container *drum,
                                const dem_contact_parameters *contact, double time_step, int threads, bool *made_new)
{
    const bool safe = list->inner_valid && list->steps_since_pick < list->safe_steps && list->strayed <= list->margin;
    if (made_new) *made_new = !safe;
    if (safe) return DEM_OK;

    outlook now = outlook_measure(list, s, drum);
    int steps = list->outer_valid ? safe_steps(list, &now, time_step) : 0;
    if (steps < HORIZON) {
        const dem_status status = outer_build(list, s, drum, threads);
        if (status != DEM_OK) return status;
        now.largest_displacement = 0.0;
        steps = safe_steps(list, &now, time_step);
    }
    /* Right after a build, the step at hand is safe whatever the speed. */
    list->safe_steps = steps > 1 ? steps : 1;
    return inner_pick(list, s, drum, contact, list->safe_steps * time_step, threads);
}

void neighbor_list_count_contacts(const neighbor_list *list, const spheres *s, const container *drum, int32_t *contacts)
{
    memset(contacts, 0, s->mobile_count * sizeof *contacts);
    for (size_t k = 0; k < list->pairs.count; k++) {
        const int32_t i = list->pairs.first[k], j = list->pairs.second[k];
        const double radii = (double)s->row[i].radius + (double)s->row[j].radius;
        if (squared_distance(s->row[i].x, s->row[j].x, drum->length, 1.0 / drum->length) >= radii * radii) continue;
        contacts[i]++;
        if ((size_t)j < s->mobile_count) contacts[j]++;
    }
    for (size_t k = 0; k < list->walls.count; k++) {
        const sphere_row *row = &s->row[list->walls.first[k]];
        contacts[list->walls.first[k]] += hypot(row->x[0], row->x[1]) + (double)row->radius > drum->radius;
    }
}
