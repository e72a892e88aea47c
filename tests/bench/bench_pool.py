#!/usr/bin/env python3
"""bench_pool.py BUILD [ROUNDS]: do n jobs on n cores give n times the throughput of one? Runs one job alone, then as many as
there are cores, left to the scheduler and each kept on a core of its own, in rounds that take turns. Prints JSON lines:
throughput over that of one job, n at best."""
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

SPEC = {"inputs": {"drum": {"diameter": 0.126, "length": 0.0189, "rotation_rate": 1.5707963267948966},
                   "particles": [{"diameter": 0.00378}], "contact": {"friction": 0.1}, "duration": {"seconds": 0.15},
                   "snapshots": {"interval": 0.05}, "seed": 1}}
CORES = sorted(os.sched_getaffinity(0))


def seconds(repose, jobs, pinned, folder):
    """Wall time of so many jobs at once."""
    begin = time.monotonic()
    running = []
    for k in range(jobs):
        only = {CORES[k]} if pinned else set(CORES)
        running.append(subprocess.Popen([repose, "run", folder / "spec.json", "--out", folder / f"{begin}-{k}"],
                                        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                        preexec_fn=lambda only=only: os.sched_setaffinity(0, only)))
    if any(job.wait() != 0 for job in running):
        sys.exit("a job failed")
    return time.monotonic() - begin


def main():
    repose = pathlib.Path(sys.argv[1]).resolve() / "repose"
    rounds = int(sys.argv[2]) if len(sys.argv) > 2 else 7
    gain = {"left to the scheduler": [], "each on a core of its own": []}
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "spec.json").write_text(json.dumps(SPEC))
        seconds(repose, 1, False, folder)
        for _ in range(rounds):
            alone = seconds(repose, 1, True, folder)
            for how, pinned in (("left to the scheduler", False), ("each on a core of its own", True)):
                gain[how].append(len(CORES) * alone / seconds(repose, len(CORES), pinned, folder))
    for how, values in gain.items():
        print(json.dumps({"figure": f"{len(CORES)} jobs at once, {how}", "unit": "of one alone", "minimum": min(values),
                          "median": statistics.median(values), "maximum": max(values)}))


main()
