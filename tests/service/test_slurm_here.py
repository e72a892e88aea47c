"""A real Slurm on this machine, and everything that can happen to it while it runs a study. What comes out must be what this machine
makes of the same study by itself."""
import re
import signal
import time

import pytest
import requests
from conftest import SPEC, Daemon
from slurm_here import Slurm, what_is_missing

STUDY = {"name": "drums", "base": {"inputs": SPEC | {"duration": {"seconds": 0.1}, "snapshots": {"interval": 1.0}}}, "repeats": 20,
         "vary": {"/inputs/contact/friction": [0.1, 0.3, 0.5]}}
OF_THE_CLOCK = re.compile(r'"(wall_seconds|particle_steps_per_second)": ?[^,}\n]*')


@pytest.fixture
def slurm(tmp_path):
    missing = what_is_missing()
    if missing:
        pytest.skip(f"Slurm can't be started here: {missing}")
    here = Slurm(tmp_path / "slurm")
    try:
        yield here.start()
    finally:
        here.stop()


@pytest.fixture
def service(tmp_path, monkeypatch):
    started = []

    def start(name, *options):
        (tmp_path / name).mkdir()
        daemon = Daemon(tmp_path / name, options=options)
        started.append(daemon)
        return daemon.start()
    yield start
    for daemon in started:
        if daemon.is_running():
            daemon.stop(signal.SIGKILL)


def post(daemon, study):
    answer = requests.post(f"{daemon.url}/studies", json=study, timeout=60)
    assert answer.status_code == 201, answer.text
    return answer.headers["Location"]


def counts(study):
    return requests.get(study, timeout=30).json()["counts"]


def until(condition, seconds=300):
    end = time.monotonic() + seconds
    while not (found := condition()):
        assert time.monotonic() < end
        time.sleep(0.2)
    return found


def results(daemon):
    """By case and repeat, without what the clock says."""
    answer = daemon.get("/query", params={"sql": "select study_case, study_repeat, id from job where status='successful' limit 1000"}).json()
    return {(case, repeat): OF_THE_CLOCK.sub("", (daemon.data / "jobs" / job / "result.json").read_text())
            for case, repeat, job in answer["rows"]}


@pytest.mark.torture
def test_a_study_survives_all_that_happens_to_a_cluster_with_the_same_results_to_the_byte(slurm, service, monkeypatch):
    alone = service("alone")
    expected = post(alone, STUDY)
    for name in ("SLURM_CONF", "PATH"):
        monkeypatch.setenv(name, slurm.environment[name])
    daemon = service("cluster", "--executor", "slurm", "--bundle-seconds", "1", "--slurm-queue", "20")
    study = post(daemon, STUDY)

    def done():
        return counts(study)["successful"]

    def running():
        return [number for number, state, _ in slurm.jobs() if state == "RUNNING"]

    until(lambda: done() >= 3)
    slurm.kill("slurmctld")
    daemon.stop(signal.SIGKILL)
    slurm.launch("slurmctld", "-D")
    daemon.start()
    until(lambda: done() >= 8)
    [cancelled, *_] = until(running)
    slurm.run("scancel", cancelled)
    until(lambda: done() >= 14)
    until(running)
    slurm.run("scontrol", "update", f"nodename={slurm.host}", "state=down", "reason=a test")
    time.sleep(1)
    slurm.run("scontrol", "update", f"nodename={slurm.host}", "state=resume")
    until(lambda: counts(study)["accepted"] + counts(study)["running"] == 0)
    failed = daemon.get("/query", params={"sql": "select message from job where status='failed'"}).json()["rows"]
    assert all("was cancelled" in message for [message] in failed)
    if failed:
        assert requests.post(f"{study}/retry", timeout=30).status_code == 200
    until(lambda: done() == 60)
    until(lambda: counts(expected)["successful"] == 60)
    assert results(daemon) == results(alone)
    [[most]] = daemon.get("/query", params={"sql": "select max(attempt) from job"}).json()["rows"]
    assert most <= 2  # of those that were asked for again
