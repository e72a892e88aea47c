/* start.hdf, a snapshot or a checkpoint that somebody names as the bed to start from, in which a stranger has changed what it
 * holds: looked at as the file of a specification, then taken for the small drum's bed, and a few steps made of it. The first
 * byte says which of them it was. */
#include "dem.h"
#include "edited_hdf.h"
#include "job_folder.h"
#include "spec_file.h"
#include "start_file.h"

static json_t *request;
static job_spec spec;
static hdf_original originals[2];

int LLVMFuzzerInitialize(int *count, char ***arguments)
{
    problem_list problems;
    (void)count;
    (void)arguments;
    CLAIM(problem_list_init(&problems) && (request = spec_file_read("run/spec.json", &problems)));
    json_t *inputs = json_object_get(request, "inputs");
    CLAIM(json_object_set_new(inputs, "start", json_pack("{s:s}", "file", JOB_START_FILE)) == 0);
    CLAIM(job_spec_parse(NULL, request, 0, &spec, &problems));
    hostile_hdf_begin();
    hdf_original_read(&originals[0], "run/" JOB_CHECKPOINT_FILE);
    hdf_original_read(&originals[1], "run/snapshots/000000.hdf");
    problem_list_clear(&problems);
    return 0;
}

static void look(void)
{
    problem_list problems;
    job_spec found;
    const start_source files = start_files(NULL);
    CLAIM(problem_list_init(&problems));
    if (job_spec_parse_with(&files, NULL, request, 0, &found, &problems)) job_spec_clear(&found);
    else CLAIM(!problem_list_is_empty(&problems));
    problem_list_clear(&problems);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    dem_scene *scene;
    const int64_t open_before = hostile_hdf_open();
    const size_t skipped = size > 0 ? 1 : 0;
    const hdf_original *original = &originals[skipped && bytes[0] % 2];
    if (!hdf_edited(JOB_START_FILE, original, bytes + skipped, size - skipped)) return 0;
    look();
    CLAIM(dem_scene_create(&spec.scene, &scene) == DEM_OK);
    char why_not[300];
    const bool good = start_scene(&spec, scene, why_not, sizeof why_not) == DEM_OK && dem_scene_advance(scene, 2) == DEM_OK;
    CLAIM(good || size > sizeof(hdf_edit));
    dem_scene_free(scene);
    CLAIM(hostile_hdf_open() == open_before);
    return 0;
}
