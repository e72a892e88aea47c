/* The passes that make forces of a block of contacts, and what goes from one to the next. */
#ifndef CONTACT_BLOCK_H
#define CONTACT_BLOCK_H

#include "contact_list.h"

/* The law is applied in short passes over a block of contacts: gather, normal, displacement, normal force, turned
 * friction, friction stiffness, friction, output. Each pass works on LANES contacts at once without branches; a
 * block's values stay in the first-level cache between passes. The passes are short so that the processor works on
 * several batches at a time: in one long pass, each batch waits for the chain of its own roots and quotients. */
typedef struct contact_block {
    real n[3][BLOCK];       /* displacement between centres, in a unit u; then unit normal, first to second */
    real distance2[BLOCK];  /* u2; to the wall: from the axis */
    real gap2[BLOCK];       /* m u: square of the distance at first touch less distance2 (wall: the reverse) */
    real reach[BLOCK];      /* u: distance at first touch; this and the next are set once where spheres are alike */
    real radii[BLOCK];      /* m, of both together; a wall has none */
    real v[3][BLOCK];       /* m/s: second less first */
    real r_omega[3][BLOCK]; /* m/s: sum of radius times spin, where the two may have different radii */
    real omega[3][BLOCK];   /* rad/s: sum of spins */
    real overlap[BLOCK];    /* m, negative: apart */
    real parting[BLOCK];    /* m/s, of the ends along n, for the damped laws */
    real ds[3][BLOCK];      /* m, tangential displacement of this step; N: times K_T0, for Walton & Braun's law */
    real f_n[BLOCK];        /* N, normal force */
    real mu_n[BLOCK];       /* N, limit of friction */
    real k_t[BLOCK];        /* N/m, tangential stiffness: of the damped laws; of all where contacts resist rolling */
    /* of Walton & Braun's law: */
    real h[3][BLOCK];   /* direction of the stored friction force, turned into the tangent plane */
    real stored[BLOCK]; /* N, magnitude of that force */
    real s_p[BLOCK];    /* N, of ds along h */
    real along[BLOCK];  /* N, of the new friction force along h */
    /* of the damped laws: */
    real stretch[3][BLOCK]; /* m, of the tangential spring, turned into the tangent plane and grown by ds */
    real compliance[BLOCK]; /* m/N, 1/k_t */
    real dashpot[BLOCK];    /* N/m, half of c_n over the step: friction has a dashpot, too */
    real force[3][BLOCK];   /* N, friction force on the first, which these laws do not remember */
    /* where contacts resist rolling: */
    real spin[3][BLOCK];   /* rad/s, first less second */
    real moment[3][BLOCK]; /* N m, of rolling friction on the first */
    /* where contacts cohere beyond touch: */
    real joined[BLOCK]; /* 1: they hold together; 0: they do not */
    /* as wide_store_rows leaves them: what the contacts give their first ends, and their second ones but for the force's sign */
    contact_row row[BLOCK];
    contact_row second_row[BLOCK]; /* the latter where ends differ */
} __attribute__((aligned(ALIGNMENT))) contact_block;

WIDE_INLINE void store_vector(real to[3][BLOCK], int k, const wide x[3])
{
    for (int c = 0; c < 3; c++) wide_store(to[c] + k, x[c]);
}

/* Everything behind the gathering, the same for spheres and walls (contact_forces.c): from the block's geometry to its
 * rows, and the list's histories from `start` on. largest: m, the largest overlaps so far. */
void contact_block_forces(contact_list *list, size_t start, contact_block *block, const dem_contact_parameters *contact,
                          bool is_wall, double dt, wide *largest);
/* The law of a block's contacts, whose geometry is in the block: sets f_n and friction (Walton & Braun's is what its
 * history remembers, else force), updates the list's histories from `start`. dt: s. */
void contact_block_walton_braun(contact_block *block, contact_list *list, size_t start, const dem_contact_parameters *contact);
void contact_block_damped_springs(contact_block *block, contact_list *list, size_t start, const dem_contact_parameters *contact,
                                  double dt);
/* Share of critical damping with which the constant torque goes over into rest (core/NUMERICS.md, "Rolling friction"). */
#define DAMPING_OF_CONSTANT_TORQUE 0.3
/* Rolling friction of a block, right after its law, which has left stiffnesses in the block: sets the moments
 * (contact_rolling.c). */
void contact_block_roll(contact_block *block, contact_list *list, size_t start, const dem_contact_parameters *contact, double dt);
/* `joined` becomes what it was a step ago: to be called before the law (contact_cohesion.c). */
void contact_block_recall(contact_block *block, const contact_list *list, size_t start);
/* What pulls beside the law's own force, which the law's friction does not feel: subtracts it from f_n. Keeps in alpha_0
 * who is joined. */
void contact_block_cohere(contact_block *block, contact_list *list, size_t start, dem_cohesion_law law, bool is_wall);

#endif
