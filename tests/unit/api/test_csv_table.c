/* Claims about tables of numbers as comma-separated text. */
#include "csv_table.h"
#include "requests.h"

typedef json_t *reader(const char *text, size_t length, problem_list *problems);

/* What the reader makes of a text, as JSON; or its problems, one a line. */
static char *read_as_text(reader *read, const char *text)
{
    problem_list problems;
    char *said = calloc(1, 20000);
    assert_true(problem_list_init(&problems));
    json_t *made = read(text, strlen(text), &problems);
    assert_true((made != NULL) == problem_list_is_empty(&problems));
    char *dumped = made ? json_dumps(made, JSON_COMPACT | JSON_REAL_PRECISION(6)) : NULL;
    if (dumped) strcpy(said, dumped);
    size_t p;
    json_t *problem;
    json_array_foreach(problems.errors, p, problem)
    {
        strcat(said, json_string_value(json_object_get(problem, "pointer")));
        strcat(said, " ");
        strcat(said, json_string_value(json_object_get(problem, "detail")));
        strcat(said, "\n");
    }
    free(dumped);
    json_decref(made);
    problem_list_clear(&problems);
    return said;
}

static void expect(reader *read, const char *text, const char *expected)
{
    char *said = read_as_text(read, text);
    assert_string_equal(said, expected);
    free(said);
}

static void a_row_is_a_particle_whatever_the_order_of_the_columns(void **state)
{
    (void)state;
    expect(csv_read_particles, "x,y,z\n1,2,3\n", "[{\"position\":[1.0,2.0,3.0]}]");
    expect(csv_read_particles,
           "\xef\xbb\xbf# a bed\r\n\r\n diameter , z,y,x,vz,species\r\n0.004,3,2,1,-0.5,1\r\n0.005, 0, 0, -1e-3,,0",
           "[{\"diameter\":0.004,\"position\":[1.0,2.0,3.0],\"velocity\":[0.0,0.0,-0.5],\"species\":1.0},"
           "{\"diameter\":0.005,\"position\":[-0.001,0.0,0.0],\"species\":0.0}]");
}

static void everything_wrong_is_told_with_its_line_and_column(void **state)
{
    (void)state;
    expect(csv_read_particles, "", " is empty; must have a header row, and a row of numbers for each entry\n");
    expect(csv_read_particles, "x,y,z\n", " has no particle; must have a row for each below the header row\n");
    expect(csv_read_particles, "x,y,radius\n1,2,3\n",
           "/lines/1/radius is no column; must be one of x, y, z, diameter, species, vx, vy, vz, wx, wy, wz\n"
           "/lines/1/z is missing in the header row, which must name it\n");
    expect(csv_read_particles, "x,y,z,x\n", "/lines/1/x is a column twice\n");
    expect(csv_read_particles, "x,y,z,diameter\n1,2,3,0.004\n1,2\n\n1,,3,4mm\n1,2,99,2\nnan,0x10,inf,0.1\n",
           "/lines/3 has 2 cells; must have 4, as the header row\n"
           "/lines/5/y is \"\"; must be a number in [-20, 20] m\n"
           "/lines/5/diameter is \"4mm\"; must be a number in [1e-05, 1] m\n"
           "/lines/6/z is 99; must be a number in [-20, 20] m\n"
           "/lines/6/diameter is 2; must be a number in [1e-05, 1] m\n"
           "/lines/7/x is \"nan\"; must be a number in [-20, 20] m\n"
           "/lines/7/y is \"0x10\"; must be a number in [-20, 20] m\n"
           "/lines/7/z is \"inf\"; must be a number in [-20, 20] m\n");
    expect(csv_read_particles, "x,y,z,species\n1,2,3,0.5\n1,2,3,16\n",
           "/lines/2/species is 0.5; must be a whole number in [0, 15]\n"
           "/lines/3/species is 16; must be a whole number in [0, 15]\n");
}

static void sieves_have_what_is_below_or_between_them(void **state)
{
    (void)state;
    expect(csv_read_sieves, "size,cumulative\n0.003,0\n0.004,0.25\n0.005,1\n",
           "{\"sizes\":[0.003,0.004,0.005],\"cumulative\":[0.0,0.25,1.0]}");
    expect(csv_read_sieves, "size,share\n0.003,0.25\n0.004,0.75\n0.005,\n",
           "{\"sizes\":[0.003,0.004,0.005],\"shares\":[0.25,0.75]}");
    expect(csv_read_sieves, "size,share\n0.003,0.25\n0.004,0.75\n0.005,0\n",
           "{\"sizes\":[0.003,0.004,0.005],\"shares\":[0.25,0.75]}");
    expect(csv_read_sieves, "size,share\n3,25\n",
           "/lines/2/size is 3; must be a number in [1e-05, 1] m\n/lines/2/share is 25; must be a number in [0, 1]\n");
}

UNIT_TESTS(a_row_is_a_particle_whatever_the_order_of_the_columns, everything_wrong_is_told_with_its_line_and_column,
           sieves_have_what_is_below_or_between_them)
