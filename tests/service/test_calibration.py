"""Estimates: from this machine's calibration, kept in the data folder, and from what finished runs took. Nothing here
depends on how fast the machine is."""
import json
import os
import signal
import sqlite3
import subprocess
import time

import pytest
from conftest import FAKE_WORKER, SPEC, Daemon, alone_at_measuring, ready_calibration
from worker_runs import REPOSE, SMALL

# What the seconds said may differ by: JSON texts of 15 digits, and sums in another order.
CLOSE = 1e-9


def repose(*arguments, folder=None, text=None, cache=""):
    """With no cache, so that a calibration is where it is said to be and nowhere else. One measures at a time: it is asked again."""
    for _ in range(200):
        done = subprocess.run([REPOSE, *map(str, arguments)], capture_output=True, text=True, timeout=120, input=text, cwd=folder,
                              env={**os.environ, "XDG_CACHE_HOME": str(cache), "HOME": ""})
        if "another process measures" not in done.stderr:
            break
        time.sleep(0.5)
    assert done.returncode == 0, done.stderr
    return done.stdout


def estimate(spec, data):
    return json.loads(repose("check", "-", "--data", data, text=json.dumps(spec)))["estimate"]


@pytest.fixture(scope="module")
def measured():
    """A calibration of this machine."""
    return json.loads(ready_calibration().read_text())


def keep(data, calibration, factor=1.0):
    """The calibration in a data folder, of a machine slower by the factor."""
    slower = json.loads(json.dumps(calibration))
    for costs in slower["nanoseconds_a_sphere_step"].values():
        for law in costs:
            costs[law] *= factor
    data.mkdir(parents=True, exist_ok=True)
    (data / "calibration.json").write_text(json.dumps(slower))


def test_a_calibration_is_made_once_and_again_for_another_machine_or_program(measured, tmp_path):
    data = tmp_path / "data"
    keep(data, measured)
    written = (data / "calibration.json").read_bytes()
    assert "as measured before" in repose("calibrate", "--data", data)
    assert (data / "calibration.json").read_bytes() == written
    keep(data, {**measured, "processor": "another"})
    with alone_at_measuring():
        assert "measured now" in repose("calibrate", "--data", data)
    assert json.loads((data / "calibration.json").read_text())["processor"] == measured["processor"]


def test_another_data_folder_of_the_same_user_takes_the_calibration_over(measured, tmp_path):
    keep(tmp_path / "cache" / "reposed", measured)
    assert "as measured before" in repose("calibrate", "--data", tmp_path / "data", cache=tmp_path / "cache")
    assert json.loads((tmp_path / "data" / "calibration.json").read_text()) == measured
    spec = json.dumps(SMALL)
    without = json.loads(repose("check", "-", text=spec, folder=tmp_path / "cache", cache=tmp_path / "cache"))["estimate"]
    assert without["wall_seconds"] == pytest.approx(estimate(SMALL, tmp_path / "data")["wall_seconds"], rel=CLOSE)


def test_check_says_what_the_calibration_in_the_data_folder_makes_of_it(measured, tmp_path):
    keep(tmp_path / "fast", measured)
    keep(tmp_path / "slow", measured, 10.0)
    fast, slow = estimate(SMALL, tmp_path / "fast"), estimate(SMALL, tmp_path / "slow")
    assert slow["wall_seconds"] == pytest.approx(10.0 * fast["wall_seconds"], rel=CLOSE)
    assert slow["steps"] == fast["steps"]


def test_check_finds_the_data_folder_that_the_daemon_has_by_default(measured, tmp_path):
    keep(tmp_path / "data", measured, 10.0)
    there = json.loads(repose("check", "-", text=json.dumps(SMALL), folder=tmp_path))["estimate"]
    assert there["wall_seconds"] == pytest.approx(estimate(SMALL, tmp_path / "data")["wall_seconds"], rel=CLOSE)


def test_no_more_threads_count_than_there_are_cores(measured, tmp_path):
    keep(tmp_path / "data", measured)
    cores = os.sysconf("SC_NPROCESSORS_ONLN")
    seconds = {}
    for threads in (1, cores, 256):
        spec = {"inputs": {**SMALL["inputs"], "threads": threads}}
        seconds[threads] = estimate(spec, tmp_path / "data")["wall_seconds"]
    assert seconds[256] == seconds[cores]
    assert seconds[1] / cores <= seconds[cores] <= seconds[1]


def posted(daemon):
    return daemon.post(SPEC).json()["estimate"]["wall_seconds"]


def test_the_daemon_estimates_from_the_calibration_and_from_finished_runs(measured, tmp_path):
    keep(tmp_path / "data", measured, 10.0)
    said = estimate({"inputs": SPEC}, tmp_path / "data")
    daemon = Daemon(tmp_path, worker=FAKE_WORKER, options=["--workers", "2"]).start()
    try:
        assert posted(daemon) == pytest.approx(said["wall_seconds"], rel=CLOSE)
        # Three runs that took 0.9, 1.5 and 20 times what was said: the median counts, the odd one does not.
        jobs = [daemon.submit() for _ in range(3)]
        for job in jobs:
            daemon.ended(job)
        daemon.stop()
        with sqlite3.connect(tmp_path / "data" / "reposed.sqlite") as database:
            database.execute("DELETE FROM run_result")
            for job, factor in zip(jobs, (0.9, 1.5, 20.0), strict=True):
                database.execute("INSERT INTO run_result(job,steps,wall_seconds) SELECT number,?,? FROM job WHERE id=?",
                                 (1e6, 1e6 * factor * said["wall_seconds"] / said["steps"], job))
        daemon.start()
        assert posted(daemon) == pytest.approx(1.5 * said["wall_seconds"], rel=1e-6)
    finally:
        if daemon.is_running():
            daemon.stop()


def test_the_daemon_has_its_machine_measured_in_the_background(tmp_path):
    """By a worker program that only says how it was called: what it measures is tested above."""
    program = tmp_path / "worker"
    program.write_text(f'#!/bin/sh\necho "$@" >> {tmp_path}/calls\n')
    program.chmod(0o700)
    daemon = Daemon(tmp_path, worker=program).start()
    try:
        calls = tmp_path / "calls"
        for _ in range(200):
            if calls.exists() and calls.read_text().endswith("\n"):
                break
            time.sleep(0.05)
        assert calls.read_text() == f"calibrate --data {tmp_path}/data\n"
        assert daemon.workers() == []
    finally:
        daemon.stop()


def test_the_other_tests_have_a_calibration_that_counts(tmp_path):
    """Without it each of their daemons would have the machine measured."""
    ready_calibration()
    assert "as measured before" in repose("calibrate", "--data", tmp_path / "data", cache=os.environ["XDG_CACHE_HOME"])


def is_there(process):
    try:
        return open(f"/proc/{process}/stat").read().rsplit(")", 1)[1].split()[0] != "Z"
    except (FileNotFoundError, ProcessLookupError):
        return False


def test_killed_daemons_leave_no_calibration_behind(tmp_path):
    """Five, each killed while its calibration runs, by a worker program whose calibration takes no processor time and ends
    only when it is made to."""
    program, calls = tmp_path / "worker", tmp_path / "calls"
    program.write_text(f'#!/bin/sh\necho $$ >> {calls}\nexec sleep 50\n')
    program.chmod(0o700)
    calls.touch()
    calibrations = []
    for number in range(1, 6):
        daemon = Daemon(tmp_path, worker=program).start()
        try:
            end = time.monotonic() + 30
            while calls.read_text().count("\n") < number:
                assert time.monotonic() < end
                time.sleep(0.02)
            calibrations = [int(line) for line in calls.read_text().split()]
            assert is_there(calibrations[-1])
        finally:
            daemon.stop(signal.SIGKILL)
    end = time.monotonic() + 20  # idle processes may wait for their end
    while any(map(is_there, calibrations)) and time.monotonic() < end:
        time.sleep(0.02)
    assert not any(map(is_there, calibrations))


def begin_calibration(data, **how):
    environment = {**os.environ, "XDG_CACHE_HOME": "", "HOME": ""}
    return subprocess.Popen([REPOSE, "calibrate", "--data", data], env=environment, text=True, stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, **how)


def processor_seconds(process):
    fields = open(f"/proc/{process.pid}/stat").read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def wait_for_processor_seconds(process, seconds):
    while processor_seconds(process) < seconds:
        assert process.poll() is None, process.stderr.read()
        time.sleep(0.01)


def test_of_two_that_measure_at_once_one_gives_up(tmp_path):
    with alone_at_measuring():
        first = begin_calibration(tmp_path / "first")
        try:
            wait_for_processor_seconds(first, 0.2)
            first.send_signal(signal.SIGSTOP)  # however fast the machine is
            second = begin_calibration(tmp_path / "second")
            _, said = second.communicate(timeout=60)
            assert second.returncode == 1 and "another process measures" in said
            assert not (tmp_path / "second" / "calibration.json").exists()
            first.kill()
            first.communicate()
            third = begin_calibration(tmp_path / "third")  # the lock has gone with its holder
            wait_for_processor_seconds(third, 0.2)
            third.kill()
            assert "another process measures" not in third.communicate()[1]
        finally:
            first.kill()


def test_a_calibration_that_gets_too_little_time_ends_in_time_with_what_it_has(measured, tmp_path):
    """Held up by a stop until three quarters of its time are over: as on a machine that does other things."""
    seconds = 12
    with alone_at_measuring():
        start = time.monotonic()
        held_up = begin_calibration(tmp_path, preexec_fn=lambda: signal.alarm(seconds))
        try:
            wait_for_processor_seconds(held_up, 0.7)
            held_up.send_signal(signal.SIGSTOP)
            time.sleep(max(0, start + 0.75 * seconds + 0.2 - time.monotonic()))
            held_up.send_signal(signal.SIGCONT)
            said, warned = held_up.communicate(timeout=60)
        finally:
            held_up.kill()
    assert held_up.returncode == 0 and "measured now" in said and "in part" in warned
    rough = json.loads((tmp_path / "calibration.json").read_text())
    for kind in ("spheres", "clusters"):
        for law, cost in measured["nanoseconds_a_sphere_step"][kind].items():
            assert 0.25 * cost < rough["nanoseconds_a_sphere_step"][kind][law] < 4.0 * cost
    assert rough["program"] != measured["program"]  # so that it is measured again
