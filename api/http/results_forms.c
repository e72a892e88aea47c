#include "results_forms.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "handlers.h"
#include "http_accept.h"
#include "json_text.h"

#define BOUNDARY "the-next-output" /* with two lines before it, no line of JSON */

enum { RESULTS_BYTES = 4 << 20 };

static const char *const profile_names[] = { "ogc-results", RESULTS_PROFILE };

static bool names_profile(const char *text) { return strcmp(text, profile_names[0]) == 0 || strcmp(text, profile_names[1]) == 0; }

bool results_profile_is_good(const http_request *request, http_response *response)
{
    const char *profile = http_request_parameter(request, "profile");
    if (!profile || names_profile(profile)) return true;
    http_respond_problem(response, 400, NULL, "Bad parameter", "parameter profile is \"%.80s\"; must be %s or %s", profile,
                         profile_names[0], profile_names[1]);
    return false;
}

typedef enum results_form { AS_IT_IS, AS_OBJECT, AS_QUALIFIED } results_form;

static results_form form_of(const http_request *request, bool is_raw)
{
    static const char *const offers[] = { "multipart/related", "application/json",
                                          "application/json;profile=\"" RESULTS_PROFILE "\"",
                                          "application/json;profile=ogc-results" };
    if (http_request_parameter(request, "profile")) return AS_QUALIFIED;
    if (http_request_parameter(request, "f")) return AS_OBJECT;
    const size_t chosen = http_accept_choose(request->accept, offers + !is_raw, 4 - !is_raw) + !is_raw;
    return chosen > AS_QUALIFIED ? AS_QUALIFIED : (results_form)chosen;
}

/* Object of the outputs that are wanted. New reference. */
static json_t *choose_outputs(const json_t *results, const json_t *modes)
{
    const char *name;
    json_t *mode, *chosen = json_object();
    if (json_object_size(modes) == 0) json_object_update(chosen, (json_t *)results);
    json_object_foreach((json_t *)modes, name, mode)
    {
        json_t *output = json_object_get(results, name);
        json_object_set(chosen, name, output ? output : json_null());
    }
    return chosen;
}

static bool is_reference(const json_t *modes, const char *name)
{
    const char *mode = json_string_value(json_object_get(modes, name));
    return mode && strcmp(mode, "reference") == 0;
}

static json_t *address_of(const http_response *response, const char *id, const char *name)
{
    return json_sprintf("%s/jobs/%s/results/%s", response->base, id, name);
}

static void respond_text_of(http_response *response, const json_t *document)
{
    char *text = json_text_write(document);
    http_respond_text(response, 200, "application/json", text, text ? strlen(text) : 0);
}

static void respond_object(http_response *response, const char *id, json_t *outputs, const json_t *modes, bool is_qualified)
{
    const char *name;
    json_t *output, *document = json_object();
    json_object_foreach(outputs, name, output)
    {
        if (is_reference(modes, name))
            json_object_set_new(document, name,
                                json_pack("{s:o, s:s}", "href", address_of(response, id, name), "type", "application/json"));
        else if (is_qualified)
            json_object_set_new(document, name, json_pack("{s:O, s:s}", "value", output, "mediaType", "application/json"));
        else json_object_set(document, name, output);
    }
    if (is_qualified) snprintf(response->link, sizeof response->link, "<%s>; rel=\"profile\"", RESULTS_PROFILE);
    respond_text_of(response, document);
    json_decref(document);
}

static void respond_links(http_response *response, const char *id, json_t *outputs)
{
    const char *name;
    json_t *output;
    json_object_foreach(outputs, name, output)
    {
        const size_t used = strlen(response->link);
        json_t *address = address_of(response, id, name);
        snprintf(response->link + used, sizeof response->link - used,
                 "%s<%s>; rel=\"http://www.opengis.net/def/rel/ogc/1.0/results\"; title=\"%s\"; type=\"application/json\"",
                 used ? ", " : "", json_string_value(address), name);
        json_decref(address);
    }
    http_respond_text(response, 204, NULL, strdup(""), 0);
}

static void respond_parts(http_response *response, const char *id, json_t *outputs, const json_t *modes)
{
    const char *name;
    json_t *output;
    text_buffer out;
    text_buffer_init(&out, RESULTS_BYTES);
    json_object_foreach(outputs, name, output)
    {
        text_buffer_print(&out, "--" BOUNDARY "\r\nContent-Type: application/json\r\nContent-ID: <%s>\r\n", name);
        if (is_reference(modes, name)) {
            json_t *address = address_of(response, id, name);
            text_buffer_print(&out, "Content-Location: %s\r\n\r\n\r\n", json_string_value(address));
            json_decref(address);
            continue;
        }
        char *text = json_text_write(output);
        text_buffer_print(&out, "\r\n");
        text_buffer_add(&out, text ? text : "null", text ? strlen(text) : 4);
        text_buffer_print(&out, "\r\n");
        free(text);
    }
    text_buffer_print(&out, "--" BOUNDARY "--\r\n");
    if (out.failed) text_buffer_clear(&out);
    http_respond_text(response, 200, "multipart/related; type=\"application/json\"; boundary=" BOUNDARY, out.text, out.length);
    name_file(response, id, "-results.multipart", false);
}

void results_respond_output(http_response *response, const char *id, const char *name, const json_t *output)
{
    char end[60];
    snprintf(end, sizeof end, "-%.40s.json", name);
    name_file(response, id, end, false);
    respond_text_of(response, output);
}

/* As its request wants it: one output alone, links alone, or several parts. */
static void respond_raw(http_response *response, const char *id, json_t *outputs, const json_t *modes)
{
    size_t references = 0;
    const char *name, *first = json_object_iter_key(json_object_iter(outputs));
    json_t *output;
    json_object_foreach(outputs, name, output) references += is_reference(modes, name);
    if (references == json_object_size(outputs)) respond_links(response, id, outputs);
    else if (json_object_size(outputs) == 1) results_respond_output(response, id, first, json_object_get(outputs, first));
    else respond_parts(response, id, outputs, modes);
}

void results_respond(const http_request *request, http_response *response, const char *id, char *text, const json_t *wanted)
{
    const json_t *modes = json_object_get(wanted, "outputs");
    const int form = form_of(request, json_is_true(json_object_get(wanted, "raw")));
    if (form == AS_OBJECT && !modes) {
        http_respond_text(response, 200, "application/json", text, strlen(text));
        return;
    }
    json_t *results = json_loads(text, 0, NULL), *outputs = choose_outputs(results, modes);
    free(text);
    if (form == AS_IT_IS) respond_raw(response, id, outputs, modes);
    else respond_object(response, id, outputs, modes, form == AS_QUALIFIED);
    json_decref(outputs);
    json_decref(results);
}
