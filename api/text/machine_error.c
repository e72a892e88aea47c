#include "machine_error.h"

#include <errno.h>
#include <stddef.h>

bool machine_error_is(int error)
{
    static const int errors[] = { ENOSPC, EDQUOT, EROFS,  EIO,    ENOMEM,  EMFILE,  ENFILE, EAGAIN,    EINTR,
                                  EBUSY,  ENXIO,  ENODEV, ESTALE, ETXTBSY, ENOBUFS, ENOLCK, ETIMEDOUT, EREMOTEIO };
    for (size_t i = 0; i < sizeof errors / sizeof errors[0]; i++)
        if (errors[i] == error) return true;
    return false;
}
