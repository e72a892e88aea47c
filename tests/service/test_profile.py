"""`repose run --profile`: where a run's time went."""
import json
import time

from worker_runs import run, small, timeless_result, write_spec

STEP_PARTS = ["outer list", "inner list", "pairs", "walls", "motion", "container"]


def test_a_profiled_run_has_the_same_result_and_parts_that_make_up_its_time(tmp_path):
    spec = write_spec(tmp_path, small(duration={"seconds": 0.5}))
    assert run(spec, tmp_path / "plain")[0] == 0
    begin = time.monotonic()
    code, stdout, stderr = run(spec, tmp_path / "job", "--profile")
    took = time.monotonic() - begin
    assert code == 0, stderr
    assert timeless_result(tmp_path / "job") == timeless_result(tmp_path / "plain")
    assert not (tmp_path / "plain" / "profile.json").exists()

    profile = json.loads((tmp_path / "job" / "profile.json").read_text())
    seconds = {part["part"]: part["seconds"] for part in profile["parts"]}
    assert list(seconds) == ["making the bed", *STEP_PARTS, "measures", "snapshots", "checkpoints", "everything else"]
    assert all(value >= 0 for value in seconds.values())  # also the rest: laps never overlap
    assert 0 < profile["seconds"] <= took
    # Nothing of weight happens in a run outside the parts that are named.
    assert seconds["everything else"] < 0.25 * profile["seconds"]
    assert seconds["pairs"] > 0 and seconds["motion"] > 0 and seconds["measures"] > 0
    for name in seconds:
        assert name in stdout


def test_a_profile_counts_the_pairs_that_the_results_count(tmp_path):
    code, _, stderr = run(write_spec(tmp_path, small(duration={"seconds": 0.5})), tmp_path / "job", "--profile")
    assert code == 0, stderr
    profile = json.loads((tmp_path / "job" / "profile.json").read_text())
    packing = timeless_result(tmp_path / "job")["packing"]
    # The coordination number is a mean over the window alone and leaves the wall out or not: half of it is what the profile
    # has to within that difference, the wall's share in so small a drum.
    assert 0.7 < profile["touching_pairs_a_sphere"] / (0.5 * packing["coordination_number"]) < 1.3
    assert 0.2 < profile["gigahertz"] < 8  # a core's, whichever
