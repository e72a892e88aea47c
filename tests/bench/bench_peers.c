/* Our side of `make bench-peers`: bench_peers COPIES OUT. Makes the paper's drum with 3 mm spheres (3000 times COPIES), or of
 * 3.78 mm (2300) for COPIES 0, writes the flowing bed to OUT for the others, and says in one JSON line what it is. Then, for
 * each line on stdin, advances by so many steps and prints the seconds that took. */
#include "bed.h"

#define DRUM                                                                                                                       \
    "{\"drum\": {\"diameter\": 0.126, \"length\": %g, \"rotation_rate\": 1.5707963267948966}, \"particles\": [{\"diameter\": "     \
    "%g}],"                                                                                                                        \
    " \"contact\": {\"friction\": 0.1}, \"duration\": {\"revolutions\": 1}, \"seed\": 1}"
#define FLOWING_SECONDS 0.6

/* Both read this; LIGGGHTS wants a second type, for its wall's material. */
static void write_bed(const dem_scene *scene, double length, double diameter, const char *path, int types)
{
    const size_t n = dem_scene_sphere_count(scene);
    double *x = malloc(3 * n * sizeof *x), *v = malloc(3 * n * sizeof *v), *w = malloc(3 * n * sizeof *w);
    dem_scene_particles(scene, &(dem_particle_arrays){ .position = x, .velocity = v, .angular_velocity = w });
    FILE *file = fopen(path, "w");
    if (!file) give_up("can't write", path);
    fprintf(file, "drum\n\n%zu atoms\n%d atom types\n\n-0.065 0.065 xlo xhi\n-0.065 0.065 ylo yhi\n%.9g %.9g zlo zhi\n\nAtoms\n\n",
            n, types, -0.5 * length, 0.5 * length);
    for (size_t i = 0; i < n; i++)
        fprintf(file, "%zu 1 %.9g 2500 %.12g %.12g %.12g\n", i + 1, diameter, x[3 * i], x[3 * i + 1], x[3 * i + 2]);
    fprintf(file, "\nVelocities\n\n");
    for (size_t i = 0; i < n; i++)
        fprintf(file, "%zu %.9g %.9g %.9g %.9g %.9g %.9g\n", i + 1, v[3 * i], v[3 * i + 1], v[3 * i + 2], w[3 * i], w[3 * i + 1],
                w[3 * i + 2]);
    if (fclose(file) != 0) give_up("can't write", path);
    free(x);
    free(v);
    free(w);
}

int main(int argc, char **argv)
{
    if (argc != 3) give_up("usage", "bench_peers COPIES OUT");
    const size_t copies = strtoul(argv[1], NULL, 10);
    const double diameter = copies ? 0.003 : 0.00378, length = copies ? 0.011338 : 0.017388;
    char inputs[600], path[4096];
    snprintf(inputs, sizeof inputs, DRUM, length, diameter);
    const dem_scene_definition drum = bed_definition(inputs);
    dem_scene *small = bed_create(&drum);
    while (dem_scene_phase(small) != DEM_PHASE_RUNNING) bed_advance(small, 100);
    bed_advance(small, (int64_t)(FLOWING_SECONDS / drum.time_step));
    dem_scene *scene = copies > 1 ? bed_repeat(small, &drum, copies, 1) : small;
    for (int types = 1; types <= 2; types++) {
        snprintf(path, sizeof path, "%s.%d", argv[2], types);
        write_bed(scene, length * (double)(copies ? copies : 1), diameter, path, types);
    }
    printf("{\"spheres\": %zu, \"diameter\": %g, \"k1\": %.9g, \"dt\": %.9g, \"mass\": %.9g, \"rate\": %.9g}\n",
           dem_scene_sphere_count(scene), diameter, drum.contact.stiffness, drum.time_step, dem_species_mass(&drum.species[0]),
           drum.rotation_rate);
    fflush(stdout);
    for (long steps; scanf("%ld", &steps) == 1;) {
        const double begin = now();
        bed_advance(scene, steps);
        printf("%.9g\n", now() - begin);
        fflush(stdout);
    }
    return 0;
}
