/* The inputs of `fill`. Ranges are wider than what makes sense together; fill_rules.c looks at combinations. */
#include "fill_process.h"
#include "scene_fields.h"

static const spec_field fields[] = {
    { SPEC_INPUTS, "cylinder", FIELD_OBJECT, SPEC_CYLINDER, .required = true, .meaning = "the standing cylinder that is filled" },
    { SPEC_CYLINDER, "diameter", FIELD_REAL, .required = true, .unit = "m", RANGE(0.001, 20.0), .fallback = NAN,
      AT(fill.cylinder_diameter), USUAL(0.003, 2.0), SLIP("cm", 0.01), COLUMN("cylinder_diameter", REAL, scene.diameter), LISTED,
      IN_LIST(50, "cylinder Ø ", 1, NULL), IN_VIEW(60), .meaning = "inner diameter; at least 6 of the largest particle diameters" },
    { SPEC_CYLINDER, "height", FIELD_REAL, .unit = "m", RANGE(0.001, 20.0), .fallback = NAN, AT(fill.cylinder_height),
      USUAL(0.001, 5.0), SLIP("cm", 0.01), .meaning = "up to which it may be filled. Default: what the particles need" },

    { SPEC_INPUTS, "stream", FIELD_OBJECT, SPEC_STREAM, .meaning = "the particles that fall in, along the axis" },
    { SPEC_STREAM, "diameter", FIELD_REAL, .unit = "m", RANGE(1e-5, 20.0), .fallback = NAN, AT(fill.stream_diameter),
      USUAL(1e-4, 1.0), SLIP("cm", 0.01), COLUMN("stream_diameter", REAL, scene.stream.diameter), LISTED, IN_VIEW(70),
      .meaning = "of the inlet; at most the cylinder's. Default: a quarter of it, or 3 of the largest particle diameters" },
    { SPEC_STREAM, "rate", FIELD_REAL, .unit = "1/s", OPEN_RANGE(0.0, 1e9), .fallback = NAN, AT(fill.rate),
      COLUMN("rate", REAL, scene.stream.rate), LISTED, IN_LIST(70, "", 1, " a second"), IN_VIEW(80),
      .meaning = "particles a second. Default: as many as fill 5 % of the stream at impact_speed" },
    { SPEC_STREAM, "mass_rate", FIELD_REAL, .unit = "kg/s", OPEN_RANGE(0.0, 1e6), .fallback = NAN, .excludes_too = "rate",
      AT(fill.mass_rate), .meaning = "mass a second, instead of rate" },
    { SPEC_STREAM, "impact_speed", FIELD_REAL, .unit = "m/s", OPEN_RANGE(0.0, 100.0), .fallback = 1.0, AT(fill.impact_speed),
      USUAL(0.0, 15.0), SLIP("cm/s", 0.01), COLUMN("impact_speed", REAL, scene.stream.impact_speed), LISTED,
      IN_LIST(60, "", 1, NULL), IN_VIEW(90), .meaning = "at which particles meet the level of the bed: the inlet rises with it" },

    FIELDS_OF_PARTICLES,

    { SPEC_INPUTS, "particle_count", FIELD_INTEGER, .unit = "", RANGE(8, 5000000), .fallback = NAN, .excludes_too = "fill_height",
      AT(particle_count), COLUMN("particles", COUNT, scene.particle_count), LISTED, IN_LIST(110, "", 1, NULL),
      .meaning = "number of particles, instead of fill_height" },
    { SPEC_INPUTS, "fill_height", FIELD_REAL, .unit = "m", OPEN_RANGE(0.0, 20.0), .fallback = NAN, AT(fill_height), USUAL(0.0, 3.0),
      SLIP("cm", 0.01), .meaning = "of the whole bed, at a solid fraction of 0.6. Default: half the cylinder's diameter" },

    FIELDS_OF_CONTACT,

    { SPEC_INPUTS, "wall", FIELD_OBJECT, SPEC_WALL, .meaning = "wall and floor of the cylinder" },
    { SPEC_WALL, "material", FIELD_TEXT, .unit = "", RANGE(1, NAME_MOST), AT(wall_material),
      .meaning = "name of the material of wall and floor, a member of materials: its pairs with others hold there" },
    { SPEC_WALL, "friction", FIELD_REAL, .unit = "", RANGE(0.0, 5.0), .fallback = 0.5, AT(wall_friction), USUAL(0.0, 1.5),
      COLUMN("wall_friction", REAL, scene.contact.wall_friction), LISTED, IN_VIEW(240),
      .meaning = "coefficient of friction between a particle and wall or floor" },
    { SPEC_WALL, "rolling_friction", FIELD_REAL, .unit = "", RANGE(0.0, 1.0), .fallback = 0.0, AT(wall_rolling_friction),
      COLUMN("wall_rolling_friction", REAL, scene.contact.wall_rolling_friction), IN_VIEW(260),
      .meaning = "coefficient of rolling friction between a particle and wall or floor. Default: none" },

    { SPEC_INPUTS, "duration", FIELD_OBJECT, SPEC_DURATION, COLUMN("duration", REAL, duration), LISTED, IN_VIEW(310), .unit = "s",
      .meaning = "how long the run goes on after the stream has ended" },
    { SPEC_DURATION, "settling_seconds", FIELD_REAL, .unit = "s", OPEN_RANGE(0.0, 1e6), .fallback = 2.0, AT(fill.settling_seconds),
      .meaning = "at most: it ends as soon as the bed is at rest" },

    FIELDS_OF_MATERIALS,
    FIELDS_OF_COHESIONS,
    FIELDS_OF_OUTPUT_AND_RUN,
    { SPEC_INPUTS, "gravity", FIELD_REAL, .unit = "m/s2", RANGE(0.01, 1000.0), .fallback = 9.81, AT(gravity), USUAL(1.0, 30.0),
      SLIP("cm/s2", 0.01), COLUMN("gravity", REAL, scene.gravity), IN_VIEW(160),
      .meaning = "acceleration of gravity, down the axis" },
};
const spec_table fill_fields = { fields, sizeof fields / sizeof fields[0] };
