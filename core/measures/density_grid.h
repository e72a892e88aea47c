/* Solid fraction over the drum's cross-section, on square cells, in a frame turned by an angle about the axis. Only tiles of
 * cells that a sphere reaches are there, so that a few small spheres in a wide drum cost no more than in a narrow one. */
#ifndef DENSITY_GRID_H
#define DENSITY_GRID_H

#include "scene.h"

enum { TILE_CELLS = 16 }; /* a side */

typedef struct density_tile {
    int32_t column, row;                  /* of tiles: over s, over h */
    float value[TILE_CELLS * TILE_CELLS]; /* columns in s, then h upwards */
} density_tile;

typedef struct tile_place {
    int32_t column, row, tile;
} tile_place;

/* The surface of a bed: columns of cells that have a height, ascending. */
typedef struct surface_heights {
    int32_t *column;        /* (count) */
    double *place, *height; /* (count) m */
    size_t count, capacity;
} surface_heights;

typedef struct density_grid {
    int cells;          /* a side */
    double size;        /* m a cell */
    double turned;      /* rad: column axis s = x cos + y sin, height axis h = -x sin + y cos */
    double core;        /* solid fraction of the bed's core: median over cells above half of the densest */
    density_tile *tile; /* (tile_count) in the order in which spheres came to them */
    size_t tile_count, tile_capacity;
    int32_t *slot; /* (slot_count, a power of two) of tiles by their place; -1: free */
    size_t slot_count;
    tile_place *order; /* (tile_count) by column, then upwards */
    surface_heights surface;
    bool lacks_memory;  /* since it began: nothing in it is to be believed */
    double *kernel;     /* (kernels, KERNEL_POINTS) */
    int32_t *kernel_of; /* (species, DEM_MAXIMUM_CLUSTER) of each sphere of a cluster; of a sphere, the first */
    double reach;       /* m, of the widest kernel */
} density_grid;

/* Cells of a quarter of the mean diameter. Errors: DEM_NO_MEMORY. */
dem_status density_grid_init(density_grid *grid, const dem_scene *scene);
void density_grid_clear(density_grid *grid);
/* Adds the volume of each sphere (of a cluster's sphere: its share of the cluster's), projected along the axis and spread over one
 * mean diameter. */
void density_grid_deposit(density_grid *grid, const dem_scene *scene, double turned);
/* Sets the surface: per column, the height where the solid fraction falls, from the bed up, through half the core's. */
void density_grid_find_surface(density_grid *grid);
/* Columns that a bed may have a surface in, at most. */
size_t density_grid_most_columns(const dem_scene *scene);
double density_grid_place(const density_grid *grid, int cell); /* m, centre of a column or row */
int density_grid_cells(const dem_scene *scene);
double mean_diameter(const dem_scene *scene); /* m, of the mean volume */

#endif
