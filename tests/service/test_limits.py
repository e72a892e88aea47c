"""What an administrator bounds and reads: how much one POST may ask for, and lines of the log that programs understand."""
import json
import re

import pytest
import requests
from conftest import FAKE_WORKER, SPEC, Daemon, run_daemon

LIMITS = {"estimate-seconds": "300", "particles": "500", "snapshot-bytes": "2M", "threads": "2"}


@pytest.fixture
def bounded(tmp_path):
    options = [word for name, value in LIMITS.items() for word in (f"--max-{name}", value)]
    yield from run_daemon(tmp_path, worker=FAKE_WORKER, options=["--threads", "4", *options])


def errors_of(answer):
    assert answer.status_code == 400, answer.text
    return {error["pointer"]: error["detail"] for error in answer.json()["errors"]}


def test_one_post_may_ask_for_no_more_than_the_service_gives(bounded):
    much = SPEC | {"threads": 3, "particles": [{"diameter": 0.001}], "duration": {"seconds": 1000.0}, "snapshots": {"interval": 1.0}}
    errors = errors_of(bounded.post(much))
    assert set(errors) == {"/inputs", "/inputs/particles", "/inputs/snapshots/interval", "/inputs/threads"}
    assert errors["/inputs/threads"] == "is 3; must be at most 2, the service's --max-threads"
    count = int(re.match(r"are (\d+); must be at most 500, ", errors["/inputs/particles"])[1])
    # 30 % of the drum, of solid fraction 0.5 to 0.65
    assert 0.5 < count * 0.001**3 * 2 / 3 / (0.3 * 0.04**2 * 0.012) < 0.65
    assert re.match(r"take about [\d.]+ (min|h|days?)( \d+ (s|min|h))? \([\d.e+]+ s\) on this machine; must take at most 5 min \(300 s\)", errors["/inputs"])
    size = float(re.match(r"makes about ([\d.e+]+) bytes of snapshots; must make at most 2e\+06", errors["/inputs/snapshots/interval"])[1])
    assert size > 1001 * count * 4 * 6  # at least place and velocity in single precision
    assert bounded.get("/jobs").json()["jobs"] == []
    answer = bounded.post()  # its default of threads is no more than may be
    assert answer.status_code == 201 and bounded.get(f"/jobs/{answer.json()['jobID']}/spec").json()["inputs"]["threads"] == 2


def test_a_study_is_one_post(bounded):
    one = {"inputs": SPEC | {"duration": {"seconds": 20.0}, "snapshots": {"interval": 0}}}
    assert requests.post(f"{bounded.url}/studies", json={"name": "few", "base": one, "repeats": 1}, timeout=60).status_code == 201
    many = requests.post(f"{bounded.url}/studies", json={"name": "many", "base": one, "repeats": 1000}, timeout=60)
    assert "--max-estimate-seconds" in errors_of(many)["/base/inputs"]
    vary = {"name": "wide", "base": one, "vary": {"/inputs/threads": [1, 3]}}
    errors = errors_of(requests.post(f"{bounded.url}/studies", json=vary, timeout=60))
    assert any("--max-threads" in detail for detail in errors.values()) and all("threads" in pointer for pointer in errors), errors
    assert len(bounded.get("/studies").json()["studies"]) == 1


def test_a_check_tells_what_a_post_would_and_keeps_nothing(bounded):
    """Of good ones and of bad ones; what was told is then held against the job itself."""
    def post(path, document, **headers):
        return requests.post(bounded.url + path, json=document, headers=headers, timeout=60)

    key = {"Idempotency-Key": "once"}
    good, bad = {"inputs": SPEC, "label": {"a": 1}}, {"inputs": SPEC | {"fill_fraction": 2, "colour": 1}}
    checked, refused = post("/processes/drum/execution?check=true", good, **key), post("/processes/drum/execution?check=true", bad)
    study = {"name": "two", "base": good, "vary": {"/inputs/contact/friction": [0.1, 0.2]}, "repeats": 3}
    study_checked = post("/studies?check=true", study)
    study_refused = post("/studies?check=true", study | {"vary": {"/inputs/threads": [1, 3]}})
    assert (checked.status_code, study_checked.status_code) == (200, 200) and "Location" not in checked.headers
    assert post("/processes/drum/execution?check=maybe", good).status_code == post("/studies?check=1", study).status_code == 400
    assert bounded.get("/jobs").json()["jobs"] == bounded.get("/studies").json()["studies"] == []
    assert list((bounded.data / "jobs").iterdir()) == []

    assert errors_of(refused) == errors_of(post("/processes/drum/execution", bad)) and len(errors_of(refused)) == 2
    assert errors_of(study_refused) == errors_of(post("/studies", study | {"vary": {"/inputs/threads": [1, 3]}}))
    made = post("/processes/drum/execution?check=false", good, **key).json()  # a check has not used the key up
    report = checked.json()
    assert report.pop("spec") == bounded.get(f"/jobs/{made['jobID']}/spec").json() and report == {name: made[name] for name in report}
    assert set(report) == {"estimate", "understood", "warnings"}
    report, made = study_checked.json(), post("/studies", study).json()
    assert (report["name"], report["cases"], report["repeats"], report["estimate"]["jobs"]) == ("two", 2, 3, 6)
    assert report["estimate"] == made["estimate"] and report["warnings"] == made["warnings"]


def test_every_line_of_the_log_is_an_object_and_tells_the_request(tmp_path):
    daemon = Daemon(tmp_path, worker=FAKE_WORKER, options=["--log", "json"]).start()
    mine = {"X-Request-Id": "mine-1"}
    answer = requests.post(f"{daemon.url}/processes/drum/execution", json={"inputs": SPEC, "label": {"fake": "fault"}}, headers=mine, timeout=30)
    assert answer.headers["X-Request-Id"] == "mine-1"
    job = answer.json()["jobID"]
    daemon.ended(job)
    others = [daemon.get("/jobs", headers=headers).headers["X-Request-Id"]
              for headers in ({}, {}, {"X-Request-Id": 'a"b'}, {"X-Request-Id": "x" * 65})]
    assert len(set(others)) == 4 and all(re.fullmatch(r"[0-9a-f]+-[0-9a-f]+", one) for one in others)
    refused = daemon.get('/no"thing')
    assert refused.status_code in (400, 404)
    daemon.stop()
    lines = [json.loads(line) for line in daemon.log().splitlines()]
    assert all(re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z", line["time"]) and line["message"] for line in lines)
    post = next(line for line in lines if line.get("request") == "mine-1")
    assert (post["method"], post["path"], post["status"]) == ("POST", "/processes/drum/execution", 201) and post["seconds"] > 0
    assert any(line["message"].startswith(f"job {job}: failed") and "request" not in line for line in lines)
    assert {line["request"] for line in lines if line.get("path") == "/jobs"} == set(others)
