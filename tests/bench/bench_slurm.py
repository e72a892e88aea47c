#!/usr/bin/python3
"""A daemon over a cluster of a thousand nodes that stands beside it: bench_slurm.py BUILD [JOBS [NODES [SECONDS]]].

The commands of Slurm are stood in for by this program under their names, whose one file says which jobs there are and when each
ends; a job is done by writing the fence and the result of its members, so that nothing is computed and what is measured is the
daemon. It prints a line of JSON: jobs a second that it recorded, its memory, and how often it asked in a minute."""
import fcntl
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SPEC = {"drum": {"diameter": 0.04, "length": 0.012, "rotation_rate": 6.0}, "particles": [{"diameter": 0.004}], "fill_fraction": 0.3,
        "contact": {"friction": 0.3, "maximum_overlap": 0.05}, "duration": {"seconds": 5.0}, "snapshots": {"interval": 1.0}, "seed": 1}


def command(name):
    """sbatch appends a line to `queue`; squeue prints `state`; both as quickly as a file can be read."""
    home = Path(os.environ["BENCH_SLURM"])
    with open(home / "calls", "a") as calls:
        calls.write(f"{name} {time.monotonic()}\n")
    if name == "sbatch":
        job_name = next(word.split("=", 1)[1] for word in sys.argv if word.startswith("--job-name="))
        with open(home / "queue", "a+") as queue:
            fcntl.flock(queue, fcntl.LOCK_EX)
            queue.seek(0)
            number = 1 + sum(1 for _ in queue)
            queue.write(f"{number} {job_name} {sys.argv[-1]}\n")
        print(number)
    elif name == "squeue":
        sys.stdout.write((home / "state").read_text())


class Cluster(threading.Thread):
    """Its nodes take what is in `queue`, in order, and end each after some seconds."""

    def __init__(self, home, data, result, nodes, seconds):
        super().__init__(daemon=True)
        self.home, self.data, self.nodes, self.seconds = home, data, nodes, seconds
        self.result, self.goes_on = result, True
        (home / "state").write_text("")
        (home / "queue").touch()

    def run(self):
        running, waiting, seen, ended = {}, [], 0, {}
        while self.goes_on:
            lines = (self.home / "queue").read_text().splitlines()
            waiting += [line.split() for line in lines[seen:]]
            seen = len(lines)
            now = time.monotonic()
            for number in [number for number, (until, *_) in running.items() if until < now]:
                _, name, script = running.pop(number)
                self.end(script)
                ended[number] = name
            while waiting and len(running) < self.nodes:
                number, name, script = waiting.pop(0)
                running[number] = (now + self.seconds, name, script)
            state = [f"{number}|RUNNING|{name}|None\n" for number, (_, name, _) in running.items()]
            state += [f"{number}|PENDING|{name}|Resources\n" for number, name, _ in waiting]
            state += [f"{number}|COMPLETED|{name}|None\n" for number, name in list(ended.items())[-2000:]]
            (self.home / "state.new").write_text("".join(state))
            (self.home / "state.new").rename(self.home / "state")
            time.sleep(0.2)

    def end(self, script):
        for line in Path(script).read_text().splitlines():
            if not (found := re.match(r"#: (\S+) (\d+)", line)):
                continue
            folder = self.data / "jobs" / found[1]
            shutil.copy(self.result, folder / "result.json")
            (folder / f"fence.{int(found[2]):06}").write_text("taken\nleft\nend 0\n")


def memory(process, what="VmRSS"):
    return int(re.search(rf"{what}:\s+(\d+)", Path(f"/proc/{process}/status").read_text())[1]) / 1024


def processor_seconds(process):
    fields = Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def a_result(build, folder):
    """Of a real run, whose numbers every job then has."""
    (folder / "spec.json").write_text(json.dumps({"process": "drum", "inputs": SPEC | {"duration": {"seconds": 0.05}}, "label": {}}))
    subprocess.run([build / "repose", "run", folder / "spec.json", "--out", folder / "one"], check=True, stdout=subprocess.DEVNULL)
    return folder / "one" / "result.json"


def measure(build, jobs, nodes, seconds, folder):
    import requests
    for name in ("sbatch", "squeue", "sacct", "scancel"):
        (folder / name).symlink_to(Path(__file__).resolve())
    environment = os.environ | {"BENCH_SLURM": str(folder), "PATH": f"{folder}:{os.environ['PATH']}"}
    cluster = Cluster(folder, folder / "data", a_result(build, folder), nodes, seconds)
    cluster.start()
    daemon = subprocess.Popen([build / "reposed", "serve", "--port", "0", "--data", folder / "data", "--executor", "slurm", "--slurm-queue",
                               str(2 * nodes), "--bundle-seconds", "60", "--queue-limit", "100000", "--worker", "/bin/true"],
                              env=environment, stdout=subprocess.PIPE, stderr=open(folder / "log", "w"), text=True)
    try:
        url = daemon.stdout.readline().split()[-1]
        idle, posted = memory(daemon.pid), time.monotonic()
        study = {"base": {"inputs": SPEC}, "repeats": 1000, "vary": {"/inputs/contact/friction": [0.1 + 0.01 * n for n in range(jobs // 1000)]}}
        answer = requests.post(f"{url}/studies", json=study, timeout=300)
        assert answer.status_code == 201, answer.text
        counted, most = {}, 0.0
        while counted.get("successful", 0) < jobs:
            time.sleep(1)
            counted = requests.get(answer.headers["Location"], timeout=60).json()["counts"]
            most = max(most, memory(daemon.pid))
            assert counted["failed"] == 0, counted
        took = time.monotonic() - posted
        calls = [line.split() for line in (folder / "calls").read_text().splitlines()]
        count = {name: sum(call[0] == name for call in calls) for name in ("sbatch", "squeue", "sacct", "scancel")}
        return {"jobs": jobs, "nodes": nodes, "seconds": round(took, 1), "jobs_a_second": round(jobs / took, 1),
                "idle_MB": round(idle, 1), "most_MB": round(most, 1), "calls": count,
                "squeue_a_minute": round(60 * count["squeue"] / took, 1),
                "processor_seconds_of_daemon": round(processor_seconds(daemon.pid), 1)}
    finally:
        cluster.goes_on = False
        daemon.kill()
        daemon.wait()


def main():
    build = Path(sys.argv[1]).resolve()
    jobs, nodes, seconds = [int(word) for word in [*sys.argv[2:], *("20000", "1000", "20")[len(sys.argv) - 2:]]]
    with tempfile.TemporaryDirectory() as folder:
        print(json.dumps(measure(build, jobs, nodes, seconds, Path(folder))))


if Path(sys.argv[0]).name in ("sbatch", "squeue", "sacct", "scancel"):
    command(Path(sys.argv[0]).name)
else:
    main()
