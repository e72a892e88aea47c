#include "callback_sender.h"

#include <curl/curl.h>
#include <dlfcn.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "callbacks.h"
#include "handlers.h"
#include "log.h"
#include "results_forms.h"
#include "status_info.h"

enum { SECONDS_OF_A_TRY = 10, SECONDS_TO_CONNECT = 5, LONGEST_PAUSE = 3600, MOST_DOUBLINGS = 12, LONGEST_REPLY = 64 << 10 };
#define SECONDS_BETWEEN_LOOKS 0.5
#define SECONDS_BETWEEN_SWEEPS 600.0

/* libcurl and what it needs would take more memory than all of the daemon: it is loaded only where it is used. */
typedef struct curl_calls {
    void *library;
    __typeof__(curl_global_init) *global_init;
    __typeof__(curl_easy_init) *init;
    __typeof__(curl_easy_reset) *reset;
    CURLcode (*set)(CURL *, CURLoption, ...);
    CURLcode (*tell)(CURL *, CURLINFO, ...);
    __typeof__(curl_easy_perform) *perform;
    __typeof__(curl_easy_strerror) *problem;
    __typeof__(curl_easy_cleanup) *cleanup;
    __typeof__(curl_slist_append) *append;
    __typeof__(curl_slist_free_all) *free_list;
} curl_calls;

/* A host that did not take something: "https://name:port", how often in a row, and until when (monotonic s) it has its rest. */
typedef struct resting_host {
    char begin[300];
    int failures;
    double until;
} resting_host;

struct callback_sender {
    api_service *service;
    curl_calls curl;
    CURL *handle;
    resting_host host[16]; /* the last of those that failed */
    size_t next_host;
    double next_sweep;
    pthread_t thread;
    atomic_bool stopping;
};

/* --- one POST --- */

static bool load_curl(curl_calls *curl)
{
    const struct {
        void *place;
        const char *name;
    } calls[] = {
        { &curl->global_init, "curl_global_init" }, { &curl->init, "curl_easy_init" },
        { &curl->reset, "curl_easy_reset" },        { &curl->set, "curl_easy_setopt" },
        { &curl->tell, "curl_easy_getinfo" },       { &curl->perform, "curl_easy_perform" },
        { &curl->problem, "curl_easy_strerror" },   { &curl->cleanup, "curl_easy_cleanup" },
        { &curl->append, "curl_slist_append" },     { &curl->free_list, "curl_slist_free_all" },
    };
    curl->library = dlopen("libcurl.so.4", RTLD_NOW | RTLD_LOCAL);
    for (size_t i = 0; curl->library && i < sizeof calls / sizeof calls[0]; i++) {
        void *call = dlsym(curl->library, calls[i].name);
        if (!call) return false;
        memcpy(calls[i].place, &call, sizeof call); /* a function's address, as dlsym gives it */
    }
    return curl->library && curl->global_init(CURL_GLOBAL_DEFAULT) == CURLE_OK;
}

static int is_to_stop(void *sender, curl_off_t a, curl_off_t b, curl_off_t c, curl_off_t d)
{
    (void)a, (void)b, (void)c, (void)d;
    return ((callback_sender *)sender)->stopping;
}

/* Nobody reads what is answered; one that does not end is cut off. */
static size_t throw_away(char *bytes, size_t size, size_t count, void *seen)
{
    (void)bytes;
    *(size_t *)seen += size * count;
    return *(size_t *)seen <= LONGEST_REPLY ? size * count : 0;
}

static void set_bounds(callback_sender *sender, size_t *seen)
{
    const curl_calls *curl = &sender->curl;
    CURL *handle = sender->handle;
    curl->reset(handle);
    curl->set(handle, CURLOPT_PROTOCOLS_STR, "http,https");
    curl->set(handle, CURLOPT_FOLLOWLOCATION, 0L);
    curl->set(handle, CURLOPT_PROXY, "");
    curl->set(handle, CURLOPT_NETRC, (long)CURL_NETRC_IGNORED);
    curl->set(handle, CURLOPT_NOSIGNAL, 1L);
    curl->set(handle, CURLOPT_HTTP_VERSION, (long)CURL_HTTP_VERSION_1_1);
    curl->set(handle, CURLOPT_CONNECTTIMEOUT, (long)SECONDS_TO_CONNECT);
    curl->set(handle, CURLOPT_TIMEOUT, (long)SECONDS_OF_A_TRY);
    curl->set(handle, CURLOPT_NOPROGRESS, 0L);
    curl->set(handle, CURLOPT_XFERINFOFUNCTION, is_to_stop);
    curl->set(handle, CURLOPT_XFERINFODATA, sender);
    curl->set(handle, CURLOPT_WRITEFUNCTION, throw_away);
    curl->set(handle, CURLOPT_WRITEDATA, seen);
    curl->set(handle, CURLOPT_USERAGENT, "reposed/" REPOSED_VERSION);
}

/* The status of the answer; 0: there was none, and *problem says why. */
static long post(callback_sender *sender, const callback *news, const http_response *document, const char **problem)
{
    const curl_calls *curl = &sender->curl;
    char line[600];
    long status = 0;
    size_t seen = 0;
    struct curl_slist *headers = curl->append(NULL, "Content-Type: application/json");
    /* The same when it is sent again. */
    snprintf(line, sizeof line, "Idempotency-Key: %s-%s-%llx", news->id, news->kind, (unsigned long long)news->news);
    headers = curl->append(headers, line);
    snprintf(line, sizeof line, "Link: <%s/jobs/%s>; rel=\"monitor\"", news->base, news->id);
    headers = curl->append(headers, line);
    headers = curl->append(headers, "Expect:");
    set_bounds(sender, &seen);
    curl->set(sender->handle, CURLOPT_URL, news->uri);
    curl->set(sender->handle, CURLOPT_HTTPHEADER, headers);
    curl->set(sender->handle, CURLOPT_POSTFIELDSIZE_LARGE, (curl_off_t)document->length);
    curl->set(sender->handle, CURLOPT_POSTFIELDS, document->body);
    const CURLcode code = curl->perform(sender->handle);
    curl->tell(sender->handle, CURLINFO_RESPONSE_CODE, &status);
    *problem = curl->problem(code);
    curl->free_list(headers);
    return code == CURLE_OK || seen > LONGEST_REPLY ? status : 0;
}

/* --- what is told to whom --- */

/* The results in the form of the standard, else the job's status. */
static bool make_document(callback_sender *sender, const callback *news, http_response *document)
{
    job_record job;
    const http_request request = { .method = "GET", .accept = "application/json;profile=\"" RESULTS_PROFILE "\"" };
    http_response_init(document);
    snprintf(document->base, sizeof document->base, "%.310s", news->base);
    if (store_find_job(sender->service->store, news->id, &job) != STORE_OK) return false;
    if (strcmp(news->kind, "success") == 0) respond_results(sender->service, &request, document, &job, 500);
    else http_respond_json(document, 200, status_info(&job));
    job_record_clear(&job);
    return document->status == 200 && document->body;
}

/* "https://name:port" of an address that was checked. */
static void begin_of(const char *uri, char begin[300])
{
    const size_t scheme = (size_t)(strstr(uri, "://") + 3 - uri);
    snprintf(begin, 300, "%.*s", (int)(scheme + strcspn(uri + scheme, "/?")), uri);
}

/* The one of that name; else the place of the one that failed longest ago. */
static resting_host *host_of(callback_sender *sender, const char *begin, bool make)
{
    const size_t count = sizeof sender->host / sizeof sender->host[0];
    for (size_t h = 0; h < count; h++)
        if (strcmp(sender->host[h].begin, begin) == 0) return &sender->host[h];
    if (!make) return NULL;
    resting_host *host = &sender->host[sender->next_host++ % count];
    *host = (resting_host){ 0 };
    snprintf(host->begin, sizeof host->begin, "%s", begin);
    return host;
}

static store_status put_off(callback_sender *sender, const callback *news, const char *begin, const char *problem)
{
    resting_host *host = host_of(sender, begin, true);
    const double seconds = fmin(LONGEST_PAUSE, ldexp(1.0, host->failures < MOST_DOUBLINGS ? host->failures : MOST_DOUBLINGS));
    if (host->failures++ == 0) log_line("job %s: %s did not take its callback: %s; it is sent again", news->id, begin, problem);
    host->until = monotonic_seconds() + seconds;
    return store_put_off_callback(sender->service->store, news, true, seconds, begin);
}

/* What became of it is noted, or the status says why not. */
static store_status tell(callback_sender *sender, const callback *news)
{
    job_store *store = sender->service->store;
    char begin[300], answered[40];
    const char *problem;
    http_response document;
    begin_of(news->uri, begin);
    resting_host *host = host_of(sender, begin, false);
    const double rest = host ? host->until - monotonic_seconds() : 0.0;
    if (rest > 0.0) return store_put_off_callback(store, news, false, rest, begin);
    if (!callback_hosts_have(&sender->service->callback_hosts, news->uri)) {
        log_line("job %s: %s may no longer be called back (--callback-host)", news->id, begin);
        return store_end_callback(store, news);
    }
    if (!make_document(sender, news, &document)) {
        http_response_clear(&document);
        return store_put_off_callback(store, news, true, LONGEST_PAUSE, news->uri);
    }
    const long status = post(sender, news, &document, &problem);
    snprintf(answered, sizeof answered, "it answered %ld", status);
    http_response_clear(&document);
    if (status >= 200 && status < 300) {
        if (host) host->failures = 0;
        return store_end_callback(store, news);
    }
    return sender->stopping ? STORE_OK : put_off(sender, news, begin, status ? answered : problem);
}

static void sweep(callback_sender *sender)
{
    int64_t forgotten = 0;
    if (monotonic_seconds() < sender->next_sweep) return;
    sender->next_sweep = monotonic_seconds() + SECONDS_BETWEEN_SWEEPS;
    store_forget_callbacks(sender->service->store, &forgotten);
    if (forgotten > 0) log_line("%lld callbacks are given up, which nobody took", (long long)forgotten);
}

static void *send_all(void *context)
{
    callback_sender *sender = context;
    const struct timespec between = { .tv_nsec = (long)(1e9 * SECONDS_BETWEEN_LOOKS) };
    while (!sender->stopping) {
        callback news;
        if (store_next_callback(sender->service->store, &news) == STORE_OK && tell(sender, &news) == STORE_OK) continue;
        sweep(sender);
        nanosleep(&between, NULL);
    }
    return NULL;
}

callback_sender *callback_sender_start(api_service *service)
{
    callback_sender *sender = calloc(1, sizeof *sender);
    if (sender) sender->service = service;
    if (!sender || !load_curl(&sender->curl) || !(sender->handle = sender->curl.init())) {
        log_line("nobody can be called back (--callback-host): libcurl.so.4 can't be used: %s",
                 sender && !sender->curl.library ? dlerror() : "out of memory, or another library than was expected");
        free(sender);
        return NULL;
    }
    if (pthread_create(&sender->thread, NULL, send_all, sender) == 0) return sender;
    log_line("no thread is to be had for callbacks");
    sender->curl.cleanup(sender->handle);
    free(sender);
    return NULL;
}

void callback_sender_stop(callback_sender *sender)
{
    if (!sender) return;
    sender->stopping = true;
    pthread_join(sender->thread, NULL);
    sender->curl.cleanup(sender->handle);
    free(sender);
}
