/* Plain structs of the granular core: what a scene is made of, and what is measured in it.
 *
 * SI throughout (m, s, kg, N, rad); fields that end in _deg are degrees, because the measures are asked for
 * in degrees. A container's axis is z. The drum lies: gravity points along -y, and a positive rotation rate turns it
 * counter-clockwise in the x-y plane, so that the free surface rises towards +x; z is 0 at half its length. The other
 * containers stand: gravity points along -z, and the floor or plate is at z = 0. */
#ifndef DEM_TYPES_H
#define DEM_TYPES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { DEM_MAXIMUM_SPECIES = 16, DEM_MAXIMUM_CLUSTER = 64, DEM_MAXIMUM_SIEVES = 64 };

typedef enum dem_status {
    DEM_OK = 0,
    DEM_NO_MEMORY,
    DEM_BAD_PARAMETER,     /* a definition breaks a rule that include/dem_rules.h states */
    DEM_DOES_NOT_FIT,      /* the particles asked for can't be placed in the container */
    DEM_NOT_A_NUMBER,      /* a position or velocity is no longer finite */
    DEM_OVERLAP_TOO_LARGE, /* an overlap beyond half of the smaller radius */
    DEM_PARTICLE_ESCAPED,  /* a particle's centre is outside the container */
    DEM_NEVER_SETTLED,     /* the bed did not come to rest before rotation */
    DEM_TOO_FEW_FRAMES,    /* not enough frames for the measure asked for */
    DEM_STATE_MISMATCH     /* a saved state does not belong to this definition */
} dem_status;

typedef struct dem_cluster_sphere {
    double position[3]; /* m, of the centre, in a frame of the cluster's own */
    double diameter;    /* m */
} dem_cluster_sphere;

/* Spheres joined for good: a rigid body of the shape, volume and inertia of their union. */
typedef struct dem_cluster {
    size_t sphere_count; /* 0: no cluster, but a sphere of the species' diameter */
    dem_cluster_sphere sphere[DEM_MAXIMUM_CLUSTER];
    /* What follows from the spheres: filled in by dem_cluster_complete (dem_cluster.h), which also moves the frame to
     * the centre of mass and turns it to the principal axes. volume 0: not yet done; a scene does it for itself. */
    double volume;     /* m3 */
    double inertia[3]; /* m5: principal moments at a density of 1 */
    double reach;      /* m: radius of the sphere about the centre of mass that holds the cluster */
} dem_cluster;

/* How the sizes of a species' spheres are distributed: equations in core/NUMERICS.md, "Sizes". */
typedef enum dem_size_law {
    DEM_ONE_SIZE,
    DEM_LOGNORMAL,     /* center: median; width: geometric standard deviation */
    DEM_NORMAL,        /* center: mean; width: standard deviation */
    DEM_ROSIN_RAMMLER, /* center: the size that 1 - 1/e is below; width: the exponent */
    DEM_UNIFORM,       /* from minimum to maximum */
    DEM_SIEVES         /* straight lines between the shares below each sieve */
} dem_size_law;

/* All 0: every particle is alike. */
typedef struct dem_sizes {
    dem_size_law law;
    bool by_volume;          /* what the law is the distribution of: volume, and so mass; else number */
    double center, width;    /* m, of the width of a normal one, too; else a pure number */
    double minimum, maximum; /* m: it is cut there */
    size_t sieve_count;
    double sieve[DEM_MAXIMUM_SIEVES], below[DEM_MAXIMUM_SIEVES]; /* m, ascending; the share that is smaller */
} dem_sizes;

typedef struct dem_species {
    double diameter; /* m; of a cluster: of its largest sphere, for whoever wants one number; the core has no use for it. With
                        sizes: of the sphere of mean volume (dem_sizes_complete) */
    double density;  /* kg/m3 */
    double share;    /* of the particles by number; shares of all species sum to 1 */
    dem_cluster cluster;
    dem_sizes sizes; /* of spheres alone */
} dem_species;

/* Equations and sources of each: core/NUMERICS.md. */
typedef enum dem_contact_law {
    DEM_WALTON_BRAUN,   /* latching normal spring and incremental friction (Walton & Braun 1993) */
    DEM_SPRING_DASHPOT, /* linear springs and dashpots, the tangential cut at mu N (the paper's footnote) */
    DEM_HERTZ_MINDLIN   /* Hertz, Mindlin's no-slip stiffness, damping set from restitution (Tsuji et al. 1992) */
} dem_contact_law;

/* What pulls spheres together: equations and sources in core/NUMERICS.md, "Cohesion". */
typedef enum dem_cohesion_law {
    DEM_NO_COHESION,
    DEM_CONSTANT_PULL, /* the same while they touch */
    DEM_SJKR,          /* an energy density times the area in which the spheres cut each other */
    DEM_SJKR2,         /* the same times 4 pi R* alpha */
    DEM_JKR,           /* Johnson, Kendall & Roberts (1971), in the place of Hertz: of Hertz-Mindlin alone */
    DEM_LIQUID_BRIDGE  /* forms at a touch, breaks at a gap */
} dem_cohesion_law;

/* Of one pair of materials; all 0: none. */
typedef struct dem_cohesion {
    double strength; /* constant: N; sjkr: J/m3; jkr: J/m2, work of adhesion of the two surfaces; bridge: N/m, surface tension */
    double liquid_volume; /* m3, of one bridge */
    double contact_angle; /* rad, of the bridge, below pi/2 */
} dem_cohesion;

/* How contacts resist rolling: equations and sources in core/NUMERICS.md, "Rolling friction". */
typedef enum dem_rolling_law {
    DEM_EPSD,           /* a spring that yields */
    DEM_EPSD_DAMPED,    /* with a dashpot until it yields */
    DEM_CONSTANT_TORQUE /* the limit, against the relative spin */
} dem_rolling_law;

typedef struct dem_elasticity {
    double youngs_modulus; /* Pa; infinite: rigid */
    double poissons_ratio;
} dem_elasticity;

typedef struct dem_contact_parameters {
    dem_contact_law law;
    double stiffness;              /* K1, N/m, loading branch (Walton-Braun, spring-dashpot) */
    dem_elasticity particle, wall; /* Hertz-Mindlin; a lining is of the wall's material */
    double restitution;            /* e = sqrt(K1/K2) */
    double unloading_slope;        /* S, 1/m, Walton-Braun: K2 = K1 + S N_max; 0: K2 = K1/e^2, the same for all loads */
    double latch_damping;          /* zeta, Walton-Braun: share of critical damping of K2 while an overlap below the latch grows */
    double friction;               /* mu between particles */
    double wall_friction;          /* mu_w, particle against the cylinder (drum, tube) or its lining */
    double tangential_stiffness_ratio;    /* K_T0/K1 */
    double rolling_friction;              /* mu_r between particles: a contact bears a moment of mu_r R* N; 0: none */
    double wall_rolling_friction;         /* likewise, particle against all that is the container's but ends, floor and plate */
    dem_rolling_law rolling_law;          /* of all contacts that resist rolling */
    double rolling_damping;               /* share of critical damping, of DEM_EPSD_DAMPED */
    dem_cohesion_law cohesion_law;        /* of all contacts that cohere */
    dem_cohesion cohesion, wall_cohesion; /* between particles; with all that is the container's */
} dem_contact_parameters;

/* What a container shows to particles, as far as each may be of another material. */
typedef enum dem_surface {
    DEM_WALL,    /* the cylinder of a drum or of a standing cylinder; the tube; the sides of a vessel */
    DEM_ENDS,    /* of a drum; a cylinder's floor; a vessel's floor or hopper */
    DEM_LIFTERS, /* their bars */
    DEM_LINING,  /* its spheres */
    DEM_PLATE,   /* with its rim */
    DEM_SURFACES
} dem_surface;

/* A contact of two materials: what dem_contact_parameters have of all contacts. */
typedef struct dem_pair {
    double friction, rolling_friction, restitution;
    double stiffness, unloading_slope; /* N/m, 1/m: as there; the slope is more than 0 for all pairs or for none */
    dem_elasticity elasticity[2];      /* Hertz-Mindlin */
    dem_cohesion cohesion;
} dem_pair;

/* Spheres glued to the inner wall, turning with it. diameter 0: no lining, a smooth wall. */
typedef struct dem_lining {
    double diameter; /* m */
    double pitch;    /* m between neighboring centres, around the wall and along the axis */
} dem_lining;

typedef enum dem_container_kind {
    DEM_DRUM,          /* lies, and turns about its axis */
    DEM_CYLINDER,      /* stands on its floor, open at the top */
    DEM_TUBE_ON_PLATE, /* stands on a plate, open at both ends, and is raised; its wall is thin */
    DEM_VESSEL         /* stands, open at the top, over an orifice that opens when the bed is at rest */
} dem_container_kind;

/* What closes a drum, and turns with it; the floor of a cylinder has its frictions. */
typedef struct dem_drum_ends {
    bool are_walls; /* else the axis is periodic */
    double friction, rolling_friction;
} dem_drum_ends;

/* Straight bars of rectangular section along the whole drum, evenly spaced about it, turning with it. */
typedef struct dem_lifters {
    size_t count;  /* 0: none */
    double height; /* m, from the wall towards the axis */
    double width;  /* m, across */
    double friction;
    double angle; /* rad, from the radius at the bar's foot; more than 0: its top leans the way that a positive rate turns */
} dem_lifters;

/* A stage of a drum's rotation. */
typedef struct dem_rotation_stage {
    double rate;    /* rad/s; 0: the drum stands still */
    double seconds; /* of the last one: until the run ends */
} dem_rotation_stage;

/* How the tube is raised, from when the bed in it is at rest (DEM_PHASE_RUNNING) on. */
typedef struct dem_lift {
    double speed; /* m/s */
    double start; /* s after the bed came to rest */
} dem_lift;

/* A level disc, whose middle is on the axis. What falls off it is lost: it takes no further part. */
typedef struct dem_plate {
    double diameter;   /* m */
    double rim_height; /* m; 0: no rim */
    double friction, rolling_friction;
} dem_plate;

/* Where particles leave a vessel: a round hole about its axis, or a slot across a flat one. What is through it is out of the test. */
typedef struct dem_orifice {
    double opening;    /* m: diameter of the hole, or width of the slot along x */
    double depth;      /* m: of a flat vessel along y, and so the slot's length; 0: vessel and hole are round */
    double half_angle; /* rad between a hopper's wall and the vertical; 0: no hopper but a flat floor */
} dem_orifice;

/* Particles that enter a standing cylinder one after the other: dem_stream.h. */
typedef struct dem_stream {
    double rate;         /* 1/s; 0: no stream, the bed makes itself */
    double diameter;     /* m, of the inlet, in the cylinder's middle */
    double impact_speed; /* m/s, at the level of the bed */
} dem_stream;

enum { DEM_MAXIMUM_LIFTERS = 64, DEM_MAXIMUM_STAGES = 64 };

typedef struct dem_scene_definition {
    dem_container_kind container;
    double diameter; /* m, inner diameter of the smooth wall; of a flat vessel its width along x */
    /* m along the axis: of a periodic drum the period, 3 of the largest spheres at least; the height of what stands, from the plate, the
     * floor or the orifice */
    double length;
    dem_drum_ends ends; /* of the drum alone, as are lifters and lining */
    dem_lifters lifters;
    dem_lift lift;        /* of the tube alone */
    dem_plate plate;      /* of the tube alone; the floor of a cylinder or vessel has ends.friction, as the hopper has */
    dem_stream stream;    /* of the cylinder alone */
    dem_orifice orifice;  /* of the vessel alone */
    double rotation_rate; /* rad/s; the drum's, where it has no stages */
    size_t stage_count;   /* of the drum's rotation, one after the other; 0: it turns at one rate */
    dem_rotation_stage stage[DEM_MAXIMUM_STAGES];
    double gravity;       /* m/s2 */
    double tilt;          /* rad, of a drum's axis from the horizontal, its end at -z being the lower one; 0 without end walls */
    double fill_fraction; /* share of the cross-section below the free surface at a bed solid fraction of 0.6 */
    size_t particle_count;
    size_t species_count;
    dem_species species[DEM_MAXIMUM_SPECIES];
    dem_contact_parameters contact;
    /* Each species with each, both ways round, and behind these with each surface, in the place of what contact, ends, lifters and
     * plate say; without has_pairs nobody looks at it. */
    bool has_pairs;
    dem_pair pair[DEM_MAXIMUM_SPECIES][DEM_MAXIMUM_SPECIES + DEM_SURFACES];
    dem_lining lining;
    bool is_placed;       /* nothing is placed at random: particles come by dem_scene_place or dem_scene_continue */
    double time_step;     /* s */
    int corrector_passes; /* of Euler's equations for clusters, Eqns 9-10; 0: one */
    uint64_t seed;
    int threads;
} dem_scene_definition;

typedef enum dem_phase {
    DEM_PHASE_GROWING,  /* spheres placed at random grow to full size, without gravity */
    DEM_PHASE_SETTLING, /* the bed falls and comes to rest in the standing drum */
    DEM_PHASE_RUNNING /* the drum turns; the tube is raised; the orifice is open; the stream fills the cylinder, from the first step on */
} dem_phase;

/* The parts of a step, for whoever wants to know what they cost. */
typedef enum dem_step_part {
    DEM_PART_OUTER_LIST, /* steps in which the list of pairs within the skin was made again */
    DEM_PART_INNER_LIST, /* choosing from it the pairs that can touch, and looking whether that is due */
    DEM_PART_PAIRS,      /* contacts between spheres */
    DEM_PART_WALLS,      /* contacts with the container */
    DEM_PART_MOTION,     /* of each sphere the sum over its contacts, velocity and place */
    DEM_PART_CONTAINER,  /* its motion, the next phase, looks at torque and energy */
    DEM_STEP_PARTS
} dem_step_part;

/* Filled while a scene advances; the caller's, who begins with zeros and a clock. */
typedef struct dem_step_profile {
    double (*clock)(void);          /* s, from any origin; read by the thread that advances */
    double seconds[DEM_STEP_PARTS]; /* spent in each part */
    double lap_begin;               /* s, the core's own */
} dem_step_profile;

/* Where and why a run went wrong; filled when dem_scene_advance does not return DEM_OK. */
typedef struct dem_failure {
    dem_status status;
    int64_t step;
    double time;          /* s since rotation began; negative before */
    int64_t particle;     /* id, -1: none in particular */
    int64_t other;        /* id of the other particle, -1: the wall or none */
    double position[3];   /* m, of the sphere in question */
    double value, limit;  /* what was seen and what is allowed, in the unit below */
    const char *quantity; /* "overlap", "distance from the axis", "velocity", ... */
    const char *unit;
    const char *likely_cause;
} dem_failure;

/* The state of all n spheres, for snapshots: spheres that are particles by themselves, then those of clusters, cluster
 * after cluster. Arrays belong to the caller. */
typedef struct dem_particle_arrays {
    double *position;         /* (n,3) m; z within [-length/2, length/2) in a drum */
    double *velocity;         /* (n,3) m/s, half a step before the positions */
    double *angular_velocity; /* (n,3) rad/s, likewise */
    double *radius;           /* (n) m */
    int32_t *species;         /* (n) index into the definition's species */
    int32_t *contacts;        /* (n) contacts of this sphere with other particles, lining and wall */
    int32_t *cluster;         /* (n) id of the particle that the sphere is, or is a part of */
    double *orientation;      /* (n,4) w, x, y, z: turns the particle's own frame into the drum's; 1, 0, 0, 0 for a sphere
                                 by itself, whose orientation nothing depends on */
} dem_particle_arrays;

/* A particle put into a scene by its maker. */
typedef struct dem_placed_particle {
    double position[3];         /* m, of the centre of mass */
    double velocity[3];         /* m/s */
    double angular_velocity[3]; /* rad/s, along the drum's axes */
    double orientation[4];      /* w, x, y, z as in dem_particle_arrays, of any length but 0; a sphere by itself needs none */
    int32_t species;
    double diameter; /* m, where the species has sizes; 0: as drawn */
} dem_placed_particle;

/* Fields over the cross-section, in the laboratory frame; n = cells x cells, x fastest, from the lowest x and y up. Arrays
 * belong to the caller. NaN where a cell has seen too little to tell. */
typedef struct dem_field_arrays {
    double *solid_fraction; /* (n) */
    double *velocity;       /* (n,3) m/s, mean over the volume of what passed */
    double *temperature;    /* (n) m2/s2, a third of the mean square of velocities about the mean field */
    double *samples;        /* (n) independent particles that the means rest on */
} dem_field_arrays;

/* Everything a scene needs to go on bit for bit: saved by dem_scene_save, owned by the caller.
 * `table` names each array so that a file can hold them without knowing what they mean. */
typedef enum dem_element { DEM_FLOAT64, DEM_INT64, DEM_INT32 } dem_element;

typedef struct dem_state_array {
    const char *name;
    dem_element element;
    size_t rows, columns;
    void *data; /* rows x columns, row after row */
} dem_state_array;

enum { DEM_STATE_ARRAYS = 20 };

typedef struct dem_state {
    size_t array_count;
    dem_state_array array[DEM_STATE_ARRAYS];
} dem_state;

typedef enum dem_regime {
    DEM_SLIPPING,
    DEM_SLUMPING,
    DEM_AVALANCHING,
    DEM_ROLLING,
    DEM_CASCADING,
    DEM_CATARACTING,
    DEM_RAINING,
    DEM_SLIDING,
    DEM_CENTRIFUGING
} dem_regime;

/* An angle with the uncertainty of its mean over the measuring window. NaN where it could not be measured. */
typedef struct dem_angle {
    double mean_deg, standard_error_deg, minimum_deg, maximum_deg;
} dem_angle;

typedef struct dem_mean {
    double mean, standard_error; /* NaN: too few to tell */
} dem_mean;

/* Slumps or avalanches: the bed is lifted until it gives way, and comes to rest at a lower angle. */
typedef struct dem_slumps {
    double count;                           /* those seen from their beginning to their end */
    dem_mean period;                        /* s, from one beginning to the next */
    dem_mean start_deg, stop_deg, size_deg; /* direction of the centre of mass before and after; the difference */
    double hysteresis_deg;                  /* largest less smallest of the angles that they start and stop at */
    double first_start;                     /* s, of the first fall after a rise, be its end seen or not */
    double first_end;                       /* s, of the first fall seen to its end */
} dem_slumps;

typedef enum dem_angle_method {
    DEM_SURFACE_FIT,    /* line through the half-density heights over the middle 60 % of the chord */
    DEM_CENTER_OF_MASS, /* direction of the centre of mass from straight down */
    DEM_CHORD,          /* slope of the time-averaged interface between +-D/10 (GranuDrum) */
    DEM_THEIL_SEN,      /* Theil-Sen line through the tops of columns one diameter wide */
    DEM_UPPER_CHORD,    /* upper half of the chord alone */
    DEM_LOWER_CHORD,    /* lower half of the chord alone */
    DEM_ANGLE_METHODS
} dem_angle_method;

/* What the window lets be said of the angle. The least windows are in dem_rules.h, "What a run can tell". */
typedef enum dem_verdict {
    DEM_NO_VERDICT, /* the bed has no surface: it lies all around the wall */
    DEM_STEADY,
    DEM_DRIFTING,  /* or it moves by falls */
    DEM_TOO_SHORT, /* for either to be known */
    DEM_TOO_FEW    /* particles, or layers of them */
} dem_verdict;

/* The straight line through the angle over the window; NaN: no angle, or too short to tell. */
typedef struct dem_trend {
    double change_deg, error_deg; /* over the window, and its standard error */
    double deviation_deg;         /* about the line */
    double times;                 /* correlation times of what is left without it */
} dem_trend;

typedef struct dem_repose_result {
    dem_angle angle[DEM_ANGLE_METHODS];
    dem_verdict verdict;
    bool steady;         /* the verdict is DEM_STEADY */
    bool is_long_enough; /* the window, for any other verdict than too short */
    dem_trend trend;
    double drift_deg_per_revolution;
    double drift_bound_deg_per_revolution; /* what its size stays below in 97 of 100 cases; NaN: too short to tell */
    double window_revolutions;             /* that the drum turned in the window */
    double correlation_times;              /* that the window is long */
    double layers;                         /* depth of the bed at mid-chord, in mean diameters */
    double interface_fluctuation;          /* m: mean over x of the standard deviation in time of the interface height */
    double window_start, window_end;       /* s since rotation began */
    double correlation_time;               /* s, of the surface-fit angle */
    size_t frames;                         /* in the window */
    dem_slumps slumps;                     /* all NaN where the bed neither slumps nor avalanches */
} dem_repose_result;

typedef struct dem_regime_result {
    bool is_told; /* false: there is no bed */
    dem_regime regime;
    bool is_certain; /* told alike from either half of a window that is long enough, of a bed of enough particles */
    double omega2_outer, omega2_inner; /* omega^2 R/g at the wall and at the bed's inner surface */
    /* predicted boundaries of Omega_i^2 for the measured angle of repose */
    double predicted_stationary;   /* Eq 33: 1/sin(phi) */
    double predicted_sliding_eq35; /* Eq 35 */
    double predicted_sliding_eq36; /* Eqns 36-37 */
    /* evidence */
    double wall_slip;             /* 1 - spin of the outermost layer / spin of the drum, mean */
    double wall_slip_fluctuation; /* its standard deviation in time */
    double angle_fluctuation_deg; /* standard deviation in time of the centre of mass's direction */
    double flow_fluctuation;      /* standard deviation over mean of the surface flow */
    double airborne_fraction;     /* share of particles in flight: no contact, 3 d above the surface; mean */
    double wall_coverage;         /* share of the wall's circumference that has particles against it */
    double curvature_deg;         /* upper less lower half of the chord */
    double fallen_fraction;       /* share of particles lately nearer the axis than R_i - 2d */
    double surface_lag;           /* rad a revolution by which the inner surface lags the drum */
} dem_regime_result;

typedef struct dem_segregation_result {
    double radial_index; /* (mean radius of the largest species less that of the smallest) / drum radius; NaN: one species */
    double axial_index;  /* NaN: one species */
    double lacey_index;  /* 0 segregated, 1 randomly mixed; NaN: one species */
} dem_segregation_result;

typedef struct dem_packing_result {
    double solid_fraction;      /* of the bed's core */
    double coordination_number; /* mean contacts a particle */
    double mean_overlap;        /* of contacts between spheres, share of the smallest diameter; mean over the window */
    double overlap_99;          /* what 99 of 100 such contacts stay below */
    double tension_share;       /* of such contacts, that pull; NaN: nothing coheres */
} dem_packing_result;

/* What turns the drum. In a steady state its torque carries the bed's weight, m g x of the centre of mass. */
typedef struct dem_drive_result {
    dem_mean torque;        /* N m about the axis, of the drum on the bed */
    dem_mean weight_torque; /* N m, m g x of the centre of mass */
    double power;           /* W, torque times rotation rate */
    double torque_number;   /* torque over m g R */
} dem_drive_result;

typedef struct dem_drum_results {
    dem_repose_result repose;
    dem_regime_result regime;
    dem_segregation_result segregation;
    dem_packing_result packing;
    dem_drive_result drive;
} dem_drum_results;

#endif
