/* Pictures of a palette or of four channels as PNG (the format's first and third kind of pixels that need no filter): head, palette
 * and one compressed block. */
#ifndef PNG_IMAGE_H
#define PNG_IMAGE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { PNG_COLOURS = 256 };

typedef struct png_image {
    uint32_t width, height;
    const uint8_t *pixels; /* (height, width) numbers of colours; without a palette (height, width, 4): r, g, b, opacity */
    uint8_t (*palette)[4]; /* (PNG_COLOURS) r, g, b, opacity; NULL: there is none */
} png_image;

/* The file's bytes, for free(); NULL: no memory. */
unsigned char *png_image_encode(const png_image *image, size_t *length);

#endif
