#include "sha256.h"

#include <errno.h>
#include <nettle/sha2.h>
#include <stdint.h>
#include <stdio.h>
#include <unistd.h>

enum { PIECE = 1 << 16 };

bool sha256_of_file(int file, char hex[SHA256_HEX_SIZE])
{
    struct sha256_ctx state;
    uint8_t piece[PIECE], digest[SHA256_DIGEST_SIZE];
    sha256_init(&state);
    for (off_t at = 0;;) {
        const ssize_t got = pread(file, piece, sizeof piece, at);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) return false;
        if (got == 0) break;
        sha256_update(&state, (size_t)got, piece);
        at += got;
    }
    sha256_digest(&state, sizeof digest, digest);
    for (size_t k = 0; k < sizeof digest; k++) snprintf(hex + 2 * k, 3, "%02x", digest[k]);
    return true;
}
