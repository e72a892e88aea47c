/* What a worker appends to its event log: read at once or in two pieces, it is the same events, and whatever they are, they
 * can be recorded, and asked for then. The first byte says where it is cut. */
#include <fcntl.h>
#include <math.h>
#include <string.h>
#include <unistd.h>

#include "event_tail.h"
#include "fuzz.h"
#include "served_job.h"

static int file = -1;
static data_folder data;
static job_store *store;
static api_service service;
static job_claim claim;

int LLVMFuzzerInitialize(int *count, char ***arguments)
{
    char id[JOB_ID_SIZE];
    (void)count;
    (void)arguments;
    store = store_with_a_claim(&data, id, &claim);
    service = service_of(store);
    file = open("events.ndjson", O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    CLAIM(file >= 0);
    return 0;
}

static void fill(const uint8_t *bytes, size_t size)
{
    CLAIM(ftruncate(file, (off_t)size) == 0);
    CLAIM(pwrite(file, bytes, size, 0) == (ssize_t)size);
}

static void are_same(const json_t *all, json_t *first, const json_t *second)
{
    CLAIM(json_is_array(all) && json_array_extend(first, (json_t *)second) == 0);
    CLAIM(json_equal(all, first));
}

static void record(const event_batch *events)
{
    job_claim noted = claim;
    CLAIM(store_begin(store) == STORE_OK);
    CLAIM(store_end(store, store_record_events(store, &claim, events)) == STORE_OK);
    job_claim_note(&noted, events);
    can_be_asked_for(&service, "/jobs/%s", claim.id);
    can_be_asked_for(&service, "/jobs/%s/samples", claim.id);
    can_be_asked_for(&service, "/jobs/%s/samples?format=csv&limit=9", claim.id);
    can_be_asked_for(&service, "/jobs/%s/snapshots", claim.id);
    can_be_asked_for(&service, "/jobs", claim.id);
    CLAIM(sqlite3_exec(store->writer,
                       "DELETE FROM sample; DELETE FROM snapshot; UPDATE job SET message='', progress=0, "
                       "eta_seconds=NULL",
                       NULL, NULL, NULL)
          == SQLITE_OK);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    event_batch all, first, second;
    if (size < 1) return 0;
    const size_t length = size - 1, cut = length * bytes[0] / 255;
    fill(bytes + 1, length);
    CLAIM(event_tail_read(file, 0, &all));
    CLAIM(all.end >= 0 && all.end <= (int64_t)length && strlen(all.phase) < sizeof all.phase);
    CLAIM(all.end == 0 || bytes[all.end] == '\n');
    fill(bytes + 1, cut);
    CLAIM(event_tail_read(file, 0, &first));
    fill(bytes + 1, length);
    CLAIM(event_tail_read(file, first.end, &second));
    CLAIM(second.end == all.end);
    are_same(all.samples, first.samples, second.samples);
    are_same(all.snapshots, first.snapshots, second.snapshots);
    are_same(all.checkpoints, first.checkpoints, second.checkpoints);
    CLAIM(all.any == (first.any || second.any));
    if (all.any) record(&all);
    event_batch_clear(&all);
    event_batch_clear(&first);
    event_batch_clear(&second);
    return 0;
}
