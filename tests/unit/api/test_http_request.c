/* Targets, parameters, Accept and routes: what a request is taken to mean. */
#include "claims.h"
#include "http_accept.h"
#include "routes.h"
#include "text_buffer.h"

static const char *split(http_request *request, char *copy, const char *target)
{
    memset(request, 0, sizeof *request);
    strcpy(copy, target);
    return http_request_split_target(request, copy);
}

static void parameters_are_decoded_once(void **state)
{
    (void)state;
    http_request request;
    char copy[200];
    assert_null(split(&request, copy, "/jobs?q=a%2Bb+c%26d%253D&status=&limit"));
    assert_string_equal(request.path, "/jobs");
    assert_string_equal(http_request_parameter(&request, "q"), "a+b c&d%3D");
    assert_string_equal(http_request_parameter(&request, "status"), "");
    assert_string_equal(http_request_parameter(&request, "limit"), "");
    assert_null(http_request_parameter(&request, "cursor"));
}

static void strange_targets_are_refused(void **state)
{
    (void)state;
    static const char *const targets[] = {
        "",           "jobs",        "//",          "/a//b",
        "/./a",       "/a/..",       "/a/../b",     "/%2e%2e",
        "/a%00",      "/a b",        "/a\\b",       "/jobs?q=%00",
        "/jobs?q=%4", "/jobs?q=%gg", "/jobs?q=%ff", "/j?a&b&c&d&e&f&g&h&i&j&k&l&m&n&o&p&q&a&b&c&d&e&f&g&h&i&j&k&l&m&n&o&p"
    };
    http_request request;
    char copy[200];
    for (size_t i = 0; i < sizeof targets / sizeof targets[0]; i++) assert_non_null(split(&request, copy, targets[i]));
    static const char *const good[] = { "/",
                                        "/jobs/",
                                        "/web/a.b_c~d-e",
                                        "/...",
                                        "/jobs?",
                                        "/j?a&b&c&d&e&f&g&h&i&j&k&l&m&n&o&p&a&b&c&d&e&f&g&h&i&j&k&l&m&n&o&p",
                                        "/jobs?a=1&a=2" };
    for (size_t i = 0; i < sizeof good / sizeof good[0]; i++) assert_null(split(&request, copy, good[i]));
}

static void whole_numbers_have_bounds(void **state)
{
    (void)state;
    http_request request;
    char copy[200], problem[200];
    int64_t value;
    assert_null(split(&request, copy, "/?a=7&b=x&c=7.5&d=%207&e=99999999999999999999&f="));
    assert_true(http_request_integer(&request, "a", 0, 10, 5, &value, problem, sizeof problem) && value == 7);
    assert_true(http_request_integer(&request, "missing", 0, 10, 5, &value, problem, sizeof problem) && value == 5);
    assert_false(http_request_integer(&request, "a", 0, 6, 5, &value, problem, sizeof problem));
    assert_string_equal(problem, "parameter a is \"7\"; must be a whole number in [0, 6]");
    for (const char *name = "b\0c\0d\0e\0f\0"; *name; name += 2)
        assert_false(http_request_integer(&request, name, 0, INT64_MAX, 5, &value, problem, sizeof problem));
}

/* The rules of RFC 9110, 12.5.1: a range's quality, of several ranges that fit the most exact one, parameters. */
static void accept_chooses_by_quality_and_exactness(void **state)
{
    (void)state;
    static const char *const offers[] = { "application/json", "text/html", "text/csv" };
    const struct {
        const char *accept;
        size_t chosen;
    } cases[] = { { NULL, 0 },
                  { "", 0 },
                  { "*/*", 0 },
                  { "text/html", 1 },
                  { "TEXT/HTML", 1 },
                  { "text/htmlx", 0 },
                  { "image/png", 0 },
                  { "text/*", 1 },
                  { "text/csv", 2 },
                  { "text/csv;q=0", 0 },
                  { "text/html, application/json", 1 },
                  { "application/json, text/html", 0 },
                  { "application/json;q=0.5, text/html", 1 },
                  { "text/html;q=0.5,application/json", 0 },
                  { "text/html;q=0.4, text/csv;q=0.9, */*;q=0.1", 2 },
                  { "text/html,application/xhtml+xml,application/xml;q=0.9,*/*;q=0.8", 1 },
                  { "text/csv, */*", 2 },
                  { "*/*, text/csv", 2 },
                  { "application/json;q=0, */*", 1 },
                  { "application/json;q=0, text/*;q=0.2, text/csv;q=0.1", 1 },
                  { "text/csv;charset=utf-8", 2 },
                  { "text/csv;header=present", 0 },
                  { " ,, text/csv ; q=1 ", 2 },
                  { "text/csv;q=x", 0 },
                  { ";q=1, /, */html", 0 } };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const size_t chosen = http_accept_choose(cases[i].accept, offers, 3);
        if (chosen != cases[i].chosen) fail_msg("\"%s\" chose %s", cases[i].accept, offers[chosen]);
    }
    static const char *const versions[] = { "application/x;version=2", "application/x;version=1" };
    assert_int_equal(http_accept_choose("application/x", versions, 2), 0);
    assert_int_equal(http_accept_choose("application/x;version=1", versions, 2), 1);
    assert_int_equal(http_accept_choose("application/x; Version=\"1\"", versions, 2), 1);
    assert_int_equal(http_accept_choose("application/x;version=1;q=0.3, application/x;version=2;q=0.2", versions, 2), 1);
    assert_int_equal(http_accept_choose("application/x;version=3, application/x;version=1;q=0.1", versions, 2), 1);
}

static void answer_nothing(api_service *service, const http_request *request, http_response *response)
{
    (void)service, (void)request, (void)response;
}

static const http_route table[] = {
    { "GET", "/jobs/{}", "", answer_nothing, .open = false },
    { "DELETE", "/jobs/{}", "", answer_nothing, .open = false },
    { "GET", "/jobs/{}/snapshots/{}", "", answer_nothing, .open = false },
    { "PUT", "/more", "", answer_nothing, .open = false },
    { "PATCH", "/more", "", answer_nothing, .open = false },
    { "POST", "/more", "", answer_nothing, .open = false },
};

static const http_route *match(const char *method, const char *path, http_request *request, int *status)
{
    *request = (http_request){ .method = method, .path = path };
    http_response response;
    http_response_init(&response);
    const http_route *route = routes_match(table, sizeof table / sizeof table[0], request, &response);
    *status = route ? 0 : response.status;
    if (response.status == 405)
        assert_string_equal(response.allow, strcmp(path, "/more") == 0 ? "PUT, PATCH, POST" : "GET, HEAD, DELETE");
    http_response_clear(&response);
    return route;
}

static void routes_fill_in_segments(void **state)
{
    (void)state;
    http_request request;
    int status;
    assert_ptr_equal(match("GET", "/jobs/abc/snapshots/7.hdf", &request, &status), &table[2]);
    assert_string_equal(request.segment[0], "abc");
    assert_string_equal(request.segment[1], "7.hdf");
    assert_ptr_equal(match("HEAD", "/jobs/abc", &request, &status), &table[0]);
    assert_ptr_equal(match("DELETE", "/jobs/abc", &request, &status), &table[1]);
    assert_null(match("PUT", "/jobs/abc", &request, &status));
    assert_int_equal(status, 405);
    assert_null(match("GET", "/more", &request, &status));
    assert_int_equal(status, 405);
    static const char *const unknown[] = { "/jobs",
                                           "/jobs/",
                                           "/jobs/a/b",
                                           "/jobs/a/snapshots",
                                           "/jobs/a/snapshots/b/c",
                                           "/jobs/0123456789012345678901234567890123456789012345678901234567890123456789" };
    for (size_t i = 0; i < sizeof unknown / sizeof unknown[0]; i++) {
        assert_null(match("GET", unknown[i], &request, &status));
        assert_int_equal(status, 404);
    }
}

static void a_buffer_keeps_its_cap(void **state)
{
    (void)state;
    text_buffer buffer;
    text_buffer_init(&buffer, 10);
    text_buffer_add(&buffer, "0123456789", 10);
    assert_false(buffer.failed);
    text_buffer_add(&buffer, "x", 1); /* there is room in its memory, but not in its cap */
    assert_true(buffer.failed);
    assert_string_equal(buffer.text, "0123456789");
    text_buffer_clear(&buffer);
}

static void a_text_is_no_formula_in_a_spreadsheet(void **state)
{
    (void)state;
    static const char *const fields[][2] = { { "plain", "plain" },
                                             { "", "" },
                                             { "a,b", "\"a,b\"" },
                                             { "a\"b", "\"a\"\"b\"" },
                                             { "a;=1+1", "\"a;=1+1\"" },
                                             { "=1+1", "\"'=1+1\"" },
                                             { "+1+1", "\"'+1+1\"" },
                                             { "-1+1", "\"'-1+1\"" },
                                             { "@SUM(1)", "\"'@SUM(1)\"" },
                                             { "\t=1", "\"'\t=1\"" },
                                             { "\r=1", "\"'\r=1\"" },
                                             { "\n=1", "\"'\n=1\"" },
                                             { "=\"a\"", "\"'=\"\"a\"\"\"" },
                                             { "-", "\"'-\"" },
                                             { "-0x10", "\"'-0x10\"" },
                                             { "-inf", "\"'-inf\"" },
                                             { "-1e", "\"'-1e\"" },
                                             { "-1e5-2", "\"'-1e5-2\"" },
                                             { "-.", "\"'-.\"" },
                                             { "\xef\xbc\x9d"
                                               "1+1",
                                               "\"'\xef\xbc\x9d"
                                               "1+1\"" },
                                             /* numbers stay numbers */
                                             { "-1", "-1" },
                                             { "+2.5", "+2.5" },
                                             { "-1.5e-7", "-1.5e-7" },
                                             { "-.5", "-.5" },
                                             { "-1E+05", "-1E+05" },
                                             /* and what only holds such a character is nothing special */
                                             { "a=b", "a=b" },
                                             { "20261122-014455-3f9a2c71", "20261122-014455-3f9a2c71" },
                                             { "a@b", "a@b" } };
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; i++) {
        text_buffer buffer;
        text_buffer_init(&buffer, 100);
        text_buffer_add_csv_field(&buffer, fields[i][0], strlen(fields[i][0]));
        text_buffer_add(&buffer, "", 0);
        assert_string_equal(buffer.text, fields[i][1]);
        text_buffer_clear(&buffer);
    }
}

/* A client may send any bytes in a header, and a limit of bytes may cut a character. */
static void a_problem_is_told_whatever_bytes_it_quotes(void **state)
{
    (void)state;
    static const char *const quoted[][2] = { { "h\xc3\xa4\xc3\x9f", "h\xc3\xa4\xc3\x9f" },
                                             { "h\xc3\xa4\xc3", "h\xc3\xa4" },
                                             { "\xff\xfe"
                                               "a",
                                               "a" },
                                             { "\xe2\x82\xac\xe2\x82", "\xe2\x82\xac" },
                                             { "\xed\xa0\x80"
                                               "b",
                                               "b" },
                                             { "\xf0\x9f\x98\x80", "\xf0\x9f\x98\x80" } };
    for (size_t i = 0; i < sizeof quoted / sizeof quoted[0]; i++) {
        http_response response;
        http_response_init(&response);
        http_respond_problem(&response, 400, NULL, "Bad", "it is \"%s\"", quoted[i][0]);
        assert_int_equal(response.status, 400);
        json_t *document = json_loadb(response.body, response.length, 0, NULL);
        char expected[100];
        snprintf(expected, sizeof expected, "it is \"%s\"", quoted[i][1]);
        assert_string_equal(json_string_value(json_object_get(document, "detail")), expected);
        json_decref(document);
        http_response_clear(&response);
    }
}

static void ids_have_one_shape(void **state)
{
    (void)state;
    assert_true(job_id_is_valid("20261122-014455-3f9a2c71"));
    static const char *const bad[] = { "",
                                       "..",
                                       "20261122-014455-3f9a2c7",
                                       "20261122-014455-3f9a2c711",
                                       "20261122-014455-3F9A2C71",
                                       "20261122/014455-3f9a2c71",
                                       "2026112x-014455-3f9a2c71",
                                       "20261122-014455-3f9a2c7g" };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) assert_false(job_id_is_valid(bad[i]));
}

UNIT_TESTS(parameters_are_decoded_once, strange_targets_are_refused, whole_numbers_have_bounds,
           accept_chooses_by_quality_and_exactness, routes_fill_in_segments, a_buffer_keeps_its_cap, ids_have_one_shape,
           a_text_is_no_formula_in_a_spreadsheet, a_problem_is_told_whatever_bytes_it_quotes)
