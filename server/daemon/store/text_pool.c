/* Each text once (job_index_rows.h). */
#include <stdlib.h>
#include <string.h>

#include "job_index_rows.h"

/* FNV-1a, begun at a place that nobody outside knows, so that nobody makes texts which all have one. */
static uint64_t hash_of(const text_pool *pool, const char *text)
{
    uint64_t hash = 0xcbf29ce484222325U ^ (uintptr_t)pool;
    for (; *text; text++) hash = (hash ^ (unsigned char)*text) * 0x100000001b3U;
    return hash ^ (hash >> 32);
}

const char *text_pool_text(const text_pool *pool, uint32_t index) { return pool->text + pool->offset[index]; }

/* The slot of a text, or the free one where it belongs. */
static size_t find_slot(const text_pool *pool, const char *text)
{
    size_t slot = hash_of(pool, text) & (pool->slots - 1);
    while (pool->slot[slot] && strcmp(text_pool_text(pool, pool->slot[slot] - 1), text) != 0) slot = (slot + 1) & (pool->slots - 1);
    return slot;
}

/* Half of the slots at least are free. */
static bool make_slots(text_pool *pool)
{
    if (2 * (pool->count + 1) <= pool->slots) return true;
    const size_t slots = pool->slots ? 2 * pool->slots : 16;
    uint32_t *slot = calloc(slots, sizeof *slot);
    if (!slot) return false;
    free(pool->slot);
    pool->slot = slot;
    pool->slots = slots;
    for (uint32_t t = 0; t < pool->count; t++) pool->slot[find_slot(pool, text_pool_text(pool, t))] = t + 1;
    return true;
}

static bool make_room(text_pool *pool, size_t length)
{
    if (pool->count == pool->most) {
        const size_t most = pool->most + pool->most / 2 + 16;
        uint32_t *offset = realloc(pool->offset, most * sizeof *offset);
        if (offset) pool->offset = offset;
        uint32_t *users = realloc(pool->users, most * sizeof *users);
        if (users) pool->users = users;
        if (!offset || !users) return false;
        pool->most = most;
    }
    if (pool->used + length <= pool->room) return true;
    const size_t room = pool->used + length + pool->room / 2;
    char *text = room < UINT32_MAX ? realloc(pool->text, room) : NULL;
    if (!text) return false;
    pool->text = text;
    pool->room = room;
    return true;
}

bool text_pool_add(text_pool *pool, const char *text, uint32_t *index)
{
    const size_t length = strlen(text) + 1;
    if (!make_slots(pool)) return false;
    const size_t slot = find_slot(pool, text);
    if (!pool->slot[slot]) {
        if (!make_room(pool, length)) return false;
        memcpy(pool->text + pool->used, text, length);
        pool->offset[pool->count] = (uint32_t)pool->used;
        pool->users[pool->count] = 0;
        pool->used += length;
        pool->slot[slot] = (uint32_t)++pool->count;
        pool->unused++;
    }
    *index = pool->slot[slot] - 1;
    if (pool->users[*index]++ == 0) pool->unused--;
    return true;
}

void text_pool_leave(text_pool *pool, uint32_t index)
{
    if (--pool->users[index] == 0) pool->unused++;
}

void text_pool_clear(text_pool *pool)
{
    free(pool->text);
    free(pool->offset);
    free(pool->users);
    free(pool->slot);
    *pool = (text_pool){ .count = 0 };
}
