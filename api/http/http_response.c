#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "http_range.h"
#include "http_request.h"
#include "json_writer.h"
#include "problem_kinds.h"

void http_response_init(http_response *response) { *response = (http_response){ .status = 500, .file = -1 }; }

void http_response_clear(http_response *response)
{
    free(response->body);
    if (response->pieces.context) response->pieces.free(response->pieces.context);
    if (response->file >= 0) close(response->file);
    http_response_init(response);
}

void http_respond_text(http_response *response, int status, const char *content_type, char *text, size_t length)
{
    response->status = text ? status : 503;
    response->content_type = content_type;
    response->body = text;
    response->length = text ? length : 0;
}

/* Clients follow an address as it is given to them. links: a list of objects with an href. */
static void make_absolute(const char *base, json_t *links)
{
    size_t i;
    json_t *link;
    json_array_foreach(links, i, link)
    {
        const char *address = json_string_value(json_object_get(link, "href"));
        if (address && *address == '/') json_object_set_new(link, "href", json_sprintf("%s%s", base, address));
    }
}

/* What a user gave, as labels and inputs, is left as it is. */
static void make_links_absolute(const char *base, const json_t *document)
{
    static const char *const lists[] = { "jobs", "examples", "studies", "calibrations",
                                         "processes" }; /* whose entries have links of their own */
    make_absolute(base, json_object_get(document, "links"));
    make_absolute(base, json_object_get(document, "snapshots"));
    for (size_t l = 0; l < sizeof lists / sizeof lists[0]; l++) {
        size_t i;
        json_t *entry;
        json_array_foreach(json_object_get(document, lists[l]), i, entry) make_absolute(base, json_object_get(entry, "links"));
    }
}

enum { LONGEST_JSON = 1 << 30 };

/* Into one buffer that is sent as it is: json_dumps would copy all of it once more, which is half the time of a list. */
void http_respond_json(http_response *response, int status, json_t *document)
{
    text_buffer text;
    text_buffer_init(&text, LONGEST_JSON);
    if (*response->base) make_links_absolute(response->base, document);
    if (!json_write(&text, document)) text_buffer_clear(&text);
    json_decref(document);
    http_respond_text(response, status, status >= 400 ? "application/problem+json" : "application/json", text.text, text.length);
}

void http_respond_json_after(http_response *response, text_buffer *begun, json_t *rest)
{
    const size_t end = begun->length;
    if (*response->base) make_links_absolute(response->base, rest);
    if (json_write(begun, rest)) begun->text[end] = ','; /* its brace */
    else text_buffer_clear(begun);
    json_decref(rest);
    http_respond_text(response, 200, "application/json", begun->text, begun->length);
}

static void set_type(const http_response *response, json_t *document, const char *title)
{
    const problem_kind *kind = problem_kind_titled(title);
    if (!kind || !document) return;
    json_object_set_new(document, "type",
                        strchr(kind->name, ':') ? json_string(kind->name)
                                                : json_sprintf("%s" PROBLEMS_PATH "%s", response->base, kind->name));
}

void http_respond_problem(http_response *response, int status, const char *type, const char *title, const char *format, ...)
{
    char *detail = NULL;
    va_list arguments;
    va_start(arguments, format);
    if (vasprintf(&detail, format, arguments) < 0) detail = NULL;
    va_end(arguments);
    json_t *document = problem_json(status, type ? type : "about:blank", title, detail ? detail : title, NULL);
    if (!type) set_type(response, document, title);
    http_respond_json(response, status, document);
    free(detail);
}

void http_respond_problems(http_response *response, int status, const char *title, const char *detail, const problem_list *problems)
{
    json_t *document = problem_json(status, "about:blank", title, detail, problems);
    set_type(response, document, title);
    http_respond_json(response, status, document);
}

void http_respond_failure(http_response *response, int status, const char *title, const char *detail, json_t *failure)
{
    json_t *document = problem_json(status, "about:blank", title, detail, NULL);
    set_type(response, document, title);
    if (document && failure) json_object_set(document, "failure", failure);
    json_decref(failure);
    http_respond_json(response, status, document);
}

/* From the file that is being sent, not from what a table says about it: files are replaced by rename only, so
 * the same inode, size and time of change are the same bytes. */
static void set_etag(http_response *response, const struct stat *facts)
{
    snprintf(response->etag, sizeof response->etag, "\"%llx-%llx-%llx\"", (unsigned long long)facts->st_ino,
             (unsigned long long)facts->st_size,
             (unsigned long long)facts->st_mtim.tv_sec * 1000000000ULL + (unsigned long long)facts->st_mtim.tv_nsec);
}

static bool etag_is_listed(const char *list, const char *etag)
{
    return list && (strcmp(list, "*") == 0 || strstr(list, etag) != NULL);
}

bool http_respond_unchanged(const http_request *request, http_response *response, const char *version)
{
    snprintf(response->etag, sizeof response->etag, "\"%s\"", version);
    response->cache_control = "no-cache";
    if (!etag_is_listed(request->if_none_match, response->etag)) return false;
    response->status = 304;
    return true;
}

bool http_respond_part(const http_request *request, http_response *response, uint64_t size)
{
    response->accept_ranges = "bytes";
    /* If-Range asks for the part only while the whole is still the one the client knows. */
    const bool part_is_wanted = !request->if_range || (response->etag[0] && strcmp(request->if_range, response->etag) == 0);
    const http_range_kind kind =
        part_is_wanted ? http_range_parse(request->range, size, &response->offset, &response->length) : HTTP_RANGE_WHOLE;
    if (kind == HTTP_RANGE_PART) {
        response->status = 206;
        snprintf(response->content_range, sizeof response->content_range, "bytes %llu-%llu/%llu",
                 (unsigned long long)response->offset, (unsigned long long)(response->offset + response->length - 1),
                 (unsigned long long)size);
    } else if (kind == HTTP_RANGE_OUTSIDE) {
        http_respond_problem(response, 416, NULL, "Range outside the file", "the file has %llu bytes; Range was \"%.60s\"",
                             (unsigned long long)size, request->range);
        snprintf(response->content_range, sizeof response->content_range, "bytes */%llu", (unsigned long long)size);
    } else {
        response->offset = 0;
        response->length = size;
    }
    return kind != HTTP_RANGE_OUTSIDE;
}

void http_respond_file(const http_request *request, http_response *response, int file, const char *content_type,
                       enum http_file_kind kind)
{
    struct stat facts;
    if (fstat(file, &facts) != 0 || !S_ISREG(facts.st_mode)) {
        close(file);
        http_respond_problem(response, 404, NULL, "Not found", "there is no such file");
        return;
    }
    response->status = 200;
    response->content_type = content_type;
    response->cache_control = kind == HTTP_FILE_IMMUTABLE ? "private, max-age=31536000, immutable" : "no-cache";
    if (kind != HTTP_FILE_GROWING) set_etag(response, &facts);
    if (kind != HTTP_FILE_GROWING && etag_is_listed(request->if_none_match, response->etag)) {
        close(file);
        response->status = 304;
        return;
    }
    if (http_respond_part(request, response, (uint64_t)facts.st_size)) response->file = file;
    else close(file);
}
