#!/usr/bin/python3 -SE
"""Stands in for `repose run SPEC --out DIR`: keeps the contract of the job folder and does what the spec's label
"fake" says, so that tests of the daemon can have any end of a worker at once."""
import base64
import json
import os
import signal
import struct
import sys
import time
from pathlib import Path

if sys.argv[1] == "plan":  # by the real one
    program = Path(os.environ.get("REPOSED_BUILD", Path(__file__).resolve().parents[2] / "build")).absolute() / "repose"
    os.execv(program, [program, *sys.argv[1:]])
if sys.argv[1] != "run":  # calibrate: nobody's speed
    sys.exit(0)
DOT = base64.b64decode("iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGOYCQAAmwCarS5ItAAAAABJRU5ErkJggg==")  # a picture
SPEC, FOLDER = Path(sys.argv[2]), Path(sys.argv[4])
CHECKPOINT = FOLDER / "checkpoint.hdf"
spec = json.loads(SPEC.read_text())
label = spec["label"]
what, seconds = label.get("fake", "quick"), float(label.get("seconds", 0))
stopped = False
START = int(sys.argv[sys.argv.index("--start") + 1]) if "--start" in sys.argv else 0
FENCE = FOLDER / f"fence.{START:06}"
if START:  # of a worker that others may be beside
    try:
        os.close(os.open(FENCE, os.O_CREAT | os.O_EXCL | os.O_WRONLY))
    except FileExistsError:
        sys.exit(7)
    FENCE.write_text("taken\n")


def tell(event, **facts):
    with open(FOLDER / "events.ndjson", "a") as events:
        events.write(json.dumps({"event": event, **facts}) + "\n")


def publish(path, text):
    path.with_suffix(path.suffix + ".tmp").write_text(text)
    os.rename(path.with_suffix(path.suffix + ".tmp"), path)


def stop(*_):
    global stopped
    stopped = True


def sample(number):
    tell("sample", number=number, step=100 * number, time=0.1 * number,
         values={"angle_deg": 20.0 + number, "wall_slip": None if number == 0 else 0.5})


def snapshot(number):
    (FOLDER / "snapshots").mkdir(exist_ok=True)
    frame = FOLDER / "snapshots" / f"{number:06}.bin"
    frame.with_suffix(".tmp").write_bytes(struct.pack("<8s2I2d8f", b"RPSFRM1", 0, 0, 0.1 * number, *[0] * 9))
    frame.with_suffix(".tmp").rename(frame)
    publish(FOLDER / "snapshots" / f"{number:06}.hdf", f"snapshot {number} " + "0123456789" * 10)
    tell("snapshot", number=number, step=100 * number, time=0.1 * number, file=f"{number:06}.hdf", bytes=111, particles=41)


def checkpoint(step):
    publish(CHECKPOINT, str(step))
    tell("checkpoint", step=100 * step, time=0.1 * step, attempt=int(sys.argv[6]))


taken = bytearray(int(label.get("megabytes", 0)) << 20)  # and written to, so that they count


def run():
    """Twenty steps in `seconds`, from the checkpoint on."""
    step = int(CHECKPOINT.read_text()) if CHECKPOINT.exists() else 0
    tell("start", attempt=int(sys.argv[6]), step=step, resumed=step > 0)
    while step < 20:
        told = FENCE.read_text() if START else ""
        if "leave" in told:
            sys.exit(7)
        if (stopped or "stop" in told) and what != "stubborn":
            checkpoint(step)
            sys.exit(3)
        sample(step)
        tell("progress", phase="rotating", step=step, time=0.1 * step, progress=5 * step, eta_seconds=seconds * (1 - step / 20),
             particle_steps_per_second=1e6)
        if step % 10 == 0:
            for name in ("picture.png", "picture-96.png"):
                (FOLDER / name).write_bytes(DOT)
            snapshot(step // 10)
            checkpoint(step)
        if what == "stumbles" and step % 4 == 3:  # always a little further
            checkpoint(step + 1)
            os.kill(os.getpid(), signal.SIGKILL)
        if what == "stuck" and step == 13:
            os.kill(os.getpid(), signal.SIGKILL)
        time.sleep(seconds / 20)
        step += 1


RESULT = {
    "repose": {"angle_deg": 23.5, "standard_error_deg": 0.3, "minimum_deg": 22, "maximum_deg": 25, "steady": True,
               "verdict": "steady", "drift_deg_per_revolution": 0.1, "drift_bound_deg_per_revolution": 0.4,
               "window": {"start": 1.0, "end": 5.0, "revolutions": 2.5, "correlation_times": 30.0}, "layers": 6.5, "method": "surface-fit", "other_methods": {"chord": 23.1},
               "interface_fluctuation": 1e-4, "slumps": {"count": 12, "period": 0.56, "start_deg": 13.5}, "hysteresis_deg": 15.5},
    "stages": [],
    "regime": {"name": "rolling", "certain": True, "omega2_outer": 0.07, "omega2_inner": 0.01, "predicted": {}, "evidence": {}},
    "segregation": {"radial_index": None, "axial_index": None, "lacey_index": None},
    "packing": {"solid_fraction": 0.59, "coordination_number": 4.4, "mean_overlap": 0.001, "overlap_99": 0.004},
    "drive": {"torque": 0.012, "torque_standard_error": 1e-4, "weight_torque": 0.0121, "weight_torque_standard_error": 1e-4,
              "torque_number": 0.2, "power": 0.019},
    "run": {"particles": 41, "steps": 2000, "time_step": 1e-4, "simulated_seconds": 0.4, "wall_seconds": 0.1,
            "particle_steps_per_second": 8.2e5, "maximum_overlap": 0.01, "threads": 1, "seed": 7},
}
OTHER_RESULTS = {
    "of too few": {"repose": {"angle_deg": None, "standard_error_deg": None, "minimum_deg": None, "maximum_deg": None, "steady": None,
                              "verdict": "too-few"},
                   "regime": {"name": None, "certain": None}},
    "of a moment": {"repose": {"standard_error_deg": None, "steady": None, "verdict": "too-short", "drift_deg_per_revolution": None,
                               "drift_bound_deg_per_revolution": 1440,
                               "window": {"start": 0, "end": 0.01, "revolutions": 0.0123, "correlation_times": 1.2}},
                    "regime": {"certain": False}, "run": {"simulated_seconds": 0.012, "ended_by": "duration"}},
}

if "angle" in label:  # a number of its own for each seed
    RESULT["repose"]["angle_deg"] = label["angle"] + (spec["inputs"]["seed"] * 7919 % 101) / 50
    RESULT["run"]["seed"] = spec["inputs"]["seed"]
if "fit" in label:  # what a material with these frictions would tell, and a number of its own for each seed
    inputs = spec["inputs"]
    slope = {"steep": 30, "flat": 0}[label["fit"]]
    RESULT["repose"]["angle_deg"] = 20 + slope * inputs["contact"]["friction"] + (inputs["seed"] % 101 - 50) / 250
    RESULT["repose"]["other_methods"]["chord"] = 15 + 40 * inputs["contact"]["rolling_friction"] + (inputs["seed"] % 103 - 51) / 250
    RESULT["run"]["seed"] = inputs["seed"]
if "verdicts" in label:  # one for each seed in turn
    verdicts = label["verdicts"].split()
    verdict = verdicts[spec["inputs"]["seed"] % len(verdicts)]
    RESULT["repose"].update(verdict=verdict, steady={"steady": True, "drifting": False}.get(verdict))
    RESULT["regime"]["certain"] = verdict in ("steady", "drifting")
if "warnings" in label:  # how many there are, likewise
    counts = label["warnings"].split()
    RESULT["run"]["warnings"] = [{"field": f"/run/fact_{k}", "text": f"is <b>odd</b> {k}"}
                                 for k in range(int(counts[spec["inputs"]["seed"] % len(counts)]))]
if "results" in label:  # those that have this name
    for output, members in OTHER_RESULTS[label["results"]].items():
        RESULT[output].update(members)

signal.signal(signal.SIGTERM, stop)
print("a word on standard error", file=sys.stderr, flush=True)
if what == "numerical":
    tell("failure", status="overlap-too-large", message="overlap of 0.7 radii at step 12 between particles 3 and 4",
         detail={"step": 12})
    sys.exit(4)
if what in ("fault", "disk", "machine"):
    sys.exit({"fault": 1, "disk": 5, "machine": 6}[what])
if what == "until there is room":  # somebody makes it
    sys.exit(0 if (FOLDER.parent / "room").exists() and publish(FOLDER / "result.json", json.dumps(RESULT)) is None else 5)
if what == "dies":
    os.kill(os.getpid(), signal.SIGKILL)
try:
    run()
    if what != "no result":
        text = "[1]" if what == "wrong result" else json.dumps(RESULT)
        if what == "seen late" and os.fork() == 0:  # as on another machine, whose files come here some time after
            time.sleep(6)
        elif what == "seen late":
            sys.exit(0)
        publish(FOLDER / "result.json", text)
except OSError:  # the disk is full
    sys.exit(5)
