/* What the measures share: the columns of a frame, and each measure's part of it. */
#ifndef MEASURE_H
#define MEASURE_H

#include "dem_slumps.h"
#include "scene.h"

typedef enum frame_column {
    FRAME_TIME,
    FRAME_SURFACE_FIT,
    FRAME_CENTER_OF_MASS,
    FRAME_THEIL_SEN,
    FRAME_UPPER_CHORD,
    FRAME_LOWER_CHORD,
    FRAME_CHORD,
    FRAME_SOLID_FRACTION,
    FRAME_COORDINATION,
    FRAME_AIRBORNE,
    FRAME_WALL_SLIP,
    FRAME_WALL_COVERAGE,
    FRAME_FLOW_SPEED,
    FRAME_SURFACE_LAG,
    FRAME_KINETIC_ENERGY,
    FRAME_RADIAL_INDEX,
    FRAME_TORQUE,
    FRAME_WEIGHT_TORQUE,
    FRAME_MEAN_OVERLAP,
    FRAME_OVERLAP_99,
    FRAME_TENSION
} frame_column;

/* A table of frames and the part of it that is measured. */
typedef struct frame_window {
    const double *frames; /* (count, width), the first row of the window */
    size_t count, width;
} frame_window;

/* One column as a new array, freed with free(); NULL when out of memory. */
double *frame_window_column(const frame_window *window, size_t column);
double frame_window_mean(const frame_window *window, size_t column);
double frame_window_deviation(const frame_window *window, size_t column);
frame_window frame_window_from(const frame_window *window, double time); /* the frames from then on, the last at least */
/* Frames in which the particles of a bed that slips at the wall come by again, and with them what they had of a mean: those of
 * one revolution. 0 of a bed that does not slip: it renews itself as its particles roll down. */
size_t frame_window_memory(const dem_scene *scene, const frame_window *window);
/* Standard error of a column's mean, of series with that memory. */
double frame_window_error(const dem_scene *scene, const frame_window *window, const double *column);

/* Of a bed that flows: where the climb from rest and the transient are over, which is after a quarter revolution (a quarter
 * of the run where that is shorter) or when the angle has stopped drifting, whichever is later. Of one that falls: from where
 * the surface was steepest before the first fall began. */
frame_window measure_window_of_flow(const dem_scene *scene, const frame_window *all);
frame_window measure_window_of_falls(const dem_scene *scene, const frame_window *all, double first_start);

/* Share of the frames that have a value. */
double frame_window_share_seen(const frame_window *window, size_t column);

double measure_layers(const dem_scene *scene); /* depth of the bed at mid-chord, in mean diameters */
bool measure_has_bed(const dem_scene *scene);  /* else there is no surface to measure an angle of */

/* Angles and interface of the present configuration: frame[FRAME_SURFACE_FIT ... FRAME_SOLID_FRACTION] and the
 * interface behind the scalars. contacts: (mobile spheres) of the particle that each is a part of. */
dem_status measure_repose_frame(const dem_scene *scene, const int32_t *contacts, double *frame);
void measure_repose_results(const dem_scene *scene, const frame_window *window, dem_repose_result *result);

/* Motion: frame[FRAME_AIRBORNE ... FRAME_SURFACE_LAG]; needs the frame's surface fit. */
void measure_regime_frame(dem_scene *scene, const int32_t *contacts, double *frame);
void measure_regime_results(const dem_scene *scene, const frame_window *window, const dem_repose_result *repose,
                            dem_regime_result *result);

/* Slumping or avalanching. */
bool measure_comes_in_falls(dem_regime regime);

/* Drift, verdict, and whether the regime is certain; needs all else of angle, slumps and regime. */
/* Whether the window ends late enough for its bed to be like another one: of a bed that slips at the wall, after some revolutions. */
bool measure_has_forgotten(const dem_scene *scene, const frame_window *window);
void measure_verdict(const dem_scene *scene, const frame_window *window, dem_drum_results *results);

/* The drum's torque since the last frame, whose meter it resets, and that of the bed's weight: frame[FRAME_TORQUE,
 * FRAME_WEIGHT_TORQUE]. */
void measure_drive_frame(dem_scene *scene, double *frame);
void measure_drive_results(const dem_scene *scene, const frame_window *window, dem_drive_result *result);

/* Overlaps of the contacts between spheres, shares of the smallest diameter: frame[FRAME_MEAN_OVERLAP, FRAME_OVERLAP_99]. */
dem_status measure_overlap_frame(const dem_scene *scene, double *frame);
double measure_overlap_of(const dem_scene *scene, size_t i, size_t j); /* m, of two spheres */

/* Of the contacts between spheres; NaN where none cohere, or none touch. */
double measure_tension_share(const dem_scene *scene);

/* Slumps or avalanches in a series of the bed's angle: degrees, over time in s, positive for a surface that rises with the
 * drum. NaN where there are too few of them. Errors: DEM_NO_MEMORY. */
dem_slumps measure_no_slumps(void); /* all NaN */
dem_status measure_slumps(const double *time, const double *angle, size_t count, dem_slumps *slumps);
/* The same one by one, as dem_drum_slumps_list. */
dem_status measure_slumps_list(const double *time, const double *angle, size_t count, dem_slump *slump, size_t room, size_t *found);

double measure_radial_index(const dem_scene *scene);
dem_status measure_segregation_results(const dem_scene *scene, dem_segregation_result *result);

/* dem_drum_results_measure of a drum that turns at one rate, definition.rotation_rate. */
dem_status measure_results(const dem_scene *scene, const double *frames, size_t count, dem_drum_results *results);

#endif
