/* Tells subscribers what there is to tell (store/callbacks.h), one after the other, in a thread of its own: no request and no
 * worker waits for a stranger's answer. POSTs JSON, believes nothing but the status, and follows no redirection. What is not
 * taken with 2xx is sent again after 1 s, 2 s, 4 s, ... up to an hour. */
#ifndef CALLBACK_SENDER_H
#define CALLBACK_SENDER_H

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>

#include "service.h"

typedef struct callback_sender callback_sender;

/* NULL: it can't be had, for a reason that is logged. service: with hosts that may be called back. */
callback_sender *callback_sender_start(api_service *service);
/* Within a second, whatever it waits for. NULL is nothing. */
void callback_sender_stop(callback_sender *sender);

#endif
