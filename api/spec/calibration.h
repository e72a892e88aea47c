/* How fast this machine computes: what `repose calibrate` measured, as DATA/calibration.json keeps it.
 *
 * One run's cost is its sphere-steps times the cost of one, which depends on the law, on whether spheres are joined to
 * clusters, on how many there are (caches) and on how many touch. */
#ifndef CALIBRATION_H
#define CALIBRATION_H

#include <jansson.h>
#include <stdbool.h>

#include "dem_types.h"

#define CALIBRATION_FILE "calibration.json"

enum { CALIBRATION_LAWS = DEM_HERTZ_MINDLIN + 1, CALIBRATION_SIZES = 3, CALIBRATION_TEXT = 160 };

typedef struct calibration {
    char processor[CALIBRATION_TEXT]; /* whose speed this is; "": nobody's, the built-in figures */
    char program[CALIBRATION_TEXT];   /* which build of repose was measured */
    char made[32];                    /* when, in UTC, as the jobs' times */
    int cores;                        /* of the machine that asks; not in the file */
    /* ns a sphere-step of one thread, in the paper's drum at friction 0.1: */
    double sphere[CALIBRATION_LAWS], cluster[CALIBRATION_LAWS];     /* clusters: tetrahedra */
    double size[CALIBRATION_SIZES], size_factor[CALIBRATION_SIZES]; /* spheres; cost relative to the paper's drum */
    double correction; /* what finished runs took over what was said of them; 1: nothing known */
} calibration;

/* Of a processor with AVX-512 near 4 GHz: for a machine on which nothing has been measured yet. */
calibration calibration_built_in(void);

/* What a step has to do. */
typedef struct calibration_load {
    double spheres;     /* all of them, those of clusters too */
    double of_particle; /* spheres that a particle has, in the mean; 1: there are no clusters */
    dem_contact_law law;
    double friction;
    bool rolling_friction;
    bool in_double; /* precision */
    int threads;    /* asked for; no more count than there are cores */
} calibration_load;

/* s of wall time for one step. machine NULL: built-in figures. */
double calibration_seconds_a_step(const calibration *machine, const calibration_load *load);

/* How many times longer this machine takes than the one on which costs beside the sphere-steps were measured. */
double calibration_pace(const calibration *machine);

/* How many of so many beds, one a thread, its cores advance at a time. */
double calibration_at_once(const calibration *machine, int beds);

/* s of wall time for a run of so many steps, with what it costs beside them. */
double calibration_seconds_a_run(const calibration *machine, const calibration_load *load, double steps);

extern const char *const contact_law_names[]; /* as in a specification, by dem_contact_law; ends with NULL */

/* False: the document is no calibration; *machine is then the built-in one. */
bool calibration_from_json(const json_t *document, calibration *machine);
json_t *calibration_to_json(const calibration *machine); /* new reference; NULL: no memory */

#endif
