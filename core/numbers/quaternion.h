/* Orientations: the quaternions of Evans & Murad (1977) as Walton & Braun write them, Eqns 11-23. In the usual order
 * e0 = q4, e1 = q2, e2 = -q1, e3 = q3. */
#ifndef QUATERNION_H
#define QUATERNION_H

#include <math.h>

typedef struct quaternion {
    double q1, q2, q3, q4;
} quaternion;

static inline quaternion quaternion_from_wxyz(const double e[4]) { return (quaternion){ -e[2], e[1], e[3], e[0] }; }

static inline void quaternion_to_wxyz(quaternion q, double e[4])
{
    e[0] = q.q4;
    e[1] = q.q2;
    e[2] = -q.q1;
    e[3] = q.q3;
}

/* Eqns 22, 23. */
static inline quaternion quaternion_normal(quaternion q)
{
    const double f = 1.0 / sqrt(q.q1 * q.q1 + q.q2 * q.q2 + q.q3 * q.q3 + q.q4 * q.q4);
    return (quaternion){ f * q.q1, f * q.q2, f * q.q3, f * q.q4 };
}

/* Eq 11: A turns a vector's components along the axes of space into those along the axes of the body. */
static inline void quaternion_matrix(quaternion q, double a[3][3])
{
    const double q1 = q.q1, q2 = q.q2, q3 = q.q3, q4 = q.q4;
    a[0][0] = -q1 * q1 + q2 * q2 - q3 * q3 + q4 * q4;
    a[0][1] = -2 * (q1 * q2 - q3 * q4);
    a[0][2] = 2 * (q2 * q3 + q1 * q4);
    a[1][0] = -2 * (q1 * q2 + q3 * q4);
    a[1][1] = q1 * q1 - q2 * q2 - q3 * q3 + q4 * q4;
    a[1][2] = -2 * (q1 * q3 - q2 * q4);
    a[2][0] = 2 * (q2 * q3 - q1 * q4);
    a[2][1] = -2 * (q1 * q3 + q2 * q4);
    a[2][2] = -q1 * q1 - q2 * q2 + q3 * q3 + q4 * q4;
}

static inline void to_body(double a[3][3], const double space[3], double body[3])
{
    for (int c = 0; c < 3; c++) body[c] = a[c][0] * space[0] + a[c][1] * space[1] + a[c][2] * space[2];
}

static inline void to_space(double a[3][3], const double body[3], double space[3])
{
    for (int c = 0; c < 3; c++) space[c] = a[0][c] * body[0] + a[1][c] * body[1] + a[2][c] * body[2];
}

/* One step at the angular velocity omega (body's axes, half way): Eqns 15, solved by Eqns 17-21. Each line of Eqns 19
 * and 21 is printed with one beta_x that must be beta_z, as Eqns 16 and 18 have it. */
static inline quaternion quaternion_advance(quaternion q, const double omega[3], double dt)
{
    const double bx = 0.25 * dt * omega[0], by = 0.25 * dt * omega[1], bz = 0.25 * dt * omega[2];
    const double c1 = q.q1 + bz * q.q2 - bx * q.q3 - by * q.q4;
    const double c2 = -bz * q.q1 + q.q2 - by * q.q3 + bx * q.q4;
    const double c3 = bx * q.q1 + by * q.q2 + q.q3 + bz * q.q4;
    const double c4 = by * q.q1 - bx * q.q2 - bz * q.q3 + q.q4;
    const double f = 1.0 / (1.0 + bx * bx + by * by + bz * bz); /* of Eqns 20, 21: (1 + b2)/det B */
    const quaternion next = { f * (c1 + c2 * bz - c3 * bx - c4 * by), f * (-c1 * bz + c2 - c3 * by + c4 * bx),
                              f * (c1 * bx + c2 * by + c3 + c4 * bz), f * (c1 * by - c2 * bx - c3 * bz + c4) };
    return quaternion_normal(next);
}

#endif
