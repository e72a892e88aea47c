#include "given_files.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "spec_memory.h"
#include "spec_text.h"

static bool is_csv(const char *name)
{
    const size_t length = name ? strlen(name) : 0;
    return length > 4 && strcasecmp(name + length - 4, ".csv") == 0;
}

/* What the source knows of that name. New reference; NULL: a problem says why there is none. */
static json_t *look_up(const start_source *source, given_table kind, const char *name, const char *pointer, problem_list *problems)
{
    json_t *found = source && source->table ? source->table(source->context, kind, name, pointer, problems) : NULL;
    if (!found && !(source && source->table))
        problem_list_add(problems, pointer, "is \"%.100s\", which is not to be had here; give what it holds", name);
    return found;
}

/* A copy of the object without the member, but with those of `more`. */
static json_t *with_members(const json_t *object, const char *without, json_t *more)
{
    json_t *copy = json_copy((json_t *)object);
    json_object_del(copy, without);
    json_object_update(copy, more);
    json_decref(more);
    return copy;
}

/* The list of a bed that was looked up for the case before is that very list, which is then not read again. */
static json_t *list_of(const start_source *source, given_table kind, const char *name, const char *pointer, problem_list *problems)
{
    spec_memory *memory = source ? source->memory : NULL;
    json_t *list = spec_memory_find_list(memory, name);
    if (list) return list;
    list = look_up(source, kind, name, pointer, problems);
    spec_memory_keep_list(memory, name, list);
    return list;
}

static json_t *take_start(json_t *inputs, const start_source *source, problem_list *problems)
{
    const json_t *start = json_object_get(inputs, "start");
    const char *bed = json_string_value(json_object_get(start, "bed")), *file = json_string_value(json_object_get(start, "file"));
    const bool is_table = is_csv(file);
    if (!bed && !is_table) return inputs;
    const char *name = bed ? "bed" : "file";
    char pointer[60];
    snprintf(pointer, sizeof pointer, "/inputs/start/%s", name);
    if (json_object_size(start) > 1) {
        problem_list_add(problems, pointer, "is given beside other members of start; give one of them");
        return inputs;
    }
    json_t *list = list_of(source, bed ? GIVEN_BED : GIVEN_PARTICLES, bed ? bed : file, pointer, problems);
    if (!list) return inputs;
    return with_members(inputs, "start", json_pack("{s:{s:o}}", "start", "particles", list));
}

/* Of one entry of particles; NULL: nothing to be done. New reference. */
static json_t *take_sieves(const json_t *species, size_t s, const start_source *source, problem_list *problems)
{
    const json_t *sizes = json_object_get(species, "size_distribution");
    const char *file = json_string_value(json_object_get(sizes, "file"));
    char pointer[80];
    if (!file) return NULL;
    snprintf(pointer, sizeof pointer, "/inputs/particles/%zu/size_distribution/file", s);
    json_t *table = look_up(source, GIVEN_SIEVES, file, pointer, problems);
    if (!table) return NULL;
    return with_members(species, "size_distribution", json_pack("{s:o}", "size_distribution", with_members(sizes, "file", table)));
}

static json_t *take_sizes(json_t *inputs, const start_source *source, problem_list *problems)
{
    const json_t *particles = json_object_get(inputs, "particles");
    json_t *changed = NULL, *species;
    size_t s;
    json_array_foreach(particles, s, species)
    {
        json_t *taken = take_sieves(species, s, source, problems);
        if (!taken) continue;
        if (!changed) changed = json_copy((json_t *)particles);
        json_array_set_new(changed, s, taken);
    }
    return changed ? with_members(inputs, "particles", json_pack("{s:o}", "particles", changed)) : inputs;
}

/* The inputs as they are now, of which the old reference is given up where they changed. */
static json_t *instead(json_t *inputs, json_t *taken)
{
    if (taken != inputs) json_decref(inputs);
    return taken;
}

json_t *given_files_take(json_t *inputs, const start_source *source, problem_list *problems)
{
    inputs = instead(inputs, take_start(inputs, source, problems));
    return instead(inputs, take_sizes(inputs, source, problems));
}
