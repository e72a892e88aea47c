/* What flows out of a vessel: frames, the steady part and its error, and when it ended. */
#include <math.h>
#include <string.h>

#include "array.h"
#include "dem_flow.h"
#include "dem_rules.h"
#include "drained.h"
#include "measure.h"
#include "statistics.h"

enum flow_column { FLOW_TIME, FLOW_PASSED, FLOW_MASS, FLOW_LEVEL, FLOW_SOLID, FLOW_ENERGY, FLOW_HELD, FLOW_AT_REST, FLOW_TENSION };

const char *dem_flow_frame_name(size_t index)
{
    static const char *const name[DEM_FLOW_FRAME] = {
        "time", "passed", "passed_mass", "level", "solid_fraction", "kinetic_energy", "over_orifice", "at_rest", "tension_share",
    };
    return index < DEM_FLOW_FRAME ? name[index] : NULL;
}

static const double REST = 1e-4; /* of the energy that a fall through one diameter would give */
/* In sqrt(D/g), the time in which a particle falls through the orifice: after opening, until the flow is steady; without a passage,
 * until it has ended; of an interval that the number flow fluctuates over. */
static const double TRANSIENT = 5, WAIT = 10;
static const double WAIT_OF_INTERVALS = 20; /* mean times between two passages, likewise */
static const double LEAST_LEVEL = 2.5;      /* in D: a lower bed flows more slowly */
enum { FRAMES_AT_REST = 3, LEAST_BATCHES = 8, MOST_BATCHES = 20, LEAST_OF_A_BATCH = 5 };

static double fall_time(const dem_scene *scene) { return sqrt(scene->definition.orifice.opening / scene->definition.gravity); }

double distance_from_middle(const dem_scene *scene, const double x[3])
{
    return scene->container.half_depth > 0 ? fabs(x[0]) : sqrt(x[0] * x[0] + x[1] * x[1]);
}

/* Of its motion alone: nothing slows the spin of a sphere about the normal of the floor that it lies on. */
static double energy_of(const spheres *s, size_t p)
{
    const vector4 v = p < s->single_count ? s->velocity[p] : s->clusters.body[p - s->single_count].velocity;
    return 0.5 * particle_mass(s, p) * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* Would fall through the orifice if nothing held it: its shadow is within, or the middle of a narrow one is beneath its centre. */
static bool is_over_orifice(const dem_scene *scene, size_t p)
{
    const double half = 0.5 * scene->definition.orifice.opening;
    return distance_from_middle(scene, particle_place(&scene->spheres, p))
           < fmax(half - particle_reach(&scene->spheres, p), 0.5 * half);
}

static double top_over_orifice(const dem_scene *scene)
{
    const spheres *s = &scene->spheres;
    double top = 0;
    for (size_t i = 0; i < s->mobile_count; i++)
        if (distance_from_middle(scene, sphere_place(s, i)) < 0.5 * scene->definition.orifice.opening)
            top = fmax(top, sphere_place(s, i)[2] + sphere_radius(s, i));
    return top;
}

/* Share of a ball's volume below a plane `h` above its centre. */
static double share_below(double h, double radius)
{
    const double t = fmin(fmax(h / radius, -1.0), 1.0);
    return 0.25 * (1 + t) * (1 + t) * (2 - t);
}

/* Over the whole section, from two grains above the orifice to two grains below the level. */
static double solid_below(const dem_scene *scene, double level)
{
    const spheres *s = &scene->spheres;
    const double grain = cbrt(6 / DEM_PI * dem_mean_volume(scene->definition.species, scene->definition.species_count));
    const double low = 2 * grain, high = level - 2 * grain;
    double solid = 0;
    if (!(high > low + grain)) return NAN;
    for (size_t i = 0; i < s->mobile_count; i++) {
        const double z = sphere_place(s, i)[2], r = sphere_radius(s, i);
        solid += volume_of_sphere(scene, i) * (share_below(high - z, r) - share_below(low - z, r));
    }
    return solid / (container_volume_below(&scene->container, high) - container_volume_below(&scene->container, low));
}

dem_status dem_flow_frame_measure(dem_scene *scene, double *frame)
{
    const spheres *s = &scene->spheres;
    double energy = 0, weight = 0, mass = 0, held = 0;
    for (size_t p = 0; p < particles_count(s); p++) {
        if (particle_is_lost(scene, p)) {
            mass += particle_mass(s, p);
            continue;
        }
        energy += energy_of(s, p);
        weight += particle_mass(s, p) * scene->definition.gravity;
        held += is_over_orifice(scene, p);
    }
    const double level = top_over_orifice(scene);
    frame[FLOW_TIME] = dem_scene_time(scene);
    frame[FLOW_PASSED] = (double)scene->lost_count;
    frame[FLOW_MASS] = mass;
    frame[FLOW_LEVEL] = level;
    frame[FLOW_SOLID] = solid_below(scene, level);
    frame[FLOW_ENERGY] = energy;
    frame[FLOW_HELD] = held;
    frame[FLOW_AT_REST] = energy <= REST * weight * s->smallest_diameter;
    frame[FLOW_TENSION] = measure_tension_share(scene);
    return DEM_OK;
}

/* ---- the end ---- */

static const double *frame_at(const double *frames, size_t k) { return frames + k * DEM_FLOW_FRAME; }

/* The first frame that has all that ever passed. */
static size_t last_passage(const double *frames, size_t count)
{
    size_t k = count - 1;
    while (k > 0 && frame_at(frames, k - 1)[FLOW_PASSED] == frame_at(frames, count - 1)[FLOW_PASSED]) k--;
    return k;
}

dem_flow_end dem_flow_ended(const dem_scene *scene, const double *frames, size_t count)
{
    if (count < FRAMES_AT_REST) return DEM_FLOWS_ON;
    const double *now = frame_at(frames, count - 1), *last = frame_at(frames, last_passage(frames, count));
    const double interval = now[FLOW_PASSED] > 0 ? last[FLOW_TIME] / now[FLOW_PASSED] : 0;
    if (now[FLOW_PASSED] == (double)particles_count(&scene->spheres)) return DEM_FLOW_DRAINED;
    if (now[FLOW_TIME] - last[FLOW_TIME] < fmax(WAIT * fall_time(scene), WAIT_OF_INTERVALS * interval)) return DEM_FLOWS_ON;
    for (size_t k = count - FRAMES_AT_REST; k < count; k++)
        if (frame_at(frames, k)[FLOW_AT_REST] == 0) return DEM_FLOWS_ON;
    return now[FLOW_HELD] > 0 ? DEM_FLOW_CLOGGED : DEM_FLOW_DRAINED;
}

/* ---- the steady part ---- */

bool dem_flow_is_steady(const dem_scene *scene, const double *frame)
{
    return frame[FLOW_TIME] >= TRANSIENT * fall_time(scene) && frame[FLOW_LEVEL] >= LEAST_LEVEL * scene->definition.orifice.opening;
}

/* Passages up to a time between frames: the line from one to the next. */
static double passed_at(const double *frames, size_t count, double time, enum flow_column column)
{
    size_t k = 1;
    while (k + 1 < count && frame_at(frames, k)[FLOW_TIME] < time) k++;
    const double *a = frame_at(frames, k - 1), *b = frame_at(frames, k);
    return a[column] + (b[column] - a[column]) * (time - a[FLOW_TIME]) / (b[FLOW_TIME] - a[FLOW_TIME]);
}

/* Means and their error from so many parts of equal length, which are long beside what the flow remembers. */
static dem_mean mean_of_batches(const double *frames, size_t count, const dem_flow_results *r, size_t batches,
                                enum flow_column column)
{
    double rate[MOST_BATCHES] = { 0 };
    const double length = (r->steady_end - r->steady_start) / (double)batches;
    for (size_t b = 0; b < batches; b++) {
        const double from = r->steady_start + (double)b * length;
        rate[b] = (passed_at(frames, count, from + length, column) - passed_at(frames, count, from, column)) / length;
    }
    dem_mean mean = { statistics_mean(rate, batches), NAN };
    if (batches >= LEAST_BATCHES) mean.standard_error = statistics_deviation(rate, batches) / sqrt((double)batches);
    return mean;
}

static dem_status measure_fluctuation(const double *frames, size_t count, double interval, dem_flow_results *r)
{
    const size_t n = (size_t)((r->steady_end - r->steady_start) / interval);
    double *rate = array_create(n + 1, sizeof *rate);
    if (!rate) return DEM_NO_MEMORY;
    for (size_t k = 0; k < n; k++) {
        const double from = r->steady_start + (double)k * interval;
        rate[k] = (passed_at(frames, count, from + interval, FLOW_PASSED) - passed_at(frames, count, from, FLOW_PASSED)) / interval;
    }
    if (n >= LEAST_BATCHES) r->number_fluctuation = statistics_deviation(rate, n);
    free(rate);
    return DEM_OK;
}

/* From when the first transient is over to when the level over the orifice is low, or the last particle left. */
static dem_status measure_steady(const dem_scene *scene, const double *frames, size_t count, dem_flow_results *r)
{
    const double unit = fall_time(scene);
    size_t from = 0, to = 0;
    while (from < count && !dem_flow_is_steady(scene, frame_at(frames, from))) from++;
    for (to = from; to < count && dem_flow_is_steady(scene, frame_at(frames, to));) to++;
    const size_t last = last_passage(frames, count);
    if (dem_flow_ended(scene, frames, count) != DEM_FLOWS_ON && to > last) to = last;
    if (to <= from + 1) return DEM_OK;
    const frame_window steady = { frame_at(frames, from), to - from, DEM_FLOW_FRAME };
    r->tension_share = frame_window_mean(&steady, FLOW_TENSION);
    r->steady_start = frame_at(frames, from)[FLOW_TIME];
    r->steady_end = frame_at(frames, to - 1)[FLOW_TIME];
    const double passed = frame_at(frames, to - 1)[FLOW_PASSED] - frame_at(frames, from)[FLOW_PASSED];
    const double most = fmin((r->steady_end - r->steady_start) / (2 * unit), passed / LEAST_OF_A_BATCH);
    const size_t batches = (size_t)fmin(fmax(floor(most), 1.0), MOST_BATCHES);
    r->batches = (double)batches;
    r->mass_rate = mean_of_batches(frames, count, r, batches, FLOW_MASS);
    r->number_rate = mean_of_batches(frames, count, r, batches, FLOW_PASSED);
    return measure_fluctuation(frames, count, unit, r);
}

static void set_nothing_known(dem_flow_results *r)
{
    memset(r, 0, sizeof *r);
    r->mass_rate = r->number_rate = (dem_mean){ NAN, NAN };
    r->number_fluctuation = r->steady_start = r->steady_end = r->clogged_at = r->last_left_at = r->solid_fraction =
        r->tension_share = NAN;
    r->drained_angle_deg[0] = r->drained_angle_deg[1] = NAN;
}

dem_status dem_flow_measure(const dem_scene *scene, const double *frames, size_t count, dem_flow_results *r)
{
    arrays_begin();
    set_nothing_known(r);
    r->left = particles_count(&scene->spheres);
    if (count == 0) return arrays_end(DEM_OK);
    const double *now = frame_at(frames, count - 1);
    const dem_flow_end end = dem_flow_ended(scene, frames, count);
    r->passed = scene->lost_count;
    r->left -= r->passed;
    for (size_t p = 0; p < particles_count(&scene->spheres); p++) {
        const double mass = particle_mass(&scene->spheres, p);
        if (particle_is_lost(scene, p)) r->passed_mass += mass;
        else r->drained_volume += mass / scene->definition.species[particle_species(&scene->spheres, p)].density;
    }
    r->at_rest = now[FLOW_AT_REST] != 0;
    r->clogged = end == DEM_FLOW_CLOGGED;
    r->drained = end == DEM_FLOW_DRAINED;
    r->solid_fraction = frame_at(frames, 0)[FLOW_SOLID];
    const double last = frame_at(frames, last_passage(frames, count))[FLOW_TIME];
    if (r->passed > 0) r->last_left_at = last;
    if (r->clogged) r->clogged_at = last;
    dem_status status = measure_steady(scene, frames, count, r);
    if (status == DEM_OK && r->drained) status = drained_measure(scene, r->drained_angle_deg);
    return arrays_end(status);
}
