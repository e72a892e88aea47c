#include "container.h"

#include "dem_rules.h"

static container_wall *add_wall(container *c, wall_kind kind, double friction)
{
    container_wall *w = &c->wall[c->wall_count++];
    *w = (container_wall){ .kind = kind, .friction = friction };
    return w;
}

static void add_plane(container *c, double z, double facing)
{
    container_wall *w = add_wall(c, WALL_PLANE, 0);
    w->low = w->high = z;
    w->facing = facing;
}

static void add_shell(container *c, double radius, double height)
{
    container_wall *w = add_wall(c, WALL_SHELL, 0);
    w->radius = radius;
    w->high = height;
}

/* Walls of a drum: its own first, then the ends, then the bars. */
static void drum_walls(container *c, const dem_scene_definition *definition)
{
    add_wall(c, WALL_CYLINDER, 0)->radius = c->radius;
    if (definition->ends.are_walls) {
        add_plane(c, -0.5 * c->length, 1);
        add_plane(c, 0.5 * c->length, -1);
    }
    c->first_bar = c->wall_count;
    c->bar_count = (int)definition->lifters.count;
    c->bars_from = c->bar_count ? c->radius - definition->lifters.height : c->radius;
    /* A bar that leans by `lean` has its foot on the wall, at the same places as one that does not. */
    const double lean = definition->lifters.angle, half_width = 0.5 * definition->lifters.width;
    const double top = lean != 0 ? c->radius * cos(lean) - definition->lifters.height : c->bars_from;
    const double aside = lean != 0 ? c->radius * sin(lean) : 0;
    if (lean != 0) c->bars_from = hypot(fmax(top, 0), fmax(fabs(aside) - half_width, 0));
    for (int k = 0; k < c->bar_count; k++) {
        const double angle = 2 * DEM_PI * k / c->bar_count - lean;
        container_wall *bar = add_wall(c, WALL_BAR, 0);
        bar->radius = top;
        bar->half_width = half_width;
        bar->aside = aside;
        bar->middle[0] = bar->place[0] = cos(angle);
        bar->middle[1] = bar->place[1] = sin(angle);
    }
}

/* A tube first, then the plate, then its rim. The tube has no upper edge, which would carry what lies across it up for ever. */
static void tube_walls(container *c, const dem_scene_definition *definition)
{
    add_shell(c, c->radius, INFINITY);
    container_wall *plate = add_wall(c, WALL_DISC, 0);
    plate->radius = 0.5 * definition->plate.diameter;
    if (definition->plate.rim_height > 0) add_shell(c, 0.5 * definition->plate.diameter, definition->plate.rim_height);
}

/* The sides of a vessel first, then its floor or hopper, then a hopper's stopper, which container_move takes away. */
static void vessel_walls(container *c, const dem_orifice *orifice)
{
    if (c->half_depth == 0) add_wall(c, WALL_CYLINDER, 0)->radius = c->radius;
    for (int k = 0; c->half_depth > 0 && k < 4; k++) {
        container_wall *face = add_wall(c, WALL_FACE, 0);
        face->radius = k < 2 ? c->radius : c->half_depth;
        face->middle[k / 2] = k % 2 ? -1 : 1;
    }
    c->funnel = c->wall_count;
    container_wall *floor = add_wall(c, WALL_FUNNEL, 0);
    floor->radius = 0.5 * orifice->opening;
    floor->outer = c->radius;
    floor->high = c->hopper_height;
    floor->middle[0] = c->half_depth > 0;
    if (c->hopper_height == 0) return;
    container_wall *stopper = add_wall(c, WALL_FUNNEL, 0);
    *stopper = *floor;
    stopper->outer = floor->radius;
    stopper->radius = stopper->high = 0;
}

/* The stopper of a hopper is the last wall; a flat floor has no hole before. */
static void open_vessel(container *c, const dem_orifice *orifice, bool is_open)
{
    if (c->hopper_height > 0) c->wall_count = c->funnel + (is_open ? 1 : 2);
    else c->wall[c->funnel].radius = is_open ? 0.5 * orifice->opening : 0.0;
}

static void set_box(container *c, double radius, double low, double high)
{
    for (int a = 0; a < 2; a++) c->high[a] = -(c->low[a] = -radius);
    c->low[2] = low;
    c->high[2] = high;
}

static void set_vessel(container *c, const dem_orifice *orifice)
{
    c->half_depth = 0.5 * orifice->depth;
    if (c->half_depth > 0) {
        c->inner_radius = fmin(c->radius, c->half_depth);
        c->high[1] = -(c->low[1] = -c->half_depth);
    }
    if (orifice->half_angle > 0) c->hopper_height = (c->radius - 0.5 * orifice->opening) / tan(orifice->half_angle);
    vessel_walls(c, orifice);
    open_vessel(c, orifice, false);
}

static dem_surface surface_of(const container *c, int k)
{
    switch (c->wall[k].kind) {
    case WALL_PLANE:
    case WALL_FUNNEL: return DEM_ENDS;
    case WALL_DISC: return DEM_PLATE;
    case WALL_BAR: return DEM_LIFTERS;
    case WALL_SHELL: return k == 0 ? DEM_WALL : DEM_PLATE;
    case WALL_FACE:
    case WALL_CYLINDER: break;
    }
    return DEM_WALL;
}

void container_init(container *c, const dem_scene_definition *definition)
{
    *c = (container){ .kind = definition->container, .radius = 0.5 * definition->diameter, .length = definition->length };
    c->inner_radius = c->bars_from = c->radius;
    c->up[c->kind == DEM_DRUM ? 1 : 2] = 1;
    switch (c->kind) {
    case DEM_DRUM:
        c->inner_radius = c->radius - definition->lining.diameter;
        if (!definition->ends.are_walls) {
            c->period = c->length;
            c->inverse_period = 1.0 / c->length;
        }
        if (definition->tilt > 0) c->up[1] = cos(definition->tilt), c->up[2] = sin(definition->tilt);
        set_box(c, c->radius, -0.5 * c->length, 0.5 * c->length);
        drum_walls(c, definition);
        break;
    case DEM_CYLINDER:
        set_box(c, c->radius, 0, c->length);
        add_wall(c, WALL_CYLINDER, 0)->radius = c->radius;
        add_plane(c, 0, 1);
        break;
    case DEM_TUBE_ON_PLATE:
        set_box(c, fmax(c->radius, 0.5 * definition->plate.diameter), 0, c->length);
        tube_walls(c, definition);
        break;
    case DEM_VESSEL:
        set_box(c, c->radius, 0, c->length);
        set_vessel(c, &definition->orifice);
        break;
    }
    for (int k = 0; k < c->wall_count; k++) c->wall[k].surface = surface_of(c, k);
    container_set_friction(c, definition, true);
}

static double wall_friction(const container *c, const dem_scene_definition *definition, int k)
{
    switch (c->wall[k].kind) {
    case WALL_PLANE:
    case WALL_FUNNEL: return definition->ends.friction;
    case WALL_DISC: return definition->plate.friction;
    case WALL_BAR: return definition->lifters.friction;
    case WALL_SHELL: return k == 0 ? definition->contact.wall_friction : definition->plate.friction;
    case WALL_FACE:
    case WALL_CYLINDER: break;
    }
    return definition->contact.wall_friction;
}

/* Ends, and a plate with its rim, have their own; lifters and all others have the wall's. */
static double wall_rolling_friction(const container *c, const dem_scene_definition *definition, int k)
{
    const bool is_plate = c->wall[k].kind == WALL_DISC || (c->wall[k].kind == WALL_SHELL && k > 0);
    if (c->wall[k].kind == WALL_PLANE || c->wall[k].kind == WALL_FUNNEL) return definition->ends.rolling_friction;
    return is_plate ? definition->plate.rolling_friction : definition->contact.wall_rolling_friction;
}

void container_set_friction(container *c, const dem_scene_definition *definition, bool has_friction)
{
    for (int k = 0; k < c->wall_count; k++) {
        c->wall[k].friction = has_friction ? wall_friction(c, definition, k) : 0.0;
        c->wall[k].rolling_friction = has_friction ? wall_rolling_friction(c, definition, k) : 0.0;
    }
}

/* Its rate `time` after it began to turn. turned: rad until then. */
static double rate_at(const dem_scene_definition *definition, double time, double *turned)
{
    if (definition->stage_count == 0) {
        *turned = definition->rotation_rate * time;
        return definition->rotation_rate;
    }
    double since, before = 0;
    const size_t now = dem_stage_at(definition, time, &since);
    for (size_t k = 0; k < now; k++) before += definition->stage[k].rate * definition->stage[k].seconds;
    *turned = before + definition->stage[now].rate * (time - since);
    return definition->stage[now].rate;
}

static bool turn_drum(container *c, double rate, double turned)
{
    const bool changes = rate != c->rotation_rate;
    c->angle = c->angle_before + turned;
    for (int k = 0; changes && k < c->wall_count; k++) c->wall[k].rotation_rate = rate;
    c->rotation_rate = rate;
    if (c->bar_count == 0) return changes;
    const double cosine = cos(c->angle), sine = sin(c->angle);
    for (int k = c->first_bar; k < c->first_bar + c->bar_count; k++) {
        container_wall *w = &c->wall[k];
        w->middle[0] = cosine * w->place[0] - sine * w->place[1];
        w->middle[1] = sine * w->place[0] + cosine * w->place[1];
    }
    return changes;
}

static bool raise_tube(container *c, const dem_lift *lift, bool has_begun, double time)
{
    container_wall *tube = &c->wall[0];
    const bool rises = has_begun && time >= lift->start;
    const bool changes = rises != (tube->rise != 0) && lift->speed != 0;
    tube->rise = rises ? lift->speed : 0.0;
    tube->low = rises ? lift->speed * (time - lift->start) : 0.0;
    return changes;
}

bool container_move(container *c, const dem_scene_definition *definition, bool has_begun, double time)
{
    double turned = 0;
    switch (c->kind) {
    case DEM_DRUM: {
        const double rate = has_begun ? rate_at(definition, time, &turned) : 0;
        return turn_drum(c, rate, turned);
    }
    case DEM_TUBE_ON_PLATE: return raise_tube(c, &definition->lift, has_begun, time);
    case DEM_VESSEL: open_vessel(c, &definition->orifice, has_begun); break;
    case DEM_CYLINDER: break;
    }
    return false;
}

/* Area of the cross-section where the funnel's wall is `out` from the axis, m2. */
static double section_area(const container *c, double out)
{
    return c->half_depth > 0 ? 4 * c->half_depth * out : DEM_PI * out * out;
}

double container_volume_below(const container *c, double height)
{
    if (c->hopper_height == 0) return section_area(c, c->radius) * height;
    const container_wall *funnel = &c->wall[c->funnel];
    const double in = fmin(height, c->hopper_height), rise = (funnel->outer - funnel->radius) / c->hopper_height;
    const double middle = section_area(c, funnel->radius + 0.5 * rise * in);
    const double ends = section_area(c, funnel->radius) + section_area(c, funnel->radius + rise * in);
    return in / 6 * (ends + 4 * middle) + section_area(c, c->radius) * (height - in); /* Simpson's rule is exact for both */
}

double container_overlap(const container *c, const double x[3], double radius)
{
    double nearest = INFINITY;
    for (int k = 0; k < c->wall_count; k++) nearest = fmin(nearest, wall_seen_from(&c->wall[k], x).distance);
    return radius - nearest;
}

/* Centres lie half a diameter inside the wall, so the lining touches it from within. */
static double lining_radius(const dem_scene_definition *definition)
{
    return 0.5 * (definition->diameter - definition->lining.diameter);
}

static size_t lining_around(const dem_scene_definition *definition)
{
    return (size_t)floor(2 * DEM_PI * lining_radius(definition) / definition->lining.pitch + 1e-9);
}

static size_t lining_along(const dem_scene_definition *definition)
{
    return (size_t)floor(definition->length / definition->lining.pitch + 1e-9);
}

size_t container_lining_count(const dem_scene_definition *definition)
{
    return definition->lining.diameter > 0 ? lining_around(definition) * lining_along(definition) : 0;
}

void container_place_lining(const container *vessel, const dem_scene_definition *definition, spheres *s)
{
    if (s->lining_count == 0) return;
    const size_t around = lining_around(definition), along = lining_along(definition);
    for (size_t k = 0; k < s->lining_count; k++) {
        const double angle = 2 * DEM_PI * (double)(k / along) / (double)around;
        vector4 *place = &s->lining_place[k];
        (*place)[0] = lining_radius(definition) * cos(angle);
        (*place)[1] = lining_radius(definition) * sin(angle);
        (*place)[2] = vessel->length * (((double)(k % along) + 0.5) / (double)along - 0.5);
        s->rest[s->mobile_count + k].radius = (real)(0.5 * definition->lining.diameter);
        s->full_radius[s->mobile_count + k] = s->rest[s->mobile_count + k].radius;
    }
    container_rotate_lining(vessel, s);
}

void container_rotate_lining(const container *vessel, spheres *s)
{
    const double c = cos(vessel->angle), sine = sin(vessel->angle);
    for (size_t k = 0; k < s->lining_count; k++) {
        const vector4 place = s->lining_place[k];
        const vector4 x = { c * place[0] - sine * place[1], sine * place[0] + c * place[1], place[2] };
        sphere_set(s, s->mobile_count + k, x, (vector4){ -vessel->rotation_rate * x[1], vessel->rotation_rate * x[0] },
                   (vector4){ 0, 0, vessel->rotation_rate });
    }
}
