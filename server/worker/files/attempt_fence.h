/* Who may write in a job folder that several machines see: the one start of the job that the folder's newest fence names. A lock
 * would not do: it is inherited by processes of one machine, and not every network file system has it.
 *
 * fence.000007 is made by the seventh start itself, where it is not there yet: so of two workers of the same start one runs. Whoever
 * finds a newer one leaves. Each line says what became of that start:
 *     taken     a worker is at work
 *     stop      it is asked to save its state and to leave
 *     leave     it is to leave at once, and to write nothing more: another start has the folder
 *     left      it has left
 *     end 0     by that exit code, as the script tells that had started it */
#ifndef ATTEMPT_FENCE_H
#define ATTEMPT_FENCE_H

#include <stdbool.h>

typedef enum fence_state { FENCE_HOLDS, FENCE_STOPS, FENCE_IS_LOST } fence_state;

/* Start 0 stands for none: nothing is fenced, and all holds. False: the start is another worker's, was forbidden, or there is a newer
 * one; or no file can be made, which is logged. Tells the workers of earlier starts to leave, and waits some seconds for that. */
bool attempt_fence_take(const char *folder, int start);
/* In the job folder. Reads the file anew, since a network file system tells what others wrote to whoever opens it. */
fence_state attempt_fence_look(int start);
/* The last thing that the worker of that start does. */
void attempt_fence_leave(int start);

#endif
