"""The second process, end to end: a particle on the wall of a rotating cylinder."""
import json
import math
import subprocess
from pathlib import Path

import pytest
import requests

from conftest import BUILD

ROOT = Path(__file__).resolve().parents[2]
EXAMPLE = json.loads((ROOT / "api/examples/granule.json").read_text())


def post(daemon, inputs, **label):
    return requests.post(f"{daemon.url}/processes/granule/execution", json={"inputs": inputs, "label": label}, timeout=30)


def results_of(daemon, inputs):
    answer = post(daemon, inputs)
    assert answer.status_code == 201, answer.text
    job = daemon.job(answer.json()["jobID"], wait=20)
    assert job["status"] == "successful", job
    return job, daemon.get(f"/jobs/{job['jobID']}/results").json()


def test_the_example_is_posted_run_and_answered(daemon):
    answer = requests.post(f"{daemon.url}/processes/granule/execution", json=EXAMPLE, timeout=30)
    assert answer.status_code == 201, answer.text
    assert answer.json()["processID"] == "granule" and answer.json()["estimate"]["wall_seconds"] < 1
    job = daemon.job(answer.json()["jobID"], wait=20)
    assert job["status"] == "successful" and job["progress"] == 100, job
    summary = job["summary"]
    assert summary["friction"] == 0.5 and summary["radius"] == 0.063 and summary["rotation_rate"] == 18.0
    assert summary["regime"] == "sliding"
    granule = daemon.get(f"/jobs/{job['jobID']}/results").json()["granule"]
    assert granule["minimum_omega2"] == pytest.approx(1.826, abs=5e-4)  # Omega^2 for mu = 0.5, to three decimals
    assert granule["minimum_rotation_rate"] == pytest.approx(math.sqrt(granule["minimum_omega2"] * 9.81 / 0.063), rel=1e-12)
    assert summary["minimum_rotation_rate"] == pytest.approx(granule["minimum_rotation_rate"], rel=1e-14)  # 15 digits
    assert 0 < granule["error"] < 1.1e-9  # half the tolerance, which is the default, and rounding
    # The spec that is run is the one asked for with its defaults, and can be posted again as it is.
    spec = daemon.get(f"/jobs/{job['jobID']}/spec").json()
    assert spec["inputs"] == EXAMPLE["inputs"] | {"revolutions": 30, "gravity": 9.81, "tolerance": 1e-9}
    assert requests.post(f"{daemon.url}/processes/granule/execution", json=spec, timeout=30).status_code == 201


def test_without_a_rate_only_the_least_is_found(daemon):
    job, results = results_of(daemon, {"friction": 0.2})
    assert results["granule"]["minimum_omega2"] == pytest.approx(2.861, abs=5e-4)
    assert results["regime"]["name"] is None and set(results["regime"]["evidence"].values()) == {None}
    assert "regime" not in job["summary"] and "rotation_rate" not in job["summary"]
    assert "angle_deg" not in job["summary"]
    assert "rotation_rate" not in daemon.get(f"/jobs/{job['jobID']}/spec").json()["inputs"]
    assert daemon.get(f"/jobs/{job['jobID']}/samples").json()["samples"] == []
    assert daemon.get(f"/jobs/{job['jobID']}/snapshots").json()["snapshots"] == []


def test_rates_on_either_side_of_the_least_keep_and_lose_the_wall(daemon):
    least = results_of(daemon, {"friction": 0.3, "radius": 0.2})[1]["granule"]["minimum_rotation_rate"]
    for factor, regime, keeps in ((0.999, "raining", False), (1.001, "sliding", True), (3, "centrifuging", True), (0.02, "slipping", True)):
        rate = factor * least
        found = results_of(daemon, {"friction": 0.3, "radius": 0.2, "rotation_rate": rate})[1]["regime"]
        assert found["name"] == regime and found["evidence"]["keeps_contact"] is keeps, factor
        assert found["omega2_outer"] == pytest.approx(rate**2 * 0.2 / 9.81)
        assert (found["evidence"]["slip_per_revolution"] is not None) == (regime in ("sliding", "centrifuging"))


def test_sql_has_granules_beside_drums(daemon):
    drum = daemon.submit()
    for friction in (0.1, 1.0):
        results_of(daemon, {"friction": friction})
    daemon.ended(drum)
    query = ("select friction, minimum_omega2 from run_summary where process='granule' order by friction")
    rows = daemon.get("/query", params={"sql": query}).json()["rows"]
    assert [row[0] for row in rows] == [0.1, 1.0]
    assert [row[1] for row in rows] == pytest.approx([3.632, 1.319], abs=5e-4)
    both = daemon.get("/query", params={"sql": "select process, friction, angle_deg is null, particles from run_summary order by created"}).json()["rows"]
    assert sorted(row[0] for row in both) == ["drum", "granule", "granule"]
    assert all(row[1] is not None and row[2] == (row[0] == "granule") for row in both)
    tables = daemon.get("/query", params={"sql": "select g.error, i.tolerance from granule_result g join granule_input i using(job)"}).json()["rows"]
    assert len(tables) == 2 and all(0 < error <= 1.1 * tolerance for error, tolerance in tables)
    # A particle's run says nothing of how fast drums are computed here.
    assert daemon.get("/query", params={"sql": "select count(*) from run_result where particle_steps_per_second is not null"}).json()["rows"] == [[1]]
    assert [job["processID"] for job in daemon.get("/jobs?processID=granule").json()["jobs"]] == ["granule", "granule"]


def test_figure_8_is_one_study(daemon):
    study = json.loads((ROOT / "api/studies/figure8.json").read_text())
    answer = requests.post(f"{daemon.url}/studies", json=study, timeout=30)
    assert answer.status_code == 201, answer.text
    address = f"/studies/{answer.json()['studyID']}"
    assert daemon.get(f"{address}?wait=30").json()["status"] == "successful"
    found = {case["inputs"]["friction"]: case["results"]["minimum_omega2"]["mean"] for case in daemon.get(f"{address}/results").json()["cases"]}
    expected = {0.05: 4.207, 0.1: 3.632, 0.2: 2.861, 0.3: 2.377, 0.4: 2.053, 0.5: 1.826, 0.6: 1.662, 0.7: 1.540, 0.8: 1.447, 0.9: 1.376, 1.0: 1.319}
    assert found == pytest.approx(expected, abs=6e-4)  # found before by steps through time: three decimals, some rounded up


def test_every_problem_is_named_at_once(daemon):
    answer = post(daemon, {"radius": -1, "rotation_rate": "fast", "revolutions": 2.5, "tolerance": 1, "threads": 2, "fricton": 0.5})
    assert answer.status_code == 400
    errors = {error["pointer"]: error["detail"] for error in answer.json()["errors"]}
    assert errors["/inputs/friction"] == "is missing; must be a number in [0.001, 10]"
    assert errors["/inputs/radius"] == "is -1 m; must be in [0.0001, 100] m"
    assert errors["/inputs/rotation_rate"] == 'is "fast"; must be a number in [-10000, 10000] rad/s, and at least 0.001 in size'
    assert errors["/inputs/revolutions"] == "is 2.5 revolutions; must be a whole number in [1, 100] revolutions"
    assert errors["/inputs/tolerance"] == "is 1; must be in [1e-12, 0.01]"
    assert errors["/inputs/fricton"] == "is not an input; did you mean inputs/friction?"
    assert "friction, radius" in errors["/inputs/threads"]
    assert len(errors) == 7
    # Inputs of one process are none of another's.
    drum = requests.post(f"{daemon.url}/processes/drum/execution", json=EXAMPLE, timeout=30).json()["errors"]
    assert {"/process", "/inputs/friction", "/inputs/drum"} <= {error["pointer"] for error in drum}


def test_processes_are_listed_and_described(daemon):
    listed = daemon.get("/processes").json()["processes"]
    assert [process["id"] for process in listed] == ["drum", "fill", "heap", "granule", "orifice"]
    described = daemon.get("/processes/granule").json()
    assert described["inputs"]["friction"]["minOccurs"] == 1
    assert [name for name, given in described["inputs"].items() if given["minOccurs"]] == ["friction"]
    assert described["inputs"]["radius"]["schema"]["default"] == 0.063
    assert set(described["outputs"]) == {"granule", "regime", "run"}


def test_repose_runs_it_without_a_daemon(tmp_path):
    spec = tmp_path / "granule.json"
    spec.write_text(json.dumps(EXAMPLE))
    command = [BUILD / "repose", "run", spec, "--out", tmp_path / "job", "--json"]
    first = subprocess.run(command, capture_output=True, text=True, timeout=20)
    assert first.returncode == 0, first.stderr
    result = json.loads(first.stdout)
    assert result["granule"]["minimum_omega2"] == pytest.approx(1.826, abs=5e-4)
    assert result["run"]["wall_seconds"] < 1
    assert json.loads((tmp_path / "job/result.json").read_text()) == result
    again = subprocess.run(command, capture_output=True, text=True, timeout=20)
    assert again.returncode == 0 and json.loads(again.stdout) == result and "complete" in again.stderr
