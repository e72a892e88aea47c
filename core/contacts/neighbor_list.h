/* Which spheres may touch: two lists, one inside the other, both exact.
 *
 * Outer: all pairs closer than a skin, found through the cell grid and kept until displacements could have
 * brought an unlisted pair into reach. Inner: those of them that can touch within the next HORIZON steps,
 * picked every few steps; only these are computed. Neither ever misses a contact: each is made again before
 * the bound that it was made for is passed. The proof is in core/NUMERICS.md, "Neighbor lists". */
#ifndef NEIGHBOR_LIST_H
#define NEIGHBOR_LIST_H

#include "contact_constants.h"
#include "neighbor_outer.h"

enum {
    HORIZON = 8,             /* steps between two picks of the inner list, at most */
    PICKS_BETWEEN_LOOKS = 2, /* at most, between two checks of every sphere's place and velocity (failure_check_places) */
};

/* Bounds of all spheres. */
typedef struct outlook {
    double largest_displacement; /* m since the outer list was made */
    double largest_speed;        /* m/s */
} outlook;

typedef struct neighbor_list {
    outer_list outer;
    /* inner */
    double margin; /* m: how far a sphere may stray from its straight path before the next pick */
    double least_margin, most_margin;
    int steps_apart; /* by which the places of spheres may be apart in time: zero but where waves end early (wave.h) */
    int safe_steps;
    outlook at_pick; /* bounds at the last pick: measured then, or extrapolated from an earlier measurement */
    bool inner_valid;
    half_row *picked_velocity; /* (mobile) m/s at the last pick; the fourth number is not used */
    contact_list pairs, pairs_before;
    contact_list walls, walls_before; /* sphere against wall: wall_reach.h */
    uint32_t *wall_start;             /* (mobile + 1) where each sphere's begin in `walls` */
    contact_row *wall_rows;           /* of the walls' contacts */
    double *wall_torques;             /* N m about the axis, of each on its sphere (contact_forces_with_walls) */
    size_t wall_row_capacity;
    contact_parts parts; /* of the pairs */
    bool stays_whole;    /* the next pick deals the pairs to one part, however many threads there are: for waves */
    pair_table table;    /* of materials */
    int64_t inner_picks;
    int64_t picked_of; /* outer.builds at the last pick */
    /* written in each step, apart from what all threads read */
    _Alignas(ALIGNMENT) double strayed; /* m: bound on how far any sphere has, since the pick */
    double deviation;                   /* m/s: largest |v - v at the pick| after the last step */
    int steps_since_pick;
} neighbor_list;

dem_status neighbor_list_init(neighbor_list *list, const spheres *spheres, const dem_scene_definition *definition);
/* The spheres have other radii than when the list was made. */
void neighbor_list_sizes_changed(neighbor_list *list, const spheres *spheres);
void neighbor_list_clear(neighbor_list *list);
void neighbor_list_invalidate(neighbor_list *list); /* after spheres were moved by hand, or added behind the last */
/* Makes the next update pick anew, while a wave has stopped and some spheres are up to steps_apart steps ahead of others: the pick
 * then lists every pair that may touch at any of these steps. */
void neighbor_list_expire(neighbor_list *list, int steps_apart);
/* Makes whichever list is no longer safe again, so that the contacts of this step are all in `pairs` and
 * `walls`. looked: becomes whether it is time to check the place and velocity of every sphere, because the bounds do not notice
 * one that is not a number. Errors: DEM_NO_MEMORY. */
dem_status neighbor_list_update(neighbor_list *list, spheres *spheres, const container *vessel,
                                const dem_contact_parameters *contact, double time_step, int threads, bool *looked);
/* Tell the list of a finished step: the largest |v - v at the pick| of all spheres, m/s. */
static inline void neighbor_list_step_done(neighbor_list *list, double largest_deviation, double time_step)
{
    list->strayed += largest_deviation * time_step;
    list->deviation = largest_deviation;
    list->steps_since_pick++;
}

/* Contacts (overlap > 0) of each mobile sphere at the places of now, in order of memory or (id not NULL) of id; the list
 * must be up to date. */
void neighbor_list_count_contacts(const neighbor_list *list, const spheres *spheres, const container *vessel, const int32_t *id,
                                  int32_t *contacts);

#endif
