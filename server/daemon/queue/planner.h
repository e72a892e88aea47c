/* Plans calibrations: where all jobs of one have ended, it gives the planner program what they told, and keeps what that says, which
 * is further jobs or the answer (api/CALIBRATION.md).
 *
 *   jobs have ended -> request and runs -> `repose plan -` -> cases -> jobs, in one commit -> ...
 *                                                          -> answer
 *
 * It decides nothing itself, and keeps nothing between two plans but what is in the tables. So a planner or a daemon that dies leaves
 * no trace: the same runs are planned again, and give the same cases. One calibration is planned at a time, by a thread of its own,
 * which forks: it lives as long as the daemon, so that its children may end with it. */
#ifndef PLANNER_H
#define PLANNER_H

#include "service.h"

typedef struct run_planner run_planner;

/* program: the worker program. NULL: no thread is to be had (logged). The service lives longer. */
run_planner *planner_start(api_service *service, const char *program, bool confine);
/* From any thread: a job has ended, or there is something to plan. NULL is nothing. */
void planner_wake(run_planner *planner);
/* A plan that is being made is given up. */
void planner_stop(run_planner *planner);

#endif
