"""A drum that turns the other way is the mirror image, x for -x, of one that turns this way: to the last bit in what is
measured and in what is written."""
import json
import subprocess

import h5py
import numpy
import pytest
from conftest import BUILD, SPEC
from worker_runs import run, timeless_result, write_spec

PLACED = [{"position": [0.004 * i - 0.008, -0.013, 0.003 * k - 0.003], "velocity": [0.02 * i, 0.01, 0.0],
           "angular_velocity": [1.0, 2.0 * i, 3.0]} for i in range(5) for k in (0, 2)]
CHANGES = {
    "spheres": {},
    "lifters": {"drum": SPEC["drum"] | {"lifters": {"count": 4, "height": 0.005, "width": 0.004}}},
    "lining and ends": {"drum": SPEC["drum"] | {"ends": "walls"}, "wall": {"lining": {"diameter": 0.003}}},
    "dumbbells": {"particles": [{"shape": "dumbbell", "diameter": 0.0025}], "drum": SPEC["drum"] | {"diameter": 0.05, "length": 0.02}},
    "fast": {"drum": SPEC["drum"] | {"rotation_rate": 25.0}},
}


def turned(inputs, sign):
    drum = inputs["drum"] | {"rotation_rate": sign * inputs["drum"]["rotation_rate"]}
    return {"inputs": inputs | {"drum": drum}}


def mirrored(particle):
    flip = {"position": [-1, 1, 1], "velocity": [-1, 1, 1], "angular_velocity": [1, -1, -1]}
    return {name: [a * b for a, b in zip(flip[name], value)] for name, value in particle.items()}


def ended(folder, name, spec):
    (folder / name).mkdir()
    code, _, stderr = run(write_spec(folder / name, spec), folder / name / "job", "--json")
    assert code == 0, stderr
    return folder / name / "job"


def is_mirror(one, other):
    """Every snapshot and the fields of the one are the other's, x for -x."""
    names = sorted(path.name for path in (one / "snapshots").glob("*.hdf"))
    assert names and names == sorted(path.name for path in (other / "snapshots").glob("*.hdf"))
    for name in names:
        with h5py.File(one / "snapshots" / name) as a, h5py.File(other / "snapshots" / name) as b:
            a, b = a["VTKHDF"], b["VTKHDF"]
            numpy.testing.assert_array_equal(a["Points"][:] * [-1, 1, 1], b["Points"][:])
            numpy.testing.assert_array_equal(a["PointData/velocity"][:] * [-1, 1, 1], b["PointData/velocity"][:])
            numpy.testing.assert_array_equal(a["PointData/angular_velocity"][:] * [1, -1, -1], b["PointData/angular_velocity"][:])
            for same in ("radius", "species", "contacts", "cluster"):
                numpy.testing.assert_array_equal(a[f"PointData/{same}"][:], b[f"PointData/{same}"][:])
            assert a["FieldData/drum_angle"][0] == -b["FieldData/drum_angle"][0]
    with h5py.File(one / "fields.hdf") as a, h5py.File(other / "fields.hdf") as b:
        numpy.testing.assert_array_equal(a["fields/solid_fraction"][:][:, ::-1], b["fields/solid_fraction"][:])
        numpy.testing.assert_array_equal(a["fields/velocity"][:][:, ::-1] * [-1, 1, 1], b["fields/velocity"][:])


@pytest.mark.parametrize("name", [name if name in ("lifters", "dumbbells") else pytest.param(name, marks=pytest.mark.torture)
                                  for name in CHANGES])
def test_the_other_way_is_the_mirror_image_to_the_last_bit(tmp_path, name):
    inputs = SPEC | CHANGES[name]
    this, that = ended(tmp_path, "this", turned(inputs, 1)), ended(tmp_path, "that", turned(inputs, -1))
    assert timeless_result(this) == timeless_result(that)
    is_mirror(this, that)


def test_a_mirrored_bed_turned_the_other_way_is_the_mirror_image(tmp_path):
    inputs = {name: value for name, value in SPEC.items() if name != "fill_fraction"}
    this = ended(tmp_path, "this", turned(inputs | {"start": {"particles": PLACED}}, 1))
    that = ended(tmp_path, "that", turned(inputs | {"start": {"particles": [mirrored(p) for p in PLACED]}}, -1))
    assert timeless_result(this) == timeless_result(that)
    is_mirror(this, that)
    with h5py.File(that / "snapshots/000000.hdf") as file:  # a snapshot has what was asked for, not its mirror image
        numpy.testing.assert_allclose(file["VTKHDF/Points"][:], [mirrored(p)["position"] for p in PLACED], atol=1e-8)


@pytest.mark.torture
def test_clusters_stand_in_snapshots_as_their_shape_and_orientation_say(tmp_path):
    """An oracle of its own: places from the shape as it was given, which is no mirror image of itself, and the orientation."""
    spheres = [[0, 0, 0], [0.002, 0, 0], [0, 0.0018, 0], [0.0005, 0.0004, 0.0017]]
    shape = {"spheres": [{"position": place, "diameter": 0.002} for place in spheres]}
    inputs = SPEC | {"particles": [{"shape": shape}], "drum": {"diameter": 0.05, "length": 0.02, "ends": "walls", "rotation_rate": 6.0}}
    handed, frames = set(), []
    for sign in (1, -1):
        job = ended(tmp_path, f"sign{sign}", turned(inputs, sign))
        with h5py.File(job / "snapshots/000002.hdf") as file:
            points = file["VTKHDF/Points"][:].astype(float).reshape(-1, 4, 3)
            turn = file["VTKHDF/PointData/orientation"][:].astype(float).reshape(-1, 4, 4)[:, 0]
        edges = points[:, 1:] - points[:, :1]
        handed |= set(numpy.sign(numpy.linalg.det(edges)))
        w, u = turn[:, None, :1], turn[:, None, 1:]
        # In the particle's own frame, by the inverse turn, every particle's edges are the same.
        t = 2 * numpy.cross(-u, edges)
        own = edges + w * t + numpy.cross(-u, t)
        numpy.testing.assert_allclose(own, numpy.broadcast_to(own[:1], own.shape), atol=2e-8)
        frames.append(own[0])
    numpy.testing.assert_allclose(*frames, atol=2e-8)
    assert len(handed) == 1  # the mirror image of a screw is another screw, but these particles are the ones asked for


@pytest.mark.torture
def test_a_bed_made_this_way_goes_on_the_other_way_from_a_snapshot_alone(tmp_path):
    this = ended(tmp_path, "this", turned(SPEC, 1))
    inputs = {name: value for name, value in SPEC.items() if name != "fill_fraction"}
    last = sorted((this / "snapshots").glob("*.hdf"))[-1]
    that = ended(tmp_path, "that", turned(inputs | {"start": {"file": str(last)}}, -1))
    with h5py.File(last) as a, h5py.File(that / "snapshots/000000.hdf") as b:
        numpy.testing.assert_array_equal(a["VTKHDF/Points"][:], b["VTKHDF/Points"][:])
    spec = turned(inputs | {"start": {"file": str(this / "checkpoint.hdf")}}, -1)
    done = subprocess.run([BUILD / "repose", "check", "-"], input=json.dumps(spec), capture_output=True, text=True)
    assert done.returncode == 2 and "turns the other way" in done.stdout
