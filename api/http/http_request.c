#include "http_request.h"

#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool path_is_plain(const char *path)
{
    if (path[0] != '/') return false;
    const char *segment = path + 1;
    for (const char *c = segment;; c++) {
        if (*c == '/' || *c == '\0') {
            const size_t length = (size_t)(c - segment);
            if (length == 0 && *c == '/') return false;
            if (length == 1 && segment[0] == '.') return false;
            if (length == 2 && segment[0] == '.' && segment[1] == '.') return false;
            if (*c == '\0') return true;
            segment = c + 1;
        } else if (!isalnum((unsigned char)*c) && !strchr("_.~-", *c)) {
            return false;
        }
    }
}

static int hexadecimal(char c)
{
    if (c >= '0' && c <= '9') return c - '0';
    const int lower = tolower((unsigned char)c);
    return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
}

/* Form decoding in place. A zero byte would cut the text where the database reads on: refused. */
static bool decode(char *text)
{
    char *out = text;
    for (const char *in = text; *in; in++) {
        if (*in == '%') {
            const int high = hexadecimal(in[1]);
            const int low = high < 0 ? -1 : hexadecimal(in[2]);
            if (low < 0 || high * 16 + low == 0) return false;
            *out++ = (char)(high * 16 + low);
            in += 2;
        } else {
            *out++ = *in == '+' ? ' ' : *in;
        }
    }
    *out = '\0';
    json_t *text_check = json_string(text); /* NULL unless UTF-8 */
    json_decref(text_check);
    return text_check != NULL;
}

static const char *split_parameters(http_request *request, char *query)
{
    for (char *rest = query, *pair; (pair = strsep(&rest, "&")) != NULL;) {
        if (*pair == '\0') continue;
        if (request->parameter_count == HTTP_PARAMETERS) return "the query has more than 32 parameters";
        char *value = strchr(pair, '=');
        if (value) *value++ = '\0';
        else value = pair + strlen(pair);
        if (!decode(pair) || !decode(value))
            return "the query holds a broken percent code, a zero byte or bytes that are not UTF-8";
        request->parameter[request->parameter_count++] = (http_parameter){ pair, value };
    }
    return NULL;
}

const char *http_request_split_target(http_request *request, char *target)
{
    request->parameter_count = 0;
    request->path = "/";
    char *query = strchr(target, '?');
    if (query) *query++ = '\0';
    if (!path_is_plain(target))
        return "the path may hold only letters, digits and / _ . ~ -, without empty, \".\" or \"..\" segments";
    request->path = target;
    return query ? split_parameters(request, query) : NULL;
}

const char *http_request_parameter(const http_request *request, const char *name)
{
    for (size_t i = 0; i < request->parameter_count; i++)
        if (strcmp(request->parameter[i].name, name) == 0) return request->parameter[i].value;
    return NULL;
}

bool http_request_values(const http_request *request, const char *name, http_value_taker *take, void *context)
{
    for (size_t i = 0; i < request->parameter_count; i++) {
        if (strcmp(request->parameter[i].name, name) != 0) continue;
        for (const char *value = request->parameter[i].value; *value;) {
            const size_t length = strcspn(value, ",");
            if (length > 0 && !take(context, value, length)) return false;
            value += length + (value[length] == ',');
        }
    }
    return true;
}

bool http_request_integer(const http_request *request, const char *name, int64_t low, int64_t high, int64_t missing, int64_t *value,
                          char *problem, size_t problem_size)
{
    *value = missing;
    const char *text = http_request_parameter(request, name);
    if (!text) return true;
    char *end;
    errno = 0;
    const long long number = strtoll(text, &end, 10);
    if (errno == 0 && end != text && *end == '\0' && !isspace((unsigned char)*text) && number >= low && number <= high) {
        *value = number;
        return true;
    }
    snprintf(problem, problem_size, "parameter %s is \"%.40s\"; must be a whole number in [%lld, %lld]", name, text, (long long)low,
             (long long)high);
    return false;
}

bool http_request_truth(const http_request *request, const char *name, bool *value, char *problem, size_t problem_size)
{
    const char *text = http_request_parameter(request, name);
    *value = text && strcmp(text, "true") == 0;
    if (!text || *value || strcmp(text, "false") == 0) return true;
    snprintf(problem, problem_size, "parameter %s is \"%.40s\"; must be true or false", name, text);
    return false;
}
