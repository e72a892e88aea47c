#!/usr/bin/python3 -SE
"""Stands in for sbatch, squeue, sacct and scancel, whichever name it is called by: one machine on which as many jobs run at once as
the file `nodes` says, and on which a minute of a time limit takes as many seconds as the file `minute` says. A job is a folder of
$FAKE_SLURM/jobs. Files of $FAKE_SLURM make it misbehave:
    down      no command is answered
    refuse    sbatch says what stands in it, and takes nothing
    lose      sbatch takes the job, and its answer is lost
    held      no job starts
Whoever writes a state into a job's file `end` kills the job so; VANISHED: one that waits is not known any more."""
import fcntl
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

HOME = Path(os.environ["FAKE_SLURM"])
JOBS = HOME / "jobs"


def word(name, otherwise=None):
    try:
        return (HOME / name).read_text().strip()
    except FileNotFoundError:
        return otherwise


def fail(text):
    print(text, file=sys.stderr)
    sys.exit(1)


def publish(path, text):
    path.with_suffix(".new").write_text(text)
    os.rename(path.with_suffix(".new"), path)


def jobs():
    return sorted((folder for folder in JOBS.iterdir() if (folder / "state").exists()), key=lambda folder: int(folder.name))


def state(folder):
    return (folder / "state").read_text()


def submit():
    if word("refuse") is not None:
        fail(f"sbatch: error: {word('refuse')}")
    options = dict(option[2:].split("=", 1) for option in sys.argv[1:] if "=" in option)
    with open(HOME / "lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        number = int(word("next", "101"))
        publish(HOME / "next", str(number + 1))
        folder = JOBS / str(number)
        folder.mkdir()
    (folder / "script").write_text(Path(sys.argv[-1]).read_text())
    (folder / "options").write_text(json.dumps(options))
    publish(folder / "state", "PENDING")
    if os.fork() == 0:  # the node
        os.setsid()
        null = os.open("/dev/null", os.O_RDWR)
        for descriptor in (0, 1, 2):
            os.dup2(null, descriptor)
        run(folder, options)
        os._exit(0)
    if word("lose") is not None:
        fail("sbatch: error: Batch job submission failed: Socket timed out on send/recv operation")
    print(number)


def may_start(folder):
    if word("held") is not None:
        return False
    with open(HOME / "lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        busy = sum(state(other) == "RUNNING" for other in jobs())
        first = next((other for other in jobs() if state(other) == "PENDING"), folder)
        if busy >= int(word("nodes", "2")) or first != folder:
            return False
        publish(folder / "state", "RUNNING")
        return True


def run(folder, options):
    while not may_start(folder):
        if (folder / "end").exists():
            how = (folder / "end").read_text()
            return (folder / "state").unlink() if how == "VANISHED" else publish(folder / "state", how)
        time.sleep(0.05)
    minute = float(word("minute", "60"))
    until = time.monotonic() + float(options["time"]) * minute
    script = subprocess.Popen(["sh", folder / "script"], start_new_session=True)
    warned = False
    while script.poll() is None:
        if (folder / "end").exists():
            how = (folder / "end").read_text()
            gone = how in ("NODE_FAIL", "BOOT_FAIL", "OUT_OF_MEMORY")
            os.killpg(script.pid, signal.SIGKILL if gone else signal.SIGTERM)
            time.sleep(0 if gone else 0.5)
            try:
                os.killpg(script.pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
            script.wait()
            return publish(folder / "state", how)
        if time.monotonic() > until - minute and not warned:
            warned = True
            os.kill(script.pid, signal.SIGTERM)
        if time.monotonic() > until:
            os.killpg(script.pid, signal.SIGKILL)
            script.wait()
            return publish(folder / "state", "TIMEOUT")
        time.sleep(0.02)
    publish(folder / "state", "FAILED" if script.returncode else "COMPLETED")


def show():
    for folder in jobs():
        name = json.loads((folder / "options").read_text())["job-name"]
        print(f"{folder.name}|{state(folder)}|{name}|{'Resources' if state(folder) == 'PENDING' else 'None'}")


if word("down") is not None:
    fail("slurm_load_jobs error: Unable to contact slurm controller (connect failure)")
JOBS.mkdir(parents=True, exist_ok=True)
what = os.path.basename(sys.argv[0])
with open(HOME / "calls", "a") as calls:
    calls.write(f"{what}\n")
if what == "sbatch":
    submit()
elif what == "squeue":
    show()
elif what == "scancel":
    (JOBS / sys.argv[1] / "end").write_text("CANCELLED")
else:
    fail("Slurm accounting storage is disabled")
