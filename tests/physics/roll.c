/* One sphere under its weight on the wall of a drum at rest, in the scene's own step. Prints its motion as JSON lists:
 * time, angle from the lowest line, place along the axis, speed along it, spin about the drum's x axis.
 *
 * Starts at rest, or moving along the axis and spinning, at the overlap that carries its weight there. */
#include "named_numbers.h"

enum {
    RADIUS,
    DRUM_RADIUS,
    STIFFNESS,
    MU,
    ANGLE,
    V_Z,
    STEP,
    EVERY,
    SAMPLES,
    LAW,
    YOUNGS_MODULUS,
    ROLLING,
    SPIN,
    TWIST,
    ROLLING_LAW,
    ROLLING_DAMPING
};

static named_number asked[] = {
    { "radius", 0.002 },
    { "drum_radius", 0.1 },
    { "stiffness", 4000 },
    { "friction", 0.5 },
    { "angle", 0 }, /* rad */
    { "v_z", 0 },
    { "time_step", 1e-5 },
    { "every", 10 }, /* steps between samples */
    { "samples", 100 },
    { "law", DEM_WALTON_BRAUN },
    { "youngs_modulus", 5e7 }, /* Hertz-Mindlin, both bodies, Poisson's ratio 0.3 */
    { "rolling_friction", 0 },
    { "spin", 0 },  /* rad/s, about x */
    { "twist", 0 }, /* likewise, about y, the normal at the lowest line */
    { "rolling_law", DEM_EPSD },
    { "rolling_damping", 0 },
    { NULL, 0 },
};

static double of(int which) { return asked[which].value; }

static double overlap_under(double force)
{
    const double e_star = of(YOUNGS_MODULUS) / (2 * (1 - 0.3 * 0.3));
    return of(LAW) == DEM_HERTZ_MINDLIN ? pow(3 * force / (4 * e_star * sqrt(of(RADIUS))), 2.0 / 3) : force / of(STIFFNESS);
}

static dem_scene *sphere_on_the_wall(const dem_scene_definition *d)
{
    dem_scene *scene = hand_scene(d);
    const double alpha = overlap_under(species_mass(&d->species[0]) * d->gravity * cos(of(ANGLE)));
    const double rho = scene->container.radius - scene->spheres.full_radius[0] + alpha;
    place_by_hand(scene, &(placement){ .phase = DEM_PHASE_RUNNING,
                                       .position = (double[]){ rho * sin(of(ANGLE)), -rho * cos(of(ANGLE)), 0 },
                                       .velocity = (double[]){ 0, 0, of(V_Z) },
                                       .spin = (double[]){ of(SPIN), of(TWIST), 0 } });
    return scene;
}

static void print_list(const char *name, const double *list, size_t n, const char *end)
{
    printf("\"%s\": [", name);
    for (size_t k = 0; k < n; k++) printf("%s%.17g", k ? ", " : "", list[k]);
    printf("]%s", end);
}

int main(int argc, char **argv)
{
    read_named_numbers(argc, argv, asked);
    dem_scene_definition d = hand_definition(1);
    d.species[0].diameter = 2 * of(RADIUS);
    d.diameter = 2 * of(DRUM_RADIUS);
    d.length = 5 * of(DRUM_RADIUS); /* the parked spheres fall beside it, and reach the wall after sqrt(2 R/g) */
    d.contact.stiffness = of(STIFFNESS);
    d.contact.wall_friction = of(MU);
    d.contact.law = (dem_contact_law)of(LAW);
    d.contact.particle = d.contact.wall = (dem_elasticity){ of(YOUNGS_MODULUS), 0.3 };
    d.contact.wall_rolling_friction = of(ROLLING);
    d.contact.rolling_law = (dem_rolling_law)of(ROLLING_LAW);
    d.contact.rolling_damping = of(ROLLING_DAMPING);
    d.time_step = of(STEP);
    dem_scene *scene = sphere_on_the_wall(&d);
    const size_t n = (size_t)of(SAMPLES);
    double *time = calloc(5 * n, sizeof *time), *angle = time + n, *z = time + 2 * n, *v_z = time + 3 * n, *w_x = time + 4 * n;
    for (size_t k = 0; k < n; k++) {
        advance(scene, (int64_t)of(EVERY));
        double x[3], v[3], w[3];
        look_at(scene, x, v, w);
        time[k] = dem_scene_time(scene);
        angle[k] = atan2(x[0], -x[1]);
        z[k] = x[2];
        v_z[k] = v[2];
        w_x[k] = w[0];
    }
    printf("{");
    print_list("time", time, n, ", ");
    print_list("angle", angle, n, ", ");
    print_list("z", z, n, ", ");
    print_list("v_z", v_z, n, ", ");
    print_list("spin", w_x, n, "}\n");
    free(time);
    dem_scene_free(scene);
    return 0;
}
