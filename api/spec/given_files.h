/* Parts of a specification that stand elsewhere: a bed that was sent before, or, of `repose run`, a table in a file. They take their
 * places before anything is read, so that a canonical specification holds all it needs. */
#ifndef GIVEN_FILES_H
#define GIVEN_FILES_H

#include "job_spec.h"

/* The inputs with start's bed or file of particles, and the files of size distributions, in their places. Takes the reference to
 * inputs; problems say what could not be had. New reference. */
json_t *given_files_take(json_t *inputs, const start_source *source, problem_list *problems);

#endif
