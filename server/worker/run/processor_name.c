#include "processor_name.h"

#include <cpuid.h>
#include <string.h>

#define FIRST_PART 0x80000002U

enum { PARTS = 3, PART = 16 };

/* It is asked itself, since a confined worker may not read /proc/cpuinfo, which says the same. */
const char *processor_name(void)
{
    static char name[PARTS * PART + 1];
    unsigned words[4];
    if (*name) return name;
    char text[sizeof name] = "";
    for (unsigned part = 0; part < PARTS; part++)
        if (__get_cpuid(FIRST_PART + part, &words[0], &words[1], &words[2], &words[3])) memcpy(text + part * PART, words, PART);
    const char *start = text + strspn(text, " ");
    size_t length = strlen(start);
    while (length > 0 && start[length - 1] == ' ') length--;
    memcpy(name, length ? start : "unknown", length ? length : sizeof "unknown");
    return name;
}
