/* The kinds of problem that answers tell of. Each has an address of its own, which is the `type` of RFC 9457: what stands
 * there says what it means. */
#ifndef PROBLEM_KINDS_H
#define PROBLEM_KINDS_H

#include <stddef.h>

#define OGC_EXCEPTION "http://www.opengis.net/def/exceptions/ogcapi-processes-1/1.0/"
#define PROBLEMS_PATH "/problems/"

typedef struct problem_kind {
    const char *name; /* at the end of its address; with OGC_EXCEPTION before it where the standard has named it */
    const char *title, *meaning;
} problem_kind;

extern const problem_kind problem_kinds[];
extern const size_t problem_kind_count;

/* NULL: there is none. */
const problem_kind *problem_kind_named(const char *name);
const problem_kind *problem_kind_titled(const char *title);

#endif
