"""What a run that came to its end knows of itself is told: in its results, in print, in the job's message, in lists, SQL,
studies, CSV and on the page."""
import csv
import io

import pytest
import requests
from test_heap_and_fill import SPECS
from test_page import find, until
from worker_runs import result, run, small, write_spec

FULL = {"drum": {"diameter": 0.044, "length": 0.0165, "rotation_rate": 6}, "particles": [{"shape": "cube", "diameter": 0.002}],
        "fill_fraction": 0.85, "contact": {"maximum_overlap": 0.05}, "duration": {"seconds": 0.005}, "snapshots": {"interval": 0},
        "seed": 1}


def finished(folder, spec):
    code, printed, errors = run(write_spec(folder, spec), folder / "job")
    assert code == 0, errors
    return result(folder / "job"), printed


def fields_of(results):
    return [warning["field"] for warning in results["run"]["warnings"]]


def test_a_bed_that_is_pressed_together_is_told(tmp_path):
    found, printed = finished(tmp_path, {"inputs": FULL})
    largest = found["run"]["maximum_overlap"]
    assert largest > 1.5 * 0.05 and fields_of(found) == ["/run/maximum_overlap"]
    assert f"{largest:.2g}" in found["run"]["warnings"][0]["text"] and "0.05 was asked for" in found["run"]["warnings"][0]["text"]
    assert "/run/maximum_overlap is" in printed


def test_a_run_that_is_as_it_should_be_warns_of_nothing(tmp_path):
    found, printed = finished(tmp_path, small(duration={"revolutions": 0.3}))
    assert found["run"]["maximum_overlap"] < 1.5 * 0.03 and found["run"]["warnings"] == [] and "warning" not in printed


@pytest.mark.parametrize("process, duration", [("heap", {"at_most_seconds": 0.05}), ("fill", {"settling_seconds": 0.001})])
def test_what_did_not_come_to_rest_is_told(tmp_path, process, duration):
    found, printed = finished(tmp_path, {"process": process, "inputs": SPECS[process] | {"duration": duration}})
    assert found[process]["at_rest"] is False and f"/{process}/at_rest" in fields_of(found)
    assert f"/{process}/at_rest is false" in printed


def test_an_angle_that_was_not_known_as_well_as_asked_for_is_told(tmp_path):
    found, _ = finished(tmp_path, small(duration={"until_standard_error_deg": 0.01, "at_most_revolutions": 0.3}))
    assert found["run"]["ended_by"] == "at-most-revolutions" and fields_of(found) == ["/run/ended_by"]


def test_warnings_stand_in_messages_lists_tables_and_studies(fake):
    cases = [{"name": name, "inputs": {"seed": 0}, "label": {"warnings": counts}} for name, counts in (("some", "2 0 1"), ("none", "0"))]
    study = requests.post(f"{fake.url}/studies", timeout=60,
                          json={"name": "warned", "base": {"inputs": small()["inputs"]}, "repeats": 3, "cases": cases})
    assert study.status_code == 201, study.text
    study = study.json()["studyID"]
    assert fake.get(f"/studies/{study}?wait=60").json()["status"] == "successful"
    rows = {row["case"]: row["warnings"] for row in fake.get(f"/studies/{study}/results").json()["cases"]}
    assert rows == {"some": 3, "none": 0}
    lines = csv.DictReader(io.StringIO(fake.get(f"/studies/{study}/results.csv").text))
    assert {line["case"]: line["warnings"] for line in lines} == {"some": "3", "none": "0"}
    for table in ("run_result", "run_summary"):
        sql = f"select warnings, count(*) from {table} group by warnings order by warnings"
        assert fake.get("/query", params={"sql": sql}).json()["rows"] == [[0, 4], [1, 1], [2, 1]]
    jobs = fake.get(f"/jobs?study={study}&limit=20").json()["jobs"]
    assert {(job["summary"]["warnings"], job["message"]) for job in jobs} == {
        (0, "done"), (1, "done, with 1 warning: /run/fact_0 is <b>odd</b> 0"), (2, "done, with 2 warnings: /run/fact_0 is <b>odd</b> 0")}


def test_the_page_shows_warnings_before_the_angle(fake, browser):
    job = fake.submit(warnings="2")
    fake.ended(job)
    browser.get(f"{fake.url}/?open={job}")
    shown = until(browser, lambda b: find(b, f"#detail-{job} .warnings"))
    assert "2 warnings" in shown.text and "is <b>odd</b> 1" in shown.text
    assert shown.location["y"] < find(browser, f"#detail-{job} .answer").location["y"]
    assert "2 warnings" in find(browser, f"#job-{job}").text
