/* The inputs of `granule`. */
#include <math.h>

#include "granule_process.h"
#include "input_rows.h"

#define AT(member) .offset = offsetof(granule_inputs, member)

static const spec_field fields[] = {
    { SPEC_INPUTS, "friction", FIELD_REAL, .required = true, .unit = "", RANGE(0.001, 10.0), .fallback = NAN, AT(friction),
      USUAL(0.0, 1.5), COLUMN("friction", REAL, granule.friction), LISTED, IN_LIST(10, "μ ", 1, NULL), IN_VIEW(220),
      IN_FORM(10, NULL), .meaning = "coefficient of friction between particle and wall" },
    { SPEC_INPUTS, "radius", FIELD_REAL, .unit = "m", RANGE(0.0001, 100.0), .fallback = 0.063, AT(radius), USUAL(0.001, 3.0),
      SLIP("cm", 0.01), COLUMN("radius", REAL, granule.radius), LISTED, IN_LIST(30, "R ", 1, NULL), IN_VIEW(330), IN_FORM(20, NULL),
      .meaning = "of the circle that the particle's centre describes" },
    { SPEC_INPUTS, "rotation_rate", FIELD_REAL, .unit = "rad/s", RANGE(-10000.0, 10000.0), .least_size = 0.001, .fallback = NAN,
      AT(rotation_rate), COLUMN("rotation_rate", REAL, granule_inputs.rotation_rate), LISTED, IN_LIST(20, "", 1, NULL),
      IN_VIEW(150), IN_FORM(30, NULL), .column_may_miss = true,
      .meaning = "a rate at which to tell what becomes of the particle. Default: none, only the least rate is found" },
    { SPEC_INPUTS, "rotation_rate_rpm", FIELD_REAL, .unit = "1/min", RANGE(-95000.0, 95000.0), .least_size = 0.01, .fallback = NAN,
      .excludes_too = "rotation_rate", AT(rotation_rate_rpm), .meaning = "revolutions a minute, instead of rotation_rate" },
    { SPEC_INPUTS, "revolutions", FIELD_INTEGER, .unit = "revolutions", RANGE(1, 100), .fallback = 30, AT(revolutions),
      COLUMN("revolutions", WHOLE, granule_inputs.revolutions),
      .meaning = "for how many the particle is followed, unless its motion repeats itself sooner" },
    { SPEC_INPUTS, "gravity", FIELD_REAL, .unit = "m/s2", RANGE(0.01, 1000.0), .fallback = 9.81, AT(gravity), USUAL(1.0, 30.0),
      SLIP("cm/s2", 0.01), COLUMN("gravity", REAL, granule.gravity), IN_VIEW(160),
      .meaning = "acceleration of gravity, across the axis" },
    { SPEC_INPUTS, "tolerance", FIELD_REAL, .unit = "", RANGE(1e-12, 0.01), .fallback = 1e-9, AT(tolerance),
      COLUMN("tolerance", REAL, granule.tolerance), .meaning = "to which minimum_omega2 is found" },
};
const spec_table granule_fields = { fields, sizeof fields / sizeof fields[0] };
