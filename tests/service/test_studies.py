"""Studies: many jobs from one document, kept or refused whole, and their results in one table."""
import csv
import io
import json
import math
import re
import sqlite3
import subprocess
import threading
import time
from pathlib import Path

import numpy
import pytest
import requests
from conftest import BUILD, FAKE_WORKER, SPEC, run_daemon

ROOT = Path(__file__).resolve().parents[2]
FRICTION, RATE = "/inputs/contact/friction", "/inputs/drum/rotation_rate"


def base(**label):
    return {"inputs": SPEC, "label": label}


def post(daemon, document):
    return requests.post(f"{daemon.url}/studies", json=document, timeout=60)


def submit(daemon, document):
    answer = post(daemon, document)
    assert answer.status_code == 201, answer.text
    return answer.json()["studyID"]


def ended(daemon, study, seconds=60):
    end = time.monotonic() + seconds
    while True:
        info = daemon.get(f"/studies/{study}?wait=5").json()
        if info["status"] not in ("accepted", "running"):
            return info
        assert time.monotonic() < end, info


def jobs_of(daemon, study, **filters):
    """All of them, page after page, newest first."""
    path, jobs = f"/jobs?study={study}&limit=400" + "".join(f"&{name}={value}" for name, value in filters.items()), []
    while path:
        page = daemon.get(path).json()
        jobs += page["jobs"]
        path = next((link["href"] for link in page["links"] if link["rel"] == "next"), None)
    return jobs


def all_jobs(daemon):
    return sum(daemon.get("/jobs?limit=1").json()["counts"].values())


def errors_of(answer):
    assert answer.status_code == 400, answer.text
    assert answer.headers["Content-Type"] == "application/problem+json"
    return [(error["pointer"], error["detail"]) for error in answer.json()["errors"]]


STUDENT = {3: 1.3213, 5: 1.1416}  # by number of runs: 68.27 % of Student's distribution within so many standard errors


def mean_and_error(values, own=0.0):
    """Of independent runs, each with an error of its own: the larger of the two, in two digits, and the mean as far as they reach."""
    error = float(f"{max(STUDENT[len(values)] * numpy.std(values, ddof=1), own) / numpy.sqrt(len(values)):.1e}")
    decimals = 1 - math.floor(math.log10(error)) if error else 15
    return pytest.approx([round(float(numpy.mean(values)), decimals), error], rel=1e-12)


def test_a_study_makes_every_case_as_often_as_asked(fake):
    answer = post(fake, {"name": "grid", "base": base(project="p"), "vary": {FRICTION: [0.1, 0.4], RATE: [5, 6, 7]}, "repeats": 2})
    info = answer.json()
    assert answer.status_code == 201 and answer.headers["Location"] == f"{fake.url}/studies/{info['studyID']}"
    assert (info["cases"], info["repeats"], info["jobs"]) == (6, 2, 12) and info["estimate"]["jobs"] == 12
    assert ended(fake, info["studyID"])["counts"]["successful"] == 12
    fake.submit()  # of no study
    jobs = jobs_of(fake, info["studyID"])
    assert len(jobs) == 12 and {job["studyID"] for job in jobs} == {info["studyID"]}
    inputs = [fake.get(f"/jobs/{job['jobID']}/spec").json()["inputs"] for job in jobs]
    made = {(one["contact"]["friction"], one["drum"]["rotation_rate"], one["seed"]) for one in inputs}
    assert made == {(friction, rate, seed) for friction in (0.1, 0.4) for rate in (5, 6, 7) for seed in (7, 8)}
    assert {job["label"]["case"] for job in jobs} == {f"friction {f}, rotation_rate {r}" for f in (0.1, 0.4) for r in (5, 6, 7)}
    assert all(job["label"]["project"] == "p" and job["label"]["study"] == "grid" for job in jobs)
    # first every case once: the first six have the first seed
    assert [fake.get(f"/jobs/{job['jobID']}/spec").json()["inputs"]["seed"] for job in jobs[::-1]] == [7] * 6 + [8] * 6


def test_means_and_errors_are_those_of_the_jobs(fake):
    cases = [{"name": "five", "inputs": {"contact": {"friction": 0.1}, "seed": 100}, "label": {"angle": 20, "paper": "21"}},
             {"name": "fails", "inputs": {"contact": {"friction": 0.2}}, "label": {"fake": "fault"}},
             {"name": "constant", "label": {"paper": 23.5}}]
    study = submit(fake, {"name": "numbers", "base": base(), "cases": cases, "repeats": 5})
    info = ended(fake, study)
    assert info["status"] == "failed" and info["counts"]["failed"] == 5 and info["progress"] == 100
    rows = {row["case"]: row for row in fake.get(f"/studies/{study}/results").json()["cases"]}
    assert rows["five"]["results"]["hysteresis_deg"]["mean"] == 15.5
    assert list(rows) == ["five", "fails", "constant"]
    angles = [fake.get(f"/jobs/{job['jobID']}/results").json()["repose"]["angle_deg"]
              for job in jobs_of(fake, study) if job["label"]["case"] == "five"]
    assert len(set(angles)) == 5
    angle = rows["five"]["results"]["angle_deg"]
    assert [angle["mean"], angle["standard_error"]] == mean_and_error(angles, own=0.3)
    assert angle["error_from"] == "repeats" and angle["count"] == 5
    assert rows["five"]["label"] == {"angle": 20, "paper": "21"} and rows["five"]["regime"] == "rolling"
    assert rows["five"]["inputs"] == {"contact/friction": 0.1, "seed": 100} and rows["constant"]["inputs"] == {"contact/friction": 0.3, "seed": 7}
    assert (rows["fails"]["repeats"], rows["fails"]["finished"], rows["fails"]["failed"]) == (5, 0, 5) and rows["fails"]["results"] == {}
    constant = rows["constant"]["results"]
    # five runs of 23.5 +- 0.3 that agree are no better than 0.3/sqrt(5)
    assert constant["angle_deg"] == {"mean": 23.5, "standard_error": 0.13, "error_from": "runs", "count": 5}
    assert constant["maximum_deg"] == {"mean": 25, "standard_error": 0, "error_from": "repeats", "count": 5}
    assert constant["solid_fraction"]["mean"] == pytest.approx(0.59, rel=1e-12) and "radial_index" not in constant

    tables = [fake.get(f"/studies/{study}/results.csv"), fake.get(f"/studies/{study}/results?format=csv"),
              fake.get(f"/studies/{study}/results", headers={"Accept": "text/csv"})]
    assert all(table.text == tables[0].text and table.headers["Content-Type"].startswith("text/csv") for table in tables)
    lines = list(csv.DictReader(io.StringIO(tables[0].text)))
    assert [line["case"] for line in lines] == list(rows)
    assert [float(lines[0][name]) for name in ("angle_deg", "angle_deg_standard_error")] == [angle["mean"], angle["standard_error"]]
    assert lines[2]["error_from"] == lines[2]["torque_error_from"] == "runs" and lines[2]["angle_deg_standard_error"] == "0.13"
    assert lines[0]["contact/friction"] == "0.1" and lines[0]["label/paper"] == "21" and lines[0]["error_from"] == "repeats"
    assert lines[1]["angle_deg"] == "" and lines[1]["finished"] == "0" and lines[1]["failed"] == "5"


def test_one_repeat_has_the_error_of_its_run(fake):
    study = submit(fake, {"base": base()})
    ended(fake, study)
    row, = fake.get(f"/studies/{study}/results").json()["cases"]
    assert row["results"]["angle_deg"] == {"mean": 23.5, "standard_error": 0.3, "error_from": "run", "count": 1}
    assert row["results"]["solid_fraction"]["standard_error"] is None


def test_texts_in_csv_keep_their_commas_and_quotes(fake):
    name = 'rough, "very" rough'
    study = submit(fake, {"base": base(), "cases": [{"name": name, "label": {"note": "a\nb"}}]})
    line, = csv.DictReader(io.StringIO(fake.get(f"/studies/{study}/results.csv").text, newline=""))
    assert line["case"] == name and line["label/note"] == "a\nb"


def test_a_bad_study_is_refused_whole_with_every_problem(fake):
    cases = [{"name": "good"}, {"name": "rough", "inputs": {"contact": {"friction": -1}}}, {"name": "odd", "inputs": {"wal": {}}},
             {"name": "good", "inputs": {"particles": [{"diameter": 0.2}]}}]
    errors = dict(errors_of(post(fake, {"base": {"inputs": SPEC | {"gravity": -2}}, "cases": cases, "repeats": 0})))
    assert set(errors) >= {"/repeats", "/cases/3/name", "/base/inputs/gravity", "/cases/1/inputs/contact/friction", "/cases/2/inputs/wal",
                           "/cases/3/inputs/drum/diameter"}
    assert errors["/cases/1/inputs/contact/friction"] == "is -1; must be in [0, 5]"
    errors = dict(errors_of(post(fake, {"base": base(), "vary": {"/inputs/contact/frction": [1], FRICTION: [0.1, "x"]}})))
    assert "did you mean inputs/contact/friction" in errors["/vary/~1inputs~1contact~1frction"]
    assert "/vary/~1inputs~1contact~1friction/1" in errors
    assert errors_of(post(fake, {"base": base(), "vary": {"friction": [1]}}))[0][0] == "/vary/friction"
    assert errors_of(post(fake, []))[0][0] == ""
    assert all_jobs(fake) == 0 and fake.get("/studies").json()["studies"] == []
    assert requests.post(f"{fake.url}/studies", data="{", headers={"Content-Type": "application/json"}).status_code == 400
    assert requests.post(f"{fake.url}/studies", data=b" " * 1_100_000, headers={"Content-Type": "application/json"}).status_code == 413


@pytest.fixture
def narrow(tmp_path):
    """One worker, and room for ten jobs that wait."""
    yield from run_daemon(tmp_path, worker=FAKE_WORKER, options=["--workers", "1", "--queue-limit", "10"])


def test_no_more_jobs_wait_than_may(narrow):
    slow = base(fake="slow", seconds="60")
    pointer, detail = errors_of(post(narrow, {"base": slow, "repeats": 11}))[0]
    assert pointer == "" and "makes 11 jobs" in detail and "at most 10" in detail
    first = narrow.submit(fake="slow", seconds="60")
    narrow.until(first, lambda info: info["status"] == "running")
    study = submit(narrow, {"base": slow, "repeats": 7})
    answer = post(narrow, {"base": slow, "repeats": 4})
    assert answer.status_code == 503 and int(answer.headers["Retry-After"]) > 0 and "--queue-limit" in answer.json()["detail"]
    submit(narrow, {"base": slow, "repeats": 3})
    answer = narrow.post(label={"fake": "slow"})
    assert answer.status_code == 503 and all_jobs(narrow) == 11
    assert len(list((narrow.data / "jobs").iterdir())) == 1  # no folder of what was refused or only waits
    requests.delete(f"{narrow.url}/studies/{study}")
    assert narrow.post().status_code == 201


def test_cancelling_stops_what_has_not_ended(fake):
    cases = [{"name": "quick"}, {"name": "slow", "label": {"fake": "slow", "seconds": "60"}}, {"name": "slower", "label": {"fake": "slow", "seconds": "60"}},
             {"name": "last", "label": {"fake": "slow", "seconds": "60"}}]
    other = submit(fake, {"base": base()})
    ended(fake, other)
    study = submit(fake, {"base": base(), "cases": cases})
    end = time.monotonic() + 20
    while fake.get(f"/studies/{study}").json()["counts"] != {"accepted": 1, "running": 2, "successful": 1, "failed": 0, "dismissed": 0}:
        assert time.monotonic() < end, fake.get(f"/studies/{study}").json()
        time.sleep(0.05)
    info = fake.get(f"/studies/{study}").json()
    assert info["status"] == "running" and 25 <= info["progress"] < 50 and "finished" not in info and info["started"] >= info["created"]
    answer = requests.delete(f"{fake.url}/studies/{study}")
    assert answer.status_code == 200 and answer.json()["status"] == "dismissed"
    assert answer.json()["counts"] == {"accepted": 0, "running": 0, "successful": 1, "failed": 0, "dismissed": 3}
    end = time.monotonic() + 8
    while fake.workers():
        assert time.monotonic() < end
        time.sleep(0.05)
    info = fake.get(f"/studies/{study}").json()
    assert info["counts"]["dismissed"] == 3 and info["finished"] == info["updated"]
    assert [row["finished"] for row in fake.get(f"/studies/{study}/results").json()["cases"]] == [1, 0, 0, 0]
    assert requests.delete(f"{fake.url}/studies/{other}?only=dismiss").status_code == 409
    assert fake.get(f"/studies/{other}").json()["status"] == "successful"


def test_waiting_ends_with_the_last_job(fake):
    study = submit(fake, {"base": base(fake="slow", seconds="1"), "repeats": 2})
    assert fake.get(f"/studies/{study}?wait=0").json()["status"] in ("accepted", "running")
    start = time.monotonic()
    assert fake.get(f"/studies/{study}?wait=30").json()["status"] == "successful"
    assert time.monotonic() - start < 15


def test_the_list_is_newest_first_and_paged(fake):
    studies = [submit(fake, {"name": f"s{i}", "base": base()}) for i in range(5)]
    seen, path = [], "/studies?limit=2"
    while path:
        page = fake.get(path).json()
        assert len(page["studies"]) <= 2
        seen += [info["studyID"] for info in page["studies"]]
        path = next((link["href"] for link in page["links"] if link["rel"] == "next"), None)
    assert seen == studies[::-1]
    for info in page["studies"]:
        for link in info["links"]:
            assert fake.get(link["href"]).status_code == 200
    assert fake.get("/jobs?study=nothing").json()["jobs"] == []


def test_other_methods_are_refused_with_those_that_are_allowed(fake):
    for path, allowed in (("/studies", "GET, HEAD, POST"), ("/studies/20200101-000000-00000000", "GET, HEAD, DELETE"),
                          ("/studies/20200101-000000-00000000/results.csv", "GET, HEAD")):
        answer = requests.put(fake.url + path, json={})
        assert answer.status_code == 405 and answer.headers["Allow"] == allowed


@pytest.mark.parametrize("share", [0.05, 0.3, 0.6, 0.8, 0.95, 1.1])
def test_a_daemon_killed_in_the_post_kept_all_jobs_or_none(tmp_path, share):
    """The kill comes after a share of the time that the same POST takes undisturbed."""
    document = {"base": base(fake="slow", seconds="60"), "vary": {FRICTION: [i / 1000 for i in range(1, 401)]}, "repeats": 2}
    for daemon in run_daemon(tmp_path, worker=FAKE_WORKER, options=["--workers", "1"]):
        start = time.monotonic()
        first = submit(daemon, document)
        took = time.monotonic() - start
        answers = []

        def send():
            try:
                answers.append(post(daemon, document).status_code)
            except requests.RequestException:
                answers.append(None)
        sender = threading.Thread(target=send)
        sender.start()
        time.sleep(share * took)
        daemon.stop(9)
        sender.join()
        daemon.start()
        studies = daemon.get("/studies").json()["studies"]
        assert [info["jobs"] for info in studies] == [800] * len(studies) and 1 <= len(studies) <= 2
        assert all_jobs(daemon) == 800 * len(studies)
        assert len(studies) == 2 or answers == [None]  # what was answered is there
        assert studies[-1]["studyID"] == first and len(jobs_of(daemon, studies[0]["studyID"])) == 800


def test_a_study_goes_on_after_a_crash(fake):
    study = submit(fake, {"base": base(fake="slow", seconds="2"), "repeats": 4})
    end = time.monotonic() + 20
    while not fake.get(f"/studies/{study}").json()["progress"] > 5:
        assert time.monotonic() < end
        time.sleep(0.05)
    fake.stop(9)
    fake.start()
    info = ended(fake, study)
    assert info["counts"]["successful"] == 4 and info["progress"] == 100
    assert [job["attempt"] for job in jobs_of(fake, study)] == [1, 1, 1, 1]  # a daemon that dies uses up none


def test_posting_a_kept_study_again_gives_the_same_jobs(fake):
    inputs = {name: value for name, value in SPEC.items() if name != "seed"}
    first = submit(fake, {"name": "kept", "base": {"inputs": inputs}, "vary": {FRICTION: [0.1, 0.2]}, "repeats": 2})
    second = submit(fake, fake.get(f"/studies/{first}/spec").json())
    specs = [[fake.get(f"/jobs/{job['jobID']}/spec").json() for job in jobs_of(fake, study)] for study in (first, second)]
    assert specs[0] == specs[1] and len({json.dumps(spec) for spec in specs[0]}) == 4


def test_counts_in_the_table_are_those_of_the_jobs(fake):
    """The triggers against a count of the rows."""
    submit(fake, {"base": base(), "repeats": 3})
    study = submit(fake, {"base": base(fake="fault"), "repeats": 2})
    ended(fake, study)
    requests.delete(f"{fake.url}/studies/{submit(fake, {'base': base(fake='slow', seconds='60'), 'repeats': 3})}")
    with sqlite3.connect(f"file:{fake.data / 'reposed.sqlite'}?mode=ro", uri=True) as database:
        kept = database.execute("SELECT number, jobs, accepted, running, successful, failed, dismissed FROM study ORDER BY 1").fetchall()
        counted = database.execute("SELECT study, count(*), sum(status='accepted'), sum(status='running'), sum(status='successful'),"
                                   " sum(status='failed'), sum(status='dismissed') FROM job GROUP BY study ORDER BY 1").fetchall()
    assert kept == counted and [row[1] for row in kept] == [3, 2, 3]
    rows = fake.get("/query?sql=select study.name, study_case.name, count(*) from job join study on study.number=job.study"
                    " join study_case on study_case.study=study.number group by 1, 2").json()["rows"]
    assert rows == [["drum study", "base", 8]]


def test_a_database_of_the_first_version_is_brought_up_to_date(fake):
    """Its tables are those of the first migration, which never changes."""
    fake.stop()
    path = fake.data / "reposed.sqlite"
    for file in fake.data.glob("reposed.sqlite*"):
        file.unlink()
    source = (ROOT / "server/daemon/store/schema.c").read_text()
    sql = [re.sub(r"/\*.*?\*/", "", re.search(rf"{name}\[\] =(.*?);\n\n", source, re.S)[1], flags=re.S) for name in ("job_tables", "result_tables")]
    with sqlite3.connect(path) as database:
        for part in sql:
            database.executescript("".join(re.findall(r'"(.*?)"', part)))
        database.execute("INSERT INTO job(id,process,label,spec,status,message,threads,estimated_seconds,estimated_memory_bytes,created,updated)"
                         " VALUES('20260101-000000-00000001','drum','{}','{}','failed','old',1,1,1,'2026-01-01T00:00:00.000Z','2026-01-01T00:00:00.000Z')")
        database.execute("PRAGMA user_version=1")
        database.execute(f"PRAGMA application_id={0x72657073}")
    fake.start()
    assert fake.job("20260101-000000-00000001")["message"] == "old"
    assert ended(fake, submit(fake, {"base": base(), "repeats": 2}))["counts"]["successful"] == 2


# --- the ready-made ones, and the real worker ---

STUDIES = {path.stem: json.loads(path.read_text()) for path in (ROOT / "api/studies").glob("*.json")}


@pytest.mark.parametrize("name", sorted(STUDIES))
def test_ready_made_studies_are_taken(fake, name):
    study = STUDIES[name]
    info = post(fake, study).json()
    assert info["repeats"] == study.get("repeats", 1)
    varied = numpy.prod([len(values) for values in study["vary"].values()]) if "vary" in study else len(study["cases"])
    assert info["jobs"] == varied * info["repeats"]
    if not name.startswith("materials-"):  # these say which row of the paper each case is
        assert all(case["label"]["paper"] for case in study.get("cases", []))


def check(folder, study):
    """What `repose check` says of it, without a daemon."""
    (folder / "study.json").write_text(json.dumps(study))
    done = subprocess.run([BUILD / "repose", "check", folder / "study.json"], capture_output=True, text=True)
    return done.returncode, json.loads(done.stdout)


@pytest.mark.parametrize("name", sorted(STUDIES))
def test_a_study_is_checked_without_a_daemon(tmp_path, fake, name):
    code, report = check(tmp_path, STUDIES[name])
    info = post(fake, STUDIES[name]).json()
    assert code == 0 and len(report["cases"]) == info["cases"] and report["repeats"] == info["repeats"]
    assert {part: report["estimate"][part] for part in ("jobs", "steps")} == {part: info["estimate"][part] for part in ("jobs", "steps")}
    rows = fake.get(f"/studies/{info['studyID']}/results").json()["cases"]
    for case, row in zip(report["cases"], rows, strict=True):
        assert case["case"] == row["case"] and set(case["inputs"]) == set(row["inputs"])
        for column, value in case["inputs"].items():  # answers have 15 digits
            assert row["inputs"][column] == (pytest.approx(value, rel=1e-14) if isinstance(value, float) else value)


def test_a_bad_study_has_the_same_problems_without_a_daemon(tmp_path, fake):
    study = {"base": {"inputs": SPEC | {"gravity": -2}}, "cases": [{"name": "a", "inputs": {"contact": {"friction": -1}}}], "repeats": 0}
    code, report = check(tmp_path, study)
    assert code == 2 and [(error["pointer"], error["detail"]) for error in report["errors"]] == errors_of(post(fake, study))


def test_table_1_is_the_papers():
    paper = [(0.01, "10", "pi/2"), (0.02, "13", "pi/2"), (0.1, "23", "pi/2"), (0.1, "25", "pi"), (0.2, "25", "pi/2"), (1.0, "31", "pi/2"), (1.0, "35", "pi"),
             (0.1, "28", "pi/2"), (0.1, "35 to 39", "pi/2")]
    study = STUDIES["table1"]
    default = study["base"]["inputs"]["drum"]["rotation_rate"]
    rates = {"pi/2": numpy.pi / 2, "pi": numpy.pi}
    for case, (friction, angle, rate) in zip(study["cases"], paper, strict=True):
        assert case["inputs"]["contact"]["friction"] == friction and case["label"]["paper"].split(",")[0] == angle
        assert case["inputs"].get("drum", {}).get("rotation_rate", default) == pytest.approx(rates[rate], rel=1e-12)
    assert study["cases"][0]["inputs"]["fill_fraction"] == 0.65
    shapes = [case["inputs"].get("particles", study["base"]["inputs"]["particles"])[0]["shape"] for case in study["cases"]]
    assert shapes == ["sphere"] * 7 + ["tetrahedron", "cube"]
    # "10 spheres for the cubic sphere cluster simulations"
    assert study["cases"][8]["inputs"]["drum"]["length"] == pytest.approx(10 * 0.00378)


@pytest.mark.parametrize("name, omega2, turns", [("figure5", 1.0, 7), ("figure7", 2.2, 14)])
def test_fast_drums_turn_at_the_papers_rate(name, omega2, turns):
    """Omega_i^2 = omega^2 R_i/g, R_i = R_d sqrt(1 - fill); the rate is written with four decimals."""
    inputs = STUDIES[name]["base"]["inputs"]
    inner = inputs["drum"]["diameter"] / 2 * numpy.sqrt(1 - inputs["fill_fraction"])
    assert inputs["drum"]["rotation_rate"] ** 2 * inner / 9.81 == pytest.approx(omega2, rel=2e-5)
    assert inputs["contact"]["friction"] == 0.2 and inputs["wall"]["friction"] == 0.5 and inputs["duration"]["revolutions"] == turns


def test_drums_of_other_sizes_turn_at_the_same_froude_number():
    study = STUDIES["size-scaling"]
    drums = [case["inputs"]["drum"] for case in study["cases"]]
    assert [drum["diameter"] / 0.126 for drum in drums] == [0.5, 1.0, 2.0]
    froude = [drum["rotation_rate"] ** 2 * drum["diameter"] for drum in drums]
    assert froude == pytest.approx([froude[1]] * 3, rel=1e-5)


def test_a_process_without_a_seed_is_not_repeated_but_varied(daemon):
    study = {"base": {"process": "granule", "inputs": {"friction": 0.1}}, "vary": {"/inputs/friction": [0.5, 1.0]}}
    (pointer, detail), = errors_of(post(daemon, study | {"repeats": 2}))
    assert pointer == "/repeats" and "granule" in detail and "seed" in detail
    study = submit(daemon, study)
    assert ended(daemon, study)["status"] == "successful"
    rows = daemon.get(f"/studies/{study}/results").json()["cases"]
    for row, job in zip(rows, jobs_of(daemon, study)[::-1], strict=True):
        result = daemon.get(f"/jobs/{job['jobID']}/results").json()["granule"]
        found = row["results"]["minimum_omega2"]
        assert found["standard_error"] == pytest.approx(result["error"], rel=0.05)  # two digits
        assert abs(found["mean"] - result["minimum_omega2"]) <= 0.05 * result["error"]
        assert found["error_from"] == "run"
        assert row["inputs"] == {"friction": job["summary"]["friction"]} and "angle_deg" not in row["results"]


def test_a_study_with_the_real_worker(daemon):
    study = submit(daemon, {"name": "real", "base": {"inputs": SPEC}, "vary": {FRICTION: [0.1, 0.6]}, "repeats": 3})
    assert ended(daemon, study, 120)["status"] == "successful"
    for row in daemon.get(f"/studies/{study}/results").json()["cases"]:
        results = [daemon.get(f"/jobs/{job['jobID']}/results").json() for job in jobs_of(daemon, study) if job["label"]["case"] == row["case"]]
        assert {result["run"]["seed"] for result in results} == {7, 8, 9}
        for part, name in (("repose", "angle_deg"), ("repose", "maximum_deg"), ("packing", "solid_fraction"), ("run", "maximum_overlap")):
            values = [result[part][name] for result in results]
            own = [result["repose"]["standard_error_deg"] for result in results] if name == "angle_deg" else [0.0]
            found = row["results"][name]
            assert [found["mean"], found["standard_error"]] == mean_and_error(values, own=numpy.sqrt(numpy.mean(numpy.square(own))))


def test_a_retry_takes_the_failed_jobs_of_a_study_and_no_other(fake):
    cases = [{"name": name, "label": {"fake": name}} for name in ("quick", "numerical", "dies")]
    study = submit(fake, {"base": {"inputs": SPEC}, "cases": cases})
    assert ended(fake, study)["counts"] | {"successful": 1, "failed": 2} == ended(fake, study)["counts"]
    before = {job["jobID"]: job for job in fake.get(f"/jobs?study={study}").json()["jobs"]}
    answer = requests.post(f"{fake.url}/studies/{study}/retry", timeout=30)
    assert answer.status_code == 200 and answer.json()["counts"]["failed"] == 0, answer.text
    assert ended(fake, study)["counts"]["failed"] == 2
    for job in fake.get(f"/jobs?study={study}").json()["jobs"]:
        was = before[job["jobID"]]
        assert (job["attempt"] > was["attempt"]) == (was["status"] == "failed")
    good = submit(fake, {"base": {"inputs": SPEC, "label": {"fake": "quick"}}})
    ended(fake, good)
    assert requests.post(f"{fake.url}/studies/{good}/retry", timeout=30).status_code == 409
    assert requests.post(f"{fake.url}/studies/20200101-000000-00000000/retry", timeout=30).status_code == 404
