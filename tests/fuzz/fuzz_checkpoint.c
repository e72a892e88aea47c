/* checkpoint.hdf of the small drum's run, in which a stranger has changed what it holds: read, given to a scene, and a few steps
 * made of it. It is refused, or goes on, or ends in a failure that is told; unchanged it goes on. */
#include "checkpoint_file.h"
#include "dem.h"
#include "edited_hdf.h"
#include "job_folder.h"
#include "spec_file.h"

static job_spec spec;
static char *brief;
static hdf_original original;

int LLVMFuzzerInitialize(int *count, char ***arguments)
{
    problem_list problems;
    (void)count;
    (void)arguments;
    CLAIM(problem_list_init(&problems) && spec_file_load("run/spec.json", NULL, 0, &spec, &problems));
    CLAIM((brief = job_spec_to_brief(&spec)));
    hostile_hdf_begin();
    hdf_original_read(&original, "run/" JOB_CHECKPOINT_FILE);
    problem_list_clear(&problems);
    return 0;
}

static bool goes_on(const checkpoint *saved)
{
    dem_scene *scene;
    CLAIM(dem_scene_create(&spec.scene, &scene) == DEM_OK);
    const bool good = dem_scene_restore(scene, &saved->state) == DEM_OK && dem_scene_advance(scene, 2) == DEM_OK;
    dem_scene_free(scene);
    return good;
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    checkpoint saved;
    const int64_t open_before = hostile_hdf_open();
    if (!hdf_edited(JOB_CHECKPOINT_FILE, &original, bytes, size)) return 0;
    const file_state state = checkpoint_read(&saved, JOB_CHECKPOINT_FILE, brief);
    CLAIM(state == FILE_WHOLE || state == FILE_DAMAGED);
    CLAIM(hostile_hdf_open() == open_before);
    const bool good = state == FILE_WHOLE && goes_on(&saved);
    CLAIM(good || size >= sizeof(hdf_edit));
    checkpoint_clear(&saved);
    return 0;
}
