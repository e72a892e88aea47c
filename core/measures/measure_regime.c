/* The flow regime, told from the motion. The thresholds and the runs that they were chosen on: core/NUMERICS.md,
 * "Regimes". */
#include "dem_rules.h"
#include "density_grid.h"
#include "measure.h"
#include "regime_map.h"
#include "statistics.h"

/* Radius of the inner surface that the bed would have spread evenly over the wall. */
static double inner_radius(const dem_scene *scene)
{
    return scene->container.radius * sqrt(fmax(0.0, 1 - scene->definition.fill_fraction));
}

/* Share of the cross-section that the bed takes up. Clusters pack looser, each shape in its own way, than the solid
 * fraction by which a fill is counted. */
static double bed_fill(const dem_scene *scene, double solid_fraction)
{
    const double fill = scene->definition.fill_fraction;
    return scene->spheres.clusters.count && solid_fraction > 0 ? fill * DEM_BED_SOLID_FRACTION / solid_fraction : fill;
}

typedef struct mean {
    double sum, count;
} mean;

static void mean_add(mean *m, double x)
{
    m->sum += x;
    m->count += 1;
}

static double mean_of(const mean *m) { return m->count > 0 ? m->sum / m->count : NAN; }

enum { WALL_BINS = 72 };

/* Sectors of the wall, none narrower than a diameter: a full layer leaves some of those empty. */
static int wall_bins(double radius, double d) { return (int)fmin(fmax(floor(2 * DEM_PI * radius / d), 8), WALL_BINS); }

static double share_of_bins(const bool *bins, int count)
{
    int covered = 0;
    for (int b = 0; b < count; b++) covered += bins[b];
    return covered / (double)count;
}

/* Slip of the bed's inner surface against the drum, rad a revolution. It is the mean over the spheres that were within d of the
 * surface when a revolution began, followed through that revolution. A sphere that falls from the surface goes on to count,
 * and one that comes there later does not count yet: of the spheres that are there at one moment, too many are falling. Until
 * the first revolution is over, the mean is over the part that there has been. Azimuths are in the frame of the drum; a lag of
 * less than half a turn between two calls is told from a lead. */
static double surface_lag(dem_scene *scene, double inner, double d)
{
    spheres *s = &scene->spheres;
    surface_meter *meter = &scene->surface;
    const bool has_stages = scene->definition.stage_count > 0;
    const double rate = scene->container.rotation_rate, time = dem_scene_time(scene);
    double stage_began;
    dem_stage_at(&scene->definition, time, &stage_began);
    if (has_stages && meter->since < stage_began) *meter = (surface_meter){ NAN, NAN };
    const double azimuth = has_stages ? scene->container.angle : rate * time, turned = rate * (time - meter->since);
    const bool begins = !(fabs(turned) < 2 * DEM_PI * (1 - 1e-9)); /* also where none has yet */
    mean way = { 0 };
    for (size_t i = 0; i < s->mobile_count; i++) {
        const double *x = sphere_place(s, i), angle = remainder(atan2(x[1], x[0]) - azimuth, 2 * DEM_PI);
        surface_track *track = &s->surface_track[i];
        const double further = angle - (double)track->angle;
        track->angle = (float)angle;
        track->way += (float)remainder(further, 2 * DEM_PI);
        if (!isnan(track->way)) mean_add(&way, (double)track->way);
        if (begins) track->way = fabs(hypot(x[0], x[1]) - inner) < d ? 0 : NAN;
    }
    const double lag = -2 * DEM_PI * mean_of(&way) / turned;
    if (begins) *meter = (surface_meter){ time, isnan(meter->since) ? NAN : lag };
    return isnan(meter->lag) ? lag : meter->lag;
}

void measure_regime_frame(dem_scene *scene, const int32_t *contacts, double *frame)
{
    spheres *s = &scene->spheres;
    const double d = mean_diameter(scene), rate = scene->container.rotation_rate, time = dem_scene_time(scene);
    const double wall = scene->container.inner_radius, inner = inner_radius(scene);
    const double angle = frame[FRAME_SURFACE_FIT] * (DEM_PI / 180), c = cos(angle), sine = sin(angle);
    /* The chord that the fill makes in the frame of the surface: in flight is what is well above it without contact. */
    const double chord = dem_circle_level(fmin(bed_fill(scene, frame[FRAME_SOLID_FRACTION]), 1.0)) * scene->container.radius;
    const double sense = rate < 0 ? -1 : 1; /* in which the surface rises */
    mean wall_spin = { 0 }, flow = { 0 }, airborne = { 0 };
    bool bins[WALL_BINS] = { false };
    const int bin_count = wall_bins(wall, d);
    for (size_t i = 0; i < s->mobile_count; i++) {
        const double *x = sphere_place(s, i);
        const vector4 v = s->velocity[i];
        const double rho2 = x[0] * x[0] + x[1] * x[1], rho = sqrt(rho2);
        const double spin = (x[0] * v[1] - x[1] * v[0]) / fmax(rho2, 1e-300);
        const double above_chord = c * x[1] - sine * x[0] - chord;
        mean_add(&airborne, contacts[i] == 0 && above_chord > 3 * d);
        if (rho > wall - d) {
            if (!(above_chord > -3 * d)) mean_add(&wall_spin, spin); /* the bed's own, not what falls at its ends */
            bins[(int)((atan2(x[1], x[0]) / (2 * DEM_PI) + 0.5) * (bin_count - 1e-9))] = true;
        }
        if (rho < inner - 2 * d) s->fallen_time[i] = (float)time;
        /* Flow of the layer at the middle of the chord: downslope speed, over all that is there. What moves with the drum
         * counts as 0, so that a bed at rest has a flow, too: none. */
        const double along = c * x[0] + sine * x[1], downslope = sense * -(c * v[0] + sine * v[1]);
        if (fabs(along) < 0.25 * scene->container.radius) mean_add(&flow, fmax(downslope, 0.0));
    }
    frame[FRAME_AIRBORNE] = mean_of(&airborne);
    frame[FRAME_WALL_SLIP] = rate != 0 ? 1 - mean_of(&wall_spin) / rate : NAN;
    frame[FRAME_WALL_COVERAGE] = share_of_bins(bins, bin_count);
    frame[FRAME_FLOW_SPEED] = mean_of(&flow);
    frame[FRAME_SURFACE_LAG] = rate != 0 ? surface_lag(scene, inner, d) : NAN;
}

/* Share of particles seen nearer the axis than R_i - 2d since then. Who fell in a stage is not remembered beyond it. */
static double fallen_fraction(const dem_scene *scene, double since)
{
    if (scene->definition.stage_count > 0) return NAN;
    double fallen = 0.0;
    for (size_t i = 0; i < scene->spheres.mobile_count; i++) fallen += scene->spheres.fallen_time[i] >= (float)since;
    return fallen / (double)scene->spheres.mobile_count;
}

/* Fast beds take revolutions to form: they are judged by the last four (or the window, if shorter). */
static frame_window last_revolutions(const dem_scene *scene, const frame_window *window, double *since)
{
    const double revolution = 2 * DEM_PI / fabs(scene->definition.rotation_rate);
    const double end = fmin(window->frames[(window->count - 1) * window->width + FRAME_TIME], dem_scene_time(scene));
    *since = fmax(window->frames[FRAME_TIME], end - 4 * revolution);
    frame_window last = *window;
    while (last.count > 1 && last.frames[FRAME_TIME] < *since) {
        last.frames += last.width;
        last.count--;
    }
    return last;
}

/* A bed spread over the whole wall: raining, sliding or centrifuging. */
static dem_regime fast_regime(const dem_regime_result *r)
{
    if (r->fallen_fraction > 0.02) return DEM_RAINING;
    return r->surface_lag < 0.03 ? DEM_CENTRIFUGING : DEM_SLIDING;
}

static dem_regime slow_regime(const dem_regime_result *r)
{
    /* Thrown clear of the bed: particles in flight. */
    if (r->airborne_fraction > 0.002) return DEM_CATARACTING;
    /* The bed as a whole moves against the wall: in jerks, or at a steady pace. One that slides back as far as it was carried
     * slips by 1 in the mean; avalanches shake the wall's layer, too, which against a slow drum is much, but not in the mean. */
    if (r->wall_slip > 0.3) return r->wall_slip_fluctuation > 0.2 && r->angle_fluctuation_deg > 1.5 ? DEM_SLUMPING : DEM_SLIPPING;
    /* The bed follows the wall, its surface flows: all the time, or in avalanches. */
    if (r->flow_fluctuation > 0.5) return DEM_AVALANCHING;
    return r->curvature_deg > 12 ? DEM_CASCADING : DEM_ROLLING;
}

void measure_regime_results(const dem_scene *scene, const frame_window *window, const dem_repose_result *repose,
                            dem_regime_result *r)
{
    const double rate = scene->definition.rotation_rate, g = scene->definition.gravity * scene->container.up[1];
    r->omega2_outer = rate * rate * scene->container.radius / g;
    r->omega2_inner = rate * rate * inner_radius(scene) / g;
    const double tangent = tan(repose->angle[DEM_SURFACE_FIT].mean_deg * (DEM_PI / 180));
    r->predicted_stationary = regime_map_stationary(tangent);
    r->predicted_sliding_eq35 = regime_map_sliding_eq34(tangent);
    r->predicted_sliding_eq36 = regime_map_sliding_eq36(tangent);
    r->wall_slip = frame_window_mean(window, FRAME_WALL_SLIP);
    r->wall_slip_fluctuation = frame_window_deviation(window, FRAME_WALL_SLIP);
    r->angle_fluctuation_deg = frame_window_deviation(window, FRAME_CENTER_OF_MASS);
    r->flow_fluctuation = frame_window_deviation(window, FRAME_FLOW_SPEED) / frame_window_mean(window, FRAME_FLOW_SPEED);
    r->airborne_fraction = frame_window_mean(window, FRAME_AIRBORNE);
    r->curvature_deg = frame_window_mean(window, FRAME_UPPER_CHORD) - frame_window_mean(window, FRAME_LOWER_CHORD);
    double since;
    const frame_window last = last_revolutions(scene, window, &since);
    r->fallen_fraction = fallen_fraction(scene, since);
    r->surface_lag = frame_window_mean(&last, FRAME_SURFACE_LAG);
    r->wall_coverage = frame_window_mean(&last, FRAME_WALL_COVERAGE);
    const bool is_fast = r->wall_coverage > 0.95 && r->omega2_outer > 1;
    r->regime = is_fast ? fast_regime(r) : slow_regime(r);
    r->is_told = is_fast ? !isnan(r->fallen_fraction) && particles_count(&scene->spheres) >= DEM_LEAST_BED_PARTICLES
                         : measure_has_bed(scene);
}
