"""Jobs of a study that would settle the same bed settle it once, and come to the same bits as if each had done so itself."""
import os
import signal
import sqlite3
from pathlib import Path

import pytest
import requests
from conftest import SPEC, run_daemon
from worker_runs import WALL_CLOCK, events, run, timeless_result, wait_until, write_spec

BASE = {**SPEC, "contact": {"friction": 0.3, "stiffness": 60.0}, "duration": {"seconds": 0.1}, "snapshots": {"interval": 0}}
SLOW = {**BASE, "drum": {"diameter": 0.1, "length": 0.024, "rotation_rate": 3.0}, "duration": {"seconds": 0.02}}  # to settle
LONG = {**BASE, "duration": {"seconds": 200.0}}


@pytest.fixture
def four_workers(tmp_path):
    yield from run_daemon(tmp_path, options=["--workers", "4"])


@pytest.fixture
def two_workers(tmp_path):
    yield from run_daemon(tmp_path, options=["--workers", "2"])


def submit(daemon, inputs, cases, **more):
    document = {"base": {"inputs": inputs}, "cases": [{"name": f"case {n:02}", "inputs": case} for n, case in enumerate(cases)], **more}
    answer = requests.post(f"{daemon.url}/studies", json=document, timeout=60)
    assert answer.status_code == 201, answer.text
    jobs = daemon.get(f"/jobs?study={answer.json()['studyID']}&limit=100").json()["jobs"]
    return [job["jobID"] for job in sorted(jobs, key=lambda job: (job["label"].get("repeat", 0), job["label"]["case"]))]


def results(daemon, job):
    assert daemon.ended(job, 120)["status"] == "successful", daemon.get(f"/jobs/{job}/log").text
    return daemon.get(f"/jobs/{job}/results").json()


def timeless(result):
    return {**result, "run": {name: value for name, value in result["run"].items() if name not in (*WALL_CLOCK, "settled_by")}}


def alone(daemon, job, folder):
    """What its specification comes to in a run of its own."""
    spec = daemon.get(f"/jobs/{job}/spec").json()
    code, _, errors = run(write_spec(folder, spec, f"{job}.json"), folder / job)
    assert code == 0, errors
    result = timeless_result(folder / job)
    del result["run"]["settled_by"]
    return result


def beds(daemon):
    with sqlite3.connect(f"file:{daemon.data}/reposed.sqlite?mode=ro", uri=True) as database:
        return dict(database.execute("SELECT id, sha256 FROM bed JOIN job ON job.number=bed.job").fetchall())


def cancel(daemon, job):
    assert requests.delete(f"{daemon.url}/jobs/{job}", timeout=30).status_code == 200


def folder_of(daemon, job):
    return Path(daemon.data) / "jobs" / job


def test_results_are_those_of_a_bed_of_ones_own(two_workers, tmp_path):
    cluster = {"particles": [{"shape": "dumbbell", "diameter": 0.002}]}
    rate = {"drum": {"rotation_rate": 4.0}}
    same = [{}, rate, {"drum": {"rotation_rate": -4.0}, "duration": {"seconds": 0.15}},
            {"snapshots": {"interval": 0.05}, "samples": {"interval": 0.002}, "threads": 2}]
    other = [{**rate, "contact": {"friction": 0.4}}, {**rate, "precision": "double"}]
    jobs = submit(two_workers, BASE, [*same, *other, cluster, {**cluster, **rate}])
    found = [results(two_workers, job) for job in jobs]
    settled_by = [result["run"]["settled_by"] for result in found]
    assert settled_by[:len(same)] == [None] + [jobs[0]] * (len(same) - 1)
    assert settled_by[len(same):-1] == [None] * (len(other) + 1) and settled_by[-1] == jobs[-2]
    for job, result in zip(jobs, found):
        phases = {event.get("phase") for event in events(folder_of(two_workers, job), "progress")}
        assert not result["run"]["settled_by"] or phases <= {"rotating"}
    for n in (2, 3, len(same), len(jobs) - 1):
        assert timeless(found[n]) == alone(two_workers, jobs[n], tmp_path), n
    assert found[0]["run"]["settling_seconds"] == found[1]["run"]["settling_seconds"] > 0
    assert beds(two_workers) == {} and not list(Path(two_workers.data).glob("jobs/*/bed.hdf*"))
    rows = two_workers.get("/query?sql=SELECT count(*) AS n FROM run_result WHERE settled_by IS NOT NULL").json()
    assert rows["rows"] == [[4]], rows


def test_jobs_wait_for_a_bed_without_a_worker_and_settle_it_where_the_first_does_not(two_workers):
    rates = [{"drum": {"rotation_rate": rate}} for rate in (3.0, 2.0, 1.0)]
    first, second, third, other = submit(two_workers, SLOW, [*rates, {"seed": 8}])
    two_workers.until(other, lambda job: job["status"] == "running")
    assert [two_workers.job(job)["status"] for job in (first, second, third)] == ["running", "accepted", "accepted"]
    cancel(two_workers, first)
    assert results(two_workers, second)["run"]["settled_by"] is None
    assert results(two_workers, third)["run"]["settled_by"] == second


def damage(path):
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    path.write_bytes(content)


def replace_by_link(path):
    path.unlink()
    path.symlink_to("/etc/passwd")


def test_a_bed_outlives_a_crash_and_one_that_is_harmed_is_settled_again(four_workers, tmp_path):
    seeds = [{"seed": seed} for seed in range(4)]
    jobs = submit(four_workers, LONG, [*seeds, *({**seed, "duration": {"seconds": 0.1}} for seed in seeds)])
    first, second = jobs[:4], jobs[4:]
    wait_until(lambda: beds(four_workers).keys() == set(first))
    four_workers.stop(9)
    for job, harm in zip(first[1:], (damage, Path.unlink, replace_by_link)):
        harm(folder_of(four_workers, job) / "bed.hdf")
    four_workers.start()
    for job in first:
        cancel(four_workers, job)
    found = [results(four_workers, job) for job in second]
    assert [result["run"]["settled_by"] for result in found] == [first[0], None, None, None]
    for n in (0, 1):
        assert timeless(found[n]) == alone(four_workers, second[n], tmp_path)


def is_of(worker, job):
    try:
        return job.encode() in Path(f"/proc/{worker}/cmdline").read_bytes()
    except OSError:
        return False


@pytest.mark.torture
def test_whoever_is_held_up_while_settling_holds_up_nobody_and_ends_right(two_workers, tmp_path):
    """The first is stopped, the second, which waits for its bed, is deleted; the others settle one of their own and share it."""
    rates = [{"drum": {"rotation_rate": rate}} for rate in (3.0, 2.0, 1.0, 0.5)]
    first, second, third, fourth = submit(two_workers, SLOW, rates)
    wait_until(lambda: any(is_of(worker, first) for worker in two_workers.workers()))
    held_up, = [worker for worker in two_workers.workers() if is_of(worker, first)]
    os.kill(held_up, signal.SIGSTOP)
    try:
        cancel(two_workers, second)
        cancel(two_workers, second)
        assert two_workers.get(f"/jobs/{second}").status_code == 404
        assert [results(two_workers, job)["run"]["settled_by"] for job in (third, fourth)] == [None, third]
        assert two_workers.job(first)["status"] == "running"
    finally:
        os.kill(held_up, signal.SIGCONT)
    found = {job: results(two_workers, job) for job in (first, third, fourth)}
    assert found[first]["run"]["settled_by"] is None
    for job in (first, fourth):
        assert timeless(found[job]) == alone(two_workers, job, tmp_path)
    assert beds(two_workers) == {} and not list(Path(two_workers.data).glob("jobs/*/bed.hdf*"))
