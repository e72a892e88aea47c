/* The stream that fills a cylinder: where its inlet is, how fast particles enter, and how many of them it lets through.
 * A part of the rules (dem_rules.h). Reasons: core/NUMERICS.md, "The stream". */
#ifndef DEM_STREAM_H
#define DEM_STREAM_H

#include "dem_rules.h"

/* Solid share of the inlet's flow up to which a random free place is found at once: random placing jams at 0.38, and
 * particles that bounce back want room too. */
#define DEM_STREAM_MOST_SOLID 0.15

double dem_stream_widest(const dem_scene_definition *d);

/* m from the level of the bed up to the inlet: a mound as steep as 37 degrees below it, and three particles more. */
double dem_stream_clearance(const dem_scene_definition *d);

/* Clusters pack looser than spheres. */
double dem_stream_usual_fraction(const dem_scene_definition *d);

/* Solid fraction that the level of the bed is counted by. A bed that is so high that it would come half the way up to the inlet,
 * were it as loose as its particles lie in a cylinder as narrow as this, is counted by that. */
double dem_stream_bed_fraction(const dem_scene_definition *d);

/* m, of a flat bed of so many particles at a solid fraction. */
double dem_stream_height(const dem_scene_definition *d, double particles, double solid_fraction);

/* m above the floor: level of a bed of so many particles, were it flat. */
double dem_stream_level(const dem_scene_definition *d, double particles);

/* m above the floor, of the centre of a particle that enters after so many others. */
double dem_stream_inlet_height(const dem_scene_definition *d, double particles);

/* m/s: what falls from the inlet to the level of the bed arrives with at least this. */
double dem_stream_least_impact_speed(const dem_scene_definition *d);

/* m/s, downward at the inlet; NaN where impact_speed is below the least. */
double dem_stream_entry_speed(const dem_scene_definition *d);

/* Particles a second that make up `solid` of the flow at a speed. */
double dem_stream_rate(const dem_scene_definition *d, double solid, double speed);

/* 1/s: more would clog the inlet. */
double dem_stream_most_rate(const dem_scene_definition *d);

#endif
