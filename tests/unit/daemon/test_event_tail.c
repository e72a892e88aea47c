/* Reading events.ndjson while somebody writes it. */
#include <unistd.h>

#include "claims.h"
#include "event_tail.h"

static FILE *file_with(const char *text)
{
    FILE *file = tmpfile();
    assert_non_null(file);
    fputs(text, file);
    fflush(file);
    return file;
}

static void a_line_counts_when_it_is_whole(void **state)
{
    (void)state;
    FILE *file = file_with("{\"event\":\"sample\",\"number\":0}\n{\"event\":\"sample\",\"num");
    event_batch batch;
    assert_true(event_tail_read(fileno(file), 0, &batch));
    assert_int_equal(json_array_size(batch.samples), 1);
    const int64_t end = batch.end;
    event_batch_clear(&batch);
    fputs("ber\":1}\n", file);
    fflush(file);
    assert_true(event_tail_read(fileno(file), end, &batch));
    assert_int_equal(json_array_size(batch.samples), 1);
    assert_int_equal(json_integer_value(json_object_get(json_array_get(batch.samples, 0), "number")), 1);
    event_batch_clear(&batch);
    fclose(file);
}

static void the_latest_progress_counts_and_rubbish_does_not(void **state)
{
    (void)state;
    FILE *file =
        file_with("{\"event\":\"progress\",\"progress\":10,\"eta_seconds\":5,\"phase\":\"settling\"}\nrubbish\n[]\n\n"
                  "{\"event\":\"progress\",\"progress\":20.5,\"eta_seconds\":null,\"phase\":\"rotating\"}\n{\"event\":7}\n");
    event_batch batch;
    assert_true(event_tail_read(fileno(file), 0, &batch));
    assert_true(batch.progress == 20.5 && isnan(batch.eta_seconds) && isnan(batch.speed));
    assert_string_equal(batch.phase, "rotating");
    assert_false(batch.more);
    event_batch_clear(&batch);
    fclose(file);
}

/* What is cut ends up in answers, and JSON holds whole characters alone. */
static void a_phase_that_is_too_long_is_not_cut_within_a_character(void **state)
{
    (void)state;
    for (int before = 0; before < 4; before++) {
        char text[200];
        snprintf(text, sizeof text, "{\"event\":\"progress\",\"phase\":\"%.*s%s\"}\n", before, "abcd",
                 "\u20ac\u20ac\u20ac\u20ac\u20ac\u20ac\u20ac\u20ac\u20ac");
        FILE *file = file_with(text);
        event_batch batch;
        assert_true(event_tail_read(fileno(file), 0, &batch));
        assert_int_equal(strlen(batch.phase), before + 3 * ((23 - before) / 3));
        json_t *told = json_string(batch.phase);
        assert_non_null(told);
        json_decref(told);
        event_batch_clear(&batch);
        fclose(file);
    }
}

static void a_new_attempt_forgets_an_earlier_failure(void **state)
{
    (void)state;
    FILE *file = file_with("{\"event\":\"failure\",\"message\":\"old\"}\n{\"event\":\"start\"}\n");
    event_batch batch;
    assert_true(event_tail_read(fileno(file), 0, &batch));
    assert_null(batch.failure);
    event_batch_clear(&batch);
    fclose(file);
}

static void checkpoints_come_in_order_with_their_attempts(void **state)
{
    (void)state;
    FILE *file = file_with("{\"event\":\"checkpoint\",\"step\":300,\"attempt\":1}\n{\"event\":\"start\",\"attempt\":2}\n"
                           "{\"event\":\"checkpoint\",\"step\":200,\"attempt\":2}\n");
    const int64_t step[] = { 300, 200 }, attempt[] = { 1, 2 };
    event_batch batch;
    assert_true(event_tail_read(fileno(file), 0, &batch));
    assert_int_equal(json_array_size(batch.checkpoints), 2);
    for (size_t i = 0; i < 2; i++) {
        const json_t *event = json_array_get(batch.checkpoints, i);
        assert_int_equal(json_integer_value(json_object_get(event, "step")), step[i]);
        assert_int_equal(json_integer_value(json_object_get(event, "attempt")), attempt[i]);
    }
    event_batch_clear(&batch);
    fclose(file);
}

static void a_long_file_comes_in_pieces_without_loss(void **state)
{
    (void)state;
    FILE *file = tmpfile();
    const int count = 40000; /* some 2 MB, twice what one read takes */
    for (int i = 0; i < count; i++) fprintf(file, "{\"event\":\"sample\",\"number\":%d,\"values\":{\"angle_deg\":20}}\n", i);
    fflush(file);
    int next = 0, reads = 0;
    bool more = true;
    for (int64_t offset = 0; more; reads++) {
        event_batch batch;
        assert_true(event_tail_read(fileno(file), offset, &batch));
        for (size_t i = 0; i < json_array_size(batch.samples); i++)
            assert_int_equal(json_integer_value(json_object_get(json_array_get(batch.samples, i), "number")), next++);
        offset = batch.end;
        more = batch.more;
        event_batch_clear(&batch);
    }
    assert_int_equal(next, count);
    assert_true(reads > 1);
    fclose(file);
}

UNIT_TESTS(a_line_counts_when_it_is_whole, the_latest_progress_counts_and_rubbish_does_not,
           a_phase_that_is_too_long_is_not_cut_within_a_character, a_new_attempt_forgets_an_earlier_failure,
           checkpoints_come_in_order_with_their_attempts, a_long_file_comes_in_pieces_without_loss)
