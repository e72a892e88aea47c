/* Grids of cells over a box, perhaps periodic along z, in which spheres are found by place: a grid for each octave of
 * diameters that there are, so that neither the cells of small spheres are many for a large one's size, nor those of large
 * spheres full of small ones. */
#ifndef CELL_GRID_H
#define CELL_GRID_H

#include "spheres.h"

typedef struct grid_level {
    int cells[3];
    double inverse_size[3]; /* 1/m */
    size_t first_cell;      /* cells are counted through all levels; z runs fastest */
    double largest;         /* m, radius of its spheres */
    size_t spheres;         /* how many */
} grid_level;

enum { MOST_LEVELS = 12 };

typedef struct cell_grid {
    double low[3], high[3]; /* m: the box that the cells divide */
    double rounding;        /* m: of three coordinates of the container's size, twice over */
    real period, inverse_period;
    int level_count;
    grid_level level[MOST_LEVELS]; /* largest spheres first; the last one has all that are smaller, too */
    size_t capacity_cells, capacity_spheres;
    int32_t *start; /* (cells + 1) where each cell's spheres begin in the arrays below */
    /* cell after cell, ascending in index within each; LANES more behind the last, so that whole vectors may be read */
    int32_t *sphere;
    real *x[3];   /* m, rounded */
    real *radius; /* m */
} cell_grid;

/* For these spheres, whose radii stay. */
void cell_grid_init(cell_grid *grid, const spheres *spheres);
void cell_grid_clear(cell_grid *grid);
/* Sort all spheres into cells no smaller than their level's largest diameter and `skin`, over as much of the container's
 * box from low to high as they span; what lies outside goes to the cells at the border. period: m along z, which is then
 * the box's height; 0: none. */
dem_status cell_grid_fill(cell_grid *grid, const spheres *spheres, const double low[3], const double high[3], double period,
                          double skin);

/* Spheres of index above i whose surfaces are within `skin` of i's, in no order: written to found, which has room for
 * `room` and LANES more. Returns how many there are; where that exceeds room, not all were written. Never leaves
 * one out through rounding: one whose gap is a millionth of the drum above the skin may be in, too. */
size_t cell_grid_neighbors(const cell_grid *grid, const spheres *spheres, size_t i, double skin, int32_t *found, size_t room);

#endif
