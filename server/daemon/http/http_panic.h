/* When libmicrohttpd gives up, which it tells by a function that must not come back. The reason goes to the log. While the daemon
 * serves, the process aborts; what the database holds is made for that. */
#ifndef HTTP_PANIC_H
#define HTTP_PANIC_H

#include <stdbool.h>

void http_panic_watch(void);
/* From now on the thread that met it stays where it is, and the supervisor still records the ends of the workers. */
void http_panic_leaves(void);
bool http_panic_has_come(void);
/* They are recorded: the process ends here if it has come, or as soon as it comes. */
void http_panic_may_end(void);

#endif
