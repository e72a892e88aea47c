/* repose-plan: what a calibration does next. `repose plan` hands over to it, so that no other program loads the linear algebra. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "confine_calls.h"
#include "confine_files.h"
#include "json_text.h"
#include "plan.h"
#include "version.h"

enum { PLAN_DONE = 0, PLAN_FAULT = 1, PLAN_REFUSED = 2, PLAN_MACHINE = 6, LONGEST_INPUT = 200000000 };

#define HELP                                                                                                                       \
    "repose plan FILE              read {\"request\", \"runs\", \"workers\"} of a calibration (\"-\": stdin) and print as JSON\n"  \
    "                              which cases to run next, or the answer; or every problem of the request\n"                      \
    "    --confine                 from stdin alone: open no file, start no program and use no network\n"

/* The whole of it, to be freed; NULL: it can't be read, or is longer than 200 MB. */
static char *read_all(FILE *file, size_t *length)
{
    size_t room = 1 << 16;
    char *text = malloc(room);
    *length = 0;
    while (text) {
        *length += fread(text + *length, 1, room - *length, file);
        if (*length < room) break;
        room *= 2;
        char *more = room <= LONGEST_INPUT ? realloc(text, room) : NULL;
        if (!more) free(text);
        text = more;
    }
    if (!text || !ferror(file)) return text;
    free(text);
    return NULL;
}

static json_t *read_document(const char *name, problem_list *problems)
{
    FILE *file = strcmp(name, "-") == 0 ? stdin : fopen(name, "rb");
    size_t length;
    char *text = file ? read_all(file, &length) : NULL;
    json_t *document = text ? json_text_load(text, length, problems) : NULL;
    if (!text) problem_list_add(problems, "", "can't read %.200s, or it is longer than 200 MB", name);
    free(text);
    if (file && file != stdin) fclose(file);
    return document;
}

static bool print_json(json_t *document)
{
    char *text = json_text_write(document);
    const bool good = text && fputs(text, stdout) >= 0 && fflush(stdout) == 0;
    free(text);
    json_decref(document);
    return good;
}

/* OpenBLAS, where it stands in for the reference, sums in the order of its threads, which it makes as it is loaded. */
static void hold_to_one_thread(char **argv)
{
    const char *threads = getenv("OPENBLAS_NUM_THREADS");
    if (threads && strcmp(threads, "1") == 0) return;
    setenv("OPENBLAS_NUM_THREADS", "1", 1);
    setenv("OMP_NUM_THREADS", "1", 1);
    execv("/proc/self/exe", argv);
    fputs("repose-plan: can't start again with one thread; going on\n", stderr);
}

/* What it reads came from clients, and runs gave it numbers: a fault in what reads them must give nobody more than an answer. A kernel
 * that lacks one of these confines by the other. */
static bool confine(void)
{
    int version;
    bool has_calls;
    if (confine_files("", NULL, &version) && confine_calls(false, &has_calls)) return true;
    perror("repose-plan: can't be confined");
    return false;
}

int main(int argc, char **argv)
{
    if (argc == 2 && strcmp(argv[1], "--version") == 0) return printf("repose-plan " REPOSED_VERSION "%s\n", reposed_commit) < 0;
    if (argc == 2 && (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0)) return fputs(HELP, stdout) < 0;
    const bool is_confined = argc == 3 && strcmp(argv[1], "-") == 0 && strcmp(argv[2], "--confine") == 0;
    if (argc != 2 && !is_confined) {
        fputs("repose: give one FILE\n" HELP, stderr);
        return PLAN_REFUSED;
    }
    hold_to_one_thread(argv);
    if (is_confined && !confine()) return PLAN_MACHINE;
    problem_list problems;
    if (!problem_list_init(&problems)) return PLAN_FAULT;
    json_t *document = read_document(argv[1], &problems), *plan = document ? plan_next(document, &problems) : NULL;
    int exit = plan ? PLAN_DONE : PLAN_REFUSED;
    if (!plan && problem_list_is_empty(&problems)) {
        fputs("repose-plan: out of memory, or a matrix that can't be factored\n", stderr);
        exit = PLAN_FAULT;
    } else if (!plan) {
        plan = problem_json(400, "about:blank", "Bad calibration", "The calibration can't be planned as it is.", &problems);
    }
    if (plan && !print_json(plan)) exit = PLAN_FAULT;
    json_decref(document);
    problem_list_clear(&problems);
    return exit;
}
