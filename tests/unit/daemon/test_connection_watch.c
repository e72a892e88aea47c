/* Claims about which connections count as one client's. */
#include "connection_watch.h"

#include "claims.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <string.h>

static void take_address(const char *text, uint8_t address[CONNECTION_ADDRESS_SIZE])
{
    struct sockaddr_in four = { .sin_family = AF_INET };
    struct sockaddr_in6 six = { .sin6_family = AF_INET6 };
    if (inet_pton(AF_INET, text, &four.sin_addr) == 1) connection_address(address, (const struct sockaddr *)&four);
    else if (inet_pton(AF_INET6, text, &six.sin6_addr) == 1) connection_address(address, (const struct sockaddr *)&six);
    else fail_msg("%s is no address", text);
}

static bool is_one_client(const char *one, const char *other)
{
    uint8_t a[CONNECTION_ADDRESS_SIZE], b[CONNECTION_ADDRESS_SIZE];
    take_address(one, a);
    take_address(other, b);
    return memcmp(a, b, sizeof a) == 0;
}

static void addresses_of_one_network_of_ipv6_are_one_client(void **state)
{
    (void)state;
    assert_true(is_one_client("2001:db8:1:2::1", "2001:db8:1:2:ffff:ffff:ffff:ffff"));
    assert_false(is_one_client("2001:db8:1:2::1", "2001:db8:1:3::1"));
    assert_false(is_one_client("127.0.0.1", "127.0.0.2"));
    assert_true(is_one_client("192.0.2.7", "::ffff:192.0.2.7"));
    assert_false(is_one_client("::ffff:192.0.2.7", "::ffff:192.0.2.8"));
    assert_false(is_one_client("32.1.13.184", "2001:db8::1")); /* the same first bytes */
}

/* The socket -1 can't be shut down, which does no harm. */
static void an_address_has_its_share_of_connections_and_of_memory(void **state)
{
    (void)state;
    connection_watch watch;
    connection_watch_init(&watch, 100, 3);
    struct sockaddr_in mine = { .sin_family = AF_INET, .sin_addr.s_addr = htonl(0x7f000001) },
                       other = { .sin_family = AF_INET, .sin_addr.s_addr = htonl(0x7f000002) };
    const struct sockaddr *me = (const struct sockaddr *)&mine, *you = (const struct sockaddr *)&other;
    watched_connection *one[3], *yours = connection_watch_add(&watch, -1, you);
    for (int i = 0; i < 3; i++) {
        assert_true(connection_watch_admits(&watch, me));
        one[i] = connection_watch_add(&watch, -1, me);
        connection_watch_set_reading(&watch, one[i], i != 1); /* the second is being answered */
    }
    watched_connection *more[3];
    for (int i = 0; i < 2; i++) { /* the first makes room, then the third, */
        assert_true(connection_watch_admits(&watch, me));
        more[i] = connection_watch_add(&watch, -1, me);
        connection_watch_set_reading(&watch, more[i], 0);
    }
    assert_false(connection_watch_admits(&watch, me)); /* those that are being answered do not */
    more[2] = connection_watch_add(&watch, -1, me);    /* two threads had admitted one each while there was room for one */
    assert_true(more[2]->is_going && !more[0]->is_going && !more[1]->is_going);
    assert_true(connection_watch_admits(&watch, you));

    assert_true(connection_watch_hold(&watch, one[0], 500, 100)); /* a single one always fits */
    assert_false(connection_watch_hold(&watch, one[1], 1, 100));
    assert_true(connection_watch_hold(&watch, yours, 60, 100));
    connection_watch_release(&watch, one[0], 500);
    assert_true(connection_watch_hold(&watch, one[1], 60, 100));
    assert_true(connection_watch_hold(&watch, one[2], 40, 100));
    assert_false(connection_watch_hold(&watch, one[0], 1, 100));
    for (int i = 0; i < 3; i++) {
        connection_watch_remove(&watch, one[i]);
        connection_watch_remove(&watch, more[i]);
    }
    connection_watch_remove(&watch, yours);
    connection_watch_clear(&watch);
}

/* With room for two that ask, and three of one address. */
static void streams_take_no_place_but_that_of_their_address(void **state)
{
    (void)state;
    connection_watch watch;
    connection_watch_init(&watch, 100, 3);
    watch.most = 2;
    struct sockaddr_in mine = { .sin_family = AF_INET, .sin_addr.s_addr = htonl(0x7f000001) },
                       other = { .sin_family = AF_INET, .sin_addr.s_addr = htonl(0x7f000002) };
    const struct sockaddr *me = (const struct sockaddr *)&mine, *you = (const struct sockaddr *)&other;
    watched_connection *stream[3];
    for (int i = 0; i < 3; i++) {
        assert_true(connection_watch_admits(&watch, me));
        stream[i] = connection_watch_add(&watch, -1, me);
        connection_watch_set_sending(&watch, stream[i]);
        connection_watch_set_stream(&watch, stream[i]);
        connection_watch_set_stream(&watch, stream[i]); /* it is one already */
    }
    assert_int_equal(watch.count, 0);
    assert_false(connection_watch_admits(&watch, me));
    watched_connection *ask[2];
    for (int i = 0; i < 2; i++) {
        assert_true(connection_watch_admits(&watch, you));
        ask[i] = connection_watch_add(&watch, -1, you);
        connection_watch_set_reading(&watch, ask[i], 0);
    }
    assert_false(connection_watch_admits(&watch, you));
    connection_watch_remove(&watch, stream[0]);
    assert_int_equal(watch.count, 2);
    connection_watch_remove(&watch, ask[0]);
    assert_true(connection_watch_admits(&watch, you) && connection_watch_admits(&watch, me));
    connection_watch_remove(&watch, ask[1]);
    for (int i = 1; i < 3; i++) connection_watch_remove(&watch, stream[i]);
    connection_watch_clear(&watch);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(addresses_of_one_network_of_ipv6_are_one_client),
        cmocka_unit_test(an_address_has_its_share_of_connections_and_of_memory),
        cmocka_unit_test(streams_take_no_place_but_that_of_their_address),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
