/* Texts in ids and labels, for looking through the index. */
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "job_index_rows.h"

enum { ID_LENGTH = 24, ID_BITS_AT = 16 };

/* Which bits the end of an id may have for the text to begin at one of its places, given its date and time. */
typedef struct bits_wanted {
    uint32_t mask[ID_LENGTH], value[ID_LENGTH];
    size_t count;
} bits_wanted;

static int hexadecimal(char c) { return c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1; }

static void write_date(uint64_t stamp, char date[ID_BITS_AT + 1])
{
    char digits[24];
    snprintf(digits, sizeof digits, "%014llu", (unsigned long long)(stamp % 100000000000000U));
    snprintf(date, ID_BITS_AT + 1, "%.8s-%.6s-", digits, digits + 8);
}

static void find_bits(uint64_t stamp, const char *text, size_t length, bits_wanted *wanted)
{
    char date[ID_BITS_AT + 1];
    write_date(stamp, date);
    wanted->count = 0;
    for (size_t at = 0; at + length <= ID_LENGTH; at++) {
        uint32_t mask = 0, value = 0;
        bool fits = true;
        for (size_t i = 0; fits && i < length; i++) {
            const int digit = hexadecimal(text[i]);
            const size_t place = at + i;
            if (place < ID_BITS_AT) {
                fits = date[place] == text[i];
                continue;
            }
            const unsigned shift = (unsigned)(4 * (ID_LENGTH - 1 - place));
            fits = digit >= 0;
            if (!fits) continue;
            mask |= 0xfU << shift;
            value |= (uint32_t)digit << shift;
        }
        if (!fits) continue;
        wanted->mask[wanted->count] = mask;
        wanted->value[wanted->count++] = value;
    }
}

static void mark_bits(const uint32_t *bits, size_t first, size_t end, uint32_t mask, uint32_t value, uint8_t *restrict marks)
{
    for (size_t row = first; row < end; row++) marks[row] |= (bits[row] & mask) == value;
}

/* Marks the jobs whose ids hold the text. */
static void mark_ids(const index_rows *rows, const char *text, uint8_t *marks)
{
    const size_t length = strlen(text);
    bits_wanted wanted = { .count = 0 };
    if (length > ID_LENGTH || strspn(text, "0123456789abcdef-") != length) return;
    for (size_t row = 0, end; row < rows->count; row = end) {
        for (end = row + 1; end < rows->count && rows->stamp[end] == rows->stamp[row];) end++;
        find_bits(rows->stamp[row], text, length, &wanted);
        for (size_t k = 0; k < wanted.count; k++) mark_bits(rows->bits, row, end, wanted.mask[k], wanted.value[k], marks);
    }
}

bool keep_text(job_index *index, const char *text, uint8_t *kept)
{
    const index_rows *rows = &index->rows;
    if (!*text) return true;
    const uint8_t *of_labels = text_search_marks(&index->search, &index->labels, text);
    uint8_t *of_ids = of_labels ? calloc(rows->count + 1, 1) : NULL;
    if (!of_ids) return false;
    mark_ids(rows, text, of_ids);
    for (size_t row = 0; row < rows->count; row++) kept[row] &= of_ids[row] | of_labels[rows->label[row]];
    free(of_ids);
    return true;
}

typedef struct label_member {
    const char *name, *value;
    char *quoted_name, *quoted_value; /* as they stand in a label */
} label_member;

/* A number is meant whichever way it is written, a truth by its name or by 1 and 0. */
static bool member_is(const json_t *member, const char *value)
{
    if (json_is_string(member)) return strcmp(json_string_value(member), value) == 0;
    if (json_is_boolean(member))
        return strcmp(value, json_is_true(member) ? "true" : "false") == 0 || strcmp(value, json_is_true(member) ? "1" : "0") == 0;
    if (json_is_number(member)) {
        char *end;
        const double number = strtod(value, &end);
        return end != value && *end == '\0' && strspn(value, "0123456789.eE+-") == strlen(value)
               && number == json_number_value(member);
    }
    char *text = member && !json_is_null(member) ? json_dumps(member, JSON_COMPACT | JSON_ENCODE_ANY) : NULL;
    const bool is = text && strcmp(text, value) == 0;
    free(text);
    return is;
}

/* Whether it is worth while to read the label: it has the name, and behind it the text, or something that is none. */
static bool may_have_member(const char *label, const label_member *wanted)
{
    const size_t value_length = strlen(wanted->quoted_value);
    for (const char *at = label; (at = strstr(at, wanted->quoted_name)) != NULL;) {
        at += strlen(wanted->quoted_name);
        if (at[0] == ':' && (at[1] != '"' || strncmp(at + 1, wanted->quoted_value, value_length) == 0)) return true;
    }
    return false;
}

static bool has_member(const char *label, const label_member *wanted)
{
    if (!may_have_member(label, wanted)) return false;
    json_t *members = json_loads(label, 0, NULL);
    const bool has = member_is(json_object_get(members, wanted->name), wanted->value);
    json_decref(members);
    return has;
}

static char *quoted(const char *text)
{
    json_t *value = json_string(text);
    char *dumped = value ? json_dumps(value, JSON_COMPACT | JSON_ENCODE_ANY) : NULL;
    json_decref(value);
    return dumped;
}

bool keep_label_member(const job_index *index, const job_filter *filter, uint8_t *kept)
{
    const index_rows *rows = &index->rows;
    const text_pool *labels = &index->labels;
    label_member wanted = { filter->label_name, filter->label_value, quoted(filter->label_name), quoted(filter->label_value) };
    uint8_t *marks = wanted.quoted_name && wanted.quoted_value ? calloc(labels->count + 1, 1) : NULL;
    for (uint32_t l = 0; marks && l < labels->count; l++)
        marks[l] = labels->users[l] > 0 && has_member(text_pool_text(labels, l), &wanted);
    for (size_t row = 0; marks && row < rows->count; row++)
        if (kept[row]) kept[row] = marks[rows->label[row]];
    const bool good = marks != NULL;
    free(marks);
    free(wanted.quoted_name);
    free(wanted.quoted_value);
    return good;
}
