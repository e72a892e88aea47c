"""Starting `repose` on small specs, and reading what it leaves in a job folder."""
import copy
import json
import os
import pathlib
import subprocess
import time

REPOSE = os.environ.get("REPOSE", str(pathlib.Path(__file__).resolve().parents[2] / "build" / "repose"))

# Some 180 soft particles: a second, with every part of a run in it.
SMALL = {
    "inputs": {
        "drum": {"diameter": 0.03, "length": 0.01, "rotation_rate": 6.0},
        "particles": [{"diameter": 0.003}],
        "contact": {"maximum_overlap": 0.03},
        "duration": {"revolutions": 2.0},
        "snapshots": {"interval": 0.1},
        "seed": 7,
    },
    "label": {"project": "worker tests"},
}

# Of a run, what depends on the clock or on how often it was interrupted.
WALL_CLOCK = ("wall_seconds", "particle_steps_per_second", "attempt")


def small(**changes):
    """SMALL with other inputs: small(seed=8, duration={"seconds": 0.1})."""
    spec = copy.deepcopy(SMALL)
    for name, value in changes.items():
        if isinstance(value, dict) and isinstance(spec["inputs"].get(name), dict) and name != "duration":
            spec["inputs"][name].update(value)
        else:
            spec["inputs"][name] = value
    return spec


def write_spec(folder, spec, name="request.json"):
    path = pathlib.Path(folder) / name
    path.write_text(json.dumps(spec))
    return path


def start(spec_path, out, *options, **popen):
    return subprocess.Popen([REPOSE, "run", str(spec_path), "--out", str(out), *map(str, options)],
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **popen)


def run(spec_path, out, *options, **popen):
    """Runs to the end; returns (exit code, stdout, stderr)."""
    process = start(spec_path, out, *options, **popen)
    stdout, stderr = process.communicate(timeout=120)
    return process.returncode, stdout, stderr


def events(out, kind=None):
    path = pathlib.Path(out) / "events.ndjson"
    lines = path.read_text().split("\n")[:-1] if path.exists() else []
    found = [json.loads(line) for line in lines]
    return [event for event in found if kind in (None, event["event"])]


def wait_until(condition, seconds=60):
    """Waits for condition() to be true; fails the test when it never is."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if condition():
            return
        time.sleep(0.01)
    raise AssertionError("waited %g s in vain" % seconds)


def result(out):
    return json.loads((pathlib.Path(out) / "result.json").read_text())


def timeless_result(out):
    document = result(out)
    for name in WALL_CLOCK:
        del document["run"][name]
    return document


def samples(out):
    """By number; of repeated ones the later."""
    return {event["number"]: (event["step"], event["values"]) for event in events(out, "sample")}


def snapshot_bytes(out):
    return {path.name: path.read_bytes() for path in sorted((pathlib.Path(out) / "snapshots").iterdir())}
