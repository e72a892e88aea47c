/* A team of threads that stay together over many steps, and take their parts of one piece of work after the other. Handing
 * out work and waiting for its end cost a fraction of a microsecond each; a parallel region of its own costs several, a
 * tenth of a small drum's step. */
#ifndef TEAM_H
#define TEAM_H

#include "dem_types.h"

enum { MOST_PARTS = 64 };

/* One part of a piece of work, of `parts`. Parts run side by side and in any order. */
typedef void team_work(void *context, int part, int parts);

/* Runs lead(context) with as many threads at hand as team_run can use. Returns what it returns. */
dem_status team_gather(int threads, dem_status (*lead)(void *context), void *context);
/* All parts (at most MOST_PARTS): by the team that the calling thread leads, or else one after the other. The work itself
 * hands out none. */
void team_run(int parts, team_work *work, void *context);
/* For `threads` of them. */
static inline int team_parts(int threads) { return threads < MOST_PARTS ? threads : MOST_PARTS; }

#endif
