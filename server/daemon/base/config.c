#include "config.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <getopt.h>
#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "config_options.h"
#include "log.h"

#define INSTALLED_FILE "/etc/reposed.conf"

enum { LONGEST_FILE = 65536, HELP_COLUMN = 23 };

/* The commands, each with what it is given. */
static const struct command {
    const char *name, *argument, *meaning;
} commands[] = {
    { "serve", NULL, "run the service until SIGTERM, SIGINT or the like" },
    { "submit", "FILE", "post a job, a study or a calibration to the service, print its id; with --wait, what becomes of it" },
    { "jobs", NULL, "list the newest jobs" },
    { "show", "ID", "show a job, and its results when there are any" },
    { "backup", "DIR", "copy the data folder of a service, also of one at work" },
    { "prune", NULL, "remove what --keep-days and --keep-bytes do not keep" },
    { "collect", "DIR", "of a study that repose split has written to DIR: its results as DIR/results.csv and DIR/reposed.sqlite" },
    { "check", NULL, "look whether the data folder is sound; with --repair, mend it" },
};
enum { COMMANDS = sizeof commands / sizeof commands[0] };

/* To whoever has just typed the command; what a running service finds goes to its log. */
static void complain(const config *settings, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void complain(const config *settings, const char *format, ...)
{
    char text[1200];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (settings->command) log_line("%s", text);
    else fprintf(stderr, "reposed: %s\n", text);
}

static void print_usage(FILE *out)
{
    fputs("reposed: virtual rotary-drum tests over HTTP\n\n", out);
    for (size_t c = 0; c < COMMANDS; c++) {
        char words[64];
        snprintf(words, sizeof words, "%s %s%s[options]", commands[c].name, commands[c].argument ? commands[c].argument : "",
                 commands[c].argument ? " " : "");
        fprintf(out, "  reposed %-26s%s\n", words, commands[c].meaning);
    }
    fputs("  reposed openapi FILE              write the schemas of inputs and results into an OpenAPI document\n"
          "  reposed --help | --version\n\n",
          out);
    for (size_t o = 0; o < config_option_count; o++) {
        const config_option *option = &config_options[o];
        char words[64];
        snprintf(words, sizeof words, "--%s%s%s", option->name, option->argument ? " " : "",
                 option->argument ? option->argument : "");
        fprintf(out, "  %-*s", HELP_COLUMN - 2, words);
        if (strlen(words) > HELP_COLUMN - 3) fprintf(out, "\n%*s", HELP_COLUMN, "");
        for (const char *c = option->meaning; *c; c++) {
            fputc(*c, out);
            if (*c == '\n') fprintf(out, "%*s", HELP_COLUMN, "");
        }
        fputc('\n', out);
    }
}

/* --- the file --- */

static char *read_file(const config *settings, const char *name)
{
    const int file = open(name, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    struct stat facts;
    errno = file >= 0 ? 0 : errno;
    char *text = file >= 0 && fstat(file, &facts) == 0 && S_ISREG(facts.st_mode) ? calloc(1, LONGEST_FILE + 1) : NULL;
    const ssize_t length = text ? read(file, text, LONGEST_FILE + 1) : -1;
    const char *reason = errno ? strerror(errno) : "no plain file";
    if (file >= 0) close(file);
    if (length >= 0 && length <= LONGEST_FILE && strlen(text) == (size_t)length) return text;
    complain(settings, "%s can't be read: %s", name,
             length > LONGEST_FILE ? "it has more than 64 kB"
             : length >= 0         ? "no text"
                                   : reason);
    free(text);
    return NULL;
}

static char *trim(char *text)
{
    while (isspace((unsigned char)*text)) text++;
    char *end = text + strlen(text);
    while (end > text && isspace((unsigned char)end[-1])) end--;
    *end = '\0';
    return text;
}

/* "name = value"; seen: the line on which each option was given. */
static bool take_line(config *settings, const char *file, int line, char *text, int *seen)
{
    char *equals = strchr(text, '='), problem[OPTION_PROBLEM_SIZE];
    if (equals) *equals = '\0';
    const char *name = trim(text), *value = equals ? trim(equals + 1) : NULL;
    const config_option *option = config_option_named(name);
    if (!value) complain(settings, "%s, line %d: \"%.100s\" is not understood; must be a name, = and a value", file, line, name);
    else if (!option || option->kind == OPTION_FLAG || strcmp(name, "config") == 0)
        complain(settings, "%s, line %d: there is no option \"%.100s\"; reposed --help lists them", file, line, name);
    else if (seen[option - config_options] && !option->may_repeat)
        complain(settings, "%s, line %d: %s was given on line %d already; must be given once", file, line, name,
                 seen[option - config_options]);
    else if (!config_option_take(option, settings, value, problem))
        complain(settings, "%s, line %d: %s is \"%.200s\"; must be %s", file, line, name, value, problem);
    else {
        seen[option - config_options] = line;
        return true;
    }
    return false;
}

static bool take_file(config *settings, const char *file)
{
    int seen[MOST_OPTIONS] = { 0 }, line = 0;
    bool good = (settings->file_text = read_file(settings, file)) != NULL;
    for (char *rest = settings->file_text, *text; (text = strsep(&rest, "\n")) != NULL;) {
        line++;
        text = trim(text);
        if (*text && *text != '#') good = take_line(settings, file, line, text, seen) && good;
    }
    return good;
}

/* --- the command line --- */

static void list_options(struct option list[MOST_OPTIONS + 2])
{
    for (size_t o = 0; o < config_option_count; o++)
        list[o] = (struct option){ config_options[o].name, config_options[o].argument != NULL, NULL, 0 };
    list[config_option_count] = (struct option){ "help", 0, NULL, 'h' };
    list[config_option_count + 1] = (struct option){ NULL, 0, NULL, 0 };
}

typedef struct given_option {
    const config_option *option;
    const char *value;
} given_option;

/* The file first, so that the command line has the last word. */
static bool take_all(config *settings, const given_option *given, size_t count)
{
    bool good = true;
    const char *file = settings->is_installed && access(INSTALLED_FILE, F_OK) == 0 ? INSTALLED_FILE : NULL;
    for (size_t g = 0; g < count; g++)
        if (strcmp(given[g].option->name, "config") == 0) file = given[g].value;
    if (file) good = take_file(settings, file);
    for (size_t g = 0; g < count; g++) {
        char problem[OPTION_PROBLEM_SIZE];
        if (config_option_take(given[g].option, settings, given[g].value, problem)) continue;
        complain(settings, "--%s is \"%.200s\"; must be %s", given[g].option->name, given[g].value, problem);
        good = false;
    }
    settings->file = file;
    return good;
}

static enum config_outcome read_options(config *settings, const struct command *command)
{
    struct option list[MOST_OPTIONS + 2];
    given_option given[4 * MOST_OPTIONS];
    size_t count = 0;
    int which = 0;
    list_options(list);
    optind = 0; /* from the beginning, also the second time */
    for (int code; (code = getopt_long(settings->word_count, settings->word, "h", list, &which)) != -1;) {
        if (code == 'h') {
            print_usage(stdout);
            return CONFIG_SHOWN;
        }
        if (code != 0 || count == sizeof given / sizeof *given) return CONFIG_WRONG; /* getopt has said why */
        given[count++] = (given_option){ &config_options[which], optarg };
    }
    const int most = command->argument ? 1 : 0;
    settings->argument = optind < settings->word_count && most ? settings->word[optind] : NULL;
    if (optind + most < settings->word_count)
        complain(settings, "\"%s\" is not understood; see reposed --help", settings->word[optind + most]);
    else if (most && !settings->argument && *command->argument != '[')
        complain(settings, "say which %s: reposed %s %s", command->argument, command->name, command->argument);
    else return take_all(settings, given, count) ? CONFIG_READ : CONFIG_WRONG;
    return CONFIG_WRONG;
}

/* --- what lies where --- */

/* Beside the program as it is built, or below the prefix that its folder, PREFIX/lib/reposed, was installed with. */
static void find_parts(config *settings)
{
    char program[3900] = "";
    if (readlink("/proc/self/exe", program, sizeof program - 1) < 0) program[0] = '\0';
    char *name = strrchr(program, '/');
    if (name) *name = '\0';
    snprintf(settings->worker_found, sizeof settings->worker_found, "%s/repose", program);
    snprintf(settings->web_found, sizeof settings->web_found, "%s/../../share/reposed/web", program);
    settings->is_installed = access(settings->web_found, X_OK) == 0;
    const char *shared = settings->is_installed ? "../../share/reposed" : "..";
    snprintf(settings->web_found, sizeof settings->web_found, "%s/%s/web", program, shared);
    snprintf(settings->api_found, sizeof settings->api_found, "%s/%s/api/openapi.yaml", program, shared);
    settings->worker = settings->worker_found;
    settings->web = settings->web_found;
    settings->api_file = settings->api_found;
}

static bool find_worker(config *settings)
{
    char found[PATH_MAX];
    if (access(settings->worker, X_OK) != 0 || !realpath(settings->worker, found)) {
        complain(settings, "the worker program %s can't be started: %s (--worker names another)", settings->worker,
                 strerror(errno));
        return false;
    }
    snprintf(settings->worker_found, sizeof settings->worker_found, "%s", found);
    settings->worker = settings->worker_found;
    return true;
}

static enum config_outcome read_all(config *settings, const struct command *command)
{
    const long cores = sysconf(_SC_NPROCESSORS_ONLN);
    settings->host = "127.0.0.1";
    settings->data = "data";
    settings->port = 8080;
    settings->threads = 1;
    settings->queue_limit = 10000;
    settings->address_rate = 2000;
    settings->confine = true;
    settings->slurm_queue = 200;
    settings->slurm_bundle_seconds = 300;
    settings->slurm_longest = 86400.0;
    settings->workers = cores < 1 ? 1 : cores > CONFIG_MOST_WORKERS ? CONFIG_MOST_WORKERS : (int)cores;
    find_parts(settings);
    const enum config_outcome outcome = read_options(settings, command);
    const bool serves = command == &commands[0];
    return outcome == CONFIG_READ && serves && !find_worker(settings) ? CONFIG_WRONG : outcome;
}

static const struct command *command_named(const char *name)
{
    for (size_t c = 0; c < COMMANDS; c++)
        if (strcmp(commands[c].name, name) == 0) return &commands[c];
    return NULL;
}

enum config_outcome config_read(config *settings, int argc, char **argv)
{
    const char *word = argc > 1 ? argv[1] : "";
    const struct command *command = command_named(word);
    *settings = (config){ .command = NULL };
    if (strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0) {
        print_usage(stdout);
        return CONFIG_SHOWN;
    }
    if (!command) {
        if (*word) fprintf(stderr, "reposed: \"%s\" is not a command; say \"reposed serve\"\n", word);
        print_usage(stderr);
        return CONFIG_WRONG;
    }
    argv[1] = argv[0]; /* in the place of the command: getopt begins its complaints with it */
    settings->word_count = argc - 1;
    settings->word = argv + 1;
    const enum config_outcome outcome = read_all(settings, command);
    settings->command = command->name;
    return outcome;
}

bool config_read_again(config *fresh, const config *running)
{
    *fresh = (config){ .command = running->command, .word_count = running->word_count, .word = running->word };
    return read_all(fresh, command_named(running->command)) == CONFIG_READ;
}

void config_clear(config *settings)
{
    free(settings->file_text);
    settings->file_text = NULL;
}

/* Options that take a restart are kept in one place each. */
static void keep_running(const config_option *option, config *fresh, const config *running)
{
    const size_t size = option->kind == OPTION_WHOLE    ? sizeof(int)
                        : option->kind == OPTION_TEXT   ? sizeof(char *)
                        : option->kind == OPTION_AMOUNT ? sizeof(double)
                                                        : sizeof(bool); /* confine */
    memcpy((char *)fresh + option->offset, (const char *)running + option->offset, size);
}

int config_compare(config *fresh, const config *running)
{
    int changes = 0;
    for (size_t o = 0; o < config_option_count; o++) {
        const config_option *option = &config_options[o];
        char now[300], before[300];
        if (strcmp(option->name, "config") == 0 || config_option_is_same(option, fresh, running)) continue;
        config_option_text(option, fresh, now, sizeof now);
        config_option_text(option, running, before, sizeof before);
        if (option->is_live)
            log_line("%s is now %s%s%s", option->name, now, option->take ? "" : ", was ", option->take ? "" : before);
        else log_line("%s stays %s; that it is to be %s takes a restart", option->name, option->take ? "as it is" : before, now);
        if (option->is_live) changes++;
        else keep_running(option, fresh, running);
    }
    return changes;
}
