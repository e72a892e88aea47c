"""A real Slurm on this machine, and everything that can happen to it while it runs jobs. What comes out must be what this machine
makes of the same by itself."""
import json
import re
import signal
import sqlite3
import subprocess
import time

import pytest
import requests
from conftest import BUILD, FAKE_WORKER, SPEC, Daemon
from slurm_here import BY_CGROUPS, BY_LOOKING, Slurm, what_is_missing, why_no_cgroups

STUDY = {"name": "drums", "base": {"inputs": SPEC | {"duration": {"seconds": 0.1}, "snapshots": {"interval": 1.0}}}, "repeats": 20,
         "vary": {"/inputs/contact/friction": [0.1, 0.3, 0.5]}}
OF_THE_RUN = re.compile(r'"(wall_seconds|particle_steps_per_second|attempt)": ?[^,}\n]*')


@pytest.fixture
def start_slurm(tmp_path, monkeypatch):
    """Its commands are those that daemons find from then on."""
    if missing := what_is_missing():
        pytest.skip(f"Slurm can't be started here: {missing}")
    started = []

    def start(memory=BY_LOOKING):
        started.append(Slurm(tmp_path / "slurm", memory))
        started[0].start()
        for name in ("SLURM_CONF", "PATH"):
            monkeypatch.setenv(name, started[0].environment[name])
        return started[0]
    yield start
    for one in started:
        one.stop()


@pytest.fixture
def service(tmp_path, monkeypatch):
    started = []

    def start(name, *options, worker=None):
        (tmp_path / name).mkdir()
        daemon = Daemon(tmp_path / name, worker=worker, options=options)
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
    """By case and repeat, without what the clock says and which attempt it was."""
    sql = "select study_case, study_repeat, id from job where status='successful' limit 1000"
    return {(case, repeat): OF_THE_RUN.sub("", (daemon.data / "jobs" / job / "result.json").read_text())
            for case, repeat, job in rows(daemon, sql)}


def rows(daemon, sql):
    return daemon.get("/query", params={"sql": sql}).json()["rows"]


@pytest.mark.torture
def test_a_few_jobs_by_a_real_slurm_end_as_they_do_here_and_one_that_fails_holds_up_no_other(start_slurm, service, tmp_path):
    study = STUDY | {"repeats": 1}
    alone = service("alone")
    expected = post(alone, study)
    slurm = start_slurm()
    daemon = service("cluster", "--executor", "slurm", "--slurm-allow", "partition=drums,other")
    wrong = requests.post(f"{daemon.url}/studies", json=study | {"base": study["base"] | {"resources": {"partition": "gpu"}}}, timeout=60)
    assert wrong.status_code == 400 and "drums, other" in wrong.json()["errors"][0]["detail"]
    done = post(daemon, study | {"base": study["base"] | {"resources": {"partition": "drums"}}})
    until(lambda: counts(done)["successful"] == 3)
    until(lambda: counts(expected)["successful"] == 3)
    assert results(daemon) == results(alone) and len(slurm.jobs()) == 1
    # Of five in one Slurm job the third breaks down.
    fake = service("fake", "--executor", "slurm", worker=FAKE_WORKER)
    cases = [{"name": str(n), "label": {"fake": "numerical" if n == 2 else "quick"}} for n in range(5)]
    broken = post(fake, {"base": {"inputs": SPEC}, "cases": cases})
    until(lambda: counts(broken)["successful"] == 4 and counts(broken)["failed"] == 1)
    assert rows(fake, "select study_case, starts, attempt from job where status='failed'") == [[2, 1, 1]]
    assert len(slurm.jobs()) == 2 and rows(fake, "select distinct starts, attempt from job") == [[1, 1]]
    # Without a daemon: the same results by an array of Slurm's.
    (tmp_path / "study.json").write_text(json.dumps(study))
    split = tmp_path / "split"
    subprocess.run([BUILD / "repose", "split", tmp_path / "study.json", "--out", split], check=True, timeout=60)
    slurm.run("sbatch", "--wait", split / "job.sbatch")
    collected = subprocess.run([BUILD / "repose", "collect", split], capture_output=True, text=True, timeout=60)
    assert collected.stdout.startswith("3 of 3 jobs have results, 0 failed"), collected
    assert not re.search("earlier daemon|put back|not been told", collected.stderr)
    with sqlite3.connect(split / "reposed.sqlite") as database:
        table = "select study_case, angle_deg, steps from run_summary order by 1"
        assert [list(row) for row in database.execute(table)] == rows(alone, table)


@pytest.mark.torture
def test_a_study_survives_all_that_happens_to_a_cluster_with_the_same_results_to_the_byte(start_slurm, service):
    alone = service("alone")
    expected = post(alone, STUDY)
    slurm = start_slurm()
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
    failed = rows(daemon, "select id, message from job where status='failed'")
    assert failed and all(f"Slurm job {cancelled} was cancelled" in message for _, message in failed)
    states = [state for _, state, _ in slurm.jobs()]
    assert states.count("CANCELLED") == 1 and "NODE_FAIL" in states
    assert rows(daemon, "select distinct attempt from job") == [[1]]  # whatever happened to its machine counts against no job
    assert requests.post(f"{study}/retry", timeout=30).status_code == 200
    until(lambda: done() == 60)
    until(lambda: counts(expected)["successful"] == 60)
    assert results(daemon) == results(alone)
    assert sorted(rows(daemon, "select id, attempt from job where attempt>1")) == [[job, 2] for job in sorted(job for job, _ in failed)]
    # Each was run to its end once: no worker came to a folder that another had.
    logs = "".join(log.read_text() for log in daemon.data.glob("jobs/*/log.txt"))
    assert "can't take its folder" not in logs and "too late" not in logs
    assert len(rows(daemon, "select job from run_result limit 1000")) == 60


@pytest.mark.torture
@pytest.mark.parametrize("memory", [BY_LOOKING, BY_CGROUPS])
def test_what_takes_too_much_memory_is_given_twice_as_much_once(start_slurm, service, memory):
    if memory == BY_CGROUPS and (why := why_no_cgroups()):
        pytest.skip(why)
    slurm = start_slurm(memory)
    daemon = service("cluster", "--executor", "slurm", worker=FAKE_WORKER)
    before, greedy, glutton, after = [daemon.submit(seconds=1, **label) for label in
                                      ({}, {"megabytes": 400}, {"megabytes": 900}, {})]
    assert [daemon.ended(job, seconds=300)["status"] for job in (before, greedy, after)] == ["successful"] * 3
    status = daemon.ended(glutton, seconds=300)
    assert status["status"] == "failed" and "more memory than it was given" in status["message"]
    table = {job: facts for job, *facts in rows(daemon, "select id, more_memory, attempt from job")}
    assert [table[job] for job in (before, greedy, glutton, after)] == [[0, 1], [1, 1], [1, 1], [0, 1]]
    assert sum(state in ("OUT_OF_MEMORY", "FAILED") for _, state, _ in slurm.jobs()) == 3


@pytest.mark.torture
def test_a_time_that_is_too_short_makes_a_job_go_on_from_its_checkpoint(start_slurm, service):
    slurm = start_slurm()
    daemon = service("cluster", "--executor", "slurm", "--slurm-line=--time=1", "--slurm-line=--signal=B:TERM@55", worker=FAKE_WORKER)
    job = daemon.submit(seconds=60)
    assert daemon.ended(job, seconds=500)["status"] == "successful"
    [[more_time, starts]] = rows(daemon, "select more_time, starts from job")
    assert more_time >= 1 and starts == more_time + 1 == len(slurm.jobs())
    numbers = [line["number"] for line in map(json.loads, (daemon.data / "jobs" / job / "events.ndjson").read_text().splitlines())
               if line["event"] == "sample"]
    assert sorted(numbers) == list(range(20)) or len(numbers) < 20 + 2 * starts  # it went on, rather than from the beginning
