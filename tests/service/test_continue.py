"""A drum goes on from where a job is, as a job of its own."""
import io
import sqlite3

import h5py
import numpy
import pytest
import requests
from conftest import FAKE_WORKER, SPEC, Daemon

ONCE = {**SPEC, "snapshots": {"interval": 0}}


@pytest.fixture(scope="module")
def real(tmp_path_factory):
    daemon = Daemon(tmp_path_factory.mktemp("continue")).start()
    yield daemon
    daemon.stop()


def go_on(daemon, job, body, **headers):
    return requests.post(f"{daemon.url}/jobs/{job}/continue", json=body, headers=headers, timeout=30)


def last_places(daemon, job):
    number = daemon.get(f"/jobs/{job}/snapshots").json()["snapshots"][-1]["number"]
    with h5py.File(io.BytesIO(daemon.get(f"/jobs/{job}/snapshots/{number:06}.hdf").content)) as file:
        return file["VTKHDF/Points"][:]


def errors_of(answer):
    return {error["pointer"]: error["detail"] for error in answer.json()["errors"]}


def test_two_halves_end_where_the_whole_ends_to_the_bit(real):
    step = real.post(ONCE).json()["estimate"]["time_step"]
    half, whole = real.submit({**ONCE, "duration": {"seconds": 2000 * step}}), real.submit({**ONCE, "duration": {"seconds": 4000 * step}})
    assert real.ended(half)["status"] == "successful"
    answer = go_on(real, half, {"seconds": {"value": 2000 * step * 1000, "unit": "ms"}, "label": {"project": "halves"}},
                   **{"Idempotency-Key": "once-and-only-once"})
    assert answer.status_code == 201, answer.text
    rest = answer.json()["jobID"]
    assert answer.headers["Location"].endswith(f"/jobs/{rest}")
    assert go_on(real, half, {"seconds": {"value": 2000 * step * 1000, "unit": "ms"}, "label": {"project": "halves"}},
                 **{"Idempotency-Key": "once-and-only-once"}).json()["jobID"] == rest
    assert [real.ended(job)["status"] for job in (rest, whole)] == ["successful"] * 2, real.get(f"/jobs/{rest}/log").text
    assert (last_places(real, rest) == last_places(real, whole)).all()
    assert not numpy.array_equal(last_places(real, half), last_places(real, whole))
    told = real.get(f"/jobs/{rest}").json()
    assert told["label"] == {"project": "halves", "parent": half}
    assert real.get(f"/jobs/{rest}/spec").json()["inputs"]["start"] == {"job": half, "checkpoint": True}
    assert [job["jobID"] for job in real.get(f"/jobs?label.parent={half}").json()["jobs"]] == [rest]
    real.get(f"/jobs/{half}")
    assert requests.delete(f"{real.url}/jobs/{half}", timeout=30).status_code in (200, 204)
    again = go_on(real, rest, {"revolutions": 0.2, "rotation_rate_rpm": 30})  # and once more, without the first
    assert again.status_code == 201, again.text
    spec = real.get(f"/jobs/{again.json()['jobID']}/spec").json()["inputs"]
    assert abs(spec["drum"]["rotation_rate"] - 3.141592653589793) < 1e-12 and spec["duration"] == {"revolutions": 0.2}
    assert real.ended(again.json()["jobID"])["status"] == "successful"


def test_what_is_wrong_is_told_by_the_member_that_was_sent(real):
    job = real.submit(ONCE)
    assert real.ended(job)["status"] == "successful"
    for body in ({}, {"revolutions": 1, "seconds": 1}, [], {"rotation_rate": 3}):
        answer = go_on(real, job, body)
        assert answer.status_code == 400 and "" in errors_of(answer), answer.text
    wrong = errors_of(go_on(real, job, {"revolutions": -1, "rotation_rate": {"value": 3, "unit": "m"}}))
    assert set(wrong) == {"/revolutions", "/rotation_rate"} and "units allowed: rad/s" in wrong["/rotation_rate"]
    assert "/rotation_rate_rpm" in errors_of(go_on(real, job, {"revolutions": 1, "rotation_rate": 3, "rotation_rate_rpm": 3}))
    assert "/turns" in errors_of(go_on(real, job, {"revolutions": 1, "turns": 3}))
    assert "/rotation_rate" in errors_of(go_on(real, job, {"revolutions": 1, "rotation_rate": -3}))  # contacts remember the other way


def test_where_there_is_no_state_the_reason_is_told(tmp_path):
    daemon = Daemon(tmp_path, worker=FAKE_WORKER, options=["--workers", "1"]).start()
    try:
        failed = daemon.submit(fake="fault")
        granule = requests.post(f"{daemon.url}/processes/granule/execution", json={"inputs": {"friction": 0.5}}, timeout=30).json()["jobID"]
        daemon.ended(failed)
        daemon.ended(granule)
        daemon.submit(fake="slow", seconds=60)
        waiting = daemon.submit()
        with sqlite3.connect(daemon.data / "reposed.sqlite") as database:
            before = database.execute("select count(*) from job").fetchone()
        for job, reason in ((failed, "is failed and has no checkpoint"), (granule, "only a drum"), (waiting, "has no checkpoint yet")):
            answer = go_on(daemon, job, {"revolutions": 1})
            assert answer.status_code == 409 and reason in answer.json()["detail"], answer.text
            assert answer.json()["type"].endswith("/job-not-continued")
        assert go_on(daemon, "20200101-000000-00000000", {"revolutions": 1}).status_code == 404
        with sqlite3.connect(daemon.data / "reposed.sqlite") as database:
            assert database.execute("select count(*) from job").fetchone() == before
    finally:
        daemon.stop()
