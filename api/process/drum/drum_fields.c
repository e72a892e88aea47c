/* The inputs of `drum`. Ranges are wider than what makes sense together; drum_rules.c looks at combinations. */
#include "csv_table.h"
#include "drum_process.h"
#include "result_fields.h"
#include "scene_fields.h"

static const char *const ends_choices[] = { "periodic", "walls", NULL };

#define AT_STAGE(member) .offset = offsetof(stage_inputs, member)
#define AT_PLACED(member) .offset = offsetof(start_particle, member)

static const spec_field fields[] = {
    { SPEC_INPUTS, "drum", FIELD_OBJECT, SPEC_DRUM, .required = true, .meaning = "the rotating drum" },
    { SPEC_DRUM, "diameter", FIELD_REAL, .required = true, .unit = "m", RANGE(0.001, 20.0), .fallback = NAN, AT(drum_diameter),
      USUAL(0.005, 2.0), SLIP("cm", 0.01), COLUMN("drum_diameter", REAL, scene.diameter), LISTED, IN_LIST(40, "drum Ø ", 1, NULL),
      IN_VIEW(10), .meaning = "inner diameter" },
    { SPEC_DRUM, "length", FIELD_REAL, .required = true, .unit = "m", RANGE(0.0001, 20.0), .fallback = NAN, AT(drum_length),
      USUAL(0.0005, 1.0), SLIP("cm", 0.01), COLUMN("drum_length", REAL, scene.length), LISTED, IN_VIEW(20),
      .meaning = "length along the axis; at least 3 of the largest particle diameters" },
    { SPEC_DRUM, "ends", FIELD_CHOICE, .unit = "", .choices = ends_choices, AT(drum_ends), COLUMN("ends", WORD, inputs.drum_ends),
      IN_VIEW(30),
      .meaning = "periodic: what leaves at one end enters at the other, as in a slice of a long drum; walls: closed by flat "
                 "discs that turn with it" },
    { SPEC_DRUM, "lifters", FIELD_OBJECT_OR_NULL, SPEC_LIFTERS, AT(lifter_count), COLUMN("lifters", COUNT, scene.lifters.count),
      IN_VIEW(40), .meaning = "straight bars of rectangular section along the wall, evenly spaced, turning with it; null: none" },
    { SPEC_DRUM, "rotation_rate", FIELD_REAL, .required = true, .spared_by = "rotation_rate_rpm", .spared_by_too = "rotation",
      .unit = "rad/s", RANGE(-500.0, 500.0), .least_size = 0.001, .fallback = NAN, .excludes = "rotation", AT(rotation_rate),
      COLUMN("rotation_rate", REAL, rotation_rate), LISTED, IN_LIST(20, "", 1, NULL), IN_VIEW(150), FREE_OF_BED, ACTS_LATER,
      .meaning = "rate of rotation; below 0: the other way, the mirror image. The column of a drum with stages has the fastest" },
    { SPEC_DRUM, "rotation_rate_rpm", FIELD_REAL, .unit = "1/min", RANGE(-4770.0, 4770.0), .least_size = 0.01, .fallback = NAN,
      .excludes = "rotation", .excludes_too = "rotation_rate", AT(rotation_rate_rpm), ACTS_LATER,
      .meaning = "revolutions a minute, instead of rotation_rate" },
    { SPEC_DRUM, "rotation", FIELD_LONG_LIST, SPEC_ROTATION, RANGE(1, DEM_MAXIMUM_STAGES), AT(stages),
      .count_offset = offsetof(scene_inputs, stage_count), .entry_size = sizeof(stage_inputs), FREE_OF_BED, ACTS_LATER,
      .meaning = "stages of rotation one after the other, each with results of its own, instead of rotation_rate and duration" },
    { SPEC_ROTATION, "rate", FIELD_REAL, .required = true, .unit = "rad/s", RANGE(-500.0, 500.0), .fallback = NAN, AT_STAGE(rate),
      .meaning = "rate of rotation in this stage; below 0: the other way; 0: the drum stands still" },
    { SPEC_ROTATION, "revolutions", FIELD_REAL, .unit = "revolutions", OPEN_RANGE(0.0, 1e5), .fallback = NAN,
      .excludes_too = "seconds", AT_STAGE(revolutions), .meaning = "how far the drum turns in it; not of a stage of rest" },
    { SPEC_ROTATION, "seconds", FIELD_REAL, .unit = "s", OPEN_RANGE(0.0, 1e6), .fallback = NAN, AT_STAGE(seconds),
      .meaning = "how long it lasts, instead of revolutions" },
    { SPEC_DRUM, "tilt_deg", FIELD_REAL, .unit = "degrees", RANGE(0.0, 60.0), .fallback = 0.0, AT(tilt_deg),
      COLUMN("tilt_deg", REAL, inputs.tilt_deg), IN_VIEW(165), FREE_OF_BED,
      .meaning =
          "of the axis from the horizontal, the end at -z being the lower one; with end walls alone. Angles are those of the "
          "cross-section" },

    FIELDS_OF_PARTICLES,

    { SPEC_INPUTS, "fill_fraction", FIELD_REAL, .unit = "", OPEN_RANGE(0.0, 0.95), .fallback = 0.5, .excludes = "particle_count",
      .spared_beside = "start", AT(fill_fraction), USUAL(0.05, 0.95), COLUMN("fill_fraction", REAL, scene.fill_fraction), LISTED,
      IN_LIST(140, "", 100, " % full"), IN_VIEW(170),
      .meaning = "share of the cross-section below the free surface, at a bed solid fraction of 0.6. With start: as there" },
    { SPEC_INPUTS, "particle_count", FIELD_INTEGER, .unit = "", RANGE(1, 5000000), .fallback = NAN, .excludes = "fill_fraction",
      AT(particle_count), COLUMN("particles", COUNT, scene.particle_count), LISTED, IN_LIST(110, "", 1, NULL),
      .meaning = "number of particles, instead of fill_fraction; at least 8, but with start" },

    { SPEC_INPUTS, "start", FIELD_OBJECT_OR_NULL, SPEC_START, AT(start.given),
      .meaning = "a bed that was made before, from which rotation begins at once; null: a bed is made" },
    { SPEC_START, "job", FIELD_TEXT, .unit = "", RANGE(1, 27), AT(start.job),
      .meaning = "id of the job whose bed it is: of the same drum and particles; all else may differ" },
    { SPEC_START, "snapshot", FIELD_INTEGER, .unit = "", RANGE(0, 1e9), .fallback = NAN, AT(start.snapshot),
      .meaning = "number of the job's snapshot: places and velocities in single precision, contacts without memory" },
    { SPEC_START, "checkpoint", FIELD_TRUE, .unit = "", .fallback = NAN, AT(start.checkpoint),
      .meaning = "the job's newest checkpoint, with what its contacts remember; of a job that is done: its end. The default, where "
                 "no snapshot is named" },
    { SPEC_START, "file", FIELD_TEXT, .unit = "", RANGE(1, 1024), AT(start.file),
      .meaning = "a snapshot or checkpoint file, or a table of particles whose name ends in .csv, instead of a job; for repose run "
                 "alone, where the path of a table is relative to the specification" },
    { SPEC_START, "bed", FIELD_TEXT, .unit = "", RANGE(1, 27), AT(start.bed),
      .meaning = "id of a table of particles that was sent to /beds, which takes the place of particles" },
    { SPEC_START, "particles", FIELD_LONG_LIST, SPEC_PLACED, RANGE(1, CSV_MOST_PARTICLES), AT(start.particles),
      .count_offset = offsetof(scene_inputs, start.particle_count), .entry_size = sizeof(start_particle),
      .meaning = "every particle, instead of a job" },
    { SPEC_PLACED, "position", FIELD_PLACE, .required = true, .unit = "m", RANGE(-20.0, 20.0), .fallback = NAN, AT_PLACED(position),
      .meaning = "centre of mass; the drum's axis is z, its middle 0, y is up" },
    { SPEC_PLACED, "velocity", FIELD_PLACE, .unit = "m/s", RANGE(-100.0, 100.0), .fallback = 0.0, AT_PLACED(velocity),
      .meaning = "its velocity" },
    { SPEC_PLACED, "angular_velocity", FIELD_PLACE, .unit = "rad/s", RANGE(-1e5, 1e5), .fallback = 0.0, AT_PLACED(angular_velocity),
      .meaning = "its spin, along the drum's axes" },
    { SPEC_PLACED, "orientation", FIELD_ORIENTATION, .unit = "", RANGE(-1.0, 1.0), .fallback = NAN, AT_PLACED(orientation),
      .meaning = "of a cluster, as snapshots have it: w, x, y, z of the turn from its principal axes. Default: not turned" },
    { SPEC_PLACED, "species", FIELD_INTEGER, .unit = "", RANGE(0, DEM_MAXIMUM_SPECIES - 1), .fallback = 0,
      .spared_beside = "diameter", AT_PLACED(species),
      .meaning = "which of the kinds of particles. With diameter: the one that has it" },
    { SPEC_PLACED, "diameter", FIELD_REAL, .unit = "m", RANGE(1e-5, 1.0), .fallback = NAN, AT_PLACED(diameter),
      .meaning = "of a sphere whose kind has a size distribution; else it tells the kind. Default: the kind's" },

    FIELDS_OF_CONTACT,

    { SPEC_INPUTS, "wall", FIELD_OBJECT, SPEC_WALL, .meaning = "inner wall of the drum" },
    { SPEC_WALL, "material", FIELD_TEXT, .unit = "", RANGE(1, NAME_MOST), AT(wall_material), FREE_OF_BED,
      .meaning = "name of the material of all that is the drum's, a member of materials: its pairs with others hold there" },
    { SPEC_WALL, "friction", FIELD_REAL, .unit = "", RANGE(0.0, 5.0), .fallback = 0.5, AT(wall_friction), USUAL(0.0, 1.5),
      COLUMN("wall_friction", REAL, scene.contact.wall_friction), LISTED, IN_VIEW(240), FREE_OF_BED,
      .meaning = "coefficient of friction between a particle and the wall or its lining" },
    { SPEC_WALL, "rolling_friction", FIELD_REAL, .unit = "", RANGE(0.0, 1.0), .fallback = 0.0, AT(wall_rolling_friction),
      COLUMN("wall_rolling_friction", REAL, scene.contact.wall_rolling_friction), IN_VIEW(260), FREE_OF_BED,
      .meaning = "coefficient of rolling friction between a particle and all that is the drum's: wall, lining, lifters, and ends "
                 "that have none of their own. Default: none" },
    { SPEC_WALL, "end_friction", FIELD_REAL, .unit = "", RANGE(0.0, 5.0), .fallback = NAN, AT(end_friction), USUAL(0.0, 1.5),
      FREE_OF_BED, .meaning = "coefficient of friction between a particle and the walls at the drum's ends. Default: the wall's" },
    { SPEC_WALL, "end_rolling_friction", FIELD_REAL, .unit = "", RANGE(0.0, 1.0), .fallback = NAN, AT(end_rolling_friction),
      COLUMN("end_rolling_friction", REAL, scene.ends.rolling_friction), IN_VIEW(265), FREE_OF_BED,
      .meaning = "coefficient of rolling friction between a particle and the walls at the drum's ends. Default: the wall's" },
    { SPEC_WALL, "lining", FIELD_OBJECT_OR_NULL, SPEC_LINING, AT(lining_diameter),
      .meaning = "spheres glued to the wall, turning with it; null: a smooth wall" },
    { SPEC_LINING, "diameter", FIELD_REAL, .required = true, .unit = "m", RANGE(1e-5, 1.0), .fallback = NAN, AT(lining_diameter),
      USUAL(1e-4, 0.05), SLIP("cm", 0.01), COLUMN("lining_diameter", REAL, scene.lining.diameter), IN_VIEW(290),
      .meaning = "diameter of the glued spheres; at most 1/8 of the drum's, and 1/3 of a periodic axis" },
    { SPEC_LINING, "pitch", FIELD_REAL, .unit = "m", RANGE(1e-5, 1.0), .fallback = NAN, AT(lining_pitch), USUAL(1e-4, 0.1),
      SLIP("cm", 0.01), .meaning = "distance between their centres, around the wall and along the axis. Default: their diameter" },
    { SPEC_LIFTERS, "count", FIELD_INTEGER, .required = true, .unit = "", RANGE(1, DEM_MAXIMUM_LIFTERS), .fallback = NAN,
      AT(lifter_count), .meaning = "number of bars" },
    { SPEC_LIFTERS, "height", FIELD_REAL, .required = true, .unit = "m", RANGE(1e-5, 10.0), .fallback = NAN, AT(lifter_height),
      USUAL(1e-4, 0.5), SLIP("cm", 0.01), .meaning = "of a bar, from the wall towards the axis" },
    { SPEC_LIFTERS, "width", FIELD_REAL, .required = true, .unit = "m", RANGE(1e-5, 10.0), .fallback = NAN, AT(lifter_width),
      USUAL(1e-4, 0.5), SLIP("cm", 0.01), .meaning = "of a bar, around the wall" },
    { SPEC_LIFTERS, "friction", FIELD_REAL, .unit = "", RANGE(0.0, 5.0), .fallback = NAN, AT(lifter_friction), USUAL(0.0, 1.5),
      FREE_OF_BED, .meaning = "coefficient of friction between a particle and a bar. Default: the wall's" },
    { SPEC_LIFTERS, "angle_deg", FIELD_REAL, .unit = "degrees", RANGE(-60.0, 60.0), .fallback = 0.0, AT(lifter_angle_deg),
      .meaning = "between a bar and the radius at its foot; above 0: its top leans the way that a positive rate turns" },

    { SPEC_INPUTS, "duration", FIELD_OBJECT, SPEC_DURATION, COLUMN("duration", REAL, duration), LISTED, IN_VIEW(310), .unit = "s",
      ACTS_LATER, .meaning = "how long the drum turns" },
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

    FIELDS_OF_MATERIALS,
    FIELDS_OF_COHESIONS,
    FIELDS_OF_OUTPUT_AND_RUN,
    { SPEC_INPUTS, "beds", FIELD_INTEGER, .unit = "", RANGE(1, MOST_BEDS), .fallback = 1, .is_left_out_by_default = true, AT(beds),
      COLUMN("beds", COUNT, bed_count), IN_VIEW(325), FREE_OF_BED,
      .meaning = "beds of this drum that differ in their seeds and run side by side, one a thread: one answer, whose error is of "
                 "all of them" },
    { SPEC_INPUTS, "gravity", FIELD_REAL, .unit = "m/s2", RANGE(0.01, 1000.0), .fallback = 9.81, AT(gravity), USUAL(1.0, 30.0),
      SLIP("cm/s2", 0.01), COLUMN("gravity", REAL, scene.gravity), IN_VIEW(160),
      .meaning = "acceleration of gravity, across the axis" },
};
const spec_table drum_fields = { fields, sizeof fields / sizeof fields[0] };
