#include "cell_grid.h"

#include "array.h"

/* Small spheres may be few in a wide box: larger cells than theirs are right, too, and cost less than many empty ones. */
enum { MOST_CELLS_A_SIDE = 1024, MOST_CELLS_A_SPHERE = 32 };

void cell_grid_init(cell_grid *grid, const spheres *s)
{
    memset(grid, 0, sizeof *grid);
    double largest = 0.0, largest_of[MOST_LEVELS] = { 0 };
    size_t spheres_of[MOST_LEVELS] = { 0 };
    for (size_t i = 0; i < spheres_count(s); i++) largest = fmax(largest, s->full_radius[i]);
    for (size_t i = 0; i < spheres_count(s); i++) {
        const int octave = ilogb(largest / s->full_radius[i]), o = octave < MOST_LEVELS ? octave : MOST_LEVELS - 1;
        largest_of[o] = fmax(largest_of[o], s->full_radius[i]);
        spheres_of[o]++;
    }
    for (int o = 0; o < MOST_LEVELS; o++)
        if (spheres_of[o] > 0)
            grid->level[grid->level_count++] = (grid_level){ .largest = largest_of[o], .spheres = spheres_of[o] };
}

static void sphere_arrays_free(cell_grid *grid)
{
    free(grid->sphere);
    for (int c = 0; c < 3; c++) free(grid->x[c]);
    free(grid->radius);
}

void cell_grid_clear(cell_grid *grid)
{
    free(grid->start);
    sphere_arrays_free(grid);
    memset(grid, 0, sizeof *grid);
}

static dem_status reserve_cells(cell_grid *grid, size_t cells)
{
    if (grid->start && cells <= grid->capacity_cells) return DEM_OK;
    int32_t *start = array_create(cells + 1, sizeof *start);
    if (!start) return DEM_NO_MEMORY;
    free(grid->start);
    grid->start = start;
    grid->capacity_cells = cells;
    return DEM_OK;
}

static dem_status reserve_spheres(cell_grid *grid, size_t count)
{
    if (count <= grid->capacity_spheres) return DEM_OK;
    cell_grid grown = { 0 };
    grown.sphere = array_create(count + LANES, sizeof *grown.sphere);
    for (int c = 0; c < 3; c++) grown.x[c] = array_create(count + LANES, sizeof *grown.x[c]);
    grown.radius = array_create(count + LANES, sizeof *grown.radius);
    if (!grown.sphere || !grown.x[0] || !grown.x[1] || !grown.x[2] || !grown.radius) {
        sphere_arrays_free(&grown);
        return DEM_NO_MEMORY;
    }
    sphere_arrays_free(grid);
    grid->sphere = grown.sphere;
    for (int c = 0; c < 3; c++) grid->x[c] = grown.x[c];
    grid->radius = grown.radius;
    grid->capacity_spheres = count;
    return DEM_OK;
}

/* As far as the grid goes: what lies outside counts to its border, a NaN to the lower one. */
static int cell_along(const cell_grid *grid, const grid_level *level, double x, int axis)
{
    const double place = (x - grid->low[axis]) * level->inverse_size[axis], last = level->cells[axis] - 1;
    return place > 0 ? (int)(place < last ? place : last) : 0;
}

/* Cells of a level, no smaller than `size`. Returns how many. */
static size_t set_cells_of_level(const cell_grid *grid, grid_level *level, double size)
{
    size_t cells = 1;
    for (int a = 0; a < 3; a++) {
        const double side = grid->high[a] - grid->low[a];
        level->cells[a] = (int)fmax(1.0, fmin(floor(side / size), MOST_CELLS_A_SIDE));
        level->inverse_size[a] = level->cells[a] / side;
        cells *= (size_t)level->cells[a];
    }
    return cells;
}

/* The cells of all levels. Returns how many they are together. */
static size_t set_cells(cell_grid *grid, double skin)
{
    size_t all = 0;
    for (int l = 0; l < grid->level_count; l++) {
        grid_level *level = &grid->level[l];
        double size = 2 * level->largest + skin;
        size_t cells;
        while ((cells = set_cells_of_level(grid, level, size)) > MOST_CELLS_A_SPHERE * level->spheres) size *= 1.26;
        level->first_cell = all;
        all += cells;
    }
    return all;
}

static const grid_level *level_of(const cell_grid *grid, double radius)
{
    int l = 0;
    while (l + 1 < grid->level_count && radius <= grid->level[l + 1].largest) l++;
    return &grid->level[l];
}

static size_t cell_of(const cell_grid *grid, const grid_level *level, const double x[3])
{
    size_t cell = 0;
    for (int a = 0; a < 3; a++) cell = cell * (size_t)level->cells[a] + (size_t)cell_along(grid, level, x[a], a);
    return level->first_cell + cell;
}

/* The spheres' own box and `skin` around it, no larger than the one from low to high: few spheres may be in a wide container.
 * Along a periodic axis, all of it. Comparing so that a NaN counts for nothing. */
static void set_box(cell_grid *grid, const spheres *s, const double low[3], const double high[3], double skin)
{
    double least[3] = { high[0], high[1], high[2] }, most[3] = { low[0], low[1], low[2] };
    for (size_t i = 0; i < spheres_count(s); i++) {
        const double *x = sphere_place(s, i);
        for (int a = 0; a < 3; a++) {
            least[a] = x[a] < least[a] ? x[a] : least[a];
            most[a] = x[a] > most[a] ? x[a] : most[a];
        }
    }
    for (int a = 0; a < 3; a++) {
        const bool whole = a == 2 && grid->period > 0;
        grid->low[a] = whole ? low[a] : fmax(low[a], least[a] - skin);
        grid->high[a] = whole ? high[a] : fmin(high[a], most[a] + skin);
    }
}

dem_status cell_grid_fill(cell_grid *grid, const spheres *s, const double low[3], const double high[3], double period, double skin)
{
    const size_t n = spheres_count(s);
    grid->period = (real)period;
    grid->inverse_period = (real)(period > 0 ? 1 / period : 0);
    grid->rounding = 1e-6 * (high[0] - low[0] + high[2] - low[2]);
    set_box(grid, s, low, high, skin);
    const size_t cells = set_cells(grid, skin);
    if (reserve_cells(grid, cells) != DEM_OK || reserve_spheres(grid, n) != DEM_OK) return DEM_NO_MEMORY;
    memset(grid->start, 0, (cells + 1) * sizeof *grid->start);
    for (size_t i = 0; i < n; i++) grid->start[cell_of(grid, level_of(grid, s->full_radius[i]), sphere_place(s, i)) + 1]++;
    for (size_t c = 0; c < cells; c++) grid->start[c + 1] += grid->start[c];
    /* Filling moves each start to its cell's end, which is the next cell's start: shift back by one. */
    for (size_t i = 0; i < n; i++) {
        const double *x = sphere_place(s, i);
        const int32_t at = grid->start[cell_of(grid, level_of(grid, s->full_radius[i]), x)]++;
        grid->sphere[at] = (int32_t)i;
        for (int c = 0; c < 3; c++) grid->x[c][at] = (real)x[c];
        grid->radius[at] = s->full_radius[i];
    }
    memmove(grid->start + 1, grid->start, cells * sizeof *grid->start);
    grid->start[0] = 0;
    return DEM_OK;
}

/* Those within reach among the spheres at [from, to), which are a run of neighboring cells. */
static size_t find_in_run(const cell_grid *grid, int32_t from, int32_t to, int32_t i, const real x[3], real reach, int32_t *found,
                          size_t count, size_t room)
{
    const wide period = wide_all(grid->period), inverse_period = wide_all(grid->inverse_period), own = wide_all(reach);
    for (int32_t at = from; at < to; at += LANES) {
        const wide dx = wide_load_any(grid->x[0] + at) - wide_all(x[0]), dy = wide_load_any(grid->x[1] + at) - wide_all(x[1]);
        wide dz = wide_load_any(grid->x[2] + at) - wide_all(x[2]);
        dz -= period * wide_rint(dz * inverse_period);
        const wide r = own + wide_load_any(grid->radius + at);
        uint32_t bits = wide_mask_bits(wide_exceeds(r * r, dx * dx + dy * dy + dz * dz)) & wide_index_above(grid->sphere + at, i);
        if (to - at < LANES) bits &= (1u << (to - at)) - 1;
        if (count <= room) count += wide_compress(found + count, bits, grid->sphere + at);
        else count += (size_t)__builtin_popcount(bits);
    }
    return count;
}

/* The cells along z that come within `way` of z, in one or, beyond a period's end, in two runs from..to-1. Returns how many. */
static int runs_along_z(const cell_grid *grid, const grid_level *level, double z, double way, int from[2], int to[2])
{
    const int cells = level->cells[2], low = cell_along(grid, level, z - way, 2), high = cell_along(grid, level, z + way, 2);
    from[0] = low;
    to[0] = high + 1;
    if (!(grid->period > 0)) return 1;
    const double below = grid->low[2] - (z - way), above = z + way - grid->high[2];
    if (below >= 0) { /* what is below the box is as far below its upper end */
        from[1] = cell_along(grid, level, grid->high[2] - below, 2);
        to[1] = cells;
    } else if (above >= 0) {
        from[1] = 0;
        to[1] = cell_along(grid, level, grid->low[2] + above, 2) + 1;
    } else {
        return 1;
    }
    if ((below >= 0 && above >= 0) || (below >= 0 ? from[1] <= to[0] : to[1] >= from[0])) { /* they meet: all there are */
        from[0] = 0;
        to[0] = cells;
        return 1;
    }
    return 2;
}

size_t cell_grid_neighbors(const cell_grid *grid, const spheres *s, size_t i, double skin, int32_t *found, size_t room)
{
    const double *place = sphere_place(s, i);
    const real x[3] = { (real)place[0], (real)place[1], (real)place[2] };
    const double reach = s->full_radius[i] + skin + grid->rounding;
    size_t count = 0;
    for (int l = 0; l < grid->level_count; l++) {
        const grid_level *level = &grid->level[l];
        const double way = reach + level->largest;
        int from[2], to[2];
        const int runs = runs_along_z(grid, level, place[2], way, from, to);
        const int high_x = cell_along(grid, level, place[0] + way, 0), high_y = cell_along(grid, level, place[1] + way, 1);
        for (int a = cell_along(grid, level, place[0] - way, 0); a <= high_x; a++)
            for (int b = cell_along(grid, level, place[1] - way, 1); b <= high_y; b++) {
                const int32_t *start = grid->start + level->first_cell + (a * level->cells[1] + b) * level->cells[2];
                for (int r = 0; r < runs; r++)
                    count = find_in_run(grid, start[from[r]], start[to[r]], (int32_t)i, x, (real)reach, found, count, room);
            }
    }
    return count;
}
