#include "slurm_commands.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "log.h"

#define LONGEST_COMMAND 60.0 /* s */

enum { LARGEST_ANSWER = 64 << 20, PIECE = 65536 };

/* One table for all releases: a word that a later one adds is a line here. */
static const struct state_word {
    const char *word;
    slurm_state state;
} state_words[] = {
    { "PENDING", SLURM_WAITS },
    { "CONFIGURING", SLURM_WAITS },
    { "REQUEUED", SLURM_WAITS },
    { "REQUEUE_HOLD", SLURM_WAITS },
    { "REQUEUE_FED", SLURM_WAITS },
    { "RESV_DEL_HOLD", SLURM_WAITS },
    { "SPECIAL_EXIT", SLURM_WAITS },
    { "RUNNING", SLURM_RUNS },
    { "COMPLETING", SLURM_RUNS },
    { "SUSPENDED", SLURM_RUNS },
    { "STOPPED", SLURM_RUNS },
    { "SIGNALING", SLURM_RUNS },
    { "STAGE_OUT", SLURM_RUNS },
    { "RESIZING", SLURM_RUNS },
    { "COMPLETED", SLURM_DONE },
    { "FAILED", SLURM_DONE },
    { "TIMEOUT", SLURM_OUT_OF_TIME },
    { "DEADLINE", SLURM_OUT_OF_TIME },
    { "OUT_OF_ME", SLURM_OUT_OF_MEMORY },
    { "NODE_FAIL", SLURM_LOST },
    { "BOOT_FAIL", SLURM_LOST },
    { "LAUNCH_FAILED", SLURM_LOST },
    { "RECONFIG_FAIL", SLURM_LOST },
    { "PREEMPTED", SLURM_LOST },
    { "REVOKED", SLURM_LOST },
    { "CANCELLED", SLURM_CANCELLED },
};

slurm_state slurm_state_of(const char *word)
{
    for (size_t i = 0; i < sizeof state_words / sizeof state_words[0]; i++)
        if (strncmp(word, state_words[i].word, strlen(state_words[i].word)) == 0) return state_words[i].state;
    return SLURM_WAITS;
}

typedef struct answer {
    char *text;
    size_t length;
    bool failed;
} answer;

static void add_piece(answer *to, const char *piece, size_t length)
{
    char *text = to->failed || to->length + length > LARGEST_ANSWER ? NULL : realloc(to->text, to->length + length + 1);
    to->failed = text == NULL;
    if (!text) return;
    memcpy(text + to->length, piece, length);
    text[to->length += length] = '\0';
    to->text = text;
}

/* Both to their ends, or until the time is up. */
static bool read_both(const int pipes[2], answer answers[2])
{
    static char piece[PIECE]; /* commands run one after the other */
    struct pollfd watched[2] = { { .fd = pipes[0], .events = POLLIN }, { .fd = pipes[1], .events = POLLIN } };
    const double until = monotonic_seconds() + LONGEST_COMMAND;
    while (watched[0].fd >= 0 || watched[1].fd >= 0) {
        const double left = until - monotonic_seconds();
        if (left <= 0.0 || (poll(watched, 2, (int)(1e3 * left) + 1) < 0 && errno != EINTR)) return false;
        for (int i = 0; i < 2; i++) {
            if (watched[i].fd < 0 || !watched[i].revents) continue;
            const ssize_t got = read(pipes[i], piece, sizeof piece);
            if (got > 0) add_piece(&answers[i], piece, (size_t)got);
            else if (got == 0 || errno != EINTR) watched[i].fd = -1;
        }
    }
    return true;
}

/* With default signals, none of them blocked, as a command from a shell. */
static int spawn(const char *const *argv, const int out[2], const int problems[2], pid_t *process)
{
    posix_spawn_file_actions_t files;
    posix_spawnattr_t attributes;
    sigset_t none, all;
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&files, out[1], 1);
    posix_spawn_file_actions_adddup2(&files, problems[1], 2);
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &all);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    const int code = posix_spawnp(process, argv[0], &files, &attributes, (char *const *)argv, environ);
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&attributes);
    return code;
}

static void first_line(const char *text, char reason[SLURM_REASON_SIZE])
{
    snprintf(reason, SLURM_REASON_SIZE, "%.*s", (int)strcspn(text ? text : "", "\n"), text ? text : "");
    for (char *c = reason; *c; c++)
        if ((unsigned char)*c < ' ' || (unsigned char)*c > '~') *c = '?';
}

/* The exit status; -1: it can't be had. */
static int end_of(pid_t process, bool is_in_time)
{
    int status = -1;
    if (!is_in_time) kill(process, SIGKILL);
    while (waitpid(process, &status, 0) < 0)
        if (errno != EINTR) return -1;
    return is_in_time ? status : -1;
}

char *slurm_run(const char *const *argv, char reason[SLURM_REASON_SIZE])
{
    int out[2] = { -1, -1 }, problems[2] = { -1, -1 };
    answer answers[2] = { { NULL, 0, false }, { NULL, 0, false } };
    pid_t process = -1;
    int code = pipe2(out, O_CLOEXEC) == 0 && pipe2(problems, O_CLOEXEC) == 0 ? 0 : errno;
    if (code == 0) code = spawn(argv, out, problems, &process);
    if (out[1] >= 0) close(out[1]);
    if (problems[1] >= 0) close(problems[1]);
    const bool is_in_time = code == 0 && read_both((int[]){ out[0], problems[0] }, answers);
    const int status = code == 0 ? end_of(process, is_in_time) : -1;
    if (out[0] >= 0) close(out[0]);
    if (problems[0] >= 0) close(problems[0]);
    const bool good = status == 0 && !answers[0].failed;
    if (!good && code != 0) snprintf(reason, SLURM_REASON_SIZE, "%s can't be started: %s", argv[0], strerror(code));
    else if (!good && !is_in_time) snprintf(reason, SLURM_REASON_SIZE, "%s did not answer within a minute", argv[0]);
    else if (!good) first_line(answers[1].text, reason);
    if (good && !answers[0].text) answers[0].text = strdup("");
    free(answers[1].text);
    if (good) return answers[0].text;
    free(answers[0].text);
    return NULL;
}
