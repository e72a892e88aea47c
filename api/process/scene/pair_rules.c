/* Inputs that were refused are NaN, and no check is true of NaN. */
#include "pair_rules.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cohesion_rules.h"
#include "dem_rules.h"
#include "pair_names.h"

enum { LONGEST_PLACE = 80, LONGEST_LIST = 400 };
#define USUAL_DENSITY 2500.0
#define LEAST_SLOPE 1e-6 /* 1/m: a pair of restitution 1 among others that unload variably */

/* --- names --- */

static void check_material_name(const scene_inputs *inputs, const char *name, const char *pointer, problem_list *problems)
{
    if (!*name || material_index(inputs, name) != NO_PARTNER) return;
    char known[LONGEST_LIST];
    partner_names(inputs, NULL, known, sizeof known);
    problem_list_add(problems, pointer, "is \"%s\"; available: %s", name, *known ? known : "none, as /inputs/materials has none");
}

void materials_complete(scene_inputs *inputs, problem_list *problems)
{
    char pointer[LONGEST_PLACE];
    for (size_t k = 0; k < inputs->material_count; k++) {
        material_inputs *m = &inputs->materials[k];
        if (!isnan(m->poisson_ratio)) m->poissons_ratio = m->poisson_ratio;
        m->poisson_ratio = NAN; /* one spelling in the canonical specification */
        if (is_surface_name(m->name))
            problem_list_add(problems, "/inputs/materials",
                             "has a member \"%s\", which is the name of a surface; name it otherwise", m->name);
    }
    for (size_t s = 0; s < inputs->species_count; s++) {
        snprintf(pointer, sizeof pointer, "/inputs/particles/%zu/material", s);
        check_material_name(inputs, inputs->species[s].material, pointer, problems);
    }
    check_material_name(inputs, inputs->wall_material, "/inputs/wall/material", problems);
    check_material_name(inputs, inputs->plate_material, "/inputs/plate/material", problems);
}

double material_density(const scene_inputs *inputs, const species_inputs *species)
{
    const int material = material_index(inputs, species->material);
    if (!isnan(species->density) || material == NO_PARTNER) return species->density;
    return isnan(inputs->materials[material].density) ? USUAL_DENSITY : inputs->materials[material].density;
}

/* A partner as pairs name it: a material, or a surface behind the materials. */
static int partner_of(const scene_inputs *inputs, const dem_scene_definition *scene, const char *name)
{
    const int material = material_index(inputs, name), surface = surface_index(scene, name);
    if (material != NO_PARTNER) return material;
    return surface == NO_PARTNER ? NO_PARTNER : (int)inputs->material_count + surface;
}

static bool is_surface(const scene_inputs *inputs, int partner) { return partner >= (int)inputs->material_count; }

static void check_partner(const scene_inputs *inputs, const dem_scene_definition *scene, size_t pair, int end,
                          problem_list *problems)
{
    char pointer[LONGEST_PLACE], known[LONGEST_LIST];
    const char *name = inputs->pairs[pair].between[end];
    const int partner = partner_of(inputs, scene, name);
    const bool is_there =
        partner != NO_PARTNER
        && (!is_surface(inputs, partner) || surface_is_there(scene, (dem_surface)(partner - (int)inputs->material_count)));
    if (is_there || !*name) return;
    snprintf(pointer, sizeof pointer, "/inputs/pairs/%zu/between/%d", pair, end);
    partner_names(inputs, scene, known, sizeof known);
    problem_list_add(problems, pointer, "is \"%s\", %s; available: %s", name,
                     partner == NO_PARTNER ? "a name that nobody has" : "which this container has not", known);
}

static void check_pair(const scene_inputs *inputs, const dem_scene_definition *scene, size_t pair, problem_list *problems)
{
    char pointer[LONGEST_PLACE];
    const pair_inputs *p = &inputs->pairs[pair];
    const int a = partner_of(inputs, scene, p->between[0]), b = partner_of(inputs, scene, p->between[1]);
    for (int end = 0; end < 2; end++) check_partner(inputs, scene, pair, end, problems);
    snprintf(pointer, sizeof pointer, "/inputs/pairs/%zu/between", pair);
    if (a == NO_PARTNER || b == NO_PARTNER) return;
    if (is_surface(inputs, a) && is_surface(inputs, b))
        problem_list_add(problems, pointer, "is \"%s\" and \"%s\", which never touch; one must be a material of particles",
                         p->between[0], p->between[1]);
    for (size_t other = 0; other < pair; other++) {
        const pair_inputs *o = &inputs->pairs[other];
        const int c = partner_of(inputs, scene, o->between[0]), d = partner_of(inputs, scene, o->between[1]);
        if (!((a == c && b == d) || (a == d && b == c))) continue;
        problem_list_add(problems, pointer, "is \"%s\" and \"%s\", which /inputs/pairs/%zu is, too; give a pair once",
                         p->between[0], p->between[1], other);
        return;
    }
}

static void check_pairs(const scene_inputs *inputs, const dem_scene_definition *scene, problem_list *problems)
{
    char pointer[LONGEST_PLACE];
    for (size_t k = 0; k < inputs->pair_count && !problem_list_is_full(problems); k++) {
        check_pair(inputs, scene, k, problems);
        if (scene->contact.law != DEM_HERTZ_MINDLIN || isnan(inputs->pairs[k].stiffness)) continue;
        snprintf(pointer, sizeof pointer, "/inputs/pairs/%zu/stiffness", k);
        problem_list_add(problems, pointer, "is %g N/m, but hertz-mindlin takes the youngs_modulus (Pa) of materials",
                         inputs->pairs[k].stiffness);
    }
}

/* --- elasticity --- */

static bool have_moduli(const scene_inputs *inputs)
{
    bool have = false;
    for (size_t k = 0; k < inputs->material_count; k++)
        have = have || !isnan(inputs->materials[k].youngs_modulus) || !isnan(inputs->materials[k].poissons_ratio);
    return have;
}

static dem_elasticity elasticity_of(const scene_inputs *inputs, const char *material, dem_elasticity otherwise)
{
    const int k = material_index(inputs, material);
    if (k == NO_PARTNER) return otherwise;
    const material_inputs *m = &inputs->materials[k];
    return (dem_elasticity){ isnan(m->youngs_modulus) ? otherwise.youngs_modulus : m->youngs_modulus,
                             isnan(m->poissons_ratio) ? otherwise.poissons_ratio : m->poissons_ratio };
}

/* Beside moduli that are given, that of a species can't be one that an overlap is chosen for. */
static void check_moduli(const scene_inputs *inputs, problem_list *problems)
{
    bool any = false;
    char pointer[LONGEST_PLACE];
    for (size_t s = 0; s < inputs->species_count; s++)
        any = any || elasticity_of(inputs, inputs->species[s].material, (dem_elasticity){ NAN, NAN }).youngs_modulus > 0;
    for (size_t s = 0; s < inputs->species_count; s++) {
        const char *name = inputs->species[s].material;
        const double modulus = elasticity_of(inputs, name, (dem_elasticity){ NAN, NAN }).youngs_modulus;
        const bool is_unknown = *name && material_index(inputs, name) == NO_PARTNER;
        if (!any || modulus > 0 || is_unknown || !isnan(inputs->youngs_modulus)) continue;
        if (*name) snprintf(pointer, sizeof pointer, "/inputs/materials/%s/youngs_modulus", name);
        else snprintf(pointer, sizeof pointer, "/inputs/contact/youngs_modulus");
        problem_list_add(problems, pointer, "is missing; must be given beside that of other materials, for particles %zu", s);
    }
}

/* --- the pairs --- */

static dem_pair pair_of_contact(const dem_scene_definition *scene)
{
    const dem_contact_parameters *c = &scene->contact;
    return (dem_pair){ .friction = c->friction,
                       .rolling_friction = c->rolling_friction,
                       .restitution = c->restitution,
                       .stiffness = c->stiffness,
                       .unloading_slope = c->unloading_slope,
                       .cohesion = c->cohesion };
}

static void set_surface(const dem_scene_definition *scene, dem_surface surface, dem_pair *pair)
{
    pair->friction = scene->contact.wall_friction;
    pair->cohesion = scene->contact.wall_cohesion;
    pair->rolling_friction = scene->contact.wall_rolling_friction;
    if (surface == DEM_LIFTERS) pair->friction = scene->lifters.friction;
    if (surface == DEM_ENDS) pair->friction = scene->ends.friction, pair->rolling_friction = scene->ends.rolling_friction;
    if (surface == DEM_PLATE) pair->friction = scene->plate.friction, pair->rolling_friction = scene->plate.rolling_friction;
}

static void override(double *number, double given)
{
    if (!isnan(given)) *number = given;
}

/* What is said of the two, either way round, where it is said. */
static void apply_pair(const scene_inputs *inputs, const dem_scene_definition *scene, int a, int b, dem_pair *pair)
{
    for (size_t k = 0; a != NO_PARTNER && b != NO_PARTNER && k < inputs->pair_count; k++) {
        const pair_inputs *p = &inputs->pairs[k];
        const int c = partner_of(inputs, scene, p->between[0]), d = partner_of(inputs, scene, p->between[1]);
        if (!((a == c && b == d) || (a == d && b == c))) continue;
        override(&pair->friction, p->friction);
        override(&pair->rolling_friction, p->rolling_friction);
        override(&pair->restitution, p->restitution);
        override(&pair->stiffness, p->stiffness);
        if (!isnan(p->cohesion.law)) pair->cohesion = cohesion_of(&p->cohesion, scene);
    }
}

/* S and restitution of the hardest impact, one from the other: restitution was said, or S holds and stiffness was. */
static void unload_variably(const collision *worst, const dem_pair *base, dem_pair *pair)
{
    if (!(base->unloading_slope > 0)) return;
    const double overlap = worst->speed * sqrt(worst->heaviest / pair->stiffness);
    const bool is_said = pair->restitution < base->restitution || pair->restitution > base->restitution;
    if (is_said) pair->unloading_slope = fmax(LEAST_SLOPE, (1.0 / (pair->restitution * pair->restitution) - 1.0) / overlap);
    else pair->restitution = 1.0 / sqrt(1.0 + pair->unloading_slope * overlap);
}

static dem_pair pair_of_species(const scene_inputs *inputs, const collision *worst, const dem_scene_definition *scene, size_t a,
                                size_t b)
{
    dem_pair pair = pair_of_contact(scene);
    const dem_pair base = pair;
    const char *const name[] = { inputs->species[a].material, inputs->species[b].material };
    for (int end = 0; end < 2; end++) pair.elasticity[end] = elasticity_of(inputs, name[end], scene->contact.particle);
    apply_pair(inputs, scene, material_index(inputs, name[0]), material_index(inputs, name[1]), &pair);
    unload_variably(worst, &base, &pair);
    return pair;
}

/* What names the surface says more than what names its material; the lining is the wall's where nothing names it. */
static dem_pair pair_with_surface(const scene_inputs *inputs, const collision *worst, const dem_scene_definition *scene, size_t a,
                                  dem_surface surface)
{
    dem_pair pair = pair_of_contact(scene);
    const dem_pair base = pair;
    const char *name = surface == DEM_PLATE ? inputs->plate_material : inputs->wall_material;
    const int material = material_index(inputs, inputs->species[a].material), first = (int)inputs->material_count;
    set_surface(scene, surface, &pair);
    pair.elasticity[0] = elasticity_of(inputs, inputs->species[a].material, scene->contact.particle);
    pair.elasticity[1] = pair.elasticity[0]; /* a surface without a material has the particle's */
    if (*name) pair.elasticity[1].poissons_ratio = inputs->poissons_ratio;
    pair.elasticity[1] = elasticity_of(inputs, name, pair.elasticity[1]);
    apply_pair(inputs, scene, material, material_index(inputs, name), &pair);
    if (surface == DEM_LINING) apply_pair(inputs, scene, material, first + DEM_WALL, &pair);
    apply_pair(inputs, scene, material, first + (int)surface, &pair);
    unload_variably(worst, &base, &pair);
    return pair;
}

/* --- what follows from them --- */

/* Of one pair's two bodies: effective mass for its step, heaviest for its overlap; radii. */
typedef struct bodies {
    double effective_mass, heaviest; /* kg */
    double least_radius, largest;    /* m: effective radius of the smallest spheres; diameter of the largest */
} bodies;

/* other NULL: a surface. */
static bodies bodies_of(const dem_species *one, const dem_species *other)
{
    const double m = dem_species_contact_mass(one), r = 0.5 * dem_species_smallest_sphere(one);
    if (!other) return (bodies){ m, dem_species_heaviest(one), r, dem_species_largest_sphere(one) };
    const double n = dem_species_contact_mass(other), q = 0.5 * dem_species_smallest_sphere(other);
    return (bodies){ m * n / (m + n), fmax(dem_species_heaviest(one), dem_species_heaviest(other)), r * q / (r + q),
                     fmax(dem_species_largest_sphere(one), dem_species_largest_sphere(other)) };
}

static double effective_modulus(const dem_pair *p)
{
    double sum = 0.0;
    for (int k = 0; k < 2; k++)
        sum += (1.0 - p->elasticity[k].poissons_ratio * p->elasticity[k].poissons_ratio) / p->elasticity[k].youngs_modulus;
    return 1.0 / sum;
}

/* m, of the hardest impact. */
static double overlap_of(const dem_pair *p, const collision *worst, const bodies *b, dem_contact_law law)
{
    if (law != DEM_HERTZ_MINDLIN) return worst->speed * sqrt(b->heaviest / p->stiffness);
    const double modulus_for_one = dem_hertz_modulus_for_overlap(worst->speed, b->heaviest, 0.5 * b->largest, 1.0);
    return pow(modulus_for_one / effective_modulus(p), 0.4);
}

static double step_of(const dem_pair *p, const collision *worst, const bodies *b, dem_contact_law law)
{
    const double twice = 2.0 * b->effective_mass;
    if (law == DEM_HERTZ_MINDLIN) return dem_hertz_time_step(effective_modulus(p), twice, b->least_radius, worst->fastest);
    if (law == DEM_SPRING_DASHPOT) return dem_time_step(p->stiffness, twice, p->restitution);
    const double deepest = worst->fastest * sqrt(worst->heaviest / p->stiffness);
    const double e = p->unloading_slope > 0 ? fmin(p->restitution, 1.0 / sqrt(1.0 + p->unloading_slope * deepest)) : p->restitution;
    return dem_latching_time_step(p->stiffness, twice, e);
}

/* Latching springs between spheres need fewer than clusters, which several springs hold at once, and dashpots, unless they unload
 * fast: core/NUMERICS.md, "Time step". */
static double usual_steps_per_contact(const dem_scene_definition *scene, double restitution)
{
    const dem_contact_parameters *c = &scene->contact;
    const bool is_slow = c->law == DEM_WALTON_BRAUN && c->rolling_law == DEM_EPSD && restitution >= 0.7;
    return is_slow && !dem_has_clusters(scene->species, scene->species_count) ? 14.0 : DEM_STEPS_PER_CONTACT;
}

static bodies bodies_of_pair(const dem_scene_definition *scene, size_t a, size_t partner)
{
    return bodies_of(&scene->species[a], partner < DEM_MAXIMUM_SPECIES ? &scene->species[partner] : NULL);
}

static void set_pairs(const scene_inputs *inputs, const collision *worst, dem_scene_definition *scene)
{
    for (size_t a = 0; a < scene->species_count; a++) {
        for (size_t b = 0; b < scene->species_count; b++) scene->pair[a][b] = pair_of_species(inputs, worst, scene, a, b);
        for (size_t s = 0; s < DEM_SURFACES; s++)
            scene->pair[a][DEM_MAXIMUM_SPECIES + s] = pair_with_surface(inputs, worst, scene, a, (dem_surface)s);
    }
}

/* Of all pairs that can touch. */
typedef struct outcome {
    double overlap, time_step; /* m, the largest; s, the least at DEM_STEPS_PER_CONTACT */
    double steps;              /* in the contact that is over soonest, so that each contact has as many as it usually takes */
} outcome;

static outcome outcome_of_pairs(const collision *worst, const dem_scene_definition *scene)
{
    const dem_contact_law law = scene->contact.law;
    double step[DEM_MAXIMUM_SPECIES][DEM_MAXIMUM_SPECIES + DEM_SURFACES];
    outcome all = { 0.0, INFINITY, 0.0 };
    for (size_t a = 0; a < scene->species_count; a++)
        for (size_t b = 0; b < DEM_MAXIMUM_SPECIES + DEM_SURFACES; b++) {
            if (!partner_is_there(scene, b)) continue;
            const bodies both = bodies_of_pair(scene, a, b);
            step[a][b] = step_of(&scene->pair[a][b], worst, &both, law);
            all.overlap = larger_of(all.overlap, overlap_of(&scene->pair[a][b], worst, &both, law));
            all.time_step = smaller_of(all.time_step, step[a][b]);
        }
    for (size_t a = 0; a < scene->species_count; a++)
        for (size_t b = 0; b < DEM_MAXIMUM_SPECIES + DEM_SURFACES; b++)
            if (partner_is_there(scene, b))
                all.steps =
                    fmax(all.steps, usual_steps_per_contact(scene, scene->pair[a][b].restitution) * (all.time_step / step[a][b]));
    return all;
}

/* Particles that are all alike keep the contact for all, which is faster. */
static void contact_of_one_species(dem_scene_definition *scene)
{
    const dem_pair *p = &scene->pair[0][0];
    dem_contact_parameters *const c = &scene->contact;
    c->friction = p->friction;
    c->rolling_friction = p->rolling_friction;
    c->restitution = p->restitution;
    c->stiffness = p->stiffness;
    c->unloading_slope = p->unloading_slope;
    c->cohesion = p->cohesion;
    c->particle = c->wall = p->elasticity[0];
}

double pairs_derive(const scene_inputs *inputs, const collision *worst, double *overlap, dem_scene_definition *scene,
                    problem_list *problems)
{
    const bool is_hertzian = scene->contact.law == DEM_HERTZ_MINDLIN;
    check_pairs(inputs, scene, problems);
    if (is_hertzian) check_moduli(inputs, problems);
    if ((inputs->pair_count == 0 && !(is_hertzian && have_moduli(inputs))) || inputs->species_count == 0)
        return usual_steps_per_contact(scene, scene->contact.restitution);
    scene->has_pairs = true;
    set_pairs(inputs, worst, scene);
    const outcome all = outcome_of_pairs(worst, scene);
    *overlap = all.overlap / worst->smallest;
    if (*overlap > MOST_OVERLAP)
        problem_list_add(
            problems, is_hertzian ? "/inputs/materials" : "/inputs/pairs",
            "have contacts so soft that overlaps would reach %.3g of the smallest diameter; must stay below %g: give a "
            "larger %s",
            *overlap, MOST_OVERLAP, is_hertzian ? "youngs_modulus" : "stiffness");
    scene->time_step = all.time_step;
    if (scene->species_count == 1) contact_of_one_species(scene);
    return all.steps;
}
