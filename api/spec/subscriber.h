/* Who is called back about a job: {"successUri", "inProgressUri", "failedUri"} of an execute request. An address is http:// or
 * https://, a host, perhaps a port, and perhaps a path; its host is written so that all who read it read the same one. */
#ifndef SUBSCRIBER_H
#define SUBSCRIBER_H

#include <jansson.h>
#include <stdbool.h>

#include "problem.h"

/* The hosts that may be called back: "NAME" by any port, "NAME:PORT" by that one. */
typedef struct callback_hosts {
    const char *const *name;
    int count;
} callback_hosts;

/* Whether that may stand in the list. */
bool callback_host_is_good(const char *name);
bool callback_hosts_have(const callback_hosts *hosts, const char *uri);

/* Adds a problem for each member that can't be one; NULL and null: nobody is called back. */
void subscriber_check(const json_t *subscriber, problem_list *problems);
/* The same for each member whose host may not be called back. The subscriber has no other problems. */
void subscriber_check_hosts(const json_t *subscriber, const callback_hosts *hosts, problem_list *problems);

#endif
