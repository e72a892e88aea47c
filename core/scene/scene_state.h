/* How a saved scene is laid out: the arrays "counters", "numbers" and "cluster" by column. The others name themselves. */
#ifndef SCENE_STATE_H
#define SCENE_STATE_H

#include "scene.h"

/* "counters" (1, STATE_INTEGERS) */
enum {
    STATE_PHASE,
    STATE_STEP,
    STATE_PHASE_START,
    STATE_RUN_START,
    STATE_STEPS_BEFORE,
    STATE_LAW, /* for whoever goes on with another: what contacts remember is of this one */
    STATE_INTEGERS
};

/* "numbers" (1, STATE_NUMBERS) */
enum {
    STATE_OVERLAP, /* m */
    STATE_TORQUE_SUM,
    STATE_TORQUE_COUNT,
    STATE_ANGLE_BEFORE, /* rad */
    STATE_RATE,         /* rad/s */
    STATE_TIME_STEP,    /* s */
    STATE_NUMBERS
};

/* "cluster" (clusters, CLUSTER_NUMBERS): what a cluster's spheres don't tell of it. */
enum {
    CLUSTER_PLACE = 0,
    CLUSTER_VELOCITY = 3,
    CLUSTER_SPIN = 6,
    CLUSTER_SPIN_CHANGE = 9,
    CLUSTER_ORIENTATION = 12,
    CLUSTER_NUMBERS = 16
};

/* NULL: not there, or of another kind. */
const dem_state_array *state_find(const dem_state *state, const char *name, dem_element element, size_t columns);

#endif
