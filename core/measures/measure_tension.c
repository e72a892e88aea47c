/* How many of the contacts between spheres pull: of those that hold, touching or joined beyond touch, the share in which spring and
 * cohesion together are a pull. Dashpots are left out, which may pull at the end of any collision. */
#include "dem_rules.h"
#include "measure.h"

/* A contact, with where its numbers are in the list: of its history, and of its constants. */
typedef struct held_contact {
    const contact_list *list;
    size_t history, constants;
    double alpha;    /* m, overlap; negative: apart */
    double radii[2]; /* m */
} held_contact;

static double law_number_of(const held_contact *h, int number, double of_all)
{
    return h->list->laws_differ ? (double)h->list->law[number][h->constants] : of_all;
}

static double cohesion_number_of(const held_contact *h, int number) { return (double)h->list->cohesion[number][h->constants]; }

static double latching_spring(const held_contact *h, const dem_contact_parameters *c)
{
    const real alpha = (real)h->alpha, k_1 = (real)law_number_of(h, LAW_K_N, c->stiffness);
    const bool has_slope = c->unloading_slope > 0;
    const real unloading =
        (real)law_number_of(h, LAW_K_2, has_slope ? c->unloading_slope : c->stiffness / (c->restitution * c->restitution));
    real latch = h->list->alpha_0[h->history];
    return (double)(has_slope ? normal_force_of_slope(alpha, 0, k_1, unloading, 0, &latch)
                              : normal_force(alpha, 0, k_1, unloading, 0, &latch));
}

/* N, where they touch. */
static double spring_of(const held_contact *h, const dem_contact_parameters *c)
{
    if (!(h->alpha > 0)) return 0;
    if (c->law == DEM_WALTON_BRAUN) return latching_spring(h, c);
    const double k_n = law_number_of(h, LAW_K_N, (double)h->list->damped.k_n);
    if (c->law == DEM_SPRING_DASHPOT) return k_n * h->alpha;
    return 4.0 / 3 * k_n * sqrt((double)h->list->radius[h->constants] * h->alpha) * h->alpha;
}

/* N: core/NUMERICS.md, "Cohesion". */
static double pull_of(const held_contact *h, dem_cohesion_law law)
{
    const double strength = cohesion_number_of(h, 0), sum = h->radii[0] + h->radii[1], r = sum - h->alpha;
    const double share = (h->radii[0] - h->radii[1]) / r, gap = fmax(-h->alpha, 0);
    switch (law) {
    case DEM_SJKR: return strength * DEM_PI / 4 * h->alpha * (2 * sum - h->alpha) * (1 - share * share);
    case DEM_SJKR2: return strength * h->alpha;
    case DEM_LIQUID_BRIDGE: return strength * (1 - gap / sqrt(gap * gap + cohesion_number_of(h, 1)));
    default: return strength;
    }
}

/* Of JKR's: N is 0 at y^3 = 6, where y^4 - 4 y is 2 6^(1/3). */
static double jkr_overlap(const held_contact *h) { return h->alpha * cohesion_number_of(h, 0); }

static bool holds(const held_contact *h, dem_cohesion_law law)
{
    if (h->alpha > 0) return true;
    if (h->list->alpha_0[h->history] == 0) return false;
    return (law == DEM_JKR && jkr_overlap(h) > -3) || (law == DEM_LIQUID_BRIDGE && -h->alpha < cohesion_number_of(h, 2));
}

static bool pulls(const held_contact *h, const dem_contact_parameters *c)
{
    if (c->cohesion_law == DEM_JKR) return jkr_overlap(h) < 2 * cbrt(6);
    return spring_of(h, c) < pull_of(h, c->cohesion_law);
}

double measure_tension_share(const dem_scene *scene)
{
    const contact_list *list = &scene->neighbors.pairs;
    const dem_contact_parameters *c = &scene->definition.contact;
    size_t held = 0, in_tension = 0;
    if (!list->coheres) return NAN;
    for (size_t k = 0; k < list->count; k++) {
        const size_t i = (size_t)list->first[k], j = (size_t)list->second[k];
        const held_contact h = { list,
                                 k,
                                 constants_of(list, k),
                                 measure_overlap_of(scene, i, j),
                                 { sphere_radius(&scene->spheres, i), sphere_radius(&scene->spheres, j) } };
        if (!holds(&h, c->cohesion_law)) continue;
        held++;
        in_tension += pulls(&h, c);
    }
    return held ? (double)in_tension / (double)held : NAN;
}
