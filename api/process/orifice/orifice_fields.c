/* The inputs of `orifice`. Ranges are wider than what makes sense together; orifice_rules.c looks at combinations. */
#include "orifice_process.h"
#include "scene_fields.h"

static const spec_field fields[] = {
    { SPEC_INPUTS, "vessel", FIELD_OBJECT, SPEC_VESSEL, .required = true,
      .meaning = "what the particles stand in: a cylinder of that diameter, or a flat box of that width and depth" },
    { SPEC_VESSEL, "diameter", FIELD_REAL, .required = true, .spared_by = "width", .unit = "m", RANGE(0.001, 20.0), .fallback = NAN,
      AT(orifice.vessel_diameter), USUAL(0.003, 3.0), SLIP("cm", 0.01), COLUMN("vessel_width", REAL, scene.diameter), LISTED,
      IN_LIST(140, "vessel Ø ", 1, NULL), IN_VIEW(141), IN_FORM(10, NULL),
      .meaning =
          "inner diameter; at least 5 of the largest particle diameters. Above a slot: the same as width. The column has the "
          "diameter or the width" },
    { SPEC_VESSEL, "width", FIELD_REAL, .unit = "m", RANGE(0.001, 20.0), .fallback = NAN, .excludes_too = "diameter",
      AT(orifice.vessel_width), USUAL(0.003, 3.0), SLIP("cm", 0.01),
      .meaning = "of a flat vessel, across its slot, instead of diameter; at least 5 of the largest particle diameters" },
    { SPEC_VESSEL, "depth", FIELD_REAL, .unit = "m", RANGE(0.0005, 20.0), .fallback = NAN, AT(orifice.vessel_depth),
      USUAL(0.001, 3.0), SLIP("cm", 0.01), COLUMN("vessel_depth", REAL, inputs.orifice.vessel_depth), .column_may_miss = true,
      IN_VIEW(142),
      .meaning = "of a flat vessel, between the two plates, and so the length of its slot; at least 3 of the largest particle "
                 "diameters. Default: 8 of them" },
    { SPEC_VESSEL, "height", FIELD_REAL, .unit = "m", RANGE(0.001, 50.0), .fallback = NAN, AT(orifice.vessel_height),
      USUAL(0.001, 10.0), SLIP("cm", 0.01), COLUMN("vessel_height", REAL, scene.length), IN_VIEW(143),
      .meaning = "from the orifice to the top of the part that the bed is made in; the wall goes on above it. Default: what the "
                 "particles need" },

    { SPEC_INPUTS, "orifice", FIELD_OBJECT, SPEC_ORIFICE, .required = true,
      .meaning = "the hole in the middle of the floor, or below the hopper, which is closed until the bed is at rest" },
    { SPEC_ORIFICE, "diameter", FIELD_REAL, .required = true, .spared_by = "width", .unit = "m", RANGE(1e-5, 20.0), .fallback = NAN,
      AT(orifice.diameter), USUAL(3e-4, 1.0), SLIP("cm", 0.01), COLUMN("opening", REAL, scene.orifice.opening), LISTED,
      IN_LIST(150, "orifice ", 1, NULL), IN_VIEW(144), IN_FORM(20, NULL),
      .meaning =
          "of a round hole; at least one of the largest particle diameters. The column has the diameter, or the slot's width" },
    { SPEC_ORIFICE, "width", FIELD_REAL, .unit = "m", RANGE(1e-5, 20.0), .fallback = NAN, .excludes_too = "diameter",
      AT(orifice.width), USUAL(3e-4, 1.0), SLIP("cm", 0.01),
      .meaning = "of a slot across the whole depth of a flat vessel, instead of diameter; at least one of the largest particle "
                 "diameters" },

    { SPEC_INPUTS, "hopper", FIELD_OBJECT_OR_NULL, SPEC_HOPPER, AT(orifice.half_angle_deg),
      COLUMN("hopper_half_angle_deg", REAL, inputs.orifice.half_angle_deg), .column_may_miss = true, IN_VIEW(145),
      .unit = "degrees", .meaning = "a cone, or two inclined plates over a slot, down to the orifice; null: a flat floor" },
    { SPEC_HOPPER, "half_angle_deg", FIELD_REAL, .required = true, .unit = "degrees", RANGE(5.0, 85.0), .fallback = NAN,
      AT(orifice.half_angle_deg), IN_FORM(30, NULL), .meaning = "between its wall and the vertical" },

    FIELDS_OF_PARTICLES,

    FIELD_OF_COUNT,
    { SPEC_INPUTS, "fill_height", FIELD_REAL, .unit = "m", OPEN_RANGE(0.0, 20.0), .fallback = NAN, AT(fill_height), USUAL(0.0, 5.0),
      SLIP("cm", 0.01),
      .meaning = "of the bed at a solid fraction of 0.6 in a vessel without a hopper. Default: twice the diameter or width of the "
                 "vessel, or 8 orifices where that is more" },

    FIELDS_OF_CONTACT,

    FIELDS_OF_STANDING_WALL("sides, floor and hopper of the vessel", "the whole vessel", "the vessel"),

    { SPEC_INPUTS, "duration", FIELD_OBJECT, SPEC_DURATION, COLUMN("duration", REAL, duration), LISTED, IN_VIEW(310), .unit = "s",
      .meaning = "how long the run goes on from when the orifice is opened" },
    { SPEC_DURATION, "at_most_seconds", FIELD_REAL, .unit = "s", OPEN_RANGE(0.0, 1e6), .fallback = NAN, AT(orifice.seconds),
      .meaning =
          "it ends as soon as nothing leaves any more. Default: 3 times what Beverloo's law gives for all particles, and 2 s" },

    FIELDS_OF_STANDING_RUN,
};
const spec_table orifice_fields = { fields, sizeof fields / sizeof fields[0] };
