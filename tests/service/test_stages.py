"""A drum that turns in stages: a result a stage, in the document, in SQL and as CSV; the mirror image; what goes on from it."""
import csv
import io

import pytest
import requests
from conftest import SPEC, Daemon
from worker_runs import run, timeless_result, write_spec

STAGES = [{"rate": 4.0, "seconds": 0.1}, {"rate": 0.0, "seconds": 0.05}, {"rate": -6.0, "seconds": 0.1}]
INPUTS = {name: value for name, value in SPEC.items() if name != "duration"} | {"snapshots": {"interval": 0}}


def staged(stages, **drum):
    rest = {name: value for name, value in SPEC["drum"].items() if name != "rotation_rate"}
    return INPUTS | {"drum": rest | {"rotation": stages} | drum}


@pytest.fixture(scope="module")
def real(tmp_path_factory):
    daemon = Daemon(tmp_path_factory.mktemp("stages")).start()
    yield daemon
    daemon.stop()


def ended(folder, name, inputs):
    (folder / name).mkdir()
    code, _, stderr = run(write_spec(folder / name, {"inputs": inputs}), folder / name / "job", "--json")
    assert code == 0, stderr
    return timeless_result(folder / name / "job")


def test_each_stage_has_a_result_in_the_document_and_a_row_in_sql(real):
    job = real.submit(staged(STAGES))
    assert real.ended(job)["status"] == "successful"
    results = real.get(f"/jobs/{job}/results").json()
    stages = results["stages"]
    assert [(s["rate"], s["from"]) for s in stages] == [(4, 0), (0, pytest.approx(0.1)), (-6, pytest.approx(0.15))]
    assert all(s["from"] <= s["window_start"] <= s["window_end"] <= s["to"] + 1e-3 for s in stages)  # the last frame is a step late
    assert all(s["angle_deg"] > 0 and s["interface_fluctuation"] is not None for s in stages)
    assert stages[1]["standard_error_deg"] is None and stages[1]["verdict"] is None and stages[1]["regime"] is None
    assert stages[0]["verdict"] == stages[2]["verdict"] == "too-few"  # particles
    assert results["repose"]["angle_deg"] == stages[2]["angle_deg"]  # the last that turns
    answer = requests.get(f"{real.url}/query", params={"sql": f"select * from stage where id='{job}' order by number"}, timeout=30).json()
    rows = answer["rows"] if isinstance(answer["rows"][0], dict) else [dict(zip(answer["columns"], row)) for row in answer["rows"]]
    for stage, row in zip(stages, rows, strict=True):
        assert {name: row[{"from": "begins", "to": "ends"}.get(name, name)] for name in stage} == stage
    text = requests.get(f"{real.url}/query", params={"sql": f"select number, rate, angle_deg from stage where id='{job}'", "format": "csv"},
                        timeout=30).text
    assert [float(row["rate"]) for row in csv.DictReader(io.StringIO(text))] == [4, 0, -6]
    assert real.get(f"/jobs/{job}").json()["summary"]["rotation_rate"] == -6  # the fastest


def test_a_drum_at_one_rate_has_no_stages_and_one_of_one_stage_the_same_results(tmp_path):
    rate = SPEC["drum"]["rotation_rate"]
    alone = ended(tmp_path, "alone", INPUTS | {"duration": {"seconds": 0.2}})
    one = ended(tmp_path, "one", staged([{"rate": rate, "seconds": 0.2}]))
    assert alone["stages"] == []
    stage, = one.pop("stages")
    for output in ("repose", "packing", "drive", "segregation"):
        assert one[output] == alone[output]
    assert stage["angle_deg"] == alone["repose"]["angle_deg"] and stage["torque"] == alone["drive"]["torque"]


def test_stages_the_other_way_are_the_mirror_image(tmp_path):
    back = [stage | {"rate": -stage["rate"]} for stage in STAGES]
    lifters = {"count": 3, "height": 0.004, "width": 0.003, "angle_deg": 25.0}
    one = ended(tmp_path, "one", staged(STAGES, lifters=lifters))
    other = ended(tmp_path, "other", staged(back, lifters=lifters | {"angle_deg": -25.0}))
    for stage in other["stages"]:
        stage["rate"] = -stage["rate"] if stage["rate"] else 0.0
    assert one == other


def test_a_drum_goes_on_from_its_stages_at_one_rate(real):
    job = real.submit(staged(STAGES[:2]))
    assert real.ended(job)["status"] == "successful"
    answer = requests.post(f"{real.url}/jobs/{job}/continue", json={"seconds": 0.1}, timeout=30)
    assert answer.status_code == 201, answer.text
    drum = real.get(f"/jobs/{answer.json()['jobID']}/spec").json()["inputs"]["drum"]
    assert drum["rotation_rate"] == 4 and "rotation" not in drum
    assert real.ended(answer.json()["jobID"])["status"] == "successful"
