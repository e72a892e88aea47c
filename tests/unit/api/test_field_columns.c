/* Claims about what the rows of inputs and results say of the columns of SQL. */
#include "claims.h"
#include "field_columns.h"

static int gather(void **state)
{
    static field_columns columns;
    *state = &columns;
    return field_columns_gather(&columns) ? 0 : -1;
}

static int clear(void **state)
{
    field_columns_clear(*state);
    return 0;
}

static const field_column *find(const field_columns *columns, const char *shown_as)
{
    for (size_t c = 0; c < columns->count; c++)
        if (strcmp(columns->column[c].shown_as, shown_as) == 0) return &columns->column[c];
    return NULL;
}

static void each_column_stands_once_in_its_table(void **state)
{
    const field_columns *columns = *state;
    for (size_t c = 0; c < columns->count; c++)
        for (size_t other = 0; other < c; other++)
            assert_false(strcmp(columns->column[c].table, columns->column[other].table) == 0
                         && strcmp(columns->column[c].name, columns->column[other].name) == 0);
    assert_true(columns->count > 100);
}

/* Columns of one name are one column in the view: they have one place there, one type, and no other name has the place. */
static void each_place_in_the_view_and_in_studies_has_one_name(void **state)
{
    const field_columns *columns = *state;
    for (size_t c = 0; c < columns->count; c++) {
        for (size_t other = 0; other < c; other++) {
            const field_column *a = &columns->column[c], *b = &columns->column[other];
            const bool same = strcmp(a->shown_as, b->shown_as) == 0;
            if (a->in_view && b->in_view) assert_true(same == (a->in_view == b->in_view));
            if (a->in_study && b->in_study) assert_true(same == (a->in_study == b->in_study));
            if (same && a->in_view && b->in_view) assert_string_equal(a->type, b->type);
        }
    }
}

static void what_a_runs_error_is_named_by_is_a_column(void **state)
{
    const field_columns *columns = *state;
    size_t errors = 0;
    for (size_t c = 0; c < columns->count; c++) {
        const field_column *column = &columns->column[c];
        if (!column->run_error) continue;
        assert_non_null(find(columns, column->run_error));
        assert_true(column->in_study > 0);
        errors++;
    }
    assert_int_equal(errors, 6); /* of the angle, while filling, the torque, the least rate, two flows */
}

/* What is told of an output by several processes is the same thing: a table has one type for it. */
static void rows_of_one_name_are_of_one_kind_in_all_processes(void **state)
{
    (void)state;
    for (size_t p = 0; process_types[p]; p++)
        for (size_t q = 0; q < p; q++)
            for (size_t f = 0; f < process_types[p]->results->count; f++)
                for (size_t g = 0; g < process_types[q]->results->count; g++) {
                    const result_field *a = &process_types[p]->results->field[f], *b = &process_types[q]->results->field[g];
                    if (strcmp(a->output, b->output) == 0 && strcmp(a->name, b->name) == 0 && !a->group && !b->group) {
                        assert_int_equal(a->kind, b->kind);
                        assert_string_equal(a->unit, b->unit);
                    }
                }
}

static void a_list_is_in_the_order_of_its_places(void **state)
{
    const field_columns *columns = *state;
    const field_column **list = calloc(columns->count, sizeof *list);
    assert_non_null(list);
    const size_t count = field_columns_select(columns, COLUMNS_IN_VIEW, list);
    for (size_t i = 1; i < count; i++) assert_true(list[i - 1]->in_view <= list[i]->in_view);
    assert_string_equal(list[0]->shown_as, "drum_diameter");
    const size_t told = field_columns_select(columns, COLUMNS_IN_STUDY, list);
    assert_string_equal(list[0]->shown_as, "regime");
    assert_string_equal(list[0]->name, "name");
    assert_true(told > 20 && field_column_is_truth(find(columns, "steady")) && !field_column_is_truth(find(columns, "regime")));
    free(list);
}

int main(void)
{
    return RUN_UNIT_TESTS(gather, clear, each_column_stands_once_in_its_table, each_place_in_the_view_and_in_studies_has_one_name,
                          what_a_runs_error_is_named_by_is_a_column, rows_of_one_name_are_of_one_kind_in_all_processes,
                          a_list_is_in_the_order_of_its_places);
}
