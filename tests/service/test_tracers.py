"""The paths of a few particles, beside the snapshots of all, and over an interruption."""
import csv
import signal

import h5py
import numpy
import pytest
import requests

from conftest import SPEC
from worker_runs import events, run, small, start, wait_until, write_spec

FOLLOWED = [3, 0, 90]


def spec(**changes):
    return small(tracers=FOLLOWED, samples={"interval": 0.025}, snapshots={"interval": 0.05}, duration={"seconds": 1.0}, **changes)


@pytest.fixture(scope="module", params=[6.0, -6.0], ids=["forward", "the other way"])
def job(request, tmp_path_factory):
    folder = tmp_path_factory.mktemp("tracers")
    changes = {"drum": {"rotation_rate": request.param}}
    code, _, stderr = run(write_spec(folder, spec(**changes)), folder / "job")
    assert code == 0, stderr
    return folder / "job", changes


def snapshots(folder):
    """time: {(place, velocity, spin) of the followed}"""
    found = {}
    for path in sorted((folder / "snapshots").glob("*.hdf")):
        with h5py.File(path) as file:
            at = file["VTKHDF/PointData"]
            found[round(float(file["VTKHDF/FieldData/time"][0]), 6)] = (file["VTKHDF/Points"][:][FOLLOWED], at["velocity"][:][FOLLOWED],
                                                                 at["angular_velocity"][:][FOLLOWED])
    return found


def test_paths_are_those_of_the_snapshots(job):
    folder, _ = job
    with h5py.File(folder / "tracers.hdf") as file:
        times, who = file["tracers/time"][:], file["tracers/particle"][:]
        paths = [file[f"tracers/{name}"][:] for name in ("position", "velocity", "angular_velocity")]
        assert file["tracers/position"].attrs["units"] == b"m"
    assert list(who) == FOLLOWED and len(times) == len(events(folder, "sample")) == len(paths[0]) > 30
    seen = 0
    for time, there in snapshots(folder).items():
        k = int(numpy.argmin(abs(times - time)))
        if abs(times[k] - time) > 1e-6:
            continue
        seen += 1
        assert all(numpy.allclose(path[k], one, rtol=1e-6, atol=1e-9) for path, one in zip(paths, there))
    assert seen > 10
    with (folder / "tracers.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(times) * len(FOLLOWED)
    for k, row in enumerate(rows):
        sample, p = divmod(k, len(FOLLOWED))
        assert int(row["particle"]) == FOLLOWED[p] and float(row["time"]) == pytest.approx(times[sample], abs=1e-9)
        assert [float(row[c]) for c in ("x", "y", "z")] == pytest.approx(list(paths[0][sample, p]), rel=1e-6, abs=1e-9)


def test_a_killed_run_has_the_same_paths(job, tmp_path):
    folder, changes = job
    request, out = write_spec(tmp_path, spec(**changes)), tmp_path / "job"
    worker = start(request, out, "--checkpoint-seconds", 0.05)
    wait_until(lambda: worker.poll() is not None or any(event["time"] > 0.1 for event in events(out, "checkpoint")))
    worker.send_signal(signal.SIGKILL)
    worker.communicate(timeout=20)
    code, _, stderr = run(request, out, "--attempt", 2)
    assert code == 0, stderr
    assert all((out / name).read_bytes() == (folder / name).read_bytes() for name in ("tracers.csv", "tracers.hdf"))


def test_tracers_that_are_no_particles_are_named_all_at_once(daemon):
    answer = requests.post(f"{daemon.url}/processes/drum/execution", json={"inputs": spec()["inputs"] | {"tracers": [5, 1.5, 5, 1e5]}}, timeout=30)
    problems = {error["pointer"]: error["detail"] for error in answer.json()["errors"]}
    assert set(problems) == {"/inputs/tracers/1", "/inputs/tracers/2", "/inputs/tracers/3"}
    assert "whole" in problems["/inputs/tracers/1"] and "once" in problems["/inputs/tracers/2"] and "at most" in problems["/inputs/tracers/3"]


def test_a_job_links_to_the_paths_that_it_has(daemon):
    jobs = [daemon.submit(SPEC | more) for more in ({"tracers": [2, 0]}, {})]
    assert all(daemon.ended(job)["status"] == "successful" for job in jobs)
    links = [{link["type"]: link["href"] for link in daemon.job(job)["links"] if link["rel"] == "tracers"} for job in jobs]
    listed = {job["jobID"]: job for job in daemon.get("/jobs").json()["jobs"]}
    assert set(links[0]) == {"text/csv", "application/x-hdf5"} and not links[1]
    assert all(daemon.get(href).headers["Content-Type"].startswith(kind) for kind, href in links[0].items())
    assert [listed[job]["summary"].get("tracers") for job in jobs] == [2, None]
    assert [len([link for link in listed[job]["links"] if link["rel"] == "tracers"]) for job in jobs] == [2, 0]
