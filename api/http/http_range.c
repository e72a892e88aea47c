#include "http_range.h"

#include <ctype.h>
#include <stdbool.h>
#include <string.h>
#include <strings.h>

/* Digits only; a number beyond any file stops at the largest one. */
static bool read_number(const char **at, uint64_t *number)
{
    if (!isdigit((unsigned char)**at)) return false;
    *number = 0;
    for (; isdigit((unsigned char)**at); (*at)++) {
        const uint64_t digit = (uint64_t)(**at - '0');
        *number = *number > (UINT64_MAX - digit) / 10 ? UINT64_MAX : *number * 10 + digit;
    }
    return true;
}

static http_range_kind last_bytes(uint64_t count, uint64_t size, uint64_t *offset, uint64_t *length)
{
    if (count == 0 || size == 0) return HTTP_RANGE_OUTSIDE;
    *length = count < size ? count : size;
    *offset = size - *length;
    return HTTP_RANGE_PART;
}

http_range_kind http_range_parse(const char *header, uint64_t size, uint64_t *offset, uint64_t *length)
{
    if (!header || strncasecmp(header, "bytes=", 6) != 0) return HTTP_RANGE_WHOLE;
    const char *at = header + 6;
    uint64_t first, last = UINT64_MAX;
    if (*at == '-') {
        at++;
        if (!read_number(&at, &last) || *at) return HTTP_RANGE_WHOLE;
        return last_bytes(last, size, offset, length);
    }
    if (!read_number(&at, &first) || *at++ != '-') return HTTP_RANGE_WHOLE;
    if (*at && (!read_number(&at, &last) || *at)) return HTTP_RANGE_WHOLE;
    if (last < first) return HTTP_RANGE_WHOLE;
    if (first >= size) return HTTP_RANGE_OUTSIDE;
    *offset = first;
    *length = (last < size ? last : size - 1) - first + 1;
    return HTTP_RANGE_PART;
}
