#include "frame_format.h"

#include <stdbool.h>
#include <string.h>

static size_t padded(size_t bytes) { return (bytes + 3) / 4 * 4; }

size_t frame_bytes(uint32_t count, uint32_t flags)
{
    static const struct {
        uint32_t flag; /* 0: always there */
        size_t bytes;  /* of a sphere */
    } arrays[] = { { 0, 6 },
                   { 0, 1 },
                   { FRAME_SPECIES, 1 },
                   { FRAME_RADIUS, 2 },
                   { FRAME_CLUSTER, 4 },
                   { FRAME_SPIN, 1 },
                   { FRAME_CONTACTS, 1 } };
    size_t bytes = FRAME_HEAD_BYTES;
    for (size_t k = 0; k < sizeof arrays / sizeof arrays[0]; k++)
        if (arrays[k].flag == 0 || (flags & arrays[k].flag)) bytes += padded(count * arrays[k].bytes);
    return bytes;
}

unsigned char *frame_put_16(unsigned char *at, uint16_t number)
{
    *at++ = (unsigned char)(number & 0xFF);
    *at++ = (unsigned char)(number >> 8);
    return at;
}

unsigned char *frame_put_32(unsigned char *at, uint32_t number)
{
    return frame_put_16(frame_put_16(at, (uint16_t)(number & 0xFFFF)), (uint16_t)(number >> 16));
}

static unsigned char *put_float(unsigned char *at, float number)
{
    uint32_t bits;
    memcpy(&bits, &number, sizeof bits);
    return frame_put_32(at, bits);
}

static unsigned char *put_double(unsigned char *at, double number)
{
    uint64_t bits;
    memcpy(&bits, &number, sizeof bits);
    return frame_put_32(frame_put_32(at, (uint32_t)(bits & 0xFFFFFFFF)), (uint32_t)(bits >> 32));
}

void frame_head_write(const frame_head *head, unsigned char bytes[FRAME_HEAD_BYTES])
{
    memcpy(bytes, FRAME_MAGIC, sizeof FRAME_MAGIC);
    unsigned char *at = frame_put_32(bytes + sizeof FRAME_MAGIC, head->count);
    at = frame_put_32(at, head->flags);
    at = put_double(at, head->time);
    at = put_double(at, head->drum_angle);
    for (int c = 0; c < 3; c++) at = put_float(at, head->low[c]);
    for (int c = 0; c < 3; c++) at = put_float(at, head->high[c]);
    put_float(put_float(at, head->speed), head->radius);
}

static uint32_t number_at(const unsigned char *at)
{
    return (uint32_t)at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
}

size_t frame_bytes_told(const unsigned char bytes[FRAME_HEAD_BYTES])
{
    const uint32_t count = number_at(bytes + sizeof FRAME_MAGIC), flags = number_at(bytes + sizeof FRAME_MAGIC + 4);
    if (memcmp(bytes, FRAME_MAGIC, sizeof FRAME_MAGIC) != 0 || (flags & ~(uint32_t)FRAME_ALL_FLAGS)) return 0;
    return frame_bytes(count, flags);
}
