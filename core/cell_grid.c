#include "cell_grid.h"

enum { MOST_CELLS_A_SIDE = 1024 };

void cell_grid_init(cell_grid *grid) { memset(grid, 0, sizeof *grid); }

void cell_grid_clear(cell_grid *grid)
{
    free(grid->start);
    free(grid->sphere);
    free(grid->cell_of);
    cell_grid_init(grid);
}

static dem_status grid_reserve(cell_grid *grid, size_t cells, size_t count)
{
    if (cells > grid->capacity_cells) {
        int32_t *start = array_create(cells + 1, sizeof *start);
        if (!start) return DEM_NO_MEMORY;
        free(grid->start);
        grid->start = start;
        grid->capacity_cells = cells;
    }
    if (count > grid->capacity_spheres) {
        int32_t *sphere = array_create(count, sizeof *sphere), *cell_of = array_create(count, sizeof *cell_of);
        if (!sphere || !cell_of) {
            free(sphere);
            free(cell_of);
            return DEM_NO_MEMORY;
        }
        free(grid->sphere);
        free(grid->cell_of);
        grid->sphere = sphere;
        grid->cell_of = cell_of;
        grid->capacity_spheres = count;
    }
    return DEM_OK;
}

static int clamp_cell(double place, int cells)
{
    const int cell = place > 0 ? (int)fmin(place, 1e6) : 0;
    return cell < cells ? cell : cells - 1;
}

static int32_t cell_at(const cell_grid *grid, const double x[3])
{
    int c[3];
    for (int a = 0; a < 3; a++) c[a] = clamp_cell((x[a] - grid->origin[a]) * grid->inverse_size[a], grid->cells[a]);
    return (int32_t)((c[0] * grid->cells[1] + c[1]) * grid->cells[2] + c[2]);
}

dem_status cell_grid_fill(cell_grid *grid, const spheres *s, double radius, double period, double reach)
{
    const double side[3] = { 2 * radius, 2 * radius, period };
    const size_t n = spheres_count(s);
    size_t cells = 1;
    for (int a = 0; a < 3; a++) {
        grid->cells[a] = (int)fmax(1.0, fmin(floor(side[a] / reach), MOST_CELLS_A_SIDE));
        grid->origin[a] = -0.5 * side[a];
        grid->inverse_size[a] = grid->cells[a] / side[a];
        cells *= (size_t)grid->cells[a];
    }
    grid->period = period;
    const dem_status status = grid_reserve(grid, cells, n);
    if (status != DEM_OK) return status;

    memset(grid->start, 0, (cells + 1) * sizeof *grid->start);
    for (size_t i = 0; i < n; i++) {
        grid->cell_of[i] = cell_at(grid, s->row[i].x);
        grid->start[grid->cell_of[i] + 1]++;
    }
    for (size_t c = 0; c < cells; c++) grid->start[c + 1] += grid->start[c];
    /* Filling moves each start to its cell's end, which is the next cell's start: shift back by one. */
    for (size_t i = 0; i < n; i++) grid->sphere[grid->start[grid->cell_of[i]]++] = (int32_t)i;
    memmove(grid->start + 1, grid->start, cells * sizeof *grid->start);
    grid->start[0] = 0;
    return DEM_OK;
}

int cell_grid_neighborhood(const cell_grid *grid, int32_t center, int32_t cells[27])
{
    const int nz = grid->cells[2], ny = grid->cells[1];
    const int cz = center % nz, cy = center / nz % ny, cx = center / nz / ny;
    int z[3], z_count = 0;
    if (nz >= 3) {
        for (int d = -1; d <= 1; d++) z[z_count++] = (cz + d + nz) % nz;
    } else {
        for (int c = 0; c < nz; c++) z[z_count++] = c;
    }
    int count = 0;
    for (int x = cx > 0 ? cx - 1 : 0; x <= cx + 1 && x < grid->cells[0]; x++)
        for (int y = cy > 0 ? cy - 1 : 0; y <= cy + 1 && y < ny; y++)
            for (int k = 0; k < z_count; k++) cells[count++] = (int32_t)((x * ny + y) * nz + z[k]);
    return count;
}
