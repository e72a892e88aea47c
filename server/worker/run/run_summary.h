/* What a person at a terminal sees of a run: a line that moves, and at the end the result in words. */
#ifndef RUN_SUMMARY_H
#define RUN_SUMMARY_H

#include <jansson.h>

#include "dem.h"
#include "progress.h"

/* time: s since the test began; negative before. */
void terminal_progress(const progress_report *report, const char *phase, double time);
void terminal_end_progress(void);

/* result: the results document. folder: as the user named it. */
void terminal_summary(const json_t *result, const char *folder); /* of a drum */

/* Its parts. */
void summary_angle(const json_t *result);
void summary_fact(const json_t *result, const char *output, const char *name, const char *label, const char *unit);
void summary_run(const json_t *result, const char *folder);

#endif
