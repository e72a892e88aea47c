#include "contact_list.h"

#include "array.h"

dem_status contact_list_init(contact_list *list, int extras, contact_constants constants)
{
    memset(list, 0, sizeof *list);
    list->has_rolling = (extras & CONTACTS_ROLL) != 0;
    list->laws_differ = (extras & CONTACT_LAWS_DIFFER) != 0;
    list->coheres = (extras & CONTACTS_COHERE) != 0;
    list->constants = constants;
    return contact_list_reserve(list, BLOCK);
}

static void memory_free(contact_list *list)
{
    free(list->first);
    free(list->second);
    for (int m = 0; m < CONTACT_NUMBERS; m++) free(list->memory[m]);
}

static void constants_free(contact_list *list)
{
    for (int c = 0; c < CONTACT_CONSTANTS; c++) free(list->constant[c]);
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
    bool enough = list->first && list->second;
    for (int m = 0; m < contact_list_numbers(list); m++) {
        list->memory[m] = array_create(n, sizeof *list->memory[m]);
        enough = enough && list->memory[m];
    }
    return enough;
}

static bool constants_create(contact_list *list, size_t n)
{
    list->constant_capacity = n;
    bool enough = true;
    for (int c = 0; c < CONTACT_CONSTANTS; c++) {
        if (!contact_list_keeps(list, c)) continue;
        list->constant[c] = array_create(n, sizeof *list->constant[c]);
        enough = enough && list->constant[c];
    }
    return enough;
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
    for (int m = 0; m < contact_list_numbers(list); m++) list->memory[m][slot] = 0;
}

void contact_list_pad(contact_list *list, int32_t first, int32_t second)
{
    const int constants = list->constants == CONSTANTS_OF_EACH ? CONTACT_CONSTANTS : 0;
    for (size_t k = list->count; k < round_up_to_block(list->count); k++) {
        list->first[k] = first;
        list->second[k] = second;
        for (int c = 0; c < constants; c++)
            if (contact_list_keeps(list, c)) list->constant[c][k] = 0;
        contact_list_forget(list, k);
    }
}

contact_history contact_list_history(const contact_list *list, size_t k)
{
    contact_history history = { .number = { 0 } };
    for (int m = 0; m < contact_list_numbers(list); m++) history.number[m] = list->memory[m][k];
    return history;
}

void contact_list_set_history(contact_list *list, size_t k, const contact_history *history)
{
    for (int m = 0; m < contact_list_numbers(list); m++) list->memory[m][k] = history->number[m];
}

void contact_list_copy(contact_list *to, size_t slot, const contact_list *from, size_t k)
{
    for (int m = 0; m < contact_list_numbers(from); m++) to->memory[m][slot] = from->memory[m][k];
    to->first[slot] = from->first[k];
    to->second[slot] = from->second[k];
    if (from->constants != CONSTANTS_OF_EACH) return;
    for (int c = 0; c < CONTACT_CONSTANTS; c++)
        if (contact_list_keeps(from, c)) to->constant[c][slot] = from->constant[c][k];
}

void contact_list_copy_constants(contact_list *to, const contact_list *from)
{
    if (from->constants != CONSTANTS_OF_ALL) return;
    for (int c = 0; c < CONTACT_CONSTANTS; c++)
        if (contact_list_keeps(from, c)) memcpy(to->constant[c], from->constant[c], BLOCK * sizeof(real));
}

static void take_memory(contact_list *to, const contact_list *from)
{
    to->count = from->count;
    to->capacity = from->capacity;
    to->first = from->first;
    to->second = from->second;
    memcpy(to->memory, from->memory, sizeof to->memory);
}

void contact_list_swap(contact_list *a, contact_list *b)
{
    const contact_list c = *a;
    take_memory(a, b);
    take_memory(b, &c);
}

/* The key by which lists are ordered: first sphere, then second. */
static inline uint64_t place_in_order(const contact_list *list, size_t slot)
{
    return (uint64_t)(uint32_t)list->first[slot] << 32 | (uint32_t)list->second[slot];
}

/* The first slot whose key is not less than `place`. */
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
