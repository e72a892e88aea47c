#include "checksum.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#define POLYNOMIAL 0xC96C5795D7870F42u

void checksum_begin(checksum *state)
{
    state->sum = ~(uint64_t)0;
    for (unsigned byte = 0; byte < 256; byte++) {
        uint64_t rest = byte;
        for (int bit = 0; bit < 8; bit++) rest = (rest >> 1) ^ (rest & 1 ? POLYNOMIAL : 0);
        state->table[0][byte] = rest;
    }
    /* What a byte is worth with so many zero bytes behind it: eight bytes are then taken at once. */
    for (int behind = 1; behind < 8; behind++)
        for (unsigned byte = 0; byte < 256; byte++) {
            const uint64_t before = state->table[behind - 1][byte];
            state->table[behind][byte] = (before >> 8) ^ state->table[0][before & 0xff];
        }
}

void checksum_add(checksum *state, const void *bytes, size_t length)
{
    const unsigned char *next = bytes;
    uint64_t sum = state->sum;
    for (; length >= 8; length -= 8, next += 8) {
        uint64_t eight = 0;
        for (int k = 7; k >= 0; k--) eight = (eight << 8) | next[k]; /* least first, whatever the machine */
        eight ^= sum;
        sum = 0;
        for (int k = 0; k < 8; k++) sum ^= state->table[7 - k][(eight >> (8 * k)) & 0xff];
    }
    for (; length > 0; length--) sum = (sum >> 8) ^ state->table[0][(sum ^ *next++) & 0xff];
    state->sum = sum;
}

uint64_t checksum_end(const checksum *state) { return ~state->sum; }

uint64_t checksum_of(const void *bytes, size_t length)
{
    checksum state;
    checksum_begin(&state);
    checksum_add(&state, bytes, length);
    return checksum_end(&state);
}

void checksum_write_line(uint64_t sum, char line[CHECKSUM_LINE + 1])
{
    snprintf(line, CHECKSUM_LINE + 1, "crc64 %016" PRIx64 "\n", sum);
}

void checksum_write_lines(const char *text, size_t length, const char *origin, char lines[CHECKSUM_LINES + 1])
{
    checksum state;
    checksum_begin(&state);
    checksum_add(&state, text, length);
    checksum_write_line(checksum_end(&state), lines);
    checksum_add(&state, origin, strlen(origin));
    checksum_write_line(checksum_end(&state), lines + CHECKSUM_LINE);
}

bool checksum_line_fits(const char *line, size_t line_length, const char *text, size_t length)
{
    char expected[CHECKSUM_LINE + 1];
    checksum_write_line(checksum_of(text, length), expected);
    return line_length == CHECKSUM_LINE && memcmp(line, expected, CHECKSUM_LINE) == 0;
}
