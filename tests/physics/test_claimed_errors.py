"""What runs claim about their own numbers: standard errors over many seeds, and that a bed which slumps is not steady."""
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


def run(folder, name, inputs, process="drum"):
    (folder / f"{name}.json").write_text(json.dumps({"process": process, "inputs": inputs}))
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
@pytest.mark.parametrize("beds", [2, 4])
def test_the_error_that_beds_claim_together_is_the_scatter_over_other_seeds(tmp_path, beds):
    """The same drum; the windows of several beds are shorter than one alone would need. With 24 runs, 23 s^2/sigma^2 is
    chi-square with 23 degrees of freedom, 9.26 to 44.18 in 99 of 100 cases. A bed of a run is no bed of another."""
    def answer(seed):
        result = run(tmp_path, f"seed{seed}", {
            "drum": {"diameter": 0.1, "length": 0.03, "rotation_rate": 3.0}, "particles": [{"diameter": 0.006}],
            "contact": {"friction": 0.3, "restitution": 0.5, "maximum_overlap": 0.03}, "snapshots": {"interval": 0}, "beds": beds,
            "duration": {"until_standard_error_deg": 0.5, "at_most_revolutions": 8}, "seed": seed})
        repose = result["repose"]
        assert repose["steady"] and result["run"]["ended_by"] == "standard-error" and repose["standard_error_deg"] <= 0.5
        return repose["angle_deg"], repose["standard_error_deg"], {bed["seed"] for bed in repose["beds"]}

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        found = list(pool.map(answer, range(101, 125)))
    assert len(set.union(*(seeds for _, _, seeds in found))) == 24 * beds
    claimed = statistics.fmean(error ** 2 for _, error, _ in found)
    chi_square = 23 * statistics.variance(mean for mean, _, _ in found) / claimed
    print(f"{beds} beds: true scatter {statistics.stdev(mean for mean, _, _ in found):.3f}, claimed {math.sqrt(claimed):.3f} degrees")
    assert 9.26 < chi_square < 44.18


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
    assert slumps["size_deg"] <= repose["hysteresis_deg"] < 2 * slumps["size_deg"]
    error = math.hypot(drive["torque_standard_error"], drive["weight_torque_standard_error"])
    assert abs(drive["torque"] - drive["weight_torque"]) < 3 * error


# Eight beds of each kind, of the same but for the seed. With honest errors 7 s^2/sigma^2 is chi-square of 7 degrees of
# freedom, below 24.3 in 999 of 1000 cases (some fifty of them are looked at); an error that is half of the scatter gives 28.
SEEDS, LIMIT = range(1, 9), 24.3
OF_DRUM = {"angle", "center-of-mass", "chord", "theil-sen", "upper-chord", "lower-chord", "torque", "weight_torque"}
OF_FALLS = {"start", "stop", "size", "period"}


def small_bed(friction, rate, fill=0.5, **duration):
    return {"drum": {"diameter": 0.06, "length": 0.02, "rotation_rate": rate}, "particles": [{"diameter": 0.004}],
            "fill_fraction": fill, "contact": {"friction": friction, "maximum_overlap": 0.03, "restitution": 0.5},
            "duration": duration}


# what is made, which process, and what claims an error
KINDS = {
    "rolling": ("drum", small_bed(0.3, 3.0, revolutions=3), OF_DRUM),
    "rolling or slipping": ("drum", small_bed(0.3, 7.0, revolutions=8), OF_DRUM),
    "cascading": ("drum", small_bed(1.0, 14.0, fill=0.55, revolutions=4), OF_DRUM),
    "cataracting": ("drum", small_bed(0.8, 17.0, revolutions=8), OF_DRUM),
    "raining": ("drum", small_bed(0.3, 24.0, revolutions=10), {"torque", "weight_torque"}),  # a ring has no angle
    "centrifuging": ("drum", small_bed(0.3, 40.0, revolutions=16), {"torque", "weight_torque"}),
    "slipping": ("drum", small_bed(0.3, 16.0, revolutions=8), OF_DRUM),
    "avalanching": ("drum", small_bed(0.5, math.pi / 32, seconds=20), OF_DRUM | OF_FALLS),
    "slumping": ("drum", small_bed(0.02, math.pi / 2, seconds=5), {"center-of-mass", "torque", "weight_torque", "period"}),
    "heap": ("heap", {"tube": {"diameter": 0.03, "lift_speed": 0.04}, "plate": {"diameter": 0.06, "rim_height": 0.0015},
                      "particles": [{"diameter": 0.003}], "particle_count": 1000,
                      "contact": {"law": "hertz-mindlin", "friction": 0.2, "maximum_overlap": 0.03}}, {"angle"}),
    "fill": ("fill", {"cylinder": {"diameter": 0.04}, "stream": {"diameter": 0.012, "rate": 800, "impact_speed": 1.0},
                      "particles": [{"diameter": 0.003}], "particle_count": 900,
                      "contact": {"friction": 0.5, "maximum_overlap": 0.03}}, {"angle", "while filling"}),
}


def claims_of(result):
    """{name: (value, error)} of everything that may have an error."""
    repose, drive, slumps = result["repose"], result.get("drive", {}), result["repose"].get("slumps", {})
    found = {"angle": (repose["angle_deg"], repose["standard_error_deg"])}
    found |= {name: (value, repose["other_methods_standard_error_deg"][name]) for name, value in repose["other_methods"].items()}
    found |= {name: (slumps.get(f"{name}_deg"), slumps.get(f"{name}_standard_error_deg")) for name in ("start", "stop", "size")}
    found |= {"period": (slumps.get("period"), slumps.get("period_standard_error"))}
    found |= {name: (drive.get(name), drive.get(f"{name}_standard_error")) for name in ("torque", "weight_torque")}
    filling = repose.get("while_filling", {})
    return found | {"while filling": (filling.get("angle_deg"), filling.get("standard_error_deg"))}


@pytest.mark.minutes
@pytest.mark.parametrize("kind", KINDS)
def test_every_error_claimed_is_what_another_bed_shows(tmp_path, kind):
    process, inputs, claiming = KINDS[kind]

    def claims(seed):
        result = run(tmp_path, f"seed{seed}", {**inputs, "snapshots": {"interval": 0}, "seed": seed}, process)
        if process == "drum":
            assert result["regime"]["name"] in kind.split(" or ") and (result["regime"]["certain"] or " or " in kind)
            assert result["repose"]["verdict"] != "too-few"
        return claims_of(result)

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        found = list(pool.map(claims, SEEDS))
    assert {name for name in found[0] if any(one[name][1] is not None for one in found)} == claiming
    for name in claiming:
        known = [one[name] for one in found if one[name][1] is not None]
        assert len(known) >= 6, name
        claimed = statistics.fmean(error ** 2 for _, error in known)
        chi_square = (len(known) - 1) * statistics.variance(value for value, _ in known) / claimed
        print(f"{kind}, {name}: claimed {math.sqrt(claimed):.3g}, chi-square {chi_square:.1f}")
        assert chi_square < LIMIT, name


@pytest.mark.minutes
def test_a_bed_that_slips_claims_nothing_before_it_is_like_another_one(tmp_path):
    """Over forty seeds the first four revolutions of this bed scattered by 1.3 to 2 times what their series showed."""
    for seed in range(1, 5):
        result = run(tmp_path, f"seed{seed}", {**small_bed(0.3, 7.0, revolutions=4), "snapshots": {"interval": 0}, "seed": seed})
        repose, drive = result["repose"], result["drive"]
        assert repose["verdict"] == "too-short" and repose["steady"] is None and result["regime"]["certain"] is False
        errors = [repose["standard_error_deg"], drive["torque_standard_error"], *repose["other_methods_standard_error_deg"].values()]
        assert errors == [None] * len(errors)
        assert "8 revolutions" in "".join(warning["text"] for warning in result["run"]["warnings"])
