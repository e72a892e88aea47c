/* All files of a job as one tar archive (POSIX ustar), made while it is sent: of each file, its size is what it had when its turn
 * came; a file that has become shorter by then is filled up with zeros, so that the archive stays whole. */
#ifndef TAR_STREAM_H
#define TAR_STREAM_H

#include "http_request.h"
#include "store.h"

/* Takes nothing. False: there is no folder of this job, or no memory. */
bool tar_stream_open(job_store *store, const char *id, http_pieces *pieces);

#endif
