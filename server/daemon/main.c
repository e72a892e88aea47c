/* reposed: puts the parts together. The main thread becomes the supervisor (dispatcher.h); the HTTP threads know it
 * only as "wake up". */
#include <errno.h>
#include <fcntl.h>
#include <malloc.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "backup.h"
#include "calibrator.h"
#include "callback_sender.h"
#include "client.h"
#include "collect.h"
#include "data_check.h"
#include "end_signals.h"
#include "executor_slurm.h"
#include "folder_remover.h"
#include "http_server.h"
#include "json_text.h"
#include "log.h"
#include "openapi_schemas.h"
#include "planner.h"
#include "readiness.h"

#define SECONDS_TO_END 25.0 /* after the signal, whatever hangs */

typedef struct parts {
    config settings;       /* as they were at the start */
    const config *running; /* and as they are */
    post_limits limits;    /* of the settings */
    data_folder data;
    job_store *store;
    worker_executor executor;
    job_dispatcher dispatcher;
    api_service service;
    http_server server;
    readiness readiness;
    int signals; /* readable when the daemon is to end */
    folder_remover remover;
    callback_sender *callbacks;   /* NULL: nobody may be called back */
    run_planner *_Atomic planner; /* the last that is started */
} parts;

/* --- what the handlers ask of us --- */

static void jobs_changed_by_request(void *context)
{
    parts *all = context;
    dispatcher_wake(&all->dispatcher);
    waiting_room_jobs_changed(&all->server.room);
    planner_wake(all->planner);
}

static void jobs_changed_by_worker(void *context)
{
    parts *all = context;
    waiting_room_jobs_changed(&all->server.room);
    planner_wake(all->planner);
}

static void jobs_deleted(void *context)
{
    parts *all = context;
    folder_remover_wake(&all->remover);
    waiting_room_jobs_changed(&all->server.room);
}

static bool is_ready(void *context, char *why_not, size_t size)
{
    parts *all = context;
    return readiness_look(&all->readiness, why_not, size);
}

static void write_metrics(void *context, text_buffer *out)
{
    parts *all = context;
    const prune_tally pruned = folder_remover_pruned(&all->remover);
    metrics_write(&all->server.metrics, &all->dispatcher, &pruned, out);
}

static void begin_session_of(void *context, const http_request *request, const char *token, http_response *response)
{
    parts *all = context;
    http_guard_begin_session(&all->server.guard, request, token, response);
}

static void end_session_of(void *context, const http_request *request, http_response *response)
{
    parts *all = context;
    http_guard_end_session(&all->server.guard, request, response);
}

static void leave(void *context)
{
    parts *all = context;
    http_server_leave(&all->server);
}

/* --- options --- */

static prune_rules rules_of(const config *settings)
{
    return (prune_rules){ settings->keep_days, settings->keep_bytes, settings->dry_run };
}

static post_limits limits_of(const config *settings)
{
    return (post_limits){ .estimate_seconds = settings->max_estimate_seconds,
                          .particles = settings->max_particles,
                          .snapshot_bytes = settings->max_snapshot_bytes,
                          .threads = settings->max_threads,
                          .resources = { settings->slurm_allowed, settings->slurm_allowances } };
}

static int default_threads_of(const config *settings)
{
    return settings->max_threads && settings->max_threads < settings->threads ? settings->max_threads : settings->threads;
}

typedef struct later_options {
    config settings;
    post_limits limits;
} later_options;

static void take_options(parts *all, const later_options *later)
{
    const prune_rules rules = rules_of(&later->settings);
    log_as_json(later->settings.log_json);
    all->running = &later->settings;
    all->service.limits = &later->limits;
    all->service.default_threads = default_threads_of(&later->settings);
    all->service.public_url = later->settings.public_url;
    all->store->queue_limit = later->settings.queue_limit;
    dispatcher_set_threads(&all->dispatcher, later->settings.threads);
    http_guard_set_options(&all->server.guard, &later->settings);
    folder_remover_set_rules(&all->remover, &rules);
}

/* On SIGHUP, in the thread of signals. Requests may still use what the options were before, so those that were taken over are
 * never freed: that is the size of a file for each time that they have changed. */
static void read_options_again(void *context)
{
    parts *all = context;
    later_options *later = calloc(1, sizeof *later);
    const bool good =
        later && config_read_again(&later->settings, all->running) && http_guard_read_tokens(&all->server.guard, &later->settings);
    if (!good) log_line("the options stay as they were");
    if (good && config_compare(&later->settings, all->running) > 0) {
        later->limits = limits_of(&later->settings);
        take_options(all, later);
        return;
    }
    if (good) log_line("options read again: none has changed that can without a restart");
    if (later) config_clear(&later->settings);
    free(later);
}

/* Where there is something to read again. */
static bool takes_hangup(const config *settings) { return settings->token_file || settings->file || settings->is_installed; }

/* --- start --- */

/* Idle memory: few arenas, and what is freed goes back to the system. */
static void keep_memory_small(void)
{
    mallopt(M_ARENA_MAX, 2);
    mallopt(M_MMAP_THRESHOLD, 128 * 1024);
    mallopt(M_TRIM_THRESHOLD, 256 * 1024);
}

/* Before any thread starts, so that all inherit it: one thread alone takes these signals. */
static bool arrange_signals(parts *all)
{
    sigset_t ends;
    dispatcher_end_signals(&ends);
    if (takes_hangup(&all->settings)) sigaddset(&ends, SIGHUP); /* also under nohup: it ends nothing then */
    pthread_sigmask(SIG_BLOCK, &ends, NULL);
    signal(SIGPIPE, SIG_IGN);
    signal(SIGXFSZ, SIG_IGN);
    return end_signals_watch(&ends, SECONDS_TO_END, &all->signals);
}

/* A port file that can't be written, on a full disk say, keeps nobody from reading; one of an earlier daemon would mislead. */
static void write_port_file(const char *name, int port)
{
    char temporary[4096];
    snprintf(temporary, sizeof temporary, "%s.tmp", name);
    FILE *file = fopen(temporary, "we");
    bool good = file && fprintf(file, "%d\n", port) > 0;
    if (file) good = fclose(file) == 0 && good;
    if (good && rename(temporary, name) == 0) return;
    log_line("port file %s can't be written: %s", name, strerror(errno));
    unlink(temporary);
    unlink(name);
}

static void announce(const parts *all)
{
    const char *host = all->settings.host;
    const bool six = strchr(host, ':') != NULL;
    printf("listening on http://%s%s%s:%d\n", six ? "[" : "", host, six ? "]" : "", all->server.port);
    fflush(stdout);
    if (all->settings.port_file) write_port_file(all->settings.port_file, all->server.port);
}

static bool open_executor(worker_executor *executor, const config *s, const data_folder *data)
{
    const slurm_settings slurm = { s->slurm_partition,  s->slurm_account,        s->slurm_qos,
                                   s->slurm_constraint, s->slurm_line,           s->slurm_lines,
                                   s->slurm_queue,      s->slurm_bundle_seconds, s->slurm_longest };
    return s->on_slurm ? executor_slurm_init(executor, &slurm, data, s->worker, s->confine)
                       : executor_local_init(executor, s->worker, s->confine, s->workers);
}

static bool open_parts(parts *all)
{
    if (!data_folder_open(&all->data, all->settings.data)) return false;
    all->store = store_open(&all->data, all->settings.queue_limit);
    if (!all->store) return false;
    all->running = &all->settings;
    all->limits = limits_of(&all->settings);
    if (!open_executor(&all->executor, &all->settings, &all->data)) return false;
    all->store->places = all->executor.places;
    if (!dispatcher_init(&all->dispatcher, all->store, &all->executor, all->settings.threads, all->signals)) return false;
    if (!dispatcher_recover(&all->dispatcher))
        log_line("jobs that an earlier daemon left running can't be put back now: tried again later");
    store_remove_unused_folders(all->store);
    readiness_init(&all->readiness, &all->dispatcher);
    all->dispatcher.jobs_changed = jobs_changed_by_worker;
    all->dispatcher.context = all;
    all->service = (api_service){ .store = all->store,
                                  .web_folder = open(all->settings.web, O_RDONLY | O_DIRECTORY | O_CLOEXEC),
                                  .api_file = all->settings.api_file,
                                  .public_url = all->settings.public_url,
                                  .default_threads = default_threads_of(&all->settings),
                                  .limits = &all->limits,
                                  .callback_hosts = { all->settings.callback_host, all->settings.callback_hosts },
                                  .daemon = all,
                                  .jobs_changed = jobs_changed_by_request,
                                  .jobs_deleted = jobs_deleted,
                                  .is_ready = is_ready,
                                  .begin_session = begin_session_of,
                                  .end_session = end_session_of,
                                  .write_metrics = write_metrics };
    if (all->service.web_folder < 0) log_line("no page: the folder %s can't be opened", all->settings.web);
    const prune_rules rules = rules_of(&all->settings);
    if (!folder_remover_start(&all->remover, all->store, &rules)) return false;
    if (all->settings.callback_hosts > 0 && !(all->callbacks = callback_sender_start(&all->service))) return false;
    if (!http_server_open(&all->server, &all->settings, &all->service) || !http_server_start(&all->server)) return false;
    all->planner = planner_start(&all->service, all->settings.worker, all->settings.confine);
    return all->planner != NULL;
}

/* What is not the service itself; the exit status. */
static int run_command(const config *settings)
{
    if (strcmp(settings->command, "backup") == 0) return backup_make(settings->data, settings->argument) ? 0 : 1;
    if (strcmp(settings->command, "submit") == 0) return client_submit(settings);
    if (strcmp(settings->command, "jobs") == 0) return client_jobs(settings);
    if (strcmp(settings->command, "show") == 0) return client_show(settings);
    if (strcmp(settings->command, "collect") == 0) return collect_study(settings->argument) ? 0 : 1;
    if (strcmp(settings->command, "check") == 0) return data_check(settings->data, settings->repair) ? 0 : 1;
    const prune_rules rules = rules_of(settings);
    if (rules.keep_days > 0 || rules.keep_bytes > 0.0) return prune_once(settings->data, &rules) ? 0 : 1;
    fputs("reposed: say what is to be kept: --keep-days N, --keep-bytes SIZE\n", stderr);
    return 2;
}

int main(int argc, char **argv)
{
    static parts all;
    if (argc == 3 && strcmp(argv[1], "openapi") == 0) return openapi_file_update(argv[2]) ? 0 : 1;
    if (argc == 2 && strcmp(argv[1], "--version") == 0) return printf("reposed " REPOSED_VERSION "%s\n", reposed_commit) < 0;
    const enum config_outcome outcome = config_read(&all.settings, argc, argv);
    if (outcome != CONFIG_READ) return outcome == CONFIG_SHOWN ? 0 : 2;
    keep_memory_small();
    json_text_watch_memory();
    umask(077);
    log_as_json(all.settings.log_json);
    if (strcmp(all.settings.command, "serve") != 0) return run_command(&all.settings);
    /* Nothing to undo on failure: the lock goes with the process, and the store is made for sudden ends. */
    if (!arrange_signals(&all) || !open_parts(&all)) {
        log_line("the daemon can't start; data folder %s", all.settings.data);
        return 1;
    }
    if (takes_hangup(&all.settings)) end_signals_on_hangup(read_options_again, &all);
    announce(&all);
    calibrator_start(all.settings.worker, all.data.path);
    dispatcher_run(&all.dispatcher, leave);
    http_server_stop(&all.server); /* first: requests wake what is stopped next */
    planner_stop(all.planner);
    folder_remover_stop(&all.remover);
    callback_sender_stop(all.callbacks);
    dispatcher_clear(&all.dispatcher);
    (all.settings.on_slurm ? executor_slurm_clear : executor_local_clear)(&all.executor);
    store_close(all.store);
    data_folder_close(&all.data);
    return 0;
}
