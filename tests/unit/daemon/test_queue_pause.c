/* How long the queue stands still while the machine can't run jobs. */
#include "claims.h"
#include "queue_pause.h"

static void intervals_double_up_to_half_a_minute(void **state)
{
    (void)state;
    static const double length[] = { 1, 2, 4, 8, 16, 30, 30, 30 };
    queue_pause pause = { 0 };
    double now = 100.0;
    assert_false(queue_pause_holds(&pause, now));
    for (size_t i = 0; i < sizeof length / sizeof length[0]; i++) {
        queue_pause_add(&pause, now);
        assert_true(queue_pause_holds(&pause, now + length[i] - 0.01));
        assert_false(queue_pause_holds(&pause, now + length[i] + 0.01));
        now += length[i] + 0.01;
    }
}

static void workers_that_end_side_by_side_are_one_setback(void **state)
{
    (void)state;
    queue_pause pause = { 0 };
    for (int worker = 0; worker < 20; worker++) queue_pause_add(&pause, 100.0 + 0.01 * worker);
    assert_false(queue_pause_holds(&pause, 101.01));
}

static void only_a_worker_that_was_started_after_it_tells_that_the_machine_is_sound(void **state)
{
    (void)state;
    queue_pause pause = { 0 };
    queue_pause_add(&pause, 100.0);
    queue_pause_add(&pause, 101.5); /* 2 s */
    queue_pause_note_end(&pause, 99.0);
    queue_pause_note_well(&pause, 99.0, 200.0);
    assert_true(queue_pause_is_trying(&pause, 103.6));
    queue_pause_note_well(&pause, 103.6, 104.0); /* not yet for as long as the pause was */
    assert_true(queue_pause_is_trying(&pause, 103.6));
    queue_pause_note_well(&pause, 103.6, 106.0);
    assert_false(queue_pause_is_trying(&pause, 103.6));
    queue_pause_add(&pause, 300.0);
    queue_pause_note_end(&pause, 302.0);
    queue_pause_add(&pause, 400.0); /* from the shortest on again */
    assert_false(queue_pause_holds(&pause, 401.01));
}

UNIT_TESTS(intervals_double_up_to_half_a_minute, workers_that_end_side_by_side_are_one_setback,
           only_a_worker_that_was_started_after_it_tells_that_the_machine_is_sound)
