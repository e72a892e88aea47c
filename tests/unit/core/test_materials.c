/* Contacts of unlike materials: each pair of species, and each species with each surface, has its own restitution, friction and
 * stiffness. Oracles are the closed forms of one collision (core/NUMERICS.md, "Contact"), and scenes of one material, to the bit. */
#include "container_by_hand.h"
#include "scene_by_hand.h"

static const dem_contact_law laws[] = { DEM_WALTON_BRAUN, DEM_SPRING_DASHPOT, DEM_HERTZ_MINDLIN };
enum { LAWS = 3 };

static dem_pair pair_of(double restitution, double friction, double stiffness, double modulus, double other_modulus)
{
    return (dem_pair){ .friction = friction,
                       .restitution = restitution,
                       .stiffness = stiffness,
                       .elasticity = { { modulus, 0.3 }, { other_modulus, 0.2 } } };
}

/* Every pair of the definition. */
static void set_all_pairs(dem_scene_definition *d, dem_pair pair)
{
    d->has_pairs = true;
    for (size_t a = 0; a < d->species_count; a++)
        for (size_t b = 0; b < DEM_MAXIMUM_SPECIES + DEM_SURFACES; b++) d->pair[a][b] = pair;
}

static double effective_modulus(const dem_pair *p)
{
    return 1
           / ((1 - p->elasticity[0].poissons_ratio * p->elasticity[0].poissons_ratio) / p->elasticity[0].youngs_modulus
              + (1 - p->elasticity[1].poissons_ratio * p->elasticity[1].poissons_ratio) / p->elasticity[1].youngs_modulus);
}

/* Steps of a collision at 1 m/s of the bodies at hand: at 400 or more a collision. */
static double short_step(const dem_pair *p, dem_contact_law law, double m_eff, double radius)
{
    if (law == DEM_HERTZ_MINDLIN) return dem_hertz_time_step(effective_modulus(p), 2 * m_eff, radius, 1) / 20;
    return dem_time_step(p->stiffness, 2 * m_eff, p->restitution) / 20;
}

/* Head on at 1 m/s: species a against b, which are 0 and 1. Returns the speed ratio, and the largest overlap, m. */
static double strike_head_on(dem_scene_definition *d, double *overlap)
{
    dem_scene *scene = weightless_scene(d);
    const double reach = 0.5 * (d->species[0].diameter + d->species[d->species_count - 1].diameter) + 1e-5;
    const double x[] = { 0.04, 0, 0, 0.04 + reach, 0, 0 }, v[] = { 1, 0, 0, 0, 0, 0 };
    place_by_hand(scene, &(placement){ .phase = DEM_PHASE_RUNNING, .position = x, .velocity = v });
    double after[6] = { 1 };
    for (int k = 0; k < 4000 && !(after[3] > after[0] && k > 100); k += 100) {
        advance(scene, 100);
        look_at(scene, NULL, after, NULL);
    }
    advance(scene, 1000);
    look_at(scene, NULL, after, NULL);
    *overlap = dem_scene_maximum_overlap(scene) * scene->spheres.smallest_diameter;
    dem_scene_free(scene);
    return after[3] - after[0];
}

static dem_scene_definition unlike_spheres(dem_contact_law law)
{
    dem_scene_definition d = hand_definition(2);
    first_sphere_differs(&d, (dem_species){ .diameter = 0.003, .density = 7800 });
    d.contact.law = law;
    d.contact.particle = d.contact.wall = (dem_elasticity){ 1e7, 0.3 };
    set_all_pairs(&d, pair_of(0.9, 0.3, 4000, 1e7, 1e7));
    return d;
}

/* Latching springs depend on where in a step the spheres touch by (20/400) of the 0.1 % that they do at 20 steps, damped ones by less
 * than their 0.3 %; stiffness enters the overlap only. */
static void unlike_spheres_part_with_the_restitution_of_their_pair(void **unused)
{
    (void)unused;
    for (int l = 0; l < LAWS; l++)
        for (double e = 0.4; e < 1.05; e += 0.3) {
            dem_scene_definition d = unlike_spheres(laws[l]);
            const double m_1 = species_mass(&d.species[0]), m_2 = species_mass(&d.species[1]), m_eff = m_1 * m_2 / (m_1 + m_2);
            const double radius = 0.002 * 0.0015 / 0.0035;
            d.pair[0][1] = d.pair[1][0] = pair_of(fmin(e, 1), 0.3, 25000, 5e7, 2e8);
            d.time_step = short_step(&d.pair[0][1], laws[l], m_eff, radius);
            double overlap;
            CHECK_NEAR(strike_head_on(&d, &overlap) / e, 1, 2e-3);
            if (e < 0.99) continue;
            const double linear = sqrt(m_eff / 25000);
            const double hertzian = pow(15 * m_eff / (16 * effective_modulus(&d.pair[0][1]) * sqrt(radius)), 0.4);
            CHECK_NEAR(overlap / (laws[l] == DEM_HERTZ_MINDLIN ? hertzian : linear), 1, 1e-3);
        }
}

/* With variable unloading each pair has its slope: e = sqrt(w/(S v + w)), w = sqrt(K1/m). */
static void unlike_spheres_unload_by_the_slope_of_their_pair(void **unused)
{
    (void)unused;
    dem_scene_definition d = unlike_spheres(DEM_WALTON_BRAUN);
    const double m_1 = species_mass(&d.species[0]), m_2 = species_mass(&d.species[1]), m_eff = m_1 * m_2 / (m_1 + m_2);
    dem_pair other = pair_of(0.9, 0.3, 4000, 1e7, 1e7);
    other.unloading_slope = 100;
    set_all_pairs(&d, other);
    d.contact.unloading_slope = 100;
    d.pair[0][1] = d.pair[1][0] = pair_of(0.5, 0.3, 25000, 1e7, 1e7);
    d.pair[0][1].unloading_slope = d.pair[1][0].unloading_slope = 30000;
    const double w = sqrt(25000 / m_eff);
    d.time_step = short_step(&d.pair[0][1], DEM_WALTON_BRAUN, m_eff, 0.001);
    double overlap;
    CHECK_NEAR(strike_head_on(&d, &overlap) / sqrt(w / (30000 + w)), 1, 2e-3);
}

/* Where a surface is, and how a sphere of 4 mm meets it. */
typedef struct surface_case {
    dem_container_kind kind;
    dem_surface surface;
    double place[3]; /* m: 10 micrometres off the surface */
    int normal, tangent;
    double toward;
} surface_case;

static const surface_case surfaces[] = {
    { DEM_DRUM, DEM_WALL, { 0, 0.05 - 0.00201, 0 }, 1, 2, 1 },
    { DEM_DRUM, DEM_ENDS, { 0, 0, -0.03 + 0.00201 }, 2, 0, -1 },
    { DEM_DRUM, DEM_ENDS, { 0, 0, 0.03 - 0.00201 }, 2, 0, 1 },
    { DEM_DRUM, DEM_LIFTERS, { 0.04 - 0.00201, 0, 0 }, 0, 2, 1 },
    { DEM_CYLINDER, DEM_WALL, { 0, 0.05 - 0.00201, 0.03 }, 1, 2, 1 },
    { DEM_CYLINDER, DEM_ENDS, { 0, 0, 0.00201 }, 2, 0, -1 },
    { DEM_TUBE_ON_PLATE, DEM_WALL, { 0, 0.05 - 0.00201, 0.02 }, 1, 2, 1 },
    { DEM_TUBE_ON_PLATE, DEM_PLATE, { 0, 0, 0.00201 }, 2, 0, -1 },
    { DEM_TUBE_ON_PLATE, DEM_PLATE, { 0, 0.1 - 0.00201, 0.015 }, 1, 2, 1 },
};

static dem_scene_definition beside_surfaces(const surface_case *s, dem_contact_law law)
{
    dem_scene_definition d = container_definition(s->kind, 8);
    d.gravity = 1e-6;
    d.contact.law = law;
    d.contact.particle = d.contact.wall = (dem_elasticity){ 1e7, 0.3 };
    d.ends.are_walls = s->kind == DEM_DRUM;
    if (s->kind == DEM_DRUM) d.lifters = (dem_lifters){ 3, 0.01, 0.01, 0.1, 0 };
    d.plate.rim_height = 0.03;
    set_all_pairs(&d, pair_of(0.9, 0.3, 4000, 1e7, 1e7));
    return d;
}

/* It slides throughout: the tangential speed changes by mu (1 + e) of the normal one. The damped laws' dashpots pull at the end of a
 * collision, and their friction acts against that, too: closed form for e = 1 alone, where there is none. */
static void a_sphere_meets_each_surface_with_the_pair_s_restitution_and_friction(void **unused)
{
    (void)unused;
    for (size_t k = 0; k < sizeof surfaces / sizeof *surfaces; k++)
        for (int l = 0; l < LAWS; l++) {
            const surface_case *s = &surfaces[k];
            dem_scene_definition d = beside_surfaces(s, laws[l]);
            const double e = laws[l] == DEM_WALTON_BRAUN ? 0.5 : 1, mu = 0.11, m = species_mass(&d.species[0]);
            dem_pair *const pair = &d.pair[0][DEM_MAXIMUM_SPECIES + s->surface];
            *pair = pair_of(e, mu, 25000, 5e7, 2e8);
            d.time_step = short_step(pair, laws[l], m, 0.002);
            dem_scene *scene = container_scene(&d);
            double x[24], v[24] = { 0 }, after[24];
            for (int i = 0; i < 8; i++) /* the others are where they meet nothing */
                memcpy(x + 3 * i, (double[]){ 0.006 * i - 0.02, -0.01, s->kind == DEM_DRUM ? 0 : 0.045 }, 3 * sizeof *x);
            memcpy(x, s->place, sizeof s->place);
            v[s->normal] = s->toward;
            v[s->tangent] = 2;
            put(scene, x, v, NULL);
            go_on(scene, 1200);
            dem_scene_particles(scene, &(dem_particle_arrays){ .velocity = after });
            CHECK_NEAR(-after[s->normal] * s->toward / e, 1, 2e-3);
            CHECK_NEAR(after[s->tangent], 2 - mu * (1 + e), 2e-3 * mu);
            dem_scene_free(scene);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(unlike_spheres_part_with_the_restitution_of_their_pair),
        cmocka_unit_test(unlike_spheres_unload_by_the_slope_of_their_pair),
        cmocka_unit_test(a_sphere_meets_each_surface_with_the_pair_s_restitution_and_friction),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
