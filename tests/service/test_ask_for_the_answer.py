"""A run that is asked for an angle of a given error ends when it has it, or says that it never had."""
import json

from worker_runs import run, small, write_spec


def answer(folder, name, **duration):
    spec = write_spec(folder, small(duration=duration, drum={"rotation_rate": 8.0}, contact={"maximum_overlap": 0.05}), f"{name}.json")
    code, _, errors = run(spec, folder / name)
    assert code == 0, errors
    return json.loads((folder / name / "result.json").read_text())


def test_a_run_ends_as_soon_as_its_angle_is_known_well_enough(tmp_path):
    coarse = answer(tmp_path, "coarse", until_standard_error_deg=4.0, at_most_revolutions=20)
    better = 0.95 * coarse["repose"]["standard_error_deg"]
    fine = answer(tmp_path, "fine", until_standard_error_deg=better, at_most_revolutions=60)
    for result, asked in (coarse, 4.0), (fine, better):
        assert result["run"]["ended_by"] == "standard-error"
        assert result["repose"]["steady"] and result["repose"]["standard_error_deg"] <= asked
        assert result["repose"]["frames"] >= 40
    assert coarse["run"]["steps"] < fine["run"]["steps"]  # a better answer takes longer
    # the same run, only longer: the shorter one's samples are the beginning of the longer one's
    samples = [[json.loads(line) for line in (tmp_path / name / "events.ndjson").read_text().splitlines() if '"sample"' in line]
               for name in ("coarse", "fine")]
    assert samples[0] == samples[1][:len(samples[0])]
    # what was asked for by its length and ends there gives the same numbers
    same = answer(tmp_path, "same", seconds=coarse["run"]["simulated_seconds"])
    assert same["run"]["ended_by"] == "duration" and same["run"]["steps"] == coarse["run"]["steps"]
    last = sorted((tmp_path / "coarse" / "snapshots").glob("*.hdf"))[-1]
    assert coarse["run"]["snapshots"] == len(list((tmp_path / "coarse" / "snapshots").glob("*.hdf"))) and last.stat().st_size > 0


def test_an_error_out_of_reach_ends_at_the_bound_and_says_so(tmp_path):
    result = answer(tmp_path, "never", until_standard_error_deg=0.01, at_most_revolutions=2)
    assert result["run"]["ended_by"] == "at-most-revolutions"
    assert result["repose"]["standard_error_deg"] is None and result["repose"]["verdict"] == "too-short"  # it slips at the wall
