/* The main inputs of a job as numbers, so that SQL can ask for them: a table a process, <process>_input. */
#include <string.h>

#include "database.h"
#include "job_store.h"
#include "process_type.h"

typedef store_status inputs_inserter(sqlite3 *writer, int64_t job, const job_spec *spec);

/* The word that a choice stands for; of a shape that is none, what it is made of. */
static const char *word_of(const job_spec *spec, spec_group group, const char *name, double choice)
{
    const spec_field *field = spec_field_find(spec->type->inputs, group, name);
    for (int c = 0; field->choices[c]; c++)
        if (c == (int)choice) return field->choices[c];
    return "spheres";
}

static store_status insert_drum(sqlite3 *writer, int64_t job, const job_spec *spec)
{
    const dem_drum_definition *drum = &spec->drum;
    return sql_run(writer, NULL, "INSERT INTO drum_input VALUES(?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)",
                   "idddddii"
                   "dddddddddd"
                   "ititdd",
                   job, drum->diameter, drum->length, spec->inputs.rotation_rate, drum->gravity, drum->fill_fraction,
                   (int64_t)drum->particle_count, (int64_t)drum->species_count, drum->species[0].diameter, drum->species[0].density,
                   drum->contact.friction, drum->contact.restitution, drum->contact.wall_friction,
                   drum->contact.tangential_stiffness_ratio, drum->contact.stiffness, drum->lining.diameter, drum->time_step,
                   spec->duration, (int64_t)drum->seed, word_of(spec, SPEC_DRUM, "ends", spec->inputs.drum_ends),
                   (int64_t)drum->lifters.count, word_of(spec, SPEC_PARTICLES, "shape", spec->inputs.species[0].shape),
                   drum->contact.rolling_friction, drum->contact.wall_rolling_friction);
}

static store_status insert_fill(sqlite3 *writer, int64_t job, const job_spec *spec)
{
    const dem_drum_definition *scene = &spec->drum;
    return sql_run(writer, NULL, "INSERT INTO fill_input VALUES(?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)",
                   "idddd"
                   "diiddt"
                   "dddddddidd",
                   job, scene->diameter, scene->stream.diameter, scene->stream.rate, scene->stream.impact_speed, scene->gravity,
                   (int64_t)scene->particle_count, (int64_t)scene->species_count, scene->species[0].diameter,
                   scene->species[0].density, word_of(spec, SPEC_PARTICLES, "shape", spec->inputs.species[0].shape),
                   scene->contact.friction, scene->contact.restitution, scene->contact.wall_friction,
                   scene->contact.tangential_stiffness_ratio, scene->contact.stiffness, scene->time_step, spec->duration,
                   (int64_t)scene->seed, scene->contact.rolling_friction, scene->contact.wall_rolling_friction);
}

static store_status insert_heap(sqlite3 *writer, int64_t job, const job_spec *spec)
{
    const dem_drum_definition *scene = &spec->drum;
    return sql_run(writer, NULL, "INSERT INTO heap_input VALUES(?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)",
                   "iddddd"
                   "diiddt"
                   "dddddddidd",
                   job, scene->diameter, scene->lift.speed, scene->plate.diameter, scene->plate.rim_height, scene->plate.friction,
                   scene->gravity, (int64_t)scene->particle_count, (int64_t)scene->species_count, scene->species[0].diameter,
                   scene->species[0].density, word_of(spec, SPEC_PARTICLES, "shape", spec->inputs.species[0].shape),
                   scene->contact.friction, scene->contact.restitution, scene->contact.wall_friction,
                   scene->contact.tangential_stiffness_ratio, scene->contact.stiffness, scene->time_step, spec->duration,
                   (int64_t)scene->seed, scene->contact.rolling_friction, scene->contact.wall_rolling_friction);
}

static store_status insert_granule(sqlite3 *writer, int64_t job, const job_spec *spec)
{
    const dem_granule_definition *granule = &spec->granule;
    return sql_run(writer, NULL, "INSERT INTO granule_input VALUES(?,?,?,?,?,?,?)", "idddidd", job, granule->friction,
                   granule->radius, spec->granule_inputs.rotation_rate, (int64_t)granule->revolutions, granule->gravity, granule->tolerance);
}

static const struct {
    const char *process;
    inputs_inserter *insert;
} tables[] = {
    { "drum", insert_drum },
    { "fill", insert_fill },
    { "heap", insert_heap },
    { "granule", insert_granule },
};

store_status process_inputs_insert(sqlite3 *writer, int64_t job, const job_spec *spec)
{
    for (size_t t = 0; t < sizeof tables / sizeof tables[0]; t++)
        if (strcmp(tables[t].process, spec->process) == 0) return tables[t].insert(writer, job, spec);
    return STORE_FAILED; /* a process without a table here is our own mistake */
}
