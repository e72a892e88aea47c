"""Calibrations of materials whose parameters are known: how often the answer's regions hold them."""
import json
import math
import random
import resource
import statistics
import subprocess
import sys
from pathlib import Path

import pytest

SECTION = "Calibrations"
sys.path.append(str(Path(__file__).parents[1] / "service"))
from plan_loop import FRICTION, REPOSE, ROLLING, calibrate, made_up, request_of  # noqa: E402


@pytest.mark.minutes
def test_regions_hold_the_truth_as_often_as_they_say(record):
    dice = random.Random(5)
    tests = [lambda m, r: 18 + 22 * math.sqrt(m) + 12 * r, lambda m, r: 24 + 6 * m + 30 * r / (0.2 + r)]
    held = {"68": 0, "95": 0}
    for _ in range(24):
        truth = dice.uniform(0.15, 0.9), dice.uniform(0.05, 0.45)
        values = [test(*truth) + dice.gauss(0, 0.6) for test in tests]
        request = request_of(values, stop={"jobs": 60}, seed=dice.randrange(2 ** 50))
        answer, _, _ = calibrate(request, made_up(tests))
        for region in held:
            for name, value in zip((FRICTION, ROLLING), truth):
                low, high = answer["credible"][name][region]
                held[region] += low <= value <= high
    record.between("24 made-up materials, two parameters each: truths of 48 in the 68 % regions", held["68"], 23, 42,
                   "68 % are 33, give or take 20 in 100")
    record.between("the same in the 95 % regions", held["95"], 41, 48, "95 % are 46; 17 of 20 are 41")


# Two drums and a heap of soft spheres, each a second or two of processor time.
DRUM = {"drum": {"diameter": 0.05, "length": 0.012, "rotation_rate": 1.5}, "particles": [{"diameter": 0.004}],
        "contact": {"maximum_overlap": 0.04}, "duration": {"seconds": 2.5}}
REAL = [{"process": "drum", "inputs": {}, "result": "/repose/angle_deg"},
        {"process": "drum", "inputs": {"drum": {"rotation_rate": 6.0}}, "result": "/repose/angle_deg"},
        {"process": "heap", "inputs": {"tube": {"diameter": 0.03, "lift_speed": 0.02}, "plate": {"diameter": 0.05, "rim_height": 0.0015},
                                       "particle_count": 300}, "result": "/repose/angle_deg"}]


def run_for_real(folder):
    def run(case):
        done = subprocess.run([str(REPOSE), "run", "-", "--out", str(folder / str(case["number"])), "--json"],
                              input=json.dumps(case["request"]), capture_output=True, text=True, timeout=600)
        return json.loads(done.stdout) if done.returncode == 0 else None
    return run


@pytest.mark.long
def test_frictions_of_own_runs_are_found_again(record, tmp_path):
    truth, beds = (0.45, 0.12), 6
    request = {"name": "own runs", "base": {"process": "drum", "inputs": DRUM}, "seed": 3, "stop": {"jobs": 100},
               "parameters": {FRICTION: {"range": [0.1, 0.9]}, ROLLING: {"range": [0.0, 0.35]}}}
    known = [dict(test, value=0, standard_error=1) for test in REAL]
    plan = json.loads(subprocess.run([str(REPOSE), "plan", "-"], input=json.dumps({"request": request | {"targets": known}}),
                                     capture_output=True, text=True, check=True).stdout)
    run = run_for_real(tmp_path)
    for test, target in enumerate(known):
        job = next(case["request"] for case in plan["cases"] if case["test"] == test)
        job["inputs"]["contact"] |= {"friction": truth[0], "rolling_friction": truth[1]}
        angles = []
        for bed in range(beds):
            job["inputs"]["seed"] = 1000 * test + bed
            angles.append(run({"number": f"truth {test} {bed}", "request": job})["repose"]["angle_deg"])
        target["value"] = statistics.mean(angles)
        target["standard_error"] = max(statistics.stdev(angles) / math.sqrt(beds), 0.5)
    answer, runs, _ = calibrate(request | {"targets": known}, run, at_once=2)
    (tmp_path / "answer.json").write_text(json.dumps(answer, indent=1))
    for name, value in zip((FRICTION, ROLLING), truth):
        low, high = answer["credible"][name]["95"]
        record.between(f"{name[8:]} of own runs, {len(runs)} jobs, status {answer['status']}", value, low, high,
                       "the middle 95 % of the posterior hold the truth")
    z = [abs(result["z"]) for one in answer["family"] for result in one["results"]]
    record.between("verified sets: median of what the runs differ from the emulators by, in errors", statistics.median(z), 0.2, 1.2,
                   "0.67 of normal errors, of 15 give or take 0.5; the median, since a heap of 300 stands much steeper now and then")


@pytest.mark.minutes
def test_the_example_finds_its_frictions_again(record, tmp_path):
    """Its values are means over six drums and eight heaps of friction 0.6 and rolling friction 0.05."""
    request = json.loads((Path(__file__).parents[2] / "api/examples/calibration.json").read_text())
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    answer, runs, _ = calibrate(request, run_for_real(tmp_path), at_once=2)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    for name, value in ((FRICTION, 0.6), (ROLLING, 0.05)):
        low, high = answer["credible"][name]["95"]
        record.between(f"the example's {name[8:]}, {len(runs)} jobs, status {answer['status']}", value, low, high,
                       "the middle 95 % of the posterior hold the truth")
    record.between("the example's runs and plans: processor time in s",
                   after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, 1, 600, "5 minutes on 2 cores")
