/* What a job may ask of the cluster that runs it: {"partition": "gpu", "qos": "long"} of an execute request, each a value that the
 * service was started to allow. A resource is a row of the table. */
#ifndef JOB_RESOURCES_H
#define JOB_RESOURCES_H

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>

#include "problem.h"

typedef struct resource_field {
    const char *name;    /* as a member, and as the option of sbatch */
    const char *meaning; /* in the words of the API document */
} resource_field;

extern const resource_field resource_fields[]; /* ends with a NULL name */

enum { RESOURCE_SIZE = 64, RESOURCES_SIZE = 512 /* all of them as JSON */ };

/* What may be asked for: each entry is "partition=cpu,gpu", a name may come more than once. */
typedef struct resource_list {
    const char *const *entry;
    int count;
} resource_list;

/* "partition, account, ...": the names of the table. Returns text. */
char *resource_names(char text[RESOURCES_SIZE]);
/* Whether that may stand in the list. */
bool resource_entry_is_good(const char *entry);

/* Adds a problem for each member that is no resource or can't be a value of one; NULL and null: nothing is asked for. */
void job_resources_check(const json_t *resources, problem_list *problems);
/* The same for each that is not allowed. The resources have no other problems. */
void job_resources_check_allowed(const json_t *resources, const resource_list *allowed, problem_list *problems);
/* As they are kept: compact, in the order of the names; "": nothing is asked for. False: no memory. */
bool job_resources_write(const json_t *resources, char text[RESOURCES_SIZE]);

#endif
