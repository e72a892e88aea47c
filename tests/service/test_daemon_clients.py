"""One client against all others: who waits, leaves, or does not read, takes nobody's place."""
import socket
import sqlite3
import time
from concurrent.futures import ThreadPoolExecutor

import pytest
import requests
from conftest import SPEC
from test_daemon_http import head, metrics_of

ENDLESS = "with+recursive+n(i)+as+(select+1+union+all+select+i%2B1+from+n)+select+count(*)+from+n"


def ask_and_keep(daemon, target, receive_buffer=None):
    """A client that has sent its request and reads nothing."""
    connection = socket.socket()
    if receive_buffer:
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_buffer)
    connection.settimeout(20)
    connection.connect(("127.0.0.1", daemon.port))
    connection.sendall(head(daemon, target=target).encode())
    return connection


def answer_of(connection):
    text = b""
    while piece := connection.recv(65536):
        text += piece
        if b"\r\n\r\n" in text:
            break
    return text


def until(check, seconds):
    end = time.monotonic() + seconds
    while not check():
        assert time.monotonic() < end
        time.sleep(0.1)


def test_clients_that_close_while_they_wait_give_their_places_back(fake):
    job = fake.submit(fake="slow", seconds="60")
    clients = [ask_and_keep(fake, f"/jobs/{job}?wait=60") for _ in range(90)]
    until(lambda: metrics_of(fake)["reposed_http_connections"] >= 90, 20)
    for client in clients:
        client.close()
    until(lambda: metrics_of(fake)["reposed_http_connections"] < 5, 20)  # a second, and the machine may be busy


def test_however_many_wait_the_others_are_answered(fake):
    job = fake.submit(fake="slow", seconds="60")
    clients = [ask_and_keep(fake, f"/jobs/{job}?wait=60") for _ in range(260)]
    clients += [socket.create_connection(("127.0.0.1", fake.port)) for _ in range(300)]  # and these ask nothing
    try:
        for _ in range(5):
            assert fake.get("/healthz").status_code == 200
        assert fake.get(f"/jobs/{job}").json()["status"] in ("accepted", "running")
        start = time.monotonic()
        assert fake.get(f"/jobs/{job}?wait=30").status_code == 200  # at once, as things are: too many wait already
        assert time.monotonic() - start < 20
    finally:
        for client in clients:
            client.close()


def test_a_client_that_closes_its_end_alone_is_answered_still(fake):
    job = fake.submit(fake="slow", seconds="60")
    with ask_and_keep(fake, f"/jobs/{job}?wait=60") as client:
        client.shutdown(socket.SHUT_WR)
        assert answer_of(client).startswith(b"HTTP/1.1 200")
    with ask_and_keep(fake, "/query?sql=select+1") as client:
        client.shutdown(socket.SHUT_WR)
        assert answer_of(client).startswith(b"HTTP/1.1 200")


def test_forty_short_queries_at_once_are_all_answered(fake):
    with ThreadPoolExecutor(40) as pool:
        answers = list(pool.map(lambda i: fake.get(f"/query?sql=select+{i}"), range(40)))
    assert [answer.json()["rows"] for answer in answers] == [[[i]] for i in range(40)]


def test_queries_of_clients_that_have_left_are_not_run(fake):
    clients = [ask_and_keep(fake, f"/query?sql={ENDLESS}") for _ in range(40)]
    time.sleep(0.2)
    for client in clients:
        client.close()
    start = time.monotonic()
    assert fake.get("/query?sql=select+1").status_code == 200
    assert time.monotonic() - start < 30  # where each ran for its 2 s: 80


def test_a_slow_query_holds_up_no_study(fake):
    clients = [ask_and_keep(fake, f"/query?sql={ENDLESS}") for _ in range(9)]
    start = time.monotonic()
    study = {"base": {"process": "granule", "inputs": {"friction": 0.5}}}
    assert requests.post(f"{fake.url}/studies", json=study, timeout=30).status_code == 201
    assert time.monotonic() - start < 16  # where it waits for all of them: 18
    for client in clients:
        client.close()


def test_the_daemon_leaves_while_queries_run(fake):
    with ThreadPoolExecutor(20) as pool:
        answers = [pool.submit(fake.get, f"/query?sql={ENDLESS}") for _ in range(20)]
        time.sleep(0.5)
        start = time.monotonic()
        assert fake.stop(seconds=30) == 0
        assert time.monotonic() - start < 25  # where each ran for its 2 s: 40
        for answer in answers:
            answer.exception()


def resident(daemon):
    return metrics_of(daemon)["process_resident_memory_bytes"]


LONG_SPECIFICATION = '"' + "x" * 5_000_000 + '"'


def job_of_long_specification(daemon):
    """Its id; GET .../spec sends 5 MB."""
    job = daemon.submit()
    daemon.ended(job)
    with sqlite3.connect(f"{daemon.data}/reposed.sqlite", timeout=30) as writer:
        writer.execute("update job set spec=?", (LONG_SPECIFICATION,))
    writer.close()
    return job


def test_answers_that_nobody_reads_take_bounded_memory(fake):
    job = job_of_long_specification(fake)
    before = resident(fake)
    clients = [ask_and_keep(fake, f"/jobs/{job}/spec", receive_buffer=4096) for _ in range(60)]
    try:
        time.sleep(2)
        assert resident(fake) - before < 150e6  # 300 MB, if all were kept
        assert fake.get("/healthz").status_code == 200
        until(lambda: (answer := fake.get(f"/jobs/{job}/spec")).status_code == 200 and answer.content == LONG_SPECIFICATION.encode(), 25)
    finally:
        for client in clients:
            client.close()


@pytest.mark.torture
def test_memory_stays_as_it_is_while_jobs_come_and_go(fake):
    """In each round a study and single jobs are posted, looked for, cancelled and deleted; what the first rounds needed suffices."""
    fake.until(fake.submit(fake="slow", seconds="1000"), lambda job: job["status"] == "running")
    fake.until(fake.submit(fake="slow", seconds="1000"), lambda job: job["status"] == "running")
    taken = []
    for round_ in range(40):
        study = {"name": "churn", "base": {"inputs": SPEC}, "vary": {"/inputs/contact/friction": [0.1 + 1e-4 * k for k in range(500)]}}
        assert requests.post(f"{fake.url}/studies", json=study, timeout=120).status_code == 201
        for number in range(20):
            fake.submit(round=f"churn {round_}", number=number)
        for query in ("q=churn&sort=-friction", "q=churn&value.friction=0.1..0.12", "label.round=churn+1", "f=csv&q=churn"):
            assert fake.get(f"/jobs?{query}").status_code == 200
        while fake.get("/jobs?q=churn&limit=1").json()["jobs"]:  # each of these works for a second at most
            for what in ("cancel", "delete"):
                assert requests.post(f"{fake.url}/jobs/{what}?q=churn", timeout=120).status_code == 200
        taken.append(resident(fake))
    assert max(taken[30:]) - max(taken[:10]) < 2e6, taken  # 100 bytes kept of each of the 15,600 jobs between are 1.6 MB
