#include "contact_list.h"

dem_status contact_list_init(contact_list *list, size_t sphere_count, bool has_rolling)
{
    memset(list, 0, sizeof *list);
    list->has_rolling = has_rolling;
    list->start = array_create(sphere_count + 1, sizeof *list->start);
    if (!list->start) return DEM_NO_MEMORY;
    return contact_list_reserve(list, BLOCK);
}

static void slots_free(contact_list *list)
{
    free(list->first);
    free(list->second);
    free(list->friction);
    free(list->first_radius);
    free(list->mass);
    for (int c = 0; c < 3; c++) free(list->t[c]);
    free(list->t_star);
    free(list->alpha_0);
    free(list->rolling_friction);
    for (int c = 0; c < 3; c++) free(list->roll[c]);
    free(list->overlap);
    free(list->to_first);
    free(list->to_second);
}

void contact_list_clear(contact_list *list)
{
    slots_free(list);
    free(list->start);
    memset(list, 0, sizeof *list);
}

static bool rolling_create(contact_list *list)
{
    list->rolling_friction = array_create(list->capacity, sizeof *list->rolling_friction);
    for (int c = 0; c < 3; c++) list->roll[c] = array_create(list->capacity, sizeof *list->roll[c]);
    return list->rolling_friction && list->roll[0] && list->roll[1] && list->roll[2];
}

dem_status contact_list_reserve(contact_list *list, size_t count)
{
    if (count <= list->capacity) return DEM_OK;
    contact_list grown = { .start = list->start,
                           .count = list->count,
                           .capacity = round_up_to_block(count + count / 4),
                           .has_rolling = list->has_rolling,
                           .ends_differ = list->ends_differ };
    const size_t n = grown.capacity;
    grown.first = array_create(n, sizeof *grown.first);
    grown.second = array_create(n, sizeof *grown.second);
    grown.friction = array_create(n, sizeof *grown.friction);
    grown.first_radius = array_create(n, sizeof *grown.first_radius);
    grown.mass = array_create(n, sizeof *grown.mass);
    for (int c = 0; c < 3; c++) grown.t[c] = array_create(n, sizeof *grown.t[c]);
    grown.t_star = array_create(n, sizeof *grown.t_star);
    grown.alpha_0 = array_create(n, sizeof *grown.alpha_0);
    grown.overlap = array_create(n, sizeof *grown.overlap);
    grown.to_first = array_create(n, sizeof *grown.to_first);
    grown.to_second = array_create(n, sizeof *grown.to_second);
    if (!grown.first || !grown.second || !grown.friction || !grown.first_radius || !grown.mass || !grown.t[0] || !grown.t[1]
        || !grown.t[2] || !grown.t_star || !grown.alpha_0 || !grown.overlap || !grown.to_first || !grown.to_second
        || (grown.has_rolling && !rolling_create(&grown))) {
        slots_free(&grown);
        return DEM_NO_MEMORY;
    }
    slots_free(list);
    *list = grown;
    return DEM_OK;
}

void contact_list_forget(contact_list *list, size_t slot)
{
    const contact_history nothing = { .t = { 0 } };
    contact_list_set_history(list, slot, &nothing);
}

void contact_list_pad(contact_list *list, int32_t first, int32_t second, size_t nobody)
{
    for (size_t k = list->count; k < round_up_to_block(list->count); k++) {
        list->first[k] = first;
        list->second[k] = second;
        list->friction[k] = list->first_radius[k] = list->mass[k] = 0;
        list->to_first[k] = list->to_second[k] = load_offset(nobody);
        if (list->has_rolling) list->rolling_friction[k] = 0;
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

int contact_list_memory(const contact_list *list, real *memory[CONTACT_NUMBERS])
{
    real *const all[CONTACT_NUMBERS] = { list->t[0],    list->t[1],    list->t[2],    list->t_star,
                                         list->alpha_0, list->roll[0], list->roll[1], list->roll[2] };
    memcpy(memory, all, sizeof all);
    return list->has_rolling ? CONTACT_NUMBERS : CONTACT_NUMBERS - 3;
}

void contact_list_swap(contact_list *a, contact_list *b)
{
    const contact_list c = *a;
    *a = *b;
    *b = c;
}

void contact_list_carry(contact_list *list, const contact_list *before, size_t i)
{
    /* Both are ordered by second, so one walk along each is enough. */
    size_t old = before->start[i];
    for (size_t k = list->start[i]; k < list->start[i + 1]; k++) {
        while (old < before->start[i + 1] && before->second[old] < list->second[k]) old++;
        if (old < before->start[i + 1] && before->second[old] == list->second[k]) {
            const contact_history history = contact_list_history(before, old);
            contact_list_set_history(list, k, &history);
        } else {
            contact_list_forget(list, k);
        }
    }
}
