"""Many jobs cancelled or deleted by a filter at once."""
import itertools
import time

import pytest
import requests
from conftest import FAKE_WORKER, SPEC, run_daemon


@pytest.fixture
def one(tmp_path):
    """One job runs, another has failed, one is done and pinned, two are done; of a study of six one has been dismissed."""
    running = run_daemon(tmp_path, worker=FAKE_WORKER, options=["--workers", "1"])
    daemon = next(running)
    daemon.jobs = {"failed": daemon.submit(fake="numerical"), "pinned": daemon.submit(), "done": daemon.submit(), "too": daemon.submit()}
    for job in daemon.jobs.values():
        daemon.ended(job)
    requests.post(f"{daemon.url}/jobs/{daemon.jobs['pinned']}/pin", timeout=30)
    daemon.jobs["running"] = daemon.submit(seconds=1000)
    daemon.until(daemon.jobs["running"], lambda job: job["status"] == "running")
    study = {"name": "six", "base": {"inputs": SPEC, "label": {"project": "Six"}},
             "vary": {"/inputs/contact/friction": [0.1, 0.2, 0.3, 0.4, 0.5, 0.6]}}
    daemon.study = requests.post(f"{daemon.url}/studies", json=study, timeout=30).json()["studyID"]
    daemon.six = [job["jobID"] for job in reversed(daemon.get(f"/jobs?study={daemon.study}").json()["jobs"])]
    requests.delete(f"{daemon.url}/jobs/{daemon.six[0]}", timeout=30)
    yield daemon
    for _ in running:
        pass


def ask(daemon, what, query, status=200, **options):
    answer = requests.post(f"{daemon.url}/jobs/{what}?{query}", timeout=60, **options)
    assert answer.status_code == status, answer.text
    return answer.json()


def states(daemon):
    return {job["jobID"]: job["status"] for job in daemon.get("/jobs?limit=500").json()["jobs"]}


def numbers(answer):
    return [answer[name] for name in ("found", "changed", "left", "unfit", "pinned")]


def test_a_filter_cancels_what_waits_or_runs(one):
    before = states(one)
    told = ask(one, "cancel", "q=six&value.friction=..0.35&dry_run=true")
    assert told["jobs"] == one.six[1:3] and numbers(told) == [2, 0, 2, 1, 0] and told["dry_run"] and states(one) == before
    done = ask(one, "cancel", "q=six&value.friction=..0.35")
    assert done["jobs"] == one.six[1:3] and numbers(done) == [2, 2, 0, 1, 0]
    expected = before | {job: "dismissed" for job in one.six[1:3]}
    assert states(one) == expected
    assert one.get(f"/studies/{one.study}").json()["counts"]["dismissed"] == 3
    assert numbers(ask(one, "cancel", "status=successful")) == [0, 0, 0, 3, 0]
    done = ask(one, "cancel", "status=running,accepted")
    assert sorted(done["jobs"]) == sorted([one.jobs["running"], *one.six[3:]])
    deadline = time.monotonic() + 10
    while one.workers() and time.monotonic() < deadline:
        time.sleep(0.05)
    assert not one.workers()


def test_a_filter_deletes_what_has_ended_and_is_not_pinned(one):
    before = states(one)
    told = ask(one, "delete", "type=process&dry_run=true")
    gone = [one.jobs["failed"], one.jobs["done"], one.jobs["too"], one.six[0]]
    assert told["jobs"] == gone and numbers(told) == [4, 0, 4, 6, 1] and states(one) == before
    done = ask(one, "delete", "status=failed,successful")
    assert done["jobs"] == gone[:3] and numbers(done) == [3, 3, 0, 0, 1]
    assert states(one) == {job: state for job, state in before.items() if job not in gone[:3]}
    deadline = time.monotonic() + 10
    while any((one.data / "jobs" / job).exists() for job in gone[:3]) and time.monotonic() < deadline:
        time.sleep(0.05)
    assert not any((one.data / "jobs" / job).exists() for job in gone[:3]) and (one.data / "jobs" / one.jobs["pinned"]).exists()
    assert numbers(ask(one, "delete", f"study={one.study}")) == [1, 1, 0, 5, 0]
    assert one.get(f"/studies/{one.study}").json()["jobs"] == 5


@pytest.mark.parametrize("what", ["cancel", "delete"])
def test_a_filter_that_is_missing_or_wrong_changes_nothing(one, what):
    before = states(one)
    for query, pointer in (("", ""), ("dry_run=false", ""), ("q=", ""), ("status=", ""), ("status=,", ""), ("processID=,", ""),
                           ("q=six&dry_run=1", "/dry_run"), ("status=six", "/status"), ("value.six=6", "/value.six")):
        assert [error["pointer"] for error in ask(one, what, query, 400)["errors"]] == [pointer], query
    ask(one, what, "state=failed", 400)
    ask(one, what, "q=six&limit=1", 400)
    ask(one, what, "q=six", 400, json={"status": ["failed"]})
    assert numbers(ask(one, what, "processID=heap", json={})) == [0, 0, 0, 0, 0]
    assert states(one) == before


def test_thousands_go_on_where_the_last_answer_ended(tmp_path):
    """No answer takes much longer than a second, and nobody else waits for it."""
    running = run_daemon(tmp_path, worker=FAKE_WORKER, options=["--workers", "1", "--queue-limit", "30000"])
    daemon = next(running)
    daemon.until(daemon.submit(seconds=1000), lambda job: job["status"] == "running")
    study = {"name": "many", "base": {"inputs": SPEC}, "vary": {"/inputs/contact/friction": [0.001 * k for k in range(1, 2001)]}}
    assert requests.post(f"{daemon.url}/studies", json=study, timeout=60).status_code == 201
    for what, state in (("cancel", "accepted"), ("delete", "dismissed")):
        changed, left = 0, 2000
        for _ in itertools.takewhile(lambda _: left, range(100)):
            answer = ask(daemon, what, f"q=many&status={state}")
            assert answer["found"] == left and answer["changed"] > 0 and len(answer["jobs"]) == min(500, left)
            changed, left = changed + answer["changed"], answer["left"]
            assert changed + left == 2000
        assert left == 0
    assert daemon.get("/jobs?q=many").json()["jobs"] == []
    for _ in running:
        pass
