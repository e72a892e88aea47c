/* The tables of wide_avx2.h: which lane goes where when the lanes of a set move together, and back. */
#include "wide.h"

#if WIDE_BYTES == 32 && !defined(DEM_DOUBLE)

#define HAS(set, k) ((set) >> (k)&1)
#define BEFORE(set, k) (uint64_t) __builtin_popcount((set) & ((1 << (k)) - 1)) /* how many lanes of the set are before lane k */
#define CLOSING(set, k) (HAS(set, k) ? (uint64_t)(k) << 8 * BEFORE(set, k) : 0)
#define OPENING(set, k) ((HAS(set, k) ? BEFORE(set, k) : (uint64_t)NO_LANE) << 8 * (k))

#define OF_LANES(F, set) (F(set, 0) | F(set, 1) | F(set, 2) | F(set, 3) | F(set, 4) | F(set, 5) | F(set, 6) | F(set, 7))
#define OF_4(F, set) OF_LANES(F, set), OF_LANES(F, (set) + 1), OF_LANES(F, (set) + 2), OF_LANES(F, (set) + 3)
#define OF_16(F, set) OF_4(F, set), OF_4(F, (set) + 4), OF_4(F, (set) + 8), OF_4(F, (set) + 12)
#define OF_64(F, set) OF_16(F, set), OF_16(F, (set) + 16), OF_16(F, (set) + 32), OF_16(F, (set) + 48)
#define OF_256(F) OF_64(F, 0), OF_64(F, 64), OF_64(F, 128), OF_64(F, 192)

const uint64_t lanes_closing[1 << 8] = { OF_256(CLOSING) };
const uint64_t lanes_opening[1 << 8] = { OF_256(OPENING) };

#endif
