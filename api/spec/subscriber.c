#include "subscriber.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "spec_text.h"

enum { LONGEST_URI = 1000, LONGEST_HOST = 255 };
#define DIGITS "0123456789"
#define LETTERS "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"

static const char *const members[] = { "successUri", "inProgressUri", "failedUri", NULL };

/* Length of "name", "1.2.3.4" or "[::1]" at the beginning; 0: there is none. */
static size_t host_length(const char *text)
{
    if (*text != '[') return strspn(text, LETTERS DIGITS ".-_");
    const size_t length = 1 + strspn(text + 1, DIGITS "abcdefABCDEF:.");
    return length > 1 && text[length] == ']' ? length + 1 : 0;
}

/* Length of ":8080" or of nothing; more than there is: it is neither. */
static size_t port_length(const char *text)
{
    if (*text != ':') return 0;
    const size_t digits = strspn(text + 1, DIGITS);
    return digits > 0 && digits < 6 ? 1 + digits : strlen(text) + 1;
}

bool callback_host_is_good(const char *name)
{
    const size_t host = host_length(name);
    return host > 0 && host <= LONGEST_HOST && host + port_length(name + host) == strlen(name);
}

static const char *host_of(const char *uri)
{
    return strncasecmp(uri, "https://", 8) == 0 ? uri + 8 : strncasecmp(uri, "http://", 7) == 0 ? uri + 7 : NULL;
}

bool callback_hosts_have(const callback_hosts *hosts, const char *uri)
{
    const char *host = host_of(uri);
    if (!host) return false;
    const size_t name = host_length(host), whole = name + port_length(host + name);
    for (int i = 0; i < hosts->count; i++) {
        const size_t length = strlen(hosts->name[i]);
        if ((length == name || length == whole) && strncasecmp(hosts->name[i], host, length) == 0) return true;
    }
    return false;
}

static bool is_address(const char *uri)
{
    const char *host = host_of(uri);
    const size_t name = host ? host_length(host) : 0, port = name ? port_length(host + name) : 0;
    if (name == 0 || name > LONGEST_HOST || name + port > strlen(host) || !strchr("/?", host[name + port])) return false;
    return uri[strspn(uri, LETTERS DIGITS "-._~:/?[]@!$&'()*+,;=%")] == '\0';
}

void subscriber_check(const json_t *subscriber, problem_list *problems)
{
    char seen[80], pointer[LONGEST_POINTER];
    if (!subscriber || json_is_null(subscriber)) return;
    json_value_text(subscriber, seen, sizeof seen);
    if (!json_is_object(subscriber)) {
        problem_list_add(problems, "/subscriber", "is %s; must be an object with \"successUri\", or null", seen);
        return;
    }
    refuse_unknown_members(subscriber, "/subscriber", members, problems);
    if (!json_object_get(subscriber, members[0])) problem_list_add(problems, "/subscriber/successUri", "is missing");
    for (size_t m = 0; members[m]; m++) {
        const json_t *uri = json_object_get(subscriber, members[m]);
        pointer_to_member(pointer, "/subscriber", members[m]);
        json_value_text(uri, seen, sizeof seen);
        if (uri && (!json_is_string(uri) || json_string_length(uri) > LONGEST_URI || !is_address(json_string_value(uri))))
            problem_list_add(problems, pointer, "is %s; must be http:// or https:// with a host, %d characters at most", seen,
                             LONGEST_URI);
    }
}

void subscriber_check_hosts(const json_t *subscriber, const callback_hosts *hosts, problem_list *problems)
{
    char pointer[LONGEST_POINTER];
    for (size_t m = 0; members[m]; m++) {
        const char *uri = json_string_value(json_object_get(subscriber, members[m]));
        if (!uri || callback_hosts_have(hosts, uri)) continue;
        const char *host = host_of(uri);
        const size_t name = host_length(host);
        pointer_to_member(pointer, "/subscriber", members[m]);
        problem_list_add(problems, pointer, "has the host %.*s, which this service may not call back; %s", (int)name, host,
                         hosts->count ? "those that it may are named by --callback-host" : "it may call nobody (--callback-host)");
    }
}
