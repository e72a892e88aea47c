/* Slumps as events: falls of the angle from one turning point to the next.
 *
 * A turning point counts when the angle has gone back from it by more than a threshold, which the series itself sets: eight
 * times its noise from frame to frame (10^4 normal numbers span 7.7 deviations), or one and a half times its standard
 * deviation, whichever is more: a saw-tooth's deviation is 0.29 of its height, so that teeth above 0.43 of the usual height
 * are seen. */
#include "measure.h"
#include "statistics.h"

/* Deviation of what is independent from frame to frame: second differences do not see a steady rise or fall, and the
 * median does not see the turning points. */
static double noise_of(const double *angle, size_t count, double *room)
{
    for (size_t k = 1; k + 1 < count; k++) room[k - 1] = fabs(angle[k - 1] - 2 * angle[k] + angle[k + 1]);
    return 1.4826 * statistics_median(room, count - 2) / sqrt(6);
}

/* Slumps as they are found: their beginnings' times, and angles before and after. */
typedef struct slump_list {
    double *start_time, *start, *stop;
    size_t count;
} slump_list;

/* Walks from one extreme to the next. The first is none: the series may begin anywhere; the last is none either. */
static void find_slumps(const double *time, const double *angle, size_t count, double threshold, slump_list *found)
{
    size_t low = 0, high = 0, top = 0;
    enum { EITHER, RISING, FALLING } going = EITHER;
    bool has_top = false;
    for (size_t k = 1; k < count; k++) {
        if (angle[k] < angle[low]) low = k;
        if (angle[k] > angle[high]) high = k;
        if (going != FALLING && angle[high] - angle[k] > threshold) {
            has_top = going == RISING;
            top = high;
            going = FALLING;
            low = k;
        } else if (going != RISING && angle[k] - angle[low] > threshold) {
            if (going == FALLING && has_top) {
                found->start_time[found->count] = time[top];
                found->start[found->count] = angle[top];
                found->stop[found->count++] = angle[low];
            }
            going = RISING;
            high = k;
        }
    }
}

/* One slump's numbers are independent of the next one's: their mean's error is their deviation over the root of how many. */
static dem_mean mean_of(const double *x, size_t count)
{
    return (dem_mean){ statistics_mean(x, count), count > 1 ? statistics_deviation(x, count) / sqrt((double)count) : NAN };
}

static void sum_up(slump_list *found, dem_slumps *slumps)
{
    const size_t n = found->count;
    slumps->count = (double)n;
    slumps->start_deg = mean_of(found->start, n);
    slumps->stop_deg = mean_of(found->stop, n);
    for (size_t k = 0; k < n; k++) found->stop[k] = found->start[k] - found->stop[k];
    slumps->size_deg = mean_of(found->stop, n);
    for (size_t k = 0; k + 1 < n; k++) found->start[k] = found->start_time[k + 1] - found->start_time[k];
    slumps->period = mean_of(found->start, n > 0 ? n - 1 : 0);
}

dem_status measure_slumps(const double *time, const double *angle, size_t count, dem_slumps *slumps)
{
    *slumps = (dem_slumps){ NAN, { NAN, NAN }, { NAN, NAN }, { NAN, NAN }, { NAN, NAN } };
    double *room = array_create(5 * (count + 1), sizeof *room);
    if (!room) return DEM_NO_MEMORY;
    double *const seen_time = room + 3 * count, *const seen = room + 4 * count;
    size_t n = 0;
    for (size_t k = 0; k < count; k++)
        if (!isnan(angle[k])) {
            seen_time[n] = time[k];
            seen[n++] = angle[k];
        }
    if (n >= 3) {
        const double threshold = fmax(8 * noise_of(seen, n, room), 1.5 * statistics_deviation(seen, n));
        slump_list found = { room, room + count, room + 2 * count, 0 };
        find_slumps(seen_time, seen, n, threshold, &found);
        sum_up(&found, slumps);
    }
    free(room);
    return DEM_OK;
}
