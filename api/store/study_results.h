/* A study's results: a row a case, with the mean over its repeats and the standard error of that mean. Repeats differ in
 * their random beginning alone, so they are independent (mean_of_runs.h). */
#ifndef STUDY_RESULTS_H
#define STUDY_RESULTS_H

#include "field_columns.h"
#include "mean_of_runs.h"
#include "store.h"
#include "text_buffer.h"

typedef struct study_table {
    field_columns columns;
    const field_column **told; /* (told_count) what the rows of results say is told of each case; owned */
    size_t told_count;
    json_t *cases; /* (n) rows, as GET /studies/{id}/results has them; owned */
    bool failed;   /* no memory, or something in the database that is no JSON */
} study_table;

/* False: no memory; to be cleared in any case. */
bool study_table_init(study_table *table);
void study_table_clear(study_table *table);
/* The cases in order, then the runs in order of cases, then once at the end. For the store to call; context: the table
 * or the summing. */
study_case_visitor study_table_add_case;

/* How many runs say so, how many not, how many cannot know. */
typedef struct truth_of_runs {
    int64_t yes, no, unknown;
} truth_of_runs;

/* One column over the runs of a case; which member is in use follows from the column's kind. */
typedef struct told_of_runs {
    mean_of_runs mean;
    json_t *words; /* {"rolling": 2}: how many runs were so; owned */
    truth_of_runs truth;
    int64_t sum;
} told_of_runs;

typedef struct study_summing {
    study_table *table;
    int64_t index; /* of the case being summed; -1: none yet */
    int64_t counts[JOB_STATUSES];
    told_of_runs *told; /* (table->told_count) owned */
} study_summing;

void study_summing_init(study_summing *summing, study_table *table);
study_run_visitor study_summing_add_run;
void study_summing_end(study_summing *summing);

/* One line a case. Columns: case, inputs, labels, counts, what is told in words, then for each measure that any case has its
 * mean and error. */
void study_table_write_csv(const study_table *table, text_buffer *out);

#endif
