"""A running service reads its file of options again on SIGHUP: what can change without a restart does, and a wrong file changes nothing."""
import json
import os
import signal
import sqlite3

import pytest
import requests
from conftest import FAKE_WORKER, SPEC, Daemon
from test_daemon_clients import until

TOKEN = "a-token-of-24-characters"


@pytest.fixture
def service(tmp_path):
    daemon = Daemon(tmp_path, worker=FAKE_WORKER, options=["--config", str(tmp_path / "reposed.conf")])
    options(daemon, tmp_path, "", hang_up=False)
    daemon.start()
    yield daemon
    daemon.stop()


def options(daemon, tmp_path, text, hang_up=True):
    (tmp_path / "reposed.conf").write_text(text)
    if hang_up:
        seen = len(daemon.log())
        daemon.process.send_signal(signal.SIGHUP)
        until(lambda: any(words in daemon.log()[seen:] for words in (" is now ", "stay as they were", "none has changed")), 10)
        return daemon.log()[seen:]
    return ""


def code(daemon, inputs=SPEC):
    return daemon.post(inputs, {"fake": "quick"}).status_code


def test_limits_and_names_change_at_once_and_back(service, tmp_path):
    name = {"Host": "lab.example"}
    assert code(service) == 201 and service.get("/healthz", headers=name).status_code == 421
    told = options(service, tmp_path, "max-particles = 20\nallow-host = lab.example\nqueue-limit = 7\n")
    assert "max-particles is now 20, was none" in told and "queue-limit is now 7, was 10000" in told
    refused = service.post(SPEC, {"fake": "quick"})
    assert refused.status_code == 400 and "must be at most 20" in refused.text
    assert service.get("/healthz", headers=name).status_code == 200
    study = {"base": {"inputs": {"friction": 0.3}, "process": "granule"}, "vary": {"/inputs/friction": [k / 10 for k in range(1, 9)]}}
    assert requests.post(f"{service.url}/studies", json=study, timeout=30).status_code == 400  # eight jobs
    options(service, tmp_path, "")
    assert code(service) == 201 and service.get("/healthz", headers=name).status_code == 421
    assert requests.post(f"{service.url}/studies", json=study, timeout=30).status_code == 201


def test_what_takes_a_restart_is_said_and_stays(service, tmp_path):
    options(service, tmp_path, "port = 1\nworkers = 7\nconfine = no\nthreads = 3\n")
    said = ["workers stays ", "confine stays ", "takes a restart", "threads is now 3, was 1"]  # a line each
    until(lambda: [words for words in said if words not in service.log()] == [], 20)
    assert "port stays" not in service.log()  # the command line has the last word, and has not changed
    job = service.post(SPEC, {"fake": "quick"}).json()["jobID"]
    assert service.get(f"/jobs/{job}/spec").json()["inputs"]["threads"] == 3
    assert service.get("/web/style.css").status_code == 200 and "reposed_workers 7\n" not in service.get("/metrics").text
    assert "none has changed that can without a restart" in options(service, tmp_path, "workers = 7\nthreads = 3\n")


@pytest.mark.parametrize("text, says", [("max-particles = few\nprot = 1\n", ["line 1: max-particles", "line 2: there is no option"]),
                                        ("max-particles = 20\ntoken-file = /nowhere/token\n", ["/nowhere/token can't be read"])])
def test_a_wrong_file_changes_nothing(service, tmp_path, text, says):
    told = options(service, tmp_path, text)
    assert "the options stay as they were" in told and [words for words in says if words not in told] == []
    assert code(service) == 201 and service.get("/jobs").status_code == 200
    (tmp_path / "reposed.conf").unlink()
    service.process.send_signal(signal.SIGHUP)
    until(lambda: "reposed.conf can't be read" in service.log(), 10)
    assert code(service) == 201


def test_a_token_file_may_come_and_go(service, tmp_path):
    token = tmp_path / "token"
    token.write_text(f"anna write {TOKEN}\n")
    token.chmod(0o600)
    options(service, tmp_path, f"token-file = {token}\n")
    assert service.get("/jobs").status_code == 401
    assert service.get("/jobs", headers={"Authorization": f"Bearer {TOKEN}"}).status_code == 200
    for _ in range(3):  # the name of the file is the same, the memory that it was read into is not
        options(service, tmp_path, f"token-file = {token}\n")
    assert service.get("/jobs", headers={"Authorization": f"Bearer {TOKEN}"}).status_code == 200
    os.unlink(token)
    assert "the options stay as they were" in options(service, tmp_path, f"token-file = {token}\n")
    assert service.get("/jobs").status_code == 401
    options(service, tmp_path, "")
    assert service.get("/jobs").status_code == 200


def test_the_log_and_what_is_kept_change_too(service, tmp_path):
    job = service.post(SPEC, {"fake": "quick"}).json()["jobID"]
    assert service.job(job, wait=20)["status"] == "successful"
    with sqlite3.connect(service.data / "reposed.sqlite") as database:
        database.execute("UPDATE job SET finished='2020-01-01T00:00:00.000Z'")
    options(service, tmp_path, "log = json\nkeep-days = 5\n")
    until(lambda: service.get(f"/jobs/{job}").status_code == 404, 10)
    last = service.log().splitlines()[-1]
    assert json.loads(last)["message"]
    assert "public-url is now another" in options(service, tmp_path, "public-url = https://lab.example/drum\n")
    assert service.get("/jobs").json()["links"][0]["href"].startswith("https://lab.example/drum/")
