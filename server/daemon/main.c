/* reposed: puts the parts together. The main thread becomes the supervisor (dispatcher.h); the HTTP threads know it
 * only as "wake up". */
#include <fcntl.h>
#include <malloc.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "calibrator.h"
#include "http_server.h"
#include "log.h"

#define ROUND_TOO_LONG 30.0 /* s without a round of the supervisor: something hangs */
#define LEAST_FREE_BYTES 67108864.0

typedef struct parts {
    config settings;
    data_folder data;
    job_store *store;
    worker_executor executor;
    job_dispatcher dispatcher;
    api_service service;
    http_server server;
} parts;

/* --- what the handlers ask of us --- */

static void jobs_changed_by_request(void *context)
{
    parts *all = context;
    dispatcher_wake(&all->dispatcher);
    waiting_room_jobs_changed(&all->server.room);
}

static void jobs_changed_by_worker(void *context)
{
    parts *all = context;
    waiting_room_jobs_changed(&all->server.room);
}

static bool is_ready(void *context, char *why_not, size_t size)
{
    parts *all = context;
    int64_t counts[JOB_STATUSES];
    const double silence = monotonic_seconds() - all->dispatcher.last_round;
    const double room = data_folder_free_bytes(&all->data);
    if (store_count_jobs(all->store, counts) != STORE_OK) snprintf(why_not, size, "the database can't be read");
    else if (silence > ROUND_TOO_LONG) snprintf(why_not, size, "the supervisor has been silent for %.0f s", silence);
    else if (room < LEAST_FREE_BYTES)
        snprintf(why_not, size, "the data folder's disk has %.0f MB left; needs %.0f MB", room / 1e6, LEAST_FREE_BYTES / 1e6);
    else return true;
    return false;
}

static void write_metrics(void *context, text_buffer *out)
{
    parts *all = context;
    metrics_write(&all->server.metrics, &all->dispatcher, out);
}

static void leave(void *context)
{
    parts *all = context;
    http_server_leave(&all->server);
}

/* --- start --- */

/* Idle memory: few arenas, and what is freed goes back to the system. */
static void keep_memory_small(void)
{
    mallopt(M_ARENA_MAX, 2);
    mallopt(M_MMAP_THRESHOLD, 128 * 1024);
    mallopt(M_TRIM_THRESHOLD, 256 * 1024);
}

/* Before any thread starts, so that all inherit it: these signals are read from a descriptor. */
static void arrange_signals(void)
{
    sigset_t ends;
    dispatcher_end_signals(&ends);
    pthread_sigmask(SIG_BLOCK, &ends, NULL);
    signal(SIGPIPE, SIG_IGN);
    signal(SIGXFSZ, SIG_IGN);
}

static bool announce(const parts *all)
{
    const char *host = all->settings.host;
    const bool six = strchr(host, ':') != NULL;
    printf("listening on http://%s%s%s:%d\n", six ? "[" : "", host, six ? "]" : "", all->server.port);
    fflush(stdout);
    if (!all->settings.port_file) return true;
    char temporary[4096];
    snprintf(temporary, sizeof temporary, "%s.tmp", all->settings.port_file);
    FILE *file = fopen(temporary, "we");
    bool good = file && fprintf(file, "%d\n", all->server.port) > 0;
    if (file) good = fclose(file) == 0 && good;
    good = good && rename(temporary, all->settings.port_file) == 0;
    if (!good) log_line("port file %s can't be written", all->settings.port_file);
    return good;
}

static bool open_parts(parts *all)
{
    if (!data_folder_open(&all->data, all->settings.data)) return false;
    all->store = store_open(&all->data, all->settings.queue_limit);
    if (!all->store || store_recover(all->store) != STORE_OK) return false;
    executor_local_init(&all->executor, all->settings.worker);
    if (!dispatcher_init(&all->dispatcher, all->store, &all->executor, all->settings.workers, all->settings.threads)) return false;
    all->dispatcher.jobs_changed = jobs_changed_by_worker;
    all->dispatcher.context = all;
    all->service = (api_service){ .store = all->store,
                                  .web_folder = open(all->settings.web, O_RDONLY | O_DIRECTORY | O_CLOEXEC),
                                  .api_file = all->settings.api_file,
                                  .default_threads = all->settings.threads,
                                  .daemon = all,
                                  .jobs_changed = jobs_changed_by_request,
                                  .is_ready = is_ready,
                                  .write_metrics = write_metrics };
    if (all->service.web_folder < 0) log_line("no page: the folder %s can't be opened", all->settings.web);
    return http_server_open(&all->server, &all->settings, &all->service) && http_server_start(&all->server);
}

int main(int argc, char **argv)
{
    static parts all;
    const enum config_outcome outcome = config_read(&all.settings, argc, argv);
    if (outcome != CONFIG_SERVE) return outcome == CONFIG_SHOWN ? 0 : 2;
    keep_memory_small();
    arrange_signals();
    umask(077);
    /* Nothing to undo on failure: the lock goes with the process, and the store is made for sudden ends. */
    if (!open_parts(&all) || !announce(&all)) return 1;
    calibrator_start(all.settings.worker, all.data.path);
    dispatcher_run(&all.dispatcher, leave);
    http_server_stop(&all.server);
    dispatcher_clear(&all.dispatcher);
    store_close(all.store);
    data_folder_close(&all.data);
    return 0;
}
