/* Ready documents to begin with: tests, studies and calibrations, the paper's cases among them. They lie in folders beside the OpenAPI
 * document. */
#include <ctype.h>
#include <dirent.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "handlers.h"
#include "status_info.h"
#include "text_buffer.h"

static const char *const folders[] = { "examples", "examples/instruments", "studies" };
enum { FOLDERS = sizeof folders / sizeof folders[0] };

static const char ending[] = ".json";

/* -1: there is no such folder. */
static int open_folder(const api_service *service, const char *folder)
{
    char path[4096];
    const char *slash = strrchr(service->api_file, '/');
    const int length = slash ? (int)(slash - service->api_file) : 1;
    const int written = snprintf(path, sizeof path, "%.*s/%s", length, slash ? service->api_file : ".", folder);
    return written < (int)sizeof path ? open(path, O_RDONLY | O_DIRECTORY | O_CLOEXEC) : -1;
}

static int open_example(int folder, const char *name)
{
    return openat(folder, name, O_RDONLY | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK);
}

/* "rotation-rate.json". */
static int is_example(const struct dirent *entry)
{
    const size_t length = strlen(entry->d_name), end = strlen(ending);
    return entry->d_name[0] != '.' && length > end && strcmp(entry->d_name + length - end, ending) == 0;
}

static void add_words(text_buffer *title, const char *words)
{
    if (words) text_buffer_print(title, "%s%s", title->length ? ", " : "", words);
}

/* A study's name, or what a test's label says. */
static json_t *title_of(const json_t *document, const char *fallback)
{
    text_buffer title;
    text_buffer_init(&title, 500);
    add_words(&title, json_string_value(json_object_get(document, "name")));
    const char *key;
    json_t *value;
    json_object_foreach(json_object_get(document, "label"), key, value) add_words(&title, json_string_value(value));
    json_t *text = json_string(title.length && title.text && !title.failed ? title.text : fallback);
    text_buffer_clear(&title);
    return text;
}

static json_t *entry_of(const json_t *document, const char *name)
{
    char href[80];
    snprintf(href, sizeof href, "/examples/%s", name);
    const json_t *base = json_object_get(document, "base"), *test = base ? base : document;
    const char *process = json_string_value(json_object_get(test, "process"));
    const char *kind = json_object_get(document, "targets") ? "calibration" : base ? "study" : "test";
    json_t *entry =
        json_pack("{s:s, s:s, s:s, s:o, s:o}", "name", name, "kind", kind, "process", process ? process : "drum", "title",
                  title_of(document, name), "links", json_pack("[o]", link_to("item", "application/json", href)));
    const char *description = json_string_value(json_object_get(document, "description"));
    if (description) json_object_set_new(entry, "description", json_string(description));
    return entry;
}

static void add_example(json_t *list, int folder, const char *file_name)
{
    char name[65];
    const size_t length = strlen(file_name) - strlen(ending);
    const int file = length < sizeof name ? open_example(folder, file_name) : -1;
    json_t *document = file < 0 ? NULL : json_loadfd(file, JSON_REJECT_DUPLICATES, NULL);
    snprintf(name, sizeof name, "%.*s", (int)length, file_name);
    if (json_is_object(document)) json_array_append_new(list, entry_of(document, name));
    json_decref(document);
    if (file >= 0) close(file);
}

void list_examples(api_service *service, const http_request *request, http_response *response)
{
    json_t *list = json_array();
    for (size_t f = 0; f < FOLDERS; f++) {
        const int folder = open_folder(service, folders[f]);
        struct dirent **entries = NULL;
        const int count = folder < 0 ? 0 : scandirat(folder, ".", &entries, is_example, alphasort);
        for (int i = 0; i < count; i++) {
            add_example(list, folder, entries[i]->d_name);
            free(entries[i]);
        }
        free(entries);
        if (folder >= 0) close(folder);
    }
    http_respond_json(response, 200,
                      json_pack("{s:o, s:o}", "examples", list, "links", json_pack("[o]", list_link(request, "self", NULL))));
}

static bool is_name(const char *name)
{
    for (const char *c = name; *c; c++)
        if (!isalnum((unsigned char)*c) && *c != '-' && *c != '_') return false;
    return *name != '\0';
}

void show_example(api_service *service, const http_request *request, http_response *response)
{
    const char *name = request->segment[0];
    char file_name[80];
    snprintf(file_name, sizeof file_name, "%s%s", name, ending);
    for (size_t f = 0; is_name(name) && f < FOLDERS; f++) {
        const int folder = open_folder(service, folders[f]);
        const int file = folder < 0 ? -1 : open_example(folder, file_name);
        if (folder >= 0) close(folder);
        if (file < 0) continue;
        http_respond_file(request, response, file, "application/json", HTTP_FILE_CHANGING);
        return;
    }
    http_respond_problem(response, 404, NULL, "No such example", "there is no example \"%s\"; /examples lists them", name);
}
