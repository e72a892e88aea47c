#include "metrics.h"

#include <stdio.h>
#include <unistd.h>

static const int codes[] = { 200, 201, 206, 304, 400, 401, 403, 404, 405, 408, 409, 411, 413, 415, 416, 421, 429, 500, 503, 507 };
static const double bounds[] = { 0.001, 0.005, 0.025, 0.1, 0.5, 2.5, 1e300 };
_Static_assert(sizeof codes / sizeof *codes == METRICS_CODES - 1, "the last is for all other codes");
_Static_assert(sizeof bounds / sizeof *bounds == METRICS_BUCKETS, "a bound for each bucket");

void metrics_count(http_metrics *metrics, const http_route *route, int status, double seconds)
{
    size_t code = 0, bucket = 0;
    while (code < METRICS_CODES - 1 && codes[code] != status) code++;
    while (seconds > bounds[bucket]) bucket++;
    metrics->requests[route ? (size_t)(route - route_table) : route_count][code]++;
    metrics->bucket[bucket]++;
    metrics->nanoseconds += (uint64_t)(seconds * 1e9);
}

static void write_head(text_buffer *out, const char *name, const char *type, const char *help)
{
    text_buffer_print(out, "# HELP %s %s\n# TYPE %s %s\n", name, help, name, type);
}

static void write_one(text_buffer *out, const char *name, const char *type, const char *help, double value)
{
    write_head(out, name, type, help);
    text_buffer_print(out, "%s %.17g\n", name, value);
}

static void write_requests(const http_metrics *metrics, text_buffer *out)
{
    write_head(out, "reposed_http_requests_total", "counter", "HTTP requests answered, by route, method and status code.");
    for (size_t route = 0; route <= route_count; route++) {
        for (size_t code = 0; code < METRICS_CODES; code++) {
            const uint64_t count = metrics->requests[route][code];
            if (count == 0) continue;
            char number[8] = "other";
            if (code < METRICS_CODES - 1) snprintf(number, sizeof number, "%d", codes[code]);
            text_buffer_print(out, "reposed_http_requests_total{route=\"%s\",method=\"%s\",code=\"%s\"} %llu\n",
                              route < route_count ? route_table[route].pattern : "none",
                              route < route_count ? route_table[route].method : "", number, (unsigned long long)count);
        }
    }
}

static void write_latencies(const http_metrics *metrics, text_buffer *out)
{
    write_head(out, "reposed_http_request_seconds", "histogram", "Time to answer, without the time a client asked to wait.");
    uint64_t total = 0;
    for (size_t i = 0; i < METRICS_BUCKETS; i++) {
        total += metrics->bucket[i];
        if (i < METRICS_BUCKETS - 1)
            text_buffer_print(out, "reposed_http_request_seconds_bucket{le=\"%g\"} %llu\n", bounds[i], (unsigned long long)total);
        else text_buffer_print(out, "reposed_http_request_seconds_bucket{le=\"+Inf\"} %llu\n", (unsigned long long)total);
    }
    text_buffer_print(out, "reposed_http_request_seconds_sum %.9f\nreposed_http_request_seconds_count %llu\n",
                      1e-9 * (double)metrics->nanoseconds, (unsigned long long)total);
}

static void write_jobs(job_dispatcher *dispatcher, text_buffer *out)
{
    int64_t counts[JOB_STATUSES];
    if (store_count_jobs(dispatcher->store, counts) == STORE_OK) {
        write_head(out, "reposed_jobs", "gauge", "Jobs by state.");
        for (int i = 0; i < JOB_STATUSES; i++)
            text_buffer_print(out, "reposed_jobs{status=\"%s\"} %lld\n", job_status_name((job_status)i), (long long)counts[i]);
        write_one(out, "reposed_queue_depth", "gauge", "Jobs that wait for a worker.", (double)counts[JOB_ACCEPTED]);
        write_one(out, "reposed_queue_age_seconds", "gauge", "How long the oldest of them has waited.",
                  store_queue_age(dispatcher->store));
    }
    write_one(out, "reposed_workers", "gauge", "Most workers at once.", dispatcher->workers);
    write_one(out, "reposed_workers_running", "gauge", "Workers at work.", dispatcher->running);
    write_one(out, "reposed_worker_starts_total", "counter", "Attempts started.", (double)dispatcher->started);
    write_one(out, "reposed_jobs_put_back_total", "counter", "Attempts that ended early with the job back in the queue.",
              (double)dispatcher->put_back);
    write_one(out, "reposed_store_failures_total", "counter", "Rounds in which the database could not be written.",
              (double)dispatcher->store_failures);
    write_one(out, "reposed_particle_steps_per_second", "gauge", "Particle steps a second of all workers together.",
              dispatcher->speed);
}

/* What is handed on to a batch system. */
static void write_executor(worker_executor *executor, text_buffer *out)
{
    executor_counts counts;
    if (!executor->count) return;
    executor->count(executor, &counts);
    write_one(out, "reposed_batch_submissions_total", "counter", "Batch jobs that were submitted.", (double)counts.submissions);
    write_one(out, "reposed_batch_refusals_total", "counter", "Submissions that were refused, to be tried again.",
              (double)counts.refusals);
    write_one(out, "reposed_batch_questions_total", "counter", "How often the batch system was asked how its jobs are.",
              (double)counts.questions);
    write_one(out, "reposed_batch_waiting", "gauge", "Batch jobs in its queue that have not begun.", (double)counts.waiting);
    write_one(out, "reposed_batch_running", "gauge", "Batch jobs that run.", (double)counts.running);
    write_one(out, "reposed_batch_pause_seconds", "gauge", "Pause after the latest refusal; 0: the latest was taken.",
              counts.pause);
}

static void write_disk(const data_folder *data, text_buffer *out)
{
    const disk_room room = data_folder_room(data);
    write_one(out, "reposed_disk_free_bytes", "gauge", "Free room on the data folder's disk.", room.free_bytes);
    write_one(out, "reposed_disk_bytes", "gauge", "Size of the data folder's disk.", room.bytes);
    write_one(out, "reposed_disk_free_inodes", "gauge", "Files that can still be made there.", room.free_inodes);
}

static void write_pruned(const prune_tally *pruned, text_buffer *out)
{
    write_one(out, "reposed_pruned_jobs_total", "counter", "Jobs deleted by the rules of what is kept.", (double)pruned->jobs);
    write_one(out, "reposed_pruned_studies_total", "counter", "Studies deleted by the rules of what is kept.",
              (double)pruned->studies);
    write_one(out, "reposed_stripped_jobs_total", "counter", "Jobs whose snapshots were removed by the rules of what is kept.",
              (double)pruned->stripped);
    write_one(out, "reposed_pruned_bytes_total", "counter", "Room made by these rules.", pruned->bytes);
}

static double resident_bytes(void)
{
    long pages = 0;
    FILE *file = fopen("/proc/self/statm", "re");
    if (file && fscanf(file, "%*d %ld", &pages) != 1) pages = 0;
    if (file) fclose(file);
    return (double)pages * (double)sysconf(_SC_PAGESIZE);
}

void metrics_write(http_metrics *metrics, job_dispatcher *dispatcher, const prune_tally *pruned, text_buffer *out)
{
    write_head(out, "reposed_build_info", "gauge", "Always 1; the label tells the version.");
    text_buffer_print(out, "reposed_build_info{version=\"" REPOSED_VERSION "\"} 1\n");
    write_jobs(dispatcher, out);
    write_executor(dispatcher->executor, out);
    write_requests(metrics, out);
    write_latencies(metrics, out);
    write_one(out, "reposed_http_connections", "gauge", "Open connections.", metrics->connections);
    write_disk(dispatcher->store->data, out);
    write_pruned(pruned, out);
    write_one(out, "process_resident_memory_bytes", "gauge", "Resident memory of the daemon.", resident_bytes());
}
