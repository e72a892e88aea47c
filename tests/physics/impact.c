/* One impact in the scene's own step: a sphere against the wall, or two equal spheres, without weight. Prints what
 * came of it as JSON; the tests hold it against closed forms and published values.
 *
 * The wall is the drum's at +x, and the sphere slides along the axis, in which the wall is flat. v_n: the speed of
 * approach; v_t: along the axis, of the one relative to the other; spin: about +y, by which a rolling sphere has spin r = v_t. */
#include "named_numbers.h"

enum {
    LAW,
    PAIR,
    RADIUS,
    DENSITY,
    STIFFNESS,
    TANGENTIAL,
    YOUNG,
    POISSON,
    WALL_YOUNG,
    WALL_POISSON,
    E,
    MU,
    V_N,
    V_T,
    SPIN,
    STEP,
    LEAD,
    COHESION,
    ENERGY_DENSITY
};

static named_number asked[] = {
    { "law", DEM_WALTON_BRAUN },
    { "pair", 0 }, /* 1: two spheres; 0: against the wall */
    { "radius", 0.002 },
    { "density", 2500 },
    { "stiffness", 4e4 },
    { "tangential_ratio", 0.8 },
    { "youngs_modulus", 5e7 },
    { "poissons_ratio", 0.3 },
    { "wall_youngs_modulus", 5e7 }, /* inf: rigid */
    { "wall_poissons_ratio", 0.3 },
    { "restitution", 0.8 },
    { "friction", 0 },
    { "v_n", 1 },
    { "v_t", 0 },
    { "spin", 0 },
    { "time_step", 1e-7 },
    { "lead", 2.5 },         /* steps before the touch */
    { "cohesion", 0 },       /* a dem_cohesion_law */
    { "energy_density", 0 }, /* J/m3, of sjkr and sjkr2 */
    { NULL, 0 },
};

static double of(int which) { return asked[which].value; }

static dem_scene_definition definition(void)
{
    dem_scene_definition d = hand_definition(of(PAIR) > 0 ? 2 : 1);
    d.species[0].diameter = 2 * of(RADIUS);
    d.species[0].density = of(DENSITY);
    d.diameter = 40 * of(RADIUS);
    d.length = 60 * of(RADIUS); /* the parked spheres stand well apart along it */
    d.contact = (dem_contact_parameters){ .law = (dem_contact_law)of(LAW),
                                          .stiffness = of(STIFFNESS),
                                          .tangential_stiffness_ratio = of(TANGENTIAL),
                                          .particle = { of(YOUNG), of(POISSON) },
                                          .wall = { of(WALL_YOUNG), of(WALL_POISSON) },
                                          .restitution = of(E),
                                          .friction = of(MU),
                                          .wall_friction = of(MU),
                                          .cohesion_law = (dem_cohesion_law)of(COHESION),
                                          .cohesion = { .strength = of(ENERGY_DENSITY) },
                                          .wall_cohesion = { .strength = of(ENERGY_DENSITY) } };
    d.time_step = of(STEP);
    return d;
}

/* The second of a pair stands still, in the first's way: all forces on it are those on the first, turned. */
static void place(dem_scene *scene)
{
    const double lead = of(LEAD) * of(V_N) * of(STEP), r = scene->spheres.full_radius[0];
    const double x = of(PAIR) > 0 ? 5 * r : scene->container.radius - r - lead;
    place_by_hand(scene, &(placement){ .phase = DEM_PHASE_RUNNING,
                                       .position = (double[]){ x, 0, 0, x + 2 * r + lead, 0, 0 },
                                       .velocity = (double[]){ of(V_N), 0, of(V_T), 0, 0, 0 },
                                       .spin = (double[]){ 0, of(SPIN), 0, 0, 0, 0 } });
}

int main(int argc, char **argv)
{
    read_named_numbers(argc, argv, asked);
    const dem_scene_definition d = definition();
    dem_scene *scene = weightless_scene(&d);
    place(scene);
    const double mass = species_mass(&d.species[0]);
    double v[6] = { 0 }, w[6] = { 0 }, before[6], force = 0;
    int64_t forced = 0, step = 0;
    look_at(scene, NULL, v, w);
    for (bool over = false; !over && step < 2000000; step++) {
        memcpy(before, v, sizeof v);
        advance(scene, 1);
        look_at(scene, NULL, v, w);
        const double f_n = mass * (before[0] - v[0]) / d.time_step;
        force = fmax(force, f_n);
        if (f_n != 0) forced++;
        over = forced > 0 && f_n == 0;
    }
    const bool pair = of(PAIR) > 0;
    printf("{\"v_n\": %.17g, \"v_t\": %.17g, \"spin\": %.17g, \"overlap\": %.17g, \"force\": %.17g, \"duration\": %.17g}\n",
           (pair ? v[3] : 0) - v[0], v[2] - (pair ? v[5] : 0), w[1],
           dem_scene_maximum_overlap(scene) * scene->spheres.smallest_diameter, force, (double)forced * d.time_step);
    dem_scene_free(scene);
    return forced > 0 && step < 2000000 ? 0 : 1;
}
