"""Several beds of a drum in one run: each is the run of one bed with its seed, whatever the number of threads and however
often the run is interrupted, and the answer is of all of them."""
import json
import signal
import statistics
import subprocess

import h5py
import numpy
import pytest
import requests
from conftest import SPEC, Daemon
from worker_runs import REPOSE, events, result, run, small, snapshot_bytes, start, timeless_result, wait_until, write_spec

SHORT = {"duration": {"seconds": 0.3}, "snapshots": {"interval": 0.1}}
# rolls, so that its angle has an error; soft, so that it is quick
ROLLING = {"drum": {"diameter": 0.1, "length": 0.03, "rotation_rate": 3.0}, "particles": [{"diameter": 0.006}],
           "contact": {"friction": 0.3, "maximum_overlap": 0.03, "restitution": 0.5}, "snapshots": {"interval": 0}}


def ran(folder, name, *options, **inputs):
    code, _, stderr = run(write_spec(folder, small(**inputs), f"{name}.json"), folder / name, *options)
    assert code == 0, stderr
    return folder / name


def answer(out):
    """Without what depends on the clock and on the threads."""
    document = timeless_result(out)
    del document["run"]["threads"]
    return document


@pytest.fixture(scope="module")
def three(tmp_path_factory):
    return ran(tmp_path_factory.mktemp("three"), "beds", "--threads", 2, beds=3, **SHORT)


def test_one_bed_is_the_run_without_a_word_of_beds(tmp_path):
    one, none = ran(tmp_path, "one", beds=1, **SHORT), ran(tmp_path, "none", **SHORT)
    assert answer(one) == answer(none) and result(one)["repose"]["beds"] is None
    assert snapshot_bytes(one) == snapshot_bytes(none)  # each has the canonical spec in it
    assert not (one / "beds").exists()


def test_the_number_of_threads_changes_nothing(three, tmp_path):
    for threads in 1, 7:
        other = ran(tmp_path, str(threads), "--threads", threads, beds=3, **SHORT)
        assert result(other)["run"]["threads"] == threads
        assert answer(other) == answer(three)
        assert snapshot_bytes(other) == snapshot_bytes(three)
        assert (other / "fields.hdf").read_bytes() == (three / "fields.hdf").read_bytes()


def test_each_bed_is_the_run_of_one_bed_with_its_seed(three, tmp_path):
    beds = result(three)["repose"]["beds"]
    assert beds[0]["seed"] == result(three)["run"]["seed"] == 7 and len({bed["seed"] for bed in beds}) == 3
    single = [ran(tmp_path, f"bed{k}", seed=bed["seed"], **SHORT) for k, bed in enumerate(beds)]
    alone = [answer(out) for out in single]
    for bed, one in zip(beds, alone):
        assert bed == {"seed": one["run"]["seed"], **{name: one["repose"][name] for name in ("angle_deg", "standard_error_deg", "verdict")}}
    together = answer(three)
    assert together["repose"]["angle_deg"] == pytest.approx(statistics.fmean(one["repose"]["angle_deg"] for one in alone), rel=1e-12)
    assert together["repose"]["minimum_deg"] == min(one["repose"]["minimum_deg"] for one in alone)
    assert together["repose"]["maximum_deg"] == max(one["repose"]["maximum_deg"] for one in alone)
    assert together["run"]["maximum_overlap"] == max(one["run"]["maximum_overlap"] for one in alone)
    for output, name in ("run", "steps"), ("run", "samples"), ("repose", "frames"):
        assert together[output][name] == sum(one[output][name] for one in alone)
    for output, name in ("packing", "solid_fraction"), ("drive", "torque"), ("repose", "interface_fluctuation"):
        assert together[output][name] == pytest.approx(statistics.fmean(one[output][name] for one in alone), rel=1e-12)
    assert together["run"]["particles"] == alone[0]["run"]["particles"]
    assert together["regime"]["certain"] is (all(one["regime"]["certain"] for one in alone) and len({one["regime"]["name"] for one in alone}) == 1)
    # what is told of one bed is the first's, and the fields are of all
    assert [e["values"] for e in events(three, "sample")] == [e["values"] for e in events(single[0], "sample")]
    with h5py.File(three / "fields.hdf") as file:
        seen = numpy.nan_to_num(file["fields/samples"][:])
    each = []
    for out in single:
        with h5py.File(out / "fields.hdf") as file:
            each.append(numpy.nan_to_num(file["fields/samples"][:]))
    assert seen.sum() > 1.5 * max(one.sum() for one in each)


@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGTERM])
def test_a_run_that_is_interrupted_again_and_again_ends_the_same(three, tmp_path, how):
    spec, out = write_spec(tmp_path, small(beds=3, **SHORT)), tmp_path / "job"
    for attempt in range(1, 5):
        saved = len(events(out, "checkpoint")) if out.exists() else 0
        worker = start(spec, out, "--attempt", attempt, "--checkpoint-seconds", 0.05, "--threads", 1 + attempt % 3)
        wait_until(lambda: len(events(out, "checkpoint")) > saved or worker.poll() is not None)
        worker.send_signal(how)
        worker.communicate(timeout=60)
    code, _, stderr = run(spec, out, "--attempt", 5, "--threads", 2)
    assert code == 0, stderr
    assert len(events(out, "start")) > 1 and events(out, "start")[-1]["resumed"] is True
    assert answer(out) == answer(three)
    assert snapshot_bytes(out) == snapshot_bytes(three)
    assert (out / "fields.hdf").read_bytes() == (three / "fields.hdf").read_bytes()
    assert list((out / "beds").iterdir()) == []  # only while it runs


@pytest.mark.torture
def test_a_bed_whose_checkpoint_is_older_or_lost_comes_to_the_same_end(tmp_path):
    """Ends by its error. Killed between the checkpoints of two beds, one is of another time than the other."""
    asked = {"beds": 2, **ROLLING, "duration": {"until_standard_error_deg": 1.0, "at_most_revolutions": 3}}
    whole = ran(tmp_path, "whole", "--threads", 2, **asked)
    found = result(whole)
    assert found["run"]["ended_by"] == "standard-error" and found["repose"]["standard_error_deg"] <= 1.0 and found["repose"]["steady"]
    spec, out = write_spec(tmp_path, small(**asked)), tmp_path / "job"
    worker = start(spec, out, "--checkpoint-seconds", 0.05)
    wait_until(lambda: len(events(out, "checkpoint")) > 2 and (out / "beds" / "001.hdf").exists())
    older = (out / "beds" / "001.hdf").read_bytes()
    saved = len(events(out, "checkpoint"))
    wait_until(lambda: len(events(out, "checkpoint")) > saved + 2 or worker.poll() is not None)
    worker.kill()
    worker.communicate()
    assert not (out / "result.json").exists()
    (out / "beds" / "001.hdf").write_bytes(older)
    stopped = start(spec, out, "--attempt", 2, "--checkpoint-seconds", 0.05, "--threads", 2)
    saved = len(events(out, "checkpoint"))
    wait_until(lambda: len(events(out, "checkpoint")) > saved or stopped.poll() is not None)
    stopped.kill()
    stopped.communicate()
    if not (out / "result.json").exists():
        for lost in (out / "beds").iterdir():
            lost.unlink()
    assert run(spec, out, "--attempt", 3)[0] == 0
    assert answer(out) == answer(whole)


def check(tmp_path, **inputs):
    path = write_spec(tmp_path, small(**inputs))
    done = subprocess.run([REPOSE, "check", path], capture_output=True, text=True, timeout=120)
    return done.returncode, json.loads(done.stdout)


def test_what_is_no_number_of_beds_is_refused(tmp_path):
    for wrong, why in (0, "is 0; must be in [1, 64]"), (65, "is 65; must be in [1, 64]"), (1.5, "is 1.5; must be"), ("two", "is \"two\"; must be"):
        code, told = check(tmp_path, beds=wrong)
        assert code == 2
        assert [(error["pointer"], error["detail"][:len(why)]) for error in told["errors"]] == [("/inputs/beds", why)]
    code, told = check(tmp_path, beds=2, particle_count=8, start={"particles": [{"position": [0, -0.01, 0.001 * k]} for k in range(2)]})
    assert code == 2 and "/inputs/beds" in [error["pointer"] for error in told["errors"]]


def test_estimates_are_of_all_beds(tmp_path):
    told = {(beds, threads): check(tmp_path, beds=beds, threads=threads)[1]["estimate"] for beds, threads in ((1, 1), (4, 1), (4, 2))}
    one, four, by_two = told.values()
    for name in "particles", "steps", "memory_bytes", "checkpoint_bytes":
        assert four[name] == pytest.approx(4 * one[name], rel=1e-9) and by_two[name] == four[name]
    assert four["snapshots"] == one["snapshots"] and four["snapshot_bytes"] == one["snapshot_bytes"]
    assert four["wall_seconds"] == pytest.approx(4 * one["wall_seconds"], rel=1e-9)
    assert by_two["wall_seconds"] <= four["wall_seconds"]


def test_the_service_counts_all_beds_and_goes_on_from_the_first(tmp_path):
    daemon = Daemon(tmp_path, options=["--max-particles", "500"]).start()
    try:
        many = daemon.post({**SPEC, "beds": 64})
        assert many.status_code == 400 and "--max-particles" in many.text
        job = daemon.submit({**SPEC, "beds": 2, "threads": 2, "snapshots": {"interval": 0}})
        assert daemon.ended(job)["status"] == "successful", daemon.get(f"/jobs/{job}/log").text
        found = daemon.get(f"/jobs/{job}/results").json()
        assert len(found["repose"]["beds"]) == 2
        assert daemon.get(f"/jobs/{job}/spec").json()["inputs"]["beds"] == 2
        rest = requests.post(f"{daemon.url}/jobs/{job}/continue", json={"seconds": 0.02}, timeout=30)
        assert rest.status_code == 201, rest.text
        rest = rest.json()["jobID"]
        assert daemon.ended(rest)["status"] == "successful", daemon.get(f"/jobs/{rest}/log").text
        assert "beds" not in daemon.get(f"/jobs/{rest}/spec").json()["inputs"]
        rows = daemon.get("/query", params={"sql": "select beds from run_summary order by beds"}).json()["rows"]
        assert [list(row.values())[0] if isinstance(row, dict) else row[0] for row in rows] == [1, 2]
    finally:
        daemon.stop()
