"""The n-th call fails, for memory, files, folders and processes, in the daemon or in the worker: no job fails of it."""
import errno
import os
import random
import shutil
import subprocess
import time

import pytest
import requests
from conftest import BUILD, Daemon, compiled_shim
from worker_runs import REPOSE, write_spec

# Some hundredths of a second, and all parts of a run.
SHORT = {"inputs": {"drum": {"diameter": 0.03, "length": 0.0095, "rotation_rate": 3.0}, "particles": [{"diameter": 0.003}],
                    "particle_count": 20, "contact": {"friction": 0.3}, "duration": {"seconds": 0.005}, "seed": 1}}
DONE, DISK, MACHINE, NO_PROGRAM = 0, 5, 6, 127
# call, its error, and how many calls the worker and the daemon make of it at least
CALLS = [("malloc", errno.ENOMEM, 5000, 12000), ("open", errno.EMFILE, 60, 140), ("read", errno.EIO, 60, 400),
         ("write", errno.ENOSPC, 70, 150), ("fsync", errno.EIO, 12, 40), ("rename", errno.EIO, 6, 12),
         ("mkdir", errno.ENOSPC, 2, 10), ("fork", errno.EAGAIN, 0, 9)]


@pytest.fixture(scope="module")
def shim(tmp_path_factory):
    return compiled_shim("failing_calls", tmp_path_factory.mktemp("shim"))


def failing(shim, program, call, error, first, count):
    return {**os.environ, "LD_PRELOAD": str(shim), "FAILING_PROGRAM": program, "FAILING_CALL": call,
            "FAILING_FIRST": str(first), "FAILING_COUNT": str(count), "FAILING_ERROR": str(error)}


def end_of_worker(shim, folder, *how):
    shutil.rmtree(folder / "out", ignore_errors=True)
    command = [REPOSE, "run", write_spec(folder, SHORT), "--out", folder / "out"]
    return subprocess.run(command, env=failing(shim, "repose", *how), capture_output=True, text=True, timeout=60)


@pytest.mark.parametrize("first", [90, 150, 250, 700, 1800, 4200])
def test_a_worker_that_is_refused_memory_four_times_in_a_row_says_so_and_does_not_crash(shim, tmp_path, first):
    done = end_of_worker(shim, tmp_path, "malloc", errno.ENOMEM, first, 4)
    assert done.returncode in (DONE, DISK, MACHINE), done.stderr


def test_a_crash_that_is_not_for_want_of_memory_keeps_its_signal(tmp_path):
    spec = {"inputs": {**SHORT["inputs"], "duration": {"seconds": 100.0}}}
    worker = subprocess.Popen([REPOSE, "run", write_spec(tmp_path, spec), "--out", tmp_path / "out"], stderr=subprocess.DEVNULL,
                              stdout=subprocess.DEVNULL)
    while not (tmp_path / "out" / "events.ndjson").exists():
        assert worker.poll() is None
        time.sleep(0.02)
    worker.send_signal(11)
    assert worker.wait(10) == -11


@pytest.mark.torture
@pytest.mark.parametrize("count", [1, 4])
@pytest.mark.parametrize("call, error, calls, _", [row for row in CALLS if row[2] > 0])
def test_no_failing_call_makes_a_worker_blame_the_job(shim, tmp_path, call, error, calls, _, count):
    wrong = {}
    for first in range(1, calls + 1, max(1, calls // 100)):
        done = end_of_worker(shim, tmp_path, call, error, first, count)
        if done.returncode not in (DONE, DISK, MACHINE, NO_PROGRAM):
            wrong[first] = done.returncode, done.stderr[-300:]
    assert not wrong


def post(daemon):
    """The jobs that the daemon has acknowledged."""
    jobs = []
    for seed in range(3):
        try:
            answer = daemon.post({**SHORT["inputs"], "seed": seed})
            jobs += [answer.json()["jobID"]] if answer.status_code == 201 else []
        except requests.RequestException:
            pass
    return jobs


def ends_of_jobs(folder, monkeypatch, environment):
    """Posts jobs to a daemon in that environment, and looks at them with a sound one afterwards."""
    daemon, jobs = Daemon(folder, options=["--workers", "2"]), []
    with monkeypatch.context() as changed:
        for name, value in environment.items():
            changed.setenv(name, value)
        try:
            daemon.start()
        except AssertionError:  # a start may be refused; nothing is accepted then
            daemon.process.wait(10)
        else:
            jobs = post(daemon)
            time.sleep(1.0)
    if daemon.is_running():
        daemon.stop(seconds=30)
    daemon.start()
    try:
        return [daemon.ended(job)["status"] + ": " + daemon.job(job)["message"] for job in jobs]
    finally:
        daemon.stop()


def refusal_of_a_start(shim, folder, call, error, first):
    """What the daemon says on a new folder; None: it starts all the same."""
    folder.mkdir()
    port, said = folder / "port", folder / "said"
    command = [BUILD / "reposed", "serve", "--port", "0", "--port-file", port, "--data", folder / "data"]
    with said.open("w") as log:
        daemon = subprocess.Popen(command, env=failing(shim, "reposed", call, error, first, 1), stderr=log, stdout=subprocess.DEVNULL)
        while daemon.poll() is None and not port.exists():
            time.sleep(0.01)
    if daemon.poll() is None:
        daemon.terminate()
        daemon.wait(30)
        return None
    assert daemon.returncode == 1
    return said.read_text()


@pytest.mark.parametrize("call, error, first, words", [
    *(("write", errno.ENOSPC, first, ("make room on its disk",)) for first in (5, 12, 40, 116)),
    *(("fsync", errno.EIO, first, ("disk I/O error", "see to its disk")) for first in (5, 12))])
def test_a_start_that_is_refused_tells_the_file_the_reason_and_a_way_out(shim, tmp_path, call, error, first, words):
    said = refusal_of_a_start(shim, tmp_path / "new", call, error, first)
    assert all(word in said for word in (f"{tmp_path}/new/data/reposed.sqlite can't be used: ", *words)), said


@pytest.mark.torture
@pytest.mark.parametrize("program, call, error, calls",
                         [("reposed", call, error, of_daemon) for call, error, _, of_daemon in CALLS]
                         + [("repose", call, error, of_worker) for call, error, of_worker, _ in CALLS if of_worker > 0])
def test_no_failing_call_loses_or_fails_a_job(shim, tmp_path, monkeypatch, program, call, error, calls):
    choose = random.Random(1)
    wrong = {}
    for number in range(8):
        first, count = choose.randint(1, calls), choose.choice([1, 1, 1, 4])
        folder = tmp_path / str(number)
        folder.mkdir()
        ends = ends_of_jobs(folder, monkeypatch, failing(shim, program, call, error, first, count))
        if any(end != "successful: done" for end in ends):
            wrong[first, count] = ends
    assert not wrong
