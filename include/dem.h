/* The granular core's public face: make a scene, advance it, look at it, save it, measure it.
 *
 * The core is a library of the numbers alone: it opens no file, prints nothing, reads no clock and never exits.
 * Every function that can fail returns a dem_status. */
#ifndef DEM_H
#define DEM_H

#include "dem_types.h"

typedef struct dem_scene dem_scene;

/* A scene of the drum with its particles placed at random, at step 0 of DEM_PHASE_GROWING.
 * definition: checked (DEM_BAD_PARAMETER); copied. *scene: freed with dem_scene_free; NULL on failure.
 * Errors: DEM_NO_MEMORY, DEM_BAD_PARAMETER, DEM_DOES_NOT_FIT. */
dem_status dem_scene_create(const dem_scene_definition *definition, dem_scene **scene);
void dem_scene_free(dem_scene *scene);

/* Advance by `steps` time steps, passing from growing to settling to rotating as each phase ends.
 * Stops early with the failure described by dem_scene_failure. The same bits for any number of threads and
 * for any way of dividing the steps into calls. */
dem_status dem_scene_advance(dem_scene *scene, int64_t steps);
/* The same, of at most `steps`: no further than to the first step of rotation. */
dem_status dem_scene_advance_to_run(dem_scene *scene, int64_t steps);
const dem_failure *dem_scene_failure(const dem_scene *scene);

/* From now on `profile` is filled, until it is set to NULL; it must live as long. Nothing computed depends on it,
 * but a step then takes its parts one after the other, which is a tenth slower. */
void dem_scene_set_profile(dem_scene *scene, dem_step_profile *profile);

dem_phase dem_scene_phase(const dem_scene *scene);
int64_t dem_scene_step_count(const dem_scene *scene);    /* since creation */
int64_t dem_scene_run_start(const dem_scene *scene);     /* step at which rotation began; -1 before */
double dem_scene_turned(const dem_scene *scene);         /* rad that the drum has turned, in all runs from which this one goes on */
double dem_scene_time(const dem_scene *scene);           /* s since rotation began; negative before: less the time since creation */
size_t dem_scene_particle_count(const dem_scene *scene); /* mobile particles, each sphere or cluster one; without the lining */
size_t dem_scene_sphere_count(const dem_scene *scene);   /* spheres that these are made of */
size_t dem_scene_lost_count(const dem_scene *scene);     /* particles that fell off the plate, or left by the orifice */
bool dem_scene_has_clusters(const dem_scene *scene);
double dem_scene_maximum_overlap(const dem_scene *scene); /* since rotation began, as a share of the smallest diameter */
double dem_scene_kinetic_energy(const dem_scene *scene);  /* J, translation and rotation */

/* Fill the arrays that are not NULL; each has dem_scene_sphere_count rows. */
void dem_scene_particles(const dem_scene *scene, const dem_particle_arrays *arrays);

/* Of the particles with these ids, from 0 to dem_scene_particle_count: place of the centre of mass (m), velocity (m/s) and angular
 * velocity (rad/s), each (count, DEM_TRACER_NUMBERS); NaN of those that are not in the container. */
enum { DEM_TRACER_NUMBERS = 9 };
void dem_tracers_measure(const dem_scene *scene, const int32_t *ids, size_t count, double *numbers);

/* Save and restore. A scene created from the same definition and restored continues bit for bit.
 * Errors: DEM_NO_MEMORY; DEM_STATE_MISMATCH from restore. */
dem_status dem_scene_save(const dem_scene *scene, dem_state *state);
void dem_state_clear(dem_state *state);
dem_status dem_scene_restore(dem_scene *scene, const dem_state *state);

/* A bed made before, instead of one at random: for scenes whose definition says is_placed, before anything else is done
 * with them. Rotation begins at once; time and largest overlap count from here.
 * place: particles in any order; within a species they get their ids in the order given. No contact remembers anything.
 * turned: rad by which the drum, its lining and its lifters have turned already.
 * continue: from a scene of the same container and particles, saved while it rotated. The container's turn and every
 * contact's memory go on (memory is dropped where the contact law is another); all else may differ. With the same
 * definition it goes on with the same bits.
 * Errors: DEM_STATE_MISMATCH (other particles, or never rotated), DEM_NO_MEMORY, and those of dem_scene_advance. */
dem_status dem_scene_place(dem_scene *scene, const dem_placed_particle *particles, size_t count, double turned);
dem_status dem_scene_continue(dem_scene *scene, const dem_state *state);

/* Measuring: the caller takes frames at regular intervals of simulated time while the drum rotates, keeps
 * them as rows of a table (with the checkpoint, too), and asks for the results from the table at the end.
 * A frame is dem_frame_width numbers; the first DEM_FRAME_SCALARS have the names that dem_frame_scalar_name
 * gives ("time", "angle_deg", ...), the rest is the interface's height over x. */
enum { DEM_FRAME_SCALARS = 21 };
size_t dem_frame_width(const dem_scene *scene);
const char *dem_frame_scalar_name(size_t index); /* NULL beyond the last */
dem_status dem_frame_measure(dem_scene *scene, double *frame);

/* frames: (count, dem_frame_width) in order of time. NaN where something could not be measured.
 * Errors: DEM_TOO_FEW_FRAMES (fewer than 8), DEM_NO_MEMORY. */
dem_status dem_drum_results_measure(const dem_scene *scene, const double *frames, size_t count, dem_drum_results *results);

/* The same of one stage of the drum's rotation alone, as if it were a run of its own that turns the positive way: of a stage with a
 * rate below 0 the frames are mirrored. Of a stage of rest there is neither verdict nor regime, and its angles have no error.
 * dem_drum_results_measure of a drum with stages gives the last one in which it turns. */
dem_status dem_drum_stage_measure(const dem_scene *scene, size_t stage, const double *frames, size_t count,
                                  dem_drum_results *results);
/* Of `count` beds of one definition that differ in their seeds: verdict, steady, drift and its bound of all of them together,
 * into *all, whose other members stay as they are. Of one bed: what it says itself. */
void dem_drum_results_of_beds(const dem_drum_results *beds, size_t count, dem_repose_result *all);

/* Fields over the cross-section, averaged over frames: the caller keeps a table of dem_fields_size numbers, all zero at
 * first, adds to it at regular intervals while the drum rotates, and asks for the fields at the end. The grid has
 * dem_fields_cells a side, over the drum's diameter. */
size_t dem_fields_cells(const dem_scene *scene);
size_t dem_fields_size(const dem_scene *scene);
/* Errors: DEM_NO_MEMORY. */
dem_status dem_fields_add(const dem_scene *scene, double *sums);
/* Fill the arrays that are not NULL. */
void dem_fields_measure(const dem_scene *scene, const double *sums, const dem_field_arrays *arrays);

/* How this library was built: the instruction set it needs ("avx512", "avx2", "plain": any x86-64), and what contacts are
 * computed in ("single", "double"). In one precision, results have the same bits by any instruction set. */
const char *dem_build_isa(void);
const char *dem_build_precision(void);

const char *dem_status_text(dem_status status);
const char *dem_phase_name(dem_phase phase);                /* "growing", "settling", "rotating" */
const char *dem_scene_phase_name(const dem_scene *scene);   /* the same, or "filling", "lifting", "flowing" where that is it */
const char *dem_step_part_name(dem_step_part part);         /* "outer list", ... */
const char *dem_regime_name(dem_regime regime);             /* "slipping", ... */
const char *dem_verdict_name(dem_verdict verdict);          /* "steady", "drifting", "too-short", "too-few"; NULL: none */
const char *dem_angle_method_name(dem_angle_method method); /* "surface-fit", "center-of-mass", ... */

#endif
