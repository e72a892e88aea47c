"""ParaView itself opens what a job leaves: the snapshots as one series in time, and the walls. By its own Python, pvpython or pvbatch."""
import json
import os
import shutil
import subprocess

import h5py
import numpy
import pytest
from worker_runs import result, run, small, write_spec

PROGRAM = os.environ.get("PVPYTHON") or shutil.which("pvpython") or shutil.which("pvbatch")

SCRIPT = """
import json, sys
from paraview.simple import FetchData, OpenDataFile
from paraview import servermanager
folder, out = sys.argv[1:]
def points_of(source, time):
    source.UpdatePipeline(time)
    data = servermanager.Fetch(source)
    return {"time": time, "points": data.GetNumberOfPoints(), "bounds": data.GetBounds(), "cells": data.GetNumberOfCells(),
            "arrays": sorted(data.GetPointData().GetArrayName(k) for k in range(data.GetPointData().GetNumberOfArrays()))}
series = OpenDataFile(folder + "/snapshots.hdf.series")
walls = OpenDataFile(folder + "/walls.vtp")
json.dump({"series": [points_of(series, time) for time in series.TimestepValues], "walls": points_of(walls, 0.0)}, open(out, "w"))
"""


def can_be_run(folder):
    """Whether it is there with its modules."""
    if not PROGRAM:
        return False
    script = folder / "look.py"
    script.write_text("import paraview.simple\n")
    return subprocess.run([PROGRAM, script], capture_output=True, timeout=120).returncode == 0


def test_paraview_opens_the_series_and_the_walls(tmp_path):
    if not can_be_run(tmp_path):
        pytest.skip("no pvpython, or its modules are missing (Debian's python3-paraview takes the place of python3-vtk9); "
                    "PVPYTHON names one elsewhere")
    code, _, errors = run(write_spec(tmp_path, small(snapshots={"interval": 0.02})), tmp_path / "job")
    assert code == 0, errors
    script, out = tmp_path / "open.py", tmp_path / "seen.json"
    script.write_text(SCRIPT)
    done = subprocess.run([PROGRAM, script, tmp_path / "job", out], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    seen = json.loads(out.read_text())
    files = sorted((tmp_path / "job" / "snapshots").glob("*.hdf"))
    assert len(seen["series"]) == len(files) == result(tmp_path / "job")["run"]["snapshots"] > 2
    for step, path in zip(seen["series"], files):
        with h5py.File(path) as file:
            points = file["VTKHDF/Points"][:]
            assert step["arrays"] == sorted(file["VTKHDF/PointData"])
        assert step["points"] == len(points)
        assert numpy.allclose(numpy.reshape(step["bounds"], (3, 2)).T, [points.min(axis=0), points.max(axis=0)])
    bounds = numpy.array(seen["walls"]["bounds"])
    radius = small()["inputs"]["drum"]["diameter"] / 2
    assert seen["walls"]["cells"] > 0 and numpy.allclose(bounds[:4], [-radius, radius, -radius, radius], rtol=0.02)
