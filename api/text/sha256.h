/* SHA-256 of a file, by libnettle: what a checksum can't do, tell a file from one that was made to look like it. */
#ifndef SHA256_H
#define SHA256_H

#include <stdbool.h>

enum { SHA256_HEX_SIZE = 65 };

/* Of all bytes of the open file, in hexadecimal; false: errno says why it can't be read. */
bool sha256_of_file(int file, char hex[SHA256_HEX_SIZE]);

#endif
