"""What a run says of what it cannot know: in results, in print, in warnings beforehand, in SQL, studies and CSV."""
import csv
import io
import json
import subprocess

import pytest
import requests
from worker_runs import REPOSE, result, run, small, write_spec

ONE_SPHERE = {"drum": {"diameter": 0.04, "length": 0.012, "rotation_rate": 6}, "particles": [{"diameter": 0.002}],
              "start": {"particles": [{"position": [0.0, -0.015, 0.0]}]}, "duration": {"seconds": 0.1}, "seed": 1}


def finished(folder, spec):
    path = write_spec(folder, spec)
    code, printed, errors = run(path, folder / "job")
    assert code == 0, errors
    return result(folder / "job"), printed


def checked(folder, spec):
    done = subprocess.run([REPOSE, "check", write_spec(folder, spec)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return {warning["field"]: warning["text"] for warning in json.loads(done.stdout)["warnings"]}


@pytest.mark.parametrize("places", [[[0, -0.015, 0]], [[0.004 * k - 0.008, -0.017, 0] for k in range(5)]])
def test_one_sphere_or_a_handful_have_neither_angle_nor_avalanches(tmp_path, places):
    spec = {"inputs": {**ONE_SPHERE, "start": {"particles": [{"position": place} for place in places]}}}
    found, printed = finished(tmp_path, spec)
    repose, regime = found["repose"], found["regime"]
    assert all(repose[name] is None for name in ("angle_deg", "standard_error_deg", "minimum_deg", "maximum_deg", "steady"))
    assert set(repose["other_methods"].values()) == set(repose["other_methods_standard_error_deg"].values()) == {None}
    assert repose["verdict"] == "too-few" and repose["slumps"]["count"] is None
    assert regime["name"] is None and regime["certain"] is None
    assert "not measured" in printed and "not known" in printed
    assert "no angle" in checked(tmp_path, spec)["/inputs/particles"]


@pytest.mark.parametrize("duration", [{"seconds": 0.01}, {"revolutions": 0.05}, {"revolutions": 0.3}, {"revolutions": 0.45}])
def test_a_run_of_less_than_half_a_revolution_cannot_know(tmp_path, duration):
    spec = small(duration=duration, contact={"friction": 0.5, "maximum_overlap": 0.03})
    found, printed = finished(tmp_path, spec)
    assert found["repose"]["verdict"] == "too-short" and found["repose"]["steady"] is None
    assert found["regime"]["certain"] in (False, None)
    if found["repose"]["angle_deg"] is not None:
        assert "too short to tell" in printed and "not certain" in printed
    assert "too short" in checked(tmp_path, spec)["/inputs/duration"]


def test_what_can_know_is_not_warned_of(tmp_path):
    assert checked(tmp_path, small(duration={"revolutions": 2})) == {}


def test_verdicts_stand_in_lists_tables_and_studies(fake):
    words = {"alike": ["steady"], "short": ["steady", "too-short", "steady"], "mixed": ["steady", "too-short", "drifting"]}
    cases = [{"name": name, "inputs": {"seed": 0}, "label": {"verdicts": " ".join(words[name])}} for name in words]
    study = requests.post(f"{fake.url}/studies", timeout=60,
                          json={"name": "verdicts", "base": {"inputs": small()["inputs"]}, "repeats": 3, "cases": cases})
    assert study.status_code == 201, study.text
    study = study.json()["studyID"]
    assert fake.get(f"/studies/{study}?wait=60").json()["status"] == "successful"
    rows = {row["case"]: row for row in fake.get(f"/studies/{study}/results").json()["cases"]}
    told = {name: (row["verdict"], row["steady"], row["certain"]) for name, row in rows.items()}
    assert told["alike"] == ("steady", True, True)
    assert (sorted(told["short"][0].split(", ")), *told["short"][1:]) == (["steady 2", "too-short 1"], None, False)
    assert (sorted(told["mixed"][0].split(", ")), *told["mixed"][1:]) == (["drifting 1", "steady 1", "too-short 1"], False, False)
    lines = {line["case"]: line for line in csv.DictReader(io.StringIO(fake.get(f"/studies/{study}/results.csv").text))}
    assert {name: (line["verdict"], line["steady"], line["certain"]) for name, line in lines.items()} == {
        name: (word, {True: "true", False: "false", None: ""}[steady], {True: "true", False: "false"}[certain])
        for name, (word, steady, certain) in told.items()}
    sql = ("select verdict, count(*), count(steady), sum(certain), max(drift_bound_deg_per_revolution), max(layers)"
           " from run_summary group by verdict order by verdict")
    assert fake.get("/query", params={"sql": sql}).json()["rows"] == [
        ["drifting", 1, 1, 1, 0.4, 6.5], ["steady", 6, 6, 6, 0.4, 6.5], ["too-short", 2, 0, 0, 0.4, 6.5]]
    for table in ("repose_result", "run_summary"):
        sql = f"select distinct window_revolutions, window_correlation_times from {table}"
        assert fake.get("/query", params={"sql": sql}).json()["rows"] == [[2.5, 30.0]]
    summaries = [job["summary"] for job in fake.get(f"/jobs?study={study}&limit=20").json()["jobs"]]
    assert sorted((one["verdict"], one.get("steady"), one["certain"]) for one in summaries if one["verdict"] != "steady") == [
        ("drifting", False, True), ("too-short", None, False), ("too-short", None, False)]
