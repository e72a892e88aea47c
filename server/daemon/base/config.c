#include "config.h"

#include <errno.h>
#include <getopt.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "service.h"

static const char usage[] = "reposed: virtual rotary-drum tests over HTTP\n"
                            "\n"
                            "  reposed serve [options]     run the service until SIGTERM, SIGINT or the like\n"
                            "  reposed openapi FILE        write the schemas of inputs and results into an OpenAPI document\n"
                            "  reposed --help | --version\n"
                            "\n"
                            "  --host ADDRESS       where to listen (127.0.0.1); beyond loopback needs --token-file\n"
                            "  --port NUMBER        0 to 65535 (8080); 0 takes any free port and prints it\n"
                            "  --data DIR           database and job folders, made when missing (./data)\n"
                            "  --workers N          jobs at once, 1 to 256 (one for each core)\n"
                            "  --threads N          threads of a job that does not ask, 1 to 256 (1)\n"
                            "  --queue-limit N      jobs that may wait, 1 to 1000000 (10000); a study that makes more is refused\n"
                            "  --token-file FILE    clients must send \"Authorization: Bearer\" with its text; mode 0600\n"
                            "  --allow-host NAME    accept this name in the Host header; may be given 8 times\n"
                            "  --public-url URL     what addresses begin with for clients, as https://host/prefix behind a proxy\n"
                            "  --port-file FILE     write the port there once it is open\n"
                            "  --worker PATH        the worker program (repose, beside this one)\n"
                            "  --web DIR            the page (../web from this program)\n"
                            "  --api-file FILE      the OpenAPI document (../api/openapi.yaml from this program)\n";

static bool beside_program(char path[4096], const char *relative)
{
    char program[3900];
    const ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
    if (length <= 0) return false;
    program[length] = '\0';
    *strrchr(program, '/') = '\0';
    snprintf(path, 4096, "%s/%s", program, relative);
    return true;
}

static bool read_number(const char *name, const char *text, int low, int high, int *value)
{
    char *end;
    errno = 0;
    const long number = strtol(text, &end, 10);
    if (errno == 0 && end != text && *end == '\0' && number >= low && number <= high) {
        *value = (int)number;
        return true;
    }
    fprintf(stderr, "reposed: --%s is \"%s\"; must be a whole number in [%d, %d]\n", name, text, low, high);
    return false;
}

static void copy_path(char path[4096], const char *text) { snprintf(path, 4096, "%s", text); }

/* "http[s]://host[:port][/prefix]"; it goes into addresses as it is. */
static bool take_public_url(config *settings, const char *value)
{
    static char kept[300];
    static const char path[] = "/abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-._~", *letters = path + 1;
    const char *host = strncmp(value, "https://", 8) == 0 ? value + 8 : strncmp(value, "http://", 7) == 0 ? value + 7 : NULL;
    size_t length = strlen(value);
    while (host && length > 0 && value[length - 1] == '/') length--;
    const size_t name = host ? (*host == '[' ? strcspn(host, "]") + 1 : strspn(host, letters)) : 0;
    const char *rest = host && name > 0 && name < sizeof settings->public_host ? host + name : "?";
    if (*rest == ':') rest += 1 + strspn(rest + 1, "0123456789");
    const bool good = (*rest == '\0' || *rest == '/') && rest[strspn(rest, path)] == '\0' && !strstr(rest, "//")
                      && !strstr(rest, "/.") && length < sizeof kept;
    if (!good) {
        fprintf(stderr, "reposed: --public-url is \"%s\"; must be http:// or https:// with a host and perhaps a port and a path\n",
                value);
        return false;
    }
    snprintf(kept, sizeof kept, "%.*s", (int)length, value);
    const bool six = *host == '[';
    snprintf(settings->public_host, sizeof settings->public_host, "%.*s", (int)(six ? name - 2 : name), host + six);
    settings->public_url = kept;
    return true;
}

static bool take_option(config *settings, const char *name, const char *value)
{
    if (strcmp(name, "port") == 0) return read_number(name, value, 0, 65535, &settings->port);
    if (strcmp(name, "workers") == 0) return read_number(name, value, 1, CONFIG_MOST_WORKERS, &settings->workers);
    if (strcmp(name, "threads") == 0) return read_number(name, value, 1, 256, &settings->threads);
    if (strcmp(name, "queue-limit") == 0) return read_number(name, value, 1, 1000000, &settings->queue_limit);
    if (strcmp(name, "host") == 0) settings->host = value;
    if (strcmp(name, "data") == 0) settings->data = value;
    if (strcmp(name, "token-file") == 0) settings->token_file = value;
    if (strcmp(name, "port-file") == 0) settings->port_file = value;
    if (strcmp(name, "worker") == 0) copy_path(settings->worker, value);
    if (strcmp(name, "web") == 0) copy_path(settings->web, value);
    if (strcmp(name, "api-file") == 0) copy_path(settings->api_file, value);
    if (strcmp(name, "public-url") == 0) return take_public_url(settings, value);
    if (strcmp(name, "allow-host") == 0) {
        if (settings->allowed_hosts == CONFIG_HOSTS) {
            fprintf(stderr, "reposed: --allow-host is given more than %d times\n", CONFIG_HOSTS);
            return false;
        }
        settings->allowed_host[settings->allowed_hosts++] = value;
    }
    return true;
}

static enum config_outcome read_options(config *settings, int argc, char **argv)
{
    static const struct option options[] = {
        { "host", 1, NULL, 0 },       { "port", 1, NULL, 0 },        { "data", 1, NULL, 0 },       { "workers", 1, NULL, 0 },
        { "threads", 1, NULL, 0 },    { "queue-limit", 1, NULL, 0 }, { "token-file", 1, NULL, 0 }, { "allow-host", 1, NULL, 0 },
        { "port-file", 1, NULL, 0 },  { "worker", 1, NULL, 0 },      { "web", 1, NULL, 0 },        { "api-file", 1, NULL, 0 },
        { "public-url", 1, NULL, 0 }, { "help", 0, NULL, 'h' },      { NULL, 0, NULL, 0 },
    };
    int which = 0;
    for (int code; (code = getopt_long(argc, argv, "h", options, &which)) != -1;) {
        if (code == 'h') {
            fputs(usage, stdout);
            return CONFIG_SHOWN;
        }
        if (code != 0 || !take_option(settings, options[which].name, optarg)) return CONFIG_WRONG;
    }
    if (optind < argc) {
        fprintf(stderr, "reposed: \"%s\" is not understood; see reposed --help\n", argv[optind]);
        return CONFIG_WRONG;
    }
    return CONFIG_SERVE;
}

static bool check(config *settings)
{
    char found[PATH_MAX];
    if (access(settings->worker, X_OK) != 0 || !realpath(settings->worker, found)) {
        fprintf(stderr, "reposed: the worker program %s can't be started: %s (--worker names another)\n", settings->worker,
                strerror(errno));
        return false;
    }
    copy_path(settings->worker, found);
    return true;
}

enum config_outcome config_read(config *settings, int argc, char **argv)
{
    const long cores = sysconf(_SC_NPROCESSORS_ONLN);
    *settings = (config){ .host = "127.0.0.1",
                          .data = "data",
                          .port = 8080,
                          .threads = 1,
                          .queue_limit = 10000,
                          .workers = cores < 1                     ? 1
                                     : cores > CONFIG_MOST_WORKERS ? CONFIG_MOST_WORKERS
                                                                   : (int)cores };
    const char *command = argc > 1 ? argv[1] : "";
    if (strcmp(command, "--version") == 0) {
        puts("reposed " REPOSED_VERSION);
        return CONFIG_SHOWN;
    }
    if (strcmp(command, "--help") == 0 || strcmp(command, "-h") == 0) {
        fputs(usage, stdout);
        return CONFIG_SHOWN;
    }
    if (strcmp(command, "serve") != 0) {
        if (*command) fprintf(stderr, "reposed: \"%s\" is not a command; say \"reposed serve\"\n", command);
        fputs(usage, stderr);
        return CONFIG_WRONG;
    }
    if (!beside_program(settings->worker, "repose") || !beside_program(settings->web, "../web")
        || !beside_program(settings->api_file, "../api/openapi.yaml"))
        return CONFIG_WRONG;
    argv[1] = argv[0]; /* in the place of "serve": getopt begins its complaints with it */
    const enum config_outcome outcome = read_options(settings, argc - 1, argv + 1);
    return outcome == CONFIG_SERVE && !check(settings) ? CONFIG_WRONG : outcome;
}
