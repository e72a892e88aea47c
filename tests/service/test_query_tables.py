"""The tables that SQL may read: what is told of them, and what they hold of a run beside its main numbers."""
import csv
import io
import json
import random
import re
import sqlite3
import statistics

import pytest
import requests
from conftest import FAKE_WORKER, ROOT, SPEC, run_daemon


@pytest.fixture(scope="module")
def own(tmp_path_factory):
    """A job that has ended well, one that has failed, and a study of two."""
    running = run_daemon(tmp_path_factory.mktemp("tables"), worker=FAKE_WORKER, options=["--workers", "2"])
    daemon = next(running)
    daemon.jobs = [daemon.submit(SPEC | {"contact": {"law": "hertz-mindlin"}, "precision": "double"}), daemon.submit(fake="numerical")]
    study = {"name": "two", "base": {"inputs": SPEC}, "vary": {"/inputs/contact/friction": [0.3, 0.6]}}
    daemon.study = requests.post(f"{daemon.url}/studies", json=study, timeout=30).json()["studyID"]
    for job in [*daemon.jobs, *(job["jobID"] for job in daemon.get(f"/jobs?study={daemon.study}").json()["jobs"])]:
        daemon.ended(job)
    yield daemon
    for _ in running:
        pass


def rows(daemon, sql):
    answer = daemon.get("/query", params={"sql": sql})
    assert answer.status_code == 200, answer.text
    return [dict(zip(answer.json()["columns"], row)) for row in answer.json()["rows"]]


def test_all_tables_are_told_with_unit_and_meaning(own):
    answer = own.get("/query")
    tables = {table["name"]: table for table in answer.json()["tables"]}
    assert {"run_summary", "job", "job_input", "study", "study_case", "sample", "snapshot", "result", "drum_input", "heap_input",
            "fill_input", "granule_input", "repose_result", "run_result"} <= set(tables)
    for name, table in tables.items():
        columns = own.get("/query", params={"sql": f"SELECT * FROM {name} LIMIT 0"}).json()["columns"]
        assert [column["name"] for column in table["columns"]] == columns and table["meaning"], name
        assert [column["name"] for column in table["columns"] if not column["meaning"]] == [], name
    units = {column["name"]: column["unit"] for column in tables["run_summary"]["columns"]}
    assert (units["drum_diameter"], units["rotation_rate"], units["angle_deg"], units["law"]) == ("m", "rad/s", "degrees", "")
    page = own.get("/query", headers={"Accept": "text/html"})
    assert page.headers["Content-Type"].startswith("text/html") and page.text == own.get("/query?f=html").text
    assert all(f'<h2 id="{name}">' in page.text for name in tables) and "<code>drum_diameter</code>" in page.text
    list_of_columns = own.get("/query?f=csv")
    assert list_of_columns.headers["Content-Type"].startswith("text/csv")
    told = [{key: cell.removeprefix("'") for key, cell in row.items()} for row in csv.DictReader(io.StringIO(list_of_columns.text))]
    assert told == [  # before - stands a ', since a spreadsheet would read a formula
        {"table": name, "column": column["name"]} | {key: column[key] for key in ("type", "unit", "meaning")}
        for name, table in tables.items() for column in table["columns"]]
    assert own.get("/query", headers={"Accept": "text/csv, application/json;q=0.9"}).text == list_of_columns.text


@pytest.mark.parametrize("sql, names", [
    ("select angel from run_summary", ["angle_deg", "drum_diameter"]), ("select j.nowhere from job j", ["label", "created"]),
    ("select * from runs", ["run_summary", "job_input", "sample"]), ("select nonsense from result", ["document"])])
def test_an_unknown_name_is_answered_with_those_there_are(own, sql, names):
    answer = own.get("/query", params={"sql": sql})
    assert answer.status_code == 400
    detail = answer.json()["detail"]
    assert detail.startswith("no such") and all(re.search(rf"\b{name}\b", detail) for name in names), detail


def test_a_summary_tells_of_law_precision_study_and_failure(own):
    told = {row["id"]: row for row in rows(own, "select * from run_summary")}
    first, failed = (told[job] for job in own.jobs)
    assert (first["law"], first["precision"], first["study"], first["status"]) == ("hertz-mindlin", "double", None, "successful")
    assert (failed["law"], failed["precision"], failed["angle_deg"], failed["status"]) == ("walton-braun", "single", None, "failed")
    assert failed["message"] and failed["drum_diameter"] == SPEC["drum"]["diameter"]
    of_study = [row for row in told.values() if row["study"] == own.study]
    assert sorted((row["study_case"], row["study_repeat"], row["friction"]) for row in of_study) == [(0, 0, 0.3), (1, 0, 0.6)]
    assert len(told) == 4


def test_every_definition_of_the_angle_has_a_column(daemon):
    job = daemon.submit(SPEC | {"duration": {"seconds": 0.6}})
    assert daemon.ended(job, seconds=120)["status"] == "successful"
    results = daemon.get(f"/jobs/{job}/results").json()["repose"]
    row, = rows(daemon, "select * from run_summary")
    assert row["angle_definition"] == results["method"] and len(results["other_methods"]) == 5
    for name, angle in results["other_methods"].items():
        assert row[name.replace("-", "_") + "_deg"] == angle
        assert row[name.replace("-", "_") + "_standard_error_deg"] == results["other_methods_standard_error_deg"][name]
    for source in ("measures/measure_heap.c", "measures/measure_fill.c"):  # all but the first, which is angle_deg
        names = re.search(r"name\[DEM_\w+_METHODS\] = \{([^}]*)\}", (ROOT / "core" / source).read_text()).group(1)
        assert all(name.replace("-", "_") + "_deg" in row for name in re.findall('"([^"]+)"', names)[1:])


def test_inputs_are_told_with_default_and_whether_they_were_given(own):
    inputs = {row["name"]: row for row in rows(own, f"select * from job_input where id='{own.jobs[0]}'")}
    spec = own.get(f"/jobs/{own.jobs[0]}/spec").json()["inputs"]
    assert inputs["contact/law"] | {"id": 0} == {"id": 0, "job": 1, "process": "drum", "name": "contact/law", "value": "hertz-mindlin",
                                                "default_value": "walton-braun", "unit": "", "is_given": 1}
    for name, value, default, unit, given in (("drum/diameter", 0.04, None, "m", 1), ("contact/friction", 0.3, 0.3, "", 0),
                                              ("fill_fraction", 0.3, 0.5, "", 1), ("drum/ends", spec["drum"]["ends"], "periodic", "", 0),
                                              ("seed", 7, None, "", 1), ("snapshots/interval", 0.1, 0.1, "s", 1)):
        row = inputs[name]
        assert (row["value"], row["default_value"], row["unit"], row["is_given"]) == (value, default, unit, given), name
    assert json.loads(inputs["particles"]["value"]) == spec["particles"] and inputs["particles"]["is_given"] == 1
    differs = rows(own, "select id, name, value from job_input where default_value is not null and value is not default_value"
                        " and name like 'contact/%'")
    assert {(row["id"], row["name"]) for row in differs} >= {(own.jobs[0], "contact/law")}
    of_study = rows(own, "select value, is_given from job_input join job on job.id=job_input.id where name='contact/friction'"
                         " and study is not null order by value")
    assert [(row["value"], row["is_given"]) for row in of_study] == [(0.3, 1), (0.6, 1)]


def test_quantiles_are_exact(own):
    chance = random.Random(5)
    for count in (1, 2, 3, 10, 101):
        values = [chance.choice([chance.gauss(0, 1), chance.randint(-3, 3)]) for _ in range(count)]
        sql = ", ".join(f"quantile(value, {share})" for share in (0, 0.25, 0.5, 0.9, 1))
        found = list(rows(own, f"select {sql} from json_each('{json.dumps(values + [None, 'x'])}')")[0].values())
        expected = [min(values), None, statistics.median(values), None, max(values)]
        if count > 1:
            expected[1] = statistics.quantiles(values, n=4, method="inclusive")[0]
            expected[3] = statistics.quantiles(values, n=10, method="inclusive")[8]
        assert all(e is None or abs(f - e) < 1e-12 for f, e in zip(found, expected)), (values, found)
    assert rows(own, "select quantile(value, 0.5) as q from json_each('[]')") == [{"q": None}]
    assert rows(own, "select quantile(1e999, 0.5) as q, quantile(value, 0.5) as p from json_each('[1,2]')")[0]["p"] == 1.5
    for share in ("1.5", "-0.1", "'half'", "null"):
        answer = own.get("/query", params={"sql": f"select quantile(1, {share})"})
        assert answer.status_code == 400 and "[0, 1]" in answer.json()["detail"], answer.text


def test_quantiles_are_of_bounded_memory(own):
    many = "with recursive n(x) as (select 1 union all select x+1 from n limit 1500000) select quantile(x, 0.5), quantile(-x, 0.1) from n"
    answer = own.get("/query", params={"sql": many})
    assert answer.status_code in (400, 503) and ("two million" in answer.text or "limit" in answer.text)
    assert rows(own, "select quantile(value, 0.5) as q from json_each('[3,1,2]')") == [{"q": 2}]


def test_jobs_from_before_get_their_words_from_the_specification(tmp_path):
    """As the older program left them: without the columns."""
    running = run_daemon(tmp_path, worker=FAKE_WORKER, options=["--workers", "1"])
    daemon = next(running)
    job = daemon.submit(SPEC | {"contact": {"law": "spring-dashpot"}, "precision": "double"})
    daemon.ended(job)
    daemon.stop()
    with sqlite3.connect(daemon.data / "reposed.sqlite") as database:
        for view in ("run_summary", "job_input"):
            database.execute(f"DROP VIEW {view}")
        database.execute("ALTER TABLE job DROP COLUMN given")
        for table in ("drum_input", "fill_input", "heap_input"):
            for column in ("law", "precision"):
                database.execute(f"ALTER TABLE {table} DROP COLUMN {column}")
        database.executescript("DROP TRIGGER calibration_job_kept; DROP TABLE calibration_run; DROP TABLE calibration_document;"
                               "DROP TABLE calibration; DROP VIEW interface; DROP TABLE sent_bed_text; DROP TABLE sent_bed; DROP INDEX job_waiting_short; ALTER TABLE result DROP COLUMN checksum;"
                               "DROP INDEX job_of_bed; DROP TABLE bed;"
                               "ALTER TABLE job DROP COLUMN bed; ALTER TABLE job DROP COLUMN starts; ALTER TABLE job DROP COLUMN worker;"
                               "ALTER TABLE job DROP COLUMN more_time; ALTER TABLE job DROP COLUMN more_memory; ALTER TABLE job DROP COLUMN resources; PRAGMA user_version=20")
    daemon.start()
    assert rows(daemon, "select law, precision from run_summary") == [{"law": "spring-dashpot", "precision": "double"}]
    assert rows(daemon, "select distinct is_given from job_input") == [{"is_given": None}]
    for _ in running:
        pass
