"""Heaps below a raised tube and cylinders filled by a stream, from request to results."""
import copy
import json
import statistics
from pathlib import Path

import pytest
import requests

from worker_runs import run, start, timeless_result, samples, snapshot_bytes, write_spec, wait_until, events, result

ROOT = Path(__file__).resolve().parents[2]

# A few hundred soft spheres: a second or two each.
HEAP = {
    "tube": {"diameter": 0.02, "lift_speed": 0.05},
    "plate": {"diameter": 0.036},
    "particles": [{"diameter": 0.003}],
    "particle_count": 300,
    "contact": {"friction": 0.5, "restitution": 0.5, "maximum_overlap": 0.05},
    "snapshots": {"interval": 0.2},
    "seed": 1,
}
FILL = {
    "cylinder": {"diameter": 0.03},
    "stream": {"diameter": 0.012, "rate": 800, "impact_speed": 0.9},
    "particles": [{"diameter": 0.003}],
    "particle_count": 450,
    "contact": {"friction": 0.3, "restitution": 0.5, "maximum_overlap": 0.05},
    "snapshots": {"interval": 0.2},
    "seed": 1,
}
SPECS = {"heap": HEAP, "fill": FILL}


def changed(spec, **groups):
    """A copy with members of its groups, or whole inputs, replaced."""
    new = copy.deepcopy(spec)
    for name, value in groups.items():
        if isinstance(value, dict) and isinstance(new.get(name), dict):
            new[name].update(value)
        else:
            new[name] = value
    return new


def run_spec(folder, process, inputs):
    path = write_spec(folder, {"process": process, "inputs": inputs})
    code, out, err = run(path, folder / "job")
    assert code == 0, out + err
    return result(folder / "job")


def post(daemon, process, inputs):
    return requests.post(f"{daemon.url}/processes/{process}/execution", json={"inputs": inputs}, timeout=30)


@pytest.mark.parametrize("process", ["heap", "fill"])
def test_one_is_posted_run_and_answered(daemon, process):
    answer = post(daemon, process, SPECS[process])
    assert answer.status_code == 201, answer.text
    estimate = answer.json()["estimate"]
    assert estimate["particles"] == SPECS[process]["particle_count"] and 0 < estimate["wall_seconds"] < 60
    job = daemon.job(answer.json()["jobID"], wait=60)
    assert job["status"] == "successful" and job["progress"] == 100, job
    results = daemon.get(f"/jobs/{job['jobID']}/results").json()
    repose, where = results["repose"], results[process]
    assert 0 < repose["angle_deg"] < 45 and repose["minimum_deg"] <= repose["angle_deg"] <= repose["maximum_deg"]
    assert repose["azimuths"] == 16 and repose["standard_error_deg"] > 0
    assert repose["method"] == {"heap": "azimuthal-fit", "fill": "radial-fit"}[process]
    others = {"heap": {"apex-to-base", "equal-volume-cone", "silhouette"}, "fill": {"center-to-wall", "area-fit"}}[process]
    assert set(repose["other_methods"]) == set(repose["other_methods_standard_error_deg"]) == others
    assert where["at_rest"] and results["run"]["ended_by"] == "at-rest"
    # Nobody is forgotten.
    assert where["inside"] + where["apart"] + where.get("lost", 0) + where.get("waiting", 0) == SPECS[process]["particle_count"]
    profile = results["surface"]["profile"]
    assert len(profile["radius"]) == len(profile["height"]) == len(profile["standard_error"]) > 3
    assert results["surface"]["height"] > 0.003 and results["run"]["maximum_overlap"] < 0.1
    # What is described is what is there, and the other way round.
    described = daemon.get(f"/processes/{process}").json()
    assert set(described["outputs"]) == set(results)
    for output, members in results.items():
        properties = described["outputs"][output]["schema"]["properties"]
        assert set(properties) == set(members), output
    # Every input of the canonical spec is described; it can be posted again as it is.
    spec = daemon.get(f"/jobs/{job['jobID']}/spec").json()
    assert set(spec["inputs"]) <= set(described["inputs"])
    assert requests.post(f"{daemon.url}/processes/{process}/execution", json=spec, timeout=30).status_code == 201
    series = daemon.get(f"/jobs/{job['jobID']}/samples").json()["samples"]
    assert len(series) == results["run"]["samples"]
    assert series[-1]["values"]["angle_deg"] == pytest.approx(repose["angle_deg"], abs=1)
    assert len(daemon.get(f"/jobs/{job['jobID']}/snapshots").json()["snapshots"]) == results["run"]["snapshots"] >= 2


def test_sql_asks_for_angles_of_heaps_and_fills_by_friction(daemon):
    jobs = [post(daemon, process, SPECS[process]).json()["jobID"] for process in ("heap", "fill")]
    found = {}
    for job in jobs:
        assert daemon.ended(job)["status"] == "successful"
        found[daemon.job(job)["processID"]] = daemon.get(f"/jobs/{job}/results").json()
    for process, column in (("heap", "tube_diameter"), ("fill", "cylinder_diameter")):
        sql = f"select friction, angle_deg, height, {column}, solid_fraction from run_summary where process='{process}'"
        rows = daemon.get("/query", params={"sql": sql}).json()["rows"]
        inputs, results = SPECS[process], found[process]
        assert rows == [[inputs["contact"]["friction"], results["repose"]["angle_deg"], results["surface"]["height"],
                         inputs[column.split("_")[0]]["diameter"], results["packing"]["solid_fraction"]]]
    sql = "select lost, at_rest, lift_speed, rim_height from heap_result join heap_input using(job)"
    assert daemon.get("/query", params={"sql": sql}).json()["rows"] == [[found["heap"]["heap"]["lost"], 1, 0.05, 0.0015]]
    sql = "select waiting, rate, while_filling_angle_deg from fill_result join fill_input using(job) join repose_result using(job)"
    assert daemon.get("/query", params={"sql": sql}).json()["rows"] == [
        [0, 800, found["fill"]["repose"]["while_filling"]["angle_deg"]]]


@pytest.mark.parametrize("process", ["heap", "fill"])
def test_an_interrupted_run_ends_with_the_same_bits(tmp_path, process):
    spec = write_spec(tmp_path, {"process": process, "inputs": SPECS[process]})
    assert run(spec, tmp_path / "whole")[0] == 0
    phase = {"heap": "lifting", "fill": "filling"}[process]
    # The attempts stop as soon as the test itself is under way.
    first = start(spec, tmp_path / "parts", "--checkpoint-seconds", 0)
    wait_until(lambda: len(samples(tmp_path / "parts")) >= 3 or first.poll() is not None)
    first.terminate()
    first.communicate(timeout=60)
    assert first.returncode == 3
    assert run(spec, tmp_path / "parts", "--attempt", 2)[0] == 0
    assert events(tmp_path / "parts", "start")[-1]["resumed"]
    whole, parts = timeless_result(tmp_path / "whole"), timeless_result(tmp_path / "parts")
    assert whole == parts
    assert samples(tmp_path / "whole") == samples(tmp_path / "parts")
    assert snapshot_bytes(tmp_path / "whole") == snapshot_bytes(tmp_path / "parts")
    assert {event["phase"] for event in events(tmp_path / "parts", "progress")} <= {"growing", "settling", phase}


def heap_of_friction(folder, friction, seed=1, **changes):
    folder.mkdir()
    all_like_it = {"contact": {"friction": friction}, "plate": {"friction": friction}, "wall": {"friction": 0.2 * friction}}
    return run_spec(folder, "heap", changed(changed(HEAP, seed=seed, **all_like_it), **changes))


def test_a_heap_is_steeper_the_rougher(tmp_path):
    def mean_angle(friction):
        # of the four angles the one that a flat heap has, too
        heaps = [heap_of_friction(tmp_path / f"{friction}-{seed}", friction, seed) for seed in range(1, 5)]
        return statistics.mean(heap["repose"]["other_methods"]["equal-volume-cone"] for heap in heaps)

    # Over 24 heaps each these are 26.2 and 29.7 degrees, with deviations of 0.84 and 0.89: means of four differ by
    # 3.5 +- 0.6, and 1.7 is three of them away.
    assert mean_angle(1.0) > mean_angle(0.1) + 1.7


def test_without_friction_there_is_no_heap(tmp_path):
    # Spheres flow like water then: only a wide plate and some patience show it.
    found = heap_of_friction(
        tmp_path / "job", 0.0, plate={"diameter": 0.08, "rim_height": 0.004}, duration={"at_most_seconds": 1.5}
    )
    # One layer would be 3 mm high, on which others ride at most one sphere high.
    assert found["surface"]["height"] < 0.0062


def test_a_plate_without_a_rim_loses_particles_and_says_so(tmp_path):
    found = run_spec(tmp_path, "heap", changed(HEAP, plate={"rim_height": 0}))
    heap = found["heap"]
    assert heap["lost"] > 20 and heap["inside"] + heap["apart"] + heap["lost"] == 300


def test_a_filled_cylinder_is_packed_at_random(tmp_path):
    found = run_spec(tmp_path, "fill", changed(FILL, particle_count=900))
    # Between random loose and random close packing; the wall's layer is left out of the core.
    assert 0.55 < found["packing"]["solid_fraction"] < 0.645
    # Each sphere rests on three others at least: six contacts a particle without friction, four with very much.
    assert 4 < found["packing"]["coordination_number"] < 6.3
    profile = found["packing"]["profile"]
    assert len(profile["height"]) == len(profile["solid_fraction"]) and "standard_error" not in profile
    # All of the solid: the fractions summed over the slabs are the particles' volume over the section; radii are kept in
    # single precision, whose rounding, 6e-8, counts three times.
    slab = profile["height"][1] - profile["height"][0]
    assert sum(profile["solid_fraction"]) * slab == pytest.approx(900 * 0.003**3 * 2 / 3 / 0.03**2, rel=1.8e-7)


def test_species_and_clusters_are_filled_in_together(tmp_path):
    inputs = changed(FILL, particles=[{"diameter": 0.003, "share": 0.5}, {"shape": "tetrahedron", "diameter": 0.0015, "share": 0.5}],
                     particle_count=300)
    found = run_spec(tmp_path, "fill", inputs)
    assert found["run"]["particles"] == 300 and found["run"]["spheres"] == 150 + 600
    assert found["fill"]["inside"] == 300


def errors_of(daemon, process, inputs):
    answer = post(daemon, process, inputs)
    assert answer.status_code == 400, answer.text
    return {error["pointer"]: error["detail"] for error in answer.json()["errors"]}


def test_every_problem_of_a_heap_is_named_at_once(daemon):
    errors = errors_of(daemon, "heap", changed(
        HEAP, tube={"diameter": 0.012, "lift_speed": 0, "height": 0.01}, plate={"diameter": 0.013, "rim_height": 0.01},
        particle_count=50, cylinder={"diameter": 1}, drum={}))
    assert errors["/inputs/tube/diameter"] == "is 0.012 m; must be at least 0.015 m, 5 of the largest particle diameter"
    assert errors["/inputs/tube/lift_speed"] == "is 0 m/s; must be in (0, 10] m/s"
    assert "in which the particles don't fit; must be at least" in errors["/inputs/tube/height"]
    assert errors["/inputs/plate/diameter"] == "is 0.013 m; must be at least 0.018 m, the tube's diameter and two of the largest particle's"
    assert "a quarter of the plate's diameter" in errors["/inputs/plate/rim_height"]
    assert errors["/inputs/particle_count"] == "is 50; must be at least 100 here: fewer have no surface to measure"
    assert {"/inputs/cylinder", "/inputs/drum"} <= set(errors) and len(errors) == 8


def test_every_problem_of_a_fill_is_named_at_once(daemon):
    errors = errors_of(daemon, "fill", changed(
        FILL, cylinder={"height": 0.01}, stream={"diameter": 0.04, "rate": 1e6, "mass_rate": 1.0, "impact_speed": 0.1}))
    assert errors["/inputs/stream/diameter"] == "is 0.04 m; must be at most 0.03 m, the cylinder's diameter"
    assert "the speed of falling the" in errors["/inputs/stream/impact_speed"]
    assert errors["/inputs/stream/mass_rate"] == "is given beside rate; give one of the two"
    assert "but the particles need" in errors["/inputs/cylinder/height"]
    clogged = errors_of(daemon, "fill", changed(FILL, stream={"rate": 1e6}))
    most = float(clogged["/inputs/stream/rate"].split("at most ")[1].split(" 1/s")[0])
    assert "the inlet clogs" in clogged["/inputs/stream/rate"] and len(clogged) == 1
    # The rate that it names works.
    assert post(daemon, "fill", changed(FILL, stream={"rate": 0.999 * most})).status_code == 201
    assert "narrow" not in errors_of(daemon, "fill", changed(FILL, stream={"diameter": 0.002}))
    by_mass = errors_of(daemon, "fill", {key: value for key, value in changed(FILL, stream={"mass_rate": 10}).items() if key != "rate"}
                        | {"stream": {"diameter": 0.012, "mass_rate": 10, "impact_speed": 0.9}})
    assert "10 kg/s, at which the inlet clogs" in by_mass["/inputs/stream/mass_rate"]
    # Who gives no settling_seconds is not told to shorten them: the stream takes that long.
    slow = errors_of(daemon, "fill", changed(FILL, stream={"rate": 1e-6}))
    assert "steps of" in slow["/inputs/stream/rate"] and "/inputs/duration/settling_seconds" not in slow


def test_neither_takes_a_bed_to_start_from(daemon):
    for process in ("heap", "fill"):
        for bed in ({"job": "20260101-000000-00000000"}, {"particles": [{"position": [0, 0, 0.01]}]}):
            errors = errors_of(daemon, process, changed(SPECS[process], start=bed))
            assert list(errors) == ["/inputs/start"] and errors["/inputs/start"].startswith("is not an input; available here: ")


def test_the_examples_are_complete_specifications(daemon):
    for process in ("heap", "fill"):
        example = json.loads((ROOT / f"api/examples/{process}.json").read_text())
        answer = requests.post(f"{daemon.url}/processes/{process}/execution", json=example, timeout=30)
        assert answer.status_code == 201 and answer.json()["estimate"]["wall_seconds"] < 60, answer.text
        requests.delete(f"{daemon.url}/jobs/{answer.json()['jobID']}", timeout=30)
