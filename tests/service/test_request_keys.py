"""A POST with an Idempotency-Key that is sent again is not done again, whatever happens in between."""
import signal
import sqlite3
from concurrent.futures import ThreadPoolExecutor

import requests
from conftest import SPEC

EXECUTION = "/processes/drum/execution"
STUDY = {"base": {"inputs": SPEC, "label": {"fake": "quick"}}, "vary": {"/inputs/contact/friction": [0.1, 0.2]}}


def post(daemon, path, body, key, **headers):
    return requests.post(daemon.url + path, json=body, headers={"Idempotency-Key": key, **headers}, timeout=30)


def jobs(daemon):
    return daemon.get("/jobs").json()["jobs"]


def test_the_same_request_gets_the_same_answer_and_another_none(fake):
    body = {"inputs": SPEC, "label": {"fake": "quick"}}
    first = post(fake, EXECUTION, body, "a")
    assert first.status_code == 201
    fake.ended(first.json()["jobID"])  # what it shows now is another status; the answer stays
    for path, sent, status in ((EXECUTION, body, 201), (EXECUTION, body | {"label": {}}, 422),
                               ("/processes/heap/execution", body, 422), ("/studies", STUDY, 422)):
        again = post(fake, path, sent, "a")
        assert again.status_code == status, again.text
        if status == 201:
            assert (again.text, again.headers["Location"]) == (first.text, first.headers["Location"])
    assert len(jobs(fake)) == 1
    assert post(fake, EXECUTION, body, "b").json()["jobID"] != first.json()["jobID"]
    for key in ("x" * 201, "two words"):
        assert post(fake, EXECUTION, body, key).status_code == 400
    # a refused request made nothing: its key is free
    assert post(fake, EXECUTION, {"inputs": {}}, "c").status_code == 400
    assert post(fake, EXECUTION, body, "c").status_code == 201


def test_a_study_and_a_retry_are_done_once(fake):
    first = post(fake, "/studies", STUDY, "study")
    assert first.status_code == 201
    assert post(fake, "/studies", STUDY, "study").text == first.text
    assert len(jobs(fake)) == 2
    failing = fake.submit(fake="numerical")
    assert fake.ended(failing)["status"] == "failed"
    first = post(fake, f"/jobs/{failing}/retry", None, "retry")
    assert first.status_code == 200
    attempt = fake.ended(failing)["attempt"]
    assert post(fake, f"/jobs/{failing}/retry", None, "retry").text == first.text
    assert fake.ended(failing)["attempt"] == attempt


def test_who_waits_for_results_gets_them_again(fake):
    body = {"inputs": SPEC, "label": {"fake": "quick"}}
    first, again = (post(fake, EXECUTION, body, "w", Prefer="wait=20") for _ in range(2))
    assert first.status_code == 200 and first.text == again.text
    assert len(jobs(fake)) == 1


def test_of_requests_at_once_one_is_done(fake):
    body = {"inputs": SPEC, "label": {"seconds": 100}}
    with ThreadPoolExecutor(8) as pool:
        for key in ("p", "q", "r"):
            answers = list(pool.map(lambda _, key=key: post(fake, EXECUTION, body, key), range(8)))
            assert {answer.status_code for answer in answers} == {201}
            assert len({answer.json()["jobID"] for answer in answers}) == 1
    assert len(jobs(fake)) == 3


def test_keys_outlive_the_daemon_and_a_lost_answer_but_not_seven_days(fake):
    body = {"inputs": SPEC, "label": {"seconds": 100}}
    first = post(fake, EXECUTION, body, "k").json()
    fake.stop(signal.SIGKILL)
    fake.start()
    assert post(fake, EXECUTION, body, "k").json() == first

    def change(sql):
        fake.stop(signal.SIGKILL)
        with sqlite3.connect(fake.data / "reposed.sqlite") as database:
            database.execute(sql)
        database.close()
        fake.start()

    change("update request_key set status=null, location=null, body=null")  # as a crash between the two commits leaves it
    again = post(fake, EXECUTION, body, "k")
    assert again.status_code == 201 and again.json()["jobID"] == first["jobID"]
    assert again.headers["Location"].endswith(f"/jobs/{first['jobID']}")
    change("update request_key set since=since-7*86400")
    assert post(fake, EXECUTION, body, "k").json()["jobID"] != first["jobID"]
    assert len(jobs(fake)) == 2
