/* A run of several beds: what each of them is. */
#include "job_spec.h"

/* Steele, Lea and Flood (2014), splitmix64: seeds that follow one another, as those of a study's repeats, have other beds. */
uint64_t job_bed_seed(uint64_t seed, size_t bed)
{
    if (bed == 0) return seed;
    uint64_t z = seed + bed * UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return (z ^ (z >> 31)) & LARGEST_WHOLE_NUMBER;
}

job_spec job_spec_of_bed(const job_spec *spec, size_t bed)
{
    job_spec one = *spec;
    one.bed_count = 1;
    one.inputs.beds = 1.0;
    one.scene.seed = job_bed_seed(spec->scene.seed, bed);
    one.inputs.seed = (double)one.scene.seed;
    return one;
}

int job_beds_at_once(const job_spec *spec)
{
    return (size_t)spec->threads < spec->bed_count ? spec->threads : (int)spec->bed_count;
}

void job_spec_set_threads(job_spec *spec, int threads)
{
    spec->threads = threads;
    spec->scene.threads = threads / job_beds_at_once(spec);
}
