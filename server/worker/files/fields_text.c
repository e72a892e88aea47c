/* {"rows":..,"columns":..,"cell_size":..,"first_cell":[..,..],"frames":..,
 *  "fields":{"solid_fraction":{"unit":"","components":1,"values":[..]},...}}
 * Values as in fields.hdf: row by row, the components of a cell side by side, null where nothing was seen, or too little. Four digits:
 * no colour tells more. */
#include "fields_text.h"

#include <math.h>
#include <stdio.h>

#include "file_publish.h"
#include "job_folder.h"

static void print_field(FILE *stream, const field_grid *grid, const field_text *field)
{
    fprintf(stream, "\"%s\":{\"unit\":\"%s\",\"components\":%zu,\"values\":[", field->name, field->unit, field->components);
    for (size_t i = 0; i < grid->rows * grid->columns * field->components; i++) {
        if (i > 0) fputc(',', stream);
        if (isfinite(field->values[i])) fprintf(stream, "%.4g", field->values[i]);
        else fputs("null", stream);
    }
    fputs("]}", stream);
}

bool fields_text_write(const field_grid *grid, const field_text *field, size_t fields)
{
    char *text = NULL;
    size_t length = 0;
    FILE *stream = open_memstream(&text, &length);
    if (stream) {
        fprintf(stream, "{\"rows\":%zu,\"columns\":%zu,\"cell_size\":%.9g,\"first_cell\":[%.9g,%.9g],\"frames\":%.0f,\"fields\":{",
                grid->rows, grid->columns, grid->size, grid->corner[0], grid->corner[1], grid->frames);
        for (size_t f = 0; f < fields; f++) {
            if (f > 0) fputc(',', stream);
            print_field(stream, grid, &field[f]);
        }
        fputs("}}\n", stream);
    }
    return file_write_stream(JOB_FIELDS_TEXT_FILE, stream, &text, &length);
}
