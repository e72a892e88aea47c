/* Inputs that were refused are NaN, and no check is true of NaN. */
#include "cohesion_rules.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "dem_rules.h"
#include "pair_names.h"
#include "scene_rules.h"

#define MOST_GAP 0.2 /* of the smallest diameter: the lists of neighbors grow with it */
enum { LONGEST_PLACE = 80 };

static const char *const law_names[] = {
    [DEM_NO_COHESION] = "", [DEM_CONSTANT_PULL] = "constant",      [DEM_SJKR] = "sjkr", [DEM_SJKR2] = "sjkr2",
    [DEM_JKR] = "jkr",      [DEM_LIQUID_BRIDGE] = "liquid-bridge",
};

static dem_cohesion_law law_of(const cohesion_inputs *c)
{
    return c->law >= 0.0 ? (dem_cohesion_law)(c->law + 1.0) : DEM_NO_COHESION;
}

static double number_or_none(double x) { return isnan(x) ? 0.0 : x; }

static double mean_weight(const dem_scene_definition *scene)
{
    double mass = 0.0;
    for (size_t s = 0; s < scene->species_count; s++) mass += scene->species[s].share * dem_species_mass(&scene->species[s]);
    return mass * scene->gravity;
}

dem_cohesion cohesion_of(const cohesion_inputs *c, const dem_scene_definition *scene)
{
    switch (law_of(c)) {
    case DEM_CONSTANT_PULL:
        return (dem_cohesion){ .strength = number_or_none(isnan(c->pull_off) ? c->bond_number * mean_weight(scene) : c->pull_off) };
    case DEM_SJKR:
    case DEM_SJKR2: return (dem_cohesion){ .strength = number_or_none(c->energy_density) };
    case DEM_JKR: return (dem_cohesion){ .strength = number_or_none(c->surface_energy) };
    case DEM_LIQUID_BRIDGE:
        return (dem_cohesion){ .strength = number_or_none(c->surface_tension),
                               .liquid_volume = number_or_none(c->liquid_volume),
                               .contact_angle = number_or_none(c->contact_angle_deg) * DEM_PI / 180.0 };
    case DEM_NO_COHESION: break;
    }
    return (dem_cohesion){ .strength = 0.0 };
}

/* --- what one says --- */

/* A member that was refused is NaN, as one that is missing. */
static bool is_told(const problem_list *problems, const char *pointer)
{
    size_t k;
    json_t *error;
    json_array_foreach(problems->errors, k, error)
    {
        const char *told = json_string_value(json_object_get(error, "pointer"));
        if (told && strcmp(told, pointer) == 0) return true;
    }
    return false;
}

typedef struct cohesion_member {
    const char *name;
    double value;
    bool is_of_law, is_needed;
} cohesion_member;

static void check_members(const cohesion_inputs *c, const char *place, problem_list *problems)
{
    const dem_cohesion_law law = law_of(c);
    const bool is_constant = law == DEM_CONSTANT_PULL, is_sjkr = law == DEM_SJKR || law == DEM_SJKR2;
    const bool is_bridge = law == DEM_LIQUID_BRIDGE;
    const cohesion_member members[] = {
        { "pull_off", c->pull_off, is_constant, isnan(c->bond_number) },
        { "bond_number", c->bond_number, is_constant, false },
        { "energy_density", c->energy_density, is_sjkr, true },
        { "surface_energy", c->surface_energy, law == DEM_JKR, true },
        { "liquid_volume", c->liquid_volume, is_bridge, true },
        { "surface_tension", c->surface_tension, is_bridge, true },
        { "contact_angle_deg", c->contact_angle_deg, is_bridge, false },
    };
    char pointer[LONGEST_PLACE + 40];
    for (size_t k = 0; k < sizeof members / sizeof *members; k++) {
        const cohesion_member *m = &members[k];
        snprintf(pointer, sizeof pointer, "%s/%s", place, m->name);
        if (!isnan(m->value) && !m->is_of_law)
            problem_list_add(problems, pointer, "is %g, but the law is \"%s\", which does not take it", m->value, law_names[law]);
        else if (isnan(m->value) && m->is_of_law && m->is_needed && !is_told(problems, pointer))
            problem_list_add(problems, pointer, "is missing; \"%s\" needs it%s", law_names[law],
                             is_constant ? ", or bond_number" : "");
    }
}

static void check_law(const cohesion_inputs *c, const dem_scene_definition *scene, const char *place, problem_list *problems)
{
    const dem_cohesion_law law = law_of(c);
    char pointer[LONGEST_PLACE + 40];
    snprintf(pointer, sizeof pointer, "%s/law", place);
    if (scene->contact.law != DEM_HERTZ_MINDLIN && law == DEM_JKR)
        problem_list_add(problems, pointer,
                         "is \"jkr\", which is the theory of an elastic contact, but springs are linear; must be another, or the "
                         "contact's law \"hertz-mindlin\"");
    if (scene->contact.law != DEM_HERTZ_MINDLIN && (law == DEM_SJKR || law == DEM_SJKR2))
        problem_list_add(
            problems, pointer,
            "is \"%s\", whose pull grows as the overlap does, as the push of a linear spring: that would make contacts "
            "softer, and not cohere; must be another, or the contact's law \"hertz-mindlin\"",
            law_names[law]);
    if (law != scene->contact.cohesion_law)
        problem_list_add(problems, pointer, "is \"%s\"; must be \"%s\", as all that coheres has one law", law_names[law],
                         law_names[scene->contact.cohesion_law]);
}

/* One of all that may say something of cohesion: contact and wall, then the pairs. place: becomes where it stands. */
static cohesion_inputs cohesion_by_number(const scene_inputs *inputs, size_t number, char place[LONGEST_PLACE])
{
    if (number >= 2) {
        snprintf(place, LONGEST_PLACE, "/inputs/pairs/%zu/cohesion", number - 2);
        return inputs->pairs[number - 2].cohesion;
    }
    snprintf(place, LONGEST_PLACE, "/inputs/%s/cohesion", number == 0 ? "contact" : "wall");
    return number == 0 ? inputs->cohesion : inputs->wall_cohesion;
}

double cohesion_derive(const scene_inputs *inputs, dem_scene_definition *scene, problem_list *problems)
{
    char place[LONGEST_PLACE];
    const size_t count = 2 + inputs->pair_count;
    for (size_t k = 0; k < count && scene->contact.cohesion_law == DEM_NO_COHESION; k++) {
        const cohesion_inputs c = cohesion_by_number(inputs, k, place);
        scene->contact.cohesion_law = law_of(&c);
    }
    for (size_t k = 0; k < count && !problem_list_is_full(problems); k++) {
        const cohesion_inputs c = cohesion_by_number(inputs, k, place);
        if (isnan(c.law)) continue;
        check_law(&c, scene, place, problems);
        check_members(&c, place, problems);
    }
    if (scene->contact.cohesion_law == DEM_NO_COHESION) return 0.0;
    scene->contact.cohesion = cohesion_of(&inputs->cohesion, scene);
    scene->contact.wall_cohesion = cohesion_of(&inputs->wall_cohesion, scene);
    const double radius = 0.5 * scene_of_species(scene, dem_species_largest_sphere, true);
    return fmax(dem_pull_off(scene->contact.cohesion_law, &scene->contact.cohesion, 0.5 * radius),
                dem_pull_off(scene->contact.cohesion_law, &scene->contact.wall_cohesion, radius));
}

double cohesion_stiffness(const collision *worst, double overlap) { return 2.0 * worst->pull / (overlap * worst->smallest); }

double cohesion_modulus(const collision *worst, double overlap)
{
    return 0.75 * worst->pull / (sqrt(0.25 * worst->smallest) * pow(0.5 * overlap * worst->smallest, 1.5));
}

/* --- what follows --- */

/* What two bodies in touch are. */
typedef struct cohesive_contact {
    dem_cohesion cohesion;
    double modulus, stiffness; /* Pa, E*; N/m, K1 */
    double radius, mass;       /* m, kg: effective, of the smallest spheres and the lightest */
} cohesive_contact;

static cohesive_contact contact_between(const dem_scene_definition *scene, size_t a, size_t partner)
{
    const dem_contact_parameters *c = &scene->contact;
    const bool is_species = partner < DEM_MAXIMUM_SPECIES;
    const double r = 0.5 * dem_species_smallest_sphere(&scene->species[a]), m = dem_species_contact_mass(&scene->species[a]);
    cohesive_contact found = { is_species ? c->cohesion : c->wall_cohesion, dem_effective_modulus(c->particle, c->particle),
                               c->stiffness, r, m };
    if (scene->has_pairs) {
        const dem_pair *p = &scene->pair[a][partner];
        found.cohesion = p->cohesion;
        found.modulus = dem_effective_modulus(p->elasticity[0], p->elasticity[1]);
        found.stiffness = p->stiffness;
    }
    if (!is_species) return found;
    const double q = 0.5 * dem_species_smallest_sphere(&scene->species[partner]),
                 n = dem_species_contact_mass(&scene->species[partner]);
    found.radius = r * q / (r + q);
    found.mass = m * n / (m + n);
    return found;
}

/* m: the overlap at which a contact that nothing presses is at rest. */
static double overlap_at_rest(const cohesive_contact *c, const dem_scene_definition *scene)
{
    const double pull = dem_pull_off(scene->contact.cohesion_law, &c->cohesion, c->radius);
    if (scene->contact.law != DEM_HERTZ_MINDLIN) return pull / c->stiffness;
    const double density = 4.0 * DEM_PI * c->radius * c->cohesion.strength; /* sjkr: N/m, twice what its area has */
    switch (scene->contact.cohesion_law) {
    case DEM_SJKR: return pow(0.375 * density / (c->modulus * sqrt(c->radius)), 2.0);
    case DEM_SJKR2: return pow(0.75 * density / (c->modulus * sqrt(c->radius)), 2.0);
    case DEM_JKR: {
        const double a = dem_jkr_least_contact(c->cohesion.strength, c->modulus, c->radius);
        return cbrt(48.0) * a * a / c->radius; /* y^3 = 6: y^4 - 4 y = 2 6^(1/3) */
    }
    default: return pow(0.75 * pull / (c->modulus * sqrt(c->radius)), 2.0 / 3.0);
    }
}

/* s: the swing about that rest, as fast as a Hertzian contact of its radius is stiff. */
static double step_at_rest(const cohesive_contact *c, const dem_scene_definition *scene, double overlap)
{
    if (scene->contact.law != DEM_HERTZ_MINDLIN || overlap <= 0) return INFINITY;
    double a = sqrt(c->radius * overlap);
    if (scene->contact.cohesion_law == DEM_JKR) a = cbrt(36.0) * dem_jkr_least_contact(c->cohesion.strength, c->modulus, c->radius);
    return DEM_PI * sqrt(c->mass / (2.0 * c->modulus * a)) / DEM_STEPS_PER_CONTACT;
}

double cohesion_complete(const scene_inputs *inputs, const collision *worst, double overlap, dem_scene_definition *scene,
                         problem_list *problems)
{
    double gap = 0.0, at_rest = 0.0;
    for (size_t a = 0; scene->contact.cohesion_law && inputs->species_count && a < scene->species_count; a++)
        for (size_t b = 0; b < DEM_MAXIMUM_SPECIES + DEM_SURFACES; b++) {
            if (!partner_is_there(scene, b)) continue;
            const cohesive_contact c = contact_between(scene, a, b);
            if (!(c.cohesion.strength > 0)) continue;
            const double rest = overlap_at_rest(&c, scene);
            gap = larger_of(gap, dem_cohesive_gap(scene->contact.cohesion_law, &c.cohesion, c.modulus, c.radius));
            at_rest = larger_of(at_rest, rest);
            scene->time_step = smaller_of(scene->time_step, step_at_rest(&c, scene, rest));
        }
    const char *const place = !isnan(inputs->cohesion.law)        ? "/inputs/contact/cohesion"
                              : !isnan(inputs->wall_cohesion.law) ? "/inputs/wall/cohesion"
                                                                  : "/inputs/pairs";
    if (isfinite(gap) && gap > MOST_GAP * worst->smallest)
        problem_list_add(problems, place, "acts over gaps of %.3g m; must act over at most %.3g m, %g of the smallest diameter",
                         gap, MOST_GAP * worst->smallest, MOST_GAP);
    if (at_rest > 0.5 * MOST_OVERLAP * worst->smallest)
        problem_list_add(
            problems, place,
            "presses particles %.3g of the smallest diameter into each other; must do so by at most %g: give less of it, or "
            "stiffer contacts",
            at_rest / worst->smallest, 0.5 * MOST_OVERLAP);
    return overlap + at_rest / worst->smallest;
}

double cohesion_bond_number(const dem_scene_definition *scene)
{
    double pull = 0.0;
    for (size_t a = 0; scene->contact.cohesion_law && a < scene->species_count; a++)
        for (size_t b = 0; b < scene->species_count; b++) {
            const cohesive_contact c = contact_between(scene, a, b);
            pull = fmax(pull, dem_pull_off(scene->contact.cohesion_law, &c.cohesion, c.radius));
        }
    return pull / mean_weight(scene);
}
