#include "start_rules.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "dem_cluster.h"
#include "dem_rules.h"
#include "job_id.h"
#include "process_type.h"
#include "spec_memory.h"
#include "spec_text.h"
#include "start_overlap.h"

/* Of the smaller diameter: as far as spheres may overlap when a run begins, the most that maximum_overlap can ask for. */
#define MOST_START_OVERLAP 0.05
#define COINCIDING 0.99 /* of it: so much is all of it */
enum { ENOUGH_OVERLAPS = 20 };
#define AN_ID "20261122-014455-3f9a2c71"

/* --- which bed --- */

/* Whether anything in start is wrong already. */
static bool is_refused(const problem_list *problems)
{
    size_t index;
    json_t *error;
    json_array_foreach(problems->errors, index, error)
    {
        const char *pointer = json_string_value(json_object_get(error, "pointer"));
        if (pointer && strncmp(pointer, "/inputs/start", strlen("/inputs/start")) == 0) return true;
    }
    return false;
}

/* One of job, file and particles; snapshot or checkpoint of a job alone. False: a problem says why not. */
static bool check_choice(start_inputs *start, problem_list *problems)
{
    const size_t before = json_array_size(problems->errors);
    if (is_refused(problems)) return false; /* whether one was named can't be told */
    const int given = (*start->job != 0) + (*start->file != 0) + (start->particle_count > 0);
    if (given != 1)
        problem_list_add(problems, "/inputs/start", "names %d of job, file and particles; must name one of them", given);
    if (*start->job && !job_id_is_valid(start->job))
        problem_list_add(problems, "/inputs/start/job", "is \"%s\"; must be the id of a job, as " AN_ID, start->job);
    if (!isnan(start->snapshot) && !isnan(start->checkpoint))
        problem_list_add(problems, "/inputs/start/snapshot", "is given beside checkpoint; give one of the two");
    if (!*start->job && (!isnan(start->snapshot) || !isnan(start->checkpoint)))
        problem_list_add(problems, isnan(start->snapshot) ? "/inputs/start/checkpoint" : "/inputs/start/snapshot",
                         "is given without start/job, and chooses among the beds of a job; name the job, or leave it out");
    if (*start->job && isnan(start->snapshot)) start->checkpoint = 1.0;
    return json_array_size(problems->errors) == before;
}

/* The bed, as the source of beds or the memory of it has it. New reference. */
static json_t *look_up(const job_spec *spec, double *particles, problem_list *problems)
{
    const start_inputs *start = &spec->inputs.start;
    if (!spec->beds || !spec->beds->find) return NULL;
    json_t *origin = spec_memory_find_bed(spec->inputs.memory, start, particles);
    if (origin) return origin;
    origin = spec->beds->find(spec->beds->context, start, particles, problems);
    spec_memory_keep_bed(spec->inputs.memory, start, origin, *particles);
    return origin;
}

json_t *start_find(job_spec *spec, problem_list *problems)
{
    scene_inputs *inputs = &spec->inputs;
    inputs->start.bed_particles = NAN;
    if (isnan(inputs->start.given) || !check_choice(&inputs->start, problems) || inputs->start.particle_count > 0) return NULL;
    double particles = NAN;
    json_t *origin = look_up(spec, &particles, problems);
    inputs->start.bed_particles = particles;
    if (isnan(inputs->particle_count) && isnan(inputs->fill_fraction)) inputs->particle_count = particles;
    return origin;
}

/* --- particles given one by one --- */

static void refuse_species(size_t particle, double species, size_t kinds, problem_list *problems)
{
    char pointer[80];
    snprintf(pointer, sizeof pointer, "/inputs/start/particles/%zu/species", particle);
    problem_list_add(problems, pointer, "is %g; must be in [0, %zu]: particles has %zu kinds", species, kinds - 1, kinds);
}

/* Of a diameter that came through a file of six digits. */
#define ALIKE 1e-5

static bool has_size(const dem_species *species, double diameter)
{
    if (species->cluster.sphere_count) return false;
    return diameter >= dem_species_smallest_sphere(species) * (1.0 - ALIKE)
           && diameter <= dem_species_largest_sphere(species) * (1.0 + ALIKE);
}

/* The one kind that has spheres of that diameter; NaN: none, or several, and a problem says so. */
static double species_of_size(size_t particle, double diameter, const dem_scene_definition *drum, problem_list *problems)
{
    double found = NAN;
    size_t kinds = 0;
    for (size_t s = 0; s < drum->species_count; s++) {
        if (isnan(drum->species[s].diameter)) return NAN; /* refused */
        if (!has_size(&drum->species[s], diameter)) continue;
        found = (double)s;
        kinds++;
    }
    if (kinds == 1) return found;
    char pointer[80];
    snprintf(pointer, sizeof pointer, "/inputs/start/particles/%zu/diameter", particle);
    problem_list_add(problems, pointer,
                     kinds ? "is %.9g m, which %zu of the kinds of particles have; give species, too"
                           : "is %.9g m; must be what one of the kinds of particles has, and %zu of them have it",
                     diameter, kinds);
    return NAN;
}

/* Of a kind with a size distribution each has its diameter; it is kept within the ends that it may pass by the rounding of files. */
static void check_size(size_t particle, start_particle *placed, const dem_species *species, problem_list *problems)
{
    char pointer[80];
    snprintf(pointer, sizeof pointer, "/inputs/start/particles/%zu/diameter", particle);
    if (isnan(placed->diameter) && species->sizes.law)
        problem_list_add(problems, pointer, "is missing; must be given, since the particle's kind has a size distribution");
    else if (!isnan(placed->diameter) && !isnan(species->diameter) && !has_size(species, placed->diameter))
        problem_list_add(problems, pointer, "is %.9g m; must be in [%.9g, %.9g] m, as its kind is", placed->diameter,
                         dem_species_smallest_sphere(species), dem_species_largest_sphere(species));
    else if (species->sizes.law) placed->diameter = fmin(fmax(placed->diameter, species->sizes.minimum), species->sizes.maximum);
}

static void find_sizes(start_inputs *start, const dem_scene_definition *drum, problem_list *problems)
{
    for (size_t p = 0; p < start->particle_count && !problem_list_is_full(problems); p++) {
        start_particle *placed = &start->particles[p];
        if (isnan(placed->species) && !isnan(placed->diameter))
            placed->species = species_of_size(p, placed->diameter, drum, problems);
        if (placed->species < (double)drum->species_count) check_size(p, placed, &drum->species[(size_t)placed->species], problems);
    }
}

bool start_count_particles(scene_inputs *inputs, dem_scene_definition *drum, problem_list *problems)
{
    start_inputs *start = &inputs->start;
    const double count = (double)start->particle_count;
    double of_species[DEM_MAXIMUM_SPECIES] = { 0 };
    if (start->particle_count == 0) return false;
    find_sizes(start, drum, problems);
    for (size_t p = 0; p < start->particle_count; p++) {
        const double species = start->particles[p].species;
        if (species < (double)inputs->species_count) of_species[(size_t)species] += 1.0;
        else if (!isnan(species)) refuse_species(p, species, inputs->species_count, problems);
    }
    for (size_t s = 0; s < inputs->species_count; s++) {
        char pointer[60];
        snprintf(pointer, sizeof pointer, "/inputs/particles/%zu/share", s);
        drum->species[s].share = of_species[s] / count;
        if (!isnan(inputs->species[s].share))
            problem_list_add(problems, pointer, "is %g, but start/particles says how many there are of each; leave it out",
                             inputs->species[s].share);
    }
    if (!isnan(inputs->fill_fraction) || (!isnan(inputs->particle_count) && inputs->particle_count != count))
        problem_list_add(problems, isnan(inputs->fill_fraction) ? "/inputs/particle_count" : "/inputs/fill_fraction",
                         "is %g, but start/particles has %.0f particles; leave it out",
                         isnan(inputs->fill_fraction) ? inputs->particle_count : inputs->fill_fraction, count);
    drum->particle_count = start->particle_count;
    drum->fill_fraction = dem_fill_of_particles(drum->diameter, drum->length, count, drum->species, drum->species_count);
    return true;
}

/* Not one that was refused. */
static bool has_place(const start_particle *particle, const dem_scene_definition *drum)
{
    return !isnan(particle->position[0] + particle->position[1] + particle->position[2])
           && particle->species < (double)drum->species_count;
}

/* Every sphere of every particle that has a place, for free(); NULL: no memory. */
static placed_sphere *all_spheres(const start_inputs *start, const dem_scene_definition *drum, size_t *count)
{
    size_t room = 1;
    for (size_t p = 0; p < start->particle_count; p++)
        if (has_place(&start->particles[p], drum))
            room += 1 + drum->species[(size_t)start->particles[p].species].cluster.sphere_count;
    placed_sphere *spheres = calloc(room, sizeof *spheres), *next = spheres;
    for (size_t p = 0; spheres && p < start->particle_count; p++) {
        const start_particle *particle = &start->particles[p];
        if (!has_place(particle, drum)) continue;
        const dem_species *species = &drum->species[(size_t)particle->species];
        const size_t of_each = species->cluster.sphere_count;
        for (size_t k = 0; k < (of_each ? of_each : 1); k++) {
            double r[3] = { 0 };
            if (of_each && !isnan(particle->orientation[0]))
                dem_turn(particle->orientation, species->cluster.sphere[k].position, r);
            else if (of_each) memcpy(r, species->cluster.sphere[k].position, sizeof r);
            const double diameter = species->sizes.law ? particle->diameter : species->diameter;
            placed_sphere s = { .radius = 0.5 * (of_each ? species->cluster.sphere[k].diameter : diameter), .particle = p };
            for (int c = 0; c < 3; c++) s.x[c] = particle->position[c] + r[c];
            if (s.radius > 0.0 && !isnan(s.x[0] + s.x[1] + s.x[2])) *next++ = s; /* one without a size was refused */
        }
    }
    *count = spheres ? (size_t)(next - spheres) : 0;
    return spheres;
}

static void check_inside(const placed_sphere *s, const dem_scene_definition *drum, problem_list *problems)
{
    const double most = MOST_START_OVERLAP * 2 * s->radius, from_axis = sqrt(s->x[0] * s->x[0] + s->x[1] * s->x[1]);
    const double room = 0.5 * drum->diameter - s->radius + most;
    /* across periodic ends a cluster may reach by its own size */
    const double along = drum->ends.are_walls ? 0.5 * drum->length - s->radius + most : drum->length;
    if (!(from_axis > room) && !(fabs(s->x[2]) > along)) return;
    char pointer[80];
    snprintf(pointer, sizeof pointer, "/inputs/start/particles/%zu/position", s->particle);
    if (from_axis > room)
        problem_list_add(problems, pointer,
                         "puts a sphere of %g m at %.6g m from the axis; must be at most %.6g m, inside the drum", 2 * s->radius,
                         from_axis, room);
    if (fabs(s->x[2]) > along)
        problem_list_add(problems, pointer, "puts a sphere of %g m at %.6g m along the axis; must be in [%.6g, %.6g] m",
                         2 * s->radius, s->x[2], -along, along);
}

/* m that a sphere is in the bar that overlaps it most; below 0: outside. Bars stand about the angles 2 pi k/count at first. */
static double depth_in_bars(const double x[2], double radius, const dem_scene_definition *drum)
{
    const dem_lifters *bars = &drum->lifters;
    const double top = 0.5 * drum->diameter * cos(bars->angle) - bars->height, aside = 0.5 * drum->diameter * sin(bars->angle);
    double deepest = -INFINITY;
    for (size_t k = 0; k < bars->count; k++) {
        const double angle = 2.0 * DEM_PI * (double)k / (double)bars->count - bars->angle;
        const double along = x[0] * cos(angle) + x[1] * sin(angle), across = x[1] * cos(angle) - x[0] * sin(angle) - aside;
        const double below = top - along, beside = fabs(across) - 0.5 * bars->width;
        const double away =
            below > 0.0 && beside > 0.0 ? sqrt(below * below + beside * beside) : fmax(below, beside); /* of the centre */
        if (along > 0.0) deepest = fmax(deepest, radius - away);
    }
    return deepest;
}

/* The same of the lining's spheres, rows of them around the wall: the one that is nearest. */
static double depth_in_lining(const placed_sphere *s, const double x[2], const dem_scene_definition *drum)
{
    const dem_lining *lining = &drum->lining;
    const double at = 0.5 * (drum->diameter - lining->diameter);
    const double around = floor(2.0 * DEM_PI * at / lining->pitch + 1e-9), along = floor(drum->length / lining->pitch + 1e-9);
    const double angle = round(atan2(x[1], x[0]) * around / (2.0 * DEM_PI)) * 2.0 * DEM_PI / around, step = drum->length / along;
    const double place = (s->x[2] + 0.5 * drum->length) / step - 0.5;
    const double row = drum->ends.are_walls ? fmin(fmax(round(place), 0.0), along - 1.0) : round(place);
    const double dx = x[0] - at * cos(angle), dy = x[1] - at * sin(angle), dz = (place - row) * step;
    return s->radius + 0.5 * lining->diameter - sqrt(dx * dx + dy * dy + dz * dz);
}

/* is_mirrored: bars and lining are the mirror image of what was asked for. */
static void check_beside_wall(const placed_sphere *s, const dem_scene_definition *drum, bool is_mirrored, problem_list *problems)
{
    const double x[2] = { is_mirrored ? -s->x[0] : s->x[0], s->x[1] };
    const double in_bars = drum->lifters.count ? depth_in_bars(x, s->radius, drum) : -INFINITY;
    const double in_lining = drum->lining.diameter > 0.0 ? depth_in_lining(s, x, drum) : -INFINITY;
    const double most =
        MOST_START_OVERLAP * 2 * fmin(s->radius, drum->lining.diameter > 0.0 ? 0.5 * drum->lining.diameter : s->radius);
    char pointer[80];
    if (!(in_bars > most) && !(in_lining > most)) return;
    snprintf(pointer, sizeof pointer, "/inputs/start/particles/%zu/position", s->particle);
    problem_list_add(problems, pointer, "puts a sphere of %g m %.3g m into %s; must be at most %.3g m", 2 * s->radius,
                     fmax(in_bars, in_lining), in_bars > in_lining ? "a lifter" : "the lining", most);
}

static void tell_overlap(const placed_pair *pair, problem_list *problems)
{
    char pointer[80];
    snprintf(pointer, sizeof pointer, "/inputs/start/particles/%zu/position", pair->high);
    if (pair->overlap * MOST_START_OVERLAP > COINCIDING * pair->most) {
        problem_list_add(problems, pointer, "coincides with particle %zu; each must have a place of its own", pair->low);
        return;
    }
    problem_list_add(problems, pointer, "overlaps particle %zu by %.3g m; must be at most %.3g m, %g of the smaller diameter",
                     pair->low, pair->overlap, pair->most, MOST_START_OVERLAP);
}

static void check_overlaps(placed_sphere *spheres, size_t count, const dem_scene_definition *drum, problem_list *problems)
{
    placed_pair pair[ENOUGH_OVERLAPS + 1];
    const double period = !drum->ends.are_walls && drum->length > 0.0 ? drum->length : 0.0;
    const size_t found = start_overlaps_find(spheres, count, period, MOST_START_OVERLAP, pair, ENOUGH_OVERLAPS + 1);
    for (size_t k = 0; k < found && k < ENOUGH_OVERLAPS; k++) tell_overlap(&pair[k], problems);
    if (found > ENOUGH_OVERLAPS)
        problem_list_add(problems, "/inputs/start/particles", "overlap in more than these %d pairs", ENOUGH_OVERLAPS);
}

void start_check_particles(const scene_inputs *inputs, const dem_scene_definition *drum, problem_list *problems)
{
    size_t count;
    const size_t before = json_array_size(problems->errors);
    if (inputs->start.particle_count == 0 || spec_memory_knows_inside(inputs->memory, &inputs->start, drum)) return;
    placed_sphere *spheres = all_spheres(&inputs->start, drum, &count);
    if (!spheres) {
        problem_list_add(problems, "/inputs/start/particles", "could not be looked at: out of memory");
        return;
    }
    for (size_t i = 0; i < count && !problem_list_is_full(problems); i++) {
        check_inside(&spheres[i], drum, problems);
        check_beside_wall(&spheres[i], drum, turns_back(inputs), problems);
    }
    if (!spec_memory_knows_apart(inputs->memory, &inputs->start, drum)) check_overlaps(spheres, count, drum, problems);
    if (json_array_size(problems->errors) == before) spec_memory_keep_sound(inputs->memory, &inputs->start, drum);
    free(spheres);
}

/* --- against the spec that made the bed --- */

/* Both are members of the group, or lie deeper in it. What may differ of the container and the particles, how they move and
 * rub and how their number was said, is known by the rows of the table. */
static void compare_values(const spec_table *table, spec_group group, const json_t *now, const json_t *then, const char *pointer,
                           problem_list *problems)
{
    char member[LONGEST_POINTER], seen[60], before[60];
    const char *name;
    json_t *value;
    if (json_is_object(now) && json_is_object(then)) {
        json_object_foreach((json_t *)then, name, value)
        {
            pointer_to_member(member, pointer, name);
            const spec_field *field = spec_field_find(table, group, name);
            if (field && field->is_free_of_bed) continue;
            compare_values(table, field ? field->child : group, json_object_get(now, name), value, member, problems);
        }
    } else if (json_is_array(now) && json_is_array(then) && json_array_size(now) == json_array_size(then)) {
        for (size_t k = 0; k < json_array_size(now); k++) {
            snprintf(member, sizeof member, "%.200s/%zu", pointer, k);
            compare_values(table, group, json_array_get(now, k), json_array_get(then, k), member, problems);
        }
    } else if (json_is_array(now) && json_is_array(then)) {
        problem_list_add(problems, pointer, "has %zu entries; must have %zu, as the bed that it starts from", json_array_size(now),
                         json_array_size(then));
    } else if (json_is_number(now) && json_is_number(then) ? json_number_value(now) != json_number_value(then)
                                                           : !json_equal(now, then)) {
        json_value_text(now, seen, sizeof seen);
        json_value_text(then, before, sizeof before);
        problem_list_add(problems, pointer, "is %s; must be %s, as in the bed that it starts from", now ? seen : "not given",
                         before);
    }
}

bool turns_back(const scene_inputs *inputs)
{
    for (size_t k = 0; k < inputs->stage_count; k++)
        if (fabs(inputs->stages[k].rate) > 0.0) return inputs->stages[k].rate < 0.0;
    return inputs->rotation_rate < 0.0;
}

/* The same of a specification's drum. */
static bool turned_back(const json_t *drum)
{
    size_t k;
    json_t *stage;
    json_array_foreach(json_object_get(drum, "rotation"), k, stage)
    {
        const double rate = json_number_value(json_object_get(stage, "rate"));
        if (fabs(rate) > 0.0) return rate < 0.0;
    }
    return json_number_value(json_object_get(drum, "rotation_rate")) < 0.0;
}

void start_compare(const job_spec *spec, const json_t *origin, problem_list *problems)
{
    static const char *const compared[] = { "drum", "particles", "wall", "materials" };
    const json_t *then = json_object_get(origin, "inputs");
    const double asked = (double)spec->scene.particle_count, there = spec->inputs.start.bed_particles;
    if (asked > there || asked < there)
        problem_list_add(problems, isnan(spec->inputs.particle_count) ? "/inputs/fill_fraction" : "/inputs/particle_count",
                         "makes %.0f particles; must be left out, or make %.0f, as many as the bed that it starts from has", asked,
                         there);
    if (!then || json_array_size(problems->errors) > (asked != there)) return; /* what was refused can't be written */
    const bool remembers = spec->inputs.start.checkpoint > 0.0 || json_is_true(json_object_get(origin, "is_checkpoint"));
    if (remembers && turned_back(json_object_get(then, "drum")) != turns_back(&spec->inputs))
        problem_list_add(
            problems, "/inputs/drum/rotation_rate",
            "turns the other way than the bed's checkpoint, whose contacts remember theirs; must turn the same way, or "
            "start from a snapshot");
    json_t *now = spec_inputs_write(spec->type->inputs, (const char *)spec + spec->type->inputs_at);
    for (size_t k = 0; now && k < sizeof compared / sizeof compared[0]; k++) {
        char pointer[40];
        if (!json_object_get(then, compared[k])) continue; /* without materials densities are with the particles */
        snprintf(pointer, sizeof pointer, "/inputs/%s", compared[k]);
        const spec_group group = spec_field_find(spec->type->inputs, SPEC_INPUTS, compared[k])->child;
        compare_values(spec->type->inputs, group, json_object_get(now, compared[k]), json_object_get(then, compared[k]), pointer,
                       problems);
    }
    json_decref(now);
}
