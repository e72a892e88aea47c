"""What keeps a data folder in order: copies of it at work, looking through it, mending it."""
import hashlib
import os
import resource
import shutil
import signal
import sqlite3
import subprocess
import threading
import time

import pytest
import requests
from conftest import BUILD, FAKE_WORKER, Daemon

GRANULE = {"inputs": {"friction": 0.5, "rotation_rate": 18.0}}


def reposed(command, *words, data):
    return subprocess.run([BUILD / "reposed", command, *words, "--data", data], capture_output=True, text=True, timeout=120)


def contents(folder):
    return {str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest() for path in sorted(folder.rglob("*"))
            if path.is_file()}


@pytest.fixture
def restored(tmp_path):
    """A daemon for a copy, in a folder of its own."""
    (tmp_path / "other").mkdir()
    other = Daemon(tmp_path / "other", worker=FAKE_WORKER, options=["--workers", "2"])
    yield other
    if other.is_running():
        other.stop(signal.SIGKILL)


def test_a_copy_of_a_service_at_work_goes_on_from_that_moment(fake, restored):
    done = fake.submit(angle=17, project="kept")
    fake.ended(done)
    running = fake.submit(fake="slow", seconds="2")
    fake.until(running, lambda info: info["progress"] > 10)
    waiting = [fake.submit(fake="slow", seconds="0.2") for _ in range(3)]
    made = reposed("backup", restored.data, data=fake.data)
    assert made.returncode == 0 and f"{restored.data}: 5 jobs" in made.stdout, made.stderr
    later = fake.submit()
    results = fake.get(f"/jobs/{done}/results").json()
    snapshot = fake.get(f"/jobs/{done}/snapshots/1.hdf").content
    assert snapshot.startswith(b"snapshot 1")
    kept = restored.data / f"jobs/{done}"
    assert os.stat(kept / "snapshots/000001.hdf").st_nlink == 2  # no room is taken
    assert os.stat(kept / "events.ndjson").st_nlink == os.stat(kept / "log.txt").st_nlink == 1  # these grow
    for job in (running, *waiting, later):
        assert fake.ended(job)["status"] == "successful"
    fake.stop()
    shutil.rmtree(fake.data)  # the disk is gone
    restored.start()
    assert restored.get(f"/jobs/{done}/results").json() == results and restored.job(done)["label"] == {"angle": 17, "project": "kept"}
    assert restored.get(f"/jobs/{done}/snapshots/1.hdf").content == snapshot
    for job in (running, *waiting):
        assert restored.ended(job)["status"] == "successful" and restored.job(job)["attempt"] == 1
    assert restored.get(f"/jobs/{later}").status_code == 404
    refused = reposed("backup", restored.data, data=restored.data)
    assert refused.returncode == 1 and "File exists" in refused.stderr


def test_copies_are_whole_while_jobs_come_end_and_are_deleted(tmp_path):
    daemon = Daemon(tmp_path).start()
    stop = threading.Event()

    def churn():
        while not stop.is_set():
            ids = [requests.post(daemon.url + "/processes/granule/execution", json=GRANULE, timeout=30).json()["jobID"] for _ in range(3)]
            for job in ids[:2]:
                daemon.ended(job)
                requests.delete(f"{daemon.url}/jobs/{job}", timeout=30)

    clients = [threading.Thread(target=churn) for _ in range(2)]
    try:
        for client in clients:
            client.start()
        for number in range(2):
            made = reposed("backup", tmp_path / f"copy{number}", data=daemon.data)
            assert made.returncode == 0, made.stderr
    finally:
        stop.set()
        for client in clients:
            client.join()
        daemon.stop()
    for number in range(2):
        looked = reposed("check", data=tmp_path / f"copy{number}")
        assert looked.returncode == 0 and " 0 found" in looked.stdout, looked.stdout + looked.stderr


@pytest.fixture
def ended(tmp_path):
    """Two runs of the real worker, at rest; a sound folder."""
    daemon = Daemon(tmp_path).start()
    jobs = [daemon.submit(), daemon.submit()]
    for job in jobs:
        assert daemon.ended(job)["status"] == "successful"
    daemon.stop()
    yield daemon, jobs
    if daemon.is_running():
        daemon.stop(signal.SIGKILL)


def flip(path):
    text = bytearray(path.read_bytes())
    text[len(text) // 2] ^= 4
    path.write_bytes(text)


def change(daemon, sql):
    database = sqlite3.connect(daemon.data / "reposed.sqlite")
    database.executescript(sql)
    database.close()


def test_what_is_damaged_is_found_and_mended_and_nothing_is_thrown_away(ended):
    daemon, (one, two) = ended
    folder, other = (daemon.data / "jobs" / job for job in (one, two))
    sound = reposed("check", data=daemon.data)
    assert sound.returncode == 0 and sound.stdout.startswith("2 jobs that have ended") and " 0 found" in sound.stdout
    results = (folder / "result.json").read_bytes()
    flip(folder / "snapshots/000000.hdf")
    (folder / "snapshots/000001.hdf").unlink()
    (folder / "fields.hdf").write_bytes((folder / "fields.hdf").read_bytes()[:-100])
    flip(folder / "result.json")
    shutil.copytree(folder, daemon.data / "jobs/20200101-000000-00000000")
    (daemon.data / "jobs/notes").write_text("mine")
    change(daemon, "UPDATE job_count SET jobs=jobs+1 WHERE status='failed'; PRAGMA foreign_keys=OFF;"
                   f"DELETE FROM result WHERE job=(SELECT number FROM job WHERE id='{two}');")
    for path in (daemon.data / "jobs/notes", daemon.data / "jobs/20200101-000000-00000000"):
        os.utime(path, (1e9, 1e9))  # not one that is just being made
    before = contents(daemon.data / "jobs")
    looked = reposed("check", data=daemon.data)
    assert looked.returncode == 1 and contents(daemon.data / "jobs") == before
    told = looked.stdout.splitlines()
    assert sorted(told[:-1]) == sorted([
        "the counts of jobs by status are wrong", f"job {one}: snapshots/000000.hdf does not fit its checksum",
        f"job {one}: snapshot 1 is not there, or has another size", f"job {one}: fields.hdf does not fit its checksum",
        f"job {one}: result.json does not fit its checksum; the database has its text",
        f"job {two}: it is successful, but has no results",
        "jobs/notes belongs to no job", "jobs/20200101-000000-00000000 belongs to no job"])
    mended = reposed("check", "--repair", data=daemon.data)
    assert mended.returncode == 0, mended.stdout + mended.stderr
    again = reposed("check", data=daemon.data)
    assert again.returncode == 0 and " 0 found" in again.stdout, again.stdout
    lost = contents(daemon.data / "lost")
    assert lost["notes"] == before["notes"] and lost[f"{one}-fields.hdf"] == before[f"{one}/fields.hdf"]
    assert lost[f"{one}-snapshots-000000.hdf"] == before[f"{one}/snapshots/000000.hdf"]
    assert lost["20200101-000000-00000000/snapshots/000002.hdf"] == before[f"{one}/snapshots/000002.hdf"]
    assert {name: hash for name, hash in before.items() if name.startswith(two)} == \
        {name: hash for name, hash in contents(daemon.data / "jobs").items() if name.startswith(two)}
    daemon.start()
    assert daemon.get(f"/jobs/{one}/results").json() == requests.models.complexjson.loads(results)
    assert daemon.job(two)["status"] == "failed"
    refused = reposed("check", "--repair", data=daemon.data)
    assert refused.returncode == 1 and "in use by another reposed" in refused.stderr
    assert requests.post(f"{daemon.url}/jobs/{two}/retry", timeout=30).status_code == 200
    assert daemon.ended(two)["status"] == "successful" and daemon.get(f"/jobs/{two}/results").status_code == 200
    assert reposed("check", data=daemon.data).returncode == 0  # beside a daemon


def test_a_look_at_twice_as_many_jobs_takes_twice_as_long(ended):
    """Not four times: the next job is found without a look at all that have ended."""
    daemon, _ = ended
    change(daemon, "WITH RECURSIVE n(x) AS (SELECT 1 UNION ALL SELECT x+1 FROM n WHERE x<5000) INSERT INTO job(id,process,label,spec,status,message,"
                   "threads,estimated_seconds,estimated_memory_bytes,created,updated,finished) SELECT printf('20200101-000000-%08x',x),'drum','{}',"
                   "hex(zeroblob(1500)),'failed','',1,1,1,'','','2020-01-01T00:00:00.000Z' FROM n")
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    assert reposed("check", data=daemon.data).stdout.startswith("5002 jobs that have ended")
    assert resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before < 3
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    assert reposed("prune", "--keep-days", "1", "--dry-run", data=daemon.data).stdout.startswith("5000 jobs")
    assert resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before < 1


def test_a_damaged_index_is_made_anew(ended):
    daemon, _ = ended
    change(daemon, "PRAGMA writable_schema=ON; UPDATE sqlite_schema SET sql=replace(sql,'(status, number)','(status, number DESC)')"
                   " WHERE name='job_by_status';")
    looked = reposed("check", data=daemon.data)
    assert looked.returncode == 1 and "the database is damaged" in looked.stdout
    assert reposed("check", "--repair", data=daemon.data).returncode == 0
    assert reposed("check", data=daemon.data).returncode == 0


def test_a_database_of_a_later_program_is_refused_and_stays_as_it_is(ended):
    daemon, _ = ended
    change(daemon, "PRAGMA wal_checkpoint(TRUNCATE); PRAGMA user_version=9999;")
    before = contents(daemon.data)["reposed.sqlite"]
    for command in (("serve", "--port", "0", "--worker", str(FAKE_WORKER)), ("check",), ("check", "--repair")):
        refused = reposed(*command, data=daemon.data)
        assert refused.returncode == 1 and ("9999" in refused.stderr or "another version" in refused.stderr)
    assert contents(daemon.data)["reposed.sqlite"] == before


@pytest.mark.parametrize("command", [("backup", "copy"), ("check",), ("check", "--repair")])
def test_a_folder_without_data_is_no_data_folder(tmp_path, command):
    refused = subprocess.run([BUILD.absolute() / "reposed", *command, "--data", tmp_path / "nothing"], capture_output=True, text=True, cwd=tmp_path)
    assert refused.returncode == 1 and "No such file" in refused.stderr or "unable to open" in refused.stderr
    assert not (tmp_path / "nothing").exists() and not (tmp_path / "copy").exists()


# --- what is not to be kept ---

def age(daemon, job, days):
    """As if it had ended so many days ago."""
    then = time.strftime("%Y-%m-%dT%H:%M:%S.000Z", time.gmtime(time.time() - 86400 * days))
    change(daemon, f"UPDATE job SET finished='{then}' WHERE id='{job}'")


def folder_bytes(daemon):
    return sum(path.stat().st_size for path in (daemon.data / "jobs").rglob("*") if path.is_file())


def test_old_jobs_go_pinned_and_young_ones_stay(fake):
    old, pinned, young = (fake.submit(angle=number) for number in (1, 2, 3))
    for job in (old, pinned, young):
        fake.ended(job)
    assert "pinned" not in fake.job(pinned)
    assert requests.post(f"{fake.url}/jobs/{pinned}/pin", timeout=30).json()["pinned"] is True and fake.job(pinned)["pinned"] is True
    assert requests.post(f"{fake.url}/jobs/{old}/pin", timeout=30).json()["pinned"] is True
    assert "pinned" not in requests.post(f"{fake.url}/jobs/{old}/unpin", timeout=30).json()
    fake.stop()
    for job, days in ((old, 8), (pinned, 8), (young, 6)):
        age(fake, job, days)
    before = contents(fake.data / "jobs")
    told = reposed("prune", "--keep-days", "7", "--dry-run", data=fake.data)
    assert told.returncode == 0 and told.stdout.startswith("1 jobs") and contents(fake.data / "jobs") == before
    fake.options += ["--keep-days", "7"]  # by itself
    fake.start()
    end = time.monotonic() + 20
    while fake.get(f"/jobs/{old}").status_code == 200 or (fake.data / "jobs" / old).exists():
        assert time.monotonic() < end, fake.log()
        time.sleep(0.05)
    assert fake.job(pinned)["status"] == fake.job(young)["status"] == "successful"
    assert f"job {old}: deleted to make room" in fake.log()
    assert "reposed_pruned_jobs_total 1\n" in fake.get("/metrics").text


def test_snapshots_go_before_results_the_oldest_first(ended):
    daemon, (one, two) = ended
    with_all = folder_bytes(daemon)
    results = (daemon.data / f"jobs/{one}/result.json").read_bytes()
    assert reposed("prune", "--keep-bytes", "1T", data=daemon.data).returncode == 0 and folder_bytes(daemon) == with_all
    # The option does not go as low as these runs are small.
    ballast = daemon.data / f"jobs/{two}/snapshots/ballast"
    ballast.write_bytes(b"x" * 3_000_000)
    taken = sum(512 * path.stat().st_blocks for path in (daemon.data / "jobs").rglob("*"))
    done = reposed("prune", "--keep-bytes", str(taken - 50_000), data=daemon.data)
    assert done.returncode == 0 and "snapshots of 1 jobs removed" in done.stdout, done.stdout + done.stderr
    left = {path.name for path in (daemon.data / f"jobs/{one}").rglob("*") if path.is_file()}
    assert "fields.hdf" in left and "result.json" in left and not {"000000.hdf", "checkpoint.hdf"} & left
    assert (daemon.data / f"jobs/{one}/result.json").read_bytes() == results and ballast.exists()
    assert reposed("check", data=daemon.data).returncode == 0
    ballast.unlink()
    (daemon.data / f"jobs/{two}/log.txt").write_bytes(b"x" * 3_000_000)
    done = reposed("prune", "--keep-bytes", "1M", data=daemon.data)
    assert done.stdout.startswith("2 jobs and 0 studies deleted, snapshots of 1 jobs removed"), done.stdout + done.stderr
    assert list((daemon.data / "jobs").iterdir()) == []


@pytest.mark.parametrize("options, says", [((), "say what is to be kept"), (("--keep-bytes", "12"), "must be a number in [1e+06, 1e+18]"),
                                           (("--keep-bytes", "9Q"), "must be"), (("--keep-days", "0"), "must be a whole number in [1, 100000]")])
def test_what_is_to_be_kept_must_be_said_plainly(tmp_path, options, says):
    refused = reposed("prune", *options, data=tmp_path)
    assert refused.returncode == 2 and says in refused.stderr


def test_results_that_were_damaged_in_the_database_are_sent_from_the_folder_and_mended(ended):
    """SQLite has no checksums: a changed digit, a row of its own accord."""
    daemon, (one, two) = ended
    right = {job: (daemon.data / "jobs" / job / "result.json").read_bytes() for job in (one, two)}
    change(daemon, "UPDATE result SET document=replace(document, '2', '3')")
    (daemon.data / "jobs" / two / "result.json").unlink()
    daemon.start()
    assert daemon.get(f"/jobs/{one}/results").content == right[one]
    assert daemon.get(f"/jobs/{two}/results").status_code == 503
    daemon.stop()
    told = reposed("check", data=daemon.data)
    assert told.returncode == 1 and told.stdout.count("its results in the database do not fit their checksum") == 2
    assert reposed("check", "--repair", data=daemon.data).returncode == 0
    daemon.start()
    assert daemon.get(f"/jobs/{one}/results").content == right[one]
    assert daemon.job(two)["status"] == "failed"  # to be tried again
    daemon.stop()
    with sqlite3.connect(daemon.data / "reposed.sqlite") as database:
        row, = database.execute("SELECT document FROM result")
    assert row[0].encode() == right[one]
