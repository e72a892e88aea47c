#include "contact_list.h"

#include "array.h"

dem_status contact_list_init(contact_list *list, bool has_rolling, contact_constants constants)
{
    memset(list, 0, sizeof *list);
    list->has_rolling = has_rolling;
    list->constants = constants;
    return contact_list_reserve(list, BLOCK);
}

static void memory_free(contact_list *list)
{
    free(list->first);
    free(list->second);
    for (int c = 0; c < 3; c++) free(list->t[c]);
    free(list->t_star);
    free(list->alpha_0);
    for (int c = 0; c < 3; c++) free(list->roll[c]);
}

static void constants_free(contact_list *list)
{
    free(list->friction);
    free(list->first_radius);
    free(list->root_mass);
    free(list->radius);
    free(list->rolling_friction);
}

void contact_list_clear(contact_list *list)
{
    memory_free(list);
    constants_free(list);
    memset(list, 0, sizeof *list);
}

/* A sixteenth more than asked for: lists of a flowing bed grow and shrink by a hundredth. */
static size_t with_room(size_t count) { return round_up_to_block(count + count / 16); }

static bool memory_create(contact_list *list, size_t n)
{
    list->capacity = n;
    list->first = array_create(n, sizeof *list->first);
    list->second = array_create(n, sizeof *list->second);
    for (int c = 0; c < 3; c++) list->t[c] = array_create(n, sizeof *list->t[c]);
    list->t_star = array_create(n, sizeof *list->t_star);
    list->alpha_0 = array_create(n, sizeof *list->alpha_0);
    for (int c = 0; list->has_rolling && c < 3; c++) list->roll[c] = array_create(n, sizeof *list->roll[c]);
    return list->first && list->second && list->t[0] && list->t[1] && list->t[2] && list->t_star && list->alpha_0
           && (!list->has_rolling || (list->roll[0] && list->roll[1] && list->roll[2]));
}

static bool constants_create(contact_list *list, size_t n)
{
    list->constant_capacity = n;
    list->friction = array_create(n, sizeof *list->friction);
    list->first_radius = array_create(n, sizeof *list->first_radius);
    list->root_mass = array_create(n, sizeof *list->root_mass);
    list->radius = array_create(n, sizeof *list->radius);
    if (list->has_rolling) list->rolling_friction = array_create(n, sizeof *list->rolling_friction);
    return list->friction && list->first_radius && list->root_mass && list->radius
           && (!list->has_rolling || list->rolling_friction);
}

dem_status contact_list_reserve(contact_list *list, size_t count)
{
    contact_list grown = *list;
    if (count > list->capacity) {
        if (!memory_create(&grown, with_room(count))) {
            memory_free(&grown);
            return DEM_NO_MEMORY;
        }
        memory_free(list);
        *list = grown;
    }
    const size_t constants[] = { [CONSTANTS_OF_NONE] = 0, [CONSTANTS_OF_ALL] = BLOCK, [CONSTANTS_OF_EACH] = count };
    if (constants[list->constants] > list->constant_capacity) {
        if (!constants_create(&grown, with_room(constants[list->constants]))) {
            constants_free(&grown);
            return DEM_NO_MEMORY;
        }
        constants_free(list);
        *list = grown;
    }
    return DEM_OK;
}

void contact_list_forget(contact_list *list, size_t slot)
{
    const contact_history nothing = { .t = { 0 } };
    contact_list_set_history(list, slot, &nothing);
}

void contact_list_pad(contact_list *list, int32_t first, int32_t second)
{
    const bool of_each = list->constants == CONSTANTS_OF_EACH;
    for (size_t k = list->count; k < round_up_to_block(list->count); k++) {
        list->first[k] = first;
        list->second[k] = second;
        if (of_each) list->friction[k] = list->first_radius[k] = list->root_mass[k] = list->radius[k] = 0;
        if (of_each && list->has_rolling) list->rolling_friction[k] = 0;
        contact_list_forget(list, k);
    }
}

contact_history contact_list_history(const contact_list *list, size_t k)
{
    contact_history history = { .t = { list->t[0][k], list->t[1][k], list->t[2][k] },
                                .t_star = list->t_star[k],
                                .alpha_0 = list->alpha_0[k] };
    for (int c = 0; list->has_rolling && c < 3; c++) history.roll[c] = list->roll[c][k];
    return history;
}

void contact_list_set_history(contact_list *list, size_t k, const contact_history *history)
{
    for (int c = 0; c < 3; c++) list->t[c][k] = history->t[c];
    list->t_star[k] = history->t_star;
    list->alpha_0[k] = history->alpha_0;
    for (int c = 0; list->has_rolling && c < 3; c++) list->roll[c][k] = history->roll[c];
}

void contact_list_copy(contact_list *to, size_t slot, const contact_list *from, size_t k)
{
    const contact_history history = contact_list_history(from, k);
    contact_list_set_history(to, slot, &history);
    to->first[slot] = from->first[k];
    to->second[slot] = from->second[k];
    if (from->constants != CONSTANTS_OF_EACH) return;
    to->friction[slot] = from->friction[k];
    to->first_radius[slot] = from->first_radius[k];
    to->root_mass[slot] = from->root_mass[k];
    to->radius[slot] = from->radius[k];
    if (from->has_rolling) to->rolling_friction[slot] = from->rolling_friction[k];
}

void contact_list_copy_constants(contact_list *to, const contact_list *from)
{
    if (from->constants != CONSTANTS_OF_ALL) return;
    memcpy(to->friction, from->friction, BLOCK * sizeof *to->friction);
    memcpy(to->first_radius, from->first_radius, BLOCK * sizeof *to->first_radius);
    memcpy(to->root_mass, from->root_mass, BLOCK * sizeof *to->root_mass);
    memcpy(to->radius, from->radius, BLOCK * sizeof *to->radius);
    if (from->has_rolling) memcpy(to->rolling_friction, from->rolling_friction, BLOCK * sizeof *to->rolling_friction);
}

int contact_list_memory(const contact_list *list, real *memory[CONTACT_NUMBERS])
{
    real *const all[CONTACT_NUMBERS] = { list->t[0],    list->t[1],    list->t[2],    list->t_star,
                                         list->alpha_0, list->roll[0], list->roll[1], list->roll[2] };
    memcpy(memory, all, sizeof all);
    return list->has_rolling ? CONTACT_NUMBERS : CONTACT_NUMBERS - 3;
}

static void take_memory(contact_list *to, const contact_list *from)
{
    to->count = from->count;
    to->capacity = from->capacity;
    to->first = from->first;
    to->second = from->second;
    to->t_star = from->t_star;
    to->alpha_0 = from->alpha_0;
    memcpy(to->t, from->t, sizeof to->t);
    memcpy(to->roll, from->roll, sizeof to->roll);
}

void contact_list_swap(contact_list *a, contact_list *b)
{
    const contact_list c = *a;
    take_memory(a, b);
    take_memory(b, &c);
}

/* Where a contact is in the order of lists. */
static inline uint64_t place_in_order(const contact_list *list, size_t slot)
{
    return (uint64_t)(uint32_t)list->first[slot] << 32 | (uint32_t)list->second[slot];
}

/* The first slot that is not before `place`. */
static size_t slot_at(const contact_list *list, uint64_t place)
{
    size_t low = 0, high = list->count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (place_in_order(list, middle) < place) low = middle + 1;
        else high = middle;
    }
    return low;
}

void contact_list_carry(contact_list *list, const contact_list *before, size_t from, size_t to)
{
    /* Both are ordered, so one walk along each is enough. */
    size_t old = from < to ? slot_at(before, place_in_order(list, from)) : 0;
    for (size_t k = from; k < to; k++) {
        const uint64_t place = place_in_order(list, k);
        while (old < before->count && place_in_order(before, old) < place) old++;
        if (old < before->count && place_in_order(before, old) == place) {
            const contact_history history = contact_list_history(before, old);
            contact_list_set_history(list, k, &history);
        } else {
            contact_list_forget(list, k);
        }
    }
}
