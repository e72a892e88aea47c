#include "job_id.h"

#include <stddef.h>
#include <string.h>

bool job_id_is_valid(const char *id)
{
    static const char shape[] = "dddddddd-dddddd-xxxxxxxx"; /* d: digit, x: small hexadecimal */
    if (strlen(id) != sizeof shape - 1) return false;
    for (size_t i = 0; i < sizeof shape - 1; i++) {
        const char c = id[i];
        const bool digit = c >= '0' && c <= '9';
        if (shape[i] == '-' ? c != '-' : shape[i] == 'd' ? !digit : !digit && (c < 'a' || c > 'f')) return false;
    }
    return true;
}
