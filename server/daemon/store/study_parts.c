#include "study_parts.h"

#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "database.h"
#include "job_store.h"
#include "json_text.h"
#include "process_type.h"
#include "spec_text.h"
#include "text_buffer.h"

/* A list of fewer spheres stays with its job. */
enum { MOST_SPHERES_WITH_JOB = 8, LONGEST_SPEC = 256 << 20 };
/* Where the lists stand in the indented text: so many objects deep. */
enum { DEPTH_OF_SPECIES = 2, DEPTH_OF_PLACED = 3 };

static const char mark[] = "\"particles\": \"part ", label_mark[] = "\n  \"label\": ";

void study_parts_init(study_parts *parts, sqlite3 *database) { *parts = (study_parts){ .database = database }; }

void study_parts_clear(study_parts *parts)
{
    for (size_t k = 0; k < KNOWN_PARTS; k++) free(parts->known[k].inputs);
    *parts = (study_parts){ .count = 0 };
}

/* --- writing --- */

/* 0: not known. */
static int64_t find_part(const study_parts *parts, const void *inputs, size_t bytes)
{
    for (size_t k = 0; k < KNOWN_PARTS; k++) {
        const known_part *part = &parts->known[k];
        if (part->inputs && part->bytes == bytes && memcmp(part->inputs, inputs, bytes) == 0) return part->number;
    }
    return 0;
}

/* 0: no memory, or the database failed. */
static int64_t add_part(study_parts *parts, const void *inputs, size_t bytes, const json_t *list, int depth)
{
    char *text = json_text_write_within(list, depth);
    void *copy = malloc(bytes);
    const bool good =
        text && copy
        && sql_run(parts->database, NULL, "INSERT INTO study_part VALUES(0,?,?)", "it", parts->count + 1, text) == STORE_OK;
    free(text);
    if (!good) {
        free(copy);
        return 0;
    }
    memcpy(copy, inputs, bytes);
    known_part *part = &parts->known[parts->count % KNOWN_PARTS]; /* the oldest gives way */
    free(part->inputs);
    *part = (known_part){ .number = ++parts->count, .bytes = bytes, .inputs = copy };
    return part->number;
}

/* The list's place in the document is taken by the part's name. inputs: what the list was written from. */
static bool put_part(study_parts *parts, const job_spec *spec, const void *inputs, size_t bytes, json_t *document, bool placed)
{
    int64_t number = find_part(parts, inputs, bytes);
    if (number == 0) {
        json_t *whole = spec_inputs_write(spec->type->inputs, (const char *)spec + spec->type->inputs_at);
        const json_t *list = json_object_get(placed ? json_object_get(whole, "start") : whole, "particles");
        number = add_part(parts, inputs, bytes, list, placed ? DEPTH_OF_PLACED : DEPTH_OF_SPECIES);
        json_decref(whole);
    }
    json_t *object = json_object_get(document, "inputs");
    if (placed) object = json_object_get(object, "start");
    return number > 0 && json_object_set_new(object, "particles", json_sprintf("part %lld", (long long)number)) == 0;
}

static size_t spheres_of(const scene_inputs *inputs)
{
    size_t spheres = 0;
    for (size_t s = 0; s < inputs->species_count; s++) spheres += 1 + inputs->species[s].sphere_count;
    return spheres;
}

char *study_parts_write(study_parts *parts, const job_spec *spec)
{
    if (spec->type->inputs_at != offsetof(job_spec, inputs)) return job_spec_to_text(spec);
    const scene_inputs *inputs = &spec->inputs;
    const bool long_species = spheres_of(inputs) > MOST_SPHERES_WITH_JOB, placed = inputs->start.particle_count > 0;
    if (!long_species && !placed) return job_spec_to_text(spec);
    job_spec *brief = malloc(sizeof *brief);
    if (!brief) return NULL;
    *brief = *spec; /* what it points to stays the spec's */
    if (long_species) brief->inputs.species_count = 0;
    brief->inputs.start.particle_count = 0;
    json_t *document = job_spec_to_json(brief);
    free(brief);
    bool good = document != NULL;
    if (good && long_species)
        good = put_part(parts, spec, inputs->species, inputs->species_count * sizeof inputs->species[0], document, false);
    if (good && placed)
        good =
            put_part(parts, spec, inputs->start.particles, inputs->start.particle_count * sizeof(start_particle), document, true);
    char *text = good ? json_text_write(document) : NULL;
    json_decref(document);
    return text;
}

/* --- reading --- */

static bool add_part_text(text_buffer *out, sqlite3 *database, int64_t study, int64_t number)
{
    sqlite3_stmt *statement = sql_prepare(database, "SELECT text FROM study_part WHERE study=? AND number=?", "ii", study, number);
    if (!statement) return false;
    const int code = sqlite3_step(statement);
    const bool found = code == SQLITE_ROW;
    if (found) text_buffer_add(out, (const char *)sqlite3_column_text(statement, 0), (size_t)sqlite3_column_bytes(statement, 0));
    return sql_finish(statement, code) == STORE_OK && found;
}

/* The label, which is the user's and comes last, is left as it is. */
char *study_parts_expand(sqlite3 *database, int64_t study, const char *text)
{
    const char *end = strstr(text, label_mark), *at = text;
    text_buffer out;
    text_buffer_init(&out, LONGEST_SPEC);
    bool good = true;
    for (const char *next; study && good && (next = strstr(at, mark)) != NULL && (!end || next < end);) {
        const char *number = next + strlen(mark);
        text_buffer_add(&out, at, (size_t)(number - strlen("\"part ") - at));
        char *rest;
        good = add_part_text(&out, database, study, strtoll(number, &rest, 10)) && *rest == '"';
        at = rest + 1;
    }
    if (good) text_buffer_add(&out, at, strlen(at));
    if (good && !out.failed) return out.text;
    text_buffer_clear(&out);
    return NULL;
}
