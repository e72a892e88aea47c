/* Solid fraction over the drum's cross-section, on square cells, in a frame turned by an angle about the axis. */
#ifndef DENSITY_GRID_H
#define DENSITY_GRID_H

#include "scene.h"

typedef struct density_grid {
    int cells;          /* a side */
    double size;        /* m a cell */
    double turned;      /* rad: column axis s = x cos + y sin, height axis h = -x sin + y cos */
    double core;        /* solid fraction of the bed's core: median over cells above half of the densest */
    float *value;       /* (cells, cells): columns in s, then h upwards */
    double *kernel;     /* (kernels, KERNEL_POINTS) */
    int32_t *kernel_of; /* (species, DEM_MAXIMUM_CLUSTER) of each sphere of a cluster; of a sphere, the first */
    double reach;       /* m, of the widest kernel */
} density_grid;

/* Cells of a quarter of the mean diameter. Errors: DEM_NO_MEMORY. */
dem_status density_grid_init(density_grid *grid, const dem_scene *scene);
void density_grid_clear(density_grid *grid);
/* Each sphere's volume (of a cluster's: its share of the cluster's volume) projected along the axis and spread over one mean diameter. */
void density_grid_deposit(density_grid *grid, const dem_scene *scene, double turned);
/* Per column: the height where the solid fraction falls, from the bed up, through half the core's; NaN: no bed
 * there. heights: (cells) m. */
void density_grid_heights(const density_grid *grid, double *heights);
double density_grid_place(const density_grid *grid, int cell); /* m, centre of a column or row */
int density_grid_cells(const dem_scene *scene);
double mean_diameter(const dem_scene *scene); /* m, of the mean volume */

#endif
