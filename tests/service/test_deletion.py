"""Jobs tried again, and jobs and studies deleted with all that they left."""
import os
import re
import signal
import sqlite3
import time

import pytest
import requests
from conftest import SPEC, run_daemon


def delete(daemon, path):
    return requests.delete(daemon.url + path, timeout=30)


def retry(daemon, job):
    return requests.post(f"{daemon.url}/jobs/{job}/retry", timeout=30)


def submit_study(daemon, document):
    answer = requests.post(f"{daemon.url}/studies", json=document, timeout=30)
    assert answer.status_code == 201, answer.text
    return answer.json()["studyID"]


def study_ended(daemon, study, seconds=60):
    end = time.monotonic() + seconds
    while (info := daemon.get(f"/studies/{study}?wait=5").json())["status"] in ("accepted", "running"):
        assert time.monotonic() < end, info
    return info


def folders(daemon):
    return sorted(path.name for path in (daemon.data / "jobs").iterdir())


def left_in_tables(daemon, *ids):
    """The rows of every table that speak of jobs or studies of these ids, or of jobs that are not there."""
    with sqlite3.connect(f"file:{daemon.data / 'reposed.sqlite'}?mode=ro", uri=True) as database:
        tables = [name for name, in database.execute("SELECT name FROM pragma_table_list WHERE type='table' AND schema='main'"
                                                     " AND name NOT LIKE 'sqlite%' AND name<>'leaving'")]
        found = {}
        for table in tables:
            columns = {row[1] for row in database.execute(f"PRAGMA table_info({table})")}
            if "job" in columns:
                found[table] = database.execute(f"SELECT count(*) FROM {table} WHERE job NOT IN (SELECT number FROM job)").fetchone()[0]
            if "id" in columns:
                found[table] = sum(database.execute(f"SELECT count(*) FROM {table} WHERE id=?", (one,)).fetchone()[0] for one in ids)
        assert database.execute("SELECT (SELECT sum(jobs) FROM job_count)=(SELECT count(*) FROM job)").fetchone()[0]
    assert {"job", "sample", "result", "study", "drum_input"} <= set(found)
    return {table: count for table, count in found.items() if count}


def wait_until(condition, seconds=20):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.05)


@pytest.mark.parametrize("what", ["quick", "fault", "slow"])
def test_an_ended_job_is_deleted_with_its_rows_and_its_folder(fake, what):
    job, other = fake.submit(fake=what, seconds="60" if what == "slow" else "0"), fake.submit()
    if what == "slow":
        fake.until(job, lambda info: info["progress"] > 0)
        assert delete(fake, f"/jobs/{job}").json()["status"] == "dismissed"
        assert fake.job(job)["status"] == "dismissed"  # it is kept until it is deleted
    ended = fake.ended(job)
    fake.ended(other)
    answer = delete(fake, f"/jobs/{job}")
    assert answer.status_code == 200 and answer.json()["jobID"] == job and answer.json()["status"] == "dismissed"
    assert ended["status"] in answer.json()["message"]
    for path in ("", "/results", "/spec", "/log", "/samples", "/snapshots", "/snapshots/0.hdf"):
        assert fake.get(f"/jobs/{job}{path}").status_code == 404, path
    assert not (fake.data / "jobs" / job).exists()
    wait_until(lambda: folders(fake) == [other])  # also where a worker had still to leave
    assert left_in_tables(fake, job) == {}
    assert [info["jobID"] for info in fake.get("/jobs").json()["jobs"]] == [other]
    assert delete(fake, f"/jobs/{job}").status_code == 404 and fake.get(f"/jobs/{other}/results").status_code == 200


def test_a_study_is_deleted_with_all_its_jobs(fake):
    study = submit_study(fake, {"base": {"inputs": SPEC}, "vary": {"/inputs/contact/friction": [0.1, 0.2]}, "repeats": 2})
    jobs = [info["jobID"] for info in fake.get(f"/jobs?study={study}").json()["jobs"]]
    alone = fake.submit()
    assert study_ended(fake, study)["status"] == "successful" and len(jobs) == 4
    fake.ended(alone)
    answer = delete(fake, f"/studies/{study}")
    assert answer.status_code == 200 and answer.json()["studyID"] == study
    assert fake.get(f"/studies/{study}").status_code == 404 and fake.get("/studies").json()["studies"] == []
    assert all(fake.get(f"/jobs/{job}").status_code == 404 and not (fake.data / "jobs" / job).exists() for job in jobs)
    wait_until(lambda: folders(fake) == [alone])
    assert left_in_tables(fake, study, *jobs) == {} and delete(fake, f"/studies/{study}").status_code == 404


def test_a_study_that_runs_is_first_cancelled_and_then_deleted(fake):
    study = submit_study(fake, {"base": {"inputs": SPEC, "label": {"fake": "slow", "seconds": "60"}}, "repeats": 4})
    wait_until(lambda: len(fake.workers()) == 2)
    assert delete(fake, f"/studies/{study}").json()["counts"]["dismissed"] == 4
    assert delete(fake, f"/studies/{study}").status_code == 200  # while its workers are still leaving
    assert fake.get(f"/studies/{study}").status_code == 404
    wait_until(lambda: folders(fake) == [] and not fake.workers())
    job = fake.submit()
    assert fake.ended(job)["status"] == "successful"


def test_a_job_number_is_never_used_twice(fake):
    def number():
        with sqlite3.connect(f"file:{fake.data / 'reposed.sqlite'}?mode=ro", uri=True) as database:
            return database.execute("SELECT max(number) FROM job").fetchone()[0]

    job = fake.submit()
    fake.ended(job)
    before = number()
    delete(fake, f"/jobs/{job}")
    fake.submit()
    assert number() == before + 1


@pytest.mark.parametrize("moment", ["committed", "put aside", "half emptied"])
def test_whatever_dies_in_a_deletion_the_next_daemon_ends_it(fake, moment):
    """The states in which a kill -9 can leave it, made by hand: after the commit, after the rename, within the removal."""
    job, other = fake.submit(), fake.submit()
    fake.ended(job), fake.ended(other)
    fake.stop(signal.SIGKILL)
    folder = fake.data / "jobs" / job
    with sqlite3.connect(fake.data / "reposed.sqlite") as database:
        database.execute("PRAGMA foreign_keys=ON")
        database.execute("INSERT INTO leaving VALUES(?, ?)", (job, time.time() - 3600))
        database.execute("DELETE FROM job WHERE id=?", (job,))
    if moment != "committed":
        folder.rename(folder.with_suffix(".gone"))
    if moment == "half emptied":
        (folder.with_suffix(".gone") / "spec.json").unlink()
        os.symlink(fake.data / "jobs" / other, folder.with_suffix(".gone") / "snapshots" / "link")  # not followed
    fake.start()
    wait_until(lambda: folders(fake) == [other])
    assert fake.get(f"/jobs/{job}").status_code == 404 and (fake.data / "jobs" / other / "result.json").exists()
    with sqlite3.connect(f"file:{fake.data / 'reposed.sqlite'}?mode=ro", uri=True) as database:
        wait_until(lambda: database.execute("SELECT count(*) FROM leaving").fetchone()[0] == 0)


@pytest.mark.torture
def test_kills_in_the_midst_of_deletions_leave_all_or_nothing(fake):
    for turn in range(15):
        study = submit_study(fake, {"base": {"inputs": SPEC}, "repeats": 20})
        study_ended(fake, study)
        jobs = [info["jobID"] for info in fake.get(f"/jobs?study={study}").json()["jobs"]]
        killer = os.fork()
        if killer == 0:
            time.sleep(0.002 * turn)
            os.kill(fake.process.pid, signal.SIGKILL)
            os._exit(0)
        try:
            delete(fake, f"/studies/{study}")
        except requests.ConnectionError:
            pass
        os.waitpid(killer, 0)
        fake.process.wait(10)
        fake.process.stdout.close()
        fake.start()
        if fake.get(f"/studies/{study}").status_code == 200:
            assert all(fake.get(f"/jobs/{job}/snapshots/0.hdf").status_code == 200 for job in jobs)
            assert delete(fake, f"/studies/{study}").status_code == 200
        wait_until(lambda: folders(fake) == [])
        assert left_in_tables(fake, study, *jobs) == {}


@pytest.mark.parametrize("how", ["snapshot", "checkpoint"])
def test_a_job_that_starts_from_a_deleted_jobs_bed_has_it_all_the_same(daemon, how):
    source = daemon.submit()
    assert daemon.ended(source)["status"] == "successful"
    blocker = [daemon.submit(SPEC | {"duration": {"seconds": 2.0}}) for _ in range(os.cpu_count() or 1)]
    start = {"job": source} | ({"snapshot": 2} if how == "snapshot" else {})
    job = daemon.submit(SPEC | {"start": start})
    assert delete(daemon, f"/jobs/{source}").status_code == 200
    for one in blocker:
        delete(daemon, f"/jobs/{one}")
    assert daemon.ended(job)["status"] == "successful"
    wait_until(lambda: not (daemon.data / "jobs" / f"{source}.gone").exists())


# --- trying again

def test_a_failed_job_is_tried_again_with_all_its_attempts(fake):
    job = fake.submit(fake="dies")
    assert fake.ended(job)["attempt"] == 3
    answer = retry(fake, job)
    assert answer.status_code == 200 and answer.json()["status"] == "accepted" and "finished" not in answer.json()
    again = fake.until(job, lambda info: info["status"] == "failed")
    assert again["attempt"] == 6 and "3 attempts in a row" in again["message"]


def test_a_dismissed_job_goes_on_from_its_checkpoint(fake):
    job = fake.submit(fake="slow", seconds="3")
    fake.until(job, lambda info: info["progress"] > 10)
    delete(fake, f"/jobs/{job}")
    assert retry(fake, job).status_code == 200  # while its worker is still leaving
    ended = fake.ended(job)
    assert ended["status"] == "successful" and ended["attempt"] == 2
    events = (fake.data / "jobs" / job / "events.ndjson").read_text()
    assert events.count('"event": "start"') == 2 and events.count('"resumed": true') == 1
    assert fake.get("/jobs").json()["counts"] == {"accepted": 0, "running": 0, "successful": 1, "failed": 0, "dismissed": 0}


def test_what_is_neither_failed_nor_dismissed_is_not_tried_again(fake):
    done, running = fake.submit(), fake.submit(fake="slow", seconds="60")
    fake.ended(done)
    for job in (done, running):
        answer = retry(fake, job)
        assert answer.status_code == 409 and fake.job(job)["status"] in answer.json()["detail"]
    assert retry(fake, "20200101-000000-00000000").status_code == 404
    assert requests.post(f"{fake.url}/jobs/{done}/retry", headers={"Origin": "http://elsewhere.example"}, timeout=30).status_code == 403


# --- room

HUGE = SPEC | {"drum": SPEC["drum"] | {"diameter": 0.4, "length": 0.4}, "duration": {"seconds": 50.0}}


@pytest.fixture
def idle(tmp_path):
    """With a worker that does nothing."""
    yield from run_daemon(tmp_path, worker="/bin/true")


def test_what_the_disk_can_not_hold_is_refused(idle):
    room = os.statvfs(idle.data)
    free = room.f_bavail * room.f_frsize
    one = idle.post(HUGE | {"snapshots": {"interval": 10.0}}).json()["estimate"]
    snapshot = one["snapshot_bytes"] / one["snapshots"]
    number = 2.0 * free / snapshot  # of snapshots that take twice what there is
    if number > 99e3:
        pytest.skip(f"the disk has {free / 1e9:.0f} GB free, more than a job's snapshots are allowed to take")
    answer = idle.post(HUGE | {"snapshots": {"interval": 50.0 / number}})
    error, = answer.json()["errors"]
    assert answer.status_code == 400 and error["pointer"] == "/inputs/snapshots/interval" and "GB" in error["detail"]
    told = [float(number) for number in re.findall(r"([0-9.e+]+) GB", error["detail"])]
    assert told == pytest.approx([2e-9 * free, 1e-9 * free], rel=0.05)  # three digits; others use the disk, too
    assert len(folders(idle)) == 1  # of the first one
    study = {"base": {"inputs": HUGE | {"snapshots": {"interval": 50.0 / (number / 8)}}}, "repeats": 16}
    answer = requests.post(f"{idle.url}/studies", json=study, timeout=60)
    assert answer.status_code == 400 and "/snapshots/interval" in answer.json()["errors"][0]["pointer"]
    assert idle.get("/studies").json()["studies"] == []
