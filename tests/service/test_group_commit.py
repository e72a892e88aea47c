"""Jobs that are posted at the same time share a commit, and yet each is on the disk before it is acknowledged, counted alone and
refused alone."""
import json
import sqlite3
import threading
import time

import pytest
import requests
from conftest import FAKE_WORKER, SPEC, Daemon, compiled_shim

CLIENTS, EACH = 16, 6
LIMIT = 40


@pytest.fixture
def slow(tmp_path, monkeypatch):
    """On a disk that takes 50 ms for each commit, with a place in the queue for 40 jobs beside the one that runs."""
    daemon = Daemon(tmp_path, worker=FAKE_WORKER, options=["--workers", "1", "--queue-limit", str(LIMIT)])
    monkeypatch.setenv("LD_PRELOAD", str(compiled_shim("slow_disk", tmp_path)))
    daemon.start()
    monkeypatch.delenv("LD_PRELOAD")
    daemon.until(daemon.submit(seconds=1000), lambda job: job["status"] == "running")
    yield daemon
    if daemon.is_running():
        daemon.stop()


def at_once(clients, act):
    """What act(client, session) gave, of all clients."""
    results = [None] * clients

    def work(client):
        with requests.Session() as session:
            results[client] = act(client, session)

    threads = [threading.Thread(target=work, args=(client,)) for client in range(clients)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return results


def post(session, daemon, label, **headers):
    return session.post(f"{daemon.url}/processes/drum/execution", json={"inputs": SPEC, "label": label}, headers=headers, timeout=60)


def test_what_comes_at_once_shares_a_commit_and_is_refused_alone(slow):
    begin = time.monotonic()
    answers = at_once(CLIENTS, lambda client, session: [post(session, slow, {"n": f"{client}-{k}"}) for k in range(EACH)])
    seconds = time.monotonic() - begin
    slow.stop(how=9)  # at once: nothing is written behind the answers
    posted = {f"{client}-{k}": answer for client, many in enumerate(answers) for k, answer in enumerate(many)}
    good = {answer.json()["jobID"]: name for name, answer in posted.items() if answer.status_code == 201}
    assert len(good) == LIMIT and all(answer.status_code in (201, 503) for answer in posted.values())
    with sqlite3.connect(slow.data / "reposed.sqlite") as database:
        rows = dict(database.execute("SELECT id, label FROM job WHERE number>1"))
        assert {job: json.loads(label)["n"] for job, label in rows.items()} == good
        assert database.execute("SELECT jobs FROM job_count WHERE status='accepted'").fetchone()[0] in (LIMIT, LIMIT + 1)
        assert database.execute("SELECT count(*) FROM drum_input").fetchone()[0] == LIMIT + 1
        numbers = [number for number, in database.execute("SELECT number FROM job ORDER BY number")]
        assert numbers == list(range(1, LIMIT + 2))
    assert seconds < 0.05 * LIMIT  # which a commit each takes at least


def test_a_key_that_comes_twice_at_once_adds_one_job(slow):
    keys = [f"key-{k}" for k in range(4)]
    answers = at_once(CLIENTS, lambda client, session: post(session, slow, {"k": client % 4}, **{"Idempotency-Key": keys[client % 4]}))
    for k in range(4):
        same = [answer for client, answer in enumerate(answers) if client % 4 == k]
        assert {answer.status_code for answer in same} == {201}, [answer.text for answer in same]
        assert len({answer.json()["jobID"] for answer in same}) == 1
    assert slow.get("/jobs").json()["counts"]["accepted"] == 4
