"""Calibrations posted to the daemon: planned, run, cancelled, gone on with, killed and deleted. Runs are answered at once by a worker
that has a linear material in it; the planner is the real one."""
import csv
import io
import json
import os
import signal
import sqlite3
import subprocess
import time

import pytest
import requests
from conftest import ENDED, FAKE_WORKER, Daemon, run_daemon
from plan_loop import plan

FRICTION, ROLLING = "/inputs/contact/friction", "/inputs/contact/rolling_friction"
REQUEST = {
    "name": "steep", "base": {"process": "drum", "inputs": {"drum": {"diameter": 0.05, "length": 0.012, "rotation_rate": 1.0},
                                                            "particles": [{"diameter": 0.004}]}},
    "parameters": {FRICTION: {"range": [0.05, 1.0]}},
    "targets": [{"name": "angle", "result": "/repose/angle_deg", "value": 29.0, "standard_error": 0.5}],
    "stop": {"jobs": 14}, "seed": 3, "label": {"fit": "steep", "lot": 7},
}


def post(daemon, request=REQUEST, **headers):
    return requests.post(f"{daemon.url}/calibrations", json=request, headers=headers, timeout=30)


def until_ended(daemon, calibration, seconds=120):
    end = time.monotonic() + seconds
    while True:
        info = daemon.get(f"/calibrations/{calibration}?wait=10").json()
        if info["status"] in ENDED:
            return info
        assert time.monotonic() < end, f"{info}\n{daemon.log()}"


def results(daemon, calibration):
    answer = daemon.get(f"/calibrations/{calibration}/results")
    assert answer.status_code == 200, answer.text
    return answer.json()


@pytest.fixture(scope="module")
def service(tmp_path_factory):
    yield from run_daemon(tmp_path_factory.mktemp("calibrations"), worker=FAKE_WORKER, options=["--workers", "2"])


@pytest.fixture(scope="module")
def undisturbed(service):
    """What was posted, what it became, and what it found."""
    answer = post(service, **{"Idempotency-Key": "once"})
    assert answer.status_code == 201, answer.text
    calibration = answer.json()["calibrationID"]
    ended = until_ended(service, calibration)
    return answer, ended, results(service, calibration)


def test_a_calibration_is_planned_and_run_until_there_is_an_answer(service, undisturbed):
    posted, ended, found = undisturbed
    said = posted.json()
    assert said["status"] == "accepted" and said["type"] == "calibration" and said["warnings"] == []
    assert said["estimate"]["jobs"] == said["most_jobs"] == 14
    assert posted.headers["Location"] == f"{service.url}/calibrations/{said['calibrationID']}"
    assert ended["status"] == "successful" and ended["message"] == found["answer"]["status"] == "identified"
    assert ended["progress"] == 100 and ended["counts"]["successful"] == ended["jobs"] == len(found["runs"]) <= 14
    # 20 + 30 * 0.3; the error is that of the target over the slope, and the emulator adds a little.
    friction = found["answer"]["credible"][FRICTION]
    assert abs(friction["median"] - 0.3) < 0.02 and 0.015 < friction["standard_deviation"] < 0.025
    for run in found["runs"]:
        assert run["status"] == "successful" and run["process"] == "drum"
        assert abs(run["values"]["angle"]["value"] - 20 - 30 * run["parameters"][FRICTION]) <= 0.2 + 1e-9


def test_its_jobs_are_jobs_as_others_and_come_after_them(service, undisturbed):
    _, ended, found = undisturbed
    listed = service.get(f"/jobs?label.calibrationID={ended['calibrationID']}&limit=500").json()["jobs"]
    assert {job["jobID"] for job in listed} == {run["job"] for run in found["runs"]}
    for job in listed:
        assert job["priority"] == -1 and job["label"]["lot"] == 7 and job["label"]["calibration"] == "steep"
    assert service.get(ended["links"][-1]["href"]).json()["jobs"]


def test_its_table_has_a_line_a_run(service, undisturbed):
    _, ended, found = undisturbed
    text = service.get(f"/calibrations/{ended['calibrationID']}/results.csv").text
    lines = list(csv.DictReader(io.StringIO(text)))
    # JSON answers have 15 digits.
    assert [float(line["angle"]) for line in lines] == pytest.approx([run["values"]["angle"]["value"] for run in found["runs"]], 1e-14)
    assert [float(line[FRICTION]) for line in lines] == pytest.approx([run["parameters"][FRICTION] for run in found["runs"]], 1e-14)
    assert [line["job"] for line in lines] == [run["job"] for run in found["runs"]]
    assert {line["angle_standard_error"] for line in lines} == {"0.3"}


def test_it_is_listed_and_kept_as_it_was_posted_and_done_once(service, undisturbed):
    posted, ended, _ = undisturbed
    calibration = ended["calibrationID"]
    assert service.get(f"/calibrations/{calibration}/spec").json() == REQUEST
    assert calibration in [one["calibrationID"] for one in service.get("/calibrations").json()["calibrations"]]
    again = post(service, **{"Idempotency-Key": "once"})
    assert again.status_code == 201 and again.json()["calibrationID"] == calibration
    assert service.get("/calibrations/20200101-000000-00000000").status_code == 404


def test_it_is_refused_whole_with_all_that_the_planner_says_of_it(service):
    wrong = REQUEST | {"parameters": {FRICTION: {"range": [0.5, 700.0]}, ROLLING: {"range": [0.3, 0.2]}}, "repeats": 0,
                       "targets": [{"result": "/repose/angel_deg", "value": 29.0}, {"result": "/repose/angle_deg", "value": 3}]}
    before = len(service.get("/calibrations").json()["calibrations"])
    answer = post(service, wrong)
    assert answer.status_code == 400
    code, text = plan({"request": wrong})
    assert code == 2
    assert [("/request" + one["pointer"], one["detail"]) for one in answer.json()["errors"]] == \
           [(one["pointer"], one["detail"]) for one in json.loads(text)["errors"]]
    assert {"/targets/0/result", "/targets/1/standard_error", "/repeats"} < {one["pointer"] for one in answer.json()["errors"]}
    # And what a job would be refused for: here where the range ends.
    answer = post(service, REQUEST | {"parameters": {FRICTION: {"range": [0.5, 700.0]}}})
    assert [one["pointer"] for one in answer.json()["errors"]] == ["/parameters/~1inputs~1contact~1friction/range"]
    assert len(service.get("/calibrations").json()["calibrations"]) == before


def test_a_cancelled_one_goes_on_to_the_same_answer_and_a_deleted_one_leaves_nothing(service, undisturbed):
    calibration = post(service, REQUEST | {"label": {"fit": "steep", "seconds": 0.4}}).json()["calibrationID"]
    cancelled = requests.delete(f"{service.url}/calibrations/{calibration}", timeout=30).json()
    assert cancelled["status"] == "dismissed"
    assert until_ended(service, calibration)["counts"]["running"] == 0
    gone_on = requests.post(f"{service.url}/calibrations/{calibration}/retry", timeout=30)
    assert gone_on.status_code == 200 and gone_on.json()["status"] in ("accepted", "running")
    assert requests.post(f"{service.url}/calibrations/{calibration}/retry", timeout=30).status_code == 409
    assert requests.delete(f"{service.url}/calibrations/{calibration}?only=delete", timeout=30).status_code == 409
    assert until_ended(service, calibration)["status"] == "successful"
    assert results(service, calibration)["answer"] == undisturbed[2]["answer"]
    jobs = [run["job"] for run in results(service, calibration)["runs"]]
    # A job that is deleted by itself stays a run, with what it told.
    assert requests.delete(f"{service.url}/jobs/{jobs[0]}", timeout=30).status_code == 200
    first = results(service, calibration)["runs"][0]
    assert first["job"] is None and first["status"] == "successful" and first["values"]
    assert requests.delete(f"{service.url}/calibrations/{calibration}", timeout=30).status_code == 200
    assert service.get(f"/calibrations/{calibration}").status_code == 404
    assert [service.get(f"/jobs/{job}").status_code for job in jobs] == [404] * len(jobs)


def planners(daemon):
    found = []
    for process in daemon.workers():
        try:
            found += [process] if b"\0plan\0" in open(f"/proc/{process}/cmdline", "rb").read() else []
        except OSError:
            pass
    return found


def test_daemons_and_planners_that_are_killed_change_no_bit_of_the_answer(undisturbed, tmp_path):
    daemon = Daemon(tmp_path, worker=FAKE_WORKER, options=["--workers", "2"]).start()
    try:
        calibration = post(daemon).json()["calibrationID"]
        planners_killed = daemons_killed = 0
        while daemon.get(f"/calibrations/{calibration}").json()["status"] not in ENDED:
            for process in planners(daemon)[:1] if planners_killed < 3 else []:
                os.kill(process, signal.SIGKILL)
                planners_killed += 1
            runs = daemon.get(f"/calibrations/{calibration}").json()["counts"]["successful"]
            if runs >= 4 * (daemons_killed + 1) and daemons_killed < 2:
                daemon.stop(signal.SIGKILL)
                daemons_killed += 1
                daemon.options[-3:-2] = ["3"]  # other workers now
                daemon.start()
            time.sleep(0.002)
        assert planners_killed > 0 and daemons_killed == 2
        text = json.dumps(results(daemon, calibration)["answer"])
        assert text == json.dumps(undisturbed[2]["answer"])
        # Nothing of it is found amiss (files of the worker here have no checksums), and a rule that removes what is old removes it
        # once its jobs are gone.
        daemon.stop()
        checked = subprocess.run([daemon.program, "check", "--data", daemon.data], capture_output=True, text=True)
        assert f"{undisturbed[1]['jobs']} jobs that have ended" in checked.stdout and "calibration" not in checked.stdout
        with sqlite3.connect(daemon.data / "reposed.sqlite") as database:
            for table in ("job", "calibration"):
                database.execute(f"UPDATE {table} SET finished='2020-01-01T00:00:00.000Z'")
        assert subprocess.run([daemon.program, "prune", "--keep-days", "1", "--data", daemon.data]).returncode == 0
        daemon.start()
        assert daemon.get("/jobs").json()["jobs"] == [] and daemon.get("/calibrations").json()["calibrations"] == []
    finally:
        if daemon.is_running():
            daemon.stop(signal.SIGKILL)
