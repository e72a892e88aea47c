/* The rotating drum: an analytic cylinder about z, periodic along z, with or without a lining of glued spheres. */
#ifndef CONTAINER_H
#define CONTAINER_H

#include "spheres.h"

typedef struct container {
    double radius, length; /* m */
    double rotation_rate;  /* rad/s now: zero until rotation begins */
    double angle;          /* rad turned since rotation began */
    double inner_radius;   /* m, of the free room: radius less the lining's diameter */
} container;

void container_init(container *drum, const dem_drum_definition *definition);
/* Lining spheres that fit with the pitch asked for: whole numbers around and along. */
size_t container_lining_count(const dem_drum_definition *definition);
void container_place_lining(const container *drum, const dem_drum_definition *definition, spheres *spheres);
/* Turn the lining to the drum's angle, with the velocity of its place there. */
void container_turn_lining(const container *drum, spheres *spheres);

/* Height, as a share of a circle's radius, below which `share` of its area lies: -1 for 0, 1 for 1. */
double circle_level(double share);

/* z brought into [-length/2, length/2): a function of z alone, so that wrapping gives the same bits whenever done. */
static inline double wrap_axial(double z, double length, double inverse_length) { return z - length * rint(z * inverse_length); }

#endif
