/* What all fuzzers share. Each of them reads bytes as the program reads those of strangers, and claims something of what
 * comes out, beyond that no sanitizer complains. run.sh starts them in a folder of their own. */
#ifndef FUZZ_H
#define FUZZ_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

/* Where it does not hold, the bytes are a finding. */
#define CLAIM(holds) ((holds) ? (void)0 : claim_fails(#holds, __FILE__, __LINE__))

static inline _Noreturn void claim_fails(const char *what, const char *file, int line)
{
    fprintf(stderr, "%s:%d: this does not hold: %s\n", file, line, what);
    abort();
}

/* Called by the library of the fuzzer: once, and for each input. */
int LLVMFuzzerInitialize(int *count, char ***arguments);
int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

#endif
