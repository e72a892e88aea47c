/* Starting from a bed that was made before: start.hdf in the job folder, a snapshot or a checkpoint of another run, or the
 * particles that the spec itself has. */
#ifndef START_FILE_H
#define START_FILE_H

#include "dem.h"
#include "job_spec.h"

/* Knows the beds and tables of files that a spec names; of jobs it knows nothing, and takes them for good. spec: the path of its file,
 * which those of tables are relative to; NULL: they are relative to where the program runs. The source is good as long as spec. */
start_source start_files(const char *spec);

/* The file that the spec names as start.hdf of the job folder, which is the working directory: linked, or copied. path:
 * absolute. False: logged. */
bool start_file_bring(const char *path);

/* A new scene's particles. DEM_STATE_MISMATCH: the file is not there, not whole, or of other particles (logged), or not that which
 * the daemon gave to the job: then why_not says so, else it is "". */
dem_status start_scene(const job_spec *spec, dem_scene *scene, char *why_not, size_t size);

#endif
