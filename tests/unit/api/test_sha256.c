/* The examples of FIPS 180-2, and what of a file is looked at. */
#include "requests.h"

#include <unistd.h>

#include "sha256.h"

static void expect_hash(const char *text, size_t times, const char *expected)
{
    char name[] = "/tmp/sha256-XXXXXX", hex[SHA256_HEX_SIZE];
    const int file = mkstemp(name);
    assert_true(file >= 0 && unlink(name) == 0);
    for (size_t k = 0; k < times; k++) assert_int_equal(write(file, text, strlen(text)), strlen(text));
    assert_true(sha256_of_file(file, hex)); /* from its beginning, wherever the descriptor stands */
    assert_string_equal(hex, expected);
    close(file);
}

static void hashes_are_those_of_the_standard(void **unused)
{
    (void)unused;
    expect_hash("", 1, "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    expect_hash("abc", 1, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    expect_hash("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq", 1,
                "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
    expect_hash("aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa", 10000,
                "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
    char hex[SHA256_HEX_SIZE];
    assert_false(sha256_of_file(-1, hex));
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(hashes_are_those_of_the_standard) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
