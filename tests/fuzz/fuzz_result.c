/* result.json of a job that runs, with a checksum that fits: refused, or the very document is the job's results. */
#include <string.h>

#include "checksum.h"
#include "fuzz.h"
#include "hostile_file.h"
#include "job_folder.h"
#include "served_job.h"

static data_folder data;
static job_store *store;
static api_service service;
static job_claim claim;
static char result[300], seal[300];

int LLVMFuzzerInitialize(int *count, char ***arguments)
{
    char id[JOB_ID_SIZE];
    (void)count;
    (void)arguments;
    store = store_with_a_claim(&data, id, &claim);
    service = service_of(store);
    CLAIM(job_folder_create(&data, id, claim.spec));
    snprintf(result, sizeof result, "data/jobs/%s/" JOB_RESULT_FILE, id);
    snprintf(seal, sizeof seal, "data/jobs/%s/" JOB_RESULT_SUM_FILE, id);
    return 0;
}

static void run_again(void)
{
    static const char all[] =
        "UPDATE job SET status='running', attempt=1, finished=NULL; DELETE FROM run_result; DELETE FROM result";
    char *problem = NULL;
    if (sqlite3_exec(store->writer, all, NULL, NULL, &problem) != SQLITE_OK) claim_fails(problem, __FILE__, __LINE__);
}

static void are_results(const char *document)
{
    char *text;
    job_record job;
    CLAIM(store_read_results(store, claim.id, &text) == STORE_OK);
    json_t *expected = json_loads(document, 0, NULL), *told = json_loads(text, 0, NULL);
    CLAIM(expected && json_equal(expected, told));
    CLAIM(store_find_job(store, claim.id, &job) == STORE_OK && job.status == JOB_SUCCESSFUL);
    job_record_clear(&job);
    can_be_asked_for(&service, "/jobs/%s", claim.id);
    can_be_asked_for(&service, "/jobs/%s/results", claim.id);
    can_be_asked_for(&service, "/jobs", claim.id);
    json_decref(expected);
    json_decref(told);
    free(text);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    char lines[CHECKSUM_LINES + 1];
    checksum_write_lines((const char *)bytes, size, claim.spec, lines);
    hostile_bytes(result, bytes, size);
    hostile_bytes(seal, lines, CHECKSUM_LINES);
    char *document = job_result_read(&data, claim.id, claim.spec);
    if (!document) return 0;
    const store_status status = store_record_success(store, &claim, document);
    CLAIM(status == STORE_OK || status == STORE_REFUSED);
    if (status == STORE_OK) {
        are_results(document);
        run_again();
    }
    free(document);
    return 0;
}
