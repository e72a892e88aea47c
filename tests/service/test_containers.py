"""Drums with end walls and lifters: asked for, kept as asked, run, and clear of every wall in each snapshot."""
import h5py
import numpy
import pytest
from worker_runs import result, run, small, write_spec

LIFTERS = {"count": 5, "height": 0.004, "width": 0.003}
CLOSED = {"ends": "walls", "lifters": LIFTERS}


def test_walls_and_lifters_take_the_walls_friction_unless_given_their_own(fake):
    drum = {"diameter": 0.1, "length": 0.02, "rotation_rate": 3.0}
    inputs = {"particles": [{"diameter": 0.003, "shape": "dumbbell"}], "duration": {"seconds": 0.1}, "seed": 1}
    closed = fake.submit(inputs | {"drum": drum | CLOSED, "wall": {"friction": 0.4}})
    own = fake.submit(inputs | {"drum": drum | {"ends": "walls", "lifters": LIFTERS | {"friction": 0.1}}, "wall": {"end_friction": 0.2}})
    plain = fake.submit(inputs | {"drum": drum})
    specs = [fake.get(f"/jobs/{job}/spec").json()["inputs"] for job in (closed, own, plain)]
    assert [spec["wall"].get("end_friction") for spec in specs] == [0.4, 0.2, None]
    assert [(spec["drum"]["lifters"] or {}).get("friction") for spec in specs] == [0.4, 0.1, None]
    for job in (closed, own, plain):
        assert fake.ended(job)["status"] == "successful"
    rows = fake.get("/query", params={"sql": "select ends, lifters, shape from run_summary order by created, id"}).json()["rows"]
    assert sorted(rows) == [["periodic", 0, "dumbbell"], ["walls", 5, "dumbbell"], ["walls", 5, "dumbbell"]]


def test_what_cannot_be_built_is_refused_with_every_problem(fake):
    answer = fake.post({"drum": {"diameter": 0.1, "length": 0.02, "rotation_rate": 3.0, "lifters": LIFTERS | {"height": 0.06}},
                        "particles": [{"diameter": 0.003}], "wall": {"end_friction": 0.2, "lining": {"diameter": 0.003}}})
    assert answer.status_code == 400
    assert sorted(error["pointer"] for error in answer.json()["errors"]) == [
        "/inputs/drum/lifters", "/inputs/drum/lifters/height", "/inputs/wall/end_friction"]


def test_in_every_snapshot_particles_are_between_the_ends_and_beside_the_bars(tmp_path):
    """Distances to turned boxes by numpy, from the snapshot's own time. Overlaps: what the result says, of 2 mm spheres."""
    spec = small(drum=CLOSED, particles=[{"diameter": 0.002}], duration={"revolutions": 0.7}, contact={"maximum_overlap": 0.03})
    code, _, stderr = run(write_spec(tmp_path, spec), tmp_path / "job")
    assert code == 0, stderr
    document = result(tmp_path / "job")
    assert 10 < document["repose"]["angle_deg"] < 60
    allowed = 0.002 * document["run"]["maximum_overlap"] + 1e-7  # places are kept in single precision
    assert allowed < 0.002 * 0.06
    near_bar, near_end = [], []
    for path in sorted((tmp_path / "job" / "snapshots").glob("*.hdf")):
        with h5py.File(path, "r") as file:
            x, radius = file["VTKHDF/Points"][:].astype(float), file["VTKHDF/PointData/radius"][:].astype(float)
            time = float(numpy.ravel(file["VTKHDF/FieldData/time"][:])[0])
        assert numpy.all(numpy.hypot(x[:, 0], x[:, 1]) + radius <= 0.015 + allowed)
        assert numpy.all(abs(x[:, 2]) + radius <= 0.005 + allowed)
        near_end.append(numpy.max(abs(x[:, 2]) + radius - 0.005))
        for k in range(5):
            angle = 2 * numpy.pi * k / 5 + 6.0 * max(time, 0.0)
            out = x[:, 0] * numpy.cos(angle) + x[:, 1] * numpy.sin(angle)
            across = numpy.abs(x[:, 1] * numpy.cos(angle) - x[:, 0] * numpy.sin(angle))
            gap = numpy.hypot(numpy.maximum(0.015 - 0.004 - out, 0), numpy.maximum(across - 0.0015, 0)) - radius
            assert numpy.all(gap >= -allowed)
            near_bar.append(gap.min())
    assert min(near_bar) < 1e-5 and max(near_end) > -1e-5  # some did touch


def test_sizes_between_end_walls_have_an_axial_index(tmp_path):
    spec = small(drum={"ends": "walls", "length": 0.03}, duration={"revolutions": 0.3}, contact={"maximum_overlap": 0.03},
                 particles=[{"diameter": 0.002, "share": 0.7}, {"diameter": 0.003, "share": 0.3}], snapshots={"interval": 0})
    code, _, stderr = run(write_spec(tmp_path, spec), tmp_path / "job")
    assert code == 0, stderr
    assert result(tmp_path / "job")["segregation"]["axial_index"] == pytest.approx(0.2, abs=0.2)  # mixed at random, or little more
