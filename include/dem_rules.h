/* The rules that turn a user's wishes into a definition: how many particles a fill is, how stiff a contact
 * must be for the overlap allowed, how long a time step may be. The library build/librules.a (core/rules),
 * which the daemon links without the core, because it gives estimates. Sources and measurements: core/NUMERICS.md. */
#ifndef DEM_RULES_H
#define DEM_RULES_H

#include "dem_types.h"

#define DEM_PI 3.14159265358979323846

/* Time steps in one collision of the two lightest particles: between 20 and 25 is safe. */
#define DEM_STEPS_PER_CONTACT 20.0
/* Solid fraction of a bed at rest by which fill_fraction counts particles. */
#define DEM_BED_SOLID_FRACTION 0.6

/* What a run can tell, of its bed and of its length: core/NUMERICS.md, "What a run can tell". Fewer particles or layers
 * than of a bed have no angle; fewer than of a verdict have one that nobody can judge. */
#define DEM_LEAST_BED_PARTICLES 30
#define DEM_LEAST_BED_LAYERS 2
#define DEM_LEAST_PARTICLES 100
#define DEM_LEAST_LAYERS 4
#define DEM_LEAST_REVOLUTIONS 0.5         /* turned in all */
#define DEM_LEAST_WINDOW_REVOLUTIONS 0.25 /* and in the window */
#define DEM_SLIPS_FROM 0.15               /* mean slip at the wall, between beds that renew themselves and those that do not */
#define DEM_LEAST_SLIPPING_REVOLUTIONS 8  /* turned in all by a bed that slips */
#define DEM_LEAST_WINDOW_FRAMES 40
#define DEM_LEAST_CORRELATION_TIMES 20          /* as the window itself shows them, which may be twice too many */
#define DEM_LEAST_CORRELATION_TIMES_OF_A_BED 10 /* where several beds have that many together */
#define DEM_LEAST_FALLS 3                       /* slumps or avalanches that tell as much as so many revolutions */

double dem_sphere_mass(double diameter, double density);

/* Of one particle of a species, of the mean one where sizes differ; a cluster's must be complete (dem_cluster.h). */
double dem_species_volume(const dem_species *s);

double dem_species_mass(const dem_species *s);

/* Of the largest particle, where sizes differ; else of each. */
double dem_species_heaviest(const dem_species *s);

/* Diameter of the sphere of the same volume, m; of the largest particle, where sizes differ. */
double dem_species_diameter(const dem_species *s);

/* Radius of the sphere about its centre of mass that holds the particle, the largest one, m. */
double dem_species_reach(const dem_species *s);

/* Diameter of its smallest sphere, m. */
double dem_species_smallest_sphere(const dem_species *s);

double dem_species_largest_sphere(const dem_species *s);

/* Diameter of the largest sphere of all, m: of particles or of the lining. */
double dem_largest_sphere(const dem_scene_definition *d);

/* The least mass, kg, that a contact can move: a cluster pushed beside its centre also turns,
 * 1/m + |r|^2/I with r from its centre to the sphere's, which is as long as the arm of the force can be. */
double dem_species_contact_mass(const dem_species *s);

/* Mean volume of a particle, m3, for shares by number. */
double dem_mean_volume(const dem_species *species, size_t count);

/* How much of the ellipsoid of the same mass and moments of inertia a particle fills: a sphere all of it, chains of touching
 * spheres 0.8, tetrahedra 0.61, cubes 0.54, blocks of 27 spheres 0.50, crosses of seven 0.40. */
double dem_species_compactness(const dem_species *s);

/* Solid fraction that particles of one shape can be packed to. What bulges in stays empty, and particles of many small spheres
 * reach less far into each other's pores. From beds of eight shapes: core/NUMERICS.md, "How full a container can be". */
#define DEM_MOST_SOLID 0.57 /* of spheres */
#define DEM_MOST_SOLID_OF_BLOCKS 0.522
#define DEM_MOST_SOLID_OF_LARGE_BLOCKS 0.5 /* of more spheres than: */
#define DEM_BLOCK_SPHERES 8
double dem_species_most_solid(const dem_species *s);

/* The mean of that by volume. */
double dem_most_solid(const dem_species *species, size_t count);

/* How much a bed fills of an upright container that it was poured into with much friction: it is loose along the wall. */
double dem_poured_solid(const dem_scene_definition *d);

/* Share of a container's free volume, without the layer of a lining and without bars, that particles may have the volume of for
 * all of them to find a place at the start and to grow there: in a drum a little more than they can be packed to; half of one
 * that is open at the top, which growing particles would leave. */
double dem_most_placed(const dem_scene_definition *d);

/* How many particles fill `fill_fraction` of a drum's cross-section. */
double dem_particles_of_fill(double diameter, double length, double fill_fraction, const dem_species *species, size_t count);

double dem_fill_of_particles(double diameter, double length, double particles, const dem_species *species, size_t count);

/* Largest speed, m/s, at which one of many particles meets the wall or a bed that backs another in a drum: falling
 * down the surface, which friction steepens, and thrown by the wall; a bed few diameters across is jerkier. Fitted to
 * the largest overlaps that the runs listed in core/NUMERICS.md ("Stiffness") ever showed. */
double dem_impact_speed(double drum_diameter, double largest_diameter, double gravity, double friction, double rotation_rate);

/* The same for a particle that a lifter drops from the top of the drum onto the bed, or onto the wall where the bed is
 * shallow, on top of what the wall throws. */
double dem_lifted_speed(double drum_diameter, double gravity, double fill_fraction, double rotation_rate);

bool dem_have_sizes(const dem_species *species, size_t count);

/* Of two spheres or more each. */
bool dem_has_clusters(const dem_species *species, size_t count);

/* Friction of the bed of spheres that is as steep: clusters interlock, whatever their friction. */
double dem_bed_friction(double friction, const dem_species *species, size_t count);

/* K1, N/m, for the heaviest particle to overlap with what does not give way by at most `overlap` (m) at that speed:
 * alpha = v sqrt(m/K1). */
double dem_stiffness_for_overlap(double impact_speed, double heaviest_mass, double overlap);

/* Hertz-Mindlin: E* (Pa) for the same; alpha = (15 m v^2/(16 E* sqrt(R)))^(2/5). radius: effective, m. */
double dem_hertz_modulus_for_overlap(double impact_speed, double heaviest_mass, double radius, double overlap);

/* Duration of an elastic Hertzian collision, 2.868 (m^2/(R E*^2 v))^(1/5), over DEM_STEPS_PER_CONTACT. */
double dem_hertz_time_step(double effective_modulus, double lightest_mass, double radius, double impact_speed);

/* Walton-Braun: below this restitution the unloading branch alone, e of the loading's time, sets the step: it is to have no
 * fewer steps than here. */
#define DEM_SHORTEST_UNLOADING 0.3

/* Duration of a collision, t_c = (pi/2) sqrt(m_eff/K1) (1 + e), over DEM_STEPS_PER_CONTACT. */
double dem_time_step(double stiffness, double lightest_mass, double restitution);

double dem_latching_time_step(double stiffness, double lightest_mass, double restitution);

/* Pa, E* of two materials: 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2. */
double dem_effective_modulus(dem_elasticity a, dem_elasticity b);

/* N: the largest pull that a contact of this effective radius (m) bears; 0 of sjkr, whose pull goes with the overlap. */
double dem_pull_off(dem_cohesion_law law, const dem_cohesion *cohesion, double radius);

/* m: the gap up to which contacts hold that have touched. effective_modulus: Pa, E*, of jkr alone. */
double dem_cohesive_gap(dem_cohesion_law law, const dem_cohesion *cohesion, double effective_modulus, double radius);

/* m: radius of the contact at which jkr breaks, (pi w R^2/(8 E*))^(1/3). */
double dem_jkr_least_contact(double surface_energy, double effective_modulus, double radius);

/* Share of a unit circle's area below the height y. */
double dem_circle_below(double y);

/* Height, as a share of a circle's radius, below which `share` of its area lies: -1 for 0, 1 for 1. */
double dem_circle_level(double share);

/* Depth of a bed at mid-chord, in mean diameters. share: of the cross-section, that the bed takes up. */
double dem_bed_layers(double drum_diameter, double share, double mean_diameter);

/* Time to make the bed of a drum or tube, s of simulated time. Growing takes what the core's filling.c says. Settling ends when
 * little kinetic energy is left for each particle: in a drum, grains that lie side by side on the wall roll down to its lowest
 * line, held back by the drag, and do so the longer the fewer they are beside the row that the random start has room for,
 * 2 sqrt(D/d) of them in a cross-section, and the less friction holds them; where they lie on each other they stop at once.
 * Clusters interlock, and stop sooner than the spheres that hold them would. Seeds scatter by 0.3 of the time for less than such
 * a row, by 0.1 to 0.2 above. From beds of 8 to 2700 particles, D/d from 8.5 to 100: core/NUMERICS.md, "How long a bed takes". */
double dem_settling_time(const dem_scene_definition *d);

/* Shares of that time which 19 of 20 beds of a drum are between: few particles roll each in its own way. */
typedef struct dem_range {
    double low, high;
} dem_range;
dem_range dem_settling_range(const dem_scene_definition *d);

/* Resident memory of a run, bytes, without its tables of results: from drums of 1 to 20,000 spheres. */
double dem_memory_estimate(double sphere_count);

/* Cells a side of a drum's fields: half a mean diameter wide; wider where there would be more than 512, or more than 64 for
 * each particle, which beds of a few hundredths of the drum have not. No less than 64 a side for that. */
double dem_field_cells(double drum_diameter, double mean_diameter, double particles);

/* Of particles, walls, ends or plate: then every contact carries a moment. */
/* Which stage of its rotation a drum is in that long after rotation began. since: becomes when it began, s. */
size_t dem_stage_at(const dem_scene_definition *definition, double time, double *since);
/* The last stage in which it turns; where there is none, or there are no stages: stage_count. since: likewise. */
size_t dem_last_turning_stage(const dem_scene_definition *definition, double *since);

bool dem_has_rolling_friction(const dem_scene_definition *d);

#endif
