#include "http_accept.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { MOST_FORMATS = 16 };

/* A piece of a header. */
typedef struct span {
    const char *at;
    size_t length;
} span;

/* Takes what is before the next separator from the rest, without spaces around it. */
static span next_part(span *rest, char separator)
{
    const char *end = memchr(rest->at, separator, rest->length);
    span part = { rest->at, end ? (size_t)(end - rest->at) : rest->length };
    const size_t taken = part.length + (end ? 1 : 0);
    rest->at += taken;
    rest->length -= taken;
    while (part.length > 0 && strchr(" \t", *part.at)) part.at++, part.length--;
    while (part.length > 0 && strchr(" \t", part.at[part.length - 1])) part.length--;
    return part;
}

static bool is_same(span a, span b) { return a.length == b.length && strncasecmp(a.at, b.at, a.length) == 0; }
static bool is_word(span a, const char *word) { return is_same(a, (span){ word, strlen(word) }); }

static span without_quotes(span value)
{
    if (value.length < 2 || value.at[0] != '"' || value.at[value.length - 1] != '"') return value;
    return (span){ value.at + 1, value.length - 2 };
}

static bool has_parameter(const char *offer, span name, span value)
{
    span rest = { offer, strlen(offer) };
    for (next_part(&rest, ';'); rest.length > 0;) {
        span pair = next_part(&rest, ';');
        const span its_name = next_part(&pair, '=');
        if (is_same(its_name, name)) return is_same(without_quotes(next_part(&pair, ';')), value);
    }
    return false;
}

/* How exactly a range without its parameters names a type: 0 for all of them, then 1, then 2; -1: it does not. */
static int exactness_of_type(span range, span type)
{
    if (is_word(range, "*/*")) return 0;
    if (is_same(range, type)) return 2;
    const char *slash = memchr(range.at, '/', range.length);
    const size_t kind = slash ? (size_t)(slash - range.at) + 1 : 0;
    const bool of_kind = kind > 0 && range.length == kind + 1 && slash[1] == '*' && type.length > kind;
    return of_kind && strncasecmp(range.at, type.at, kind) == 0 ? 1 : -1;
}

/* -1 where the range does not name the offer. All of its parameters count but q and charset: every text is UTF-8. */
static int exactness_of(span range, const char *offer, double *quality)
{
    span type = { offer, strcspn(offer, ";") };
    int exactness = exactness_of_type(next_part(&range, ';'), type);
    *quality = 1.0;
    while (range.length > 0 && exactness >= 0) {
        span pair = next_part(&range, ';');
        if (pair.length == 0) continue;
        const span name = next_part(&pair, '='), value = without_quotes(next_part(&pair, ';'));
        if (is_word(name, "q")) {
            *quality = value.length > 0 ? strtod(value.at, NULL) : 0.0;
            break;
        }
        if (is_word(name, "charset")) continue;
        exactness = has_parameter(offer, name, value) ? exactness + 1 : -1;
    }
    return exactness;
}

typedef struct preference {
    double quality;
    int exactness; /* -1: no range names it */
    size_t place;  /* of the range */
} preference;

static preference preference_for(const char *accept, const char *offer)
{
    preference best = { .exactness = -1 };
    span rest = { accept, strlen(accept) };
    for (size_t place = 0; rest.length > 0; place++) {
        double quality;
        const int exactness = exactness_of(next_part(&rest, ','), offer, &quality);
        if (exactness > best.exactness) best = (preference){ quality, exactness, place };
    }
    return best;
}

static bool is_better(preference a, preference b)
{
    if (a.quality != b.quality) return a.quality > b.quality;
    return a.exactness != b.exactness ? a.exactness > b.exactness : a.place < b.place;
}

size_t http_accept_choose(const char *accept, const char *const *offers, size_t count)
{
    preference best = { .exactness = -1 };
    size_t chosen = 0;
    for (size_t i = 0; accept && i < count; i++) {
        const preference its = preference_for(accept, offers[i]);
        if (its.exactness < 0 || !(its.quality > 0.0) || !is_better(its, best)) continue;
        best = its;
        chosen = i;
    }
    return chosen;
}

size_t http_format_choose(const http_request *request, const http_format *formats, size_t count)
{
    const char *asked = http_request_parameter(request, "f"), *offers[MOST_FORMATS];
    if (!asked) asked = http_request_parameter(request, "format");
    for (size_t i = 0; asked && i < count; i++)
        if (strcmp(formats[i].name, asked) == 0) return i;
    for (size_t i = 0; i < count && i < MOST_FORMATS; i++) offers[i] = formats[i].media_type;
    return http_accept_choose(request->accept, offers, count < MOST_FORMATS ? count : MOST_FORMATS);
}
