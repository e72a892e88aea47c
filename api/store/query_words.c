#include "query_words.h"

#include <string.h>

typedef struct table_row {
    const char *table, *meaning;
} table_row;

static const table_row tables[] = {
    { "run_summary", "one row a run of any process that has ended well or failed: what it was given and what came out" },
    { "job_input", "one row an input of a job: its value, its default, and whether the request had it" },
    { "input_field", "one row an input of a process, as job_input has them" },
    { "stage", "one row a stage of a drum's rotation, of jobs that have ended well" },
    { "job", "one row a job" },
    { "study", "one row a study" },
    { "study_case", "one row a case of a study" },
    { "calibration", "one row a calibration" },
    { "calibration_document", "one row a calibration: what was posted, and what the planner said last" },
    { "calibration_run", "one row a run that a calibration asked for" },
    { "sample", "one row a sample of a running job's measures" },
    { "snapshot", "one row a snapshot of a job" },
    { "result", "one row a job that has ended well: its results as one document" },
    { "interface", "one row a point of a drum's mean interface" },
    { "sent_bed", "one row a table of particles that was sent for runs to start from" },
    { "pinned", "one row a job that no rule removes" },
    { "bed", "one row a settled bed that jobs of a study still share" },
};

typedef struct column_row {
    const char *table, *column, *unit, *meaning; /* table "": of any */
} column_row;

/* The first that fits counts. */
static const column_row rows[] = {
    { "interface", "point", "", "which of its points it is, from 0" },
    { "interface", "x", "m", "where it is, in a drum that turns counter-clockwise" },
    { "interface", "height", "m", "mean height of the bed's surface there" },
    { "interface", "standard_error", "m", "error of that mean; NULL: not known" },
    { "sent_bed", "number", "", "its number, in the order in which they came" },
    { "sent_bed", "id", "", "its id" },
    { "sent_bed", "created", "", "when it was sent, UTC" },
    { "sent_bed", "particles", "", "how many it has" },
    { "sent_bed", "bytes", "B", "its length" },
    { "study", "number", "", "its number, in the order of submission" },
    { "study", "jobs", "", "how many jobs it has" },
    { "study", "cases", "", "how many cases it has" },
    { "study", "repeats", "", "how many jobs each case has" },
    { "study", "accepted", "", "how many of its jobs wait" },
    { "study", "running", "", "how many of its jobs run" },
    { "study", "successful", "", "how many of its jobs have ended well" },
    { "study", "failed", "", "how many of its jobs have failed" },
    { "study", "dismissed", "", "how many of its jobs were cancelled" },
    { "study", "name", "", "its name" },
    { "study", "id", "", "its id" },
    { "study", "priority", "", "that of its jobs" },
    { "study_case", "study", "", "number of the study" },
    { "study_case", "position", "", "which of its cases it is, from 0" },
    { "study_case", "name", "", "its name" },
    { "study_case", "inputs", "", "JSON: the inputs in which cases differ" },
    { "study_case", "label", "", "JSON: the label of its jobs" },
    { "calibration", "number", "", "its number, in the order of submission" },
    { "calibration", "id", "", "its id" },
    { "calibration", "name", "", "its name" },
    { "calibration", "status", "", "accepted, running, successful (there is an answer), failed or dismissed" },
    { "calibration", "message", "", "what the answer says it is, or why there is none" },
    { "calibration", "stage", "", "start, refine or verify" },
    { "calibration", "priority", "", "that of its jobs" },
    { "calibration", "workers", "", "how many runs it asks for at a time" },
    { "calibration", "most_jobs", "", "how many jobs it may take" },
    { "calibration", "setbacks", "", "how often in a row it could not be planned" },
    { "calibration", "not_before", "s", "unix time until which planning is put off" },
    { "", "calibration", "", "number of the calibration" },
    { "calibration_document", "request", "", "JSON: what was posted" },
    { "calibration_document", "plan", "", "JSON: what the planner said last; once it is done, with the answer" },
    { "calibration_run", "number", "", "which of its runs it is, from 0" },
    { "calibration_run", "stage", "", "start, refine or verify" },
    { "calibration_run", "test", "", "which of its tests it is, from 0" },
    { "calibration_run", "of_set", "", "of a run that verifies, which of the sets it is of" },
    { "calibration_run", "parameters", "", "JSON: their values, by JSON Pointer" },
    { "calibration_run", "job", "", "the number of its job; NULL: that was deleted, or there was none" },
    { "calibration_run", "status", "",
      "that of its job when it was deleted, or of a case that could be none; NULL: its job has it" },
    { "calibration_run", "results", "", "JSON: the results of a job that was deleted" },
    { "stage", "number", "", "which stage of the job it is, from 0" },
    { "sample", "number", "", "which sample of the job it is, from 0" },
    { "sample", "measures", "", "JSON: what was measured" },
    { "sample", "angle_deg", "degrees", "of them the angle" },
    { "sample", "time", "s", "simulated time since rotation began" },
    { "snapshot", "number", "", "which snapshot of the job it is, from 0" },
    { "snapshot", "time", "s", "simulated time since rotation began" },
    { "snapshot", "file", "", "its name in the job's folder" },
    { "snapshot", "bytes", "B", "its length" },
    { "snapshot", "particles", "", "how many it holds" },
    { "result", "document", "", "JSON, as /jobs/{id}/results has it" },
    { "result", "checksum", "", "of the document, CRC-64 as a signed number; NULL: written by a program from before" },
    { "run_summary", "study", "", "id of the study it belongs to" },
    { "job", "study", "", "number of the study it belongs to" },
    { "input_field", "name", "", "the input's place in the request below inputs" },
    { "input_field", "path", "", "its place in a job's specification" },
    { "input_field", "default_value", "", "its default; NULL: that depends on others, or there is none" },
    { "input_field", "unit", "", "its unit" },
    { "job_input", "name", "", "the input's place in the request below inputs" },
    { "job_input", "value", "", "what the job ran with, also where it follows from others; of a list its JSON" },
    { "job_input", "default_value", "",
      "what it would have been if it were not given; NULL: that depends on others, or there is none" },
    { "job_input", "unit", "", "its unit" },
    { "job_input", "is_given", "",
      "1: the request had it, or, of threads, the service set it; 0: neither; NULL: not known, of jobs from before" },
    { "job", "number", "", "its number, in the order of submission: tables of inputs, results and samples have it as job" },
    { "job", "spec", "", "JSON: its specification, of which long lists of a study stand elsewhere" },
    { "job", "wanted", "", "JSON: how its results were asked for" },
    { "job", "given", "", "JSON: the inputs that its request had" },
    { "job", "failure", "", "JSON: what its worker said of why it failed" },
    { "bed", "key", "", "its number, as job.bed has it" },
    { "bed", "job", "", "the number of the job that has settled it" },
    { "bed", "sha256", "", "that of bed.hdf in the job's folder" },
    { "job", "bed", "", "the bed that it shares with others of its study; NULL: none" },
    { "job", "turn", "", "its turn among those of its priority" },
    { "job", "client", "", "who takes turns with others, of the label" },
    { "job", "not_before", "s", "unix time until which it is put off" },
    { "job", "setbacks", "", "how often in a row it was put back for want of something of the machine" },
    { "job", "attempts_before", "", "attempts made before it was tried again on request" },
    { "job", "starts", "", "how often it was started, be it as the same attempt" },
    { "job", "worker", "", "what its worker is called, where that lives on without the service; NULL: nothing" },
    { "job", "more_time", "", "how often it was given twice the time, since an attempt had too little" },
    { "job", "more_memory", "", "how often it was given twice the memory, likewise" },
    { "job", "resources", "", "JSON: what it asks of the cluster that runs it; NULL: nothing" },
    { "job", "estimated_memory_bytes", "B", "memory it was expected to take" },
    { "", "angle_definition", "", "how the angle was measured" },
    { "", "id", "", "the job's id" },
    { "", "job", "", "the number of the job" },
    { "", "process", "", "which test it is" },
    { "", "label", "", "JSON: the label it was posted with" },
    { "", "status", "", "accepted, running, successful, failed or dismissed" },
    { "", "message", "", "what is to be said of how it stands" },
    { "", "attempt", "", "which attempt it is" },
    { "", "threads", "", "threads it runs with" },
    { "", "estimated_seconds", "s", "how long it was expected to run when it was posted" },
    { "", "created", "", "when it was posted (UTC)" },
    { "", "started", "", "when it first began to run (UTC)" },
    { "", "finished", "", "when it ended (UTC)" },
    { "", "updated", "", "when what is told of it last changed (UTC)" },
    { "", "progress", "%", "how much is done" },
    { "", "eta_seconds", "s", "how long it is expected to run from now on" },
    { "", "priority", "", "-10 to 10; higher ones run first" },
    { "", "study_case", "", "which case of its study it is of, from 0" },
    { "", "study_repeat", "", "which repeat of that case it is, from 0" },
    { "", "step", "", "time steps since the beginning" },
};

static const field_column *find_field(const field_columns *columns, const char *table, const char *column)
{
    const bool in_view = strcmp(table, "run_summary") == 0;
    for (size_t c = 0; c < columns->count; c++) {
        const field_column *one = &columns->column[c];
        if (in_view ? one->in_view && strcmp(one->shown_as, column) == 0
                    : strcmp(one->table, table) == 0 && strcmp(one->name, column) == 0)
            return one;
    }
    return NULL;
}

const char *query_table_meaning(const field_columns *columns, const char *table)
{
    for (size_t t = 0; t < sizeof tables / sizeof tables[0]; t++)
        if (strcmp(tables[t].table, table) == 0) return tables[t].meaning;
    for (size_t c = 0; c < columns->count; c++)
        if (strcmp(columns->column[c].table, table) == 0)
            return columns->column[c].input ? "one row a job of that process: its main inputs, as they were used"
                                            : "one row a job that has ended well and has this output: its numbers";
    return NULL;
}

/* "chord_deg" and "chord_standard_error_deg" of the definition "chord". */
static bool is_other_angle(const char *column, bool *is_error)
{
    static const char end[] = "_deg", end_of_error[] = "_standard_error_deg";
    for (size_t p = 0; process_types[p]; p++) {
        const char *const *angles = process_types[p]->results->other_angles;
        for (size_t a = 0; angles && angles[a]; a++) {
            const size_t length = strlen(angles[a]);
            size_t same = 0;
            while (same < length && column[same] == (angles[a][same] == '-' ? '_' : angles[a][same])) same++;
            *is_error = same == length && strcmp(column + length, end_of_error) == 0;
            if (same == length && (*is_error || strcmp(column + length, end) == 0)) return true;
        }
    }
    return false;
}

static const result_field *find_entry(const char *column)
{
    for (size_t p = 0; process_types[p]; p++) {
        const result_table *entries = process_types[p]->results->entries;
        for (size_t f = 0; entries && f < entries->count; f++) {
            const result_field *field = &entries->field[f];
            if (strcmp(field->view_name ? field->view_name : field->name, column) == 0) return field;
        }
    }
    return NULL;
}

column_words query_column_words(const field_columns *columns, const char *table, const char *column)
{
    const field_column *field = find_field(columns, table, column);
    if (field && field->input) return (column_words){ field->input->unit ? field->input->unit : "", field->input->meaning };
    if (field) return (column_words){ field->result->unit ? field->result->unit : "", field->result->meaning };
    const result_field *entry = strcmp(table, "stage") == 0 ? find_entry(column) : NULL;
    if (entry) return (column_words){ entry->unit, entry->meaning };
    for (size_t r = 0; r < sizeof rows / sizeof rows[0]; r++)
        if ((!*rows[r].table || strcmp(rows[r].table, table) == 0) && strcmp(rows[r].column, column) == 0)
            return (column_words){ rows[r].unit, rows[r].meaning };
    bool is_error;
    if (strcmp(table, "run_summary") == 0 && is_other_angle(column, &is_error))
        return (column_words){ "degrees",
                               is_error ? "error of the angle by that definition" : "mean angle by this other definition" };
    return (column_words){ "", "" };
}
