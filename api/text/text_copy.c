#include "text_copy.h"

#include <assert.h>
#include <stdbool.h>
#include <string.h>

/* Of the bytes of a character all but the first. */
static bool goes_on(char byte) { return ((unsigned char)byte & 0xc0) == 0x80; }

void text_copy(char *to, size_t size, const char *from)
{
    assert(size > 0);
    size_t length = from ? strlen(from) : 0;
    if (length >= size)
        for (length = size - 1; length > 0 && goes_on(from[length]);) length--;
    if (length > 0) memcpy(to, from, length);
    to[length] = '\0';
}
