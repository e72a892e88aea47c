#include "request_key.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "checksum.h"
#include "handlers.h"
#include "plan_info.h"
#include "status_info.h"
#include "study_info.h"

enum { LOOKS_FOR_ANSWER = 10 }; /* 5 ms apart */

static bool key_is_good(const char *key)
{
    const size_t length = strlen(key);
    for (const char *c = key; *c; c++)
        if (*c < '!' || *c > '~') return false;
    return length > 0 && length < REQUEST_KEY_SIZE;
}

/* What the request asks for: its address with the parameters, and its body. */
static uint64_t fingerprint_of(const http_request *request)
{
    checksum sum;
    checksum_begin(&sum);
    checksum_add(&sum, request->path, strlen(request->path) + 1);
    for (size_t p = 0; p < request->parameter_count; p++) {
        checksum_add(&sum, request->parameter[p].name, strlen(request->parameter[p].name) + 1);
        checksum_add(&sum, request->parameter[p].value, strlen(request->parameter[p].value) + 1);
    }
    if (request->body_length > 0) checksum_add(&sum, request->body, request->body_length);
    return checksum_end(&sum);
}

/* The answer that was lost, made of what the request made: only a daemon that died between the two loses it. */
static void respond_anew(const http_route *route, api_service *service, const http_request *request, http_response *response,
                         const char *made)
{
    const bool adds = strcmp(route->pattern, "/studies") == 0 || strcmp(route->pattern, "/calibrations") == 0
                      || strstr(route->pattern, "/execution");
    job_record job;
    study_record study;
    plan_record plan;
    if (*made && strstr(route->pattern, "/execution") && request->prefer) { /* it may wait for the results */
        http_request again = *request;
        snprintf(again.made, sizeof again.made, "%s", made);
        route_respond(route, service, &again, response);
    } else if (*made && strncmp(route->pattern, "/studies", 8) == 0 && store_find_study(service->store, made, &study) == STORE_OK) {
        http_respond_json(response, adds ? 201 : 200, study_info(&study));
        if (adds) snprintf(response->location, sizeof response->location, "%s/studies/%s", response->base, made);
    } else if (*made && strncmp(route->pattern, "/calibrations", 13) == 0
               && store_find_plan(service->store, made, &plan) == STORE_OK) {
        http_respond_json(response, adds ? 201 : 200, plan_info(&plan));
        if (adds) snprintf(response->location, sizeof response->location, "%s/calibrations/%s", response->base, made);
    } else if (*made && store_find_job(service->store, made, &job) == STORE_OK) {
        http_respond_json(response, adds ? 201 : 200, status_info(&job));
        if (adds) snprintf(response->location, sizeof response->location, "%s/jobs/%s", response->base, made);
        job_record_clear(&job);
    } else {
        http_respond_problem(response, 409, NULL, "Done before",
                             "the request with this Idempotency-Key was done, but its answer is lost");
    }
}

/* The first of two that come at once may not have its answer yet. */
static store_status find_answer(api_service *service, const request_key *key, kept_answer *answer)
{
    const struct timespec pause = { 0, 5000000 };
    store_status status = STORE_FAILED;
    for (int look = 0; look < LOOKS_FOR_ANSWER; look++) {
        status = store_find_answer(service->store, key->key, answer);
        if (status != STORE_OK || answer->body || answer->fingerprint != key->fingerprint || key->awaited) break;
        nanosleep(&pause, NULL);
    }
    return status;
}

/* False: the key is new. */
static bool respond_again(const http_route *route, api_service *service, const http_request *request, http_response *response,
                          const request_key *key)
{
    kept_answer answer = { 0 };
    const store_status status = find_answer(service, key, &answer);
    if (status == STORE_NOT_FOUND) return false;
    route_set_base(service, request, response);
    if (status != STORE_OK) {
        respond_store_failure(response, status, "look for the Idempotency-Key");
    } else if (answer.fingerprint != key->fingerprint) {
        http_respond_problem(response, 422, NULL, "Another request had this key",
                             "the Idempotency-Key \"%s\" came with another address or body before; a new request needs a new key",
                             key->key);
    } else if (answer.body) {
        snprintf(response->location, sizeof response->location, "%s", answer.location);
        http_respond_text(response, answer.status, "application/json", answer.body, strlen(answer.body));
        answer.body = NULL;
    } else {
        respond_anew(route, service, request, response, answer.made);
    }
    free(answer.body);
    return true;
}

static void respond_first(const http_route *route, api_service *service, const http_request *request, http_response *response,
                          request_key *key)
{
    store_use_key(key);
    route_respond(route, service, request, response);
    store_use_key(NULL);
    if (key->is_taken) { /* by one that came at the same time */
        http_response_clear(response);
        respond_again(route, service, request, response, key);
    } else if (key->is_kept && response->status < 300 && response->body) {
        store_keep_answer(service->store, key->key, response->status, response->location, response->body);
    }
}

void respond_once(const http_route *route, api_service *service, const http_request *request, http_response *response)
{
    request_key key = { .awaited = false };
    if (!request->idempotency_key || strcmp(request->method, "POST") != 0 || request->made[0]) {
        route_respond(route, service, request, response);
        return;
    }
    if (!key_is_good(request->idempotency_key)) {
        http_respond_problem(response, 400, NULL, "Bad request",
                             "header Idempotency-Key must have 1 to %d characters of ASCII, without spaces", REQUEST_KEY_SIZE - 1);
        return;
    }
    snprintf(key.key, sizeof key.key, "%s", request->idempotency_key);
    key.fingerprint = fingerprint_of(request);
    key.awaited = request->prefer != NULL;
    if (!respond_again(route, service, request, response, &key)) respond_first(route, service, request, response, &key);
}
