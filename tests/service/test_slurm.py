"""Workers in the jobs of a cluster: a daemon with --executor slurm beside commands that stand in for Slurm's (fake_slurm.py)."""
import json
import os
import re
import signal
import time
from pathlib import Path

import pytest
import requests
from conftest import FAKE_WORKER, SPEC, Daemon

FAKE_SLURM = Path(__file__).with_name("fake_slurm.py")


class Cluster:
    def __init__(self, folder):
        self.folder = folder
        (folder / "jobs").mkdir(parents=True)
        (folder / "bin").mkdir()
        for name in ("sbatch", "squeue", "sacct", "scancel"):
            (folder / "bin" / name).symlink_to(FAKE_SLURM)

    def set(self, name, text=""):
        (self.folder / f"{name}.tmp").write_text(str(text))
        os.rename(self.folder / f"{name}.tmp", self.folder / name)

    def unset(self, name):
        (self.folder / name).unlink()

    def jobs(self):
        """Of those that sbatch took: number, state, options, script."""
        folders = sorted(self.folder.glob("jobs/*/state"), key=lambda state: int(state.parent.name))
        return [(int(state.parent.name), state.read_text(), json.loads((state.parent / "options").read_text()),
                 (state.parent / "script").read_text()) for state in folders]

    def end(self, number, how):
        (self.folder / "jobs" / str(number) / "end").write_text(how)

    def calls(self, name):
        return (self.folder / "calls").read_text().split().count(name)


@pytest.fixture
def cluster(tmp_path, monkeypatch):
    made = Cluster(tmp_path / "cluster")
    monkeypatch.setenv("FAKE_SLURM", str(made.folder))
    monkeypatch.setenv("PATH", f"{made.folder / 'bin'}:{os.environ['PATH']}")
    yield made
    for number, state, *_ in made.jobs():
        if state in ("PENDING", "RUNNING"):
            made.end(number, "CANCELLED")
    until = time.monotonic() + 20
    while any(state in ("PENDING", "RUNNING") for _, state, *_ in made.jobs()) and time.monotonic() < until:
        time.sleep(0.05)


@pytest.fixture
def service(tmp_path, cluster):
    started = []

    def start(*options, worker=FAKE_WORKER):
        daemon = Daemon(tmp_path, worker=worker, options=["--executor", "slurm", *options]).start()
        started.append(daemon)
        return daemon
    yield start
    for daemon in started:
        if daemon.is_running():
            daemon.stop(signal.SIGKILL)


def rows(daemon, sql):
    answer = daemon.get("/query", params={"sql": sql}).json()
    return [dict(zip(answer["columns"], row)) for row in answer["rows"]]


def until(condition, seconds=30):
    """What the condition gives once it gives something."""
    end = time.monotonic() + seconds
    while not (found := condition()):
        assert time.monotonic() < end
        time.sleep(0.05)
    return found


def samples(daemon, job):
    return [line["number"] for line in map(json.loads, (daemon.data / "jobs" / job / "events.ndjson").read_text().splitlines())
            if line["event"] == "sample"]


def ends(daemon, job):
    return re.findall(r"end (\d+)", "".join(fence.read_text() for fence in sorted((daemon.data / "jobs" / job).glob("fence.*"))))


def test_short_jobs_are_run_one_after_the_other_in_one_job_of_slurm_each_with_an_end_of_its_own(service, cluster):
    daemon = service("--slurm-partition", "drums", "--slurm-line=--reservation=lab", "--slurm-allow", "qos=long,short", "--slurm-allow",
                     "partition=gpu")
    for wrong, said in (({"qos": "longer"}, "allows long, short"), ({"partition": "drums"}, "allows gpu"), ({"qos": "long,short"}, "1 to 63"),
                        ({"account": "x"}, "no job choose"), ({"gres": "gpu:1"}, "known are partition, account"), ({"qos": 1}, "1 to 63")):
        answer = requests.post(f"{daemon.url}/processes/drum/execution", json={"inputs": SPEC, "resources": wrong}, timeout=30)
        [error] = answer.json()["errors"]
        assert answer.status_code == 400 and error["pointer"] == f"/resources/{[*wrong][0]}" and said in error["detail"]
    cases = [{"name": str(n), "label": {"fake": "quick" if n != 2 else "numerical"}} for n in range(4)]
    cases.append({"name": "4", "label": {"fake": "quick"}, "resources": {"qos": "long", "partition": "gpu"}})
    wrong = requests.post(f"{daemon.url}/studies", json={"base": {"inputs": SPEC}, "cases": [*cases, {"name": "5", "resources": {"qos": "x"}}]},
                          timeout=30)
    assert wrong.status_code == 400 and [error["pointer"] for error in wrong.json()["errors"]] == ["/cases/5/resources/qos"]
    assert requests.post(f"{daemon.url}/studies", json={"base": {"inputs": SPEC}, "cases": cases}, timeout=30).status_code == 201
    *jobs, chosen = [row["id"] for row in rows(daemon, "select id from job order by number")]
    assert daemon.ended(chosen)["status"] == "successful"
    [options] = [options for _, _, options, _ in cluster.jobs() if chosen in options["job-name"]]
    assert options["qos"] == "long" and options["partition"] == "gpu" and options["reservation"] == "lab"
    assert [daemon.ended(job)["status"] for job in jobs] == ["successful", "successful", "failed", "successful"]
    number, _, options, script = cluster.jobs()[0]
    assert options["job-name"] == f"reposed-{jobs[0]}.1" and jobs[0] in options["comment"]
    assert options["partition"] == "drums" and options["reservation"] == "lab" and options["signal"] == "B:TERM@60"
    assert re.findall(r"^one (\S+)", script, re.M) == jobs
    assert [ends(daemon, job) for job in jobs] == [["0"], ["0"], ["4"], ["0"]]
    metrics = daemon.get("/metrics").text
    assert "reposed_batch_submissions_total 2\n" in metrics and "reposed_batch_refusals_total 0\n" in metrics
    until(lambda: not list((daemon.data / "slurm").iterdir()))


@pytest.mark.torture
def test_a_daemon_that_was_killed_goes_on_with_the_jobs_that_slurm_runs(service, cluster):
    daemon = service("--bundle-seconds", "0")
    cluster.set("nodes", 1)
    jobs = [daemon.submit(seconds=9), daemon.submit(seconds=0)]
    daemon.until(jobs[0], lambda status: status["progress"] > 5)
    daemon.until(jobs[1], lambda status: "Resources" in status["message"])
    daemon.stop(signal.SIGKILL)
    daemon.start()
    assert [daemon.ended(job)["status"] for job in jobs] == ["successful", "successful"]
    assert len(cluster.jobs()) == 2 and [ends(daemon, job) for job in jobs] == [["0"], ["0"]]
    assert samples(daemon, jobs[0]) == list(range(20))  # by one worker, without a break
    # In good order it leaves them at work, too.
    job = daemon.submit(seconds=3)
    daemon.until(job, lambda status: status["progress"] > 5)
    assert daemon.stop() == 0
    daemon.start()
    assert daemon.ended(job)["status"] == "successful" and samples(daemon, job) == list(range(20))


@pytest.mark.torture
def test_what_sbatch_refuses_is_tried_again_and_a_lost_answer_makes_no_second_job(service, cluster):
    cluster.set("refuse", "QOSMaxSubmitJobLimit")
    daemon = service("--bundle-seconds", "0")
    job = daemon.submit()
    daemon.until(job, lambda status: "QOSMaxSubmitJobLimit" in status["message"])
    until(lambda: "reposed_batch_refusals_total 0\n" not in daemon.get("/metrics").text)
    cluster.set("lose")
    cluster.unset("refuse")
    assert daemon.ended(job)["status"] == "successful"
    assert len(cluster.jobs()) == 1 and daemon.job(job)["status"] == "successful"
    # The daemon dies between sbatch and its answer's record; the controller is down when the next one comes.
    cluster.set("held")
    job = daemon.submit()
    until(lambda: len(cluster.jobs()) == 2)
    daemon.stop(signal.SIGKILL)
    cluster.set("down")
    cluster.unset("lose")
    daemon.start()
    daemon.until(job, lambda status: "does not answer" in status["message"])
    cluster.unset("down")
    cluster.unset("held")
    assert daemon.ended(job)["status"] == "successful" and len(cluster.jobs()) == 2


@pytest.mark.torture
def test_each_end_that_slurm_tells_means_what_it_should_to_the_job(service, cluster):
    daemon = service("--bundle-seconds", "0")
    cluster.set("nodes", 4)

    def at_work(count):
        jobs = [daemon.submit(seconds=12) for _ in range(count)]
        for job in jobs:
            daemon.until(job, lambda status: status["progress"] > 5)
        return [(job, next(number for number, _, options, _ in cluster.jobs() if job in options["job-name"])) for job in jobs]

    (lost, first), (preempted, second), (cancelled, third), (starved, fourth) = at_work(4)
    cluster.end(first, "NODE_FAIL")
    cluster.end(second, "PREEMPTED")
    cluster.end(third, "CANCELLED")
    cluster.end(fourth, "OUT_OF_MEMORY")
    status = daemon.ended(cancelled)
    assert status["status"] == "failed" and f"Slurm job {third} was cancelled" in status["message"]
    for job in (lost, preempted, starved):
        assert daemon.ended(job)["status"] == "successful"
    table = {row["id"]: row for row in rows(daemon, "select id, attempt, starts, more_memory from job")}
    assert [table[job]["attempt"] for job in (lost, preempted, starved)] == [1, 1, 1]
    assert [table[job]["starts"] for job in (lost, preempted, starved, cancelled)] == [2, 2, 2, 1]
    memory = [int(options["mem"][:-1]) for _, _, options, _ in cluster.jobs() if starved in options["job-name"]]
    assert len(memory) == 2 and memory[1] == pytest.approx(2 * memory[0], abs=2)
    # Twice is once too often.
    [(job, number)] = at_work(1)
    cluster.end(number, "OUT_OF_MEMORY")
    until((daemon.data / "jobs" / job / "fence.000002").exists)
    number = next(number for number, _, options, _ in cluster.jobs() if f"{job}.2" in options["job-name"])
    cluster.end(number, "OUT_OF_MEMORY")
    assert daemon.ended(job)["status"] == "failed" and "memory" in daemon.job(job)["message"]


@pytest.mark.torture
def test_what_never_began_is_submitted_again_and_a_result_is_looked_for_for_some_time(service, cluster):
    daemon = service("--bundle-seconds", "0")
    cluster.set("held")
    unborn, vanished = daemon.submit(), daemon.submit()
    until(lambda: len(cluster.jobs()) == 2)
    (first, *_), (second, *_) = cluster.jobs()
    cluster.end(first, "BOOT_FAIL")
    cluster.end(second, "VANISHED")
    until(lambda: f"{unborn}.2" in str([options for _, _, options, _ in cluster.jobs()]))
    until(lambda: [options for number, _, options, _ in cluster.jobs() if f"{vanished}.1" in options["job-name"] and number != second], 60)
    cluster.unset("held")
    assert [daemon.ended(job)["status"] for job in (unborn, vanished)] == ["successful", "successful"]
    assert rows(daemon, "select starts, attempt from job order by number") == [{"starts": 2, "attempt": 1}, {"starts": 1, "attempt": 1}]
    assert [ends(daemon, job) for job in (unborn, vanished)] == [["0"], ["0"]] and len(cluster.jobs()) == 3
    job = daemon.submit(fake="seen late")
    until(lambda: ends(daemon, job))
    assert daemon.job(job)["status"] == "running"
    assert daemon.ended(job)["status"] == "successful"
    assert rows(daemon, "select starts, attempt from job order by number")[2] == {"starts": 1, "attempt": 1}


@pytest.mark.torture
def test_a_run_that_needs_more_time_goes_on_with_twice_as_much_and_a_dismissed_one_leaves(service, cluster):
    cluster.set("minute", 1)  # 60 s before the end become one
    daemon = service("--bundle-seconds", "0", "--slurm-line=--time=2")
    job = daemon.submit(seconds=2)
    assert daemon.ended(job)["status"] == "successful"
    assert len(cluster.jobs()) > 1 and ends(daemon, job)[0] == "3" and ends(daemon, job)[-1] == "0"
    row = rows(daemon, "select more_time, attempt from job")[0]
    assert row["more_time"] == len(cluster.jobs()) - 1
    assert samples(daemon, job)[-1] == 19
    cluster.set("minute", 60)
    job = daemon.submit(seconds=60)
    daemon.until(job, lambda status: status["progress"] > 5)
    assert requests.delete(f"{daemon.url}/jobs/{job}", timeout=30).status_code == 200
    until(lambda: cluster.jobs()[-1][1] == "CANCELLED")
    assert "stop" in (daemon.data / "jobs" / job / "fence.000001").read_text()

