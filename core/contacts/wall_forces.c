#include "wall_forces.h"

#include "contact_block.h"

/* Gathers a block of contacts as if all were with the cylinder, which most are with; `gather` then replaces the others. */
static void gather_cylinder(contact_block *restrict block, const spheres *s, const int32_t *restrict first, double radius,
                            double rotation_rate)
{
    const wide zero = wide_all(0), at_wall = wide_all((real)(rotation_rate * radius));
    for (int k = 0; k < BLOCK; k++) {
        const double *x = sphere_place(s, (size_t)first[k]);
        const double rho2 = x[0] * x[0] + x[1] * x[1], room = radius - sphere_radius(s, (size_t)first[k]);
        block->n[0][k] = (real)x[0];
        block->n[1][k] = (real)x[1];
        block->distance2[k] = (real)rho2;
        block->gap2[k] = (real)(rho2 - room * room); /* overlap = rho - (R - r) */
    }
    for (int k = 0; k < BLOCK; k += LANES) {
        const wide_rows row = wide_rows_load(s->row, first + k);
        const wide_rests rest = wide_rests_load(s->rest, first + k);
        /* the wall's velocity at the place of the contact: omega x r, at the wall rather than at the centre */
        const wide widen = at_wall * wide_inverse_root(wide_load(block->distance2 + k));
        const wide v[3] = { -widen * wide_load(block->n[1] + k) - row.v[0], widen * wide_load(block->n[0] + k) - row.v[1],
                            zero - row.v[2] };
        const wide omega[3] = { row.omega[0], row.omega[1], rest.omega_z };
        store_vector(block->v, k, v);
        store_vector(block->omega, k, omega);
        wide_store(block->n[2] + k, zero);
        wide_store(block->reach + k, wide_all((real)radius) - rest.radius);
        wide_store(block->radii + k, rest.radius);
    }
}

/* Gathers slot k of the block: sphere i at any wall. Overlap = r - distance, from (r - distance)(r + |distance|) over
 * |distance| + r, as for spheres. */
static void gather_wall(contact_block *restrict block, int k, const spheres *s, size_t i, const container_wall *w)
{
    const double *x = sphere_place(s, i), r = sphere_radius(s, i);
    const wall_sight sight = wall_seen_from(w, x);
    const double size = fmax(fabs(sight.distance), 1e-12 * r);
    double point[3], v[3];
    for (int c = 0; c < 3; c++) point[c] = x[c] + sight.distance * sight.toward[c];
    wall_velocity(w, point, v);
    block->distance2[k] = (real)(size * size);
    block->gap2[k] = (real)((r - sight.distance) * (r + size));
    block->reach[k] = block->radii[k] = (real)r;
    for (int c = 0; c < 3; c++) {
        block->n[c][k] = (real)(size * sight.toward[c]);
        block->v[c][k] = (real)v[c] - (real)s->velocity[i][c];
        block->omega[c][k] = (real)s->angular_velocity[i][c];
    }
}

/* Gathers the difference of spins, which only rolling friction needs: that of the sphere less that of the wall about z. */
static void gather_spins(contact_block *restrict block, const contact_list *walls, size_t start, const container *c)
{
    memcpy(block->spin, block->omega, sizeof block->spin);
    for (int k = 0; k < BLOCK; k++) block->spin[2][k] -= (real)c->wall[walls->second[start + (size_t)k]].rotation_rate;
}

static void gather(contact_block *restrict block, const contact_list *walls, size_t start, const spheres *s, const container *c)
{
    const int32_t *first = walls->first + start, *second = walls->second + start;
    if (c->wall[0].kind == WALL_CYLINDER) gather_cylinder(block, s, first, c->radius, c->wall[0].rotation_rate);
    if (c->wall_count == 1) return;
    const size_t left = walls->count - start;
    for (int k = 0; k < BLOCK; k++) {
        /* slots behind the last, whose results nobody reads, have spheres that no array of velocities has */
        const int from = (size_t)k < left ? k : 0;
        const container_wall *w = &c->wall[second[from]];
        if (w->kind != WALL_CYLINDER) gather_wall(block, k, s, (size_t)first[from], w);
    }
}

/* Computes the block of contacts that begins at `start`: their rows and histories. */
static void block_of_walls(contact_list *walls, size_t start, const spheres *s, const container *c,
                           const dem_contact_parameters *contact, double dt, wide *largest)
{
    contact_block block;
    gather(&block, walls, start, s, c);
    if (walls->has_rolling) gather_spins(&block, walls, start, c);
    contact_block_forces(walls, start, &block, contact, true, dt, largest);
    for (int k = 0; k < BLOCK; k++) walls->row[start + (size_t)k] = block.row[(k & -LANES) | wide_row_slot(k & (LANES - 1))];
}

/* A list of a single block, which holds copies of some contacts of another list: the way to compute part of a block while another
 * thread computes the rest. */
typedef struct contacts_aside {
    int32_t first[BLOCK], second[BLOCK];
    real memory[CONTACT_NUMBERS][BLOCK], constant[CONTACT_CONSTANTS][BLOCK];
    contact_row row[BLOCK];
    contact_list list;
} __attribute__((aligned(ALIGNMENT))) contacts_aside;

static void set_aside(contacts_aside *aside, const contact_list *walls, size_t from, size_t to)
{
    contact_list *const list = &aside->list;
    memset(aside->memory, 0, sizeof aside->memory);
    memset(aside->constant, 0, sizeof aside->constant);
    *list = (contact_list){ .has_rolling = walls->has_rolling,
                            .laws_differ = walls->laws_differ,
                            .coheres = walls->coheres,
                            .constants = CONSTANTS_OF_EACH,
                            .count = to - from,
                            .capacity = BLOCK,
                            .first = aside->first,
                            .second = aside->second,
                            .constant_capacity = BLOCK,
                            .ends_differ = walls->ends_differ,
                            .damped = walls->damped,
                            .latch_damping = walls->latch_damping,
                            .row = aside->row };
    for (int m = 0; m < CONTACT_NUMBERS; m++) list->memory[m] = aside->memory[m];
    for (int c = 0; c < CONTACT_CONSTANTS; c++) list->constant[c] = aside->constant[c];
    for (int m = 0; m < contact_list_numbers(walls); m++)
        memcpy(aside->memory[m], walls->memory[m] + from, (to - from) * sizeof(real));
    for (int c = 0; c < CONTACT_CONSTANTS; c++)
        if (contact_list_keeps(walls, c)) memcpy(aside->constant[c], walls->constant[c] + from, (to - from) * sizeof(real));
    for (size_t k = 0; k < BLOCK; k++) { /* the rest of the block is padding: it repeats a contact that exists */
        aside->first[k] = walls->first[k < to - from ? from + k : from];
        aside->second[k] = walls->second[k < to - from ? from + k : from];
    }
}

/* Copies histories and rows back into the list that the contacts came from. */
static void take_back(const contacts_aside *aside, contact_list *walls, size_t from)
{
    const size_t count = aside->list.count;
    for (int m = 0; m < contact_list_numbers(walls); m++) memcpy(walls->memory[m] + from, aside->memory[m], count * sizeof(real));
    memcpy(walls->row + from, aside->row, count * sizeof *aside->row);
}

void contact_forces_with_some_walls(neighbor_list *list, size_t from, size_t to, const spheres *s, const container *c,
                                    const dem_contact_parameters *contact, double dt, wide *largest)
{
    contact_list *const walls = &list->walls;
    for (size_t k = from + BLOCK; s->are_many && k < from + 2 * BLOCK && k < walls->count; k++)
        __builtin_prefetch(&s->place[walls->first[k]], 1); /* rows come with the pairs' */
    if (from % BLOCK == 0 && (to == from + BLOCK || to == walls->count)) {
        block_of_walls(walls, from, s, c, contact, dt, largest);
        return;
    }
    contacts_aside aside;
    set_aside(&aside, walls, from, to);
    block_of_walls(&aside.list, 0, s, c, contact, dt, largest);
    take_back(&aside, walls, from);
}

typedef struct wall_work {
    neighbor_list *list;
    const spheres *spheres;
    const container *container;
    const dem_contact_parameters *contact;
    double dt;
    double largest[MOST_PARTS]; /* m, overlaps of each part */
} wall_work;

/* Computes the blocks that begin among the contacts of the part's own spheres, which are in the cache of this core. */
static void walls_of_part(void *context, int part, int parts)
{
    (void)parts;
    wall_work *const work = context;
    neighbor_list *const list = work->list;
    const size_t from = round_up_to_block(list->wall_start[list->parts.sphere[part]]);
    const size_t to = round_up_to_block(list->wall_start[list->parts.sphere[part + 1]]);
    wide largest = wide_all(0);
    for (size_t start = from; start < to; start += BLOCK)
        block_of_walls(&list->walls, start, work->spheres, work->container, work->contact, work->dt, &largest);
    for (size_t k = from; k < to && k < list->walls.count; k++) {
        const double *x = sphere_place(work->spheres, (size_t)list->walls.first[k]);
        const contact_row row = list->walls.row[k];
        list->wall_torques[k] = x[0] * (double)row[1] - x[1] * (double)row[0] + (double)row[5];
    }
    work->largest[part] = wide_largest_lane(largest);
}

double contact_forces_with_walls(neighbor_list *list, const spheres *s, const container *c, const dem_contact_parameters *contact,
                                 double dt)
{
    wall_work work;
    work.list = list, work.spheres = s, work.container = c, work.contact = contact, work.dt = dt;
    team_run(list->parts.count, walls_of_part, &work);
    double largest = 0.0;
    for (int part = 0; part < list->parts.count; part++) largest = fmax(largest, work.largest[part]);
    return largest;
}

double wall_torque(const neighbor_list *list)
{
    double torque = 0.0;
    for (size_t k = 0; k < list->walls.count; k++) torque += list->wall_torques[k];
    return torque;
}

wall_load wall_load_of(const contact_list *walls, size_t slot, const spheres *s, const container *c)
{
    wall_load load = { .wall = walls->second[slot] };
    const container_wall *w = &c->wall[load.wall];
    const double *x = sphere_place(s, (size_t)walls->first[slot]);
    const wall_sight sight = wall_seen_from(w, x);
    for (int a = 0; a < 3; a++) {
        load.point[a] = x[a] + sight.distance * sight.toward[a];
        load.force[a] = -(double)walls->row[slot][a];
    }
    wall_velocity(w, load.point, load.velocity);
    return load;
}
