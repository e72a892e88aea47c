/* A frame: one time of a run for programs that show it, some 7 bytes a sphere (api/FRAMES.md). The worker writes one beside each
 * snapshot, and the daemon sends it as it is. */
#ifndef FRAME_FORMAT_H
#define FRAME_FORMAT_H

#include <stddef.h>
#include <stdint.h>

#define FRAME_MAGIC "RPSFRM1" /* and the \0 behind it */

enum { FRAME_HEAD_BYTES = 64, FRAME_MOST_STEPS = 65534 };

/* What each sphere has beside its place and its speed. */
enum frame_flags {
    FRAME_SPECIES = 1,
    FRAME_RADIUS = 2,
    FRAME_CLUSTER = 4,
    FRAME_SPIN = 8,
    FRAME_CONTACTS = 16,
    FRAME_ALL_FLAGS = 31
};

typedef struct frame_head {
    uint32_t count, flags;
    double time, drum_angle; /* s since rotation began, rad */
    float low[3], high[3];   /* m: corners of the box that places are scaled to */
    float speed, radius;     /* m/s, m: the largest ones */
} frame_head;

/* Bytes of the whole frame. */
size_t frame_bytes(uint32_t count, uint32_t flags);

void frame_head_write(const frame_head *head, unsigned char bytes[FRAME_HEAD_BYTES]);
/* 0: these bytes begin no frame; else the bytes of the whole frame. */
size_t frame_bytes_told(const unsigned char bytes[FRAME_HEAD_BYTES]);

/* Numbers of several bytes are little-endian on any machine. Each returns where the next goes. */
unsigned char *frame_put_16(unsigned char *at, uint16_t number);
unsigned char *frame_put_32(unsigned char *at, uint32_t number);

#endif
