/* The division of a new list, in this order: find where each part begins; find the blocks with contacts across, and mark the
 * spheres in such contacts; number these spheres; make the copies of contacts, and look up the rows that each block reads.
 * Each pass is itself divided among the threads, and the next begins when all have finished. */
#include "contact_parts.h"

#include "array.h"

void contact_parts_init(contact_parts *parts, size_t most_spheres)
{
    memset(parts, 0, sizeof *parts);
    parts->most_spheres = most_spheres;
}

void contact_parts_clear(contact_parts *parts)
{
    for (int p = 0; p < MOST_PARTS; p++) {
        contact_list_clear(&parts->part[p].copies);
        free(parts->part[p].across);
        free(parts->part[p].rows);
    }
    free(parts->shared);
    free(parts->slot);
    memset(parts, 0, sizeof *parts);
}

/* ns, by which the work is divided: a contact between spheres, a contact with a wall, a sphere's step (core/SPEED.md, "Where a
 * step's time goes"). */
static const double OF_CONTACT = 5.0, OF_WALL = 6.0, OF_SPHERE = 2.8;

/* ns: expected time of all contacts before the block, and of the steps and the contacts with walls of all spheres before the
 * first sphere of the block. */
static double cost_before(const contact_list *pairs, const uint32_t *wall_start, size_t block)
{
    const size_t sphere = (size_t)pairs->first[block * BLOCK];
    return OF_CONTACT * (double)(block * BLOCK) + OF_WALL * wall_start[sphere] + OF_SPHERE * (double)sphere;
}

/* Moves the borders between parts, so that the slower of two neighbors gets less next time. The expected times miss some of what
 * parts wait for, above all cache lines that other cores have written. A border moves by at most one percent of a share at
 * a time, because a part may have been slow only since the operating system interrupted it. even: ns, a share. */
static void shift_parts(contact_parts *parts, double even)
{
    static const double SHARE = 0.05, MOST = 0.01;
    for (int p = 1; p < parts->count; p++) {
        const double before = parts->part[p - 1].took, here = parts->part[p].took;
        const double slower = before + here > 0 ? SHARE * (here - before) / (here + before) : 0;
        parts->part[p].later += even * fmax(-MOST, fmin(MOST, slower));
    }
    for (int p = 0; p < parts->count; p++) parts->part[p].took = 0;
}

/* Divides the blocks so that all parts are expected to take equally long, but for what shift_parts has found. */
static void begin_parts(contact_parts *parts, const contact_list *pairs, const uint32_t *wall_start, size_t n, int count)
{
    const size_t blocks = round_up_to_block(pairs->count) / BLOCK;
    const double even = (OF_CONTACT * (double)pairs->count + OF_WALL * wall_start[n] + OF_SPHERE * (double)n) / count;
    if (parts->count == count) shift_parts(parts, even);
    parts->count = count;
    for (int p = 0; p < count; p++) {
        size_t low = p ? parts->block[p - 1] : 0, high = p ? blocks : 0;
        while (low < high) {
            const size_t middle = low + (high - low) / 2;
            if (cost_before(pairs, wall_start, middle) < even * p + parts->part[p].later) low = middle + 1;
            else high = middle;
        }
        parts->block[p] = low;
        parts->sphere[p] = p == 0 ? 0 : low < blocks ? (size_t)pairs->first[low * BLOCK] : n;
    }
    parts->block[count] = blocks;
    parts->sphere[count] = n;
}

typedef struct deal_work {
    contact_parts *parts;
    const contact_list *pairs;
    spheres *spheres;
    size_t shared[MOST_PARTS + 1]; /* how many spheres of each part are in contacts across */
    dem_status status[MOST_PARTS];
} deal_work;

/* The mobile spheres behind those that a part owns: later parts own them. */
typedef struct others {
    uint32_t begin, count;
} others;

static inline others behind(const deal_work *work, int part)
{
    const size_t end = work->parts->sphere[part + 1];
    return (others){ (uint32_t)end, (uint32_t)(work->spheres->mobile_count - end) };
}

static inline bool is_among(others o, int32_t i) { return (uint32_t)i - o.begin < o.count; }

static inline bool is_own(const contact_parts *parts, int part, int32_t i)
{
    return (size_t)i >= parts->sphere[part] && (size_t)i < parts->sphere[part + 1];
}

static inline size_t end_of_block(const contact_list *pairs, size_t block)
{
    return (block + 1) * BLOCK < pairs->count ? (block + 1) * BLOCK : pairs->count;
}

static dem_status across_append(contact_part *part, size_t block)
{
    if (part->across_count == part->across_capacity) {
        const size_t capacity = 2 * part->across_capacity + 8;
        size_t *across = array_create(capacity, sizeof *across);
        if (!across) return DEM_NO_MEMORY;
        if (part->across) memcpy(across, part->across, part->across_count * sizeof *across);
        free(part->across);
        part->across = across;
        part->across_capacity = capacity;
    }
    part->across[part->across_count++] = block;
    return DEM_OK;
}

static dem_status rows_reserve(contact_part *part, size_t count)
{
    if (count <= part->rows_capacity) return DEM_OK;
    block_rows *rows = array_create(count + count / 2 + 4, sizeof *rows);
    if (!rows) return DEM_NO_MEMORY;
    free(part->rows);
    part->rows = rows;
    part->rows_capacity = count + count / 2 + 4;
    return DEM_OK;
}

/* Marks a sphere as one in a contact across. Several threads may mark the same sphere at once, with the same value: the store is
 * atomic, so that this is defined. */
static void mark(const deal_work *work, int32_t i)
{
    if ((size_t)i < work->spheres->mobile_count) __atomic_store_n(&work->parts->slot[i], 1, __ATOMIC_RELAXED);
}

/* Adds the block to the part's blocks with contacts across, and marks the spheres of these contacts. Errors: DEM_NO_MEMORY. */
static dem_status mark_block(const deal_work *work, int part, size_t block)
{
    if (across_append(&work->parts->part[part], block) != DEM_OK) return DEM_NO_MEMORY;
    const others them = behind(work, part);
    const int32_t *first = work->pairs->first, *second = work->pairs->second;
    for (size_t k = block * BLOCK; k < end_of_block(work->pairs, block); k++) {
        if (!is_among(them, first[k]) && !is_among(them, second[k])) continue;
        mark(work, first[k]);
        mark(work, second[k]);
    }
    return DEM_OK;
}

/* Finds a part's blocks with contacts across. The spheres of its contacts are never before those that it owns, so it is enough to
 * look for spheres behind them. */
static void find_across(void *context, int part, int parts)
{
    (void)parts;
    deal_work *const work = context;
    contact_part *const own = &work->parts->part[part];
    const int32_t *first = work->pairs->first, *second = work->pairs->second;
    const others them = behind(work, part);
    own->across_count = 0;
    work->status[part] = DEM_OK;
    for (size_t b = work->parts->block[part]; b < work->parts->block[part + 1] && work->status[part] == DEM_OK; b++) {
        int found = 0;
        for (size_t k = b * BLOCK; k < (b + 1) * BLOCK; k++)
            found |= (int)is_among(them, first[k]) | (int)is_among(them, second[k]);
        if (found) work->status[part] = mark_block(work, part, b);
    }
}

/* Numbers the marked spheres that a part owns. The part lists them in `shared` at the index of its first sphere, where no other
 * part writes; join_shared then closes the gaps. */
static void find_shared(void *context, int part, int parts)
{
    (void)parts;
    deal_work *const work = context;
    contact_parts *const p = work->parts;
    const size_t begin = p->sphere[part];
    int32_t count = 0;
    for (size_t group = begin, next; group < p->sphere[part + 1]; group = next) {
        int32_t any = 0; /* most groups have no marked sphere */
        next = group + LANES < p->sphere[part + 1] ? group + LANES : p->sphere[part + 1];
        for (size_t i = group; i < next; i++) any |= p->slot[i];
        for (size_t i = group; any && i < next; i++) {
            if (!p->slot[i]) continue;
            p->shared[begin + (size_t)count] = (int32_t)i;
            p->slot[i] = ++count;
        }
    }
    work->shared[part] = (size_t)count;
}

/* Moves the parts' lists in `shared` together, one behind the other, and sets shared_begin. */
static void join_shared(deal_work *work)
{
    contact_parts *const parts = work->parts;
    size_t at = 0;
    for (int p = 0; p < parts->count; p++) {
        memmove(parts->shared + at, parts->shared + parts->sphere[p], work->shared[p] * sizeof *parts->shared);
        parts->shared_begin[p] = at;
        at += work->shared[p];
    }
    parts->shared_begin[parts->count] = at;
}

/* Index of the copy of a sphere's row in the first set of copies. The sphere is in a contact across. */
static int32_t copy_of_row(const deal_work *work, int32_t i)
{
    const contact_parts *const parts = work->parts;
    int owner = 0;
    while (!is_own(parts, owner, i)) owner++;
    return (int32_t)(work->spheres->first_copy + parts->shared_begin[owner]) + parts->slot[i] - 1;
}

/* Sets which rows a part reads for the spheres of a block of `list`, for either set of copies. */
static void find_rows(const deal_work *work, int part, const contact_list *list, size_t block, block_rows *rows)
{
    const int32_t *first = list->first + block * BLOCK, *second = list->second + block * BLOCK;
    const int32_t mobile = (int32_t)work->spheres->mobile_count;
    const int32_t second_set = (int32_t)work->parts->shared_begin[work->parts->count];
    for (size_t k = 0; k < BLOCK; k++) {
        const int32_t i = first[k], j = second[k];
        const bool has_i = is_own(work->parts, part, i) || i >= mobile, has_j = is_own(work->parts, part, j) || j >= mobile;
        rows->first[0][k] = has_i ? i : copy_of_row(work, i);
        rows->second[0][k] = has_j ? j : copy_of_row(work, j);
        rows->first[1][k] = rows->first[0][k] + (has_i ? 0 : second_set);
        rows->second[1][k] = rows->second[0][k] + (has_j ? 0 : second_set);
    }
}

/* Copies those contacts of earlier parts that have a sphere of this part, in the list's order. to: NULL: they are only counted.
 * Returns how many there are. */
static size_t copy_contacts(const deal_work *work, int part, contact_list *to)
{
    const contact_list *const pairs = work->pairs;
    size_t count = 0;
    for (int before = 0; before < part; before++) {
        const contact_part *const other = &work->parts->part[before];
        for (size_t c = 0; c < other->across_count; c++) {
            const size_t block = other->across[c];
            for (size_t k = block * BLOCK; k < end_of_block(pairs, block); k++) {
                if (!is_own(work->parts, part, pairs->first[k]) && !is_own(work->parts, part, pairs->second[k])) continue;
                if (to) contact_list_copy(to, count, pairs, k);
                count++;
            }
        }
    }
    return count;
}

/* Makes a part's copies of contacts, pads them, and finds the rows of all its blocks across. Errors: DEM_NO_MEMORY. */
static dem_status make_copies(const deal_work *work, int part)
{
    contact_part *const own = &work->parts->part[part];
    const spheres *const s = work->spheres;
    const size_t count = copy_contacts(work, part, NULL), blocks = round_up_to_block(count) / BLOCK;
    if (contact_list_reserve(&own->copies, count) != DEM_OK) return DEM_NO_MEMORY;
    own->copies.count = copy_contacts(work, part, &own->copies);
    if (rows_reserve(own, own->across_count + blocks) != DEM_OK) return DEM_NO_MEMORY;
    for (size_t c = 0; c < own->across_count; c++) find_rows(work, part, work->pairs, own->across[c], &own->rows[c]);
    contact_list_pad(&own->copies, sphere_of_zeros(s), sphere_far_away(s));
    contact_list_copy_constants(&own->copies, work->pairs);
    for (size_t b = 0; b < blocks; b++) find_rows(work, part, &own->copies, b, &own->rows[own->across_count + b]);
    return DEM_OK;
}

/* Copies the rows of a part's shared spheres into the front set. */
static void copy_rows_of_part(const contact_parts *parts, spheres *s, int part)
{
    size_t next = parts->shared_begin[part];
    contact_parts_copy_rows(parts, s, s->front_copy, parts->shared_begin[part + 1], s->mobile_count, &next);
}

static void complete_part(void *context, int part, int parts)
{
    (void)parts;
    deal_work *const work = context;
    copy_rows_of_part(work->parts, work->spheres, part);
    work->status[part] = make_copies(work, part);
}

static dem_status parts_reserve(contact_parts *parts, const contact_list *pairs, int count)
{
    if (!parts->shared) parts->shared = array_create(parts->most_spheres, sizeof *parts->shared);
    if (!parts->slot) parts->slot = array_create(parts->most_spheres, sizeof *parts->slot);
    bool enough = parts->shared && parts->slot;
    for (int p = 0; p < count; p++) {
        contact_list *const copies = &parts->part[p].copies;
        if (copies->capacity == 0)
            enough = contact_list_init(copies, contact_list_extras(pairs), pairs->constants) == DEM_OK && enough;
        copies->ends_differ = pairs->ends_differ;
        copies->damped = pairs->damped;
        copies->latch_damping = pairs->latch_damping;
    }
    return enough ? DEM_OK : DEM_NO_MEMORY;
}

/* The first error of any part, or DEM_OK. */
static dem_status worst(const deal_work *work)
{
    for (int p = 0; p < work->parts->count; p++)
        if (work->status[p] != DEM_OK) return work->status[p];
    return DEM_OK;
}

dem_status contact_parts_deal(contact_parts *parts, const contact_list *pairs, const uint32_t *wall_start, spheres *s, int threads)
{
    const int count = team_parts(threads);
    if (count > 1 && parts_reserve(parts, pairs, count) != DEM_OK) return DEM_NO_MEMORY;
    for (size_t k = 0; k < parts->shared_begin[parts->count]; k++) parts->slot[parts->shared[k]] = 0;
    begin_parts(parts, pairs, wall_start, s->mobile_count, count);
    memset(parts->shared_begin, 0, sizeof parts->shared_begin);
    if (count == 1) {
        parts->part[0].across_count = parts->part[0].copies.count = 0;
        return DEM_OK;
    }
    deal_work work = { .parts = parts, .pairs = pairs, .spheres = s };
    team_run(count, find_across, &work);
    if (worst(&work) != DEM_OK) return worst(&work);
    team_run(count, find_shared, &work);
    join_shared(&work);
    if (spheres_reserve_copies(s, 2 * parts->shared_begin[count]) != DEM_OK) return DEM_NO_MEMORY;
    team_run(count, complete_part, &work);
    s->copies_hold = true;
    return worst(&work);
}

typedef struct rows_work {
    const contact_parts *parts;
    spheres *spheres;
} rows_work;

static void rows_of_part(void *context, int part, int parts)
{
    (void)parts;
    const rows_work *const work = context;
    copy_rows_of_part(work->parts, work->spheres, part);
}

void contact_parts_hand_out(const contact_parts *parts, spheres *s)
{
    if (!s->copies_hold && parts->shared_begin[parts->count]) team_run(parts->count, rows_of_part, &(rows_work){ parts, s });
    s->copies_hold = true;
}
