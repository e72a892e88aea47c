"""Flows through an orifice, from request to results."""
import math

import h5py
import numpy
import pytest
import requests

from worker_runs import result, run, write_spec

SPEC = {"vessel": {"diameter": 0.01}, "orifice": {"diameter": 0.004}, "particles": [{"diameter": 0.001}], "particle_count": 1000,
        "contact": {"friction": 0.3, "restitution": 0.5, "maximum_overlap": 0.05},
        "wall": {"rolling_friction": 0.1}, "snapshots": {"interval": 0}, "seed": 3}


def changed(spec, **changes):
    return {name: value for name, value in (spec | changes).items() if value is not None}


def run_spec(folder, inputs):
    code, out, err = run(write_spec(folder, {"process": "orifice", "inputs": inputs}), folder / "job")
    assert code == 0, out + err
    return result(folder / "job")


def problems_of(daemon, inputs):
    answer = requests.post(f"{daemon.url}/processes/orifice/execution", json={"inputs": inputs}, timeout=30)
    assert answer.status_code == 400, answer.text
    return {error["pointer"]: error["detail"] for error in answer.json()["errors"]}


def check_balance(found, mass):
    """Each particle is in the vessel or has left, and what left has the mass of that many."""
    flow = found["flow"]
    assert flow["passed"] + flow["left"] == found["run"]["particles"]
    assert flow["passed_mass"] == pytest.approx(flow["passed"] * mass, rel=1e-12)
    assert found["drained"]["volume"] == pytest.approx(flow["left"] * mass / 2500, rel=1e-9, abs=1e-18)


def test_a_vessel_drains_and_no_particle_is_forgotten(tmp_path):
    found = run_spec(tmp_path, SPEC)
    flow, outlet = found["flow"], found["outlet"]
    check_balance(found, 2500 * math.pi / 6 * 0.001**3)
    assert not flow["clogged"] and flow["clogged_at"] is None and found["run"]["ended_by"] == "drained"
    assert flow["passed"] > 600 and found["drained"]["complete"]
    unit = math.sqrt(0.004 / 9.81)
    assert 5 * unit <= flow["steady_start"] < 6 * unit and flow["steady_start"] < flow["steady_end"] < flow["last_left_at"]
    # Beverloo's law with C 0.58 and k 1.4 as published for spheres, to what friction and the narrow vessel change: a half
    expected = 0.58 * 2500 * found["packing"]["solid_fraction"] * math.sqrt(9.81) * (0.004 - 1.4 * 0.001)**2.5
    assert 0.6 * expected < flow["mass_rate"] < 1.5 * expected
    assert flow["mass_rate"] == pytest.approx(flow["number_rate"] * 2500 * math.pi / 6 * 0.001**3, rel=1e-9)
    # what leaves is as much as passes the plane: the flow is solid fraction times velocity times area
    through = outlet["solid_fraction"] * outlet["velocity"] * 2500 * math.pi / 4 * 0.004**2
    assert through == pytest.approx(flow["mass_rate"], rel=0.15)
    # a fall from a dome over the orifice, of no more than its diameter
    assert 0.3 * math.sqrt(9.81 * 0.004) < outlet["velocity"] < math.sqrt(2 * 9.81 * 0.004)
    check_fields(tmp_path / "job/fields.hdf", found)


def check_fields(path, found):
    """The first row is the profile; the same mass passes each plane of the converging flow, which comes from outside and falls faster."""
    with h5py.File(path) as file:
        solid, velocity = file["fields/solid_fraction"][:], file["fields/velocity"][:]
        size, frames = file["fields"].attrs["size"], file["fields"].attrs["frames"]
        image = file["VTKHDF/PointData/velocity"][:]
        assert list(file["VTKHDF"].attrs["WholeExtent"]) == [0, solid.shape[1] - 1, 0, solid.shape[0] - 1, 0, 1]
    assert frames > 10 and size * solid.shape[1] == pytest.approx(0.75 * 0.004) and size * solid.shape[0] == pytest.approx(2 * 0.004)
    assert all(numpy.array_equal(layer, velocity, equal_nan=True) for layer in image)
    profile = found["outlet"]["profile"]
    within = len(profile["radius"])
    assert solid[0, :within] == pytest.approx(profile["solid_fraction"], rel=1e-5)
    assert -velocity[0, :within, 1] == pytest.approx(profile["velocity"], rel=1e-5)
    ring = 2 * math.pi * size**2 * (numpy.arange(solid.shape[1]) + 0.5)
    for row in (1, 2):  # a flow that widens upward, of which the rings see more than the orifice
        through = 2500 * numpy.nansum(solid[row] * -velocity[row, :, 1] * ring)
        assert through == pytest.approx(found["flow"]["mass_rate"], rel=0.15)
    assert velocity[1, within - 1, 0] < 0 and velocity[0, 0, 1] < velocity[-1, 0, 1] < 0


def test_a_narrow_orifice_clogs_and_the_run_ends_early(tmp_path):
    found = run_spec(tmp_path, changed(SPEC, orifice={"diameter": 0.0016}, particle_count=300, duration={"at_most_seconds": 20}))
    flow = found["flow"]
    check_balance(found, 2500 * math.pi / 6 * 0.001**3)
    assert flow["clogged"] and found["run"]["ended_by"] == "clogged" and flow["left"] > 100
    assert flow["clogged_at"] >= 0 and found["run"]["simulated_seconds"] < 5
    assert found["run"]["simulated_seconds"] - flow["clogged_at"] >= 10 * math.sqrt(0.0016 / 9.81) * 0.99
    assert found["drained"]["angle_deg"] is None
    assert "/flow/clogged" in {warning["field"] for warning in found["run"]["warnings"]}


@pytest.mark.parametrize("changes", [
    {"hopper": {"half_angle_deg": 30}, "particle_count": 500},
    {"vessel": {"width": 0.008, "depth": 0.005}, "orifice": {"width": 0.004}, "particle_count": 400},
    {"vessel": {"width": 0.008, "depth": 0.005}, "orifice": {"width": 0.004}, "hopper": {"half_angle_deg": 30}, "particle_count": 400},
], ids=["hopper", "slot", "slot below a hopper"])
def test_hoppers_and_slots_drain(tmp_path, changes):
    found = run_spec(tmp_path, changed(SPEC, **changes))
    check_balance(found, 2500 * math.pi / 6 * 0.001**3)
    assert found["run"]["ended_by"] == "drained" and found["flow"]["passed"] > 200
    if "hopper" in changes:
        assert found["flow"]["left"] < 20 and found["drained"]["angle_deg"] is None


def test_bad_inputs_are_named_all_at_once(daemon):
    found = problems_of(daemon, changed(SPEC, vessel={"diameter": 0.004}, orifice={"diameter": 0.0005}))
    assert set(found) == {"/inputs/vessel/diameter", "/inputs/orifice/diameter"}
    assert all("must be at least" in text and " m" in text for text in found.values())
    assert set(problems_of(daemon, changed(SPEC, orifice={"diameter": 0.009}))) == {"/inputs/orifice/diameter"}
    assert set(problems_of(daemon, changed(SPEC, vessel={"width": 0.01}))) == {"/inputs/orifice"}
    assert set(problems_of(daemon, changed(SPEC, hopper={"half_angle_deg": 90}))) == {"/inputs/hopper/half_angle_deg"}
    assert set(problems_of(daemon, changed(SPEC, vessel={"diameter": 0.01, "height": 0.01}))) == {"/inputs/vessel/height"}
    assert set(problems_of(daemon, changed(SPEC, vessel={"diameter": 0.01, "depth": 0.01}))) == {"/inputs/vessel/depth"}
    assert set(problems_of(daemon, changed(SPEC, orifice={}))) == {"/inputs/orifice/diameter"}
    assert set(problems_of(daemon, changed(SPEC, orifice={"diameter": 0.004, "width": 0.004}))) == {"/inputs/orifice/width"}
