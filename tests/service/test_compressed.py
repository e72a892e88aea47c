"""Answers compressed for clients that take it, by a client that decodes them by hand."""
import http.client
import socket
import time
import zlib

import pytest

from conftest import SPEC

JOBS = 15
GZIP = 16 + zlib.MAX_WBITS
TABLE = ("/query?format=csv&sql=with+recursive+n(i)+as+(select+1+union+all+select+i%2B1+from+n+where+i%3C9000)"
         "+select+i,i*i*0.37+as+x,hex(i*7919)+as+y+from+n")


def ask(daemon, path, **headers):
    """Status, headers and body as they came, but for the chunks."""
    connection = http.client.HTTPConnection("127.0.0.1", daemon.port, timeout=30)
    connection.request("GET", path, headers={name.replace("_", "-"): value for name, value in headers.items()})
    answer = connection.getresponse()
    body = answer.read()
    connection.close()
    return answer.status, answer.headers, body


@pytest.fixture
def listed(fake):
    """A daemon whose list of jobs is long enough to be compressed well."""
    for k in range(JOBS):
        fake.submit({**SPEC, "seed": k}, case=f"case {k}")
    deadline = time.monotonic() + 60
    while fake.get("/jobs").json()["counts"]["successful"] < JOBS and time.monotonic() < deadline:
        time.sleep(0.1)
    return fake


def test_a_list_a_table_and_the_page_are_compressed_for_who_takes_it(listed):
    for path in (f"/jobs?limit={JOBS}", TABLE, "/web/style.css", "/web/jobs.js", "/api"):
        _, plain_headers, plain = ask(listed, path)
        assert "Content-Encoding" not in plain_headers and plain_headers["Vary"] == "Accept-Encoding", path
        _, headers, body = ask(listed, path, Accept_Encoding="gzip, deflate, br")
        assert headers["Content-Encoding"] == "gzip" and headers["Vary"] == "Accept-Encoding", path
        assert headers["Content-Type"] == plain_headers["Content-Type"]
        assert zlib.decompress(body, GZIP) == plain and len(body) < 0.55 * len(plain), path


@pytest.mark.parametrize("accepted, compressed", [
    ("gzip", True), ("GZIP", True), ("x-gzip", True), ("*", True), ("br;q=1, gzip;q=0.2", True), ("deflate , gzip ; q=0.5", True),
    ("gzip;q=1.0, identity;q=0.5", True), ("gzip;q=0", False), ("gzip;q=0.000, *", False), ("*;q=0", False), ("identity", False),
    ("identity, gzip;q=0.5", False), ("br, deflate", False), ("", False), ("gzipped", False), ("gzip;q=x", False), (",,;;", False),
])
def test_the_weights_of_accept_encoding_decide(fake, accepted, compressed):
    _, headers, body = ask(fake, "/web/style.css", Accept_Encoding=accepted)
    assert headers.get("Content-Encoding") == ("gzip" if compressed else None)
    assert body[:2] == b"\x1f\x8b" if compressed else b"{" in body


def test_short_answers_parts_and_pictures_are_sent_as_they_are(fake):
    assert "Content-Encoding" not in ask(fake, "/healthz", Accept_Encoding="gzip")[1]
    status, headers, body = ask(fake, "/web/style.css", Accept_Encoding="gzip", Range="bytes=10-2009")
    assert status == 206 and "Content-Encoding" not in headers and body == ask(fake, "/web/style.css")[2][10:2010]
    status, headers, _ = ask(fake, "/web/drum.png", Accept_Encoding="gzip")
    assert status == 200 and "Content-Encoding" not in headers and "Vary" not in headers


def test_the_tag_of_a_compressed_answer_is_weak_and_known_again(fake):
    strong = ask(fake, "/web/style.css")[1]["ETag"]
    weak = ask(fake, "/web/style.css", Accept_Encoding="gzip")[1]["ETag"]
    assert weak == "W/" + strong
    for tag in (strong, weak):
        status, headers, body = ask(fake, "/web/style.css", Accept_Encoding="gzip", If_None_Match=tag)
        assert (status, headers["ETag"], headers["Vary"], body) == (304, tag, "Accept-Encoding", b"")
    # a weak tag does not vouch for the bytes that a part would be put to
    assert ask(fake, "/web/style.css", Range="bytes=0-9", If_Range=weak)[0] == 200
    assert ask(fake, "/web/style.css", Range="bytes=0-9", If_Range=strong)[0] == 206


@pytest.mark.parametrize("encoding", ["gzip", "identity"])
def test_a_long_answer_comes_whole_over_a_slow_line(fake, encoding):
    """Some hundred kilobytes, of which a client takes 2 kB at a time; others are served meanwhile."""
    with socket.create_connection(("127.0.0.1", fake.port), timeout=30) as line:
        line.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        line.sendall(f"GET {TABLE} HTTP/1.0\r\nHost: localhost\r\nAccept-Encoding: {encoding}\r\n\r\n".encode())
        answer, slowest = b"", 0.0
        for k in range(1 << 20):
            piece = line.recv(2048)
            if not piece:
                break
            answer += piece
            if k % 20 == 0:
                before = time.monotonic()
                assert fake.get("/healthz").status_code == 200
                slowest = max(slowest, time.monotonic() - before)
    head, _, body = answer.partition(b"\r\n\r\n")
    assert (b"Content-Encoding: gzip" in head) == (encoding == "gzip"), head
    rows = (zlib.decompress(body, GZIP) if encoding == "gzip" else body).decode().splitlines()
    assert len(rows) == 9001 and rows[9000].startswith("9000,") and slowest < 5
