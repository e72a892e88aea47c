/* The inputs of `drum`. Ranges are wider than what makes sense together; drum_rules.c looks at combinations. */
#include <math.h>

#include "drum_process.h"

static const char *const ends_choices[] = { "periodic", NULL };
static const char *const shape_choices[] = { "sphere", "dumbbell", "tetrahedron", "cube", NULL }; /* as dem_shape counts them */
/* in the order of dem_contact_law */
static const char *const law_choices[] = { "walton-braun", "spring-dashpot", "hertz-mindlin", NULL };

#define AT(member) .offset = offsetof(drum_inputs, member)
#define AT_SPECIES(member) .offset = offsetof(species_inputs, member)
#define AT_SPHERE(member) .offset = offsetof(dem_cluster_sphere, member)
#define RANGE(low, high) .minimum = (low), .maximum = (high)
#define OPEN_RANGE(low, high) .minimum = (low), .minimum_open = true, .maximum = (high)

static const spec_field fields[] = {
    { SPEC_INPUTS, "drum", FIELD_OBJECT, SPEC_DRUM, .required = true, .meaning = "the rotating drum" },
    { SPEC_DRUM, "diameter", FIELD_REAL, .required = true, .unit = "m", RANGE(0.001, 20.0), .fallback = NAN, AT(drum_diameter),
      .meaning = "inner diameter" },
    { SPEC_DRUM, "length", FIELD_REAL, .required = true, .unit = "m", RANGE(0.0001, 20.0), .fallback = NAN, AT(drum_length),
      .meaning = "length along the axis; at least 3 of the largest particle diameters" },
    { SPEC_DRUM, "ends", FIELD_CHOICE, .unit = "", .choices = ends_choices, AT(drum_ends),
      .meaning = "periodic: what leaves at one end enters at the other, as in a slice of a long drum" },
    { SPEC_DRUM, "rotation_rate", FIELD_REAL, .required = true, .unit = "rad/s", RANGE(0.001, 500.0), .fallback = NAN,
      AT(rotation_rate), .meaning = "rate of rotation" },

    { SPEC_INPUTS, "particles", FIELD_LIST, SPEC_PARTICLES, .required = true, RANGE(1, DEM_MAXIMUM_SPECIES), AT(species),
      .count_offset = offsetof(drum_inputs, species_count), .entry_size = sizeof(species_inputs),
      .meaning = "the kinds of particles" },
    { SPEC_PARTICLES, "shape", FIELD_CHOICE_OR_OBJECT, SPEC_SHAPE, .unit = "", .choices = shape_choices, AT_SPECIES(shape),
      .meaning = "shape of a particle: a sphere, or a rigid cluster of 2, 4 or 8 touching spheres, or of spheres placed one "
                 "by one, which must touch or overlap" },
    { SPEC_SHAPE, "spheres", FIELD_LIST, SPEC_SPHERES, .required = true, RANGE(1, DEM_MAXIMUM_CLUSTER), AT_SPECIES(sphere),
      .count_offset = offsetof(species_inputs, sphere_count), .entry_size = sizeof(dem_cluster_sphere),
      .meaning = "the spheres of a cluster" },
    { SPEC_SPHERES, "position", FIELD_PLACE, .required = true, .unit = "m", RANGE(-1.0, 1.0), .fallback = NAN, AT_SPHERE(position),
      .meaning = "centre of the sphere, in any frame of the cluster's own" },
    { SPEC_SPHERES, "diameter", FIELD_REAL, .unit = "m", RANGE(1e-5, 1.0), .fallback = NAN, AT_SPHERE(diameter),
      .meaning = "diameter of this sphere. Default: the particle's diameter" },
    { SPEC_PARTICLES, "diameter", FIELD_REAL, .required = true, .spared_by = "shape", .unit = "m", RANGE(1e-5, 1.0),
      .fallback = NAN, AT_SPECIES(diameter),
      .meaning = "diameter of the sphere, or of each sphere of a cluster; to be left out only where every sphere of a "
                 "cluster has its own" },
    { SPEC_PARTICLES, "density", FIELD_REAL, .unit = "kg/m3", RANGE(1.0, 30000.0), .fallback = 2500.0, AT_SPECIES(density),
      .meaning = "density of the particle itself, not of the bed" },
    { SPEC_PARTICLES, "share", FIELD_REAL, .unit = "", OPEN_RANGE(0.0, 1.0), .fallback = NAN, AT_SPECIES(share),
      .meaning = "share of the particles by number; all shares sum to 1. Default: equal shares" },

    { SPEC_INPUTS, "fill_fraction", FIELD_REAL, .unit = "", OPEN_RANGE(0.0, 0.95), .fallback = 0.5, .excludes = "particle_count",
      AT(fill_fraction), .meaning = "share of the cross-section below the free surface, at a bed solid fraction of 0.6" },
    { SPEC_INPUTS, "particle_count", FIELD_INTEGER, .unit = "", RANGE(8, 5000000), .fallback = NAN, .excludes = "fill_fraction",
      AT(particle_count), .meaning = "number of particles, instead of fill_fraction" },

    { SPEC_INPUTS, "contact", FIELD_OBJECT, SPEC_CONTACT, .meaning = "contact between particles" },
    { SPEC_CONTACT, "law", FIELD_CHOICE, .unit = "", .choices = law_choices, AT(contact_law),
      .meaning = "walton-braun: latching spring and incremental friction; spring-dashpot: linear springs and dashpots; "
                 "hertz-mindlin: elastic, no-slip, damping set from restitution" },
    { SPEC_CONTACT, "friction", FIELD_REAL, .unit = "", RANGE(0.0, 5.0), .fallback = 0.3, AT(friction),
      .meaning = "coefficient of friction between particles" },
    { SPEC_CONTACT, "restitution", FIELD_REAL, .unit = "", RANGE(0.3, 1.0), .fallback = 0.8, AT(restitution),
      .meaning = "coefficient of normal restitution" },
    { SPEC_CONTACT, "tangential_stiffness_ratio", FIELD_REAL, .unit = "", RANGE(0.05, 1.5), .fallback = 0.8,
      AT(tangential_stiffness_ratio), .meaning = "initial tangential over normal loading stiffness" },
    { SPEC_CONTACT, "maximum_overlap", FIELD_REAL, .unit = "", RANGE(0.0005, 0.05), .fallback = 0.01, .excludes = "stiffness",
      .excludes_too = "youngs_modulus", AT(maximum_overlap),
      .meaning = "largest overlap wanted, as a share of the smallest diameter: the stiffness is chosen for it" },
    { SPEC_CONTACT, "stiffness", FIELD_REAL, .unit = "N/m", RANGE(1e-3, 1e9), .fallback = NAN, .excludes = "maximum_overlap",
      .excludes_too = "youngs_modulus", AT(stiffness),
      .meaning = "normal loading stiffness, instead of maximum_overlap; not for hertz-mindlin" },
    { SPEC_CONTACT, "youngs_modulus", FIELD_REAL, .unit = "Pa", RANGE(1e3, 1e13), .fallback = NAN, .excludes = "maximum_overlap",
      AT(youngs_modulus), .meaning = "of particles and wall, instead of maximum_overlap; for hertz-mindlin alone" },
    { SPEC_CONTACT, "poissons_ratio", FIELD_REAL, .unit = "", RANGE(0.0, 0.5), .fallback = 0.3, AT(poissons_ratio),
      .meaning = "of particles and wall; used by hertz-mindlin alone" },

    { SPEC_INPUTS, "wall", FIELD_OBJECT, SPEC_WALL, .meaning = "inner wall of the drum" },
    { SPEC_WALL, "friction", FIELD_REAL, .unit = "", RANGE(0.0, 5.0), .fallback = 0.5, AT(wall_friction),
      .meaning = "coefficient of friction between a particle and the wall or its lining" },
    { SPEC_WALL, "lining", FIELD_OBJECT_OR_NULL, SPEC_LINING, AT(lining_diameter),
      .meaning = "spheres glued to the wall, turning with it; null: a smooth wall" },
    { SPEC_LINING, "diameter", FIELD_REAL, .required = true, .unit = "m", RANGE(1e-5, 1.0), .fallback = NAN, AT(lining_diameter),
      .meaning = "diameter of the glued spheres; at most 1/8 of the drum's" },
    { SPEC_LINING, "pitch", FIELD_REAL, .unit = "m", RANGE(1e-5, 1.0), .fallback = NAN, AT(lining_pitch),
      .meaning = "distance between their centres, around the wall and along the axis. Default: their diameter" },

    { SPEC_INPUTS, "duration", FIELD_OBJECT, SPEC_DURATION, .meaning = "how long the drum turns" },
    { SPEC_DURATION, "revolutions", FIELD_REAL, .unit = "revolutions", OPEN_RANGE(0.0, 1e5), .fallback = 1.25,
      .excludes = "seconds", .excludes_too = "until_standard_error_deg", AT(revolutions), .meaning = "revolutions of the drum" },
    { SPEC_DURATION, "seconds", FIELD_REAL, .unit = "s", OPEN_RANGE(0.0, 1e6), .fallback = NAN, .excludes = "revolutions",
      .excludes_too = "until_standard_error_deg", AT(seconds),
      .meaning = "time from the start of rotation, instead of revolutions" },
    { SPEC_DURATION, "until_standard_error_deg", FIELD_REAL, .unit = "degrees", RANGE(0.01, 10.0), .fallback = NAN,
      .excludes = "revolutions", AT(until_standard_error),
      .meaning = "ask for the answer: until the angle is steady and "
                 "known this well, instead of revolutions" },
    { SPEC_DURATION, "at_most_revolutions", FIELD_REAL, .unit = "revolutions", OPEN_RANGE(0.0, 1e5), .fallback = NAN,
      AT(at_most_revolutions), .meaning = "where until_standard_error_deg gives up. Default: 10" },

    { SPEC_INPUTS, "snapshots", FIELD_OBJECT, SPEC_SNAPSHOTS, .meaning = "files of all particles, for ParaView" },
    { SPEC_SNAPSHOTS, "interval", FIELD_REAL, .unit = "s", RANGE(0.0, 1e6), .fallback = 0.1, AT(snapshot_interval),
      .meaning = "simulated time between snapshots; 0: only the last one" },
    { SPEC_INPUTS, "samples", FIELD_OBJECT, SPEC_SAMPLES, .meaning = "the time series of measurements" },
    { SPEC_SAMPLES, "interval", FIELD_REAL, .unit = "s", OPEN_RANGE(0.0, 0.05), .fallback = NAN, AT(sample_interval),
      .meaning = "simulated time between measurements. Default: 0.05 s, less for fast drums and short runs" },

    { SPEC_INPUTS, "seed", FIELD_INTEGER, .unit = "", RANGE(0, 9007199254740991.0), .fallback = NAN, AT(seed),
      .meaning = "of the random initial positions: the same seed gives the same run. Default: chosen at random" },
    { SPEC_INPUTS, "threads", FIELD_INTEGER, .unit = "", RANGE(1, 256), .fallback = 1, AT(threads),
      .meaning = "threads of the worker; results do not depend on it" },
    { SPEC_INPUTS, "gravity", FIELD_REAL, .unit = "m/s2", RANGE(0.01, 1000.0), .fallback = 9.81, AT(gravity),
      .meaning = "acceleration of gravity, across the axis" },
};
const spec_table drum_fields = { fields, sizeof fields / sizeof fields[0] };
