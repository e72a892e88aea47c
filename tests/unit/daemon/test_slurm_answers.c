/* What releases of Slurm say, as their squeue and sacct have said it, and what it means. */
#include <fcntl.h>
#include <setjmp.h>
#include <sys/stat.h>
#include <unistd.h>

#include "claims.h"
#include "slurm_answers.h"

static char folder[] = "/tmp/slurm_answers_XXXXXX";

/* A command of that name, which says the text and ends so. */
static void make_command(const char *name, const char *text, const char *problem, int code)
{
    char path[200];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    unlink(path);
    const int file = open(path, O_WRONLY | O_CREAT | O_CLOEXEC, 0700);
    assert_true(file >= 0);
    dprintf(file, "#!/bin/sh\ncat <<'END'\n%sEND\ntest -z '%s' || echo '%s' >&2\nexit %d\n", text, problem, problem, code);
    close(file);
}

static int make_folder(void **state)
{
    char path[4096];
    (void)state;
    if (!mkdtemp(folder)) return -1;
    snprintf(path, sizeof path, "%s:%s", folder, getenv("PATH"));
    return setenv("PATH", path, 1);
}

static int remove_folder(void **state)
{
    char path[200];
    (void)state;
    snprintf(path, sizeof path, "%s/squeue", folder);
    unlink(path);
    snprintf(path, sizeof path, "%s/sacct", folder);
    unlink(path);
    return rmdir(folder);
}

static void states_of_all_releases_are_known(void **state)
{
    static const struct {
        const char *word;
        slurm_state state;
    } rows[] = {
        /* 21.08, in full as %T has them */
        { "PENDING", SLURM_WAITS },
        { "CONFIGURING", SLURM_WAITS },
        { "RUNNING", SLURM_RUNS },
        { "COMPLETING", SLURM_RUNS },
        { "SUSPENDED", SLURM_RUNS },
        { "COMPLETED", SLURM_DONE },
        { "FAILED", SLURM_DONE },
        { "TIMEOUT", SLURM_OUT_OF_TIME },
        { "DEADLINE", SLURM_OUT_OF_TIME },
        { "OUT_OF_MEMORY", SLURM_OUT_OF_MEMORY },
        { "NODE_FAIL", SLURM_LOST },
        { "BOOT_FAIL", SLURM_LOST },
        { "PREEMPTED", SLURM_LOST },
        { "CANCELLED", SLURM_CANCELLED },
        /* sacct's, with who did it, and cut off */
        { "CANCELLED by 1000", SLURM_CANCELLED },
        { "OUT_OF_ME+", SLURM_OUT_OF_MEMORY },
        /* 22.05 */
        { "LAUNCH_FAILED", SLURM_LOST },
        { "REQUEUE_FED", SLURM_WAITS },
        { "SIGNALING", SLURM_RUNS },
        { "STAGE_OUT", SLURM_RUNS },
        { "REVOKED", SLURM_LOST },
        /* 23.11 */
        { "RECONFIG_FAIL", SLURM_LOST },
        { "RESIZING", SLURM_RUNS },
        /* none yet: asked again */
        { "LEVITATING", SLURM_WAITS },
    };
    (void)state;
    for (size_t r = 0; r < sizeof rows / sizeof rows[0]; r++)
        if (slurm_state_of(rows[r].word) != rows[r].state)
            fail_msg("%s is taken for %d", rows[r].word, slurm_state_of(rows[r].word));
}

static void lines_of_squeue_are_read_by_name(void **state)
{
    slurm_answers answers;
    char reason[SLURM_REASON_SIZE] = "";
    (void)state;
    make_command("squeue",
                 "812|PENDING|reposed-20260901-120000-1a2b3c4d.1|QOSMaxJobsPerUserLimit\n"
                 "813|RUNNING|reposed-20260901-120000-1a2b3c4e.2|None\n"
                 "814|RUNNING|a job of somebody's|None\n"
                 "815|NODE_FAIL|reposed-20260901-120000-1a2b3c4f.1|NodeDown\n"
                 "816|PENDING|reposed-20260901-120000-1a2b3c50.1|Nodes required for job are DOWN, DRAINED or reserved\n"
                 "817\n"
                 "\n",
                 "", 0);
    assert_true(slurm_answers_ask(&answers, reason));
    assert_int_equal(answers.count, 4);
    const slurm_answer *waits = slurm_answers_find(&answers, "20260901-120000-1a2b3c4d.1");
    assert_non_null(waits);
    assert_string_equal(waits->id, "812");
    assert_string_equal(waits->reason, "QOSMaxJobsPerUserLimit");
    assert_int_equal(waits->state, SLURM_WAITS);
    assert_int_equal(slurm_answers_find(&answers, "20260901-120000-1a2b3c4e.2")->state, SLURM_RUNS);
    assert_int_equal(slurm_answers_find(&answers, "20260901-120000-1a2b3c4f.1")->state, SLURM_LOST);
    assert_string_equal(slurm_answers_find(&answers, "20260901-120000-1a2b3c50.1")->reason,
                        "Nodes required for job are DOWN, DRAINED or reserved");
    assert_null(slurm_answers_find(&answers, "20260901-120000-1a2b3c4e.1"));
    slurm_answers_clear(&answers);
}

/* One that was submitted twice: what is alive counts, else the latest. */
static void of_several_jobs_of_a_name_the_living_one_counts(void **state)
{
    slurm_answers answers;
    char reason[SLURM_REASON_SIZE] = "";
    (void)state;
    make_command("squeue",
                 "90|CANCELLED|reposed-one.1|None\n91|RUNNING|reposed-one.1|None\n99|PENDING|reposed-one.1|None\n"
                 "7|FAILED|reposed-two.1|NonZeroExitCode\n100|COMPLETED|reposed-two.1|None\n",
                 "", 0);
    assert_true(slurm_answers_ask(&answers, reason));
    assert_string_equal(slurm_answers_find(&answers, "one.1")->id, "91");
    assert_string_equal(slurm_answers_find(&answers, "two.1")->id, "100");
    slurm_answers_clear(&answers);
}

/* 23.11 has the state's reason in a member of its own with sacct, and job numbers of arrays as 812_3: both come as raw numbers. */
static void accounts_tell_of_what_squeue_has_forgotten(void **state)
{
    slurm_answers answers;
    char reason[SLURM_REASON_SIZE] = "";
    (void)state;
    make_command("squeue", "", "", 0);
    make_command(
        "sacct",
        "812|CANCELLED by 1000|reposed-one.1|0:15\n813|OUT_OF_MEMORY|reposed-two.1|0:125\n814|BOOT_FAIL|reposed-three.1|1:0\n", "",
        0);
    assert_true(slurm_answers_ask(&answers, reason));
    assert_null(slurm_answers_find(&answers, "one.1"));
    slurm_answers_ask_accounts(&answers, "812,813,814");
    assert_int_equal(slurm_answers_find(&answers, "one.1")->state, SLURM_CANCELLED);
    assert_int_equal(slurm_answers_find(&answers, "two.1")->state, SLURM_OUT_OF_MEMORY);
    assert_int_equal(slurm_answers_find(&answers, "three.1")->state, SLURM_LOST);
    slurm_answers_clear(&answers);
    /* Where nothing is accounted sacct fails, and nothing is added. */
    make_command("sacct", "", "Slurm accounting storage is disabled", 1);
    assert_true(slurm_answers_ask(&answers, reason));
    slurm_answers_ask_accounts(&answers, "812");
    assert_int_equal(answers.count, 0);
    slurm_answers_clear(&answers);
}

static void a_controller_that_is_down_is_told_in_its_own_words(void **state)
{
    slurm_answers answers;
    char reason[SLURM_REASON_SIZE] = "";
    (void)state;
    make_command("squeue", "", "slurm_load_jobs error: Unable to contact slurm controller (connect failure)", 1);
    assert_false(slurm_answers_ask(&answers, reason));
    assert_string_equal(reason, "slurm_load_jobs error: Unable to contact slurm controller (connect failure)");
    assert_null(slurm_answers_find(&answers, "one.1"));
    slurm_answers_clear(&answers);
}

int main(void)
{
    return RUN_UNIT_TESTS(make_folder, remove_folder, states_of_all_releases_are_known, lines_of_squeue_are_read_by_name,
                          of_several_jobs_of_a_name_the_living_one_counts, accounts_tell_of_what_squeue_has_forgotten,
                          a_controller_that_is_down_is_told_in_its_own_words);
}
