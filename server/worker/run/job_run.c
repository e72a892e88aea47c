/* What an attempt at any job has in common: the job folder before, the result after. The process's own runner does what
 * lies between. */
#include "job_run.h"

#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "attempt_fence.h"
#include "drum_run.h"
#include "failure_report.h"
#include "file_seal.h"
#include "fill_run.h"
#include "granule_run.h"
#include "heap_run.h"
#include "json_text.h"
#include "orifice_run.h"
#include "result_warnings.h"
#include "run_folder.h"
#include "run_summary.h"
#include "start_file.h"
#include "worker_log.h"

enum { LONGEST_RESULT = 16 << 20 };

typedef struct job_runner {
    const char *process;
    enum worker_exit (*run)(const job_context *job);
    void (*summarize)(const json_t *result, const char *folder);
} job_runner;

static const job_runner runners[] = {
    { "drum", drum_run, terminal_summary },      { "fill", fill_run, fill_summary },          { "heap", heap_run, heap_summary },
    { "granule", granule_run, granule_summary }, { "orifice", orifice_run, orifice_summary },
};

/* NULL: none, which is our own mistake. */
static const job_runner *runner_of(const char *process)
{
    for (size_t r = 0; r < sizeof runners / sizeof runners[0]; r++)
        if (strcmp(runners[r].process, process) == 0) return &runners[r];
    return NULL;
}

static volatile sig_atomic_t stop_requested;

static void request_stop(int signal_number)
{
    (void)signal_number;
    stop_requested = 1;
}

static const int stop_signals[] = { JOB_STOP_SIGNALS };
enum { STOP_SIGNALS = sizeof stop_signals / sizeof stop_signals[0] };

static void all_stop_signals(sigset_t *set)
{
    sigemptyset(set);
    for (size_t s = 0; s < STOP_SIGNALS; s++) sigaddset(set, stop_signals[s]);
    for (int real_time = SIGRTMIN; real_time <= SIGRTMAX; real_time++) sigaddset(set, real_time);
}

void job_run_hold_signals(void)
{
    sigset_t held;
    all_stop_signals(&held);
    sigprocmask(SIG_BLOCK, &held, NULL);
}

void job_run_catch_signals(void)
{
    struct sigaction before, action = { .sa_handler = request_stop, .sa_flags = SA_RESTART };
    sigset_t caught;
    all_stop_signals(&caught);
    for (int number = 1; number <= SIGRTMAX; number++)
        if (sigismember(&caught, number) == 1 && sigaction(number, NULL, &before) == 0 && before.sa_handler != SIG_IGN)
            sigaction(number, &action, NULL); /* what is ignored stays so: nohup does that to SIGHUP */
    sigprocmask(SIG_UNBLOCK, &caught, NULL);
    /* A limit on the size of files is then a write that fails, like a full disk. */
    signal(SIGXFSZ, SIG_IGN);
    signal(SIGPIPE, SIG_IGN);
}

bool job_run_is_asked_to_stop(void) { return stop_requested; }

void job_run_ask_to_stop(void) { stop_requested = 1; }

enum worker_exit job_run_write_result(const job_spec *spec, event_log *events, json_t *document)
{
    char *text = result_warnings_add(spec, document) ? json_text_write(document) : NULL;
    char *origin = text ? job_spec_to_text(spec) : NULL;
    json_decref(document);
    /* The events must be safe before the file that says all is done. */
    const bool written = origin && event_log_sync(events) && file_write_sealed(JOB_RESULT_FILE, text, strlen(text), origin);
    const bool had_memory = origin;
    free(text);
    free(origin);
    if (!had_memory) return failure_report(events, DEM_NO_MEMORY, NULL);
    return written ? WORKER_DONE : failure_report_disk(events, JOB_RESULT_FILE);
}

/* FILE_WHOLE: an object that is as it was written, and made from this spec. */
static file_state look_at_result(const char *spec)
{
    size_t length;
    file_state state;
    char *text = file_read_sealed(JOB_RESULT_FILE, LONGEST_RESULT, spec, &length, &state);
    json_t *result = text ? json_loadb(text, length, 0, NULL) : NULL;
    if (state == FILE_WHOLE && !json_is_object(result)) state = FILE_DAMAGED;
    json_decref(result);
    free(text);
    return state;
}

static enum worker_exit run_in_folder(const job_runner *runner, const job_context *job, const char *text)
{
    const file_state result = look_at_result(text);
    const folder_owner owner = run_folder_owner(text, job->params);
    if (result == FILE_UNREADABLE || owner == FOLDER_UNREADABLE) return WORKER_DISK;
    if (result != FILE_ABSENT && owner == FOLDER_OF_ANOTHER) {
        worker_warn("the folder holds the results of another spec, which are kept: name another folder or remove this one");
        return WORKER_BAD_SPEC;
    }
    if (!run_folder_claim(owner, text, job->events)) return WORKER_DISK;
    if (result == FILE_WHOLE) {
        worker_log("%s is there already: this run is complete", JOB_RESULT_FILE);
        return WORKER_DONE;
    }
    if (result == FILE_DAMAGED) {
        worker_warn("%s is damaged, or not that of this spec, and is made anew", JOB_RESULT_FILE);
        unlink(JOB_RESULT_FILE);
    }
    if (job->options->start && !start_file_bring(job->options->start)) return WORKER_DISK;
    return runner->run(job);
}

enum worker_exit job_run(const job_spec *spec, const char *folder, const run_options *options)
{
    const job_runner *runner = runner_of(spec->process);
    char *text = job_spec_to_text(spec), *brief = job_spec_to_brief(spec);
    event_log events = { .fd = -1 };
    enum worker_exit exit = WORKER_MACHINE;
    if (!text || !brief) worker_warn("out of memory");
    else if (!runner) exit = WORKER_FAULT;
    else if (!attempt_fence_take(folder, options->start_number)) exit = WORKER_SUPERSEDED;
    else if (run_folder_enter(folder, &events)) exit = run_in_folder(runner, &(job_context){ spec, options, brief, &events }, text);
    else exit = WORKER_DISK;
    event_log_close(&events);
    if (exit != WORKER_SUPERSEDED || attempt_fence_look(options->start_number) == FENCE_IS_LOST)
        attempt_fence_leave(options->start_number);
    free(text);
    free(brief);
    return exit;
}

void job_run_summarize(const job_spec *spec, const json_t *result, const char *folder)
{
    const job_runner *runner = runner_of(spec->process);
    if (runner) runner->summarize(result, folder);
}
