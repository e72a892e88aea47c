/* Claims about the measures of heaps and beds in cylinders: mounds of small spheres whose shapes are known beforehand. */
#include "core_claims.h"
#include "dem_mound.h"

#define GRAIN 1.0
#define RADIUS 0.25 /* of the spheres that the surfaces are strewn with */

typedef struct strewn {
    double *position, *radius, *volume;
    size_t count, room;
} strewn;

static void strew_init(strewn *s, size_t room)
{
    *s = (strewn){ malloc(3 * room * sizeof(double)), malloc(room * sizeof(double)), malloc(room * sizeof(double)), 0, room };
    assert_true(s->position && s->radius && s->volume);
}

static void strew_clear(strewn *s)
{
    free(s->position);
    free(s->radius);
    free(s->volume);
}

static void strew_one(strewn *s, double x, double y, double z, double radius)
{
    assert_true(s->count < s->room);
    memcpy(s->position + 3 * s->count, (double[3]){ x, y, z }, 3 * sizeof(double));
    s->radius[s->count] = radius;
    s->volume[s->count++] = 4.0 / 3.0 * M_PI * radius * radius * radius;
}

/* Tops at height(r, azimuth), where that is above the ground: a sphere every eighth of a grain. */
static void strew_surface(strewn *s, double half_width, double (*height)(double r, double azimuth))
{
    const double spacing = GRAIN / 8;
    const int n = (int)(half_width / spacing);
    strew_init(s, (size_t)(4 * n * n));
    for (int a = -n; a < n; a++)
        for (int b = -n; b < n; b++) {
            const double x = (a + 0.5) * spacing, y = (b + 0.5) * spacing, r = sqrt(x * x + y * y);
            const double h = height(r, atan2(y, x));
            if (r < half_width && h > 0) strew_one(s, x, y, h - RADIUS, RADIUS);
        }
}

static dem_mound mound_of(const strewn *s) { return (dem_mound){ s->count, s->position, s->radius, s->volume, GRAIN }; }

static double radians(double degrees) { return degrees * M_PI / 180; }

#define CONE_RADIUS 14.0
static double cone_angle;
static double cone(double r, double azimuth) { return (void)azimuth, (CONE_RADIUS - r) * tan(radians(cone_angle)); }
/* The steepest surface is raised where spheres of finite size roll over it: R/cos above their centres, R above tops. */
static double raised(double angle) { return RADIUS * (1 / cos(radians(angle)) - 1); }

static void a_cone_has_its_angle_under_every_definition(void **state)
{
    (void)state;
    const double angles[] = { 8, 20, 35 };
    for (int k = 0; k < 3; k++) {
        strewn s;
        dem_heap_results heap;
        cone_angle = angles[k];
        strew_surface(&s, CONE_RADIUS, cone);
        const dem_mound mound = mound_of(&s);
        assert_int_equal(dem_heap_measure(&mound, 20, 0, &heap), DEM_OK);
        const double slope = tan(radians(cone_angle)), top = CONE_RADIUS * slope;
        /* Along the flank the surface is a plane's; what is left is the cells' and the spheres' unevenness, 1/30 of a
         * grain over a flank of 8 grains, some 0.3 degrees at the worst and far less by least squares. */
        CHECK_NEAR(heap.angle[DEM_AZIMUTHAL_FIT].mean_deg, cone_angle, 0.1);
        CHECK_BETWEEN(heap.angle[DEM_AZIMUTHAL_FIT].standard_error_deg, 0, 0.1);
        CHECK_NEAR(heap.height, top, 0.1 * slope); /* no sphere stands right at the apex */
        /* The base ends where the surface is half a grain high; a ring's interpolation is off by a tenth of a grain where
         * the outermost is half empty. */
        const double base = CONE_RADIUS - (0.5 * GRAIN - raised(cone_angle)) / slope;
        CHECK_NEAR(0.5 * heap.base_diameter, base, 0.25);
        /* That cone, from half a grain up, has the flank's slope under every definition; of 8 degrees the base is known to
         * a fortieth, as is the angle. */
        CHECK_NEAR(heap.angle[DEM_APEX_TO_BASE].mean_deg, cone_angle, 0.025 * cone_angle);
        CHECK_NEAR(heap.angle[DEM_EQUAL_VOLUME].mean_deg, cone_angle, 0.05 * cone_angle);
        CHECK_NEAR(heap.angle[DEM_SILHOUETTE].mean_deg, cone_angle, 0.05 * cone_angle);
        CHECK_BETWEEN(heap.static_cohesive_index, 0, 0.1);
        strew_clear(&s);
    }
}

/* Of several radii: the mean of sixteen equal numbers is not always that number, to the last bit. */
static void a_heap_that_covers_its_plate_says_nothing_of_the_error_of_its_base(void **state)
{
    (void)state;
    const double plates[] = { 5.1, 6.3, 7.7 };
    strewn s;
    cone_angle = 20;
    strew_surface(&s, CONE_RADIUS, cone);
    const dem_mound mound = mound_of(&s);
    for (int k = 0; k < 3; k++) {
        dem_heap_results heap;
        assert_int_equal(dem_heap_measure(&mound, plates[k], 0, &heap), DEM_OK);
        CHECK_NEAR(0.5 * heap.base_diameter, plates[k], 1e-12);
        assert_true(heap.angle[DEM_APEX_TO_BASE].mean_deg > 0 && isnan(heap.angle[DEM_APEX_TO_BASE].standard_error_deg));
    }
    strew_clear(&s);
}

/* Half of the azimuths at 20 degrees, half at 30: each sector has its own. */
static double lopsided(double r, double azimuth) { return 8 - r * tan(radians(azimuth > 0 ? 20 : 30)); }

static void the_standard_error_tells_a_lopsided_heap(void **state)
{
    (void)state;
    strewn s;
    dem_heap_results heap;
    strew_surface(&s, 25, lopsided);
    const dem_mound mound = mound_of(&s);
    assert_int_equal(dem_heap_measure(&mound, 26, 0, &heap), DEM_OK);
    const dem_angle angle = heap.angle[DEM_AZIMUTHAL_FIT];
    CHECK_NEAR(angle.minimum_deg, 20, 0.5);
    CHECK_NEAR(angle.maximum_deg, 30, 0.5);
    CHECK_NEAR(angle.mean_deg, 25, 0.3);
    /* 5 degrees of deviation over 16 azimuths make 1.25 degrees if they were independent; they are not. */
    CHECK_BETWEEN(angle.standard_error_deg, 1.2, 5);
    /* At half the lesser base the two heights differ by 6 (tan 30 - tan 20) = 1.28: half of that is the deviation. */
    CHECK_BETWEEN(heap.static_cohesive_index, 0.5, 1.5);
    strew_clear(&s);
}

#define TOP_RADIUS 6.0
static double truncated(double r, double azimuth)
{
    (void)azimuth;
    return (CONE_RADIUS - fmax(r, TOP_RADIUS)) * tan(radians(30));
}

static void a_flat_top_is_told_by_what_the_definitions_differ_in(void **state)
{
    (void)state;
    strewn s;
    dem_heap_results heap;
    strew_surface(&s, CONE_RADIUS, truncated);
    const dem_mound mound = mound_of(&s);
    assert_int_equal(dem_heap_measure(&mound, 20, 0, &heap), DEM_OK);
    /* The flank keeps its slope; the cone of the same height and base is flatter. */
    CHECK_NEAR(heap.angle[DEM_AZIMUTHAL_FIT].mean_deg, 30, 0.2);
    const double height = (CONE_RADIUS - TOP_RADIUS) * tan(radians(30)), base = CONE_RADIUS - 0.5 / tan(radians(30));
    CHECK_NEAR(heap.angle[DEM_APEX_TO_BASE].mean_deg, atan((height - 0.5) / base) * 180 / M_PI, 0.8);
    /* The mean height over the base: of the top, and of the flank from there on. */
    const double slope = tan(radians(30)), top2 = TOP_RADIUS * TOP_RADIUS;
    const double flank = slope * (CONE_RADIUS * (base * base - top2) - 2.0 / 3.0 * (base * base * base - top2 * TOP_RADIUS));
    const double mean = (height * top2 + flank) / (base * base) - 0.5;
    CHECK_NEAR(heap.angle[DEM_EQUAL_VOLUME].mean_deg, atan(3 * mean / base) * 180 / M_PI, 0.6);
    strew_clear(&s);
}

/* The bare plate has no part in any measure, but for the rings of the profile that lie on it. */
static void a_plate_of_any_width_has_the_same_heap(void **state)
{
    (void)state;
    strewn s;
    dem_heap_results narrow, wide;
    cone_angle = 20;
    strew_surface(&s, CONE_RADIUS, cone);
    const dem_mound mound = mound_of(&s);
    assert_int_equal(dem_heap_measure(&mound, 20, 0, &narrow), DEM_OK);
    const double radii[] = { 100, 1000, 1e6, 1e9 }; /* of the last two, the cells of all of the plate would fill no machine */
    for (int k = 0; k < 4; k++) {
        assert_int_equal(dem_heap_measure(&mound, radii[k], 0, &wide), DEM_OK);
        for (int m = 0; m < DEM_HEAP_METHODS; m++) CHECK_NEAR(wide.angle[m].mean_deg, narrow.angle[m].mean_deg, 0.2);
        CHECK_NEAR(wide.base_diameter, narrow.base_diameter, 0.1);
        CHECK_NEAR(wide.volume / narrow.volume, 1, 0.002);
        CHECK_NEAR(wide.height, narrow.height, 1e-12);
        CHECK_BETWEEN(wide.surface.place[wide.surface.count - 1], CONE_RADIUS, 128);
        CHECK_NEAR(wide.surface.value[wide.surface.count - 1], 0, 0);
    }
    strew_clear(&s);
}

static double flat(double r, double azimuth) { return (void)r, (void)azimuth, 1.5; }

static void a_few_grains_have_no_angle(void **state)
{
    (void)state;
    strewn s;
    dem_heap_results heap;
    strew_surface(&s, 1, flat);
    const dem_mound mound = mound_of(&s);
    assert_int_equal(dem_heap_measure(&mound, 20, 0, &heap), DEM_OK);
    assert_true(isnan(heap.angle[DEM_AZIMUTHAL_FIT].mean_deg));
    const dem_mound none = { 0, NULL, NULL, NULL, GRAIN };
    assert_int_equal(dem_heap_measure(&none, 20, 0, &heap), DEM_OK);
    assert_true(isnan(heap.angle[DEM_AZIMUTHAL_FIT].mean_deg) && isnan(heap.angle[DEM_APEX_TO_BASE].mean_deg));
    assert_true(heap.height == 0);
    strew_clear(&s);
}

/* ---- cylinders ---- */

#define CYLINDER 10.0
static double fill_angle;
static double sloped(double r, double azimuth) { return (void)azimuth, 12 - r * tan(radians(fill_angle)); }

static void a_bed_in_a_cylinder_has_its_slope_up_or_down(void **state)
{
    (void)state;
    const double angles[] = { 0, 15, -25 };
    for (int k = 0; k < 3; k++) {
        strewn s;
        dem_fill_results fill;
        fill_angle = angles[k];
        strew_surface(&s, CYLINDER, sloped);
        const dem_mound mound = mound_of(&s);
        assert_int_equal(dem_fill_measure(&mound, CYLINDER, &fill), DEM_OK);
        /* as for the cone; the apex is rounded over a quarter of a grain, which the first leaves out */
        CHECK_NEAR(fill.angle[DEM_RADIAL_FIT].mean_deg, fill_angle, 0.1);
        CHECK_NEAR(fill.angle[DEM_CENTER_TO_WALL].mean_deg, fill_angle, 0.3);
        CHECK_NEAR(fill.angle[DEM_AREA_FIT].mean_deg, fill_angle, 0.2);
        CHECK_BETWEEN(fill.angle[DEM_RADIAL_FIT].standard_error_deg, 0, 0.1);
        /* up to half a grain off the wall the mean distance is 2/3 of that */
        CHECK_NEAR(fill.height, 12 + raised(fill_angle) - 2.0 / 3.0 * (CYLINDER - 0.5) * tan(radians(fill_angle)), 0.05);
        for (size_t p = 0; p < fill.surface.count; p++) {
            /* the mean over a ring of width w about r is that at r + w^2/(12 r) */
            const double expected = 12 + raised(fill_angle) - fill.surface.place[p] * tan(radians(fill_angle));
            CHECK_NEAR(fill.surface.value[p], expected, p == 0 ? 0.15 : 0.07);
        }
        strew_clear(&s);
    }
}

/* Spheres one grain wide on a cubic lattice: pi/6 of solid. */
static void a_lattice_has_its_solid_fraction(void **state)
{
    (void)state;
    strewn s;
    dem_fill_results fill;
    strew_init(&s, 40 * 40 * 20);
    for (int a = -19; a < 20; a++)
        for (int b = -19; b < 20; b++)
            for (int c = 0; c < 20; c++)
                if (hypot(a, b) + 0.5 <= 18) strew_one(&s, a, b, c + 0.5, 0.5);
    const dem_mound mound = mound_of(&s);
    assert_int_equal(dem_fill_measure(&mound, 18, &fill), DEM_OK);
    /* The core's round edge cuts 100 spheres a layer of 800: each counted by points, off by some 10 % of itself at
     * random, in all by 0.1 %; lattice points in a circle of 16 differ from its area by up to 1 %. */
    CHECK_NEAR(fill.solid_fraction, M_PI / 6, 0.012 * M_PI / 6);
    assert_int_equal(fill.packing.count, 20);
    /* Slabs are layers of the lattice: all of the spheres in the cylinder over its section. */
    const double layer = (double)s.count / 20 * (M_PI / 6) / (M_PI * 18 * 18);
    for (size_t k = 0; k < 20; k++) CHECK_NEAR(fill.packing.value[k], layer, 1e-12);
    strew_clear(&s);
}

UNIT_TESTS(a_cone_has_its_angle_under_every_definition, a_heap_that_covers_its_plate_says_nothing_of_the_error_of_its_base,
           the_standard_error_tells_a_lopsided_heap, a_flat_top_is_told_by_what_the_definitions_differ_in,
           a_plate_of_any_width_has_the_same_heap, a_few_grains_have_no_angle, a_bed_in_a_cylinder_has_its_slope_up_or_down,
           a_lattice_has_its_solid_fraction)
