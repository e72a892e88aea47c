/* The addresses of this service as an OpenAPI 3.0 document in JSON, for clients that read no other: made from the table of
 * routes. The whole contract is api/openapi.yaml. */
#include <stdio.h>
#include <string.h>

#include "handlers.h"
#include "openapi_outline.h"

/* "/jobs/{}" to "/jobs/{id}", with the name of each segment in the parameters. */
static void name_segments(const char *pattern, char *path, size_t size, json_t *parameters)
{
    static const char *const names[][2] = {
        { "/web/", "name" }, { "/processes/", "process" }, { "/snapshots/", "file" }, { "/jobs/", "id" }, { "/studies/", "id" }
    };
    size_t length = 0;
    path[0] = '\0';
    for (const char *at = pattern; *at && length + 20 < size; at++) {
        if (*at == '{') {
            const char *name = "id";
            for (size_t n = 0; n < sizeof names / sizeof names[0]; n++) {
                const size_t before = strlen(names[n][0]);
                if (length >= before && strcmp(path + length - before, names[n][0]) == 0) name = names[n][1];
            }
            length += (size_t)snprintf(path + length, size - length, "{%s}", name);
            at++;
            json_array_append_new(parameters, json_pack("{s:s, s:s, s:b, s:{s:s}}", "name", name, "in", "path", "required", 1,
                                                        "schema", "type", "string"));
        } else {
            path[length++] = *at;
            path[length] = '\0';
        }
    }
}

static void add_query(const char *known, json_t *parameters)
{
    char names[200];
    snprintf(names, sizeof names, "%s", known);
    for (char *rest = names, *name; (name = strsep(&rest, " ")) != NULL;) {
        if (*name == '\0') continue;
        name[strcspn(name, "*")] = '\0';
        json_array_append_new(parameters,
                              json_pack("{s:s, s:s, s:{s:s}}", "name", name, "in", "query", "schema", "type", "string"));
    }
}

static json_t *operation(const http_route *route, json_t *parameters)
{
    const bool posts = strcmp(route->method, "POST") == 0;
    json_t *one = json_pack("{s:o, s:{s:{s:s}, s:{s:s}}}", "parameters", parameters, "responses", posts ? "201" : "200",
                            "description", "done", "default", "description", "a problem (RFC 9457)");
    if (posts)
        json_object_set_new(
            one, "requestBody",
            json_pack("{s:b, s:{s:{s:{s:s}}}}", "required", 1, "content", "application/json", "schema", "type", "object"));
    return one;
}

json_t *openapi_outline(const char *base)
{
    json_t *paths = json_object();
    for (size_t r = 0; r < route_count; r++) {
        char path[120], method[8] = "";
        json_t *parameters = json_array();
        name_segments(route_table[r].pattern, path, sizeof path, parameters);
        add_query(route_table[r].parameters, parameters);
        for (size_t c = 0; route_table[r].method[c] && c + 1 < sizeof method; c++)
            method[c] = (char)(route_table[r].method[c] | 0x20);
        if (!json_object_get(paths, path)) json_object_set_new(paths, path, json_object());
        json_object_set_new(json_object_get(paths, path), method, operation(&route_table[r], parameters));
    }
    return json_pack("{s:s, s:{s:s, s:s, s:s}, s:[{s:s}], s:o}", "openapi", "3.0.3", "info", "title", "reposed", "version",
                     REPOSED_VERSION, "description", "Addresses and parameters; the whole contract, OpenAPI 3.1, is /api",
                     "servers", "url", base, "paths", paths);
}
