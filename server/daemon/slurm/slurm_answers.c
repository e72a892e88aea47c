#include "slurm_answers.h"

#include <stdlib.h>
#include <string.h>

/* The next field of a line, which is cut out of it; "": there is none. */
static char *next_field(char **line)
{
    char *field = strsep(line, "|");
    return field ? field : "";
}

static bool has_room(slurm_answers *answers)
{
    if (answers->count < answers->room) return true;
    const size_t room = answers->room ? 2 * answers->room : 256;
    slurm_answer *list = realloc(answers->answer, room * sizeof *list);
    if (!list) return false;
    answers->answer = list;
    answers->room = room;
    return true;
}

static int rank_of(slurm_state state) { return state == SLURM_RUNS ? 0 : state == SLURM_WAITS ? 1 : 2; }

static int by_name_and_life(const void *one, const void *other)
{
    const slurm_answer *a = one, *b = other;
    const int names = strcmp(a->name, b->name), ranks = rank_of(a->state) - rank_of(b->state);
    if (names != 0) return names;
    if (ranks != 0) return ranks;
    const long first = strtol(a->id, NULL, 10), second = strtol(b->id, NULL, 10);
    return (first < second) - (first > second);
}

static void sort(slurm_answers *answers)
{
    if (answers->count) qsort(answers->answer, answers->count, sizeof *answers->answer, by_name_and_life);
}

/* ID|STATE|NAME|REASON a line. */
static bool read_lines(slurm_answers *answers, char *text)
{
    for (char *line; (line = strsep(&text, "\n")) != NULL;) {
        char *id = next_field(&line), *state = next_field(&line), *name = next_field(&line), *reason = next_field(&line);
        if (strncmp(name, SLURM_NAME_START, sizeof SLURM_NAME_START - 1) != 0) continue;
        if (!has_room(answers)) return false;
        answers->answer[answers->count++] = (slurm_answer){ name + sizeof SLURM_NAME_START - 1, id, reason, slurm_state_of(state) };
    }
    sort(answers);
    return true;
}

bool slurm_answers_ask(slurm_answers *answers, char reason[SLURM_REASON_SIZE])
{
    static const char *const command[] = { "squeue", "--me", "--noheader", "--states=all", "--format=%i|%T|%j|%r", NULL };
    *answers = (slurm_answers){ .text = slurm_run(command, reason) };
    return answers->text && read_lines(answers, answers->text);
}

void slurm_answers_ask_accounts(slurm_answers *answers, const char *ids)
{
    const char *const command[] = { "sacct", "-X", "-n", "-P", "-o", "JobIDRaw,State,JobName,ExitCode", "-j", ids, NULL };
    char ignored[SLURM_REASON_SIZE];
    answers->accounts = slurm_run(command, ignored);
    if (answers->accounts) read_lines(answers, answers->accounts);
}

static int compare_names(const void *name, const void *answer) { return strcmp(name, ((const slurm_answer *)answer)->name); }

const slurm_answer *slurm_answers_find(const slurm_answers *answers, const char *bundle)
{
    const slurm_answer *found =
        answers->count ? bsearch(bundle, answers->answer, answers->count, sizeof *answers->answer, compare_names) : NULL;
    while (found && found > answers->answer && strcmp(found[-1].name, bundle) == 0) found--;
    return found;
}

void slurm_answers_clear(slurm_answers *answers)
{
    free(answers->text);
    free(answers->accounts);
    free(answers->answer);
    *answers = (slurm_answers){ .count = 0 };
}
