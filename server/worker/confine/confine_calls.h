/* System calls, by seccomp: all that are not in a list are refused. */
#ifndef CONFINE_CALLS_H
#define CONFINE_CALLS_H

#include <stdbool.h>

/* may_exec: the process will still become another program, and complete this there. Where the kernel has no seccomp, *confined
 * is false. False: errno says what the machine lacked. */
bool confine_calls(bool may_exec, bool *confined);
/* The number of a call that was refused; -1: none was. */
long confine_calls_refused(void);

#endif
