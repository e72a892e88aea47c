/* A job's specification: the request {"inputs": {...}, "label": {...}} read, checked and filled in.
 *
 * The same code reads a user's request and the canonical spec.json of a job folder: canonical means SI, every
 * default filled in, the seed chosen. Reading a canonical spec and writing it again gives the same bytes. What
 * follows from the inputs (stiffness from maximum_overlap, time step, particle count from fill_fraction) is not
 * written but derived anew by every reader, which gives the same numbers. */
#ifndef JOB_SPEC_H
#define JOB_SPEC_H

#include <jansson.h>
#include <stdbool.h>

#include "calibration.h"
#include "client_watch.h"
#include "dem_granule.h"
#include "dem_types.h"
#include "job_resources.h"
#include "problem.h"
#include "spec_fields.h"

/* Numbers of JSON are doubles to most clients: whole ones up to 2^53 - 1, a seed say, come back as they were. */
#define WHOLE_NUMBER_BITS 53
#define LARGEST_WHOLE_NUMBER ((UINT64_C(1) << WHOLE_NUMBER_BITS) - 1)

/* The inputs as asked for, with defaults. All are doubles so that one table of fields can read, write and
 * describe them; NaN: not given, because its alternative was (or, for the lining, because there is none). */
/* How sizes are distributed; NaN: not given. */
typedef struct size_inputs {
    double type; /* index into the choices, a dem_size_law less 1; NaN: all are of one diameter */
    double by;   /* a size_basis */
    double median, geometric_deviation, mean, deviation, size, spread, minimum, maximum;
    size_t size_count, cumulative_count, share_count;
    char file[257]; /* "": not given, or taken (given_files.h) */
    double sizes[DEM_MAXIMUM_SIEVES], cumulative[DEM_MAXIMUM_SIEVES], shares[DEM_MAXIMUM_SIEVES];
} size_inputs;
typedef enum size_basis { SIZES_BY_MASS, SIZES_BY_VOLUME, SIZES_BY_NUMBER } size_basis;

typedef struct species_inputs {
    double shape; /* index into the choices of the table; the one behind the last: the spheres below */
    double diameter, density, share;
    spec_name material; /* "": none */
    size_t sphere_count;
    dem_cluster_sphere sphere[DEM_MAXIMUM_CLUSTER];
    size_inputs sizes;
} species_inputs;

/* What pulls; NaN: not given. */
typedef struct cohesion_inputs {
    double law; /* index into the choices, a dem_cohesion_law less 1; NaN: no cohesion */
    double pull_off, bond_number, energy_density, surface_energy, liquid_volume, surface_tension, contact_angle_deg;
} cohesion_inputs;

/* NaN: as the contact has it. */
typedef struct material_inputs {
    spec_name name;
    double density, youngs_modulus, poissons_ratio;
    double poisson_ratio; /* given instead; NaN once poissons_ratio is set by it */
} material_inputs;

/* Of two materials, or of one and a surface, what is not as contact and wall say; NaN: as they do. */
typedef struct pair_inputs {
    spec_name between[2];
    double friction, rolling_friction, restitution, stiffness;
    cohesion_inputs cohesion;
} pair_inputs;

/* A stage of a drum's rotation; NaN: not given. */
typedef struct stage_inputs {
    double rate, revolutions, seconds; /* one of the last two */
} stage_inputs;

/* A particle of a bed that is given particle by particle. */
typedef struct start_particle {
    double position[3], velocity[3], angular_velocity[3];
    double orientation[4];    /* w, x, y, z; NaN: not given */
    double species, diameter; /* the latter NaN: as the species has it */
} start_particle;

/* Where a bed that was made before comes from: one of job, file, particles. */
typedef struct start_inputs {
    double given;                /* NaN: from nowhere; a bed is made */
    char job[28], file[1025];    /* "": not given */
    char bed[28];                /* "": not given, or taken (given_files.h) */
    double snapshot, checkpoint; /* of the job: number; 1: its newest checkpoint */
    double bed_particles;        /* how many the bed has; NaN: not known */
    size_t particle_count;
    start_particle *particles; /* (particle_count) owned */
} start_inputs;

/* What a share counts: particles, volume or mass. */
typedef enum share_basis { SHARE_BY_NUMBER, SHARE_BY_VOLUME, SHARE_BY_MASS } share_basis;

/* What a process has beside the drum's inputs, or in their place. */
typedef struct fill_inputs {
    double cylinder_diameter, cylinder_height;
    double stream_diameter, rate, mass_rate, impact_speed; /* rate or mass_rate */
    double settling_seconds;
} fill_inputs;

typedef struct heap_inputs {
    double tube_diameter, tube_height, lift_speed;
    double plate_diameter, rim_height, plate_friction, plate_rolling_friction;
    double seconds;
} heap_inputs;

typedef struct orifice_inputs {
    double vessel_diameter, vessel_width, vessel_depth, vessel_height; /* diameter, or width and depth */
    double diameter, width;                                            /* one of them */
    double half_angle_deg;                                             /* NaN: no hopper */
    double seconds;
} orifice_inputs;

enum { MOST_TRACERS = 64 };

/* Of every process that advances a scene: drum, fill, heap, orifice. */
typedef struct scene_inputs {
    double drum_diameter, drum_length, drum_ends, rotation_rate;
    double rotation_rate_rpm; /* given instead; NaN once rotation_rate is set by it */
    double rate_was_rpm;      /* NaN: it was not */
    size_t stage_count;       /* with stages there is no rotation_rate */
    stage_inputs *stages;     /* (stage_count) owned */
    double tilt_deg;
    size_t species_count;
    species_inputs species[DEM_MAXIMUM_SPECIES];
    double share_by; /* a share_basis */
    size_t material_count, pair_count;
    material_inputs *materials; /* (material_count) owned */
    pair_inputs *pairs;         /* (pair_count) owned */
    spec_name wall_material, plate_material;
    cohesion_inputs cohesion, wall_cohesion;
    double fill_fraction, fill_height, particle_count; /* one of them; fill_height of what stands */
    double contact_law, friction, rolling_friction, tangential_stiffness_ratio;
    double restitution, unloading_slope; /* one of the two */
    double rolling_law, rolling_damping; /* the first a dem_rolling_law */
    double latch_damping;
    double unloading;                                  /* 0: constant, 1: variable */
    double maximum_overlap, stiffness, youngs_modulus; /* one of the three */
    double poissons_ratio, steps_per_contact;
    double wall_friction, wall_rolling_friction, end_friction, end_rolling_friction, lining_diameter, lining_pitch;
    double lifter_count, lifter_height, lifter_width, lifter_friction; /* NaN: no lifters */
    double lifter_angle_deg;
    double revolutions, seconds, until_standard_error; /* one of the three */
    double at_most_revolutions;                        /* beside the last */
    double snapshot_interval, sample_interval;
    double tracer[MOST_TRACERS]; /* ids */
    size_t tracer_count;
    double seed, threads, beds, gravity, corrector_passes;
    double precision; /* 0: single, 1: double */
    start_inputs start;
    fill_inputs fill;
    heap_inputs heap;
    orifice_inputs orifice;
    /* While it is parsed: */
    struct spec_memory *memory;
    const client_watch *client;
} scene_inputs;

typedef struct granule_inputs {
    double friction, radius, rotation_rate; /* rotation_rate may be NaN: not asked for */
    double rotation_rate_rpm;               /* given instead; NaN once rotation_rate is set by it */
    double revolutions, gravity, tolerance;
} granule_inputs;

typedef struct process_type process_type; /* process_type.h */

/* What may stand elsewhere under a name: a bed that was sent, files of particles and of sieves. */
typedef enum given_table { GIVEN_BED, GIVEN_PARTICLES, GIVEN_SIEVES } given_table;

/* Where the beds that a spec can start from are looked up: the daemon has those of its jobs, a worker that of a file. */
typedef struct start_source {
    /* The canonical spec that the bed was made by (new reference), and its number of particles; NULL: there is no such bed,
     * and a problem says so. */
    json_t *(*find)(void *context, const start_inputs *start, double *particles, problem_list *problems);
    /* What csv_table.h reads of it (new reference); NULL: there is none, and a problem at the pointer says so. */
    json_t *(*table)(void *context, given_table kind, const char *name, const char *pointer, problem_list *problems);
    void *context;
    struct spec_memory *memory; /* of specs read before; NULL: none */
    const client_watch *client; /* the client that waits for the answer; NULL: none that could go away */
} start_source;

enum { PRIORITY_MOST = 10 };

typedef struct job_spec {
    const process_type *type;
    const char *process;      /* its name, "drum" */
    const start_source *beds; /* while it is parsed */
    int threads;              /* of the worker; each bed has scene.threads of them */
    json_t *label;            /* object of strings and numbers, owned; never NULL */
    int priority;       /* in [-PRIORITY_MOST, PRIORITY_MOST]; no part of the canonical spec, since results do not depend on it */
    json_t *wanted;     /* how its results are wanted (execute_request.h), owned; NULL: as ever. No part of the canonical spec */
    json_t *given;      /* owned: the inputs that the request had, as "contact/friction" */
    json_t *subscriber; /* who is called back (subscriber.h), owned; NULL: nobody. Likewise */
    json_t *resources;  /* what is asked of a cluster (job_resources.h), owned; NULL: nothing. Likewise */

    /* Of all that advance a scene: */
    scene_inputs inputs;        /* as asked for */
    size_t bed_count;           /* that run side by side */
    dem_scene_definition scene; /* the scene, complete: stiffness, time step and particle count derived */
    double rotation_rate;       /* rad/s, as asked for; of a drum with stages the fastest */
    bool is_mirrored;       /* it turns first with a rate below 0: the scene is the mirror image, x for -x, of what was asked for */
    double maximum_overlap; /* asked for, share of the smallest diameter; 0: stiffness was given */
    double expected_overlap;     /* of the hardest impact, likewise; follows from the stiffness where that was given */
    double bond_number;          /* largest pull-off between particles over the weight of the mean one; NaN: nothing coheres */
    double duration;             /* s from when rotation, filling or lifting starts; at most, where the run ends by itself */
    double until_standard_error; /* degrees; 0: none asked for */
    double sample_interval;      /* s between frames of measurement */
    double snapshot_interval;    /* s between snapshots; 0: only the last */

    /* Of a granule alone: */
    granule_inputs granule_inputs;
    dem_granule_definition granule;
} job_spec;

/* NaN: the process has no such thing. */
typedef struct job_estimate {
    double particles, steps, wall_seconds, memory_bytes, snapshots, snapshot_bytes, checkpoint_bytes; /* of one */
    double simulated_seconds, time_step, stiffness; /* settling included; s; N/m */
    /* Of it, making the bed, and what most seeds are between; NaN: not known. */
    double settling_seconds, settling_seconds_low, settling_seconds_high;
    char processor[CALIBRATION_TEXT]; /* on which it is expected to take so long; "": on none in particular */
    calibration_load load;            /* what each step has to do; no spheres: the process has no steps */
} job_estimate;

/* Reads {"process"?, "inputs", "label"?} and what may be around them (execute_request.h). process NULL: the document's own "process",
 * "drum" by default. seed_if_missing: the seed, its low 53 bits, where the request gives none. False: there are problems, all of
 * which are listed, and the spec is cleared. */
bool job_spec_parse(const char *process, const json_t *request, uint64_t seed_if_missing, job_spec *spec, problem_list *problems);
/* As job_spec_parse, but also looks up the bed that the run starts from in `beds`, and compares it with the spec. Without `beds`
 * the start is taken as valid, as it is in a spec that has been checked before. */
bool job_spec_parse_with(const start_source *beds, const char *process, const json_t *request, uint64_t seed_if_missing,
                         job_spec *spec, problem_list *problems);
/* Of a job or a study, a member of its request: those of a higher one run first. NULL: 0. */
int read_priority(const json_t *priority, problem_list *problems);
void job_spec_clear(job_spec *spec);

/* Of a run of several beds, one: its own seed, which of the first is the run's. The copy owns nothing. */
job_spec job_spec_of_bed(const job_spec *spec, size_t bed);
uint64_t job_bed_seed(uint64_t seed, size_t bed);
/* How many of them advance at a time: one a thread. */
int job_beds_at_once(const job_spec *spec);
void job_spec_set_threads(job_spec *spec, int threads);

/* {"process", "inputs", "label"}: canonical. New reference; NULL: no memory. */
json_t *job_spec_to_json(const job_spec *spec);
/* The canonical text, as spec.json holds it. To be freed; NULL: no memory. */
char *job_spec_to_text(const job_spec *spec);
/* The same, but for a start's particles one by one, of which it has the number alone: what files of the run carry. */
char *job_spec_to_brief(const job_spec *spec);

/* machine: how fast this one is; NULL takes cautious built-in figures. */
job_estimate job_spec_estimate(const job_spec *spec, const calibration *machine);
/* What the files of a job take: its snapshots, two checkpoints and the one that is being written. */
double job_estimate_disk_bytes(const job_estimate *estimate);
/* Adds a problem at the pointer, that of the interval between snapshots, where files of so many bytes do not fit into what is
 * free of the data folder's disk (NaN: not known). */
void job_check_disk(double bytes, double free_bytes, const char *pointer, problem_list *problems);
/* What one POST may ask for; 0: anything, but of the resources of a cluster what is listed. Of a study the seconds and the bytes are
 * those of all its jobs together. */
typedef struct post_limits {
    double estimate_seconds, particles, snapshot_bytes, threads;
    resource_list resources;
} post_limits;
/* Adds a problem for each limit that the numbers are beyond (NaN: there is no such number). at: where the inputs are, "/inputs". */
void job_check_limits(const post_limits *limits, const char *at, double wall_seconds, double particles, double snapshot_bytes,
                      double threads, problem_list *problems);
/* A checkpoint of a scene with so many spheres, and frames that take so many bytes. */
double scene_checkpoint_bytes(double spheres, double frame_bytes);
json_t *job_estimate_to_json(const job_estimate *estimate);

/* What can be run but was hardly meant so, in the words of problems: a pointer and what is there (job_warnings.c). */
void job_spec_warn(const job_spec *spec, const calibration *machine, problem_list *warnings);
/* [{"field": pointer, "text": ...}]: of such a list, and of a job's. New references; NULL: no memory. */
json_t *job_warnings_to_json(const problem_list *warnings);
json_t *job_spec_warnings(const job_spec *spec, const calibration *machine);
/* What the inputs come to in other words: revolutions a minute, Froude number, ... New reference; NULL: no memory. */
json_t *job_spec_understood(const job_spec *spec, const calibration *machine);
/* These two, the canonical spec and its estimate: what a check answers. New reference; NULL: no memory. */
json_t *job_spec_report(const job_spec *spec, const calibration *machine);

/* OGC process description with every input's JSON Schema, unit, range and default, made from the same table
 * of fields that the parser uses. NULL for an unknown process. New reference. */
json_t *process_description(const char *process);
json_t *process_summaries(void); /* array of summaries, for GET /processes */

#endif
