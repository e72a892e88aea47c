#include "ball_points.h"

#include <math.h>

#include "dem_rules.h"

void ball_points(double points[BALL_POINTS][3])
{
    const double golden = DEM_PI * (3 - sqrt(5.0));
    for (int k = 0; k < BALL_POINTS; k++) {
        /* Directions along a spiral, distances in an order of their own (bits reversed), so that both are even. */
        int reversed = 0;
        for (int bit = 0; bit < 6; bit++) reversed |= ((k >> bit) & 1) << (5 - bit);
        const double z = 1 - (2 * k + 1.0) / BALL_POINTS, r = cbrt((reversed + 0.5) / BALL_POINTS), flat = sqrt(1 - z * z);
        points[k][0] = r * flat * cos(golden * k);
        points[k][1] = r * flat * sin(golden * k);
        points[k][2] = r * z;
    }
}
