/* The arrays of the index, private to job_index*.c. Whoever calls these holds the index's lock. */
#ifndef JOB_INDEX_ROWS_H
#define JOB_INDEX_ROWS_H

#include <pthread.h>
#include <stdatomic.h>

#include "job_index.h"

/* Texts of which many jobs have the same; each is kept once. */
typedef struct text_pool {
    char *text;       /* one after the other, each with its 0; owned, as all below */
    uint32_t *offset; /* (count) */
    uint32_t *users;  /* (count) */
    uint32_t *slot;   /* (slots) hash table of index + 1; 0: free */
    size_t used, room, count, most, slots, unused;
} text_pool;

bool text_pool_add(text_pool *pool, const char *text, uint32_t *index); /* one more user; false: no memory */
void text_pool_leave(text_pool *pool, uint32_t index);
const char *text_pool_text(const text_pool *pool, uint32_t index);
void text_pool_clear(text_pool *pool);

/* What was looked for last, since pages ask for the same again and again: only what the pool has got since is looked through. */
enum { LONGEST_WANTED = 1024 };
typedef struct text_search {
    char text[LONGEST_WANTED]; /* in small letters */
    uint8_t *marks;            /* (searched) owned */
    size_t searched, room;
} text_search;

/* A mark for each text of the pool that holds this one, whatever the case; lent. NULL: no memory, or the text is empty or too long. */
const uint8_t *text_search_marks(text_search *search, const text_pool *pool, const char *text);
void text_search_clear(text_search *search); /* as the pool is cleared, too */

/* Numbers of a column, which several tables may have; of texts the numbers in the pool. */
typedef struct value_column {
    char name[64];
    double *value; /* (most rows) NaN: none */
    text_pool words;
    bool is_words;
    uint64_t used_at;
} value_column;

/* As many as one filter may need, and some that others may need next. */
enum { MOST_COLUMNS_KEPT = 24, ROW_REMOVED = 7, ROW_STATUS = 7, ROW_PROCESS_SHIFT = 3 };

typedef struct index_rows {
    int64_t *number; /* (count) ascending */
    uint64_t *stamp; /* (count) the digits of the id's date and time as one number, */
    uint32_t *bits;  /* (count) and its end */
    uint32_t *label; /* (count) in the pool */
    uint32_t *study; /* (count) number; 0: none */
    uint8_t *kind;   /* (count) status, ROW_REMOVED: deleted; above it the process's index in process_types */
    size_t count, most, removed;
} index_rows;

struct job_index {
    const field_columns *fields;
    pthread_mutex_t lock; /* of the rows and columns */
    index_rows rows;
    text_pool labels;
    text_search search; /* in the labels */
    value_column column[MOST_COLUMNS_KEPT];
    size_t columns;
    uint64_t looks;
    atomic_int readers; /* who read much in, or wait to: with the lock held for long */

    pthread_mutex_t changes_lock; /* of what follows */
    bool is_loaded;               /* and so changes are of interest */
    int64_t *changed;             /* (changes) numbers of jobs whose rows are to be read again */
    size_t changes, changes_room;

    /* Of the transaction that is on its way; the writer's thread alone. */
    int64_t *pending;
    size_t pendings, pending_room;
    bool lost_track; /* for want of memory */
};

size_t index_rows_from(const index_rows *rows, int64_t number); /* the first of this number or a higher one; count: none */
size_t index_rows_find(const index_rows *rows, int64_t number); /* count: not there */

/* job_index_values.c */
value_column *value_column_find(job_index *index, const char *name); /* NULL: not read yet */
/* Reads a column in. */
store_status value_column_read(job_index *index, sqlite3 *reader, const char *name);
/* Reads again what the jobs of these numbers have in all columns that are here. */
store_status value_columns_refresh(job_index *index, sqlite3 *reader, int64_t first, int64_t last);
bool value_columns_grow(job_index *index, size_t most);
void value_columns_drop(job_index *index);

/* job_index.c: the lock, with the rows and the columns that the filter needs as the database has them. */
store_status job_index_lock(job_index *index, sqlite3 *reader, const job_filter *filter);
void job_index_unlock(job_index *index);

/* job_index_find.c */
/* The columns that a filter needs: calls take for each name; false ends it. */
typedef bool column_name_taker(void *context, const char *name);
bool filter_columns(const job_filter *filter, column_name_taker *take, void *context);

/* Of what is kept, a mark for each row; false: no memory. */
/* job_index_texts.c: keeps what has the text in its id or label, or the member in its label. */
bool keep_text(job_index *index, const char *text, uint8_t *kept);
bool keep_label_member(const job_index *index, const job_filter *filter, uint8_t *kept);
/* job_index_page.c: the page that the filter asks for. */
bool keep_page(job_index *index, const job_filter *filter, const uint8_t *kept, found_job *found, size_t *count);

#endif
