/* What one address may do in a time: requests, and wrong tokens. Bounded memory: of more addresses than there is room for, those
 * that were heard of least lately are forgotten. Any thread may call. */
#ifndef ADDRESS_LIMITS_H
#define ADDRESS_LIMITS_H

#include <pthread.h>
#include <stdbool.h>
#include <stdint.h>

#include "connection_watch.h"

enum { ADDRESS_SETS = 128, ADDRESS_WAYS = 8 };

typedef struct address_record {
    uint8_t address[CONNECTION_ADDRESS_SIZE];
    double at;                 /* monotonic s, when the two below were brought up to date; 0: a free place */
    double requests, failures; /* that count still: they fall with time */
} address_record;

typedef struct address_limits {
    pthread_mutex_t lock;
    uint64_t secret; /* nobody can choose addresses that share a set */
    double rate;     /* requests a second */
    address_record record[ADDRESS_SETS][ADDRESS_WAYS];
} address_limits;

void address_limits_init(address_limits *limits, double rate);
void address_limits_set_rate(address_limits *limits, double rate);
/* Counts a request. 0: it may come in; else the seconds after which the next one may. */
double address_limits_ask(address_limits *limits, const uint8_t *address);
/* Whether a token is looked at: 0, or the seconds to wait. */
double address_limits_try(address_limits *limits, const uint8_t *address);
void address_limits_note_failure(address_limits *limits, const uint8_t *address);

#endif
