#include "address_limits.h"

#include <math.h>
#include <string.h>
#include <sys/random.h>

#include "log.h"

#define SECONDS_AT_ONCE 2.0     /* so much of the rate may come in one moment */
#define FAILURES_AT_ONCE 20.0   /* wrong tokens, */
#define FAILURES_PER_SECOND 1.0 /* and then */

void address_limits_init(address_limits *limits, double rate)
{
    *limits = (address_limits){ .rate = rate };
    pthread_mutex_init(&limits->lock, NULL);
    if (getrandom(&limits->secret, sizeof limits->secret, 0) != (ssize_t)sizeof limits->secret) limits->secret = 1;
}

void address_limits_set_rate(address_limits *limits, double rate)
{
    pthread_mutex_lock(&limits->lock);
    limits->rate = rate;
    pthread_mutex_unlock(&limits->lock);
}

static size_t set_of(const address_limits *limits, const uint8_t *address)
{
    uint64_t mixed = limits->secret;
    for (int i = 0; i < CONNECTION_ADDRESS_SIZE; i++) {
        mixed = (mixed ^ address[i]) * 0x9e3779b97f4a7c15ULL;
        mixed ^= mixed >> 29;
    }
    return (size_t)(mixed % ADDRESS_SETS);
}

static double fallen(double count, double by) { return fmax(0.0, count - by); }

/* With the lock held. */
static address_record *record_of(address_limits *limits, const uint8_t *address)
{
    const double now = monotonic_seconds();
    address_record *set = limits->record[set_of(limits, address)], *record = set;
    for (address_record *r = set; r < set + ADDRESS_WAYS; r++) {
        if (r->at > 0.0 && memcmp(r->address, address, CONNECTION_ADDRESS_SIZE) == 0) {
            record = r;
            break;
        }
        if (r->at < record->at) record = r;
    }
    if (record->at <= 0.0 || memcmp(record->address, address, CONNECTION_ADDRESS_SIZE) != 0) {
        *record = (address_record){ .at = now };
        memcpy(record->address, address, CONNECTION_ADDRESS_SIZE);
    }
    record->requests = fallen(record->requests, (now - record->at) * limits->rate);
    record->failures = fallen(record->failures, (now - record->at) * FAILURES_PER_SECOND);
    record->at = now;
    return record;
}

double address_limits_ask(address_limits *limits, const uint8_t *address)
{
    pthread_mutex_lock(&limits->lock);
    address_record *record = record_of(limits, address);
    const double over = record->requests + 1.0 - SECONDS_AT_ONCE * limits->rate;
    if (over <= 0.0) record->requests += 1.0;
    pthread_mutex_unlock(&limits->lock);
    return over <= 0.0 ? 0.0 : over / limits->rate;
}

double address_limits_try(address_limits *limits, const uint8_t *address)
{
    pthread_mutex_lock(&limits->lock);
    const double over = record_of(limits, address)->failures + 1.0 - FAILURES_AT_ONCE;
    pthread_mutex_unlock(&limits->lock);
    return over <= 0.0 ? 0.0 : over / FAILURES_PER_SECOND;
}

void address_limits_note_failure(address_limits *limits, const uint8_t *address)
{
    pthread_mutex_lock(&limits->lock);
    record_of(limits, address)->failures += 1.0;
    pthread_mutex_unlock(&limits->lock);
}
