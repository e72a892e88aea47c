#include "cell_grid.h"

enum { MOST_CELLS_A_SIDE = 1024 };

void cell_grid_init(cell_grid *grid) { memset(grid, 0, sizeof *grid); }

static void sphere_arrays_free(cell_grid *grid)
{
    free(grid->sphere);
    free(grid->cell_of);
    for (int c = 0; c < 3; c++) free(grid->x[c]);
    free(grid->radius);
}

void cell_grid_clear(cell_grid *grid)
{
    free(grid->start);
    sphere_arrays_free(grid);
    cell_grid_init(grid);
}

static dem_status reserve_cells(cell_grid *grid, size_t cells)
{
    if (cells <= grid->capacity_cells) return DEM_OK;
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
    grown.cell_of = array_create(count, sizeof *grown.cell_of);
    for (int c = 0; c < 3; c++) grown.x[c] = array_create(count + LANES, sizeof *grown.x[c]);
    grown.radius = array_create(count + LANES, sizeof *grown.radius);
    if (!grown.sphere || !grown.cell_of || !grown.x[0] || !grown.x[1] || !grown.x[2] || !grown.radius) {
        sphere_arrays_free(&grown);
        return DEM_NO_MEMORY;
    }
    sphere_arrays_free(grid);
    grid->sphere = grown.sphere;
    grid->cell_of = grown.cell_of;
    for (int c = 0; c < 3; c++) grid->x[c] = grown.x[c];
    grid->radius = grown.radius;
    grid->capacity_spheres = count;
    return DEM_OK;
}

static int cell_along(const cell_grid *grid, double x, int axis)
{
    const double place = (x - grid->origin[axis]) * grid->inverse_size[axis];
    const int cell = place > 0 ? (int)(place < 1e6 ? place : 1e6) : 0;
    return cell < grid->cells[axis] ? cell : grid->cells[axis] - 1;
}

static size_t set_cells(cell_grid *grid, const double low[3], const double high[3], double period, double reach)
{
    size_t cells = 1;
    for (int a = 0; a < 3; a++) {
        const double side = high[a] - low[a];
        grid->cells[a] = (int)fmax(1.0, fmin(floor(side / reach), MOST_CELLS_A_SIDE));
        grid->origin[a] = low[a];
        grid->inverse_size[a] = grid->cells[a] / side;
        cells *= (size_t)grid->cells[a];
    }
    grid->period = (real)period;
    grid->inverse_period = (real)(period > 0 ? 1 / period : 0);
    return cells;
}

dem_status cell_grid_fill(cell_grid *grid, const spheres *s, const double low[3], const double high[3], double period, double reach)
{
    const size_t cells = set_cells(grid, low, high, period, reach), n = spheres_count(s);
    if (reserve_cells(grid, cells) != DEM_OK || reserve_spheres(grid, n) != DEM_OK) return DEM_NO_MEMORY;
    memset(grid->start, 0, (cells + 1) * sizeof *grid->start);
    for (size_t i = 0; i < n; i++) {
        const double *x = sphere_place(s, i);
        const int cx = cell_along(grid, x[0], 0), cy = cell_along(grid, x[1], 1), cz = cell_along(grid, x[2], 2);
        grid->cell_of[i] = (int32_t)((cx * grid->cells[1] + cy) * grid->cells[2] + cz);
        grid->start[grid->cell_of[i] + 1]++;
    }
    for (size_t c = 0; c < cells; c++) grid->start[c + 1] += grid->start[c];
    /* Filling moves each start to its cell's end, which is the next cell's start: shift back by one. */
    for (size_t i = 0; i < n; i++) {
        const int32_t at = grid->start[grid->cell_of[i]]++;
        grid->sphere[at] = (int32_t)i;
        for (int c = 0; c < 3; c++) grid->x[c][at] = (real)sphere_place(s, i)[c];
        grid->radius[at] = (real)s->full_radius[i];
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

size_t cell_grid_neighbors(const cell_grid *grid, size_t i, double skin, int32_t *found, size_t room)
{
    const int nz = grid->cells[2], ny = grid->cells[1], cell = grid->cell_of[i];
    const int cz = cell % nz, cy = cell / nz % ny, cx = cell / nz / ny;
    int32_t at = grid->start[cell];
    while (grid->sphere[at] != (int32_t)i) at++;
    const real x[3] = { grid->x[0][at], grid->x[1][at], grid->x[2][at] };
    /* rounding of three coordinates of the box's size, twice over */
    const double rounding = 1e-6 * (grid->cells[0] / grid->inverse_size[0] + grid->cells[2] / grid->inverse_size[2]);
    const real reach = grid->radius[at] + (real)(skin + rounding);
    size_t count = 0;
    for (int a = cx > 0 ? cx - 1 : 0; a <= cx + 1 && a < grid->cells[0]; a++)
        for (int b = cy > 0 ? cy - 1 : 0; b <= cy + 1 && b < ny; b++) {
            const int32_t *start = grid->start + (a * ny + b) * nz;
            const int32_t id = (int32_t)i;
            if (nz <= 3) {
                count = find_in_run(grid, start[0], start[nz], id, x, reach, found, count, room);
            } else {
                const int low = cz > 0 ? cz - 1 : 0, high = cz + 1 < nz ? cz + 1 : nz - 1;
                count = find_in_run(grid, start[low], start[high + 1], id, x, reach, found, count, room);
                if (cz == 0) count = find_in_run(grid, start[nz - 1], start[nz], id, x, reach, found, count, room);
                if (cz == nz - 1) count = find_in_run(grid, start[0], start[1], id, x, reach, found, count, room);
            }
        }
    return count;
}
