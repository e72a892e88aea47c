/* Which of the programs does the work: there is one for each instruction set and precision of the core, side by side,
 * repose itself being the one that any processor runs. */
#ifndef VARIANT_H
#define VARIANT_H

#include <stdbool.h>

/* NULL: the best that this processor has. False: no such name, or the processor has it not, which stderr says. */
bool variant_isa_is_usable(const char *isa);

/* Goes on as the program for that instruction set (NULL: the best) and precision ("single", "double"): argv is given to it.
 * Returns where this is the program already, or, with a warning, where the other is missing but this one will do.
 * False: it is missing and none will do, which stderr says. */
bool variant_take_over(const char *isa, const char *precision, char *const *argv);

/* What has been read of standard input can be read again, also by who takes over. False: stderr says why. */
bool variant_keep_stdin(void);

#endif
