"""draw_drum.py on a made-up snapshot whose surface has a known place and slope."""
import json
import sys
from pathlib import Path

import h5py
import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "reproduce"))
import draw_drum  # noqa: E402

DIAMETER, ANGLE = 0.126, np.radians(25.0)


def make_snapshot(path, lining, offset=-0.01):
    """A bed on a square lattice below a plane through the drum, of two sizes by species."""
    spacing = 0.004
    x, y, z = (a.ravel() for a in np.meshgrid(*[np.arange(-0.06, 0.06, spacing)] * 2, [-0.004, 0.0, 0.004]))
    along, above = np.cos(ANGLE) * x + np.sin(ANGLE) * y, -np.sin(ANGLE) * x + np.cos(ANGLE) * y
    inside = (np.hypot(x, y) < 0.058) & (above < offset)
    position = np.column_stack([x, y, z])[inside].astype("f4")
    species = (np.arange(len(position)) % 2).astype("i4")
    spec = {"process": "drum", "inputs": {"drum": {"diameter": DIAMETER}, "wall": {"lining": lining}}, "label": {}}
    with h5py.File(path, "w") as file:
        file["VTKHDF/Points"] = position
        file["VTKHDF/PointData/radius"] = np.where(species == 0, 0.002, 0.001).astype("f4")
        file["VTKHDF/PointData/species"] = species
        file["VTKHDF/PointData/velocity"] = np.column_stack([along[inside], 0 * species, 0 * species]).astype("f4")
        file["VTKHDF/FieldData/time"] = np.array([1.5])
        file.create_group("run").attrs["params_json"] = json.dumps(spec)
    return len(position)


@pytest.mark.parametrize("colour", ["speed", "species"])
@pytest.mark.parametrize("lining", [None, {"diameter": 0.00378, "pitch": 0.00378}])
def test_a_picture_is_drawn(tmp_path, colour, lining):
    make_snapshot(tmp_path / "s.hdf", lining)
    results = {"repose": {"angle_deg": 25.0, "standard_error_deg": 0.3}, "regime": {"name": "rolling"}}
    snapshot = draw_drum.read_snapshot(tmp_path / "s.hdf")
    drawn = draw_drum.draw(snapshot, results, tmp_path / "s.png", colour)
    # The slice of one diameter holds the middle layer of the three alone.
    assert drawn == len(snapshot["radius"]) // 3
    picture = draw_drum.plt.imread(tmp_path / "s.png")
    assert picture.std() > 0.05  # a blank one has none


def test_the_line_lies_on_the_surface(tmp_path):
    make_snapshot(tmp_path / "s.hdf", None, offset=-0.01)
    snapshot = draw_drum.read_snapshot(tmp_path / "s.hdf")
    # The highest centres lie up to one lattice spacing under the plane, and a radius is added to them.
    offset = draw_drum.surface_offset(snapshot, ANGLE, DIAMETER / 2)
    assert -0.01 - 0.004 < offset < -0.01 + 0.002


def test_a_run_without_an_angle_still_gives_a_picture(tmp_path):
    make_snapshot(tmp_path / "s.hdf", None)
    snapshot = draw_drum.read_snapshot(tmp_path / "s.hdf")
    draw_drum.draw(snapshot, {"repose": {"angle_deg": None}, "regime": {"name": None}}, tmp_path / "s.png")
    assert (tmp_path / "s.png").stat().st_size > 0
