/* The inputs of `fill`. Ranges are wider than what makes sense together; fill_rules.c looks at combinations. */
#include "fill_process.h"
#include "scene_fields.h"

static const spec_field fields[] = {
    { SPEC_INPUTS, "cylinder", FIELD_OBJECT, SPEC_CYLINDER, .required = true, .meaning = "the standing cylinder that is filled" },
    { SPEC_CYLINDER, "diameter", FIELD_REAL, .required = true, .unit = "m", RANGE(0.001, 20.0), .fallback = NAN,
      AT(fill.cylinder_diameter), USUAL(0.003, 2.0), SLIP("cm", 0.01), COLUMN("cylinder_diameter", REAL, scene.diameter), LISTED,
      IN_LIST(50, "cylinder Ø ", 1, NULL), IN_VIEW(60), IN_FORM(10, NULL),
      .meaning = "inner diameter; at least 6 of the largest particle diameters" },
    { SPEC_CYLINDER, "height", FIELD_REAL, .unit = "m", RANGE(0.001, 20.0), .fallback = NAN, AT(fill.cylinder_height),
      USUAL(0.001, 5.0), SLIP("cm", 0.01), .meaning = "up to which it may be filled. Default: what the particles need" },

    { SPEC_INPUTS, "stream", FIELD_OBJECT, SPEC_STREAM, .meaning = "the particles that fall in, along the axis" },
    { SPEC_STREAM, "diameter", FIELD_REAL, .unit = "m", RANGE(1e-5, 20.0), .fallback = NAN, AT(fill.stream_diameter),
      USUAL(1e-4, 1.0), SLIP("cm", 0.01), COLUMN("stream_diameter", REAL, scene.stream.diameter), LISTED, IN_VIEW(70),
      IN_FORM(20, NULL),
      .meaning = "of the inlet; at most the cylinder's. Default: a quarter of it, or 3 of the largest particle diameters" },
    { SPEC_STREAM, "rate", FIELD_REAL, .unit = "1/s", OPEN_RANGE(0.0, 1e9), .fallback = NAN, AT(fill.rate),
      COLUMN("rate", REAL, scene.stream.rate), LISTED, IN_LIST(70, "", 1, " a second"), IN_VIEW(80), IN_FORM(30, NULL),
      .meaning = "particles a second. Default: as many as fill 5 % of the stream at impact_speed" },
    { SPEC_STREAM, "mass_rate", FIELD_REAL, .unit = "kg/s", OPEN_RANGE(0.0, 1e6), .fallback = NAN, .excludes_too = "rate",
      AT(fill.mass_rate), .meaning = "mass a second, instead of rate" },
    { SPEC_STREAM, "impact_speed", FIELD_REAL, .unit = "m/s", OPEN_RANGE(0.0, 100.0), .fallback = 1.0, AT(fill.impact_speed),
      USUAL(0.0, 15.0), SLIP("cm/s", 0.01), COLUMN("impact_speed", REAL, scene.stream.impact_speed), LISTED,
      IN_LIST(60, "", 1, NULL), IN_VIEW(90), .meaning = "at which particles meet the level of the bed: the inlet rises with it" },

    FIELDS_OF_PARTICLES,

    FIELD_OF_COUNT,
    { SPEC_INPUTS, "fill_height", FIELD_REAL, .unit = "m", OPEN_RANGE(0.0, 20.0), .fallback = NAN, AT(fill_height), USUAL(0.0, 3.0),
      SLIP("cm", 0.01), .meaning = "of the whole bed, at a solid fraction of 0.6. Default: half the cylinder's diameter" },

    FIELDS_OF_CONTACT,

    FIELDS_OF_STANDING_WALL("wall and floor of the cylinder", "wall and floor", "wall or floor"),

    { SPEC_INPUTS, "duration", FIELD_OBJECT, SPEC_DURATION, COLUMN("duration", REAL, duration), LISTED, IN_VIEW(310), .unit = "s",
      .meaning = "how long the run goes on after the stream has ended" },
    { SPEC_DURATION, "settling_seconds", FIELD_REAL, .unit = "s", OPEN_RANGE(0.0, 1e6), .fallback = 2.0, AT(fill.settling_seconds),
      .meaning = "at most: it ends as soon as the bed is at rest" },

    FIELDS_OF_STANDING_RUN,
};
const spec_table fill_fields = { fields, sizeof fields / sizeof fields[0] };
