/* Claims about the search for overlaps among particles that are placed one by one: it finds what comparing each with each
 * finds, and takes no longer for beds that were made to be slow. */
#include <time.h>

#include "claims.h"
#include "start_overlap.h"

static const double MOST = 0.05;

/* Each sphere with each: the largest overlap of every two particles, in a matrix. */
static size_t pairs_by_hand(const placed_sphere *s, size_t count, double period, size_t particles, bool *pairs)
{
    size_t found = 0;
    memset(pairs, 0, particles * particles * sizeof *pairs);
    for (size_t i = 0; i < count; i++)
        for (size_t j = 0; j < i; j++) {
            const double turns = period > 0 ? round((s[i].x[2] - s[j].x[2]) / period) : 0;
            const double dx = s[i].x[0] - s[j].x[0], dy = s[i].x[1] - s[j].x[1], dz = s[i].x[2] - s[j].x[2] - turns * period;
            const size_t low = s[i].particle < s[j].particle ? s[i].particle : s[j].particle;
            const size_t high = s[i].particle + s[j].particle - low;
            const double overlap = s[i].radius + s[j].radius - sqrt(dx * dx + dy * dy + dz * dz);
            if (low == high || overlap <= MOST * 2 * fmin(s[i].radius, s[j].radius)) continue;
            found += !pairs[low * particles + high];
            pairs[low * particles + high] = true;
        }
    return found;
}

/* `of_each` spheres a particle around its centre; diameters over `octaves` powers of two; a box 4 cells high or less along
 * the periodic axis where `period` is small. */
static size_t expect_the_same_pairs(dice *d, size_t particles, size_t of_each, double octaves, double period, double width)
{
    const size_t count = particles * of_each, room = particles * particles;
    placed_sphere *s = calloc(count, sizeof *s);
    placed_pair *found = calloc(room, sizeof *found);
    bool *expected = calloc(room, sizeof *expected);
    for (size_t p = 0; p < particles; p++) {
        const double centre[3] = { dice_uniform(d, -width, width), dice_uniform(d, -width, width), dice_uniform(d, -width, width) };
        for (size_t k = 0; k < of_each; k++) {
            placed_sphere *one = &s[p * of_each + k];
            one->particle = p;
            one->radius = 0.5e-3 * exp2(-dice_uniform(d, 0, octaves));
            for (int c = 0; c < 3; c++) one->x[c] = centre[c] + (of_each > 1 ? dice_uniform(d, -1e-3, 1e-3) : 0);
        }
    }
    const size_t by_hand = pairs_by_hand(s, count, period, particles, expected);
    const size_t pairs = start_overlaps_find(s, count, period, MOST, found, room);
    assert_int_equal(pairs, by_hand);
    for (size_t k = 0; k < pairs; k++) {
        assert_true(found[k].low < found[k].high && expected[found[k].low * particles + found[k].high]);
        assert_true(found[k].overlap > found[k].most);
    }
    free(s);
    free(found);
    free(expected);
    return by_hand;
}

static void the_pairs_are_those_of_comparing_each_with_each(void **unused)
{
    (void)unused;
    dice d = { 5 };
    size_t all = 0;
    for (int turn = 0; turn < 20; turn++) {
        all += expect_the_same_pairs(&d, 300, 1, 0, 0, 3e-3);
        all += expect_the_same_pairs(&d, 300, 1, 7, 0, 1e-3);      /* sizes of 1 to 128 */
        all += expect_the_same_pairs(&d, 80, 6, 3, 0, 5e-3);       /* clusters */
        all += expect_the_same_pairs(&d, 300, 1, 2, 3.1e-3, 4e-3); /* a periodic axis of three cells, */
        all += expect_the_same_pairs(&d, 300, 1, 2, 4.7e-3, 6e-3); /* of more, and places beyond it, */
        all += expect_the_same_pairs(&d, 200, 1, 2, 1.3e-3, 4e-3); /* of one */
        all += expect_the_same_pairs(&d, 60, 5, 2, 11e-3, 12e-3);
    }
    CHECK_BETWEEN((double)all, 2000, 100000); /* neither none nor all of them */
}

/* s of processor time, and how many pairs were found. */
static double seconds_for(placed_sphere *s, size_t count, double period, size_t *found)
{
    placed_pair pairs[21];
    const clock_t start = clock();
    *found = start_overlaps_find(s, count, period, MOST, pairs, 21);
    free(s);
    return (double)(clock() - start) / CLOCKS_PER_SEC;
}

/* Comparing each with each takes 2e11 comparisons, some minutes. */
static void a_bed_that_was_made_to_be_slow_is_not(void **unused)
{
    (void)unused;
    enum { PARTICLES = 10000, OF_EACH = 64, ALL = PARTICLES * OF_EACH };
    size_t found;
    placed_sphere *s = calloc(ALL, sizeof *s);
    for (size_t i = 0; i < ALL; i++) /* all in one spot */
        s[i] = (placed_sphere){ .x = { 0, 0, 1e-5 * (double)(i % OF_EACH) }, .radius = 0.5e-3, .particle = i / OF_EACH };
    CHECK_BETWEEN(seconds_for(s, ALL, 0.012, &found), 0, 3);
    assert_int_equal(found, 21);
    s = calloc(ALL, sizeof *s);
    for (size_t i = 0; i < ALL; i++) /* each particle's spheres in one spot, particles side by side in a plane */
        s[i] = (placed_sphere){ .x = { 1e-3 * (double)(i / OF_EACH % 100), 1e-3 * (double)(i / OF_EACH / 100),
                                       1e-8 * (double)(i % OF_EACH) },
                                .radius = 0.5e-3,
                                .particle = i / OF_EACH };
    CHECK_BETWEEN(seconds_for(s, ALL, 0.012, &found), 0, 10);
    assert_int_equal(found, 0);
    s = calloc(PARTICLES, sizeof *s);
    for (size_t i = 0; i < PARTICLES; i++) /* grains of dust in the shade of one boulder, which they don't touch */
        s[i] = (placed_sphere){ .x = { 2e-5 * (double)(i % 100), 2e-5 * (double)(i / 100), 0 }, .radius = 0.5e-5, .particle = i };
    s[0] = (placed_sphere){ .x = { 0, 0, 0.51 }, .radius = 0.5, .particle = 0 };
    CHECK_BETWEEN(seconds_for(s, PARTICLES, 0, &found), 0, 1);
    assert_int_equal(found, 0);
}

UNIT_TESTS(the_pairs_are_those_of_comparing_each_with_each, a_bed_that_was_made_to_be_slow_is_not)
