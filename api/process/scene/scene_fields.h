/* Rows that the tables of several processes share: particles, contacts, what is written and how it is run. To be
 * included once by each file that has such a table. */
#ifndef SCENE_FIELDS_H
#define SCENE_FIELDS_H

#include <math.h>

#include "dem_cluster.h"
#include "input_rows.h"
#include "scene_rules.h"

static const char *const cohesion_choices[] = { "constant", "sjkr", "sjkr2", "jkr", "liquid-bridge", NULL }; /* dem_cohesion_law */
static const char *const size_choices[] = { "lognormal", "normal", "rosin-rammler", "uniform", "table", NULL }; /* dem_size_law */
static const char *const size_bases[] = { "mass", "volume", "number", NULL }; /* in the order of size_basis */
_Static_assert(sizeof size_choices / sizeof *size_choices == DEM_SIEVES + 1, "each law of sizes has a name");
enum { MOST_MATERIALS = 32, MOST_PAIRS = 400 };
static const char *const shape_choices[] = { "sphere", "dumbbell", "tetrahedron", "cube", NULL }; /* as dem_shape counts them */
static const char *const unloading_choices[] = { "constant", "variable", NULL };
static const char *const rolling_choices[] = { "epsd", "epsd-damped", "constant", NULL }; /* dem_rolling_law */
static const char *const precision_choices[] = { "single", "double", NULL };
static const char *const share_choices[] = { "number", "volume", "mass", NULL }; /* in the order of share_basis */
_Static_assert(sizeof shape_choices / sizeof *shape_choices == DEM_NAMED_SHAPES + 1, "each shape has a name");
_Static_assert(sizeof share_choices / sizeof *share_choices == SHARE_BY_MASS + 2, "each basis has a name");

#define AT(member) .offset = offsetof(scene_inputs, member)
#define AT_SPECIES(member) .offset = offsetof(species_inputs, member)
#define AT_MATERIAL(member) .offset = offsetof(material_inputs, member)
#define AT_PAIR(member) .offset = offsetof(pair_inputs, member)
#define AT_SIZES(member) .offset = offsetof(species_inputs, sizes.member)
#define AT_SPHERE(member) .offset = offsetof(dem_cluster_sphere, member)

/* As they would stand in a table, but for the backslashes. */
/* clang-format off */
#define FIELDS_OF_PARTICLES \
    { SPEC_INPUTS, "particles", FIELD_LIST, SPEC_PARTICLES, .required = true, RANGE(1, DEM_MAXIMUM_SPECIES), AT(species), \
      .count_offset = offsetof(scene_inputs, species_count), .entry_size = sizeof(species_inputs), \
      COLUMN("species", COUNT, scene.species_count), LISTED, IN_LIST(120, "of ", 1, " kinds"), .list_above = 1, IN_VIEW(190), \
      .meaning = "the kinds of particles" }, \
    { SPEC_PARTICLES, "shape", FIELD_CHOICE_OR_OBJECT, SPEC_SHAPE, .unit = "", .choices = shape_choices, AT_SPECIES(shape), \
      COLUMN("shape", WORD, inputs.species[0].shape), IN_VIEW(50), \
      .meaning = "shape of a particle: a sphere, or a rigid cluster of 2, 4 or 8 touching spheres, or of spheres placed one " \
                 "by one, which must touch or overlap" }, \
    { SPEC_SHAPE, "spheres", FIELD_LIST, SPEC_SPHERES, .required = true, RANGE(1, DEM_MAXIMUM_CLUSTER), AT_SPECIES(sphere), \
      .count_offset = offsetof(species_inputs, sphere_count), .entry_size = sizeof(dem_cluster_sphere), \
      .meaning = "the spheres of a cluster" }, \
    { SPEC_SPHERES, "position", FIELD_PLACE, .required = true, .unit = "m", RANGE(-1.0, 1.0), .fallback = NAN, AT_SPHERE(position), \
      .meaning = "centre of the sphere, in any frame of the cluster's own" }, \
    { SPEC_SPHERES, "diameter", FIELD_REAL, .unit = "m", RANGE(1e-5, 1.0), .fallback = NAN, AT_SPHERE(diameter), \
      USUAL(1e-4, 0.05), SLIP("cm", 0.01), .meaning = "diameter of this sphere. Default: the particle's diameter" }, \
    { SPEC_PARTICLES, "diameter", FIELD_REAL, .required = true, .spared_by = "shape", \
      .spared_by_too = "size_distribution", .excludes_too = "size_distribution", .unit = "m", RANGE(1e-5, 1.0), \
      .fallback = NAN, AT_SPECIES(diameter), \
      USUAL(1e-4, 0.05), SLIP("cm", 0.01), \
      COLUMN("diameter", REAL, scene.species[0].diameter), LISTED, IN_LIST(130, "× ", 1, NULL), IN_VIEW(200), IN_FORM(40, NULL), \
      .meaning = "diameter of the sphere, or of each sphere of a cluster; to be left out only where every sphere of a " \
                 "cluster has its own, or with size_distribution; the column then has that of the sphere of mean volume" }, \
    { SPEC_PARTICLES, "size_distribution", FIELD_OBJECT_OR_NULL, SPEC_SIZES, .is_left_out_where_null = true, AT_SIZES(type), \
      .meaning = "sizes of spheres that are not all alike, instead of diameter" }, \
    { SPEC_SIZES, "type", FIELD_CHOICE, .unit = "", .choices = size_choices, AT_SIZES(type), \
      .meaning = "lognormal (median, geometric_deviation), normal (mean, deviation), rosin-rammler (size, spread), uniform " \
                 "(minimum, maximum), table (sizes, and cumulative or shares)" }, \
    { SPEC_SIZES, "by", FIELD_CHOICE, .unit = "", .choices = size_bases, AT_SIZES(by), \
      .meaning = "what the shares of the distribution are of: mass or volume, which are the same for one density, or number" }, \
    { SPEC_SIZES, "median", FIELD_REAL, .unit = "m", RANGE(1e-5, 1.0), .fallback = NAN, AT_SIZES(median), \
      .meaning = "of lognormal: half is smaller" }, \
    { SPEC_SIZES, "geometric_deviation", FIELD_REAL, .unit = "", OPEN_RANGE(1.0, 10.0), .fallback = NAN, \
      AT_SIZES(geometric_deviation), .meaning = "of lognormal: the size that 84.1 % is smaller than, over the median" }, \
    { SPEC_SIZES, "mean", FIELD_REAL, .unit = "m", RANGE(1e-5, 1.0), .fallback = NAN, AT_SIZES(mean), .meaning = "of normal" }, \
    { SPEC_SIZES, "deviation", FIELD_REAL, .unit = "m", OPEN_RANGE(0.0, 1.0), .fallback = NAN, AT_SIZES(deviation), \
      .meaning = "of normal: standard deviation" }, \
    { SPEC_SIZES, "size", FIELD_REAL, .unit = "m", RANGE(1e-5, 1.0), .fallback = NAN, AT_SIZES(size), \
      .meaning = "of rosin-rammler: 63.2 % is smaller" }, \
    { SPEC_SIZES, "spread", FIELD_REAL, .unit = "", RANGE(0.2, 100.0), .fallback = NAN, AT_SIZES(spread), \
      .meaning = "of rosin-rammler: the exponent; the larger, the narrower" }, \
    { SPEC_SIZES, "minimum", FIELD_REAL, .unit = "m", RANGE(1e-5, 1.0), .fallback = NAN, AT_SIZES(minimum), \
      .meaning = "there are no smaller ones. Default: the size that 0.1 % of the distribution is smaller than; of table, the first" }, \
    { SPEC_SIZES, "maximum", FIELD_REAL, .unit = "m", RANGE(1e-5, 1.0), .fallback = NAN, AT_SIZES(maximum), \
      .meaning = "there are no larger ones. Default: the size that 99.9 % of the distribution is smaller than; of table, the last" }, \
    { SPEC_SIZES, "file", FIELD_TEXT, .unit = "", RANGE(1, 256), AT_SIZES(file), \
      .meaning = "of table, instead of its lists: a table of comma-separated values with the columns size (m), and cumulative or " \
                 "share; for repose run alone, its path relative to the specification" }, \
    { SPEC_SIZES, "sizes", FIELD_NUMBERS, .unit = "m", RANGE(1e-5, 1.0), .least_entries = 2, .most_entries = DEM_MAXIMUM_SIEVES, \
      .fallback = NAN, AT_SIZES(sizes), .count_offset = offsetof(species_inputs, sizes.size_count), \
      .meaning = "of table: openings of the sieves, ascending" }, \
    { SPEC_SIZES, "cumulative", FIELD_NUMBERS, .unit = "", RANGE(0.0, 1.0), .least_entries = 2, .most_entries = DEM_MAXIMUM_SIEVES, \
      .fallback = NAN, AT_SIZES(cumulative), .count_offset = offsetof(species_inputs, sizes.cumulative_count), \
      .meaning = "of table: for each size, the share that is smaller; between them it goes in straight lines" }, \
    { SPEC_SIZES, "shares", FIELD_NUMBERS, .unit = "", RANGE(0.0, 1.0), .least_entries = 1, .most_entries = DEM_MAXIMUM_SIEVES, \
      .fallback = NAN, AT_SIZES(shares), .count_offset = offsetof(species_inputs, sizes.share_count), \
      .meaning = "of table, instead of cumulative: the share between each size and the next" }, \
    { SPEC_PARTICLES, "material", FIELD_TEXT, .unit = "", RANGE(1, NAME_MOST), AT_SPECIES(material), \
      .meaning = "name of its material, a member of materials" }, \
    { SPEC_PARTICLES, "density", FIELD_REAL, .unit = "kg/m3", RANGE(1.0, 30000.0), .fallback = 2500.0, \
      .spared_beside = "material", AT_SPECIES(density), \
      USUAL(100.0, 23000.0), SLIP("g/cm3", 1000.0), \
      COLUMN("density", REAL, scene.species[0].density), LISTED, IN_VIEW(210), \
      .meaning = "density of the particle itself, not of the bed. With material: its density" }, \
    { SPEC_PARTICLES, "share", FIELD_REAL, .unit = "", OPEN_RANGE(0.0, 1.0), .fallback = NAN, AT_SPECIES(share), \
      FREE_OF_BED, .meaning = "share of the particles, by what share_by says; all shares sum to 1. Default: equal shares" }, \
    { SPEC_INPUTS, "share_by", FIELD_CHOICE, .unit = "", .choices = share_choices, AT(share_by), \
      .meaning = "what a share counts: particles, their own volume (without the pores), or their mass" }

#define FIELDS_OF_CONTACT \
    { SPEC_INPUTS, "contact", FIELD_OBJECT, SPEC_CONTACT, .meaning = "contact between particles" }, \
    { SPEC_CONTACT, "law", FIELD_CHOICE, .unit = "", .choices = contact_law_names, AT(contact_law), \
      COLUMN("law", WORD, inputs.contact_law), IN_VIEW(215), \
      .meaning = "walton-braun: latching spring and incremental friction; spring-dashpot: linear springs and dashpots; " \
                 "hertz-mindlin: elastic, no-slip, damping set from restitution" }, \
    { SPEC_CONTACT, "friction", FIELD_REAL, .unit = "", RANGE(0.0, 5.0), .fallback = 0.3, AT(friction), \
      USUAL(0.0, 1.5), \
      COLUMN("friction", REAL, scene.contact.friction), LISTED, IN_LIST(10, "μ ", 1, NULL), IN_VIEW(220), IN_FORM(60, NULL), \
      .meaning = "coefficient of friction between particles" }, \
    { SPEC_CONTACT, "rolling_friction", FIELD_REAL, .unit = "", RANGE(0.0, 1.0), .fallback = 0.0, AT(rolling_friction), \
      COLUMN("rolling_friction", REAL, scene.contact.rolling_friction), IN_VIEW(250), \
      .meaning = "coefficient of rolling friction between particles: a contact bears a moment of it times the normal force " \
                 "times the effective radius. Default: none" }, \
    { SPEC_CONTACT, "rolling_law", FIELD_CHOICE, .unit = "", .choices = rolling_choices, AT(rolling_law), \
      COLUMN("rolling_law", WORD, inputs.rolling_law), IN_VIEW(267), \
      .meaning = "of all contacts that resist rolling. epsd: an elastic spring that yields at the limit; epsd-damped: with a " \
                 "dashpot until it yields; constant: the limit throughout, against the relative spin" }, \
    { SPEC_CONTACT, "rolling_damping", FIELD_REAL, .unit = "", RANGE(0.0, 0.5), .fallback = NAN, AT(rolling_damping), \
      .meaning = "of epsd-damped: share of critical damping of its spring. Default: 0.3" }, \
    { SPEC_CONTACT, "restitution", FIELD_REAL, .unit = "", RANGE(0.1, 1.0), .fallback = 0.8, \
      .excludes = "unloading_slope", AT(restitution), \
      COLUMN("restitution", REAL, scene.contact.restitution), LISTED, IN_VIEW(230), \
      .meaning = "coefficient of normal restitution; with variable unloading: of the hardest impact expected" }, \
    { SPEC_CONTACT, "unloading", FIELD_CHOICE, .unit = "", .choices = unloading_choices, AT(unloading), \
      .meaning = "of walton-braun. constant: one unloading stiffness K2 for all loads, one restitution for all speeds; " \
                 "variable: K2 = K1 + S N_max, so that restitution falls as impacts get faster" }, \
    { SPEC_CONTACT, "unloading_slope", FIELD_REAL, .unit = "1/m", OPEN_RANGE(0.0, 1e9), .fallback = NAN, \
      .excludes = "restitution", AT(unloading_slope), \
      .meaning = "S of variable unloading, instead of restitution. Default: such that the hardest impact expected " \
                 "has restitution" }, \
    { SPEC_CONTACT, "latch_damping", FIELD_REAL, .unit = "", RANGE(0.0, 1.0), .fallback = 0.3, AT(latch_damping), \
      .meaning = "of walton-braun: share of critical damping of the unloading spring while an overlap grows back to one that " \
                 "it had before. Piles come to rest by it; a collision by itself has none of it. 0: none" }, \
    { SPEC_CONTACT, "tangential_stiffness_ratio", FIELD_REAL, .unit = "", RANGE(0.05, 1.5), .fallback = 0.8, \
      AT(tangential_stiffness_ratio), \
      COLUMN("tangential_stiffness_ratio", REAL, scene.contact.tangential_stiffness_ratio), IN_VIEW(270), \
      .meaning = "initial tangential over normal loading stiffness" }, \
    { SPEC_CONTACT, "maximum_overlap", FIELD_REAL, .unit = "", RANGE(0.0005, 0.05), .fallback = 0.01, .excludes = "stiffness", \
      .excludes_too = "youngs_modulus", AT(maximum_overlap), \
      .meaning = "largest overlap wanted, as a share of the smallest diameter: the stiffness is chosen for it" }, \
    { SPEC_CONTACT, "stiffness", FIELD_REAL, .unit = "N/m", RANGE(1e-3, 1e9), .fallback = NAN, .excludes = "maximum_overlap", \
      .excludes_too = "youngs_modulus", AT(stiffness), \
      COLUMN("stiffness", REAL, scene.contact.stiffness), LISTED, IN_VIEW(280), \
      .meaning = "normal loading stiffness, instead of maximum_overlap; not for hertz-mindlin" }, \
    { SPEC_CONTACT, "youngs_modulus", FIELD_REAL, .unit = "Pa", RANGE(1e3, 1e13), .fallback = NAN, .excludes = "maximum_overlap", \
      AT(youngs_modulus), .meaning = "of particles and wall, instead of maximum_overlap; for hertz-mindlin alone" }, \
    { SPEC_CONTACT, "poissons_ratio", FIELD_REAL, .unit = "", RANGE(0.0, 0.5), .fallback = 0.3, AT(poissons_ratio), \
      .meaning = "of particles and wall; used by hertz-mindlin alone" }, \
    { SPEC_CONTACT, "steps_per_contact", FIELD_REAL, .unit = "", RANGE(10.0, 200.0), .fallback = NAN, AT(steps_per_contact), \
      .meaning = "time steps in a collision of the two lightest particles, or with pairs in that which is over soonest, which " \
                 "the time step follows from. Default: 14 for spheres of walton-braun and epsd whose restitution is 0.7 or " \
                 "more, else 20; with pairs, as many as give each pair its own number" }

#define FIELDS_OF_MATERIALS \
    { SPEC_INPUTS, "materials", FIELD_NAMED_LIST, SPEC_MATERIALS, RANGE(0, MOST_MATERIALS), AT(materials), \
      .count_offset = offsetof(scene_inputs, material_count), .entry_size = sizeof(material_inputs), \
      .meaning = "materials by names of your own, which particles and walls name" }, \
    { SPEC_MATERIALS, "density", FIELD_REAL, .unit = "kg/m3", RANGE(1.0, 30000.0), .fallback = NAN, AT_MATERIAL(density), \
      .meaning = "density, of particles that have none of their own. Default: 2500 kg/m3" }, \
    { SPEC_MATERIALS, "youngs_modulus", FIELD_REAL, .unit = "Pa", RANGE(1e3, 1e13), .fallback = NAN, AT_MATERIAL(youngs_modulus), \
      FREE_OF_BED, .meaning = "for hertz-mindlin, whose contacts have the E* and G* of both materials. Default: the contact's" }, \
    { SPEC_MATERIALS, "poissons_ratio", FIELD_REAL, .unit = "", RANGE(0.0, 0.5), .fallback = NAN, AT_MATERIAL(poissons_ratio), \
      FREE_OF_BED, .meaning = "for hertz-mindlin. Default: the contact's" }, \
    { SPEC_MATERIALS, "poisson_ratio", FIELD_REAL, .unit = "", RANGE(0.0, 0.5), .fallback = NAN, .excludes_too = "poissons_ratio", \
      AT_MATERIAL(poisson_ratio), FREE_OF_BED, .meaning = "another spelling of poissons_ratio" }, \
    { SPEC_INPUTS, "pairs", FIELD_LONG_LIST, SPEC_PAIRS, RANGE(0, MOST_PAIRS), AT(pairs), \
      .count_offset = offsetof(scene_inputs, pair_count), .entry_size = sizeof(pair_inputs), \
      .meaning = "contacts of two materials, or of one and a surface, that differ from what contact and wall say of all" }, \
    { SPEC_PAIRS, "between", FIELD_TWO_NAMES, .unit = "", RANGE(1, NAME_MOST), AT_PAIR(between), \
      .meaning = "the two: names of materials, or a material and a surface of the container. Of a drum: wall (its lining, too, " \
                 "unless that is named itself), ends, lifters, lining; of a cylinder: wall, floor; of a heap: wall or tube, plate; " \
                 "of a vessel: wall, floor (or hopper)" }, \
    { SPEC_PAIRS, "friction", FIELD_REAL, .unit = "", RANGE(0.0, 5.0), .fallback = NAN, AT_PAIR(friction), \
      .meaning = "coefficient of friction. Default: as without the pair" }, \
    { SPEC_PAIRS, "rolling_friction", FIELD_REAL, .unit = "", RANGE(0.0, 1.0), .fallback = NAN, AT_PAIR(rolling_friction), \
      .meaning = "coefficient of rolling friction. Default: as without the pair" }, \
    { SPEC_PAIRS, "restitution", FIELD_REAL, .unit = "", RANGE(0.1, 1.0), .fallback = NAN, AT_PAIR(restitution), \
      .meaning = "coefficient of normal restitution; with variable unloading: of the hardest impact. Default: the contact's" }, \
    { SPEC_PAIRS, "stiffness", FIELD_REAL, .unit = "N/m", RANGE(1e-3, 1e9), .fallback = NAN, AT_PAIR(stiffness), \
      .meaning = "normal loading stiffness; not for hertz-mindlin. Default: the contact's" }

/* The rows of one `cohesion`: group: its members'; at: where its struct begins in what offsets count from. */
#define AT_COHESION(at, member) .offset = (at) + offsetof(cohesion_inputs, member)
#define FIELDS_OF_COHESION(group, at) \
    { group, "law", FIELD_CHOICE, .unit = "", .choices = cohesion_choices, AT_COHESION(at, law), \
      .meaning = "constant: the same pull while they touch; sjkr, sjkr2: an energy density times the area of contact, in which two " \
                 "spheres cut each other, or 4 pi R* times the overlap; jkr: Johnson, Kendall & Roberts; liquid-bridge: formed at a " \
                 "touch, broken at a gap. sjkr and jkr are for hertz-mindlin. One law for all that coheres" }, \
    { group, "pull_off", FIELD_REAL, .unit = "N", RANGE(0.0, 1e6), .fallback = NAN, .excludes_too = "bond_number", \
      AT_COHESION(at, pull_off), .meaning = "of constant: the pull" }, \
    { group, "bond_number", FIELD_REAL, .unit = "", RANGE(0.0, 1e4), .fallback = NAN, AT_COHESION(at, bond_number), \
      .meaning = "of constant, instead of pull_off: the pull over the weight of the mean particle" }, \
    { group, "energy_density", FIELD_REAL, .unit = "J/m3", RANGE(0.0, 1e9), .fallback = NAN, AT_COHESION(at, energy_density), \
      .meaning = "of sjkr and sjkr2" }, \
    { group, "surface_energy", FIELD_REAL, .unit = "J/m2", RANGE(0.0, 1e3), .fallback = NAN, AT_COHESION(at, surface_energy), \
      .meaning = "of jkr: the work that parts an area of the two surfaces, w; the pull-off is 3/2 pi w R*" }, \
    { group, "liquid_volume", FIELD_REAL, .unit = "m3", OPEN_RANGE(0.0, 1e-3), .fallback = NAN, AT_COHESION(at, liquid_volume), \
      .meaning = "of liquid-bridge: volume of each bridge" }, \
    { group, "surface_tension", FIELD_REAL, .unit = "N/m", RANGE(0.0, 10.0), .fallback = NAN, AT_COHESION(at, surface_tension), \
      .meaning = "of liquid-bridge" }, \
    { group, "contact_angle_deg", FIELD_REAL, .unit = "degrees", RANGE(0.0, 89.0), .fallback = NAN, \
      AT_COHESION(at, contact_angle_deg), .meaning = "of liquid-bridge: between liquid and solid. Default: 0" }

#define FIELDS_OF_COHESIONS \
    { SPEC_CONTACT, "cohesion", FIELD_OBJECT_OR_NULL, SPEC_CONTACT_COHESION, .is_left_out_where_null = true, AT(cohesion.law), \
      COLUMN("bond_number", REAL, bond_number), .column_may_miss = true, IN_VIEW(285), .unit = "", \
      .meaning = "what pulls particles together; null: nothing. The column has the Bond number: the largest pull-off between " \
                 "particles over the weight of the mean one" }, \
    FIELDS_OF_COHESION(SPEC_CONTACT_COHESION, offsetof(scene_inputs, cohesion)), \
    { SPEC_WALL, "cohesion", FIELD_OBJECT_OR_NULL, SPEC_WALL_COHESION, .is_left_out_where_null = true, AT(wall_cohesion.law), \
      FREE_OF_BED, .meaning = "what pulls particles to all that is the container's; null: nothing" }, \
    FIELDS_OF_COHESION(SPEC_WALL_COHESION, offsetof(scene_inputs, wall_cohesion)), \
    { SPEC_PAIRS, "cohesion", FIELD_OBJECT_OR_NULL, SPEC_PAIR_COHESION, .is_left_out_where_null = true, AT_PAIR(cohesion.law), \
      .meaning = "what pulls the two together; null: as without the pair" }, \
    FIELDS_OF_COHESION(SPEC_PAIR_COHESION, offsetof(pair_inputs, cohesion))

#define FIELDS_OF_OUTPUT_AND_RUN \
    { SPEC_INPUTS, "snapshots", FIELD_OBJECT, SPEC_SNAPSHOTS, ACTS_LATER, .meaning = "files of all particles, for ParaView" }, \
    { SPEC_SNAPSHOTS, "interval", FIELD_REAL, .unit = "s", RANGE(0.0, 1e6), .fallback = 0.1, AT(snapshot_interval), \
      .meaning = "simulated time between snapshots; 0: only the last one" }, \
    { SPEC_INPUTS, "samples", FIELD_OBJECT, SPEC_SAMPLES, ACTS_LATER, .meaning = "the time series of measurements" }, \
    { SPEC_SAMPLES, "interval", FIELD_REAL, .unit = "s", OPEN_RANGE(0.0, 0.05), .fallback = NAN, AT(sample_interval), \
      .meaning = "simulated time between measurements. Default: 0.05 s, less for fast drums and short runs" }, \
    { SPEC_INPUTS, "tracers", FIELD_NUMBERS, .unit = "", RANGE(0, SCENE_MOST_PARTICLES - 1), .least_entries = 1, \
      .most_entries = MOST_TRACERS, .fallback = NAN, AT(tracer), .count_offset = offsetof(scene_inputs, tracer_count), ACTS_LATER, \
      COLUMN("tracers", COUNT, inputs.tracer_count), .column_may_miss = true, LISTED, \
      .meaning = "particles, counted from 0 in the order of the species, whose paths are written: place, velocity and angular " \
                 "velocity with each sample, in tracers.csv and tracers.hdf. The column has their number" }, \
 \
    { SPEC_INPUTS, "seed", FIELD_INTEGER, .unit = "", RANGE(0, (double)LARGEST_WHOLE_NUMBER), .fallback = NAN, AT(seed), \
      COLUMN("seed", WHOLE, inputs.seed), LISTED, IN_VIEW(320), \
      .meaning = "of the random initial positions: the same seed gives the same run. Default: chosen at random" }, \
    { SPEC_INPUTS, "threads", FIELD_INTEGER, .unit = "", RANGE(1, 256), .fallback = 1, AT(threads), ACTS_LATER, \
      .meaning = "threads of the worker; results do not depend on it" }, \
    { SPEC_INPUTS, "integration", FIELD_OBJECT, SPEC_INTEGRATION, \
      COLUMN("time_step", REAL, scene.time_step), IN_VIEW(300), .unit = "s", \
      .meaning = "how motion is stepped through time" }, \
    { SPEC_INTEGRATION, "corrector_passes", FIELD_INTEGER, .unit = "", RANGE(1, 10), .fallback = 1, AT(corrector_passes), \
      .meaning = "corrector passes of Euler's equations for the spin of clusters (Eqns 9-10); more do not raise the order" }, \
    { SPEC_INPUTS, "precision", FIELD_CHOICE, .unit = "", .choices = precision_choices, AT(precision), \
      COLUMN("precision", WORD, inputs.precision), IN_VIEW(305), \
      .meaning = "of contacts; positions, velocities and their integration are double always. single is as good for every " \
                 "angle, and faster" }

/* Of processes that stand still: fill, heap, orifice. whole, all, one: how the wall is told of. */
#define FIELD_OF_COUNT \
    { SPEC_INPUTS, "particle_count", FIELD_INTEGER, .unit = "", RANGE(8, 5000000), .fallback = NAN, .excludes_too = "fill_height", \
      AT(particle_count), COLUMN("particles", COUNT, scene.particle_count), LISTED, IN_LIST(110, "", 1, NULL), IN_FORM(50, NULL), \
      .meaning = "number of particles, instead of fill_height" }

#define FIELDS_OF_STANDING_WALL(whole, all, one) \
    { SPEC_INPUTS, "wall", FIELD_OBJECT, SPEC_WALL, .meaning = whole }, \
    { SPEC_WALL, "material", FIELD_TEXT, .unit = "", RANGE(1, NAME_MOST), AT(wall_material), \
      .meaning = "name of the material of " all ", a member of materials: its pairs with others hold there" }, \
    { SPEC_WALL, "friction", FIELD_REAL, .unit = "", RANGE(0.0, 5.0), .fallback = 0.5, AT(wall_friction), USUAL(0.0, 1.5), \
      COLUMN("wall_friction", REAL, scene.contact.wall_friction), LISTED, IN_VIEW(240), \
      .meaning = "coefficient of friction between a particle and " one }, \
    { SPEC_WALL, "rolling_friction", FIELD_REAL, .unit = "", RANGE(0.0, 1.0), .fallback = 0.0, AT(wall_rolling_friction), \
      COLUMN("wall_rolling_friction", REAL, scene.contact.wall_rolling_friction), IN_VIEW(260), \
      .meaning = "coefficient of rolling friction between a particle and " one ". Default: none" }

#define FIELDS_OF_STANDING_RUN \
    FIELDS_OF_MATERIALS, FIELDS_OF_COHESIONS, FIELDS_OF_OUTPUT_AND_RUN, \
    { SPEC_INPUTS, "gravity", FIELD_REAL, .unit = "m/s2", RANGE(0.01, 1000.0), .fallback = 9.81, AT(gravity), USUAL(1.0, 30.0), \
      SLIP("cm/s2", 0.01), COLUMN("gravity", REAL, scene.gravity), IN_VIEW(160), \
      .meaning = "acceleration of gravity, down the axis" }
/* clang-format on */

#endif
