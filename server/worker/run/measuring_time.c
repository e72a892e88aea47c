#include "measuring_time.h"

#include <math.h>
#include <sched.h>
#include <sys/time.h>
#include <time.h>

static double begin, limit = INFINITY; /* s of the monotonic clock */

static double monotonic_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

void measuring_time_begin(void)
{
    struct itimerval alarm;
    begin = monotonic_seconds();
    const double left =
        getitimer(ITIMER_REAL, &alarm) == 0 ? (double)alarm.it_value.tv_sec + 1e-6 * (double)alarm.it_value.tv_usec : 0.0;
    limit = left > 0.0 ? begin + 0.75 * left : INFINITY;
}

bool measuring_time_is_left(void)
{
    const struct sched_param usual = { .sched_priority = 0 };
    const double now = monotonic_seconds();
    if (now - begin > (limit - begin) * 4.0 / 9.0 && sched_getscheduler(0) == SCHED_IDLE)
        sched_setscheduler(0, SCHED_OTHER, &usual);
    return now < limit;
}
