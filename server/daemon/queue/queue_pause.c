#include "queue_pause.h"

/* s: the longest is also how late the queue may notice that the machine is sound again. */
#define SHORTEST_PAUSE 1.0
#define LONGEST_PAUSE 30.0

void queue_pause_add(queue_pause *pause, double now)
{
    /* Workers that ran side by side often end of the same want: that is one setback. */
    if (queue_pause_holds(pause, now)) return;
    pause->length = pause->setbacks == 0 ? SHORTEST_PAUSE : 2.0 * pause->length;
    if (pause->length > LONGEST_PAUSE) pause->length = LONGEST_PAUSE;
    pause->since = now;
    pause->setbacks++;
}

bool queue_pause_holds(const queue_pause *pause, double now) { return pause->setbacks > 0 && now - pause->since < pause->length; }

bool queue_pause_is_trying(const queue_pause *pause, double started) { return pause->setbacks > 0 && started > pause->since; }

void queue_pause_note_well(queue_pause *pause, double started, double now)
{
    if (queue_pause_is_trying(pause, started) && now - started > pause->length) pause->setbacks = 0;
}

void queue_pause_note_end(queue_pause *pause, double started)
{
    if (queue_pause_is_trying(pause, started)) pause->setbacks = 0;
}
