/* A grid of cells over a box, perhaps periodic along z, in which spheres are found by place. */
#ifndef CELL_GRID_H
#define CELL_GRID_H

#include "spheres.h"

typedef struct cell_grid {
    int cells[3];
    double origin[3], inverse_size[3]; /* m, 1/m */
    real period, inverse_period;
    size_t capacity_cells, capacity_spheres;
    int32_t *start;   /* (cells + 1) where each cell's spheres begin in the arrays below; z runs fastest */
    int32_t *cell_of; /* (spheres) */
    /* cell after cell, ascending in index within each; LANES more behind the last, so that whole vectors may be read */
    int32_t *sphere;
    real *x[3];   /* m, rounded */
    real *radius; /* m */
} cell_grid;

void cell_grid_init(cell_grid *grid);
void cell_grid_clear(cell_grid *grid);
/* Sort all spheres into cells no smaller than `reach`, over the box from low to high; what lies outside goes to the cells
 * at its border. period: m along z, which is then the box's height; 0: none. */
dem_status cell_grid_fill(cell_grid *grid, const spheres *spheres, const double low[3], const double high[3], double period,
                          double reach);

/* Spheres of index above i whose surfaces are within `skin` of i's, in no order: written to found, which has room for
 * `room` and LANES more. Returns how many there are; where that exceeds room, not all were written. Never leaves
 * one out through rounding: one whose gap is a millionth of the drum above the skin may be in, too. */
size_t cell_grid_neighbors(const cell_grid *grid, size_t i, double skin, int32_t *found, size_t room);

#endif
