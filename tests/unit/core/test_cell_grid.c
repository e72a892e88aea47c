/* Claims about the grid of cells: it finds every pair within reach, once, however few cells the period has and however far
 * sizes are apart. */
#include "array.h"
#include "cell_grid.h"
#include "core_claims.h"

/* Over a drum's box. */
static dem_status fill(cell_grid *grid, const spheres *s, double radius, double period, double skin)
{
    const double low[3] = { -radius, -radius, -period / 2 }, high[3] = { radius, radius, period / 2 };
    return cell_grid_fill(grid, s, low, high, period, skin);
}

/* Spheres at random places of a box, two thirds of them of radius `largest`, the others down to its ratio-th part;
 * `spheres` is filled as far as the grid looks at it. */
static void scatter(spheres *s, size_t count, double radius, double period, double largest, double ratio, dice *d)
{
    memset(s, 0, sizeof *s);
    s->mobile_count = count;
    s->place = array_create(count + 1, sizeof *s->place);
    s->full_radius = array_create(count + 1, sizeof *s->full_radius);
    assert_non_null(s->place);
    assert_non_null(s->full_radius);
    for (size_t i = 0; i < count; i++) {
        s->place[i][0] = dice_uniform(d, -radius, radius);
        s->place[i][1] = dice_uniform(d, -radius, radius);
        s->place[i][2] = dice_uniform(d, -period / 2, period / 2);
        s->full_radius[i] = (real)(i % 3 ? largest : largest * pow(ratio, -dice_uniform(d, 0, 1)));
    }
    /* the corners of the box and its seam */
    for (int c = 0; c < 3; c++) s->place[0][c] = c < 2 ? radius : -period / 2;
    for (int c = 0; c < 3; c++) s->place[1][c] = c < 2 ? -radius : nextafter(period / 2, 0);
}

static void discard(cell_grid *grid, spheres *s)
{
    cell_grid_clear(grid);
    free(s->place);
    free(s->full_radius);
}

static double gap_between(const spheres *s, size_t i, size_t j, double period)
{
    double dz = fabs(s->place[i][2] - s->place[j][2]);
    dz = fmin(dz, period - dz);
    return hypot(hypot(s->place[i][0] - s->place[j][0], s->place[i][1] - s->place[j][1]), dz) - s->full_radius[i]
           - s->full_radius[j];
}

static size_t times_found(const int32_t *found, size_t count, size_t j)
{
    size_t times = 0;
    for (size_t k = 0; k < count; k++) times += found[k] == (int32_t)j;
    return times;
}

enum { COUNT = 300, SPARE = 64 };

static void check_box(double radius, double period, double largest, double ratio, double skin)
{
    dice d = { 97 };
    spheres s;
    cell_grid grid;
    scatter(&s, COUNT, radius, period, largest, ratio, &d);
    cell_grid_init(&grid, &s);
    assert_int_equal(fill(&grid, &s, radius, period, skin), DEM_OK);
    size_t near = 0;
    /* rounding may let in, but never leave out */
    const double rounding = 1e-5 * (2 * radius + period);
    for (size_t i = 0; i < COUNT; i++) {
        int32_t found[COUNT + SPARE];
        const size_t count = cell_grid_neighbors(&grid, &s, i, skin, found, COUNT);
        for (size_t j = 0; j < COUNT; j++) {
            const double gap = gap_between(&s, i, j, period);
            const size_t times = times_found(found, count, j);
            if (j <= i || gap > skin + rounding) assert_int_equal(times, 0);
            else if (gap < skin) assert_int_equal(times, 1);
            near += times;
        }
    }
    CHECK_BETWEEN(near, 1, INFINITY);
    discard(&grid, &s);
}

static void every_pair_within_the_skin_is_found_once(void **unused)
{
    (void)unused;
    static const double periods_in_reach[] = { 1.0, 1.7, 2.0, 2.9, 3.0, 3.5, 4.0, 11.3 };
    static const double ratios[] = { 1, 3, 50, 10000 };
    for (int k = 0; k < 8; k++)
        for (int r = 0; r < 4; r++)
            for (double reach = 0.05; reach < 2.5; reach *= 1.7)
                check_box(0.5, periods_in_reach[k] * reach, 0.4 * reach, ratios[r], 0.2 * reach);
}

/* Too little room: what was asked for is counted all the same, and nothing behind the LANES to spare is touched. */
static void with_too_little_room_the_count_is_still_right(void **unused)
{
    (void)unused;
    dice d = { 107 };
    spheres s;
    cell_grid grid;
    scatter(&s, COUNT, 0.5, 0.9, 0.2, 3, &d);
    cell_grid_init(&grid, &s);
    assert_int_equal(fill(&grid, &s, 0.5, 0.9, 0.1), DEM_OK);
    for (size_t i = 0; i < COUNT; i++) {
        int32_t all[COUNT + SPARE], few[10 + LANES + 1];
        for (int k = 0; k <= 10 + LANES; k++) few[k] = -7;
        assert_int_equal(cell_grid_neighbors(&grid, &s, i, 0.1, few, 10), cell_grid_neighbors(&grid, &s, i, 0.1, all, COUNT));
        assert_int_equal(few[10 + LANES], -7);
    }
    discard(&grid, &s);
}

/* x is in the cell'th of `cells` equal parts of low..high, within rounding, or beyond the border that this is at. */
static void check_part(double x, int cell, int cells, double low, double high)
{
    const double size = (high - low) / cells;
    CHECK_BETWEEN(x, cell > 0 ? low + size * cell - 1e-12 : -INFINITY,
                  cell < cells - 1 ? low + size * (cell + 1) + 1e-12 : INFINITY);
}

static size_t cells_of(const grid_level *level)
{
    return (size_t)level->cells[0] * (size_t)level->cells[1] * (size_t)level->cells[2];
}

/* The spheres of one level's cells, which are marked as seen: each where its cell is, none too large or in another octave. */
static void check_level(const cell_grid *grid, const grid_level *level, const spheres *s, double skin, bool *seen)
{
    for (int a = 0; a < 3; a++)
        assert_true(level->cells[a] == 1 || (grid->high[a] - grid->low[a]) / level->cells[a] >= 2 * level->largest + skin);
    for (size_t c = 0; c < cells_of(level); c++)
        for (int32_t k = grid->start[level->first_cell + c]; k < grid->start[level->first_cell + c + 1]; k++) {
            const int32_t i = grid->sphere[k];
            const int z = level->cells[2], y = level->cells[1], cell[3] = { (int)c / z / y, (int)c / z % y, (int)c % z };
            for (int a = 0; a < 3; a++)
                check_part(sphere_place(s, (size_t)i)[a], cell[a], level->cells[a], grid->low[a], grid->high[a]);
            CHECK_BETWEEN(s->full_radius[i], level->largest / 2, level->largest);
            assert_false(seen[i]);
            seen[i] = true;
            assert_true(k == grid->start[level->first_cell + c] || i > grid->sphere[k - 1]);
        }
}

static void every_sphere_is_in_its_cell_once_and_in_order(void **unused)
{
    (void)unused;
    dice d = { 101 };
    spheres s;
    cell_grid grid;
    scatter(&s, COUNT, 0.5, 0.7, 0.01, 30, &d);
    cell_grid_init(&grid, &s);
    for (double skin = 0.3; skin > 0.04; skin *= 0.6) { /* a grid that is used again grows */
        assert_int_equal(fill(&grid, &s, 0.5, 0.7, skin), DEM_OK);
        bool seen[COUNT] = { false };
        CHECK_BETWEEN(grid.level_count, 4, 5); /* octaves of 30 */
        size_t cells = 0;
        for (int l = 0; l < grid.level_count; l++) {
            assert_int_equal(grid.level[l].first_cell, cells);
            cells += cells_of(&grid.level[l]);
            check_level(&grid, &grid.level[l], &s, skin, seen);
        }
        assert_int_equal(grid.start[0], 0);
        assert_int_equal(grid.start[cells], COUNT);
        for (int i = 0; i < COUNT; i++) assert_true(seen[i]);
    }
    discard(&grid, &s);
}

/* Three hundred spheres, a third of them down to a thousandth of the others: not a thousand million cells. */
static void cells_are_no_more_than_some_for_each_sphere(void **unused)
{
    (void)unused;
    dice d = { 109 };
    spheres s;
    cell_grid grid;
    scatter(&s, COUNT, 0.5, 0.7, 0.05, 1000, &d);
    cell_grid_init(&grid, &s);
    assert_int_equal(fill(&grid, &s, 0.5, 0.7, 1e-5), DEM_OK);
    size_t cells = 0;
    for (int l = 0; l < grid.level_count; l++) cells += cells_of(&grid.level[l]);
    CHECK_BETWEEN(cells, 1, 32 * COUNT);
    discard(&grid, &s);
}

/* Pairs whose gap is the skin but for a thousandth of the rounding, crowded far from the axis. */
static void crowd(spheres *s, double corner, double width, double radius, double skin, dice *d)
{
    for (size_t i = 0; i < COUNT; i++) {
        s->full_radius[i] = (real)radius;
        double apart[3], length = 0;
        for (int c = 0; c < 3; c++) {
            s->place[i][c] = (c < 2 ? corner : width / 2) - dice_uniform(d, 0, width);
            apart[c] = dice_uniform(d, -1, 1);
            length = hypot(length, apart[c]);
        }
        if (i % 2 == 0) continue;
        const double distance = 2 * (double)s->full_radius[i] + skin - 1e-11;
        for (int c = 0; c < 3; c++) s->place[i][c] = s->place[i - 1][c] + distance * apart[c] / length;
    }
}

/* Three hundred spheres in a millionth of the box: their cells are of their size, and rounding is that of the wide box. */
static void a_crowd_in_a_wide_box_has_cells_of_its_size_and_all_its_pairs(void **unused)
{
    (void)unused;
    enum { PERIODS = 2 };
    static const double period_of[PERIODS] = { 0, 0.01 };
    const double radius = 1e-4, skin = 5e-5;
    for (int p = 0; p < PERIODS; p++) {
        dice d = { 113 };
        spheres s;
        cell_grid grid;
        scatter(&s, COUNT, 0.5, 0.7, radius, 1, &d);
        crowd(&s, 0.35, 0.005, radius, skin, &d);
        cell_grid_init(&grid, &s);
        const double low[3] = { -0.5, -0.5, -0.5 * (p ? period_of[p] : 1) }, high[3] = { 0.5, 0.5, -low[2] };
        assert_int_equal(cell_grid_fill(&grid, &s, low, high, period_of[p], skin), DEM_OK);
        for (int a = 0; a < 3; a++) CHECK_BETWEEN(1 / grid.level[0].inverse_size[a], 2 * radius + skin, 2 * (2 * radius + skin));
        for (size_t i = 0; i < COUNT; i += 2) {
            int32_t found[COUNT + SPARE];
            assert_int_equal(times_found(found, cell_grid_neighbors(&grid, &s, i, skin, found, COUNT), i + 1), 1);
        }
        discard(&grid, &s);
    }
}

/* A place that is not a number, or far outside, gets some cell and is found by the checks of places. */
static void a_place_outside_or_not_a_number_gets_a_cell_of_the_grid(void **unused)
{
    (void)unused;
    dice d = { 103 };
    spheres s;
    cell_grid grid;
    scatter(&s, 5, 0.5, 0.7, 0.01, 1, &d);
    cell_grid_init(&grid, &s);
    s.place[2][0] = NAN;
    s.place[3][1] = 1e300;
    s.place[4][2] = -INFINITY;
    assert_int_equal(fill(&grid, &s, 0.5, 0.7, 0.1), DEM_OK);
    assert_int_equal(grid.start[cells_of(&grid.level[0])], 5);
    int32_t found[5 + SPARE];
    for (size_t i = 0; i < 5; i++) cell_grid_neighbors(&grid, &s, i, 0.1, found, 5);
    discard(&grid, &s);
}

UNIT_TESTS(every_pair_within_the_skin_is_found_once, with_too_little_room_the_count_is_still_right,
           every_sphere_is_in_its_cell_once_and_in_order, cells_are_no_more_than_some_for_each_sphere,
           a_crowd_in_a_wide_box_has_cells_of_its_size_and_all_its_pairs, a_place_outside_or_not_a_number_gets_a_cell_of_the_grid)
