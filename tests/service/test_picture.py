"""The picture of a bed: what is drawn is where the particles are, by the positions of the snapshot of the same moment."""
import re

import h5py
import numpy
import pytest
import requests
from conftest import SPEC
from worker_runs import run, small, write_spec

DIAMETER, MARGIN = 0.03, 1.03  # of SMALL's drum; beside it


def read_png(path):
    """(height, width, 4) from 0 to 1, by a reader that is not ours."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOImage import vtkPNGReader
    reader = vtkPNGReader()
    reader.SetFileName(str(path))
    reader.Update()
    image = reader.GetOutput()
    width, height, _ = image.GetDimensions()
    return vtk_to_numpy(image.GetPointData().GetScalars()).reshape(height, width, -1)[::-1] / 255  # its rows go upwards


def discs(path, size):
    """Which pixels have a particle in front of them, and which are within the drum."""
    with h5py.File(path) as file:
        points, radius = file["VTKHDF/Points"][:], file["VTKHDF/PointData/radius"][:]
    pixel = MARGIN * DIAMETER / size
    u = (numpy.arange(size) + 0.5) * pixel - MARGIN * DIAMETER / 2
    x, y = numpy.meshgrid(u, -u)
    covered = numpy.zeros((size, size), bool)
    for (cx, cy, _), r in zip(points, radius):
        covered |= (x - cx) ** 2 + (y - cy) ** 2 < r * r
    return covered, x * x + y * y < (DIAMETER / 2) ** 2


@pytest.mark.parametrize("rate", [6.0, -6.0])
def test_particles_are_drawn_where_they_are(tmp_path, rate):
    spec = small(drum={"rotation_rate": rate}, duration={"seconds": 0.1}, snapshots={"interval": 0})
    assert run(write_spec(tmp_path, spec), tmp_path / "job")[0] == 0
    large, little = (read_png(tmp_path / "job" / name) for name in ("picture.png", "picture-96.png"))
    assert large.shape == (640, 640, 4) and little.shape == (96, 96, 4)
    covered, inside = discs(tmp_path / "job/snapshots/000000.hdf", 640)
    assert 0.2 < covered[inside].mean() < 0.8
    opaque = large[:, :, 3] == 1
    assert numpy.mean((opaque != covered)[inside]) < 0.002  # but for pixels that an edge goes through
    outside = numpy.hypot(*numpy.meshgrid(*[numpy.arange(640) - 319.5] * 2)) > 640 / MARGIN / 2 + 5
    assert numpy.all(large[outside & ~covered, 3] == 0)
    colours = numpy.unique((large[covered] * 255).round().astype(int), axis=0)
    assert 30 < len(colours) < 250  # shaded, and of several speeds
    assert (little[:, :, 3] > 0.9).mean() == pytest.approx(covered.mean(), abs=0.05)  # and the wall


def test_a_picture_is_sent_in_two_sizes_and_a_job_without_one_says_so(daemon):
    job = daemon.submit(SPEC)
    granule = requests.post(f"{daemon.url}/processes/granule/execution", json={"inputs": {"friction": 0.5}}, timeout=30).json()["jobID"]
    assert daemon.ended(job)["status"] == daemon.ended(granule)["status"] == "successful"
    for query, width in (("", 640), ("?width=640", 640), ("?width=96", 96)):
        answer = daemon.get(f"/jobs/{job}/picture.png{query}")
        assert answer.status_code == 200 and answer.headers["Content-Type"] == "image/png"
        assert answer.content[:8] == b"\x89PNG\r\n\x1a\n" and answer.content[16:24] == width.to_bytes(4, "big") * 2
        again = daemon.get(f"/jobs/{job}/picture.png{query}", headers={"If-None-Match": answer.headers["ETag"]})
        assert again.status_code == 304 and "inline" in answer.headers["Content-Disposition"]
    links = [{link["rel"]: link["href"] for link in daemon.job(one)["links"] if link["type"] != "application/x-hdf5"} for one in (job, granule)]
    assert all(daemon.get(links[0][rel]).status_code == 200 for rel in ("picture", "frames", "fields")) and not {"picture", "frames", "fields"} & set(links[1])
    none = daemon.get(f"/jobs/{granule}/picture.png?width=96")
    assert none.status_code == 404 and re.search("has no picture-96.png; it is there some seconds after the start.* a granule has none", none.json()["detail"])
    assert daemon.get(f"/jobs/{job}/picture.png?width=97").status_code == 400
