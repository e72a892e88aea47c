#include "routes.h"

#include <stdio.h>
#include <string.h>

static bool path_fits(const char *pattern, const char *path, http_request *request)
{
    size_t filled = 0;
    while (*pattern && *path) {
        if (pattern[0] == '{') {
            const size_t length = strcspn(path, "/");
            if (length == 0 || length >= HTTP_SEGMENT_SIZE || filled == HTTP_SEGMENTS) return false;
            memcpy(request->segment[filled], path, length);
            request->segment[filled++][length] = '\0';
            pattern += 2;
            path += length;
        } else if (*pattern++ != *path++) {
            return false;
        }
    }
    return *pattern == '\0' && *path == '\0';
}

static const char *allowed_methods(const char *method)
{
    if (strcmp(method, "GET") == 0) return "GET, HEAD";
    return method;
}

const http_route *routes_match(const http_route *table, size_t count, http_request *request, http_response *response)
{
    const char *method = strcmp(request->method, "HEAD") == 0 ? "GET" : request->method;
    char allowed[64] = "";
    for (size_t i = 0; i < count; i++) {
        if (!path_fits(table[i].pattern, request->path, request)) continue;
        if (strcmp(table[i].method, method) == 0) return &table[i];
        const size_t used = strlen(allowed);
        snprintf(allowed + used, sizeof allowed - used, "%s%s", used ? ", " : "", allowed_methods(table[i].method));
    }
    if (allowed[0]) {
        http_respond_problem(response, 405, NULL, "Method not allowed", "%s allows %s", request->path, allowed);
        /* GET comes before the other in the table; then the list is one of these constants. */
        static const char *const lists[] = { "GET, HEAD", "POST", "GET, HEAD, POST", "GET, HEAD, DELETE" };
        for (size_t i = 0; i < sizeof lists / sizeof lists[0]; i++)
            if (strcmp(allowed, lists[i]) == 0) response->allow = lists[i];
    } else {
        http_respond_problem(response, 404, NULL, "Not found", "%.200s is no address of this service; / lists them", request->path);
    }
    return NULL;
}

static const char *unknown_parameter(const http_route *route, const http_request *request)
{
    for (size_t i = 0; i < request->parameter_count; i++) {
        char wanted[48];
        snprintf(wanted, sizeof wanted, " %.40s ", request->parameter[i].name);
        if (!strstr(route->parameters, wanted)) return request->parameter[i].name;
    }
    return NULL;
}

void route_respond(const http_route *route, api_service *service, const http_request *request, http_response *response)
{
    const char *unknown = unknown_parameter(route, request);
    if (unknown) /* a misspelt filter would silently list everything */
        http_respond_problem(response, 400, NULL, "Unknown parameter", "query parameter \"%.40s\" is unknown here; known:%s",
                             unknown, route->parameters[0] ? route->parameters : " none");
    else route->handler(service, request, response);
}
