/* Which texts of a pool (job_index_rows.h) hold a piece, whatever the case of its letters of ASCII. */
#include <stdlib.h>
#include <string.h>

#include "job_index_rows.h"

enum { LANES = 16 };
typedef uint8_t lanes __attribute__((vector_size(LANES)));

static uint8_t small(uint8_t c) { return c >= 'A' && c <= 'Z' ? c | 0x20 : c; }

/* What is looked for, in small letters. Its first and its last byte are looked for 16 places at once; a letter's bit 0x20, which
 * is its case, is set before. */
typedef struct wanted_text {
    const char *text;
    size_t length;
    uint8_t first, last, first_case, last_case;
} wanted_text;

static uint8_t case_of(uint8_t c) { return c >= 'a' && c <= 'z' ? 0x20 : 0; }

static bool is_at(const char *place, const wanted_text *wanted)
{
    for (size_t i = 0; i < wanted->length; i++)
        if (small((uint8_t)place[i]) != (uint8_t)wanted->text[i]) return false;
    return true;
}

/* The lanes where it may begin: 0xff in each. */
static lanes places_in(const char *from, const wanted_text *wanted)
{
    lanes begin, end;
    memcpy(&begin, from, LANES);
    memcpy(&end, from + wanted->length - 1, LANES);
    return (lanes)((begin | wanted->first_case) == wanted->first) & (lanes)((end | wanted->last_case) == wanted->last);
}

static const char *first_of_lanes(const char *from, lanes places, const wanted_text *wanted)
{
    uint64_t half[2];
    memcpy(half, &places, sizeof half);
    for (int h = 0; h < 2; h++) {
        while (half[h]) {
            const int lane = __builtin_ctzll(half[h]) / 8;
            if (is_at(from + 8 * h + lane, wanted)) return from + 8 * h + lane;
            half[h] &= ~(0xffULL << (8 * lane));
        }
    }
    return NULL;
}

/* The first place at or behind `from` where it stands; NULL: there is none before the end. */
static const char *find_from(const char *from, const char *end, const wanted_text *wanted)
{
    for (; (size_t)(end - from) >= wanted->length - 1 + LANES; from += LANES) {
        const lanes places = places_in(from, wanted);
        const char *found = first_of_lanes(from, places, wanted);
        if (found) return found;
    }
    for (; (size_t)(end - from) >= wanted->length; from++)
        if (is_at(from, wanted)) return from;
    return NULL;
}

/* Texts lie one behind the other, each with its 0, which no wanted text has. */
static void mark_from(const text_pool *pool, size_t text, const wanted_text *wanted, uint8_t *marks)
{
    const char *end = pool->text + pool->used, *at = text < pool->count ? pool->text + pool->offset[text] : end;
    while ((at = find_from(at, end, wanted)) != NULL) {
        while (text + 1 < pool->count && pool->text + pool->offset[text + 1] <= at) text++;
        marks[text++] = 1;
        if (text >= pool->count) return;
        at = pool->text + pool->offset[text];
    }
}

const uint8_t *text_search_marks(text_search *search, const text_pool *pool, const char *text)
{
    const size_t length = strlen(text);
    char wanted_small[LONGEST_WANTED];
    if (length == 0 || length >= sizeof wanted_small) return NULL;
    for (size_t i = 0; i <= length; i++) wanted_small[i] = (char)small((uint8_t)text[i]);
    const bool is_known = strcmp(search->text, wanted_small) == 0 && search->searched <= pool->count;
    if (!is_known) search->searched = 0;
    memcpy(search->text, wanted_small, length + 1);
    if (pool->count > search->room || !search->marks) {
        const size_t room = pool->count + pool->count / 4 + 64;
        uint8_t *marks = realloc(search->marks, room);
        if (!marks) return NULL;
        search->marks = marks;
        search->room = room;
    }
    const uint8_t first = (uint8_t)wanted_small[0], last = (uint8_t)wanted_small[length - 1];
    const wanted_text wanted = { wanted_small, length, first, last, case_of(first), case_of(last) };
    memset(search->marks + search->searched, 0, pool->count - search->searched);
    mark_from(pool, search->searched, &wanted, search->marks);
    search->searched = pool->count;
    return search->marks;
}

void text_search_clear(text_search *search)
{
    free(search->marks);
    *search = (text_search){ .marks = NULL };
}
