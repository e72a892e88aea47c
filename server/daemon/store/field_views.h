/* Views that are made from the rows of inputs and results at each start. */
#ifndef FIELD_VIEWS_H
#define FIELD_VIEWS_H

#include <sqlite3.h>

#include "text_buffer.h"

/* Between begin and commit: the view, where it is not as this statement, which begins "CREATE VIEW <name>", makes it. Clears sql.
 * False: the connection tells why, or there was no memory. */
bool field_view_make(sqlite3 *writer, const char *name, text_buffer *sql);

/* ", document->>'...' AS chord_deg" of all other definitions of the angle; of the table result. */
void field_views_add_angles(text_buffer *sql);

/* CREATE VIEW input_field: process, name, path, default_value and unit of each input; and job_input: the inputs of all jobs. */
void field_views_write_input_field(text_buffer *sql);
void field_views_write_job_input(text_buffer *sql);
/* CREATE VIEW of stage, one row a stage of a drum's rotation. */
void field_views_write_stage(text_buffer *sql);

#endif
