/* Claims about looking for a piece in all texts of a pool, also in those that it gets later. */
#include <stdlib.h>
#include <string.h>

#include "claims.h"
#include "job_index_rows.h"

static unsigned next_random(unsigned long long *state)
{
    *state = *state * 6364136223846793005ULL + 1442695040888963407ULL;
    return (unsigned)(*state >> 33);
}

static void make_text(unsigned long long *state, char *text, unsigned longest)
{
    static const char letters[] = "aAbB[{0\"\x5f\x1f"; /* few, so that pieces are found; some differ by a letter's case bit alone */
    const unsigned length = next_random(state) % (longest + 1);
    for (unsigned i = 0; i < length; i++) text[i] = letters[next_random(state) % (sizeof letters - 1)];
    text[length] = '\0';
}

static void every_text_that_holds_the_piece_is_marked_and_no_other(void **state)
{
    (void)state;
    text_pool pool = { .count = 0 };
    text_search search = { .marks = NULL };
    unsigned long long chance = 1;
    char text[64], wanted[8] = "a";
    size_t found = 0;
    for (int round = 0; round < 3000; round++) {
        uint32_t unused;
        for (unsigned k = next_random(&chance) % 3; k > 0; k--) {
            make_text(&chance, text, 60);
            assert_true(text_pool_add(&pool, text, &unused));
        }
        if (next_random(&chance) % 3 == 0) do
                make_text(&chance, wanted, 5); /* else the same again */
            while (!wanted[0]);
        const uint8_t *marks = text_search_marks(&search, &pool, wanted);
        assert_non_null(marks);
        for (uint32_t t = 0; t < pool.count; t++) {
            assert_int_equal(marks[t], strcasestr(text_pool_text(&pool, t), wanted) != NULL);
            found += marks[t];
        }
        if (round % 500 != 499) continue;
        text_pool_clear(&pool);
        text_search_clear(&search);
    }
    assert_true(found > 10000);
    text_pool_clear(&pool);
    text_search_clear(&search);
}

UNIT_TESTS(every_text_that_holds_the_piece_is_marked_and_no_other)
