/* How long measuring the machine's speed may take. Whoever starts it says so by an alarm, which holds over the exec and ends the
 * process; without one there is no limit. Of that time a quarter is kept for what is made of an unfinished measurement. */
#ifndef MEASURING_TIME_H
#define MEASURING_TIME_H

#include <stdbool.h>

/* At the beginning. */
void measuring_time_begin(void);
/* To be asked often. Where an idle process got too little in the first third of the time, it becomes one like any other. */
bool measuring_time_is_left(void);

#endif
