#include "team.h"

#include <omp.h>
#include <sched.h>
#include <stdatomic.h>
#include <stddef.h>

enum { CACHE_LINE = 64, MOST_MEMBERS = MOST_PARTS };

typedef struct round_counter {
    _Alignas(CACHE_LINE) atomic_uint_fast64_t count;
} round_counter;

typedef struct work_given {
    _Alignas(CACHE_LINE) atomic_uint_fast64_t count; /* how many pieces there have been */
    /* the one at hand, in the line of memory that all look at; NULL: there will be no more */
    team_work *work;
    void *context;
    int parts;
} work_given;

typedef struct team {
    int members, spins;
    work_given given;
    round_counter done[MOST_MEMBERS]; /* how many of these each member has done its parts of */
} team;

/* Of the thread that leads one. */
static _Thread_local team *led;

/* Others come within a microsecond or two while they have a processor each; else somebody needs this one. */
static void wait_for(const atomic_uint_fast64_t *rounds, uint_fast64_t count, int spins)
{
    while (atomic_load_explicit(rounds, memory_order_acquire) < count) {
        if (spins-- > 0) __builtin_ia32_pause();
        else sched_yield();
    }
}

static void take_parts(const team *t, int member)
{
    for (int part = member; part < t->given.parts; part += t->members) t->given.work(t->given.context, part, t->given.parts);
}

static void follow(team *t, int member)
{
    for (uint_fast64_t count = 1;; count++) {
        wait_for(&t->given.count, count, t->spins);
        if (!t->given.work) return;
        take_parts(t, member);
        atomic_store_explicit(&t->done[member].count, count, memory_order_release);
    }
}

/* Returns how many pieces of work there have been. */
static uint_fast64_t give(team *t, int parts, team_work *work, void *context)
{
    t->given.work = work;
    t->given.context = context;
    t->given.parts = parts;
    const uint_fast64_t count = atomic_load_explicit(&t->given.count, memory_order_relaxed) + 1;
    atomic_store_explicit(&t->given.count, count, memory_order_release);
    return count;
}

void team_run(int parts, team_work *work, void *context)
{
    team *const t = led;
    if (!t || parts == 1) {
        for (int part = 0; part < parts; part++) work(context, part, parts);
        return;
    }
    const uint_fast64_t count = give(t, parts, work, context);
    take_parts(t, 0);
    for (int member = 1; member < t->members; member++) wait_for(&t->done[member].count, count, t->spins);
}

dem_status team_gather(int threads, dem_status (*lead)(void *context), void *context)
{
    if (threads == 1) return lead(context);
    enum { SPINS = 300 }; /* some ten microseconds */
    team t = { 0 }, *const outer = led;
    dem_status status = DEM_OK;
#pragma omp parallel num_threads(team_parts(threads))
    {
        const int member = omp_get_thread_num();
        if (member == 0) {
            t.members = omp_get_num_threads();
            t.spins = t.members <= omp_get_num_procs() ? SPINS : 0;
        }
#pragma omp barrier
        if (member > 0) {
            follow(&t, member);
        } else {
            led = &t;
            status = lead(context);
            led = outer;
            give(&t, 0, NULL, NULL);
        }
    }
    return status;
}
