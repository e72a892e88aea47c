/* Claims about JSON text: what is refused on the way in, and how numbers look on the way out. */
#include <sys/mman.h>
#include <unistd.h>

#include "claims.h"
#include "job_spec.h"
#include "json_text.h"

/* The detail of the problem, or "" when the text is read. */
static const char *refusal(const char *text, char *detail, size_t size)
{
    problem_list problems;
    problem_list_init(&problems);
    json_t *document = json_text_load(text, strlen(text), &problems);
    json_t *problem = json_array_get(problems.errors, 0);
    snprintf(detail, size, "%s", problem ? json_string_value(json_object_get(problem, "detail")) : "");
    assert_true((document == NULL) == (problem != NULL));
    json_decref(document);
    problem_list_clear(&problems);
    return detail;
}

static void a_number_that_would_turn_into_0_is_refused(void **state)
{
    (void)state;
    char detail[300];
    assert_non_null(strstr(refusal("{\"a\":\n 1e-400}", detail, sizeof detail), "line 2"));
    assert_string_not_equal(refusal("[-0.001e-330]", detail, sizeof detail), "");
    assert_string_equal(refusal("[0, 0.0, -0, 0e5, 0.000e-400, 1e-300, 100]", detail, sizeof detail), "");
}

/* A body as it comes from a client: its bytes and not one more. The page behind it can't be read: whoever reads on dies.
 * Behind it only that page; before it, to be seen in a message, the other's bytes. */
typedef struct exact_body {
    char *pages, *text;
    size_t size, length;
} exact_body;

static exact_body exact_body_make(const char *text, size_t length)
{
    const size_t page = (size_t)sysconf(_SC_PAGESIZE), size = (length / page + 2) * page;
    exact_body body = { mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0), NULL, size, length };
    assert_true(body.pages != MAP_FAILED);
    memset(body.pages, 'S', size - page);
    body.text = body.pages + size - page - length;
    memcpy(body.text, text, length);
    assert_int_equal(mprotect(body.pages + size - page, page, PROT_NONE), 0);
    return body;
}

static void exact_body_free(exact_body *body) { munmap(body->pages, body->size); }

static void a_message_holds_no_byte_that_was_not_sent(void **state)
{
    (void)state;
    static const char *const numbers[] = { "1e-400", "-2.5e-999", "0.00001e-999999", "12345678901234567890123456789e-999",
                                           "0.00000000000000000000000000000000000000000000000000000000000000000000000001e-330" };
    static const char *const shown[] = { "1e-400", "2.5e-999", "0.00001e-999999", "12345678901234567890", "0.000000000000000000" };
    for (size_t n = 0; n < sizeof numbers / sizeof numbers[0]; n++) {
        for (size_t space = 0; space < 40; space++) {
            char text[200], expected[300];
            snprintf(text, sizeof text, "%*s%s", (int)space, "", numbers[n]);
            snprintf(expected, sizeof expected, "has in line 1 a number too close to 0 to be kept: %s...", shown[n]);
            exact_body body = exact_body_make(text, strlen(text));
            problem_list problems;
            problem_list_init(&problems);
            assert_null(json_text_load(body.text, body.length, &problems));
            assert_string_equal(json_string_value(json_object_get(json_array_get(problems.errors, 0), "detail")), expected);
            problem_list_clear(&problems);
            exact_body_free(&body);
        }
    }
}

static const char drum_body[] =
    "{\"inputs\": {\"drum\": {\"diameter\": 0.126, \"length\": 1.89e-2, \"rotation_rate\": 1.5}, \"particles\":"
    " [{\"shape\": \"sphere\", \"diameter\": 0.00378, \"density\": 2500}], \"fill_fraction\": 0.5, \"seed\": 18446744073709551615,"
    " \"contact\": {\"friction\": 1e-400}}, \"label\": {\"\\u00e4\\\\\": \"h\xc3\xa4\xc3\x9flich \\\"\\\\\"}}";

/* Every beginning of a body, and every body with one byte changed, is read as a specification. */
static void bodies_are_read_by_their_length(void **state)
{
    (void)state;
    const size_t whole = sizeof drum_body - 1;
    for (size_t round = 0; round <= 2 * whole; round++) {
        const size_t length = round <= whole ? round : whole;
        exact_body body = exact_body_make(drum_body, length);
        if (round > whole) body.text[round - whole - 1] = "\"\\{}[]:,e-0\xc3"[round % 12];
        problem_list problems;
        problem_list_init(&problems);
        json_t *document = json_text_load(body.text, body.length, &problems);
        assert_true((document == NULL) != problem_list_is_empty(&problems));
        if (document) {
            job_spec spec;
            if (job_spec_parse("drum", document, 1, &spec, &problems)) job_spec_clear(&spec);
        }
        json_decref(document);
        problem_list_clear(&problems);
        exact_body_free(&body);
    }
}

static void digits_inside_a_text_are_no_numbers(void **state)
{
    (void)state;
    char detail[300];
    assert_string_equal(refusal("{\"1e-400\": \"1e-400 \\\" 1e-400 \\\\\"}", detail, sizeof detail), "");
}

static void numbers_are_written_in_the_fewest_digits_that_read_back_the_same(void **state)
{
    (void)state;
    const double numbers[] = {
        0.1, 0.00378, 1.0 / 3.0, 1e-300, 1e22, 2500, 0.30000000000000004, 5e-324, -0.05, 1.7976931348623157e308
    };
    const char *const written[] = {
        "0.1", "0.00378", NULL, "1e-300", "1e+22", "2500.0", "0.30000000000000004", NULL, "-0.05", NULL
    };
    for (size_t n = 0; n < sizeof numbers / sizeof numbers[0]; n++) {
        json_t *document = json_pack("[f]", numbers[n]);
        char *text = json_text_write(document);
        json_t *again = json_loads(text, 0, NULL);
        assert_true(json_is_real(json_array_get(again, 0)));
        assert_true(json_real_value(json_array_get(again, 0)) == numbers[n]);
        if (written[n]) assert_non_null(strstr(text, written[n]));
        json_decref(again);
        json_decref(document);
        free(text);
    }
}

/* As printf writes it with 15 digits, where these read back as the number, else with 16 or 17. */
static void assert_digits(double number)
{
    char expected[48] = "";
    json_t *document = json_real(number);
    char *text = json_text_write(document);
    for (int digits = 15; digits <= 17 && (digits == 15 || strtod(expected, NULL) != number); digits++)
        snprintf(expected, sizeof expected, "%.*g", digits, number);
    strcat(expected, strpbrk(expected, ".e") ? "\n" : ".0\n");
    assert_string_equal(text, expected);
    free(text);
    json_decref(document);
}

static void numbers_of_any_size_have_the_digits_that_printf_gives_them(void **state)
{
    (void)state;
    uint64_t chance = 1;
    for (int k = 0; k < 20000; k++) {
        chance = chance * 6364136223846793005u + 1442695040888963407u;
        const double whole = (double)(chance >> 40), power = pow(10.0, (double)(chance % 41) - 20.0);
        assert_digits(whole * power);
        assert_digits(-whole / 10000.0);
        assert_digits(nextafter(whole / 1000.0, 1e9));
        assert_digits((double)(chance >> 13));
    }
    assert_digits(0.0);
    assert_digits(1e15);
    assert_digits(nextafter(1e15, 0.0));
    assert_digits(1e-4);
    assert_digits(nextafter(1e-4, 0.0));
}

/* The library's own writer is the oracle; only reals differ. */
static void texts_are_escaped_and_indented_as_the_library_does(void **state)
{
    (void)state;
    json_t *document = json_pack("{s:s%, s:[s, s, b, b, n, I, I, []], s:{}, s:s}", "zero", "a\0b", (size_t)3, "list",
                                 "plain \u00b5 / \x7f", "\"\\\b\f\n\r\t\x01\x1f", 1, 0, (json_int_t)-9007199254740993,
                                 (json_int_t)0, "none", "\xf0\x9f\x98\x80\n\"", "\xe2\x82\xac");
    assert_non_null(document);
    for (int depth = 0; depth < 40; depth++)
        document = depth % 2 ? json_pack("{s:o}", "deeper", document) : json_pack("[o]", document);
    char *text = json_text_write(document), *expected = json_dumps(document, JSON_INDENT(2));
    assert_non_null(text);
    assert_int_equal(strlen(text), strlen(expected) + 1);
    assert_memory_equal(text, expected, strlen(expected));
    free(text);
    free(expected);
    json_decref(document);
}

UNIT_TESTS(texts_are_escaped_and_indented_as_the_library_does, a_number_that_would_turn_into_0_is_refused,
           a_message_holds_no_byte_that_was_not_sent, bodies_are_read_by_their_length, digits_inside_a_text_are_no_numbers,
           numbers_are_written_in_the_fewest_digits_that_read_back_the_same,
           numbers_of_any_size_have_the_digits_that_printf_gives_them)
