"""A calibration without a daemon: asks `repose plan` for cases, has a model answer them, and asks again, until there is an answer."""
import json
import os
import pathlib
import random
import subprocess
from concurrent.futures import ThreadPoolExecutor

REPOSE = pathlib.Path(os.environ.get("REPOSED_BUILD", pathlib.Path(__file__).resolve().parents[2] / "build")).absolute() / "repose"
FRICTION = "/inputs/contact/friction"
ROLLING = "/inputs/contact/rolling_friction"


def plan(document, timeout=300):
    """What the planner prints, and its exit code."""
    done = subprocess.run([str(REPOSE), "plan", "-"], input=json.dumps(document), capture_output=True, text=True,
                          timeout=timeout)
    assert done.returncode in (0, 2), done.stderr
    return done.returncode, done.stdout


def run_of(case, results, status=None):
    """The case with what came of it, as the planner takes it back."""
    run = {name: case[name] for name in ("number", "stage", "test", "set", "parameters")}
    return run | {"status": status or ("failed" if results is None else "successful"), "results": results}


def calibrate(request, model, workers=2, most_rounds=400, at_once=1):
    """model(case) gives the results of a run, or None where it fails; at_once: how many of them. Returns the answer, the runs and what was printed last."""
    runs = []
    for _ in range(most_rounds):
        code, text = plan({"request": request, "runs": runs, "workers": workers})
        assert code == 0, text
        said = json.loads(text)
        if said["state"] == "done":
            return said["answer"], runs, text
        assert said["state"] == "runs" and said["cases"], said
        with ThreadPoolExecutor(at_once) as pool:
            runs += [run_of(case, results) for case, results in zip(said["cases"], pool.map(model, said["cases"]))]
    raise AssertionError("the planner does not come to an end")


def request_of(values, error=0.6, **more):
    """Two frictions of a drum, whose angle was measured at a rate for each value; no test is proposed."""
    targets = [{"name": f"drum {i}", "inputs": {"drum": {"rotation_rate": 1.0 + i}}, "result": "/repose/angle_deg", "value": value,
                "standard_error": error} for i, value in enumerate(values)]
    return {"base": {"process": "drum", "inputs": {"drum": {"diameter": 0.05, "length": 0.012, "rotation_rate": 1.0},
                                                   "particles": [{"diameter": 0.004}]}},
            "parameters": {FRICTION: {"range": [0.05, 1.0]}, ROLLING: {"range": [0.0, 0.5]}}, "targets": targets, "next_tests": [],
            "seed": 1} | more


def made_up(functions, scatter=0.3, own=0.2):
    """A model: the function of each test, with a scatter from bed to bed and an error of the run's own, both by the job's seed."""
    def run(case):
        dice = random.Random(case["request"]["inputs"]["seed"])
        angle = functions[case["test"]](case["parameters"][FRICTION], case["parameters"][ROLLING])
        angle += dice.gauss(0, scatter) + dice.gauss(0, own)
        return {"repose": {"angle_deg": angle, "standard_error_deg": own},
                "run": {"particles": 200, "steps": 100000, "wall_seconds": 5.0, "threads": 1}}
    return run
