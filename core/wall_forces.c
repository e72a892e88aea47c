#include "wall_forces.h"

#include "contact_block.h"

/* Order of a sphere's row behind its place. */
enum { RADIUS = 0, VELOCITY = 1, R_OMEGA = 4, OMEGA = 7 };

/* Most contacts with walls are with a drum's cylinder: LANES at a time. */
static void gather_cylinder(contact_block *restrict block, const sphere_row *restrict row, const int32_t *restrict first,
                            int32_t origin, double radius, real rotation_rate)
{
    static const float as_it_is[16] = { 0 };
    int32_t nothing[LANES];
    for (int k = 0; k < LANES; k++) nothing[k] = origin;
    for (int k = 0; k < BLOCK; k += LANES) {
        wide own[ROW_NUMBERS];
        wide_double x[HALVES], y[HALVES], z[HALVES], rho2[HALVES], beyond2[HALVES], r[HALVES];
        wide_row_sums(row, sizeof *row, nothing, first + k, as_it_is, own);
        wide_to_doubles(own[RADIUS], r);
        for (int h = 0; h < HALVES; h++) {
            wide_place_differences(row, sizeof *row, nothing, first + k + 8 * h, &x[h], &y[h], &z[h]);
            const wide_double room = wide_double_all(radius) - r[h];
            rho2[h] = x[h] * x[h] + y[h] * y[h];
            beyond2[h] = rho2[h] - room * room; /* overlap = rho - (R - r) */
        }
        const wide outward[3] = { wide_from_doubles(x), wide_from_doubles(y), wide_all(0) };
        const wide rate = wide_all(rotation_rate);
        /* the wall's velocity at the place of the contact: omega x r, at the wall rather than at the centre */
        const wide widen = wide_all((real)radius) * wide_inverse_root(wide_from_doubles(rho2));
        const wide v[3] = { -rate * widen * outward[1] - own[VELOCITY], rate * widen * outward[0] - own[VELOCITY + 1],
                            -own[VELOCITY + 2] };
        store_vector(block->n, k, outward);
        wide_store(block->distance2 + k, wide_from_doubles(rho2));
        wide_store(block->gap2 + k, wide_from_doubles(beyond2));
        wide_store(block->reach + k, wide_all((real)radius) - own[RADIUS]);
        wide_store(block->radii + k, own[RADIUS]);
        store_vector(block->v, k, v);
        store_vector(block->r_omega, k, own + R_OMEGA);
        store_vector(block->omega, k, own + OMEGA);
    }
}

/* Slot k of the block: sphere i at any wall. Overlap = r - distance, from (r - distance)(r + |distance|) over
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
        block->r_omega[c][k] = (real)r * block->omega[c][k];
    }
}

static void gather(contact_block *restrict block, const contact_list *walls, size_t start, const spheres *s, const container *c)
{
    const int32_t *first = walls->first + start, *second = walls->second + start;
    if (c->wall[0].kind == WALL_CYLINDER)
        gather_cylinder(block, s->row, first, sphere_of_zeros(s), c->radius, (real)c->wall[0].rotation_rate);
    if (c->wall_count == 1) return;
    const size_t left = walls->count - start;
    for (int k = 0; k < BLOCK; k++) {
        /* slots behind the last, whose results nobody reads, have spheres that no array of velocities has */
        const int from = (size_t)k < left ? k : 0;
        const container_wall *w = &c->wall[second[from]];
        if (w->kind != WALL_CYLINDER) gather_wall(block, k, s, (size_t)first[from], w);
    }
}

double contact_forces_with_walls(contact_list *walls, const spheres *s, const container *c, const dem_contact_parameters *contact,
                                 double dt, int threads)
{
    double largest = 0.0;
    const size_t count = round_up_to_block(walls->count);
#pragma omp parallel for schedule(static) reduction(max : largest) num_threads(threads) if (threads > 1)
    for (size_t start = 0; start < count; start += BLOCK) {
        contact_block block;
        gather(&block, walls, start, s, c);
        largest = fmax(largest, contact_block_forces(walls, start, &block, contact, true, dt));
    }
    return largest;
}

wall_load wall_load_of(const contact_list *walls, size_t slot, const spheres *s, const container *c)
{
    wall_load load = { .wall = walls->second[slot] };
    const container_wall *w = &c->wall[load.wall];
    const double *x = sphere_place(s, (size_t)walls->first[slot]);
    const wall_sight sight = wall_seen_from(w, x);
    for (int a = 0; a < 3; a++) {
        load.point[a] = x[a] + sight.distance * sight.toward[a];
        load.force[a] = -(double)walls->row[slot].end[0][a];
    }
    wall_velocity(w, load.point, load.velocity);
    return load;
}
