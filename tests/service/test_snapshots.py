"""Snapshots as other programs see them: h5py, VTK's own reader, and ParaView by the types it insists on."""
import hashlib
import json
import struct

import h5py
import numpy
import pytest
from worker_runs import events, result, run, small, snapshot_bytes, start, wait_until, write_spec


@pytest.fixture(scope="module")
def job(tmp_path_factory):
    folder = tmp_path_factory.mktemp("snapshots")
    spec = small(particles=[{"diameter": 0.003, "share": 0.75}, {"diameter": 0.0024, "density": 1200, "share": 0.25}],
                 duration={"seconds": 0.25})
    code, _, stderr = run(write_spec(folder, spec), folder / "job")
    assert code == 0, stderr
    return folder / "job"


@pytest.fixture
def last(job):
    with h5py.File(sorted((job / "snapshots").glob("*.hdf"))[-1], "r") as file:
        yield file


def test_the_type_attribute_is_the_only_kind_of_string_that_paraview_takes(last):
    attribute = h5py.h5a.open(last["VTKHDF"].id, b"Type")
    kind = attribute.get_type()
    assert attribute.get_space().get_simple_extent_ndims() == 0
    assert isinstance(kind, h5py.h5t.TypeStringID) and not kind.is_variable_str()
    assert kind.get_size() == 16
    assert kind.get_cset() == h5py.h5t.CSET_ASCII
    assert kind.get_strpad() == h5py.h5t.STR_NULLPAD
    assert last["VTKHDF"].attrs["Type"] == b"UnstructuredGrid"


def test_the_version_is_1_0_in_two_64_bit_integers(last):
    version = last["VTKHDF"].attrs["Version"]
    assert version.dtype == numpy.int64 and list(version) == [1, 0]


def test_the_grid_has_one_vertex_a_particle(job, last):
    n = result(job)["run"]["particles"]
    grid = last["VTKHDF"]
    for name in ("NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"):
        assert grid[name].dtype == numpy.int64 and list(grid[name]) == [n]
    assert grid["Points"].shape == (n, 3) and grid["Points"].dtype == numpy.float32
    assert grid["Connectivity"].dtype == numpy.int64 and list(grid["Connectivity"]) == list(range(n))
    assert grid["Offsets"].dtype == numpy.int64 and list(grid["Offsets"]) == list(range(n + 1))
    assert grid["Types"].dtype == numpy.uint8 and set(grid["Types"]) == {1}


def test_every_field_of_a_particle_is_there_compressed(job, last):
    n = result(job)["run"]["particles"]
    fields = last["VTKHDF/PointData"]
    assert set(fields) == {"radius", "id", "velocity", "angular_velocity", "species", "contacts", "speed", "cluster"}
    for name, shape in (("radius", (n,)), ("velocity", (n, 3)), ("angular_velocity", (n, 3)), ("speed", (n,))):
        assert fields[name].shape == shape and fields[name].dtype == numpy.float32, name
        assert fields[name].compression == "gzip" and fields[name].shuffle, name
    assert list(fields["id"]) == list(range(n))
    assert numpy.allclose(fields["speed"], numpy.linalg.norm(fields["velocity"], axis=1), rtol=1e-6)


def test_particles_are_of_their_species_and_inside_the_drum(last):
    fields, points = last["VTKHDF/PointData"], last["VTKHDF/Points"][:]
    species, radius = fields["species"][:], fields["radius"][:]
    assert numpy.allclose(radius[species == 0], 0.0015) and numpy.allclose(radius[species == 1], 0.0012)
    assert abs(numpy.mean(species == 1) - 0.25) < 1.0 / len(species)
    # The centre may come nearer to the wall than the radius by the overlap, 1 % of a diameter.
    assert numpy.all(numpy.hypot(points[:, 0], points[:, 1]) < 0.015 - 0.9 * radius)
    assert numpy.all(numpy.abs(points[:, 2]) <= 0.005 * (1 + 1e-6))
    assert points[:, 1].mean() < 0  # gravity points along -y
    assert fields["contacts"][:].mean() > 1  # a flowing bed is held up, if by fewer contacts than one at rest


def test_time_step_and_spec_are_kept_with_the_particles(job, last):
    final = events(job, "snapshot")[-1]
    assert list(last["VTKHDF/FieldData/time"]) == [pytest.approx(final["time"], rel=1e-11)]
    assert list(last["VTKHDF/FieldData/step"]) == [final["step"]]
    params = last["run"].attrs["params_json"]
    params = params.decode() if isinstance(params, bytes) else params
    assert json.loads(params) == json.loads((job / "spec.json").read_text())


def test_position_is_another_name_of_the_points(last):
    assert last["particles/position"] == last["VTKHDF/Points"]


def test_vtk_reads_points_and_fields(job):
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOHDF import vtkHDFReader
    path = sorted((job / "snapshots").glob("*.hdf"))[-1]
    reader = vtkHDFReader()
    assert reader.CanReadFile(str(path))
    reader.SetFileName(str(path))
    reader.Update()
    grid = reader.GetOutput()
    n = result(job)["run"]["particles"]
    assert grid.GetNumberOfPoints() == n and grid.GetNumberOfCells() == n
    assert grid.GetCellType(0) == 1
    with h5py.File(path, "r") as file:
        assert numpy.array_equal(vtk_to_numpy(grid.GetPoints().GetData()), file["VTKHDF/Points"][:])
        for name in file["VTKHDF/PointData"]:
            read = vtk_to_numpy(grid.GetPointData().GetArray(name))
            assert numpy.array_equal(read, file["VTKHDF/PointData"][name][:]), name
    assert grid.GetFieldData().GetArray("time").GetValue(0) == pytest.approx(0.25, abs=1e-3)


def test_the_series_names_every_snapshot_with_its_time(job):
    series = json.loads((job / "snapshots.hdf.series").read_text())
    assert series["file-series-version"] == "1.0"
    written = events(job, "snapshot")
    assert [entry["name"] for entry in series["files"]] == ["snapshots/" + event["file"] for event in written]
    for entry, event in zip(series["files"], written):
        assert (job / entry["name"]).exists()
        assert entry["time"] == pytest.approx(event["time"], rel=1e-8)


def test_equal_runs_have_equal_bytes(job, tmp_path):
    assert run(job / "spec.json", tmp_path / "again")[0] == 0
    hashes = [{name: hashlib.sha256(content).hexdigest() for name, content in snapshot_bytes(out).items()}
              for out in (job, tmp_path / "again")]
    assert hashes[0] == hashes[1] and sum(name.endswith(".hdf") for name in hashes[0]) == 4


def test_no_dataset_carries_the_time_of_its_making(last):
    def look(name, item):
        assert h5py.h5g.get_objinfo(item.id).mtime == 0, name
    last.visititems(look)


def test_a_label_in_any_script_survives_in_the_file(tmp_path):
    spec = small(duration={"seconds": 0.02}, snapshots={"interval": 0})
    spec["label"] = {"\u6750\u6599": "\u7802 \u2713", "quote": 'a "b" \\ c'}
    assert run(write_spec(tmp_path, spec), tmp_path / "job")[0] == 0
    with h5py.File(tmp_path / "job" / "snapshots" / "000000.hdf", "r") as file:
        params = file["run"].attrs["params_json"]
    params = params.decode() if isinstance(params, bytes) else params
    assert json.loads(params)["label"] == spec["label"]


MIXED = [{"shape": "tetrahedron", "diameter": 0.0012, "share": 0.5},
         {"shape": {"spheres": [{"position": [0, 0, 0], "diameter": 0.002}, {"position": [0.001, 0, 0], "diameter": 0.0016}]}, "share": 0.2},
         {"diameter": 0.002, "share": 0.3}]


@pytest.fixture(scope="module")
def clusters(tmp_path_factory):
    folder = tmp_path_factory.mktemp("clusters")
    spec = small(particles=MIXED, duration={"seconds": 0.2}, contact={"maximum_overlap": 0.03})
    code, _, stderr = run(write_spec(folder, spec), folder / "job")
    assert code == 0, stderr
    return folder / "job"


def rotated(orientation, vector):
    """Turned by the quaternions w, x, y, z."""
    w, axis = orientation[:, :1], orientation[:, 1:]
    return vector + 2 * w * numpy.cross(axis, vector) + 2 * numpy.cross(axis, numpy.cross(axis, vector))


def test_a_cluster_is_its_spheres_and_they_keep_their_distances(clusters):
    """Spheres by themselves first, then those of clusters, cluster after cluster."""
    facts = result(clusters)["run"]
    for path in sorted((clusters / "snapshots").glob("*.hdf")):
        with h5py.File(path, "r") as file:
            points, fields = file["VTKHDF/Points"][:].astype(float), file["VTKHDF/PointData"]
            body, species, orientation = fields["cluster"][:], fields["species"][:], fields["orientation"][:].astype(float)
        assert len(points) == facts["spheres"] and body[-1] + 1 == facts["particles"]
        assert orientation.shape == (len(points), 4) and numpy.allclose(numpy.linalg.norm(orientation, axis=1), 1, atol=1e-6)
        for which, members in ((0, 4), (1, 2), (2, 1)):
            of_it = numpy.flatnonzero(species == which)
            assert len(of_it) % members == 0 and numpy.all(body[of_it].reshape(-1, members).T == body[of_it][::members])
        tetrahedra, pairs = numpy.flatnonzero(species == 0).reshape(-1, 4), numpy.flatnonzero(species == 1).reshape(-1, 2)
        for a, b, distance in [(tetrahedra[:, i], tetrahedra[:, j], 0.0012) for i in range(4) for j in range(i)] \
                + [(pairs[:, 0], pairs[:, 1], 0.001)]:
            apart = points[a] - points[b]
            apart[:, 2] -= 0.01 * numpy.rint(apart[:, 2] / 0.01)  # across the period
            assert numpy.allclose(numpy.linalg.norm(apart, axis=1), distance, atol=1e-8)  # places are in single precision
        # the pair's axis is an axis of its own frame, whichever: turned, it is along the line of centres
        axes = [rotated(orientation[pairs[:, 0]], numpy.tile(e, (len(pairs), 1))) for e in numpy.eye(3)]
        along = [numpy.abs((axis * apart).sum(axis=1)) / 0.001 for axis in axes]
        assert any(numpy.allclose(cosine, 1, atol=1e-4) for cosine in along)
        # one body, one spin
        first = numpy.searchsorted(body, body)
        with h5py.File(path, "r") as file:
            spin = file["VTKHDF/PointData/angular_velocity"][:]
        assert numpy.array_equal(spin, spin[first])


def test_a_run_of_clusters_goes_on_from_a_checkpoint_with_the_same_bits(clusters, tmp_path):
    """Checkpoints as often as can be; stopped somewhere on the way, the second attempt ends with the same files."""
    spec = write_spec(tmp_path, json.loads((clusters / "spec.json").read_text()))
    worker = start(spec, tmp_path / "job", "--checkpoint-seconds", 0)
    wait_until(lambda: len(events(tmp_path / "job", "checkpoint")) >= 3)
    worker.terminate()
    assert worker.wait(20) in (0, 3)
    code, _, stderr = run(spec, tmp_path / "job")
    assert code == 0, stderr
    assert snapshot_bytes(tmp_path / "job") == snapshot_bytes(clusters)


def frame_of(path):
    """As api/FRAMES.md describes it: the head, and each array by its name."""
    data = path.read_bytes()
    magic, count, flags, time, turned, *rest = struct.unpack("<8s2I2d8f", data[:64])
    assert magic == b"RPSFRM1\0"
    arrays, at = {}, 64
    for name, flag, kind, columns in (("place", 0, "<i2", 3), ("speed", 0, "u1", 1), ("species", 1, "u1", 1), ("radius", 2, "<u2", 1),
                                      ("cluster", 4, "<u4", 1), ("spin", 8, "u1", 1), ("contacts", 16, "u1", 1)):
        if flag and not flags & flag:
            continue
        arrays[name] = numpy.frombuffer(data, kind, count * columns, at).astype(float)
        at += count * columns * numpy.dtype(kind).itemsize
        assert data[at:at + -at % 4] == bytes(-at % 4)
        at += -at % 4
    assert at == len(data)
    low, high = numpy.array(rest[0:3]), numpy.array(rest[3:6])
    arrays["place"] = low + (arrays["place"].reshape(count, 3) + 32767) / 65534 * (high - low)
    return {"count": count, "time": time, "turned": turned, "low": low, "high": high, "fastest": rest[6], "largest": rest[7]}, arrays


@pytest.mark.parametrize("made", ["job", "clusters"])
def test_a_frame_has_what_its_snapshot_has_as_nearly_as_it_says(made, request):
    """Each number is off by half of its last place at most; single precision of box and snapshot takes a little more."""
    folder = request.getfixturevalue(made)
    snapshots = sorted((folder / "snapshots").glob("*.hdf"))
    assert [path.stem for path in snapshots] == [path.stem for path in sorted((folder / "snapshots").glob("*.bin"))]
    for path in snapshots:
        with h5py.File(path, "r") as file:
            points, fields = file["VTKHDF/Points"][:].astype(float), {name: data[:] for name, data in file["VTKHDF/PointData"].items()}
            time, turned = (file["VTKHDF/FieldData"][name][0] for name in ("time", "drum_angle"))
        head, arrays = frame_of(path.with_suffix(".bin"))
        assert (head["count"], head["time"], head["turned"]) == (len(points), time, turned)
        assert numpy.allclose(head["low"], points.min(axis=0), atol=1e-8) and numpy.allclose(head["high"], points.max(axis=0), atol=1e-8)
        assert numpy.all(numpy.abs(arrays["place"] - points) <= 0.5 / 65534 * (head["high"] - head["low"]) + 1e-8)
        assert head["fastest"] == pytest.approx(fields["speed"].max()) and head["largest"] == fields["radius"].max()
        assert numpy.all(numpy.abs(arrays["speed"] / 255 - fields["speed"] / head["fastest"]) <= 0.5 / 255 + 1e-6)
        assert numpy.all(numpy.abs(arrays["radius"] / 65535 - fields["radius"] / head["largest"]) <= 0.5 / 65535 + 1e-6)
        spin = numpy.linalg.norm(fields["angular_velocity"], axis=1) * head["largest"] / head["fastest"]
        assert numpy.all(numpy.abs(arrays["spin"] / 255 - numpy.minimum(spin, 1)) <= 0.5 / 255 + 1e-6) and arrays["spin"].max() > 100
        for name in ("species", "contacts"):
            assert numpy.array_equal(arrays[name], fields[name]), name
        assert ("cluster" in arrays) == (made == "clusters")
        assert made != "clusters" or numpy.array_equal(arrays["cluster"], fields["cluster"])


def test_a_frame_of_equal_spheres_says_nothing_of_them_one_by_one(tmp_path):
    """And in a drum that turns the other way, x is that of the snapshot, too."""
    spec = small(drum={"rotation_rate": -6.0}, duration={"seconds": 0.02}, snapshots={"interval": 0})
    assert run(write_spec(tmp_path, spec), tmp_path / "job")[0] == 0
    head, arrays = frame_of(tmp_path / "job/snapshots/000000.bin")
    assert set(arrays) == {"place", "speed", "spin", "contacts"} and head["turned"] < 0
    with h5py.File(tmp_path / "job/snapshots/000000.hdf", "r") as file:
        assert numpy.allclose(arrays["place"], file["VTKHDF/Points"], atol=1e-6)
