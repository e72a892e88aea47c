/* Cohesion against closed forms: forces at a given overlap or gap, what a contact bears, what a collision loses; and that no contact
 * which acts beyond touch is missed. */
#include "container_by_hand.h"
#include "measure.h"
#include "scene_by_hand.h"
#include "small_drum.h"

static const double R_PAIR = 0.001, R_WALL = 0.002, MODULUS = 1e7; /* m: effective radii of spheres of 4 mm; Pa, E* */

static dem_elasticity elasticity(void) { return (dem_elasticity){ 2 * MODULUS * (1 - 0.09), 0.3 }; }

/* Elastic, without friction: what acts is the law's. */
static void let_cohere(dem_scene_definition *d, dem_cohesion_law law, dem_cohesion cohesion)
{
    d->contact.law = DEM_HERTZ_MINDLIN;
    d->contact.particle = d->contact.wall = elasticity();
    d->contact.restitution = 1;
    d->contact.cohesion_law = law;
    d->contact.cohesion = d->contact.wall_cohesion = cohesion;
}

static const dem_cohesion strengths[] = {
    [DEM_CONSTANT_PULL] = { .strength = 2e-3 },
    [DEM_SJKR] = { .strength = 2e4 },
    [DEM_SJKR2] = { .strength = 2e4 },
    [DEM_JKR] = { .strength = 0.1 },
    [DEM_LIQUID_BRIDGE] = { .strength = 0.07, .liquid_volume = 2e-11, .contact_angle = 0.5 },
};

static double hertz(double alpha, double r) { return alpha > 0 ? 4.0 / 3.0 * MODULUS * sqrt(r) * pow(alpha, 1.5) : 0; }

/* JKR as it was written (1971), over the radius of the contact; bisected for the overlap. */
static double jkr_overlap(double a, double w, double r) { return a * a / r - sqrt(2 * M_PI * w * a / MODULUS); }
static double jkr(double alpha, double w, double r)
{
    double low = cbrt(M_PI * w * r * r / (8 * MODULUS)), high = 1;
    for (int k = 0; k < 200; k++) *(jkr_overlap(0.5 * (low + high), w, r) < alpha ? &low : &high) = 0.5 * (low + high);
    return 4 * MODULUS * low * low * low / (3 * r) - sqrt(8 * M_PI * w * MODULUS * low * low * low);
}

/* N, repulsive, of a contact that has touched; is_wall: of a sphere and a plane. */
static double closed_form(dem_cohesion_law law, double alpha, bool is_wall)
{
    const dem_cohesion c = strengths[law];
    const double r = is_wall ? R_WALL : R_PAIR, gap = fmax(-alpha, 0), distance = 0.004 - alpha;
    switch (law) {
    case DEM_CONSTANT_PULL: return hertz(alpha, r) - (alpha > 0 ? c.strength : 0);
    case DEM_SJKR: /* the circle in which two equal spheres, or a sphere and a plane, cut each other */
        return hertz(alpha, r)
               - (alpha > 0 ? c.strength * M_PI
                                  * (is_wall ? 0.002 * 0.002 - (0.002 - alpha) * (0.002 - alpha)
                                             : 0.002 * 0.002 - distance * distance / 4)
                            : 0);
    case DEM_SJKR2: return hertz(alpha, r) - (alpha > 0 ? c.strength * 2 * M_PI * alpha * 0.002 : 0); /* of 4 mm, either way */
    case DEM_JKR: return jkr(alpha, c.strength, r);
    case DEM_LIQUID_BRIDGE: /* Rabinovich et al. 2005: 2 pi R gamma cos/(1 + H/(2 d)), R of each sphere, or twice the one at a plane */
    {
        const double root = sqrt(1 + 2 * c.liquid_volume / (M_PI * 2 * r * fmax(gap * gap, 1e-30))), d = gap / 2 * (root - 1);
        const double pull = 2 * M_PI * 2 * r * c.strength * cos(0.5) / (1 + (gap > 0 ? gap / (2 * d) : 0));
        return hertz(alpha, r) - pull;
    }
    default: return 0;
    }
}

/* The pair pulls where the closed form is below 0, unless rounding decides. */
static void check_tension(const dem_scene *scene, bool holds, double force, double off)
{
    const double share = measure_tension_share(scene);
    if (!holds) assert_true(isnan(share));
    else if (fabs(force) > off) assert_true(share == (force < 0 ? 1 : 0));
}

/* From rest, one step: m v = F dt. */
static void forces_of_two_spheres_are_the_closed_forms(void **unused)
{
    (void)unused;
    static const double alphas[] = { 2e-5, 5e-6, 1e-6, 1e-7, -1e-7, -1e-6, -3e-6, -3e-5 };
    for (dem_cohesion_law law = DEM_CONSTANT_PULL; law <= DEM_LIQUID_BRIDGE; law++)
        for (size_t k = 0; k < sizeof alphas / sizeof *alphas; k++) {
            dem_scene_definition d = hand_definition(2);
            let_cohere(&d, law, strengths[law]);
            const double gap = dem_cohesive_gap(law, &strengths[law], MODULUS, R_PAIR), alpha = alphas[k];
            const double expected = alpha > -gap ? closed_form(law, alpha, false) : 0;
            dem_scene *scene = weightless_scene(&d);
            const double x[] = { 0.04, 0, 0, 0.044 - alpha, 0, 0 }, joined[HISTORY_WIDTH] = { [HISTORY_ALPHA_0] = -1e-30 };
            double v[6];
            place_by_hand(
                scene,
                &(placement){
                    .phase = DEM_PHASE_RUNNING, .position = x, .pair_count = 1, .pair = (int32_t[]){ 0, 1 }, .history = joined });
            advance(scene, 1);
            look_at(scene, NULL, v, NULL);
            const double force = v[3] * species_mass(&d.species[0]) / d.time_step;
            /* places are kept to 4e-12 m, the sum of radii to rounding, so that the force is one between those of two overlaps */
            const double off = 4e-12 + 1.5 * ROUNDING * 0.004;
            const double more = alpha > -gap ? fabs(closed_form(law, alpha + off, false) - expected) : 0;
            CHECK_NEAR(force, expected, 2 * more + 30 * ROUNDING * (hertz(alpha, R_PAIR) + fabs(expected)));
            CHECK_NEAR(v[0], -v[3], 1e-6 * fabs(v[3]));
            check_tension(scene, alpha > -gap, expected, more);
            dem_scene_free(scene);
        }
}

static void forces_of_a_sphere_and_a_wall_are_the_closed_forms(void **unused)
{
    (void)unused;
    static const double alphas[] = { 2e-5, 1e-6, -1e-6 };
    for (dem_cohesion_law law = DEM_CONSTANT_PULL; law <= DEM_LIQUID_BRIDGE; law++)
        for (size_t k = 0; k < sizeof alphas / sizeof *alphas; k++) {
            dem_scene_definition d = container_definition(DEM_DRUM, 8);
            d.gravity = 1e-9;
            d.ends.are_walls = true;
            let_cohere(&d, law, strengths[law]);
            const bool holds = alphas[k] > 0; /* nothing was joined before */
            const double alpha = alphas[k], expected = holds ? closed_form(law, alpha, true) : 0;
            dem_scene *scene = container_scene(&d);
            double x[24], v[24];
            for (int i = 0; i < 8; i++) memcpy(x + 3 * i, (double[]){ 0.006 * i - 0.02, -0.02, 0 }, 3 * sizeof *x);
            memcpy(x, (double[]){ 0, 0, -0.028 - alpha }, 3 * sizeof *x);
            put(scene, x, NULL, NULL);
            go_on(scene, 1);
            dem_scene_particles(scene, &(dem_particle_arrays){ .velocity = v });
            const double force = v[2] * species_mass(&d.species[0]) / d.time_step, off = 1.5 * ROUNDING * 0.004 + 4e-12;
            const double more = holds ? fabs(closed_form(law, alpha + off, true) - expected) : 0;
            CHECK_NEAR(force, expected, 2 * more + 30 * ROUNDING * (hertz(alpha, R_WALL) + fabs(expected)));
            dem_scene_free(scene);
        }
}

/* A sphere under the drum's top: it falls off where its weight is more than the pull-off, 3/2 pi w R, 2 pi gamma R cos (of a plane
 * twice that), or the pull that was given. */
static void a_sphere_hangs_from_the_wall_up_to_the_pull_off(void **unused)
{
    (void)unused;
    static const dem_cohesion_law laws[] = { DEM_CONSTANT_PULL, DEM_JKR, DEM_LIQUID_BRIDGE };
    for (int l = 0; l < 3; l++)
        for (int more = 0; more < 2; more++) {
            dem_scene_definition d = container_definition(DEM_DRUM, 8);
            const double weight = species_mass(&d.species[0]) * d.gravity, pull = weight * (more ? 1.03 : 0.97);
            dem_cohesion c = { .strength = pull };
            /* the drum is so wide beside the sphere that R* is taken as R by the core; the overlap is that of a plane */
            if (laws[l] == DEM_JKR) c.strength = pull / (1.5 * M_PI * R_WALL);
            if (laws[l] == DEM_LIQUID_BRIDGE)
                c = (dem_cohesion){ .strength = pull / (4 * M_PI * R_WALL * cos(0.3)),
                                    .liquid_volume = 1e-12,
                                    .contact_angle = 0.3 };
            let_cohere(&d, laws[l], c);
            d.contact.cohesion_law = laws[l];
            d.contact.restitution = 0.2; /* so that it comes to rest */
            d.contact.cohesion.strength = 0;
            dem_scene *scene = container_scene(&d);
            double x[24], y[24];
            for (int i = 0; i < 8; i++) memcpy(x + 3 * i, (double[]){ 0.006 * i - 0.02, -0.02, 0 }, 3 * sizeof *x);
            memcpy(x, (double[]){ 0, 0.05 - 0.002 + 1e-9, 0 }, 3 * sizeof *x);
            put(scene, x, NULL, NULL);
            go_on(scene, 5000);
            dem_scene_particles(scene, &(dem_particle_arrays){ .position = y });
            CHECK_BETWEEN(0.048 - y[1], more ? -1e-4 : 1e-3, more ? 1e-4 : 1);
            dem_scene_free(scene);
        }
}

/* Speed after over before, of an elastic sphere against an end wall, `away` (m) from it; 0: it sticks. The mean over where in a step it
 * touches. */
static double rebound(dem_cohesion_law law, dem_cohesion c, double speed, double away)
{
    enum { PHASES = 8 };
    double sum = 0;
    for (int phase = 0; phase < PHASES; phase++) {
        dem_scene_definition d = container_definition(DEM_DRUM, 8);
        d.gravity = 1e-6;
        d.ends.are_walls = true;
        let_cohere(&d, law, c);
        d.contact.cohesion.strength = 0;
        d.time_step = 1e-6;
        dem_scene *scene = container_scene(&d);
        double x[24], v[24] = { 0 };
        for (int i = 0; i < 8; i++) memcpy(x + 3 * i, (double[]){ 0.006 * i - 0.02, -0.02, 0 }, 3 * sizeof *x);
        memcpy(x, (double[]){ 0, 0, -0.028 + 1e-6 + speed * d.time_step * phase / PHASES }, 3 * sizeof *x);
        v[2] = -speed;
        put(scene, x, v, NULL);
        go_on(scene, (int64_t)((2e-3 + 4 * away / speed) / d.time_step));
        dem_scene_particles(scene, &(dem_particle_arrays){ .position = x, .velocity = v });
        sum += x[2] > -0.028 + away ? v[2] / speed / PHASES : 0;
        dem_scene_free(scene);
    }
    return sum;
}

/* Thornton & Ning (1998): an elastic sphere sticks below v_s = sqrt(14.18/m) (w^5 R^4/E*^2)^(1/6), and above it has
 * e = sqrt(1 - (v_s/v)^2). Their number has four digits. */
static void jkr_sticks_below_its_speed_and_loses_its_energy_above(void **unused)
{
    (void)unused;
    const double w = 0.5, m = dem_sphere_mass(0.004, 2500);
    const double v_s = sqrt(14.18 / m) * pow(pow(w, 5) * pow(R_WALL, 4) / (MODULUS * MODULUS), 1.0 / 6.0);
    const dem_cohesion c = { .strength = w };
    assert_true(rebound(DEM_JKR, c, 0.95 * v_s, 1e-5) == 0);
    static const double faster[] = { 1.1, 1.5, 3 };
    for (int k = 0; k < 3; k++) {
        const double e = sqrt(1 - 1 / (faster[k] * faster[k]));
        CHECK_NEAR(rebound(DEM_JKR, c, faster[k] * v_s, 1e-5) / e, 1, 0.01);
    }
}

/* A bridge takes the integral of its force from touch to rupture, F0 (H_c + h - sqrt(H_c^2 + h^2)), h^2 = V/(pi R). */
static void a_bridge_takes_the_work_of_its_rupture(void **unused)
{
    (void)unused;
    const dem_cohesion c = strengths[DEM_LIQUID_BRIDGE];
    const double m = dem_sphere_mass(0.004, 2500), h = sqrt(c.liquid_volume / (M_PI * R_WALL));
    const double reach = (1 + c.contact_angle / 2) * cbrt(c.liquid_volume),
                 f_0 = 4 * M_PI * R_WALL * c.strength * cos(c.contact_angle);
    const double work = f_0 * (reach + h - sqrt(reach * reach + h * h)), v_s = sqrt(2 * work / m);
    assert_true(rebound(DEM_LIQUID_BRIDGE, c, 0.95 * v_s, 1.2 * reach) == 0);
    CHECK_NEAR(rebound(DEM_LIQUID_BRIDGE, c, 1.2 * v_s, 1.2 * reach) / sqrt(1 - 1 / 1.44), 1, 0.01);
    CHECK_NEAR(rebound(DEM_LIQUID_BRIDGE, c, 3 * v_s, 1.2 * reach) / sqrt(1 - 1 / 9.0), 1, 0.01);
}

/* ---- beds ---- */

static dem_scene_definition cohesive_drum(dem_cohesion_law law, bool latches)
{
    dem_scene_definition d = small_drum();
    d.species_count = 2;
    d.species[0].share = 0.7;
    d.species[1] = (dem_species){ .diameter = 0.004, .density = 2500, .share = 0.3 };
    d.particle_count = 150;
    d.contact.law = latches ? DEM_WALTON_BRAUN : DEM_HERTZ_MINDLIN;
    d.contact.particle = d.contact.wall = (dem_elasticity){ 2e6, 0.3 };
    d.contact.cohesion_law = law;
    d.contact.cohesion = d.contact.wall_cohesion = strengths[law];
    follow_rules(&d, 0.03);
    d.time_step *= 0.5;
    return d;
}

/* Who is joined, by all pairs at every step: who touches, and who was joined and is not farther apart than the gap. */
static void check_joined(dem_scene *scene, uint8_t *joined)
{
    const spheres *s = &scene->spheres;
    const size_t n = s->mobile_count;
    const container *vessel = &scene->container;
    size_t touching = 0;
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++) {
            const size_t a = (size_t)s->id[i], b = (size_t)s->id[j];
            if (a >= b) continue;
            const double r_i = (double)s->full_radius[i], r_j = (double)s->full_radius[j], r = r_i * r_j / (r_i + r_j);
            const double distance =
                sqrt(squared_distance(sphere_place(s, i), sphere_place(s, j), vessel->period, vessel->inverse_period));
            const double gap = distance - r_i - r_j;
            const dem_contact_parameters *c = &scene->definition.contact;
            const double reach =
                dem_cohesive_gap(c->cohesion_law, &c->cohesion, dem_effective_modulus(c->particle, c->particle), r);
            uint8_t *const now = &joined[a * n + b];
            /* within rounding of the border nobody knows */
            if (fabs(gap) < 1e-9 || fabs(gap - reach) < 1e-9) *now = 2;
            else *now = gap < 0 || (*now == 1 && gap < reach) ? 1 : *now == 2 && gap < reach ? 2 : 0;
            touching += gap < 0;
        }
    const contact_list *pairs = &scene->neighbors.pairs;
    size_t known = 0, listed = 0;
    for (size_t k = 0; k < n * n; k++) known += joined[k] == 1;
    for (size_t k = 0; k < pairs->count; k++) {
        const size_t a = (size_t)s->id[pairs->first[k]], b = (size_t)s->id[pairs->second[k]];
        const uint8_t told = joined[(a < b ? a : b) * n + (a < b ? b : a)];
        listed += pairs->alpha_0[k] != 0 && told == 1;
        if (told == 0 && pairs->alpha_0[k] != 0) fail_msg("a contact is joined that no pair is");
    }
    if (listed != known) fail_msg("%zu pairs are joined, of which the list has %zu", known, listed);
    assert_true(touching > 0);
}

static void no_contact_beyond_touch_is_missed(void **unused)
{
    (void)unused;
    for (int k = 0; k < 3; k++) {
        dem_scene_definition d = cohesive_drum(k == 0 ? DEM_JKR : DEM_LIQUID_BRIDGE, k == 2);
        dem_scene *scene = drum_scene(&d);
        run_to_phase(scene, DEM_PHASE_RUNNING);
        run(scene, 1);
        const size_t n = scene->spheres.mobile_count;
        uint8_t *joined = calloc(n * n, 1);
        assert_non_null(joined);
        const contact_list *pairs = &scene->neighbors.pairs;
        for (size_t p = 0; p < pairs->count; p++) { /* begin with what the list says */
            const size_t a = (size_t)scene->spheres.id[pairs->first[p]], b = (size_t)scene->spheres.id[pairs->second[p]];
            joined[(a < b ? a : b) * n + (a < b ? b : a)] = pairs->alpha_0[p] != 0;
        }
        for (int step = 0; step < 400; step++) {
            /* the forces of a step are those of the places before it */
            vector4 *before = malloc(n * sizeof *before);
            assert_non_null(before);
            memcpy(before, scene->spheres.place, n * sizeof *before);
            run(scene, 1);
            vector4 *after = malloc(n * sizeof *after);
            assert_non_null(after);
            memcpy(after, scene->spheres.place, n * sizeof *after);
            memcpy(scene->spheres.place, before, n * sizeof *before);
            check_joined(scene, joined);
            memcpy(scene->spheres.place, after, n * sizeof *after);
            free(before);
            free(after);
        }
        free(joined);
        dem_scene_free(scene);
    }
}

static void a_cohesive_bed_goes_on_with_the_same_bits_from_its_state_and_by_two_threads(void **unused)
{
    (void)unused;
    for (dem_cohesion_law law = DEM_CONSTANT_PULL; law <= DEM_LIQUID_BRIDGE; law++) {
        dem_scene_definition d = cohesive_drum(law, law == DEM_LIQUID_BRIDGE), by_two = d;
        by_two.threads = 2;
        dem_scene *scene = drum_scene(&d), *other = drum_scene(&by_two);
        dem_state state, end, other_end;
        run_to_phase(scene, DEM_PHASE_RUNNING);
        run(scene, 300);
        assert_int_equal(dem_scene_save(scene, &state), DEM_OK);
        assert_int_equal(dem_scene_restore(other, &state), DEM_OK);
        run(scene, 300);
        run(other, 300);
        assert_int_equal(dem_scene_save(scene, &end), DEM_OK);
        assert_int_equal(dem_scene_save(other, &other_end), DEM_OK);
        assert_true(states_are_equal(&end, &other_end));
        dem_state_clear(&state);
        dem_state_clear(&end);
        dem_state_clear(&other_end);
        dem_scene_free(scene);
        dem_scene_free(other);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(forces_of_two_spheres_are_the_closed_forms),
        cmocka_unit_test(forces_of_a_sphere_and_a_wall_are_the_closed_forms),
        cmocka_unit_test(a_sphere_hangs_from_the_wall_up_to_the_pull_off),
        cmocka_unit_test(jkr_sticks_below_its_speed_and_loses_its_energy_above),
        cmocka_unit_test(a_bridge_takes_the_work_of_its_rupture),
        cmocka_unit_test(no_contact_beyond_touch_is_missed),
        cmocka_unit_test(a_cohesive_bed_goes_on_with_the_same_bits_from_its_state_and_by_two_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
