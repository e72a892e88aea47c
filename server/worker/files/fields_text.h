/* fields.json: what fields.hdf has, as one short document for programs that draw it. */
#ifndef FIELDS_TEXT_H
#define FIELDS_TEXT_H

#include <stdbool.h>
#include <stddef.h>

/* What all fields of a file share. */
typedef struct field_grid {
    size_t rows, columns;
    double size;      /* m: side of a cell */
    double corner[2]; /* m: middle of the first cell */
    double thickness; /* m: of what is seen from the side */
    double frames;    /* that the means are over */
} field_grid;

typedef struct field_text {
    const char *name, *unit; /* unit "": a share or a number */
    const double *values;    /* (rows, columns, components) */
    size_t components;
} field_text;

/* False: logged. */
bool fields_text_write(const field_grid *grid, const field_text *field, size_t fields);

#endif
