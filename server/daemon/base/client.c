#include "client.h"

#include <ctype.h>
#include <errno.h>
#include <jansson.h>
#include <netdb.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include "text_buffer.h"

enum { LONGEST_ANSWER = 64 << 20, LONGEST_FILE = 1 << 20, LONGEST_TOKEN = 255, SECONDS_OF_SILENCE = 90 };

typedef struct answer {
    int status;
    char *text; /* owned: head and body */
    const char *body;
    json_t *document; /* owned; NULL: the body is no JSON */
} answer;

/* --- one request --- */

static int connect_to(const config *settings)
{
    char port[8];
    snprintf(port, sizeof port, "%d", settings->port);
    const bool any = strcmp(settings->host, "0.0.0.0") == 0 || strcmp(settings->host, "::") == 0;
    const struct addrinfo wanted = { .ai_socktype = SOCK_STREAM, .ai_flags = AI_NUMERICSERV };
    struct addrinfo *found = NULL;
    const int code = getaddrinfo(any ? "localhost" : settings->host, port, &wanted, &found);
    int connection = -1;
    for (const struct addrinfo *one = found; one && connection < 0; one = one->ai_next) {
        connection = socket(one->ai_family, SOCK_STREAM | SOCK_CLOEXEC, 0);
        const struct timeval silence = { .tv_sec = SECONDS_OF_SILENCE };
        setsockopt(connection, SOL_SOCKET, SO_RCVTIMEO, &silence, sizeof silence);
        if (connection >= 0 && connect(connection, one->ai_addr, one->ai_addrlen) == 0) break;
        const int reason = errno;
        if (connection >= 0) close(connection);
        connection = -1;
        errno = reason;
    }
    if (connection < 0)
        fprintf(stderr, "reposed: no service answers at %s port %d: %s (--host, --port or --config say where it is)\n",
                settings->host, settings->port, code ? gai_strerror(code) : strerror(errno));
    if (found) freeaddrinfo(found);
    return connection;
}

/* At most `size` - 1 bytes, with 0 behind them. -1: it can't be read, or is longer. */
static ssize_t read_text(FILE *file, char *text, size_t size)
{
    const size_t length = file ? fread(text, 1, size, file) : 0;
    const bool good = file && !ferror(file) && length < size;
    if (good) text[length] = '\0';
    return good ? (ssize_t)length : -1;
}

static bool add_token(const config *settings, text_buffer *request)
{
    char token[LONGEST_TOKEN + 64] = "";
    if (!settings->token_file) return true;
    FILE *file = fopen(settings->token_file, "re");
    const ssize_t length = read_text(file, token, sizeof token);
    if (length < 0) fprintf(stderr, "reposed: token file %s can't be read: %s\n", settings->token_file, strerror(errno));
    if (file) fclose(file);
    char *first = token;
    while (isspace((unsigned char)*first)) first++;
    if (length >= 0) text_buffer_print(request, "Authorization: Bearer %.*s\r\n", (int)strcspn(first, " \t\r\n"), first);
    return length >= 0;
}

static bool send_all(int connection, const char *text, size_t length)
{
    while (length > 0) {
        const ssize_t sent = send(connection, text, length, MSG_NOSIGNAL);
        if (sent < 0 && errno == EINTR) continue;
        if (sent <= 0) return false;
        text += sent;
        length -= (size_t)sent;
    }
    return true;
}

/* Up to the end, which the service makes. */
static char *receive_all(int connection)
{
    text_buffer all;
    char piece[16384];
    text_buffer_init(&all, LONGEST_ANSWER);
    ssize_t got = 1;
    while (got > 0) {
        got = recv(connection, piece, sizeof piece, 0);
        if (got < 0 && errno == EINTR) got = 1;
        else if (got > 0) text_buffer_add(&all, piece, (size_t)got);
    }
    if (got == 0 && !all.failed && all.text) return all.text;
    text_buffer_clear(&all);
    return NULL;
}

/* False: it has been said why there is no answer. */
static bool ask(const config *settings, const char *method, const char *path, const char *body, answer *a)
{
    *a = (answer){ .status = 0 };
    text_buffer request;
    text_buffer_init(&request, LONGEST_FILE + 4096);
    text_buffer_print(&request, "%s %s HTTP/1.0\r\nHost: localhost:%d\r\nAccept: application/json\r\n", method, path,
                      settings->port);
    if (!add_token(settings, &request)) return false;
    if (body) text_buffer_print(&request, "Content-Type: application/json\r\nContent-Length: %zu\r\n", strlen(body));
    text_buffer_print(&request, "\r\n%s", body ? body : "");
    const int connection = request.failed ? -1 : connect_to(settings);
    if (connection >= 0 && send_all(connection, request.text, request.length)) a->text = receive_all(connection);
    if (connection >= 0 && !a->text) fprintf(stderr, "reposed: the service broke off: %s\n", strerror(errno));
    if (connection >= 0) close(connection);
    text_buffer_clear(&request);
    const char *head_end = a->text ? strstr(a->text, "\r\n\r\n") : NULL;
    if (head_end && sscanf(a->text, "HTTP/%*d.%*d %d", &a->status) == 1) {
        a->body = head_end + 4;
        a->document = json_loads(a->body, 0, NULL);
    } else if (a->text) {
        fprintf(stderr, "reposed: what answers at port %d speaks no HTTP\n", settings->port);
    }
    return a->body != NULL;
}

static void clear(answer *a)
{
    json_decref(a->document);
    free(a->text);
}

/* --- for people --- */

/* What others wrote must not control the terminal. */
static void print_plainly(FILE *out, const char *text)
{
    for (; text && *text; text++) fputc(iscntrl((unsigned char)*text) ? '?' : *text, out);
}

static const char *text_at(const json_t *object, const char *name)
{
    const char *text = json_string_value(json_object_get(object, name));
    return text ? text : "";
}

/* What was refused, and why; the exit status. */
static int refused(const answer *a)
{
    size_t i;
    json_t *error;
    fprintf(stderr, "reposed: %d ", a->status);
    print_plainly(stderr, text_at(a->document, "title"));
    fputs(": ", stderr);
    print_plainly(stderr, text_at(a->document, "detail"));
    fputc('\n', stderr);
    json_array_foreach(json_object_get(a->document, "errors"), i, error)
    {
        fputs("  ", stderr);
        print_plainly(stderr, text_at(error, "pointer"));
        fputc(' ', stderr);
        print_plainly(stderr, text_at(error, "detail"));
        fputc('\n', stderr);
    }
    return a->status >= 400 && a->status < 500 ? 2 : 1;
}

static void print_value(const char *name, const json_t *value)
{
    char *text = json_is_string(value) ? NULL : json_dumps(value, JSON_ENCODE_ANY | JSON_COMPACT | JSON_REAL_PRECISION(6));
    printf("%-24s", name);
    print_plainly(stdout, text ? text : json_string_value(value));
    putchar('\n');
    free(text);
}

static void print_members(const json_t *object)
{
    const char *name;
    json_t *value;
    json_object_foreach((json_t *)object, name, value)
    {
        if (json_is_array(value)) continue; /* links */
        if (json_is_object(value) && strcmp(name, "summary") == 0) print_members(value);
        else print_value(name, value);
    }
}

static void print_document(const answer *a)
{
    char *text = json_dumps(a->document, JSON_INDENT(2) | JSON_REAL_PRECISION(17));
    if (text) puts(text);
    free(text);
}

static bool has_ended(const char *status) { return strcmp(status, "accepted") != 0 && strcmp(status, "running") != 0; }

/* --- the commands --- */

/* Where a document goes: a study has a base, a calibration targets beside it; a job says its process. */
static bool address_of(const json_t *document, char *path, size_t size)
{
    const char *process = text_at(document, "process");
    if (json_object_get(document, "targets")) snprintf(path, size, "/calibrations");
    else if (json_object_get(document, "base")) snprintf(path, size, "/studies");
    else snprintf(path, size, "/processes/%.40s/execution", *process ? process : "drum");
    return path[strcspn(path, " \r\n\t?#")] == '\0';
}

/* Until the job, the calibration, or all of the study, has ended. */
static int wait_for(const config *settings, const char *kind, const char *id)
{
    char path[120], status[24] = "";
    snprintf(path, sizeof path, "/%s/%.60s?wait=60", kind, id);
    while (!has_ended(*status ? status : "accepted")) {
        answer a;
        const bool answered = ask(settings, "GET", path, NULL, &a);
        const int exit = !answered ? 1 : a.status != 200 ? refused(&a) : 0;
        if (exit == 0) snprintf(status, sizeof status, "%s", text_at(a.document, "status"));
        if (exit == 0 && (!*status || has_ended(status))) print_members(a.document);
        const bool knows_no_status = exit == 0 && !*status;
        clear(&a);
        if (exit != 0 || knows_no_status) return exit ? exit : 1;
    }
    return strcmp(status, "successful") == 0 ? 0 : 1;
}

int client_submit(const config *settings)
{
    const bool from_stdin = strcmp(settings->argument, "-") == 0;
    FILE *file = from_stdin ? stdin : fopen(settings->argument, "re");
    char *text = malloc(LONGEST_FILE + 1), path[120];
    const ssize_t length = text ? read_text(file, text, LONGEST_FILE + 1) : -1;
    if (file && !from_stdin) fclose(file);
    json_error_t error = { .line = 0 };
    json_t *document = length >= 0 ? json_loads(text, JSON_REJECT_DUPLICATES, &error) : NULL;
    int exit = 2;
    answer a = { .status = 0 };
    if (length < 0) fprintf(stderr, "reposed: %s can't be read, or has more than 1 MB: %s\n", settings->argument, strerror(errno));
    else if (!document) fprintf(stderr, "reposed: %s is no JSON: line %d: %s\n", settings->argument, error.line, error.text);
    else if (!address_of(document, path, sizeof path)) fprintf(stderr, "reposed: %s names no process\n", settings->argument);
    else if (!ask(settings, "POST", path, text, &a)) exit = 1;
    else if (a.status != 201) exit = refused(&a);
    else {
        const char *kind = strcmp(path, "/calibrations") == 0 ? "calibrations" : strcmp(path, "/studies") == 0 ? "studies" : "jobs";
        const char *id = text_at(a.document, *kind == 'c' ? "calibrationID" : *kind == 's' ? "studyID" : "jobID");
        puts(id);
        fflush(stdout);
        exit = settings->wait ? wait_for(settings, kind, id) : 0;
    }
    clear(&a);
    json_decref(document);
    free(text);
    return exit;
}

int client_jobs(const config *settings)
{
    answer a;
    size_t i;
    json_t *job;
    int exit = 1;
    if (ask(settings, "GET", "/jobs?limit=50", NULL, &a)) exit = a.status == 200 ? 0 : refused(&a);
    if (exit == 0 && settings->json) print_document(&a);
    else if (exit == 0) {
        json_array_foreach(json_object_get(a.document, "jobs"), i, job)
        {
            printf("%-25s %-8s %-10s %3.0f %%  ", text_at(job, "jobID"), text_at(job, "processID"), text_at(job, "status"),
                   json_number_value(json_object_get(job, "progress")));
            print_plainly(stdout, text_at(job, "message"));
            putchar('\n');
        }
    }
    clear(&a);
    return exit;
}

int client_show(const config *settings)
{
    char path[120];
    answer a;
    int exit = 1;
    if (strlen(settings->argument) > 64 || settings->argument[strspn(settings->argument, "0123456789abcdef-")]) {
        fprintf(stderr, "reposed: \"%.64s\" is no id of a job; reposed jobs lists them\n", settings->argument);
        return 2;
    }
    snprintf(path, sizeof path, "/jobs/%s", settings->argument);
    if (ask(settings, "GET", path, NULL, &a)) exit = a.status == 200 ? 0 : refused(&a);
    const bool has_results = exit == 0 && strcmp(text_at(a.document, "status"), "successful") == 0;
    if (exit == 0 && settings->json) print_document(&a);
    else if (exit == 0) print_members(a.document);
    clear(&a);
    if (!has_results || settings->json) return exit;
    snprintf(path, sizeof path, "/jobs/%s/results", settings->argument);
    if (ask(settings, "GET", path, NULL, &a) && a.status == 200) print_document(&a);
    clear(&a);
    return exit;
}
