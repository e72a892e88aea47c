/* Claims about teams of threads: every part of every piece of work is done once, whoever is there to do it, and when team_run
 * returns all of it is done. */
#include "core_claims.h"
#include "team.h"

enum { PARTS = 7, ROUNDS = 3000 };

typedef struct sums {
    long count[MOST_PARTS]; /* how often each part was done */
    long seen[MOST_PARTS];  /* what part k found of the others' work of the round before */
    int parts;
    int rounds;
} sums;

static void count_part(void *context, int part, int parts)
{
    sums *const s = context;
    s->count[part]++;
    s->parts = parts; /* all write the same */
}

/* After count_part everywhere: what it left is there to be read by any other part. */
static void look_at_next(void *context, int part, int parts)
{
    sums *const s = context;
    s->seen[part] += s->count[(part + 1) % parts];
}

static dem_status count_rounds(void *context)
{
    sums *const s = context;
    for (int k = 0; k < s->rounds; k++) {
        team_run(PARTS, count_part, s);
        team_run(PARTS, look_at_next, s);
    }
    return DEM_NO_MEMORY; /* whatever it returns comes out */
}

static void check_sums(const sums *s)
{
    const long n = s->rounds;
    assert_int_equal(s->parts, PARTS);
    for (int p = 0; p < MOST_PARTS; p++) {
        assert_int_equal(s->count[p], p < PARTS ? n : 0);
        assert_int_equal(s->seen[p], p < PARTS ? n * (n + 1) / 2 : 0); /* 1 + 2 + ... + n */
    }
}

/* Fewer threads than parts, as many, more, and more than there can be processors for: then they take turns. */
static void every_part_is_done_once_by_any_number_of_threads(void **unused)
{
    (void)unused;
    static const int threads[] = { 1, 2, 3, PARTS, 12 };
    for (int k = 0; k < 5; k++) {
        sums s = { .rounds = k < 3 ? ROUNDS : ROUNDS / 10 };
        assert_int_equal(team_gather(threads[k], count_rounds, &s), DEM_NO_MEMORY);
        check_sums(&s);
    }
}

static void without_a_team_parts_are_done_one_after_the_other(void **unused)
{
    (void)unused;
    sums s = { .rounds = 10 };
    assert_int_equal(count_rounds(&s), DEM_NO_MEMORY);
    check_sums(&s);
    assert_int_equal(team_parts(1000000), MOST_PARTS);
}

static dem_status run_many_parts(void *context)
{
    team_run(MOST_PARTS, count_part, context);
    return DEM_OK;
}

static void as_many_parts_as_there_may_be(void **unused)
{
    (void)unused;
    sums s = { 0 };
    assert_int_equal(team_gather(2, run_many_parts, &s), DEM_OK);
    for (int p = 0; p < MOST_PARTS; p++) assert_int_equal(s.count[p], 1);
}

UNIT_TESTS(every_part_is_done_once_by_any_number_of_threads, without_a_team_parts_are_done_one_after_the_other,
           as_many_parts_as_there_may_be)
