#include "png_image.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

enum { CHUNK_FRAME = 12, HEAD_BYTES = 13, LEVEL = 3, OF_PALETTE = 3, WITH_OPACITY = 6 };

typedef struct png_bytes {
    unsigned char *at;
} png_bytes;

static void put(png_bytes *out, const void *bytes, size_t length)
{
    memcpy(out->at, bytes, length);
    out->at += length;
}

static void put_number(png_bytes *out, uint32_t number)
{
    const unsigned char bytes[] = { (unsigned char)(number >> 24), (unsigned char)(number >> 16), (unsigned char)(number >> 8),
                                    (unsigned char)number };
    put(out, bytes, sizeof bytes);
}

/* Length, name, content and the checksum of the last two. */
static void put_chunk(png_bytes *out, const char name[5], const void *content, size_t length)
{
    put_number(out, (uint32_t)length);
    const unsigned char *begin = out->at;
    put(out, name, 4);
    if (length > 0) put(out, content, length);
    put_number(out, (uint32_t)crc32(crc32(0, NULL, 0), begin, (uInt)(length + 4)));
}

static void put_head(png_bytes *out, const png_image *image)
{
    unsigned char head[HEAD_BYTES];
    png_bytes into = { head };
    put_number(&into, image->width);
    put_number(&into, image->height);
    const unsigned char kind[] = { 8, image->palette ? OF_PALETTE : WITH_OPACITY, 0, 0, 0 };
    put(&into, kind, sizeof kind);
    put_chunk(out, "IHDR", head, sizeof head);
}

static void put_palette(png_bytes *out, const png_image *image)
{
    unsigned char colours[3 * PNG_COLOURS], opacities[PNG_COLOURS];
    for (size_t c = 0; c < PNG_COLOURS; c++) {
        memcpy(colours + 3 * c, image->palette[c], 3);
        opacities[c] = image->palette[c][3];
    }
    put_chunk(out, "PLTE", colours, sizeof colours);
    put_chunk(out, "tRNS", opacities, sizeof opacities);
}

/* Each row begins with the number of its filter, which is none. For free(). */
static unsigned char *compress_rows(const png_image *image, size_t *length)
{
    const size_t row = image->width * (image->palette ? 1U : 4U), all = (row + 1) * image->height;
    uLongf packed = compressBound(all);
    unsigned char *rows = malloc(all), *out = malloc(packed);
    for (size_t y = 0; rows && out && y < image->height; y++) {
        rows[y * (row + 1)] = 0;
        memcpy(rows + y * (row + 1) + 1, image->pixels + y * row, row);
    }
    const bool good = rows && out && compress2(out, &packed, rows, all, LEVEL) == Z_OK;
    free(rows);
    if (!good) {
        free(out);
        return NULL;
    }
    *length = packed;
    return out;
}

unsigned char *png_image_encode(const png_image *image, size_t *length)
{
    static const unsigned char signature[] = { 0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n' };
    size_t packed = 0;
    unsigned char *rows = compress_rows(image, &packed);
    unsigned char *file = rows ? malloc(sizeof signature + 5 * CHUNK_FRAME + HEAD_BYTES + 4 * PNG_COLOURS + packed) : NULL;
    if (file) {
        png_bytes out = { file };
        put(&out, signature, sizeof signature);
        put_head(&out, image);
        if (image->palette) put_palette(&out, image);
        put_chunk(&out, "IDAT", rows, packed);
        put_chunk(&out, "IEND", "", 0);
        *length = (size_t)(out.at - file);
    }
    free(rows);
    return file;
}
