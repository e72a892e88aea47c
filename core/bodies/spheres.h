/* The spheres of a scene. In memory the mobile ones come first, then the lining's, then two that only the padding of lists
 * names: both have the radius zero, one is at the origin, the other far away. Among the mobile ones, single spheres
 * (particles by themselves) come first, then the spheres of clusters, cluster after cluster. Both kinds are sorted by
 * place for speed (sorting.h); an id tells which sphere of the definition it is. */
#ifndef SPHERES_H
#define SPHERES_H

#include "cluster.h"
#include "team.h"

/* What a contact reads of a sphere: a row, which is half a cache line in single precision, and a rest, what does not fit into
 * it. wide.h depends on the order of their members. */
typedef struct sphere_row {
    on_ring place[3];
    real omega_x; /* rad/s, half a step behind the place, as all motion */
    real v[3];    /* m/s */
    real omega_y; /* rad/s */
} __attribute__((aligned(8 * sizeof(real)))) sphere_row;
typedef struct sphere_rest {
    real omega_z; /* rad/s */
    real radius;  /* m, now (smaller while growing) */
} sphere_rest;

/* Place (in ring units), velocity and spin of a step; the radius stays. */
static inline void sphere_row_store(sphere_row *row, sphere_rest *rest, vector4 place, vector4 v, vector4 omega)
{
    const half_row w = half_row_of(omega), front = half_row_place(place, w), back = half_row_velocity(half_row_of(v), w);
    memcpy(row->place, &front, sizeof front);
    memcpy(row->v, &back, sizeof back);
    rest->omega_z = w[2];
}

/* Of a sphere that was at the bed's inner surface when the drum's present revolution began (measure_regime.c). */
typedef struct surface_track {
    float angle; /* rad: its azimuth in the frame of the drum when last looked at */
    float way;   /* rad: by which that has grown since the revolution began, less than 0 where it lags; NaN of all other spheres */
} surface_track;

typedef struct spheres {
    size_t mobile_count, lining_count;
    size_t single_count; /* of the mobile: particles by themselves */
    size_t species_count;
    clusters clusters; /* the bodies that the other mobile spheres make up */
    sphere_row *row;   /* (row_count) mobile, lining, two of the padding; from first_copy on, the halo (contact_parts.h) */
    sphere_rest *rest; /* (row_count) */
    size_t row_count, first_copy;
    vector4 *place;            /* (mobile + lining + 2) m, z within one period */
    double ring_units;         /* 1/m: of a row's place */
    int32_t *id;               /* (mobile) which sphere of the definition's it is, wherever it is in memory */
    int32_t *species;          /* (mobile) */
    int32_t *kind;             /* (mobile) whose mass it has: its species, or its own, by its id, where the species has sizes */
    real *full_radius;         /* (mobile + lining) m */
    vector4 *velocity;         /* (mobile) m/s at the half step */
    vector4 *angular_velocity; /* (mobile) rad/s at the half step */
    /* (load_count) force N, torque N m about the centre, 0, 0: of contacts only; zeros except between the forces and the motion.
     * Behind the loads of the mobile spheres are padding loads, which are never read (padding_loads). */
    row8 *load;
    size_t load_count;
    double *inverse_mass;                       /* (kinds) 1/kg, of a particle */
    double *inverse_inertia;                    /* (kinds) 1/(kg m2), of those that are spheres by themselves */
    float *fallen_time;                         /* (mobile) s since rotation began when last seen nearer the axis than R_i - 2d */
    surface_track *surface_track;               /* (mobile) */
    vector4 *lining_place;                      /* (lining) m, when the drum has not turned */
    double smallest_diameter, largest_diameter; /* m, mobile */
    double largest_reach;                       /* m: radius of the smallest sphere that can hold any of the particles */
    double small_below, large_from; /* m: radii between the thirds of the particles by size; of one species with sizes */
    bool of_one_kind;               /* all mobile spheres are of one species, without sizes */
    bool have_sizes;                /* spheres of one species are not all alike */
    bool are_many;                  /* too many for the cache of one core: prefetching the next spheres pays */
    bool exceed_caches;             /* too many for the shared cache, too: prefetching what is read in order pays */
    bool in_waves;                  /* it pays to take several steps in one pass through memory: wave.h */
    double scale;                   /* share of full size that the mobile spheres have now */
    /* written in each step, apart from what all threads read */
    _Alignas(ALIGNMENT) int front_copy; /* 0 or 1: which of the two sets of copies of rows (the halo) the next step reads */
    bool copies_hold;                   /* that set equals the rows of now */
} spheres;

/* An array of the spheres: everything that is done with each of them alike follows from its row in this table. */
typedef enum sphere_array_length {
    OF_MOBILE,
    OF_MOBILE_AND_LINING,
    OF_PLACES,
    OF_ROWS,
    OF_LINING,
    OF_KINDS,
    OF_LOADS
} sphere_array_length;
typedef struct sphere_array {
    size_t offset, size; /* of the pointer to it, in spheres; of an element */
    sphere_array_length length;
    bool is_sorted;    /* goes where its sphere goes in memory */
    const char *saved; /* name in a saved state; NULL: it is made again */
    int columns;       /* of what is saved */
    bool is_float;     /* the elements are so many floats, else as many doubles or more */
    bool is_optional;  /* a state may be without it */
} sphere_array;
enum { SPHERE_ARRAYS = 15 };
extern const sphere_array sphere_arrays[SPHERE_ARRAYS];
void *sphere_array_of(const spheres *spheres, const sphere_array *array);

dem_status spheres_init(spheres *spheres, const dem_scene_definition *definition, size_t lining_count);
void spheres_clear(spheres *spheres);
size_t spheres_count(const spheres *spheres); /* mobile and lining */
/* How rows are laid out is the business of the step's own files; all others ask here. */
static inline const double *sphere_place(const spheres *s, size_t i) { return (const double *)&s->place[i]; } /* (3) m */
static inline void sphere_set(spheres *s, size_t i, vector4 x, vector4 v, vector4 omega)
{
    s->place[i] = x;
    if (i < s->mobile_count) {
        s->copies_hold = false;
        s->velocity[i] = v;
        s->angular_velocity[i] = omega;
    }
    sphere_row_store(&s->row[i], &s->rest[i], x * s->ring_units, v, omega);
}
static inline void sphere_set_place(spheres *s, size_t i, const double x[3])
{
    const vector4 place = { x[0], x[1], x[2] };
    sphere_set(s, i, place, s->velocity[i], s->angular_velocity[i]);
}
static inline double sphere_inverse_mass(const spheres *s, size_t i) /* 1/kg, of the particle that it is or is a part of */
{
    return s->inverse_mass[s->kind[i]];
}
static inline double sphere_radius(const spheres *s, size_t i) { return (double)s->rest[i].radius; } /* m, now */
static inline int32_t sphere_of_zeros(const spheres *s) { return (int32_t)(s->mobile_count + s->lining_count); }
static inline int32_t sphere_far_away(const spheres *s) { return sphere_of_zeros(s) + 1; }
/* Particles: spheres by themselves, then clusters. */
static inline size_t particles_count(const spheres *s) { return s->single_count + s->clusters.count; }
static inline const double *particle_place(const spheres *s, size_t p) /* (3) m, centre of mass */
{
    return p < s->single_count ? sphere_place(s, p) : s->clusters.body[p - s->single_count].x;
}
static inline int32_t particle_species(const spheres *s, size_t p)
{
    return p < s->single_count ? s->species[p] : s->clusters.body[p - s->single_count].species;
}
static inline double particle_mass(const spheres *s, size_t p)
{
    return p < s->single_count ? 1 / sphere_inverse_mass(s, p)
                               : s->clusters.shape[s->clusters.body[p - s->single_count].species].mass;
}
static inline double particle_reach(const spheres *s, size_t p) /* m, at full size */
{
    return p < s->single_count ? s->full_radius[p] : s->clusters.shape[particle_species(s, p)].reach;
}
static inline size_t particle_of_sphere(const spheres *s, size_t i)
{
    return i < s->single_count ? i : s->single_count + (size_t)s->clusters.of_sphere[i - s->single_count];
}

/* Whose id is wanted outside: spheres by themselves in order of species, then clusters. */
static inline int32_t particle_id(const spheres *s, size_t p)
{
    return p < s->single_count ? s->id[p] : s->clusters.body[p - s->single_count].id;
}

/* The kind of a sphere by itself, of that id, whose species has sizes. */
static inline int32_t kind_of_id(const spheres *s, size_t id) { return (int32_t)(s->species_count + id); }
/* How many particles a species has: shares by number, every species within one of its share, the total exact. */
size_t species_particles(const dem_scene_definition *definition, size_t species);
/* Sets the unit of the rows' places; to be called before any place is set. Rows keep places modulo a length, which is the period
 * along z, a whole part of it, or some diameters. period: m; 0: not periodic. */
void spheres_set_period(spheres *spheres, const dem_scene_definition *definition, double period);
/* The first padding load of a part: forces on spheres that the part does not own are added there. Each part has its own, so that
 * no two threads write to one cache line. */
enum { LOADS_A_PART = 8, PADDING_LOADS = LOADS_A_PART * (MOST_PARTS + 1) };
static inline size_t padding_loads(const spheres *s, int part) { return s->load_count - LOADS_A_PART * (size_t)(part + 1); }
/* Makes room for `count` copies of rows behind all others. Errors: DEM_NO_MEMORY. */
dem_status spheres_reserve_copies(spheres *spheres, size_t count);
void spheres_forget_surface(spheres *spheres); /* no sphere was seen at the bed's inner surface */
void spheres_pad(spheres *spheres);            /* the last two rows, also after a change of the counts */
/* Radii of the mobile spheres at `scale` of their full size, in the rows. */
void spheres_set_scale(spheres *spheres, double scale);
double spheres_kinetic_energy(const spheres *spheres); /* J */

#endif
