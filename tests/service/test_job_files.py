"""A job's folder as other programs get it: over HTTP as a time series for ParaView and as a tar archive, the walls as VTK reads
them, and the units of everything in HDF5."""
import io
import json
import math
import os
import subprocess
import tarfile

import h5py
import numpy
import pytest
import requests
import vtk
from conftest import FAKE_WORKER, SPEC, Daemon
from test_heap_and_fill import SPECS
from vtk.util.numpy_support import vtk_to_numpy
from worker_runs import run, small, write_spec

SHELL, END, LIFTER, PLATE, RIM = range(5)


def walls_in(folder):
    """The points (n,3), for each part the numbers of the points of its cells, and how far the drum has turned."""
    reader = vtk.vtkXMLPolyDataReader()
    reader.SetFileName(str(folder / "walls.vtp"))
    reader.Update()
    data = reader.GetOutput()
    parts = vtk_to_numpy(data.GetCellData().GetArray("part"))
    corners = [[data.GetCell(k).GetPointId(c) for c in range(data.GetCell(k).GetNumberOfPoints())] for k in range(data.GetNumberOfCells())]
    of_part = {part: sorted({c for k in numpy.flatnonzero(parts == part) for c in corners[k]}) for part in set(parts)}
    return vtk_to_numpy(data.GetPoints().GetData()), of_part, data.GetFieldData().GetArray("drum_angle").GetValue(0)


def made(tmp_path, spec, name="job"):
    code, _, stderr = run(write_spec(tmp_path, spec), tmp_path / name)
    assert code == 0, stderr
    return tmp_path / name


def last_snapshot(folder):
    return h5py.File(sorted((folder / "snapshots").glob("*.hdf"))[-1])


@pytest.mark.parametrize("rate", [6.0, -6.0])
def test_the_walls_of_a_drum_are_where_they_are_at_its_newest_snapshot(tmp_path, rate):
    """Six lifters: their middles are where a point of the drum is that was at 0, 60, ... degrees and turned with it."""
    spec = small(duration={"seconds": 0.1}, snapshots={"interval": 0.05})
    spec["inputs"]["drum"] |= {"ends": "walls", "rotation_rate": rate, "lifters": {"count": 6, "height": 0.003, "width": 0.004}}
    folder = made(tmp_path, spec)
    points, of_part, turned = walls_in(folder)
    drum = json.loads((folder / "spec.json").read_text())["inputs"]["drum"]
    with last_snapshot(folder) as snapshot:
        assert turned == pytest.approx(snapshot["VTKHDF/FieldData/drum_angle"][0], rel=1e-12)
        centres = snapshot["VTKHDF/Points"][:]
    assert turned == pytest.approx(rate * 0.1, rel=1e-3)
    shell = points[of_part[SHELL]]
    assert numpy.hypot(shell[:, 0], shell[:, 1]) == pytest.approx(drum["diameter"] / 2)
    assert set(numpy.round(shell[:, 2], 9)) == {-drum["length"] / 2, drum["length"] / 2} == set(numpy.round(points[of_part[END]][:, 2], 9))
    assert (numpy.hypot(centres[:, 0], centres[:, 1]) < drum["diameter"] / 2).all()
    bars = points[of_part[LIFTER]].reshape(6, 8, 3)
    for k, bar in enumerate(bars):
        middle = bar.mean(axis=0)
        sign = math.copysign(1, rate)  # the mirror image of a drum that turns the other way is what runs
        angle = turned + sign * k * math.pi / 3 if rate > 0 else math.pi + turned - k * math.pi / 3
        assert math.atan2(middle[1], middle[0]) == pytest.approx(math.remainder(angle, 2 * math.pi), abs=1e-6)
        assert numpy.linalg.norm(bar[0] - bar[1]) == pytest.approx(0.004, rel=1e-6)
        assert numpy.hypot(bar[:, 0], bar[:, 1]).max() == pytest.approx(drum["diameter"] / 2)


def test_the_walls_of_a_heap_and_a_fill_are_tube_plate_rim_and_floor(tmp_path):
    heap = made(tmp_path, {"process": "heap", "inputs": SPECS["heap"]}, "heap")
    inputs = json.loads((heap / "spec.json").read_text())["inputs"]
    points, of_part, turned = walls_in(heap)
    assert turned == 0 and set(of_part) == {SHELL, PLATE} | ({RIM} if inputs["plate"]["rim_height"] > 0 else set())
    plate, tube = points[of_part[PLATE]], points[of_part[SHELL]]
    assert (plate[:, 2] == 0).all() and numpy.hypot(plate[:, 0], plate[:, 1]) == pytest.approx(inputs["plate"]["diameter"] / 2)
    assert numpy.hypot(tube[:, 0], tube[:, 1]) == pytest.approx(inputs["tube"]["diameter"] / 2)
    with last_snapshot(heap) as snapshot:  # raised at this speed, perhaps not from the very beginning
        assert 0 < tube[:, 2].min() <= inputs["tube"]["lift_speed"] * snapshot["VTKHDF/FieldData/time"][0] * (1 + 1e-6)
    fill = made(tmp_path, {"process": "fill", "inputs": SPECS["fill"]}, "fill")
    points, of_part, _ = walls_in(fill)
    assert set(of_part) == {SHELL, END} and (points[of_part[END]][:, 2] == 0).all() and points[of_part[SHELL]][:, 2].min() == 0


UNITS = {"VTKHDF/Points": "m", "VTKHDF/PointData/radius": "m", "VTKHDF/PointData/velocity": "m/s", "VTKHDF/PointData/speed": "m/s",
         "VTKHDF/PointData/angular_velocity": "rad/s", "VTKHDF/FieldData/time": "s", "VTKHDF/FieldData/drum_angle": "rad",
         "VTKHDF/PointData/species": "1", "VTKHDF/PointData/contacts": "1", "particles/position": "m", "fields/velocity": "m/s",
         "fields/granular_temperature": "m2/s2", "fields/solid_fraction": "1"}


def test_every_dataset_says_its_unit(tmp_path):
    folder = made(tmp_path, small(duration={"seconds": 0.1}))
    seen = {}
    for path in (next((folder / "snapshots").glob("*.hdf")), folder / "fields.hdf", folder / "checkpoint.hdf"):
        with h5py.File(path) as file:
            def look(name, node):
                if isinstance(node, h5py.Dataset):
                    seen[name] = node.attrs["units"].decode()
            file.visititems(look)
    assert len(seen) > 30 and {name: seen[name] for name in UNITS if name in seen} == {name: unit for name, unit in UNITS.items() if name in seen}
    assert set(UNITS) - set(seen) <= {"particles/position"}  # a second name of Points


# --- over HTTP ---

@pytest.fixture(scope="module")
def service(tmp_path_factory):
    """A daemon with a job whose folder holds more than it should: links, a pipe, a file that is being written."""
    daemon = Daemon(tmp_path_factory.mktemp("files"), worker=FAKE_WORKER, options=["--workers", "2"]).start()
    job = daemon.submit(fake="quick")
    daemon.ended(job)
    folder = daemon.data / "jobs" / job
    (folder / "large.bin").write_bytes(os.urandom(700_001))
    (folder / "empty.txt").touch()
    (folder / "secret.txt").symlink_to("/etc/hostname")
    (folder / "elsewhere").symlink_to("/etc")
    (folder / "snapshots" / "999999.hdf").symlink_to("/etc/hostname")
    (folder / "half.hdf.tmp").write_text("half")
    os.mkfifo(folder / "pipe")
    yield daemon, job, folder
    daemon.stop()


def plain_files(folder):
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*")
            if path.is_file() and not path.is_symlink() and path.suffix != ".tmp" and "elsewhere" not in path.parts}


def test_the_archive_holds_every_plain_file_and_no_other(service):
    daemon, job, folder = service
    answer = daemon.get(f"/jobs/{job}/files.tar")
    assert answer.headers["Content-Disposition"] == f'attachment; filename="{job}.tar"' and answer.headers["Content-Type"] == "application/x-tar"
    with tarfile.open(fileobj=io.BytesIO(answer.content)) as archive:
        members = archive.getmembers()
        assert all(member.isreg() and member.mode == 0o644 for member in members)
        held = {member.name.removeprefix(f"{job}/"): archive.extractfile(member).read() for member in members}
    assert held == plain_files(folder) and len(held) >= 6
    assert len(answer.content) % 512 == 0
    listed = subprocess.run(["tar", "tf", "-"], input=answer.content, capture_output=True, check=True)
    assert set(listed.stdout.decode().split()) == {f"{job}/{name}" for name in held} and listed.stderr == b""


def test_the_archive_is_made_while_it_is_read(service):
    """Nothing is kept for it: the memory of the daemon does not grow by what it sends, nor its folder."""
    daemon, job, folder = service
    big = folder / "big.bin"
    with open(big, "wb") as file:
        file.truncate(100 << 20)
    resident = lambda: int(next(line for line in open(f"/proc/{daemon.process.pid}/status") if line.startswith("VmRSS")).split()[1])  # noqa: E731
    before, most, length = resident(), 0, 0
    with requests.get(f"{daemon.url}/jobs/{job}/files.tar", stream=True, timeout=60) as answer:
        for piece in answer.iter_content(4 << 20):
            length += len(piece)
            most = max(most, resident())
    big.unlink()
    assert length > 100 << 20 and most - before < 16 << 10  # kB
    assert not list(daemon.data.rglob("*.tar"))


def test_an_archive_stays_whole_when_a_file_becomes_shorter(service):
    daemon, job, folder = service
    log = folder / "a-shrinking.log"
    log.write_bytes(b"x" * (8 << 20))
    with requests.get(f"{daemon.url}/jobs/{job}/files.tar", stream=True, timeout=60) as answer:
        pieces = answer.iter_content(1 << 16)
        content = next(pieces)
        os.truncate(log, 100)
        content += b"".join(pieces)
    log.unlink()
    with tarfile.open(fileobj=io.BytesIO(content)) as archive:
        assert len(archive.extractfile(f"{job}/a-shrinking.log").read()) == 8 << 20
        assert f"{job}/result.json" in archive.getnames()


def test_the_series_leads_to_the_snapshots(tmp_path):
    daemon = Daemon(tmp_path).start()
    job = daemon.submit(SPEC)
    assert daemon.ended(job)["status"] == "successful"
    address = f"{daemon.url}/jobs/{job}/snapshots.hdf.series"
    series = requests.get(address, timeout=30)
    listed = daemon.get(f"/jobs/{job}/snapshots").json()["snapshots"]
    assert [requests.compat.urljoin(address, file["name"]) for file in series.json()["files"]] == [one["href"] for one in listed]
    assert [file["time"] for file in series.json()["files"]] == pytest.approx([one["time"] for one in listed])
    links = {link["rel"]: link["href"] for link in daemon.job(job)["links"]}
    assert links["series"] == address and links["walls"].endswith("/walls.vtp") and links["archive"].endswith("/files.tar")
    walls = requests.get(links["walls"], timeout=30)
    assert "PolyData" in walls.text and requests.get(links["walls"], headers={"If-None-Match": walls.headers["ETag"]}, timeout=30).status_code == 304
    daemon.stop()


def test_what_is_not_there_is_said(service):
    daemon, job, _ = service
    for name in ("walls.vtp", "snapshots.hdf.series"):
        answer = daemon.get(f"/jobs/{job}/{name}")
        assert answer.status_code == 404 and name in answer.json()["detail"] and answer.json()["type"].endswith("/no-such-file")
    assert daemon.get("/jobs/20200101-000000-00000000/files.tar").status_code == 404
