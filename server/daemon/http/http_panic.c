#include "http_panic.h"

#include <microhttpd.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <unistd.h>

#include "log.h"

static enum { SERVING, LEAVING, ENDING } _Atomic stage;
static atomic_bool has_come;

static void end_here(void)
{
    log_line("leaving without the HTTP library");
    _exit(0);
}

static void give_up(void *context, const char *file, unsigned line, const char *reason)
{
    (void)context;
    log_line("the HTTP library gives up: %s (%s:%u)", reason ? reason : "no reason given", file ? file : "?", line);
    if (stage == SERVING) abort();
    if (stage == ENDING) end_here();
    has_come = true;
    for (;;) pause();
}

void http_panic_watch(void) { MHD_set_panic_func(give_up, NULL); }
void http_panic_leaves(void) { stage = LEAVING; }
bool http_panic_has_come(void) { return has_come; }

void http_panic_may_end(void)
{
    stage = ENDING;
    if (has_come) end_here();
}
