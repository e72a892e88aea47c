#include "unit_table.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "dem_rules.h"

typedef enum dimension {
    LENGTH,
    TIME,
    SPEED,
    ACCELERATION,
    DENSITY,
    MASS_RATE,
    FREQUENCY,
    ROTATION,
    ANGLE,
    STIFFNESS,
    PRESSURE,
    FORCE,
    VOLUME,
    INVERSE_LENGTH,
    PURE
} dimension;

static const char *const dimension_names[] = { "length",    "time",      "speed",    "acceleration",   "density",
                                               "mass rate", "frequency", "rotation", "angle",          "stiffness",
                                               "pressure",  "force",     "volume",   "inverse length", "pure number" };
_Static_assert(sizeof dimension_names / sizeof *dimension_names == PURE + 1, "each dimension has a name");

typedef struct unit {
    dimension of;
    const char *name;
    int ten;          /* one of it is 10^ten times `times` over `by` of the dimension's first unit */
    double times, by; /* 0: 1 */
} unit;

/* A row of inputs is of the dimension in which its unit is found first. One revolution a minute is 1/min where something
 * turns; 1/s is no rate of rotation, since it could be radians or revolutions. */
static const unit units[] = {
    { .of = LENGTH, "m", 0 },
    { .of = LENGTH, "cm", -2 },
    { .of = LENGTH, "mm", -3 },
    { .of = LENGTH, "um", -6 },
    { .of = LENGTH, "µm", -6 }, /* the sign micro, U+00B5 */
    { .of = LENGTH, "μm", -6 }, /* the Greek letter, U+03BC */
    { .of = LENGTH, "in", -4, .times = 254.0 },
    { .of = TIME, "s", 0 },
    { .of = TIME, "ms", -3 },
    { .of = TIME, "us", -6 },
    { .of = TIME, "min", 0, .times = 60.0 },
    { .of = TIME, "h", 0, .times = 3600.0 },
    { .of = TIME, "d", 0, .times = 86400.0 },
    { .of = SPEED, "m/s", 0 },
    { .of = SPEED, "cm/s", -2 },
    { .of = SPEED, "mm/s", -3 },
    { .of = SPEED, "m/min", 0, .by = 60.0 },
    { .of = SPEED, "km/h", 3, .by = 3600.0 },
    { .of = ACCELERATION, "m/s2", 0 },
    { .of = ACCELERATION, "m/s²", 0 },
    { .of = ACCELERATION, "cm/s2", -2 },
    { .of = ACCELERATION, "mm/s2", -3 },
    { .of = DENSITY, "kg/m3", 0 },
    { .of = DENSITY, "kg/m³", 0 },
    { .of = DENSITY, "g/cm3", 3 },
    { .of = DENSITY, "g/cm³", 3 },
    { .of = DENSITY, "g/ml", 3 },
    { .of = DENSITY, "kg/l", 3 },
    { .of = DENSITY, "t/m3", 3 },
    { .of = DENSITY, "g/l", 0 },
    { .of = MASS_RATE, "kg/s", 0 },
    { .of = MASS_RATE, "g/s", -3 },
    { .of = MASS_RATE, "kg/min", 0, .by = 60.0 },
    { .of = MASS_RATE, "g/min", -3, .by = 60.0 },
    { .of = MASS_RATE, "kg/h", 0, .by = 3600.0 },
    { .of = MASS_RATE, "t/h", 3, .by = 3600.0 },
    { .of = FREQUENCY, "1/s", 0 },
    { .of = FREQUENCY, "Hz", 0 },
    { .of = FREQUENCY, "1/ms", 3 },
    { .of = FREQUENCY, "1/h", 0, .by = 3600.0 },
    { .of = ROTATION, "rad/s", 0 },
    { .of = ROTATION, "deg/s", 0, .times = DEM_PI, .by = 180.0 },
    { .of = ROTATION, "rpm", 0, .times = 2.0 * DEM_PI, .by = 60.0 },
    { .of = ROTATION, "1/min", 0, .times = 2.0 * DEM_PI, .by = 60.0 },
    { .of = ROTATION, "rev/min", 0, .times = 2.0 * DEM_PI, .by = 60.0 },
    { .of = ROTATION, "rev/s", 0, .times = 2.0 * DEM_PI },
    { .of = FREQUENCY, "1/min", 0, .by = 60.0 },
    { .of = ANGLE, "rad", 0 },
    { .of = ANGLE, "mrad", -3 },
    { .of = ANGLE, "degrees", 0, .times = DEM_PI, .by = 180.0 },
    { .of = ANGLE, "deg", 0, .times = DEM_PI, .by = 180.0 },
    { .of = ANGLE, "°", 0, .times = DEM_PI, .by = 180.0 },
    { .of = ANGLE, "revolutions", 0, .times = 2.0 * DEM_PI },
    { .of = ANGLE, "rev", 0, .times = 2.0 * DEM_PI },
    { .of = STIFFNESS, "N/m", 0 },
    { .of = STIFFNESS, "kN/m", 3 },
    { .of = STIFFNESS, "N/mm", 3 },
    { .of = STIFFNESS, "N/cm", 2 },
    { .of = STIFFNESS, "mN/m", -3 },
    { .of = STIFFNESS, "J/m2", 0 }, /* a surface energy, which is a surface tension */
    { .of = STIFFNESS, "mJ/m2", -3 },
    { .of = PRESSURE, "Pa", 0 },
    { .of = PRESSURE, "kPa", 3 },
    { .of = PRESSURE, "MPa", 6 },
    { .of = PRESSURE, "GPa", 9 },
    { .of = PRESSURE, "N/mm2", 6 },
    { .of = PRESSURE, "bar", 5 },
    { .of = PRESSURE, "J/m3", 0 },
    { .of = PRESSURE, "kJ/m3", 3 },
    { .of = FORCE, "N", 0 },
    { .of = FORCE, "mN", -3 },
    { .of = FORCE, "uN", -6 },
    { .of = VOLUME, "m3", 0 },
    { .of = VOLUME, "mm3", -9 },
    { .of = VOLUME, "ml", -6 },
    { .of = VOLUME, "ul", -9 },
    { .of = VOLUME, "nl", -12 },
    { .of = INVERSE_LENGTH, "1/m", 0 },
    { .of = INVERSE_LENGTH, "1/cm", 2 },
    { .of = INVERSE_LENGTH, "1/mm", 3 },
    { .of = PURE, "", 0 },
    { .of = PURE, "1", 0 },
    { .of = PURE, "%", -2 },
};
static const size_t unit_count = sizeof units / sizeof units[0];

static double times_of(const unit *one) { return one->times > 0.0 ? one->times : 1.0; }
static double by_of(const unit *one) { return one->by > 0.0 ? one->by : 1.0; }

/* NULL: the row has a unit that is not in the table, a mistake of ours that the tests find. */
static const unit *own_unit(const spec_field *field)
{
    for (size_t u = 0; u < unit_count; u++)
        if (strcmp(units[u].name, field->unit) == 0) return &units[u];
    return NULL;
}

/* What is counted can't be given in parts: of a whole number only units of the same size. */
static bool is_allowed(const spec_field *field, const unit *own, const unit *other)
{
    return own && other->of == own->of && *other->name
           && (field->kind != FIELD_INTEGER
               || (other->ten == own->ten && times_of(other) == times_of(own) && by_of(other) == by_of(own)));
}

bool is_quantity(const json_t *value) { return json_object_get(value, "value") && json_object_get(value, "unit"); }

/* The decimals that stand for the number, times a power of ten, as the nearest double. */
static double shift_decimals(double number, int ten)
{
    char text[48];
    if (ten == 0 || !isfinite(number)) return number;
    for (int digits = 15; digits <= 17; digits++) {
        snprintf(text, sizeof text, "%.*e", digits - 1, number);
        if (strtod(text, NULL) == number) break;
    }
    char *exponent = strchr(text, 'e');
    const int shifted = (int)strtol(exponent + 1, NULL, 10) + ten;
    snprintf(exponent, sizeof text - (size_t)(exponent - text), "e%d", shifted);
    return strtod(text, NULL);
}

bool unit_convert(const spec_field *field, const char *name, double number, double *converted)
{
    const unit *own = own_unit(field);
    for (size_t u = 0; u < unit_count; u++) {
        const unit *other = &units[u];
        if (!is_allowed(field, own, other) || strcmp(other->name, name) != 0) continue;
        number = shift_decimals(number, other->ten - own->ten);
        const bool same = times_of(other) == times_of(own) && by_of(other) == by_of(own);
        *converted = same ? number : number * times_of(other) / by_of(other) * by_of(own) / times_of(own);
        return true;
    }
    return false;
}

json_t *quantity_to_json(const spec_field *field, const json_t *quantity)
{
    const json_t *value = json_object_get(quantity, "value");
    const char *name = json_string_value(json_object_get(quantity, "unit"));
    double number;
    if (!json_is_number(value) || !name || !unit_convert(field, name, json_number_value(value), &number)) return NULL;
    return json_is_integer(value) && field->kind == FIELD_INTEGER ? json_integer(json_integer_value(value)) : json_real(number);
}

const char *unit_dimension(const spec_field *field)
{
    const unit *own = own_unit(field);
    return own ? dimension_names[own->of] : "";
}

json_t *unit_names(const spec_field *field)
{
    json_t *names = json_array();
    const unit *own = own_unit(field);
    if (own && *own->name) json_array_append_new(names, json_string(own->name));
    for (size_t u = 0; u < unit_count; u++)
        if (&units[u] != own && is_allowed(field, own, &units[u])) json_array_append_new(names, json_string(units[u].name));
    return names;
}

void unit_names_text(const spec_field *field, char text[UNITS_TEXT_SIZE])
{
    json_t *names = unit_names(field), *name;
    size_t i;
    *text = '\0';
    json_array_foreach(names, i, name)
    {
        const size_t length = strlen(text);
        snprintf(text + length, UNITS_TEXT_SIZE - length, "%s%s", i ? ", " : "", json_string_value(name));
    }
    json_decref(names);
}
