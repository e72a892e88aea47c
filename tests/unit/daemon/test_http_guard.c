/* Claims about which requests come in, for methods that no address has yet. */
#include "claims.h"
#include "http_guard.h"

static int status_of(const char *method, const char *origin, const char *type, const char *length)
{
    const config settings = { .host = "127.0.0.1" };
    http_guard guard;
    assert_true(http_guard_init(&guard, &settings));
    const http_route route = { .method = method, .pattern = "/jobs", .open = true };
    const http_headers headers = { .length = length, .lengths = length ? 1 : 0 };
    const http_request request = { .method = method, .path = "/jobs", .host = "localhost", .origin = origin, .content_type = type };
    http_response response;
    http_response_init(&response);
    size_t body;
    const int status = http_guard_admits(&guard, &headers, &request, &route, &response, &body) ? 0 : response.status;
    http_response_clear(&response);
    return status;
}

static void whatever_may_write_is_taken_from_our_own_page_alone(void **state)
{
    (void)state;
    static const char *const writing[] = { "POST", "PUT", "PATCH", "DELETE", "MERGE" };
    for (size_t i = 0; i < sizeof writing / sizeof writing[0]; i++) {
        assert_int_equal(status_of(writing[i], "http://evil.example", "application/json", "2"), 403);
        assert_int_equal(status_of(writing[i], "http://localhost", "application/json", "2"), 0);
    }
    assert_int_equal(status_of("GET", "http://evil.example", NULL, NULL), 0);
    assert_int_equal(status_of("HEAD", "http://evil.example", NULL, NULL), 0);
}

static void whatever_sends_a_document_says_that_it_is_json(void **state)
{
    (void)state;
    static const char *const sending[] = { "POST", "PUT", "PATCH" };
    for (size_t i = 0; i < sizeof sending / sizeof sending[0]; i++) {
        assert_int_equal(status_of(sending[i], NULL, "text/plain", "2"), 415);
        assert_int_equal(status_of(sending[i], NULL, NULL, "2"), 415);
        assert_int_equal(status_of(sending[i], NULL, "application/json", NULL), 411);
        assert_int_equal(status_of(sending[i], NULL, "application/json; charset=utf-8", "2"), 0);
    }
    assert_int_equal(status_of("DELETE", NULL, NULL, NULL), 0);
}

UNIT_TESTS(whatever_may_write_is_taken_from_our_own_page_alone, whatever_sends_a_document_says_that_it_is_json)
