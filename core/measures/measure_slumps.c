/* Slumps as events: falls of the angle from one turning point to the next.
 *
 * A turning point counts when the angle has gone back from it by more than a threshold, which the series itself sets: eight
 * times its noise from frame to frame (10^4 normal numbers span 7.7 deviations), or 0.87 of the distance between its
 * quartiles, whichever is more: a saw-tooth's quartiles are half its height apart, so that teeth above 0.43 of the usual
 * height are seen, and one large fall does not hide the others. A bed that begins at rest climbs to its first fall: the
 * quartiles leave that climb out. A bed that goes on climbing between its falls would spread them too: they are those of
 * what a line leaves, where that is less. */
#include "array.h"
#include "measure.h"
#include "statistics.h"

/* Deviation of what is independent from frame to frame: differences do not see a steady rise or fall, and the median does not
 * see the turning points. Second ones take the bend of a swing of few frames for noise, which fourth ones hardly do; those
 * see more of the turning points. Neither sees less than the noise. */
static double noise_of(const double *angle, size_t count, double *room)
{
    for (size_t k = 1; k + 1 < count; k++) room[k - 1] = fabs(angle[k - 1] - 2 * angle[k] + angle[k + 1]);
    const double second = statistics_median(room, count - 2) / sqrt(6);
    for (size_t k = 2; k + 2 < count; k++)
        room[k - 2] = fabs(angle[k - 2] - 4 * angle[k - 1] + 6 * angle[k] - 4 * angle[k + 1] + angle[k + 2]);
    return 1.4826 * (count > 4 ? fmin(second, statistics_median(room, count - 4) / sqrt(70)) : second);
}

/* Slumps as they are found: the times of their beginnings and ends, and the angles then. */
typedef struct slump_list {
    double *start_time, *stop_time, *start, *stop;
    size_t count;
    double first_start; /* s, of the first fall after a rise, be its end seen or not; NaN: there is none */
    double *room;       /* that all of these are in; owned */
} slump_list;

/* Walks from one extreme to the next. The first is none: the series may begin anywhere; the last is none either. Returns
 * where the first fall after a rise begins, be its end seen or not; count: there is none. */
static size_t find_slumps(const double *time, const double *angle, size_t count, double threshold, slump_list *found)
{
    size_t low = 0, high = 0, top = 0, first = count;
    enum { EITHER, RISING, FALLING } going = EITHER;
    bool has_top = false;
    for (size_t k = 1; k < count; k++) {
        if (angle[k] < angle[low]) low = k;
        if (angle[k] > angle[high]) high = k;
        if (going != FALLING && angle[high] - angle[k] > threshold) {
            has_top = going == RISING;
            top = high;
            if (has_top && first == count) first = top;
            going = FALLING;
            low = k;
        } else if (going != RISING && angle[k] - angle[low] > threshold) {
            if (going == FALLING && has_top) {
                found->stop_time[found->count] = time[low];
                found->start_time[found->count] = time[top];
                found->start[found->count] = angle[top];
                found->stop[found->count++] = angle[low];
            }
            going = RISING;
            high = k;
        }
    }
    return first;
}

/* One slump's numbers are independent of the next one's: their mean's error is their deviation over the root of how many. */
static dem_mean mean_of(const double *x, size_t count)
{
    return (dem_mean){ statistics_mean(x, count), count > 1 ? statistics_deviation(x, count) / sqrt((double)count) : NAN };
}

/* Of all angles that slumps start or stop at; NaN: there are none. */
static double range_of(const slump_list *found)
{
    double low = NAN, high = NAN; /* fmin and fmax take the number */
    for (size_t k = 0; k < found->count; k++) {
        low = fmin(low, fmin(found->start[k], found->stop[k]));
        high = fmax(high, fmax(found->start[k], found->stop[k]));
    }
    return high - low;
}

static void sum_up(slump_list *found, dem_slumps *slumps)
{
    const size_t n = found->count;
    slumps->count = (double)n;
    slumps->hysteresis_deg = range_of(found);
    slumps->start_deg = mean_of(found->start, n);
    slumps->stop_deg = mean_of(found->stop, n);
    for (size_t k = 0; k < n; k++) found->stop[k] = found->start[k] - found->stop[k];
    slumps->size_deg = mean_of(found->stop, n);
    for (size_t k = 0; k + 1 < n; k++) found->start[k] = found->start_time[k + 1] - found->start_time[k];
    slumps->period = mean_of(found->start, n > 0 ? n - 1 : 0);
}

/* Reorders x. */
static double between_quartiles(double *x, size_t count)
{
    statistics_median(x, count); /* sorts */
    return x[3 * count / 4] - x[count / 4];
}

/* What the angle swings over: a steady climb or sinking is no swing. room: (count). */
static double swing_of(const double *time, const double *angle, size_t count, double *room)
{
    memcpy(room, angle, count * sizeof *room);
    const double level = between_quartiles(room, count);
    const line_fit line = statistics_line(time, angle, count, 1);
    for (size_t k = 0; k < count; k++) room[k] = angle[k] - line.intercept - line.slope * time[k];
    return fmin(level, between_quartiles(room, count));
}

/* Where the series first reaches its median: before, it may still climb. room: (count). */
static size_t climb_end(const double *angle, size_t count, double *room)
{
    memcpy(room, angle, count * sizeof *room);
    const double usual = statistics_median(room, count);
    size_t k = 0;
    while (k + 3 < count && angle[k] < usual) k++;
    return k;
}

dem_slumps measure_no_slumps(void)
{
    dem_slumps none = { .count = NAN };
    double *number = (double *)&none;
    _Static_assert(sizeof none % sizeof *number == 0, "slumps are nothing but numbers");
    for (size_t k = 0; k < sizeof none / sizeof *number; k++) number[k] = NAN;
    return none;
}

/* False: no memory. */
static bool list_slumps(const double *time, const double *angle, size_t count, slump_list *found)
{
    double *room = array_create(6 * (count + 1), sizeof *room);
    *found = (slump_list){ .start_time = room, .first_start = NAN, .room = room };
    if (!room) return false;
    double *const seen_time = room + 3 * count, *const seen = room + 4 * count;
    size_t n = 0;
    for (size_t k = 0; k < count; k++)
        if (!isnan(angle[k])) {
            seen_time[n] = time[k];
            seen[n++] = angle[k];
        }
    if (n < 3) return true;
    const size_t climbed = climb_end(seen, n, room);
    const double noise = noise_of(seen, n, room);
    const double threshold = fmax(8 * noise, 0.87 * swing_of(seen_time + climbed, seen + climbed, n - climbed, room));
    found->start = room + count;
    found->stop = room + 2 * count;
    found->stop_time = room + 5 * count;
    const size_t first = find_slumps(seen_time, seen, n, threshold, found);
    if (first < n) found->first_start = seen_time[first];
    return true;
}

dem_status measure_slumps(const double *time, const double *angle, size_t count, dem_slumps *slumps)
{
    slump_list found;
    *slumps = measure_no_slumps();
    if (!list_slumps(time, angle, count, &found)) return DEM_NO_MEMORY;
    slumps->first_start = found.first_start;
    if (found.count > 0) slumps->first_end = found.stop_time[0];
    if (found.start) sum_up(&found, slumps);
    free(found.room);
    return DEM_OK;
}

dem_status measure_slumps_list(const double *time, const double *angle, size_t count, dem_slump *slump, size_t room, size_t *found)
{
    slump_list all;
    *found = 0;
    if (!list_slumps(time, angle, count, &all)) return DEM_NO_MEMORY;
    *found = all.count;
    for (size_t k = 0; k < all.count && k < room; k++)
        slump[k] = (dem_slump){ all.start_time[k], all.stop_time[k], all.start[k], all.stop[k] };
    free(all.room);
    return DEM_OK;
}
