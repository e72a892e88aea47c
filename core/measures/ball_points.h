/* A ball stands as points of equal volume, spread evenly over it, so that a region's share of it is counted. */
#ifndef BALL_POINTS_H
#define BALL_POINTS_H

enum { BALL_POINTS = 64 };

/* Of the ball of radius 1 about the origin. */
void ball_points(double points[BALL_POINTS][3]);

#endif
