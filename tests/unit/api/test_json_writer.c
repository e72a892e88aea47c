/* Claims about JSON that is written straight into a buffer: it is what the library would write. */
#include <math.h>

#include "claims.h"
#include "json_writer.h"

static void assert_real(double number)
{
    json_t *real = json_real(number);
    char *expected = json_dumps(real, JSON_ENCODE_ANY | JSON_REAL_PRECISION(15));
    text_buffer out;
    text_buffer_init(&out, 100);
    json_write_real(&out, number);
    assert_string_equal(out.text, expected);
    text_buffer_clear(&out);
    free(expected);
    json_decref(real);
}

static void a_real_has_the_digits_that_the_library_gives_it(void **state)
{
    (void)state;
    static const double numbers[] = { 0.0,
                                      -0.0,
                                      1.0,
                                      -2500.0,
                                      0.1,
                                      0.5499,
                                      0.54990000000000006,
                                      1e-4,
                                      9.9999e-5,
                                      1e15,
                                      1e14,
                                      -1e14,
                                      1e16,
                                      1e-7,
                                      1e300,
                                      2.5e-300,
                                      999999999999999.0,
                                      0.3,
                                      1.0 / 3.0,
                                      100.25,
                                      1e9,
                                      123456789.123456,
                                      12287.6345532182,
                                      4388660638373648.0,
                                      0.000001,
                                      0.00012,
                                      5e-324,
                                      4.35,
                                      1e6 };
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) assert_real(numbers[i]);
    unsigned long long bits = 1;
    for (int i = 0; i < 20000; i++) {
        bits = bits * 6364136223846793005ULL + 1442695040888963407ULL;
        const double mantissa = (double)(bits >> 40), size = pow(10.0, (double)((bits >> 20) % 12) - 9.0);
        assert_real(mantissa * size);                         /* some of few digits */
        assert_real(nextafter(mantissa / 10000.0, INFINITY)); /* and beside them */
        assert_real(mantissa / 10000.0);
    }
}

static void a_text_has_the_escapes_that_the_library_gives_it(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "", "plain", "a \"quoted\" one", "back\\slash", "two\nlines\t", "\x01\x1f\x7f", "\xc3\x84rger", "/"
    };
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        json_t *string = json_string(texts[i]);
        char *expected = json_dumps(string, JSON_ENCODE_ANY);
        text_buffer out;
        text_buffer_init(&out, 100);
        json_write_string(&out, texts[i]);
        assert_string_equal(out.text, expected);
        text_buffer_clear(&out);
        free(expected);
        json_decref(string);
    }
}

/* A byte of the database that flipped spoils no list. */
static void what_is_no_text_is_told_and_the_rest_stays_json(void **state)
{
    (void)state;
    text_buffer out;
    text_buffer_init(&out, 100);
    json_write_string(&out, "ab\xff");
    assert_string_equal(out.text, "\"(can't be read)\"");
    assert_false(out.failed);
    text_buffer_clear(&out);
}

UNIT_TESTS(a_real_has_the_digits_that_the_library_gives_it, a_text_has_the_escapes_that_the_library_gives_it,
           what_is_no_text_is_told_and_the_rest_stays_json)
