/* A table of a process's results: output, name, unit and meaning of each. It drives writing the results document,
 * describing it, showing it on the page and keeping it in SQL: the tables <output>_result, the view run_summary, summaries
 * of jobs and studies. A new result is measured in the core, has a member in a struct and a row here; `make openapi` then
 * writes it into the OpenAPI document. */
#ifndef RESULT_FIELDS_H
#define RESULT_FIELDS_H

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>

typedef enum result_kind {
    RESULT_REAL,
    RESULT_WHOLE,   /* a whole number kept in a double */
    RESULT_SIZE,    /* a size_t */
    RESULT_TRUTH,   /* a bool */
    RESULT_MAYBE,   /* true or false kept in a double; NaN: not known */
    RESULT_TEXT,    /* a const char *; NULL: not known */
    RESULT_WORD,    /* a const char * that is always known */
    RESULT_WARNINGS /* a list that result_warnings_add writes; in SQL how many it holds */
} result_kind;

/* Of a run of several beds (at most MOST_BEDS): what becomes of a number of each. */
typedef enum over_beds {
    BEDS_MEAN,  /* the mean over those that have it */
    BEDS_ERROR, /* the error of the mean that the row `of` is: mean_of_runs.h */
    BEDS_SUM,   /* over those that have it, as are the next two */
    BEDS_LEAST,
    BEDS_LARGEST,
    BEDS_VOTE,    /* the word of most */
    BEDS_AGREED,  /* true where it is true of each, and the word `of` is the same in all */
    BEDS_ALIKE,   /* as in the first: it is the same in all, or that of the run */
    BEDS_TOGETHER /* told from all together, by whoever measures them */
} over_beds;

enum { MOST_BEDS = 64 };

typedef struct result_field {
    const char *output, *group, *name; /* group: object inside the output, NULL: none */
    result_kind kind;
    size_t offset; /* in the process's struct of results */
    const char *unit, *meaning;
    /* For people: its name; a number's as the value times the factor, in so many digits (0: all), and the suffix. */
    const char *label, *suffix; /* suffix NULL: as is usual for the unit */
    double factor;
    int digits;
    bool is_main;               /* among a study's measures: one that a table for people shows */
    const char *const *choices; /* the words that a text may be, ends with NULL; NULL: any */
    over_beds over_beds;        /* of processes that can run several */
    const char *of;             /* the name of another row of the same output and group, where over_beds needs one */

    /* In SQL. Processes that have an output of the same name share its table: what one row says of a column holds for all. */
    bool is_stored;        /* a column of the table <output>_result, named name or group_name */
    int in_view;           /* the place among the columns of run_summary; 0: not there */
    const char *view_name; /* its name there, in summaries and in studies; NULL: the column's */
    bool is_listed;        /* a member of a job's summary */
    int in_study;          /* the place among what a study tells of each case; 0: not there */
    const char *run_error; /* the column that holds a single run's own error of it; NULL: there is none */
} result_field;

typedef struct result_output {
    const char *name, *meaning;
} result_output;

typedef struct result_table {
    const result_field *field;
    size_t count;
    const result_output *output;
    size_t output_count;
    /* Describes members of an output that are not in the table; NULL: there are none. */
    void (*describe_words)(json_t *properties, const char *output);
    const char *list;                   /* the output that is a list of objects, not an object; NULL: there is none */
    const struct result_table *entries; /* what each of these has */
    /* A run may be of several beds: the rows of its first output that `beds` there tells of each, ends with NULL. NULL: of one. */
    const char *const *of_each_bed;
    const char *const *other_angles; /* definitions in other_methods of repose, ends with NULL; NULL: there are none */
} result_table;

/* Its rows and its outputs, of two arrays. */
#define RESULT_TABLE(fields, outputs)                                                                                              \
    .field = fields, .count = sizeof fields / sizeof fields[0], .output = outputs,                                                 \
    .output_count = sizeof outputs / sizeof outputs[0]

/* "outputs" of the process description. New reference. */
json_t *result_outputs_description(const result_table *table);

/* Every number NaN and every text NULL, as when nothing was measured; the rest 0. size: of the struct of results. */
void results_init(const result_table *table, void *results, size_t size);

/* Of `count` beds, whose results the table lays out: those of all, in *all, which is a copy of the first's. Rows that are told
 * of all together are its maker's. */
void results_of_beds(const result_table *table, const void *const *bed, size_t count, void *all);
/* The member "beds" of the document's first output: of each of several beds its seed and what the table says, of one null.
 * document: of bed k. False: no memory. */
bool beds_to_json(const result_table *table, json_t *const *document, const double *seed, size_t count, json_t *all);
/* Their mean and its error, where they have values. error: of each; NULL: none. */
void mean_over_beds(const double *value, const double *error, size_t count, double *mean, double *error_of_mean);
/* The row's rule in words. New reference. */
json_t *over_beds_to_json(const result_field *field);

/* The results document: what is not known becomes null. New reference; NULL: no memory. */
json_t *results_to_json(const result_table *table, const void *results);

#endif
