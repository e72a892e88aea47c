/* The service from a terminal: `reposed submit`, `jobs` and `show` for those without curl.
 *
 * Plain HTTP/1.0 over one connection a request, to where the same options say that the service listens. A library for HTTP would
 * bring TLS into the daemon, which leaves that to a proxy; whoever is elsewhere comes by ssh -L, or has curl. */
#ifndef CLIENT_H
#define CLIENT_H

#include "config.h"

/* The exit status: 0 done (with --wait: and successful), 1 not, 2 the service refused what was sent. */
int client_submit(const config *settings);
int client_jobs(const config *settings);
int client_show(const config *settings);

#endif
