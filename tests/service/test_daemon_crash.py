"""kill -9 of a worker or of the daemon in the middle of a job loses nothing."""
import contextlib
import fcntl
import http.client
import json
import os
import signal
import sqlite3
import subprocess
import threading
import time

import pytest
import requests

from conftest import BUILD, FAKE_WORKER, ROOT, SPEC, compiled_shim, run_daemon
from test_damage import line_of

# Long enough that a worker can be seen at work and killed: the first report of progress comes after a second.
LONG = SPEC | {"duration": {"seconds": 16.0}, "fill_fraction": 0.5, "snapshots": {"interval": 0.5}}


GOOD = json.dumps({"repose": {"angle_deg": 30.0}, "run": {"steps": 5}})


def leave_result(folder, text, made_from=None):
    """As a worker leaves it that made it from the folder's spec, or from another."""
    made_from = made_from or (folder / "spec.json").read_bytes()
    (folder / "result.json").write_text(text)
    (folder / "result.json.sum").write_bytes(line_of(text.encode()) + line_of(text.encode() + made_from))


def gone(process, seconds=5):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        try:
            state = open(f"/proc/{process}/stat").read().rsplit(")", 1)[1].split()[0]
        except FileNotFoundError:
            return True
        if state == "Z":
            return True
        time.sleep(0.02)
    return False


def running(daemon, job):
    return daemon.until(job, lambda info: info["status"] == "running" and info["progress"] > 0 and daemon.workers())


def under_way(daemon, job, seconds=30):
    """Until the real worker has told of some samples, which is well before a job as LONG ends and the daemon knows of them."""
    events, end = daemon.data / "jobs" / job / "events.ndjson", time.monotonic() + seconds
    while not events.exists() or events.read_bytes().count(b'"sample"') < 20:
        assert time.monotonic() < end, f"{daemon.job(job)}\n{daemon.log()}"
        time.sleep(0.02)


def test_a_killed_worker_is_started_again(fake):
    job = fake.submit(fake="slow", seconds="3")
    running(fake, job)
    os.kill(fake.workers()[0], signal.SIGKILL)
    info = fake.until(job, lambda info: info["attempt"] == 2)
    assert info["status"] in ("accepted", "running")
    assert fake.ended(job)["status"] == "successful"
    numbers = [sample["number"] for sample in fake.get(f"/jobs/{job}/samples").json()["samples"]]
    assert numbers == list(range(20))  # what both attempts wrote is there once


def test_three_deaths_are_enough(fake):
    job = fake.submit(fake="dies")
    info = fake.ended(job)
    assert info["status"] == "failed" and info["attempt"] == 3
    assert "signal 9" in info["message"] and "3 attempts in a row" in info["message"]


def test_deaths_that_each_come_after_a_newer_checkpoint_do_not_fail_a_job(fake):
    info = fake.ended(fake.submit(fake="stumbles"))
    assert info["status"] == "successful" and info["attempt"] == 6  # saved at 4, 8, 12, 16 and 20 of 20 steps, and died there


def test_deaths_at_the_same_place_fail_a_job_that_had_got_ahead_before(fake):
    info = fake.ended(fake.submit(fake="stuck"))
    assert info["status"] == "failed" and info["attempt"] == 4  # the first had come to a checkpoint
    assert "3 attempts in a row" in info["message"]


def test_a_job_outlives_any_number_of_daemons_although_it_comes_no_further(fake):
    job = fake.submit(fake="slow", seconds="3")
    events = fake.data / "jobs" / job / "events.ndjson"
    for death in range(4):
        fake.until(job, lambda info: info["status"] == "running" and events.exists()
                   and events.read_text().count('"event": "start"') == death + 1)
        fake.stop(signal.SIGKILL)
        fake.start()
        assert fake.job(job)["attempt"] == 1
    assert fake.ended(job)["status"] == "successful" and fake.job(job)["attempt"] == 1


def test_what_a_worker_wrote_last_is_in_the_tables_although_the_daemon_died(fake):
    job = fake.submit(fake="slow", seconds="30")
    running(fake, job)
    fake.stop(signal.SIGKILL)
    folder = fake.data / "jobs" / job
    with open(folder / "events.ndjson", "a") as events:
        events.write(json.dumps({"event": "sample", "number": 19, "step": 1900, "time": 1.9, "values": {"angle_deg": 39.0}}) + "\n")
    leave_result(folder, GOOD)
    fake.start()
    assert fake.job(job)["status"] == "successful"
    assert fake.get(f"/jobs/{job}/samples").json()["samples"][-1]["number"] == 19


def test_a_worker_that_says_nothing_is_told_of_and_can_be_dismissed_or_go_on(fake):
    held, left = [fake.submit(fake="slow", seconds="3") for _ in range(2)]
    running(fake, held), running(fake, left)
    for worker in fake.workers():
        os.kill(worker, signal.SIGSTOP)
    for job in (held, left):
        info = fake.until(job, lambda info: "no word from its worker" in info["message"], 40)
        assert info["status"] == "running" and "eta_seconds" not in info
    assert requests.delete(f"{fake.url}/jobs/{held}", timeout=30).status_code == 200
    end = time.monotonic() + 15
    while len(fake.workers()) > 1:  # SIGTERM does not reach it, SIGKILL does
        assert time.monotonic() < end
        time.sleep(0.1)
    os.kill(fake.workers()[0], signal.SIGCONT)
    assert fake.ended(left)["message"] == "done" and fake.job(left)["attempt"] == 1
    assert fake.job(held)["status"] == "dismissed"


def test_a_killed_daemon_takes_its_workers_along_and_its_successor_goes_on(fake):
    jobs = [fake.submit(fake="slow", seconds="3") for _ in range(3)]  # one more than there are workers
    running(fake, jobs[0])
    workers = fake.workers()
    fake.stop(signal.SIGKILL)
    assert all(gone(worker) for worker in workers)
    fake.start()
    infos = [fake.ended(job) for job in jobs]
    assert [info["status"] for info in infos] == ["successful"] * 3
    assert [info["attempt"] for info in infos] == [1, 1, 1]


@pytest.mark.parametrize("how", [signal.SIGTERM, signal.SIGINT, signal.SIGHUP, signal.SIGUSR1])
def test_a_stop_in_good_order_uses_up_no_attempt(fake, how):
    job = fake.submit(fake="slow", seconds="3")
    running(fake, job)
    workers = fake.workers()
    assert fake.stop(how) == 0
    assert all(gone(worker) for worker in workers)
    assert (fake.data / "jobs" / job / "checkpoint.hdf").exists()
    fake.start()
    info = fake.ended(job)
    assert info["status"] == "successful" and info["attempt"] == 1


def test_under_nohup_a_closed_terminal_stops_nothing(fake):
    fake.stop()
    options = ["--data", fake.data, *fake.options]
    with subprocess.Popen(["nohup", BUILD / "reposed", "serve", "--port", "0", *options], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as daemon:
        assert daemon.stdout.readline().startswith(b"listening")
        daemon.send_signal(signal.SIGHUP)
        with pytest.raises(subprocess.TimeoutExpired):
            daemon.wait(0.5)
        daemon.terminate()
        assert daemon.wait(10) == 0


def test_a_stop_ends_although_a_client_waits_and_a_worker_does_not_listen(fake):
    job = fake.submit(fake="stubborn", seconds="60")
    running(fake, job)
    waiting = http.client.HTTPConnection("127.0.0.1", fake.port, timeout=60)
    waiting.request("GET", f"/jobs/{job}?wait=60")
    time.sleep(0.3)
    fake.job(job)  # a later request has its answer: the daemon has the earlier one
    start = time.monotonic()
    assert fake.stop() == 0
    assert time.monotonic() - start < 9  # 5 s of grace for the worker
    assert json.loads(waiting.getresponse().read())["status"] in ("running", "accepted")


def test_a_stop_ends_well_whatever_is_asked_while_the_listening_socket_is_closed(tmp_path, monkeypatch):
    """Of the threads that answer and the one that leaves, each may find it in an epoll set that another has taken it out of."""
    monkeypatch.setenv("LD_PRELOAD", str(compiled_shim("late_epoll", tmp_path)))
    for fake in run_daemon(tmp_path, worker=FAKE_WORKER):
        clients = [http.client.HTTPConnection("127.0.0.1", fake.port, timeout=10) for _ in range(32)]
        fake.job(fake.submit(fake="slow", seconds="60"))  # its worker is to be stopped, too
        for client in clients:
            client.connect()
        fake.process.terminate()
        while fake.is_running():
            for client in clients:
                with contextlib.suppress(OSError, http.client.HTTPException):
                    client.request("GET", "/healthz")
                    client.getresponse().read()
        assert fake.process.returncode == 0, fake.log()


def test_a_result_written_just_before_the_daemon_died_counts(fake):
    job = fake.submit(fake="slow", seconds="30")
    running(fake, job)
    fake.stop(signal.SIGKILL)
    leave_result(fake.data / "jobs" / job, GOOD)
    fake.start()
    info = fake.job(job)
    assert info["status"] == "successful" and info["attempt"] == 1 and info["summary"]["angle_deg"] == 30.0


NO_RESULTS = [
    ("[1]", "own"), ("", "own"), ('{"run": {}, "repose": {"angle_deg": "steep"}}', "own"), (GOOD[:-5], "own"),
    (GOOD, "none"),  # another job's, or from before results told what they were made from
    (GOOD, "of an earlier program"),
    (GOOD, "of another job"),
]


def test_what_is_not_a_result_of_this_job_does_not_count(tmp_path):
    for fake in run_daemon(tmp_path, worker=FAKE_WORKER, options=["--workers", str(len(NO_RESULTS))]):
        jobs = [fake.submit(fake="slow", seconds="1") for _ in NO_RESULTS]
        for job in jobs:
            fake.until(job, lambda info: info["status"] == "running")
        fake.stop(signal.SIGKILL)
        for job, (text, seal) in zip(jobs, NO_RESULTS, strict=True):
            folder = fake.data / "jobs" / job
            other = (folder / "spec.json").read_bytes().replace(b'"friction": 0.3', b'"friction": 0.4')  # of the same seed
            leave_result(folder, text, other if seal == "of another job" else None)
            if seal == "of an earlier program":
                (folder / "result.json.sum").write_bytes(line_of(text.encode()))
            if seal == "none":
                (folder / "result.json.sum").unlink()
        fake.start()
        for job, case in zip(jobs, NO_RESULTS, strict=True):
            info = fake.ended(job)
            assert info["status"] == "successful" and info["attempt"] == 1, case
            assert info["summary"]["angle_deg"] == 23.5, case  # what its own worker makes of it


def test_unfinished_files_are_swept_at_start(fake):
    job = fake.submit()
    fake.ended(job)
    fake.stop(signal.SIGKILL)
    leftovers = [fake.data / "jobs" / job / "result.json.tmp", fake.data / "jobs" / job / "snapshots" / "000009.hdf.tmp"]
    for leftover in leftovers:
        leftover.write_text("half")
    fake.start()
    assert not any(leftover.exists() for leftover in leftovers)
    assert (fake.data / "jobs" / job / "result.json").exists()


def test_a_second_daemon_on_the_same_folder_is_refused(fake):
    command = [BUILD / "reposed", "serve", "--port", "0", "--data", fake.data]
    second = subprocess.run(command + fake.options, capture_output=True, text=True, timeout=10)
    assert second.returncode == 1 and "in use by another reposed" in second.stderr


def test_a_start_waits_for_what_a_killed_daemon_has_left_behind(fake):
    """Killed in the moment of a fork, it leaves a child that has its lock until it dies, too."""
    fake.stop(signal.SIGKILL)
    with open(fake.data / "lock") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        release = threading.Timer(0.5, fcntl.flock, (lock, fcntl.LOCK_UN))
        release.start()
        fake.start()
        release.join()
    assert fake.get("/healthz").status_code == 200


def test_a_newer_database_is_refused(fake):
    fake.stop()
    with sqlite3.connect(fake.data / "reposed.sqlite") as database:
        database.execute("PRAGMA user_version=99")
    command = [BUILD / "reposed", "serve", "--port", "0", "--data", fake.data]
    second = subprocess.run(command + fake.options, capture_output=True, text=True, timeout=10)
    assert second.returncode == 1 and "schema version 99" in second.stderr


@pytest.mark.parametrize("name", ["events.ndjson", "snapshots", "result.json"])
def test_no_symbolic_link_in_a_job_folder_is_followed(tmp_path, name):
    stranger, out = tmp_path / "stranger", tmp_path / "out"
    stranger.mkdir() if name == "snapshots" else stranger.write_text("untouched")
    out.mkdir()
    (out / name).symlink_to(stranger)
    (tmp_path / "spec.json").write_text(json.dumps({"process": "granule", "inputs": {"friction": 0.5}}))
    done = subprocess.run([BUILD / "repose", "run", tmp_path / "spec.json", "--out", out], capture_output=True, text=True, timeout=60)
    assert done.returncode == 5 and f"{name} in the job folder" in done.stderr
    assert list(stranger.iterdir()) == [] if name == "snapshots" else stranger.read_text() == "untouched"


def test_a_link_that_takes_the_place_of_the_snapshots_during_a_run_is_not_followed(tmp_path):
    stranger, out = tmp_path / "stranger", tmp_path / "out"
    stranger.mkdir()
    (tmp_path / "spec.json").write_text(json.dumps({"inputs": SPEC | {"duration": {"seconds": 40.0}, "snapshots": {"interval": 0.01}}}))
    command = [BUILD / "repose", "run", tmp_path / "spec.json", "--out", out]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as worker:
        while not (out / "snapshots" / "000000.hdf").exists():
            assert worker.poll() is None
            time.sleep(0.02)
        (out / "snapshots").rename(out / "kept")
        (out / "snapshots").symlink_to(stranger)
        _, said = worker.communicate(timeout=60)
    # The second message where a snapshot was being written at that very moment: what HDF5 says of it depends on how far it was.
    assert worker.returncode == 5 and ("no folder any more" in said or "can't write snapshots/" in said), said
    assert list(stranger.iterdir()) == []


def test_the_demo_and_make_clean_leave_a_folder_alone_that_a_daemon_has(tmp_path):
    data = tmp_path / "build" / "demo"
    data.mkdir(parents=True)
    with open(data / "lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        demo = subprocess.run(["sh", ROOT / "tests/demo.sh", tmp_path / "build"], capture_output=True, text=True, timeout=30)
        clean = subprocess.run(["make", "-C", ROOT, "clean", f"BUILD={tmp_path}/build"], capture_output=True, text=True, timeout=60)
        assert demo.returncode == 1 and "a daemon is at work on" in demo.stderr
        assert clean.returncode != 0 and "a daemon is at work on" in clean.stderr
        assert data.exists()
    assert subprocess.run(["make", "-C", ROOT, "clean", f"BUILD={tmp_path}/build"], capture_output=True, timeout=60).returncode == 0
    assert not data.exists()


# --- the same with the real worker ---

def test_results_of_workers_count_for_jobs_and_cases_of_studies_although_the_daemon_died(daemon):
    jobs = [daemon.submit(SPEC | {"threads": 64, "duration": {"seconds": 0.005}})]
    study = {"base": {"process": "granule", "inputs": {"friction": 0.5}}, "vary": {"/inputs/rotation_rate": [10, 12]}}
    assert requests.post(f"{daemon.url}/studies", json=study, timeout=30).status_code == 201
    jobs = [info["jobID"] for info in daemon.get("/jobs").json()["jobs"]]
    results = {job: daemon.ended(job) and daemon.get(f"/jobs/{job}/results").json() for job in jobs}
    daemon.stop(signal.SIGKILL)
    with sqlite3.connect(daemon.data / "reposed.sqlite") as database:  # as it was in the moment before the ends were recorded
        database.execute("UPDATE job SET status='running', finished=NULL")
        database.execute("DELETE FROM result")
    daemon.start()
    assert len(jobs) == 3 and all(daemon.job(job)["status"] == "successful" for job in jobs)
    assert {job: daemon.get(f"/jobs/{job}/results").json() for job in jobs} == results
    assert daemon.log().count("its result is there") == 3


WALL_CLOCK = {"wall_seconds", "particle_steps_per_second", "attempt", "attempts", "threads"}


def without_clocks(results):
    return {key: {name: value for name, value in part.items() if name not in WALL_CLOCK} if isinstance(part, dict) else part
            for key, part in results.items()}


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory):
    """Results of LONG from a run without a daemon."""
    folder = tmp_path_factory.mktemp("undisturbed")
    (folder / "spec.json").write_text(json.dumps({"inputs": LONG}))
    subprocess.run([BUILD / "repose", "run", folder / "spec.json", "--out", folder / "out"], check=True, timeout=300,
                   stdout=subprocess.DEVNULL)
    return json.loads((folder / "out" / "result.json").read_text())


def same_results(daemon, job, undisturbed):
    assert daemon.ended(job, 300)["status"] == "successful"
    assert without_clocks(daemon.get(f"/jobs/{job}/results").json()) == without_clocks(undisturbed)
    numbers = [sample["number"] for sample in daemon.get(f"/jobs/{job}/samples").json()["samples"]]
    assert numbers == list(range(len(numbers))) and len(numbers) > 100


def test_a_killed_real_worker_changes_no_number(daemon, undisturbed):
    job = daemon.submit(LONG)
    under_way(daemon, job)
    os.kill(daemon.workers()[0], signal.SIGKILL)
    assert daemon.until(job, lambda info: info["attempt"] == 2)
    same_results(daemon, job, undisturbed)


def test_a_killed_daemon_changes_no_number(daemon, undisturbed):
    job = daemon.submit(LONG)
    under_way(daemon, job)
    workers = daemon.workers()
    daemon.stop(signal.SIGKILL)
    assert all(gone(worker) for worker in workers)
    daemon.start()
    assert daemon.job(job)["attempt"] == 1
    same_results(daemon, job, undisturbed)


def test_a_stopped_daemon_goes_on_from_the_checkpoint(daemon, undisturbed):
    job = daemon.submit(LONG)
    under_way(daemon, job)
    assert daemon.stop() == 0
    assert (daemon.data / "jobs" / job / "checkpoint.hdf").exists()
    daemon.start()
    same_results(daemon, job, undisturbed)
    events = [json.loads(line) for line in (daemon.data / "jobs" / job / "events.ndjson").read_text().splitlines()]
    assert [event["resumed"] for event in events if event["event"] == "start"] == [False, True]
    assert daemon.job(job)["attempt"] == 1


def test_folders_of_jobs_that_were_never_added_go_at_the_next_start(fake):
    """A POST makes the folder, then the row; the daemon died in between. What holds more than a POST puts there stays."""
    job = fake.submit()
    fake.ended(job)
    fake.stop()
    empty, posted, foreign = (fake.data / "jobs" / f"20261130-120000-0000000{k}" for k in range(3))
    for folder in (empty, posted, foreign):
        folder.mkdir()
        if folder != empty:
            (folder / "spec.json").write_text("{}")
    (posted / "start.hdf").write_text("a bed")
    (foreign / "result.json").write_text("{}")
    fake.start()
    assert sorted(path.name for path in (fake.data / "jobs").iterdir()) == sorted([foreign.name, job])
    assert (foreign / "spec.json").exists() and fake.job(job)["status"] == "successful"
