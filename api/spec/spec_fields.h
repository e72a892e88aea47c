/* A table of a process's inputs: name, place, unit, range, default and meaning of each. It alone drives reading a
 * request, writing the canonical spec, describing the process, telling unusual values and keeping the input in SQL, so
 * these can't disagree. */
#ifndef SPEC_FIELDS_H
#define SPEC_FIELDS_H

#include <stdbool.h>
#include <stddef.h>

/* The JSON object that a field is a member of; SPEC_INPUTS is "inputs" itself. The groups of all processes. */
typedef enum spec_group {
    SPEC_INPUTS,
    SPEC_DRUM,
    SPEC_PARTICLES,
    SPEC_CONTACT,
    SPEC_WALL,
    SPEC_LINING,
    SPEC_LIFTERS,
    SPEC_DURATION,
    SPEC_SNAPSHOTS,
    SPEC_SAMPLES,
    SPEC_SHAPE,
    SPEC_SPHERES,
    SPEC_CYLINDER,
    SPEC_STREAM,
    SPEC_TUBE,
    SPEC_PLATE,
    SPEC_VESSEL,
    SPEC_ORIFICE,
    SPEC_HOPPER,
    SPEC_INTEGRATION,
    SPEC_START,
    SPEC_PLACED,
    SPEC_MATERIALS,
    SPEC_PAIRS,
    SPEC_CONTACT_COHESION,
    SPEC_WALL_COHESION,
    SPEC_PAIR_COHESION,
    SPEC_SIZES,
    SPEC_ROTATION
} spec_group;

typedef enum field_kind {
    FIELD_REAL,
    FIELD_INTEGER,
    FIELD_CHOICE,           /* one of a few words; kept as its index */
    FIELD_TRUE,             /* true, kept as 1; there is no false, which is said by leaving it out */
    FIELD_TEXT,             /* kept as bytes that end with 0; "": not given. Its range is that of its length */
    FIELD_PLACE,            /* a list of three numbers, kept as three doubles */
    FIELD_ORIENTATION,      /* a list of four numbers, kept as four doubles */
    FIELD_NUMBERS,          /* a list of `least_entries` to `most_entries` numbers of its range, kept as doubles and their count */
    FIELD_TWO_NAMES,        /* a list of two texts, kept as spec_name[2] */
    FIELD_CHOICE_OR_OBJECT, /* a word, or an object whose members are kept beside it; the object's index follows the words' */
    FIELD_OBJECT,
    FIELD_OBJECT_OR_NULL, /* null, the default: none */
    FIELD_LIST,           /* of objects */
    FIELD_LONG_LIST,      /* the same, kept in memory of its own: see spec_inputs_clear */
    FIELD_NAMED_LIST      /* an object of objects, whose names are the user's: kept as a long list, the name first in each entry */
} field_kind;

/* A name that a user gives, with its 0; names of entries have 1 to NAME_MOST bytes. */
enum { NAME_MOST = 40 };
typedef char spec_name[NAME_MOST + 1];

/* How a number of the job's specification is kept in a column of SQL. */
typedef enum input_column {
    COLUMN_NONE,
    COLUMN_REAL,  /* a double */
    COLUMN_COUNT, /* a size_t */
    COLUMN_WHOLE, /* a whole number in a double */
    COLUMN_WORD   /* the word whose index among the choices a double holds */
} input_column;

typedef struct spec_field {
    spec_group group;
    const char *name;
    field_kind kind;
    spec_group child; /* objects and lists: whose members they hold */
    bool required;
    const char *spared_by;              /* a required field: the sibling that, given as an object or a number, makes it optional */
    const char *spared_by_too;          /* another such sibling, or a list */
    const char *unit;                   /* "" for a pure number */
    double minimum, maximum;            /* lists: of their length */
    bool minimum_open;                  /* the minimum itself is not allowed */
    double least_size;                  /* of either sign; 0: may be 0 */
    double fallback;                    /* the default; NaN: none, or one that depends on other inputs (said in meaning) */
    const char *excludes;               /* the sibling that may be given instead of this field, never beside it */
    const char *excludes_too;           /* another such sibling */
    const char *spared_beside;          /* the sibling beside which this field has no default: left out, it is not given */
    const char *const *choices;         /* ends with NULL */
    size_t offset;                      /* of the double in the process's struct, or in the list's entry. Lists: of their first
                                 * entry; long ones: of the pointer to it. Objects or null: of a double that is NaN where
                                 * there is none */
    size_t count_offset;                /* lists: of the size_t that counts the entries */
    size_t least_entries, most_entries; /* of numbers */
    size_t entry_size;                  /* lists: bytes from entry to entry; there is room for `maximum` */
    const char *meaning;
    double usual_low, usual_high; /* what is outside was hardly meant; both 0: nothing is unusual */
    const char *slip_unit;        /* the unit that numbers too large are often in by mistake; NULL: none */
    double slip_factor;           /* of that unit in `unit` */

    /* In SQL: the input as it was used, which may follow from others. An object's column has the object's unit. */
    const char *column; /* of the table <process>_input; NULL: none */
    input_column column_kind;
    size_t column_at;     /* of the number in the job_spec */
    bool column_may_miss; /* where it is NaN, or a count is 0, the column is null */
    int in_view;          /* the place among the columns of run_summary; 0: not there */
    bool is_listed;       /* a member of a job's summary */

    /* For people, in a list of jobs: the column's number times the factor between two texts. */
    int list_order;          /* 0: not shown */
    const char *list_before; /* "μ " */
    double list_factor;
    const char *list_after; /* NULL: the unit, as is usual for it */
    double list_above;      /* shown only where it is more than this */

    /* In a form: the place among the few inputs that are usually asked for. */
    int form_order;        /* 0: folded away with the rest */
    const char *form_unit; /* NULL: the usual one of its dimension */

    bool is_left_out_by_default; /* not written where it is its default: it came later than files that are still read */
    bool is_left_out_where_null; /* an object or null, which is not written where it is null */

    /* Nothing that happens before the run begins (the drum turns, the tube rises) depends on it but through what is derived from
     * it: runs that differ in such fields alone settle the same bed (spec_bed.c). */
    bool acts_later;
    bool is_free_of_bed; /* of a drum: may be another than in the run that made the bed which it starts from */
} spec_field;

typedef struct spec_table {
    const spec_field *field;
    size_t count;
} spec_table;

/* NULL when the group has no such member. */
const spec_field *spec_field_find(const spec_table *table, spec_group group, const char *name);

/* The field at a JSON pointer below the inputs, "particles/0/diameter"; NULL: there is none. */
const spec_field *spec_field_at(const spec_table *table, const char *pointer);

/* A member that `name`, unknown in `group`, was probably meant to be: NULL when nothing is near. It may belong to
 * another group. */
const spec_field *spec_field_nearest(const spec_table *table, spec_group group, const char *name);

/* Levenshtein distance: letters inserted, left out or replaced between two names. */
size_t name_distance(const char *a, const char *b);

/* Path of a field below the inputs, as "contact/friction". */
void spec_field_path(const spec_table *table, const spec_field *field, char *path, size_t size);

#endif
