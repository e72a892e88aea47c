/* The Range header: which bytes of a file are sent. */
#include "claims.h"
#include "http_range.h"

static void expect(const char *header, uint64_t size, http_range_kind kind, uint64_t offset, uint64_t length)
{
    uint64_t got_offset = 0, got_length = 0;
    assert_int_equal(http_range_parse(header, size, &got_offset, &got_length), kind);
    assert_int_equal(got_offset, offset);
    assert_int_equal(got_length, length);
}

static void one_part_is_understood(void **state)
{
    (void)state;
    expect("bytes=0-0", 100, HTTP_RANGE_PART, 0, 1);
    expect("bytes=10-19", 100, HTTP_RANGE_PART, 10, 10);
    expect("Bytes=10-", 100, HTTP_RANGE_PART, 10, 90);
    expect("bytes=90-200", 100, HTTP_RANGE_PART, 90, 10);
    expect("bytes=-30", 100, HTTP_RANGE_PART, 70, 30);
    expect("bytes=-300", 100, HTTP_RANGE_PART, 0, 100);
}

static void parts_outside_the_file_are_told(void **state)
{
    (void)state;
    expect("bytes=100-", 100, HTTP_RANGE_OUTSIDE, 0, 0);
    expect("bytes=-0", 100, HTTP_RANGE_OUTSIDE, 0, 0);
    expect("bytes=0-", 0, HTTP_RANGE_OUTSIDE, 0, 0);
}

static void anything_else_means_the_whole(void **state)
{
    (void)state;
    static const char *const headers[] = { NULL,         "",           "bytes",         "bytes=",     "bytes=-",
                                           "bytes=5",    "bytes=9-5",  "bytes=1-2,5-6", "lines=1-2",  "bytes=1-2x",
                                           "bytes= 1-2", "bytes=+1-2", "bytes=1--2",    "bytes=0x1-2" };
    for (size_t i = 0; i < sizeof headers / sizeof headers[0]; i++) expect(headers[i], 100, HTTP_RANGE_WHOLE, 0, 0);
}

static void huge_numbers_do_not_wrap_around(void **state)
{
    (void)state;
    /* 2^64 + 5: would be byte 5 if it wrapped */
    expect("bytes=18446744073709551621-", 100, HTTP_RANGE_OUTSIDE, 0, 0);
    expect("bytes=5-18446744073709551621", 100, HTTP_RANGE_PART, 5, 95);
    expect("bytes=-18446744073709551621", 100, HTTP_RANGE_PART, 0, 100);
}

UNIT_TESTS(one_part_is_understood, parts_outside_the_file_are_told, anything_else_means_the_whole, huge_numbers_do_not_wrap_around)
