/* What a person at a terminal sees of a run: a line that moves, and at the end the result in words. */
#ifndef RUN_SUMMARY_H
#define RUN_SUMMARY_H

#include <jansson.h>

#include "dem.h"
#include "progress.h"

void terminal_progress(const progress_report *report, dem_phase phase, double time);
void terminal_end_progress(void);

/* result: the results document. folder: as the user named it. */
void terminal_summary(const json_t *result, const char *folder);

#endif
