"""A worker that is confined: what somebody who has got hold of it may still do, in every variant; and that a run which fails
because of its confinement is not a failed job."""
import ctypes
import errno
import os
import subprocess

import pytest
from conftest import SPEC, compiled_shim, run_daemon
from test_variants import HERE
from worker_runs import REPOSE, WALL_CLOCK, result, write_spec

SHORT = {"inputs": {"drum": {"diameter": 0.03, "length": 0.0095, "rotation_rate": 3.0}, "particles": [{"diameter": 0.003}],
                    "particle_count": 20, "contact": {"friction": 0.3}, "duration": {"seconds": 0.005}, "seed": 1}}
MACHINE = 6
SYS_SOCKET = 41
# Which part of the confinement forbids what, and by which errors.
BY_CALLS = ["socket", "unix socket", "execve", "execveat", "fork", "ptrace", "signal to another", "symlink", "chmod",
            "memory to execute", "higher limits", "not to die with the daemon", "io_uring", "open_by_handle_at"]
BY_FILES = ["read outside", "list the folder above", "write outside", "list outside", "link from outside", "link to outside",
            "truncate outside"]


def landlock_version():
    """Of the running kernel; 0: it has none."""
    return max(0, ctypes.CDLL(None, use_errno=True).syscall(444, None, 0, 1))


@pytest.fixture(scope="module")
def shim(tmp_path_factory):
    return compiled_shim("escape_attempts", tmp_path_factory.mktemp("shim"))


def run(shim, folder, *options, spec=SHORT, name="job", **environment):
    (folder / "secret").write_text("not the job's\n")
    command = [REPOSE, "run", write_spec(folder, spec), "--out", folder / name, *options]
    done = subprocess.run(command, env={**os.environ, "LD_PRELOAD": str(shim), **environment}, capture_output=True, text=True,
                          timeout=60)
    return done.returncode, done.stderr


def attempts(folder):
    lines = (folder / "attempts.txt").read_text().splitlines()
    return {name: int(error) for name, error in (line.rsplit(" ", 1) for line in lines)}


def assert_nothing_was_possible(tried, folder):
    assert tried["own file"] == 0
    assert [name for name in BY_CALLS if tried[name] not in (errno.ENOSYS, errno.EPERM)] == []
    assert (folder / "secret").read_text() == "not the job's\n"
    if landlock_version() < 3:  # which forbids to cut a file short
        pytest.skip(f"the rest needs Landlock 3, and this kernel has {landlock_version()}")
    assert [name for name in BY_FILES if tried[name] not in (errno.EACCES, errno.EXDEV)] == []
    assert sorted(p.name for p in folder.iterdir() if p.name in ("new", "link")) == []


def test_without_confinement_the_same_attempts_succeed(shim, tmp_path):
    """Which shows that they are attempts; only those that no process may make at all fail here, too."""
    code, errors = run(shim, tmp_path, ESCAPE_OUTSIDE=str(tmp_path))
    assert code == 0 and "confinement" not in errors
    tried = attempts(tmp_path / "job")
    possible = [name for name, error in tried.items() if error == 0]
    assert set(possible) >= {"socket", "unix socket", "fork", "signal to another", "symlink", "chmod", "memory to execute",
                             "not to die with the daemon", *BY_FILES} - {"link from outside"}
    assert tried["execve"] == errno.ENOENT
    assert (tmp_path / "secret").read_text() == "not"


@pytest.mark.parametrize("precision, isa", [("single", isa) for isa in HERE] + [("double", HERE[0]), ("double", "plain")])
def test_a_confined_worker_reaches_nothing_but_its_folder(shim, tmp_path, precision, isa):
    spec = {"inputs": {**SHORT["inputs"], "precision": precision}}
    code, errors = run(shim, tmp_path, "--confine", "--isa", isa, spec=spec, ESCAPE_OUTSIDE=str(tmp_path))
    assert code == 0, errors
    assert result(tmp_path / "job")["run"]["isa"] == isa and result(tmp_path / "job")["run"]["precision"] == precision
    assert_nothing_was_possible(attempts(tmp_path / "job"), tmp_path)


def test_confinement_changes_no_result(shim, tmp_path):
    for name, options in (("free", []), ("confined", ["--confine"])):
        assert run(shim, tmp_path, *options, "--threads", "2", "--profile", name=name)[0] == 0
    free, confined = result(tmp_path / "free"), result(tmp_path / "confined")
    for document in (free, confined):
        document["run"] = {k: v for k, v in document["run"].items() if k not in WALL_CLOCK}
    assert free == confined
    assert {p.name for p in (tmp_path / "free").iterdir()} == {p.name for p in (tmp_path / "confined").iterdir()}


@pytest.mark.parametrize("lacking, says", [("landlock", ["no Landlock", "those of a list"]), ("seccomp", ["no seccomp"]),
                                           ("landlock seccomp", ["no Landlock", "no seccomp"])])
def test_a_kernel_that_lacks_something_runs_it_and_the_log_says_what_does_not_hold(shim, tmp_path, lacking, says):
    code, errors = run(shim, tmp_path, "--confine", LACKING_KERNEL=lacking)
    assert code == 0, errors
    line = next(line for line in errors.splitlines() if "confinement: " in line)
    assert all(words in line for words in says), line


def test_a_bed_from_outside_the_folder_is_refused_with_the_reason(shim, tmp_path):
    if landlock_version() == 0:
        pytest.skip("this kernel has no Landlock")
    assert run(shim, tmp_path, name="first")[0] == 0
    spec = {"inputs": {**SHORT["inputs"], "start": {"file": str(tmp_path / "first" / "checkpoint.hdf")}}}
    command = [REPOSE, "run", write_spec(tmp_path, spec), "--out", tmp_path / "second", "--confine"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60)
    assert done.returncode == 2 and "Permission denied" in done.stdout


def test_a_run_that_fails_of_its_confinement_is_no_fault_of_the_job(shim, tmp_path):
    """A library that makes a call which nobody foresaw, and fails of it."""
    code, errors = run(shim, tmp_path, "--confine", ESCAPE_CALL=str(SYS_SOCKET))
    assert code == MACHINE
    assert "refused the system call socket" in errors.splitlines()[-1]


def test_the_workers_of_a_daemon_are_confined_and_a_refusal_fails_no_job(shim, tmp_path, monkeypatch):
    (tmp_path / "secret").write_text("not the job's\n")
    monkeypatch.setenv("LD_PRELOAD", str(shim))
    monkeypatch.setenv("ESCAPE_CALL", str(SYS_SOCKET))
    for daemon in run_daemon(tmp_path):
        job = daemon.submit()
        put_off = daemon.until(job, lambda status: "refused the system call socket" in (status.get("message") or ""))
        assert put_off["status"] == "accepted"
        daemon.stop()
        monkeypatch.delenv("ESCAPE_CALL")
        monkeypatch.setenv("ESCAPE_OUTSIDE", str(tmp_path))
        daemon.start()
        assert daemon.ended(job)["status"] == "successful"
        log = daemon.get(f"/jobs/{job}/log").text
        assert "the job folder alone (Landlock" in log or "this kernel has no Landlock" in log
        assert "memory " in log and "those of a list (seccomp)" in log
        assert_nothing_was_possible(attempts(daemon.data / "jobs" / job), tmp_path)


def test_an_operator_may_have_workers_run_unconfined(tmp_path):
    for daemon in run_daemon(tmp_path, options=["--confine", "no"]):
        job = daemon.submit({**SPEC, "duration": {"seconds": 0.05}})
        assert daemon.ended(job)["status"] == "successful"
        assert "confinement" not in daemon.get(f"/jobs/{job}/log").text
