/* A grid of cells over a box, periodic along z, in which spheres are found by place. */
#ifndef CELL_GRID_H
#define CELL_GRID_H

#include "spheres.h"

typedef struct cell_grid {
    int cells[3];
    double origin[3], inverse_size[3]; /* m, 1/m */
    double period;
    size_t capacity_cells, capacity_spheres;
    int32_t *start;   /* (cells + 1) where each cell's spheres begin in `sphere` */
    int32_t *sphere;  /* (spheres) indices, cell after cell, ascending within each */
    int32_t *cell_of; /* (spheres) */
} cell_grid;

void cell_grid_init(cell_grid *grid);
void cell_grid_clear(cell_grid *grid);
/* Sort all spheres into cells no smaller than `reach`, over [-radius, radius]^2 x one period. */
dem_status cell_grid_fill(cell_grid *grid, const spheres *spheres, double radius, double period, double reach);
/* The up to 27 cells around cell `center`, each once, even where the period is one or two cells long. */
int cell_grid_neighborhood(const cell_grid *grid, int32_t center, int32_t cells[27]);

#endif
