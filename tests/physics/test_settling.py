"""How long a bed takes to be made: what the estimate says before a run, against the runs."""
import json
import os
import subprocess
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
REPOSE = Path(os.environ.get("REPOSED_BUILD", ROOT / "build")) / "repose"

# diameter of the drum over that of its 4 mm particles, its length likewise, friction, and what is in it
SCENES = [
    (10, 5, 0.5, {"particle_count": 45}), (10, 3.2, 0.1, {"fill_fraction": 0.35}), (14, 3.2, 0.3, {"particle_count": 113}),
    (18, 3.2, 0.3, {"fill_fraction": 0.1}), (10, 8, 0.2, {"fill_fraction": 0.35}), (14, 8, 0.05, {"fill_fraction": 0.2}),
    (30, 4, 0.3, {"particle_count": 20}), (20, 6, 0.8, {"fill_fraction": 0.2}),
    (20, 10, 0.2, {"fill_fraction": 0.3, "particles": [{"shape": "tetrahedron", "diameter": 0.004}]}),
]
SEEDS = (1, 2, 3)


@pytest.mark.minutes
def test_beds_take_as_long_as_the_range_of_the_estimate_says(tmp_path):
    """The range is said to hold for 19 of 20 beds. Of 27 more than four are outside it in 1 of 100 cases; six of these are more
    than a fifth off the estimate. It is no wider than 1 to 4."""
    def took(scene, seed):
        across, along, friction, amount = scene
        inputs = {"drum": {"diameter": 0.004 * across, "length": 0.004 * along, "rotation_rate": 2},
                  "particles": [{"diameter": 0.004}], "contact": {"friction": friction, "maximum_overlap": 0.05, "restitution": 0.5},
                  "duration": {"seconds": 0.005}, "snapshots": {"interval": 0}, "seed": seed, **amount}
        spec = tmp_path / f"{SCENES.index(scene)}-{seed}.json"
        spec.write_text(json.dumps({"inputs": inputs}))
        said = json.loads(subprocess.run([REPOSE, "check", spec], check=True, capture_output=True).stdout)["estimate"]
        subprocess.run([REPOSE, "run", spec, "--out", spec.with_suffix("")], check=True, capture_output=True)
        run = json.loads((spec.with_suffix("") / "result.json").read_text())["run"]
        low, high = said["settling_seconds_low"], said["settling_seconds_high"]
        assert low < said["settling_seconds"] < high < 4 * low
        assert said["simulated_seconds"] == pytest.approx(0.005 + said["settling_seconds"])
        print(scene, seed, f"{run['settling_seconds']:.3f} s of {low:.3f} to {high:.3f}")
        return low <= run["settling_seconds"] <= high

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        held = list(pool.map(lambda one: took(*one), [(scene, seed) for scene in SCENES for seed in SEEDS]))
    assert held.count(False) <= 4
