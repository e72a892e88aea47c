#include "wave.h"

#include "failure.h"
#include "sorting.h"
#include "team.h"

/* Blocks that one stage computes before the next stage has its turn are the list's divided by VISITS: in a bed of a million
 * spheres, about one layer's. */
enum { VISITS = 200 };

/* ---- which steps ---- */

static int64_t until_next(int64_t count, int64_t every) { return every - count % every; }

/* Whether the next steps may be one wave. Spheres at one end of the bed are several steps ahead of those at the other then,
 * so nothing but single spheres may move in these steps, and nothing may have to see the whole bed at one moment. (What has
 * to every so many steps is no condition here but a bound of wave_length.)
 *
 *     in_waves         The bed is too large for the caches: in a smaller one, waves do not pay (SPEED.md).
 *     not growing      Growing spheres have other radii in each step, and all stages of a wave read the same rows.
 *     single spheres   A cluster moves when all its spheres have their loads, in step_motion, after the contacts of all.
 *     no lining        The lining's spheres turn with the drum between two steps (container_rotate_lining); also, the torque
 *                      on it is summed from all loads of one moment.
 *     a drum           A tube is raised and a stream lets particles in between two steps; a plate loses particles. A drum's
 *                      cylinder and end walls look the same at each angle, and so may turn on unseen.
 *     no lifters       They do not look the same at each angle: in each step they are elsewhere.
 *     its rate         Where the definition's rate is not the walls' yet, container_move changes the walls' velocity at the
 *                      end of the next step; and so it does between two stages of rotation.
 *     no profile       The profile tells what the parts of a step cost, and in a wave those of several steps are mixed.
 *     no audit         The audit of energy needs all loads and all velocities of one moment, before and after the motion. */
bool wave_is_possible(const dem_scene *scene)
{
    const spheres *s = &scene->spheres;
    const container *c = &scene->container;
    const bool turns = scene->phase == DEM_PHASE_RUNNING;
    return s->in_waves && scene->phase != DEM_PHASE_GROWING && s->single_count == s->mobile_count && s->lining_count == 0
           && c->kind == DEM_DRUM && c->bar_count == 0 && scene->definition.stage_count == 0
           && c->rotation_rate == (turns ? scene->definition.rotation_rate : 0.0) && !scene->profile && !scene->audit.is_on;
}

int wave_length(const dem_scene *scene, int64_t left)
{
    const neighbor_list *list = &scene->neighbors;
    /* A wave has one cursor a step, which goes through the whole list; the halo of a part has copies of the rows for this step
     * and the next one only. */
    if (!wave_is_possible(scene) || list->parts.count > 1) return 1;
    const bool turns = scene->phase == DEM_PHASE_RUNNING;
    const int64_t looks = turns ? until_next(scene->step_count - scene->run_start, STEPS_BETWEEN_TORQUES)
                                : until_next(scene->step_count - scene->phase_start, STEPS_BETWEEN_RESTS);
    const int64_t bounds[] = { left, looks, sorting_steps_left(scene), list->safe_steps - list->steps_since_pick };
    int64_t steps = HORIZON;
    for (size_t k = 0; k < sizeof bounds / sizeof *bounds; k++) steps = bounds[k] < steps ? bounds[k] : steps;
    return (int)steps;
}

/* ---- the stages ---- */

void wave_begin(wave *w, dem_scene *scene, int steps, bool are_walls_done)
{
    w->list = &scene->neighbors;
    w->spheres = &scene->spheres;
    w->steps = steps;
    w->threads = scene->definition.threads;
    atomic_init(&w->whole, steps);
    w->overlap_limit = failure_least_overlap(scene);
    pair_work_begin(&w->work, w->list, w->spheres, &scene->container, &scene->contact, scene->definition.time_step, &scene->leap);
    for (int k = 0; k < steps; k++) {
        wave_stage *const stage = &w->stage[k];
        stage->cursor = list_cursor_begin(&w->work, 0, &stage->block);
        stage->ready = 0;
        atomic_flag_clear(&stage->is_taken);
        atomic_init(&stage->deviation, 0.0);
        atomic_init(&stage->overlap, 0.0);
        atomic_init(&stage->complete, stage->cursor.complete);
    }
    if (are_walls_done) w->stage[0].cursor.walls_end = 0;
}

double wave_largest_overlap(const wave *w, int k) { return wide_largest_lane(w->stage[k].cursor.largest); }

double wave_deviation(const wave *w, int k)
{
    const vector4 v = w->stage[k].cursor.strayed;
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* Finds how far stage k may go: `ready` becomes the first sphere that may not be the first of a contact yet, as the stage
 * before has not moved it, or not all that it may touch. Contacts with walls may be computed for all spheres that the stage
 * before has moved. */
static void look_ahead(wave *w, int k)
{
    const neighbor_list *const list = w->list;
    wave_stage *const stage = &w->stage[k];
    const size_t n = w->spheres->mobile_count;
    const size_t complete = k ? atomic_load_explicit(&w->stage[k - 1].complete, memory_order_acquire) : n;
    while (stage->ready < n && list->outer.farthest[stage->ready / STRETCH] < complete) stage->ready += STRETCH;
    if (complete == n) stage->ready = n + 1;
    if (k) stage->cursor.walls_end = list->wall_start[complete];
}

/* How many of the first steps the list holds for, by what is known of the spheres' motion so far. A step in which an overlap
 * is too large is the last one, as the run fails there. */
static int steps_that_hold(const wave *w)
{
    const int whole = atomic_load(&w->whole);
    double strayed = w->list->strayed;
    for (int k = 0; k + 1 < whole; k++) {
        strayed += atomic_load_explicit(&w->stage[k].deviation, memory_order_relaxed) * w->work.dt;
        if (!(strayed <= w->list->margin) || atomic_load_explicit(&w->stage[k].overlap, memory_order_relaxed) > w->overlap_limit)
            return k + 1;
    }
    return whole;
}

/* Whether stage k is to go on. What this thread has seen of the stages before decides: they have told of all motion of the
 * spheres that look_ahead has found complete. */
static bool still_holds(wave *w, int k)
{
    const int holds = steps_that_hold(w);
    int whole = atomic_load(&w->whole);
    while (holds < whole && !atomic_compare_exchange_weak(&w->whole, &whole, holds)) continue;
    return k < holds;
}

/* Computes the next blocks of stage k: at most a share of the list of 1 / VISITS, and none that has spheres which the stage
 * before has yet to move. */
static void compute_portion(const wave *w, wave_stage *stage)
{
    list_cursor *const cursor = &stage->cursor;
    const size_t n = w->spheres->mobile_count;
    for (size_t b = 0; b <= cursor->end / VISITS && cursor->next < cursor->end; b++) {
        const size_t last = cursor->next + 1 < cursor->end ? (size_t)w->list->pairs.first[(cursor->next + 1) * BLOCK] : n;
        if (last >= stage->ready) return;
        list_cursor_next_block(cursor);
    }
    if (cursor->next == cursor->end && stage->ready > n) list_cursor_complete(cursor, n);
}

/* Returns whether it has come further. */
static bool go_on(wave *w, int k)
{
    wave_stage *const stage = &w->stage[k];
    const size_t next = stage->cursor.next, complete = stage->cursor.complete;
    look_ahead(w, k);
    if (!still_holds(w, k)) return false;
    compute_portion(w, stage);
    atomic_store_explicit(&stage->deviation, wave_deviation(w, k), memory_order_relaxed);
    atomic_store_explicit(&stage->overlap, wave_largest_overlap(w, k), memory_order_relaxed);
    atomic_store_explicit(&stage->complete, stage->cursor.complete, memory_order_release);
    return stage->cursor.next > next || stage->cursor.complete > complete;
}

static bool is_complete(const wave *w, int k)
{
    return atomic_load_explicit(&w->stage[k].complete, memory_order_acquire) == w->spheres->mobile_count;
}

/* Of the stages from..to-1, those that no other thread has go on once, in order. Returns whether one has come further. */
static bool go_on_with(wave *w, int from, int to)
{
    bool any = false;
    for (int k = from; k < to && k < atomic_load(&w->whole); k++) {
        wave_stage *const stage = &w->stage[k];
        if (is_complete(w, k) || atomic_flag_test_and_set_explicit(&stage->is_taken, memory_order_acquire)) continue;
        any = (!is_complete(w, k) && go_on(w, k)) || any;
        atomic_flag_clear_explicit(&stage->is_taken, memory_order_release);
    }
    return any;
}

static void share_stages(void *context, int part, int parts)
{
    wave *const w = context;
    const int from = part * w->steps / parts, to = (part + 1) * w->steps / parts;
    while (!is_complete(w, atomic_load(&w->whole) - 1))
        if (!go_on_with(w, from, to) && !go_on_with(w, 0, w->steps)) __builtin_ia32_pause();
}

/* ---- stages that stop and go on ---- */

/* Keeps where a stage stopped in terms of spheres, which outlive the list: its last pair, and the rows of those contacts with
 * walls that are computed but not yet in a load. */
static void keep_place(const wave *w, wave_stage *stage)
{
    const contact_list *const pairs = &w->list->pairs, *const walls = &w->list->walls;
    const list_cursor *const cursor = &stage->cursor;
    const size_t done = cursor->next * BLOCK < pairs->count ? cursor->next * BLOCK : pairs->count;
    stage->first = done ? pairs->first[done - 1] : -1;
    stage->second = done ? pairs->second[done - 1] : -1;
    const size_t begin = w->list->wall_start[cursor->complete];
    stage->wall_count = cursor->walls > begin ? cursor->walls - begin : 0;
    memcpy(stage->wall_first, walls->first + begin, stage->wall_count * sizeof *walls->first);
    memcpy(stage->wall_second, walls->second + begin, stage->wall_count * sizeof *walls->second);
    memcpy(stage->wall_row, walls->row + begin, stage->wall_count * sizeof *walls->row);
}

void wave_run(wave *w)
{
    team_run(team_parts(w->threads), share_stages, w);
    for (int k = w->whole; k < w->steps; k++) keep_place(w, &w->stage[k]);
}

/* The first slot of the list that is behind the contact (first, second), whether the list has that contact or not. */
static size_t slot_behind(const contact_list *list, int32_t first, int32_t second)
{
    size_t low = 0, high = list->count;
    while (low < high) {
        const size_t k = low + (high - low) / 2;
        if (list->first[k] < first || (list->first[k] == first && list->second[k] <= second)) low = k + 1;
        else high = k;
    }
    return low;
}

/* Puts the rows that keep_place kept into the new list, whose slots begin..end-1 have them; spheres have yet to add them to
 * their loads. A contact that only the new list has did not touch: its row is zero. */
static void put_rows_back(wave *w, const wave_stage *stage, size_t begin, size_t end)
{
    const contact_list *const walls = &w->list->walls;
    if (begin < end) memset(walls->row + begin, 0, (end - begin) * sizeof *walls->row);
    for (size_t k = 0; k < stage->wall_count; k++) {
        const size_t behind = slot_behind(walls, stage->wall_first[k], stage->wall_second[k]);
        if (behind == 0 || walls->first[behind - 1] != stage->wall_first[k] || walls->second[behind - 1] != stage->wall_second[k])
            continue; /* a contact that only the old list has does not touch, either */
        walls->row[behind - 1] = stage->wall_row[k];
    }
}

void wave_resume(wave *w, int k)
{
    wave_stage *const stage = &w->stage[k];
    const neighbor_list *const list = w->list;
    const size_t n = w->spheres->mobile_count, complete = stage->cursor.complete, last_wall = stage->wall_count;
    list_cursor *const cursor = &stage->cursor;
    cursor->strayed = (vector4){ 0 };
    cursor->end = list->parts.block[1];
    const size_t slot = slot_behind(&list->pairs, stage->first, stage->second);
    cursor->next = slot / BLOCK;
    cursor->walls_end = list->wall_start[n];
    cursor->walls = list->wall_start[complete];
    if (last_wall) {
        const size_t end = slot_behind(&list->walls, stage->wall_first[last_wall - 1], stage->wall_second[last_wall - 1]);
        put_rows_back(w, stage, cursor->walls, end);
        cursor->walls = end;
    }
    if (slot < list->pairs.count && slot % BLOCK) list_cursor_rest_of_block(cursor, slot % BLOCK);
    else if (slot % BLOCK) cursor->next++;
    while (cursor->next < cursor->end) list_cursor_next_block(cursor);
    if (cursor->complete < n) list_cursor_complete(cursor, n);
}
