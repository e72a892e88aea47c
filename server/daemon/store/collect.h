/* `reposed collect`: what the jobs of a study that `repose split` has written came to, wherever they ran: DIR/results.csv as a service
 * gives it, and DIR/reposed.sqlite with the service's tables. Made anew each time; jobs may be at work meanwhile. */
#ifndef COLLECT_H
#define COLLECT_H

#include <stdbool.h>

/* Tells on stdout what there is. False: it is logged. */
bool collect_study(const char *folder);

#endif
