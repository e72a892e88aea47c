/* The checksum of what is written to be read back: CRC-64 (the polynomial of ECMA-182, reflected, as in xz). It finds every
 * damage within 64 neighboring bits, and any other but for one in 2^64. */
#ifndef CHECKSUM_H
#define CHECKSUM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Of many pieces: the checksum so far and its tables. */
typedef struct checksum {
    uint64_t sum;
    uint64_t table[8][256];
} checksum;

void checksum_begin(checksum *state);
void checksum_add(checksum *state, const void *bytes, size_t length);
uint64_t checksum_end(const checksum *state);
uint64_t checksum_of(const void *bytes, size_t length);

/* The line that keeps a checksum: "crc64 0123456789abcdef\n". */
enum { CHECKSUM_LINE = 23 };
void checksum_write_line(uint64_t sum, char line[CHECKSUM_LINE + 1]);
/* Whether `line`, of so many bytes, is that of this text. */
bool checksum_line_fits(const char *line, size_t line_length, const char *text, size_t length);
/* Of a text that was made from another, its origin: that line, and behind it the one of the text followed by its origin. */
enum { CHECKSUM_LINES = 2 * CHECKSUM_LINE };
void checksum_write_lines(const char *text, size_t length, const char *origin, char lines[CHECKSUM_LINES + 1]);

#endif
