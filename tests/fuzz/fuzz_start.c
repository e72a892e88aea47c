/* start.hdf, a snapshot or a checkpoint that somebody names as the bed to start from, with a checksum that fits: looked at
 * as the file of a specification, then taken for the small drum's bed, and a few steps made of it. */
#include "dem.h"
#include "hostile_hdf.h"
#include "job_folder.h"
#include "spec_file.h"
#include "start_file.h"

static json_t *request;
static job_spec spec;

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
    hostile_sealed(JOB_START_FILE, bytes, size);
    look();
    CLAIM(dem_scene_create(&spec.scene, &scene) == DEM_OK);
    char why_not[300];
    if (start_scene(&spec, scene, why_not, sizeof why_not) == DEM_OK) dem_scene_advance(scene, 2);
    dem_scene_free(scene);
    CLAIM(hostile_hdf_open() == open_before);
    return 0;
}
