/* A store in a folder of its own, with one job in it: the small drum. */
#ifndef RUNNING_JOB_H
#define RUNNING_JOB_H

#include "fuzz.h"
#include "job_store.h"
#include "json_text.h"

static inline job_store *store_with_a_job(data_folder *data, char id[JOB_ID_SIZE])
{
    static char text[1 << 16];
    problem_list problems;
    job_spec spec;
    FILE *file = fopen("run/spec.json", "re");
    CLAIM(file && problem_list_init(&problems));
    json_t *document = json_text_load(text, fread(text, 1, sizeof text, file), &problems);
    fclose(file);
    CLAIM(document && job_spec_parse(NULL, document, 0, &spec, &problems));
    CLAIM(data_folder_open(data, "data"));
    job_store *store = store_open(data, 100);
    /* Nothing here has to outlive the machine. */
    CLAIM(store && sqlite3_exec(store->writer, "PRAGMA synchronous=OFF", NULL, NULL, NULL) == SQLITE_OK);
    CLAIM(store_add_job(store, &spec, id) == STORE_OK);
    job_spec_clear(&spec);
    json_decref(document);
    problem_list_clear(&problems);
    return store;
}

/* The same, and that job claimed by a worker. */
static inline job_store *store_with_a_claim(data_folder *data, char id[JOB_ID_SIZE], job_claim *claim)
{
    job_store *store = store_with_a_job(data, id);
    CLAIM(store_claim_job(store, QUEUE_BY_TURN, 1, 1, "[]", claim) == STORE_OK);
    return store;
}

#endif
