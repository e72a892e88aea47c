"""fields.hdf as other programs see it: h5py, and VTK's own reader of images."""
import math

import h5py
import numpy
import pytest
from worker_runs import result, run, small, write_spec

D, DRUM, LENGTH = 0.003, 0.03, 0.01  # of worker_runs' small drum


@pytest.fixture(scope="module")
def job(tmp_path_factory):
    folder = tmp_path_factory.mktemp("fields")
    code, _, stderr = run(write_spec(folder, small(duration={"revolutions": 1.0})), folder / "job")
    assert code == 0, stderr
    return folder / "job"


def test_the_fields_hold_every_particle_and_their_mean_velocity_is_the_beds(job):
    with h5py.File(job / "fields.hdf") as file:
        solid, velocity = file["fields/solid_fraction"][:], file["fields/velocity"][:]
        temperature, samples = file["fields/granular_temperature"][:], file["fields/samples"][:]
        frames = file["fields"].attrs["frames"]
    cells = math.ceil(DRUM / (D / 2))
    assert solid.shape == (cells, cells) and velocity.shape == (cells, cells, 3)
    volume = solid.sum() * (DRUM / cells) ** 2 * LENGTH
    assert volume == pytest.approx(result(job)["run"]["particles"] * math.pi / 6 * D ** 3, rel=1e-5)
    # a revolution in 1.05 s at 20 frames or more a second, the first quarter left out
    assert 0.7 * result(job)["run"]["samples"] < frames < 0.8 * result(job)["run"]["samples"]
    # seen where there are spheres and nowhere else
    assert numpy.array_equal(solid > 0, samples > 0) and numpy.array_equal(solid > 0, ~numpy.isnan(velocity[..., 0]))
    assert (temperature[~numpy.isnan(temperature)] >= 0).all()
    # y grows with the rows: the bed lies below, rises on the right and goes down along its surface
    assert solid[: cells // 2].sum() > 2 * solid[cells // 2:].sum()
    assert solid[:, cells // 2:].sum() > solid[:, : cells // 2].sum()
    dense = solid > 0.3
    assert dense.sum() > cells
    # near the wall at the bottom the bed goes with the drum, at omega R less what it slips
    bottom = velocity[1, cells // 2]
    assert 0.3 * 6 * DRUM / 2 < bottom[0] < 1.2 * 6 * DRUM / 2


def test_vtk_reads_them_as_an_image_over_the_drum(job):
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOHDF import vtkHDFReader

    reader = vtkHDFReader()
    reader.SetFileName(str(job / "fields.hdf"))
    reader.Update()
    image = reader.GetOutput()
    cells = math.ceil(DRUM / (D / 2))
    assert image.GetClassName() == "vtkImageData" and image.GetDimensions() == (cells, cells, 2)
    corner = -DRUM / 2 + DRUM / cells / 2
    assert image.GetOrigin() == pytest.approx([corner, corner, -LENGTH / 2])
    assert image.GetSpacing() == pytest.approx([DRUM / cells, DRUM / cells, LENGTH])
    with h5py.File(job / "fields.hdf") as file:
        for name in ("solid_fraction", "velocity", "granular_temperature", "samples"):
            array = image.GetPointData().GetArray(name)
            assert array.GetNumberOfComponents() == (3 if name == "velocity" else 1)
            for layer in vtk_to_numpy(array).reshape(2, -1):
                assert numpy.array_equal(layer, file[f"fields/{name}"][:].ravel(), equal_nan=True)


def test_the_type_attribute_is_a_fixed_ascii_string(job):
    with h5py.File(job / "fields.hdf") as file:
        kind = h5py.h5a.open(file["VTKHDF"].id, b"Type").get_type()
        assert not kind.is_variable_str() and kind.get_cset() == h5py.h5t.CSET_ASCII
        assert file["VTKHDF"].attrs["Type"] == b"ImageData" and list(file["VTKHDF"].attrs["Version"]) == [1, 0]
