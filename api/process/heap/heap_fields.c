/* The inputs of `heap`. Ranges are wider than what makes sense together; heap_rules.c looks at combinations. */
#include "heap_process.h"
#include "scene_fields.h"

static const spec_field fields[] = {
    { SPEC_INPUTS, "tube", FIELD_OBJECT, SPEC_TUBE, .required = true,
      .meaning = "the tube, or straw, that stands on the plate full of particles and is raised" },
    { SPEC_TUBE, "diameter", FIELD_REAL, .required = true, .unit = "m", RANGE(0.001, 20.0), .fallback = NAN, AT(heap.tube_diameter),
      USUAL(0.003, 1.0), SLIP("cm", 0.01), COLUMN("tube_diameter", REAL, scene.diameter), LISTED, IN_LIST(80, "tube Ø ", 1, NULL),
      IN_VIEW(100), IN_FORM(10, NULL), .meaning = "inner diameter; at least 5 of the largest particle diameters, or they jam" },
    { SPEC_TUBE, "height", FIELD_REAL, .unit = "m", RANGE(0.001, 20.0), .fallback = NAN, AT(heap.tube_height), USUAL(0.001, 5.0),
      SLIP("cm", 0.01),
      .meaning = "of the part of the tube that the bed is made in; the wall goes on above it. Default: what the particles need" },
    { SPEC_TUBE, "lift_speed", FIELD_REAL, .unit = "m/s", OPEN_RANGE(0.0, 10.0), .fallback = NAN, AT(heap.lift_speed),
      COLUMN("lift_speed", REAL, scene.lift.speed), LISTED, IN_LIST(90, "", 1e3, " mm/s"), IN_VIEW(110), IN_FORM(20, "mm/s"),
      ACTS_LATER, .meaning = "at which it is raised. Default: slowly, a fiftieth of sqrt(gravity * diameter)" },

    { SPEC_INPUTS, "plate", FIELD_OBJECT, SPEC_PLATE, .meaning = "the level disc below, whose middle is on the tube's axis" },
    { SPEC_PLATE, "diameter", FIELD_REAL, .unit = "m", RANGE(0.001, 50.0), .fallback = NAN, AT(heap.plate_diameter),
      USUAL(0.003, 3.0), SLIP("cm", 0.01), COLUMN("plate_diameter", REAL, scene.plate.diameter), LISTED,
      IN_LIST(100, "plate Ø ", 1, NULL), IN_VIEW(120), IN_FORM(30, NULL),
      .meaning = "of the disc: what rolls off it is lost. Default: 2 of the tube's diameters" },
    { SPEC_PLATE, "rim_height", FIELD_REAL, .unit = "m", RANGE(0.0, 1.0), .fallback = NAN, AT(heap.rim_height), USUAL(0.0, 0.1),
      SLIP("cm", 0.01), COLUMN("rim_height", REAL, scene.plate.rim_height), IN_VIEW(130),
      .meaning = "of the rim around it; 0: none. Default: half the largest particle diameter, which keeps the lowest layer "
                 "from rolling off" },
    { SPEC_PLATE, "material", FIELD_TEXT, .unit = "", RANGE(1, NAME_MOST), AT(plate_material),
      .meaning = "name of the material of plate and rim, a member of materials" },
    { SPEC_PLATE, "friction", FIELD_REAL, .unit = "", RANGE(0.0, 5.0), .fallback = 0.5, AT(heap.plate_friction), USUAL(0.0, 1.5),
      COLUMN("plate_friction", REAL, scene.plate.friction), IN_VIEW(140),
      .meaning = "coefficient of friction between a particle and the plate or its rim" },
    { SPEC_PLATE, "rolling_friction", FIELD_REAL, .unit = "", RANGE(0.0, 1.0), .fallback = 0.0, AT(heap.plate_rolling_friction),
      .meaning = "coefficient of rolling friction between a particle and the plate or its rim. Default: none" },

    FIELDS_OF_PARTICLES,

    FIELD_OF_COUNT,
    { SPEC_INPUTS, "fill_height", FIELD_REAL, .unit = "m", OPEN_RANGE(0.0, 20.0), .fallback = NAN, AT(fill_height), USUAL(0.0, 3.0),
      SLIP("cm", 0.01), .meaning = "of the bed in the tube, at a solid fraction of 0.6. Default: twice the tube's diameter" },

    FIELDS_OF_CONTACT,

    FIELDS_OF_STANDING_WALL("wall of the tube", "the tube", "the tube"),

    { SPEC_INPUTS, "duration", FIELD_OBJECT, SPEC_DURATION, COLUMN("duration", REAL, duration), LISTED, IN_VIEW(310), .unit = "s",
      ACTS_LATER, .meaning = "how long the run goes on from when the tube starts to rise" },
    { SPEC_DURATION, "at_most_seconds", FIELD_REAL, .unit = "s", OPEN_RANGE(0.0, 1e6), .fallback = NAN, AT(heap.seconds),
      .meaning = "it ends as soon as the tube is clear of the heap and the heap at rest. Default: the time to raise the tube by "
                 "fill_height, and 3 s" },

    FIELDS_OF_STANDING_RUN,
};
const spec_table heap_fields = { fields, sizeof fields / sizeof fields[0] };
