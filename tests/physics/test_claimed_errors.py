"""What a drum claims about its own angle: the standard error over many seeds, and that a bed which slumps has none."""
import json
import math
import os
import statistics
import subprocess
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
REPOSE = Path(os.environ.get("REPOSED_BUILD", ROOT / "build")) / "repose"


def run(folder, name, inputs):
    (folder / f"{name}.json").write_text(json.dumps({"inputs": inputs}))
    subprocess.run([REPOSE, "run", folder / f"{name}.json", "--out", folder / name], check=True, capture_output=True)
    return json.loads((folder / name / "result.json").read_text())


@pytest.mark.long
def test_the_error_claimed_is_the_scatter_over_fifty_seeds(tmp_path):
    """625 soft spheres, to be quick; each run ends when it claims 0.25 degrees. The angles of n independent runs scatter
    with (n - 1) s^2/sigma^2 of chi-square with 49 degrees of freedom, 27.25 to 78.23 in 99 of 100 cases; sigma^2 is the
    mean square of what was claimed, each known to a tenth or so."""
    def angle(seed):
        result = run(tmp_path, f"seed{seed}", {
            "drum": {"diameter": 0.1, "length": 0.03, "rotation_rate": 3.0}, "particles": [{"diameter": 0.006}],
            "contact": {"friction": 0.3, "restitution": 0.5, "maximum_overlap": 0.03}, "snapshots": {"interval": 0},
            "duration": {"until_standard_error_deg": 0.25, "at_most_revolutions": 8}, "seed": seed})
        repose = result["repose"]
        assert repose["steady"] and result["run"]["ended_by"] == "standard-error" and repose["standard_error_deg"] <= 0.25
        return repose["angle_deg"], repose["standard_error_deg"]

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        found = list(pool.map(angle, range(1, 51)))
    claimed = statistics.fmean(error ** 2 for _, error in found)
    chi_square = 49 * statistics.variance(mean for mean, _ in found) / claimed
    print(f"true scatter {statistics.stdev(mean for mean, _ in found):.3f}, claimed {math.sqrt(claimed):.3f} degrees")
    assert 27.25 < chi_square < 78.23


@pytest.mark.long
def test_a_bed_that_swings_as_a_block_is_never_steady_and_its_period_is_a_pendulums(tmp_path):
    """The paper's drum at a friction of 0.02. A half disc that slides without friction swings about the axis with
    2 pi sqrt(I/(m g a)) = 2 pi sqrt(3 pi R/(8 g)), I = m R^2/2, a = 4 R/(3 pi); friction with the wall changes where it
    swings about, not how fast; that its particles flow a little, by less than a tenth."""
    result = run(tmp_path, "slumps", {
        "drum": {"diameter": 0.126, "length": 0.0189, "rotation_rate": math.pi / 2}, "particles": [{"diameter": 0.00378}],
        "contact": {"friction": 0.02}, "snapshots": {"interval": 0}, "seed": 1,
        "duration": {"until_standard_error_deg": 1.0, "at_most_revolutions": 1.25}})
    repose, slumps, drive = result["repose"], result["repose"]["slumps"], result["drive"]
    assert result["regime"]["name"] == "slumping"
    assert repose["steady"] is False and result["run"]["ended_by"] == "at-most-revolutions"
    period = 2 * math.pi * math.sqrt(3 * math.pi * 0.063 / (8 * 9.81))
    assert slumps["period"] == pytest.approx(period, rel=0.1)
    assert slumps["period_standard_error"] < 0.05 * period
    assert 5 <= slumps["count"] <= (repose["window"]["end"] - repose["window"]["start"]) / slumps["period"]
    assert slumps["stop_deg"] < repose["other_methods"]["center-of-mass"] < slumps["start_deg"]
    error = math.hypot(drive["torque_standard_error"], drive["weight_torque_standard_error"])
    assert abs(drive["torque"] - drive["weight_torque"]) < 3 * error
