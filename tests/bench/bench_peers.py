#!/usr/bin/env python3
"""bench_peers.py BUILD: the same bed of the paper's drum turned by us and by the peers that are installed (LAMMPS, LIGGGHTS),
one core each, in rounds that take turns. Prints a JSON line a peer and size; report.py keeps them."""
import json
import os
import pathlib
import re
import shutil
import statistics
import subprocess
import sys
import tempfile

PEERS = {"LAMMPS": ("lmp", "drum.lmp", 1), "LIGGGHTS": ("liggghts", "drum.lig", 2)}
COPIES = {"2300": 0, "3000": 1, "24000": 8}
ROUNDS, WINDOWS, WARM_STEPS = 5, 3, 500
WINDOW_SPHERE_STEPS = 4e6  # half a second of a peer's
CORE = max(os.sched_getaffinity(0))
HERE = pathlib.Path(__file__).resolve().parent


def one_core():
    os.sched_setaffinity(0, {CORE})
    os.environ["OMP_NUM_THREADS"] = "1"


def peer_speeds(program, script, bed, drum, steps, folder):
    """Sphere-steps/s of each window."""
    log = folder / "log"
    values = {"bed": bed, "k1": drum["k1"], "reduced_mass": drum["mass"] / 2, "dt": drum["dt"], "rate": drum["rate"],
              "skin": 0.1 * drum["diameter"], "warm": WARM_STEPS, "steps": steps, "windows": WINDOWS}
    command = [program, "-in", HERE / "peers" / script, "-log", log, "-screen", "none"]
    for name, value in values.items():
        command += ["-var", name, str(value)]
    done = subprocess.run(command, cwd=folder, preexec_fn=one_core, capture_output=True, text=True, timeout=600)
    loops = re.findall(r"Loop time of (\S+) on .* for (\d+) steps with (\d+) atoms", log.read_text() if log.exists() else "")
    if len(loops) != WINDOWS + 1 or any(int(atoms) != drum["spheres"] for *_, atoms in loops):
        sys.exit(f"{program} did not do its windows:\n{done.stdout[-2000:]}{done.stderr[-2000:]}{log.read_text()[-2000:]}")
    return [drum["spheres"] * int(count) / float(seconds) for seconds, count, _ in loops[1:]]


def spread(values):
    return {"minimum": min(values), "median": statistics.median(values), "maximum": max(values)}


def compare(build, size, peers, folder):
    bed = folder / f"bed{size}"
    ours = subprocess.Popen([f"{build}/tests/bench/bench_peers", str(COPIES[size]), bed], stdin=subprocess.PIPE,
                            stdout=subprocess.PIPE, text=True, preexec_fn=one_core)
    drum = json.loads(ours.stdout.readline())
    steps = max(50, round(WINDOW_SPHERE_STEPS / drum["spheres"]))

    def our_window():
        ours.stdin.write(f"{steps}\n")
        ours.stdin.flush()
        return drum["spheres"] * steps / float(ours.stdout.readline())

    our_window()
    speeds = {name: [] for name in peers}
    ratios = {name: [] for name in peers}
    for _ in range(ROUNDS):
        for name in peers:
            program, script, types = PEERS[name]
            before = [our_window() for _ in range(WINDOWS)]
            theirs = peer_speeds(program, script, f"{bed}.{types}", drum, steps, folder)
            after = [our_window() for _ in range(WINDOWS)]
            speeds[name] += theirs
            ratios[name].append(statistics.median(before + after) / statistics.median(theirs))
    ours.stdin.close()
    ours.wait()
    for name in peers:
        print(json.dumps({"peer": name, "spheres": drum["spheres"], "unit": "sphere-steps/s", **spread(speeds[name]),
                          "ratio": spread(ratios[name])}), flush=True)


def main():
    peers = [name for name, (program, *_) in PEERS.items() if shutil.which(program)]
    if not peers:
        sys.exit("neither lmp nor liggghts is installed")
    with tempfile.TemporaryDirectory() as folder:
        for size in sys.argv[2:] or COPIES:
            compare(pathlib.Path(sys.argv[1]).resolve(), size, peers, pathlib.Path(folder))


main()
