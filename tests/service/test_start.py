"""Runs that start from a bed made before: a file, a job of the daemon, or particles one by one."""
import copy
import hashlib
import json
import os
import shutil
import subprocess

import h5py
import numpy
import pytest
import requests
import worker_runs as worker
from conftest import SPEC

CLUSTERS = [{"diameter": 0.003, "share": 0.6}, {"shape": "dumbbell", "diameter": 0.0016, "share": 0.4}]


def starting(**changes):
    spec = worker.small(**changes)
    spec["inputs"]["duration"] = {"seconds": 0.3}
    return spec


def of_clusters(intervals, **changes):
    """So many intervals of 2000 steps. The stiffness is what makes the step: the run says it."""
    spec = worker.small(particles=CLUSTERS, contact={"maximum_overlap": 0.05}, **changes)
    step = json.loads(subprocess.run([worker.REPOSE, "check", "-"], input=json.dumps(spec), capture_output=True, text=True,
                                     check=True).stdout)["estimate"]["time_step"]
    spec["inputs"]["snapshots"] = {"interval": 2000 * step}
    spec["inputs"]["duration"] = {"seconds": intervals * 2000 * step}
    return spec


def run(folder, name, spec, *options):
    code, _, errors = worker.run(worker.write_spec(folder, spec, name + ".json"), folder / name, *options, cwd=folder)
    assert code == 0, errors
    return folder / name


def places(snapshot):
    with h5py.File(snapshot) as file:
        return file["VTKHDF/Points"][:]


@pytest.fixture(scope="module")
def bed(tmp_path_factory):
    """A run of spheres and dumbbells with seven snapshots, whose interval is a whole number of steps."""
    folder = tmp_path_factory.mktemp("bed")
    run(folder, "first", of_clusters(6))
    return folder


def test_a_run_from_the_end_of_another_goes_on_with_the_bits_it_would_have_had(bed):
    """The first half ends at the fourth snapshot; its last checkpoint is that end. A second run of the same inputs from there
    takes the snapshots that the whole run took after that."""
    half = of_clusters(3)
    run(bed, "half", half)
    half["inputs"]["start"] = {"file": "half/checkpoint.hdf"}
    run(bed, "rest", half)
    for number in range(4):
        assert (places(bed / f"rest/snapshots/00000{number}.hdf") == places(bed / f"first/snapshots/00000{number + 3}.hdf")).all()
    events = worker.events(bed / "rest")
    assert events[0]["step"] == 0 and events[0]["time"] == 0.0 and not events[0]["resumed"]
    assert worker.result(bed / "rest")["run"]["settling_seconds"] == 0


def test_a_run_from_a_snapshot_has_the_snapshots_particles(bed):
    spec = starting(particles=CLUSTERS, start={"file": "first/snapshots/000002.hdf"},
                    drum={"rotation_rate": 3.0}, contact={"friction": 0.6})
    spec["inputs"]["duration"] = {"seconds": 0.02}
    run(bed, "from_snapshot", spec)
    then, now = (places(bed / name) for name in ("first/snapshots/000002.hdf", "from_snapshot/snapshots/000000.hdf"))
    # positions of single precision, put together from the cluster's first sphere: a few roundings of 15 mm
    assert numpy.abs(then - now).max() < 1e-8
    with h5py.File(bed / "first/snapshots/000002.hdf") as one, h5py.File(bed / "from_snapshot/snapshots/000000.hdf") as other:
        for name in ("velocity", "angular_velocity", "orientation", "species", "cluster"):
            a, b = one["VTKHDF/PointData/" + name][:], other["VTKHDF/PointData/" + name][:]
            # A sphere of a cluster moves by v + omega x r with the r of the middle of a step. A snapshot has the r of the step's
            # end, which is omega dt/2 further. The cluster's v is put together from its first sphere, so the second one is off
            # by both: omega^2 dt/2 times the distance between them.
            spin2 = numpy.square(one["VTKHDF/PointData/angular_velocity"][:]).sum(axis=1).max()
            beside = spin2 * 0.0016 * worker.result(bed / "first")["run"]["time_step"] / 2 if name == "velocity" else 0.0
            assert numpy.abs(a - b).max() < beside + 2e-6 * max(1e-3, numpy.abs(a).max()), name
        assert one["VTKHDF/FieldData/drum_angle"][0] == pytest.approx(6.0 * one["VTKHDF/FieldData/time"][0], rel=1e-12)
        assert other["VTKHDF/FieldData/drum_angle"][0] == one["VTKHDF/FieldData/drum_angle"][0]


def test_an_interrupted_run_from_a_file_goes_on_although_the_file_is_gone(bed, tmp_path):
    shutil.copytree(bed / "first", tmp_path / "first")
    spec = of_clusters(6)
    spec["inputs"]["start"] = {"file": "first/checkpoint.hdf"}
    whole = run(tmp_path, "whole", spec)
    path = worker.write_spec(tmp_path, spec, "again.json")
    process = worker.start(path, tmp_path / "again", "--checkpoint-seconds", 0, cwd=tmp_path)
    worker.wait_until(lambda: len(worker.events(tmp_path / "again", "checkpoint")) > 2)
    process.terminate()
    assert process.wait(30) == 3
    process.communicate()
    shutil.rmtree(tmp_path / "first" / "snapshots")
    code, _, errors = worker.run(path, tmp_path / "again", cwd=tmp_path)
    assert code == 0, errors
    assert worker.timeless_result(tmp_path / "again") == worker.timeless_result(whole)
    assert worker.snapshot_bytes(tmp_path / "again") == worker.snapshot_bytes(whole)


def test_an_attempt_that_finds_the_end_but_no_result_makes_the_same_result(bed):
    spec = worker.small(duration={"until_standard_error_deg": 10.0, "at_most_revolutions": 10})
    folder = run(bed, "known", spec)
    before = worker.timeless_result(folder)
    assert before["run"]["ended_by"] == "standard-error"
    (folder / "result.json").unlink()
    run(bed, "known", spec)
    assert worker.timeless_result(folder) == before


def test_files_that_are_no_beds_or_of_another_drum_are_told(bed, tmp_path):
    spec = starting(particles=CLUSTERS, start={"file": "missing.hdf"})
    code, out, _ = worker.run(worker.write_spec(tmp_path, spec), tmp_path / "out", cwd=bed)
    assert code == 2 and 'is \\"missing.hdf\\", which No such file or directory' in out
    (tmp_path / "text.hdf").write_text("no bed")
    spec["inputs"]["start"]["file"] = str(tmp_path / "text.hdf")
    code, out, _ = worker.run(worker.write_spec(tmp_path, spec), tmp_path / "out", cwd=bed)
    assert code == 2 and "is no snapshot or checkpoint of a run" in out
    spec["inputs"]["start"]["file"] = "first/checkpoint.hdf"
    spec["inputs"]["drum"]["length"] = 0.011
    spec["inputs"]["particles"] = [{"diameter": 0.003}]
    code, out, _ = worker.run(worker.write_spec(tmp_path, spec), tmp_path / "out", cwd=bed)
    pointers = [problem["pointer"] for problem in json.loads(out)["errors"]]
    assert code == 2 and "/inputs/drum/length" in pointers, out


def test_one_particle_placed_by_hand_falls_and_rolls_to_rest(tmp_path):
    spec = starting(particles=[{"diameter": 0.003}],
                    start={"particles": [{"position": [0.002, -0.01, 0.0], "velocity": [0.1, 0, 0]}]})
    folder = run(tmp_path, "one", spec)
    first = places(folder / "snapshots/000000.hdf")
    assert first.shape == (1, 3) and numpy.abs(first[0] - [0.002, -0.01, 0]).max() < 1e-9
    last = places(folder / "snapshots/000003.hdf")[0]
    assert 0.0134 < numpy.hypot(last[0], last[1]) < 0.0136  # against the wall, 15 mm less a radius
    assert worker.result(folder)["run"]["particles"] == 1


def test_ten_thousand_particles_placed_by_hand_are_kept_in_full(tmp_path):
    grid = [[0.0031 * i - 0.05, 0.0031 * j - 0.1, 0.0031 * k - 0.03] for i in range(33) for j in range(14) for k in range(20)]
    assert len(grid) == 9240
    spec = starting(particles=[{"diameter": 0.003}], drum={"diameter": 0.3, "length": 0.07}, start={"particles": [
        {"position": place} for place in grid]})
    spec["inputs"]["duration"] = {"seconds": 0.002}
    folder = run(tmp_path, "many", spec)
    assert len(json.loads((folder / "spec.json").read_text())["inputs"]["start"]["particles"]) == 9240
    with h5py.File(folder / "snapshots/000000.hdf") as file:
        assert numpy.abs(file["VTKHDF/Points"][:] - grid).max() < 1e-7
        assert json.loads(file["run"].attrs["params_json"])["inputs"]["start"]["particles"] == 9240


# ---- through the daemon ----

def problems_of(answer):
    assert answer.status_code == 400, answer.text
    return {error["pointer"]: error["detail"] for error in answer.json()["errors"]}


def without_fill(**changes):
    inputs = copy.deepcopy(SPEC)
    del inputs["fill_fraction"]
    inputs.update(changes)
    return inputs


def test_jobs_start_from_jobs_and_need_them_no_more(daemon):
    first = daemon.submit()
    assert daemon.ended(first)["status"] == "successful"
    number = daemon.get(f"/jobs/{first}/snapshots").json()["snapshots"][1]["number"]
    jobs = [daemon.submit(without_fill(start={"job": first})),
            daemon.submit(without_fill(start={"job": first, "snapshot": number}, drum={**SPEC["drum"], "rotation_rate": 3.0}))]
    shutil.rmtree(daemon.data / "jobs" / first)
    counts = set()
    for job in jobs:
        assert daemon.ended(job)["status"] == "successful", daemon.get(f"/jobs/{job}/log").text
        counts.add(daemon.get(f"/jobs/{job}/results").json()["run"]["particles"])
        assert daemon.get(f"/jobs/{job}/results").json()["run"]["settling_seconds"] == 0
        assert daemon.get(f"/jobs/{job}/spec").json()["inputs"]["start"]["job"] == first
    assert len(counts) == 1


def sealed_again(path):
    """The file's last line made to fit what is before it: CRC-64 of ECMA-182, reflected."""
    table = []
    for byte in range(256):
        for _ in range(8):
            byte = byte >> 1 ^ (0xC96C5795D7870F42 if byte & 1 else 0)
        table.append(byte)
    text, crc = path.read_bytes()[:-23], 0xFFFFFFFFFFFFFFFF
    for byte in text:
        crc = table[(crc ^ byte) & 255] ^ crc >> 8
    path.write_bytes(text + f"crc64 {crc ^ 0xFFFFFFFFFFFFFFFF:016x}\n".encode())


def test_a_bed_that_was_changed_after_it_was_given_is_refused_whatever_its_checksum_says(daemon):
    first = daemon.submit()
    assert daemon.ended(first)["status"] == "successful"
    mine = daemon.data / "jobs" / first / "checkpoint.hdf"
    before = mine.read_bytes()
    sealed_again(mine)
    assert mine.read_bytes() == before  # so it is the checksum that is written
    blockers = [daemon.submit({**SPEC, "duration": {"seconds": 40}}) for _ in range(os.cpu_count() + 2)]
    try:
        changed = daemon.submit(without_fill(start={"job": first}, duration={"seconds": 40}))  # a short one would not wait
        folder = daemon.data / "jobs" / changed
        assert (folder / "start.hdf.sha256").read_text() == hashlib.sha256(before).hexdigest() + "\n"
        assert daemon.job(changed)["status"] == "accepted"
        at = before.index(b"walton-braun")
        with open(mine, "r+b") as file:  # as only the first job's worker could: in place
            file.seek(at)
            file.write(b"W")
        sealed_again(mine)
        assert os.path.samefile(mine, folder / "start.hdf")
    finally:
        for job in blockers:
            requests.delete(f"{daemon.url}/jobs/{job}", timeout=30)
    ended = daemon.ended(changed)
    assert ended["status"] == "failed" and "SHA-256" in ended["message"] and hashlib.sha256(before).hexdigest() in ended["message"]
    again = daemon.submit(without_fill(start={"job": first}))  # given as it is now, it is refused by nothing but what is in it
    assert "SHA-256" not in daemon.ended(again)["message"]


def test_what_a_job_can_not_start_from_is_told(daemon):
    first = daemon.submit()
    daemon.ended(first)
    unknown = "20200101-000000-00000000"
    told = problems_of(daemon.post(without_fill(start={"job": unknown})))
    assert told["/inputs/start/job"] == f'is "{unknown}"; there is no such job'
    told = problems_of(daemon.post(without_fill(start={"job": first, "snapshot": 99})))
    assert told["/inputs/start/snapshot"].startswith("is 99, which the job")
    told = problems_of(daemon.post(without_fill(start={"file": "/etc/passwd"})))
    assert told["/inputs/start/file"].startswith("is for `repose run` alone")
    told = problems_of(daemon.post(without_fill(start={"job": first}, particles=[{"diameter": 0.0039, "density": 1000}],
                                                drum={**SPEC["drum"], "diameter": 0.05})))
    assert set(told) == {"/inputs/drum/diameter", "/inputs/particles/0/diameter", "/inputs/particles/0/density"}
    told = problems_of(daemon.post({**SPEC, "start": {"job": first}, "fill_fraction": 0.35}))
    assert "as many as the bed that it starts from has" in told["/inputs/fill_fraction"]


def test_one_bed_serves_a_whole_study(daemon):
    first = daemon.submit()
    daemon.ended(first)
    study = {"base": {"inputs": without_fill(start={"job": first})},
             "vary": {"/inputs/drum/rotation_rate": [3.0, 6.0], "/inputs/contact/friction": [0.2, 0.6]}}
    answer = requests.post(daemon.url + "/studies", json=study, timeout=30)
    assert answer.status_code == 201, answer.text
    made = answer.json()["studyID"] if "studyID" in answer.json() else answer.headers["Location"].rsplit("/", 1)[1]
    shutil.rmtree(daemon.data / "jobs" / first)
    for job in daemon.get(f"/jobs?study={made}").json()["jobs"]:
        assert daemon.ended(job["jobID"])["status"] == "successful", daemon.get(f"/jobs/{job['jobID']}/log").text
    study["repeats"] = 2
    assert "/repeats" in problems_of(requests.post(daemon.url + "/studies", json=study, timeout=30))
