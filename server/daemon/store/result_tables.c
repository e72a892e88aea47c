/* The results document, spread over the tables whose columns bear its names. */
#include <stdio.h>
#include <string.h>

#include "database.h"
#include "job_store.h"
#include "text_buffer.h"

enum { MOST_COLUMNS = 24 };

/* Table <object>_result has these columns, each named as the document's member; group/member is column group_member. */
static const struct {
    const char *object;
    const char *columns[MOST_COLUMNS];
} tables[] = {
    { "repose",
      { "angle_deg",
        "standard_error_deg",
        "minimum_deg",
        "maximum_deg",
        "steady",
        "verdict",
        "drift_deg_per_revolution",
        "drift_bound_deg_per_revolution",
        "window/revolutions",
        "window/correlation_times",
        "layers",
        "method",
        "interface_fluctuation",
        "slumps/count",
        "slumps/period",
        "slumps/start_deg",
        "slumps/stop_deg",
        "slumps/size_deg",
        "while_filling/angle_deg",
        "while_filling/standard_error_deg" } },
    { "surface", { "height", "center_height", "wall_height", "base_diameter", "volume", "static_cohesive_index" } },
    { "fill", { "inside", "apart", "waiting", "at_rest" } },
    { "heap", { "inside", "apart", "lost", "at_rest" } },
    { "regime", { "name", "certain", "omega2_outer", "omega2_inner" } },
    { "segregation", { "radial_index", "axial_index", "lacey_index" } },
    { "packing", { "solid_fraction", "coordination_number", "mean_overlap", "overlap_99" } },
    { "drive", { "torque", "torque_standard_error", "weight_torque", "weight_torque_standard_error", "torque_number", "power" } },
    { "granule", { "minimum_omega2", "error", "minimum_rotation_rate", "slip_per_revolution", "slip_onset_deg" } },
    { "run",
      { "particles", "steps", "time_step", "simulated_seconds", "wall_seconds", "particle_steps_per_second", "maximum_overlap",
        "threads", "seed", "warnings" } },
};

static void bind_json(sqlite3_stmt *statement, int index, const json_t *value)
{
    if (json_is_boolean(value)) sqlite3_bind_int(statement, index, json_is_true(value));
    else if (json_is_integer(value)) sqlite3_bind_int64(statement, index, json_integer_value(value));
    else if (json_is_real(value)) sqlite3_bind_double(statement, index, json_real_value(value));
    else if (json_is_array(value)) sqlite3_bind_int64(statement, index, (int64_t)json_array_size(value)); /* how many */
    else if (json_is_string(value)) sqlite3_bind_text(statement, index, json_string_value(value), -1, SQLITE_STATIC);
    else sqlite3_bind_null(statement, index);
}

static const json_t *member_of(const json_t *object, const char *path)
{
    const char *slash = strchr(path, '/');
    if (!slash) return json_object_get(object, path);
    char group[32];
    snprintf(group, sizeof group, "%.*s", (int)(slash - path), path);
    return json_object_get(json_object_get(object, group), slash + 1);
}

static void add_column(text_buffer *sql, const char *path)
{
    const char *slash = strchr(path, '/');
    if (slash) text_buffer_print(sql, ",%.*s_%s", (int)(slash - path), path, slash + 1);
    else text_buffer_print(sql, ",%s", path);
}

static store_status fill_table(sqlite3 *writer, int64_t job, size_t table, const json_t *object)
{
    text_buffer sql;
    text_buffer_init(&sql, 2048);
    text_buffer_print(&sql, "INSERT OR REPLACE INTO %s_result(job", tables[table].object);
    size_t count = 0;
    while (tables[table].columns[count]) add_column(&sql, tables[table].columns[count++]);
    text_buffer_print(&sql, ") VALUES(?");
    for (size_t i = 0; i < count; i++) text_buffer_print(&sql, ",?");
    text_buffer_print(&sql, ")");
    sqlite3_stmt *statement = sql.failed ? NULL : sql_prepare(writer, sql.text, "i", job);
    text_buffer_clear(&sql);
    if (!statement) return STORE_FAILED;
    for (size_t i = 0; i < count; i++) bind_json(statement, (int)i + 2, member_of(object, tables[table].columns[i]));
    return sql_finish(statement, sqlite3_step(statement));
}

store_status result_tables_fill(sqlite3 *writer, int64_t job, const char *document, const json_t *results)
{
    store_status status =
        results ? sql_run(writer, NULL, "INSERT OR REPLACE INTO result VALUES(?,?)", "it", job, document) : STORE_FAILED;
    for (size_t i = 0; status == STORE_OK && i < sizeof tables / sizeof tables[0]; i++) {
        const json_t *object = json_object_get(results, tables[i].object);
        if (object) status = fill_table(writer, job, i, object);
    }
    return status;
}
