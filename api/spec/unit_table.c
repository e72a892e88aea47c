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
    const char *name;
    dimension of;
    int ten;          /* one of it is 10^ten times `times` over `by` of the dimension's first unit */
    double times, by; /* 0: 1 */
    bool is_usual;    /* what people give such numbers in */
} unit;

/* A row of inputs is of the dimension in which its unit is found first. One revolution a minute is 1/min where something
 * turns; 1/s is no rate of rotation, since it could be radians or revolutions. */
static const unit units[] = {
    { .name = "m", LENGTH, 0 },
    { .name = "cm", LENGTH, -2 },
    { .name = "mm", LENGTH, -3, .is_usual = true },
    { .name = "um", LENGTH, -6 },
    { .name = "µm", LENGTH, -6 }, /* the sign micro, U+00B5 */
    { .name = "μm", LENGTH, -6 }, /* the Greek letter, U+03BC */
    { .name = "in", LENGTH, -4, .times = 254.0 },
    { .name = "s", TIME, 0 },
    { .name = "ms", TIME, -3 },
    { .name = "us", TIME, -6 },
    { .name = "min", TIME, 0, .times = 60.0 },
    { .name = "h", TIME, 0, .times = 3600.0 },
    { .name = "d", TIME, 0, .times = 86400.0 },
    { .name = "m/s", SPEED, 0 },
    { .name = "cm/s", SPEED, -2 },
    { .name = "mm/s", SPEED, -3 },
    { .name = "m/min", SPEED, 0, .by = 60.0 },
    { .name = "km/h", SPEED, 3, .by = 3600.0 },
    { .name = "m/s2", ACCELERATION, 0 },
    { .name = "m/s²", ACCELERATION, 0 },
    { .name = "cm/s2", ACCELERATION, -2 },
    { .name = "mm/s2", ACCELERATION, -3 },
    { .name = "kg/m3", DENSITY, 0 },
    { .name = "kg/m³", DENSITY, 0 },
    { .name = "g/cm3", DENSITY, 3 },
    { .name = "g/cm³", DENSITY, 3 },
    { .name = "g/ml", DENSITY, 3 },
    { .name = "kg/l", DENSITY, 3 },
    { .name = "t/m3", DENSITY, 3 },
    { .name = "g/l", DENSITY, 0 },
    { .name = "kg/s", MASS_RATE, 0 },
    { .name = "g/s", MASS_RATE, -3 },
    { .name = "kg/min", MASS_RATE, 0, .by = 60.0 },
    { .name = "g/min", MASS_RATE, -3, .by = 60.0 },
    { .name = "kg/h", MASS_RATE, 0, .by = 3600.0 },
    { .name = "t/h", MASS_RATE, 3, .by = 3600.0 },
    { .name = "1/s", FREQUENCY, 0 },
    { .name = "Hz", FREQUENCY, 0 },
    { .name = "1/ms", FREQUENCY, 3 },
    { .name = "1/h", FREQUENCY, 0, .by = 3600.0 },
    { .name = "rad/s", ROTATION, 0 },
    { .name = "deg/s", ROTATION, 0, .times = DEM_PI, .by = 180.0 },
    { .name = "rpm", ROTATION, 0, .times = 2.0 * DEM_PI, .by = 60.0, .is_usual = true },
    { .name = "1/min", ROTATION, 0, .times = 2.0 * DEM_PI, .by = 60.0 },
    { .name = "rev/min", ROTATION, 0, .times = 2.0 * DEM_PI, .by = 60.0 },
    { .name = "rev/s", ROTATION, 0, .times = 2.0 * DEM_PI },
    { .name = "1/min", FREQUENCY, 0, .by = 60.0 },
    { .name = "rad", ANGLE, 0 },
    { .name = "mrad", ANGLE, -3 },
    { .name = "degrees", ANGLE, 0, .times = DEM_PI, .by = 180.0 },
    { .name = "deg", ANGLE, 0, .times = DEM_PI, .by = 180.0 },
    { .name = "°", ANGLE, 0, .times = DEM_PI, .by = 180.0 },
    { .name = "revolutions", ANGLE, 0, .times = 2.0 * DEM_PI },
    { .name = "rev", ANGLE, 0, .times = 2.0 * DEM_PI },
    { .name = "N/m", STIFFNESS, 0 },
    { .name = "kN/m", STIFFNESS, 3 },
    { .name = "N/mm", STIFFNESS, 3 },
    { .name = "N/cm", STIFFNESS, 2 },
    { .name = "mN/m", STIFFNESS, -3 },
    { .name = "J/m2", STIFFNESS, 0 }, /* a surface energy, which is a surface tension */
    { .name = "mJ/m2", STIFFNESS, -3 },
    { .name = "Pa", PRESSURE, 0 },
    { .name = "kPa", PRESSURE, 3 },
    { .name = "MPa", PRESSURE, 6 },
    { .name = "GPa", PRESSURE, 9 },
    { .name = "N/mm2", PRESSURE, 6 },
    { .name = "bar", PRESSURE, 5 },
    { .name = "J/m3", PRESSURE, 0 },
    { .name = "kJ/m3", PRESSURE, 3 },
    { .name = "N", FORCE, 0 },
    { .name = "mN", FORCE, -3 },
    { .name = "uN", FORCE, -6 },
    { .name = "m3", VOLUME, 0 },
    { .name = "mm3", VOLUME, -9 },
    { .name = "ml", VOLUME, -6 },
    { .name = "ul", VOLUME, -9 },
    { .name = "nl", VOLUME, -12 },
    { .name = "1/m", INVERSE_LENGTH, 0 },
    { .name = "1/cm", INVERSE_LENGTH, 2 },
    { .name = "1/mm", INVERSE_LENGTH, 3 },
    { .name = "", PURE, 0 },
    { .name = "1", PURE, 0 },
    { .name = "%", PURE, -2 },
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

const char *unit_usual(const spec_field *field)
{
    const unit *own = own_unit(field);
    for (size_t u = 0; u < unit_count; u++)
        if (units[u].is_usual && is_allowed(field, own, &units[u])) return units[u].name;
    return field->unit;
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
