"""Lists of jobs by what they were given and what came out: filters, orders and pages, beside what SQL and Python make of the same
tables."""
import csv
import io
import json
import random
import sqlite3
from urllib.parse import quote

import pytest
import requests
from conftest import FAKE_WORKER, SPEC, run_daemon

JOBS = 60
STATES = ["accepted", "running", "successful", "failed", "dismissed"]


@pytest.fixture(scope="module")
def filled(tmp_path_factory):
    """Jobs of three studies and single ones, half of which have results; the tables are filled in while no daemon looks."""
    folder = tmp_path_factory.mktemp("lists")
    running = run_daemon(folder, worker=FAKE_WORKER, options=["--workers", "1"])
    daemon = next(running)
    daemon.until(daemon.submit(seconds=1000), lambda job: job["status"] == "running")
    for name in ("Axial flow", "axial", "radial"):
        study = {"name": name, "base": {"inputs": SPEC, "label": {"project": name, "n": 3}},
                 "vary": {"/inputs/contact/friction": [0.1 * k for k in range(1, 9)]}, "repeats": 2}
        assert requests.post(f"{daemon.url}/studies", json=study, timeout=30).status_code == 201
    for k in range(JOBS - 48 - 1):
        daemon.submit(SPEC | {"contact": {"friction": 0.3}}, number=k, text='Ä "quoted" Text')
    daemon.stop()
    chance = random.Random(7)
    with sqlite3.connect(daemon.data / "reposed.sqlite") as database:
        for number, in database.execute("SELECT number FROM job ORDER BY number").fetchall():
            if number == 1 or number % 2:
                continue
            database.execute("UPDATE job SET status=?, started=created, finished=created, progress=? WHERE number=?",
                             (chance.choice(["successful", "failed"]), chance.randint(0, 100), number))
            database.execute("INSERT INTO repose_result(job,angle_deg,steady,verdict) VALUES(?,?,?,?)",
                             (number, chance.choice([None, 20.0, 25.5, chance.uniform(10, 40)]), chance.choice([0, 1, None]),
                              chance.choice(["steady", "drifting", "too-short"])))
    daemon.start()
    yield daemon
    for _ in running:
        pass


def rows_of(daemon):
    """All jobs as the tables have them, newest first."""
    with sqlite3.connect(f"file:{daemon.data}/reposed.sqlite?mode=ro", uri=True) as database:
        database.row_factory = sqlite3.Row
        return [dict(row) for row in database.execute(
            "SELECT job.*, study.id AS study_id, friction, angle_deg, steady, verdict FROM job LEFT JOIN study ON study.number=job.study"
            " JOIN drum_input ON drum_input.job=job.number LEFT JOIN repose_result ON repose_result.job=job.number"
            " ORDER BY job.number DESC")]


def between(name, low, high):
    return lambda row: row[name] is not None and low <= row[name] <= high


def has_text(text):
    small = text.encode().lower().decode()  # of ASCII alone
    return lambda row: small in row["label"].encode().lower().decode() or text in row["id"]


FILTERS = [
    ("q=axial", has_text("axial")), ("q=AXIAL%20f", has_text("AXIAL f")), ("q=nowhere", has_text("nowhere")), ("q=a", has_text("a")),
    ("q=%C3%84", has_text("Ä")), ("q=%C3%A4", has_text("ä")), ("q=-", has_text("-")), ("q=20", has_text("20")), ("q=", lambda row: True),
    ("value.friction=0.25..0.45", between("friction", 0.25, 0.45)), ("value.friction=0.3", between("friction", 0.3, 0.3)),
    ("value.angle_deg=25.5..", between("angle_deg", 25.5, 1e9)), ("value.angle_deg=..20", between("angle_deg", -1e9, 20)),
    ("value.angle_deg=20&value.friction=..0.5", lambda row: row["angle_deg"] == 20 and row["friction"] <= 0.5),
    ("value.verdict=steady", lambda row: row["verdict"] == "steady"),
    ("value.verdict=steady,drifting", lambda row: row["verdict"] in ("steady", "drifting")), ("value.verdict=stea", lambda row: False),
    ("value.steady=true", lambda row: row["steady"] == 1), ("value.steady=false", lambda row: row["steady"] == 0),
    ("value.progress=1..99", between("progress", 1, 99)), ("label.project=axial", lambda row: json.loads(row["label"]).get("project") == "axial"),
    ("label.n=3&q=radial", lambda row: json.loads(row["label"]).get("project") == "radial"),
    ("processID=drum&value.friction=0.3..", between("friction", 0.3, 99)), ("processID=heap", lambda row: False),
]
ORDERS = ["", "sort=angle_deg", "sort=-angle_deg", "sort=friction", "sort=-verdict", "sort=verdict", "sort=created", "sort=-finished",
          "sort=progress"]


def ordered(rows, order):
    name = order.removeprefix("sort=").lstrip("-")
    if not name:
        return rows
    known = [row for row in rows if row[name] is not None]
    known.sort(key=lambda row: row[name], reverse=False)
    if "=-" in order:  # the newest first among equal ones, either way
        known = sorted(known, key=lambda row: -row["number"])
        known.sort(key=lambda row: row[name], reverse=True)
    return known + [row for row in rows if row[name] is None]


def pages(daemon, path):
    seen, counts = [], []
    while path:
        answer = daemon.get(path)
        assert answer.status_code == 200, answer.text
        page = answer.json()
        seen += [job["jobID"] for job in page["jobs"]]
        counts.append(page["counts"])
        path = next((link["href"] for link in page["links"] if link["rel"] == "next"), None)
    assert all(count == counts[0] for count in counts)
    return seen, counts[0]


@pytest.mark.parametrize("query, fits", FILTERS)
def test_a_filter_lets_through_what_fits_and_counts_it(filled, query, fits):
    expected = [row for row in rows_of(filled) if fits(row)]
    found, counts = pages(filled, f"/jobs?{query}&limit=7")
    assert found == [row["id"] for row in expected]
    assert counts == {state: sum(row["status"] == state for row in expected) for state in STATES}
    states = [row["id"] for row in expected if row["status"] in ("failed", "accepted")]
    assert pages(filled, f"/jobs?{query}&status=failed,accepted&limit=5") == (states, counts)


@pytest.mark.parametrize("order", ORDERS)
def test_a_list_is_sorted_by_any_column(filled, order):
    rows = rows_of(filled)
    assert pages(filled, f"/jobs?{order}&limit=7")[0] == [row["id"] for row in ordered(rows, order)]
    some = [row for row in rows if row["friction"] < 0.45 and row["status"] == "successful"]
    assert pages(filled, f"/jobs?value.friction=..0.45&status=successful&limit=3&{order}")[0] == [row["id"] for row in ordered(some, order)]


def test_any_piece_of_an_id_finds_its_job(filled):
    ids = [row["id"] for row in rows_of(filled)]
    chance = random.Random(3)
    for _ in range(40):
        begin = chance.randrange(24)
        piece = chance.choice(ids)[begin:begin + chance.randint(1, 24)]
        expected = [row["id"] for row in rows_of(filled) if has_text(piece)(row)]
        assert pages(filled, f"/jobs?limit=500&q={quote(piece)}")[0] == expected, piece


def test_a_list_as_csv_is_whole_or_says_where_it_goes_on(filled):
    """Also of more jobs than a piece of the answer has."""
    rows = ordered(rows_of(filled), "sort=-angle_deg")
    for request in ({"params": {"f": "csv", "sort": "-angle_deg"}}, {"params": {"sort": "-angle_deg"}, "headers": {"Accept": "text/csv"}}):
        answer = filled.get("/jobs", **request)
        assert answer.headers["Content-Type"].startswith("text/csv") and "Link" not in answer.headers
        table = list(csv.DictReader(io.StringIO(answer.text)))
        assert [row["jobID"] for row in table] == [row["id"] for row in rows]
        assert [row["angle_deg"] and float(row["angle_deg"]) or None for row in table] == [row["angle_deg"] for row in rows]
        assert [json.loads(row["label"]) for row in table] == [json.loads(row["label"]) for row in rows]
        assert [float(row["friction"]) for row in table] == [row["friction"] for row in rows]
    seen, path = [], "/jobs?f=csv&limit=7&q=axial&status=accepted&sort=friction"
    while path:
        answer = filled.get(path)
        seen += [row["jobID"] for row in csv.DictReader(io.StringIO(answer.text))]
        path = answer.links["next"]["url"] if "next" in answer.links else None
    assert seen == pages(filled, "/jobs?limit=7&q=axial&status=accepted&sort=friction")[0] and len(seen) > 7


def test_a_long_list_as_csv_is_whole(tmp_path):
    running = run_daemon(tmp_path, worker=FAKE_WORKER, options=["--workers", "1"])
    one = next(running)
    one.until(one.submit(seconds=1000), lambda job: job["status"] == "running")
    study = {"name": "many", "base": {"inputs": SPEC}, "vary": {"/inputs/contact/friction": [0.001 * k for k in range(1, 1202)]}}
    assert requests.post(f"{one.url}/studies", json=study, timeout=60).status_code == 201
    for query, count in (("", 1202), ("q=many", 1201), ("sort=friction&value.friction=..0.7005", 701)):
        table = list(csv.DictReader(io.StringIO(one.get(f"/jobs?f=csv&{query}").text)))
        assert len(table) == len({row["jobID"] for row in table}) == count
        if "sort" in query:
            assert [float(row["friction"]) for row in table] == sorted(float(row["friction"]) for row in table)
    for _ in running:
        pass


def test_all_that_is_wrong_is_told_at_once(filled):
    answer = filled.get("/jobs?value.angel_deg=3&sort=-colour&value.friction=high&value.steady=1&status=done&limit=0&value.angle_deg=9..3"
                        "&value.created=3&cursor=x&minDuration=-1")
    assert answer.status_code == 400
    errors = {error["pointer"]: error["detail"] for error in answer.json()["errors"]}
    assert set(errors) == {"/value.angel_deg", "/sort", "/value.friction", "/value.steady", "/status", "/limit", "/value.angle_deg",
                           "/value.created", "/cursor", "/minDuration"}
    assert "perhaps it is angle_deg" in errors["/value.angel_deg"] and '"colour"' in errors["/sort"]
    assert '"high"' in errors["/value.friction"]
    for query in ("cursor=5:3", "sort=angle_deg&cursor=5", "sort=angle_deg&cursor=5:x", "value.friction=", "value.verdict=", "value.=1",
                  "value.friction=..", "value.friction=nan", "&".join(f"value.friction{k}=1" for k in range(3))):
        assert filled.get(f"/jobs?{query}").status_code == 400, query


def test_lists_follow_what_changes(tmp_path):
    """As soon as a POST or DELETE is answered, and when a worker ends, the same lists show it."""
    running = run_daemon(tmp_path, worker=FAKE_WORKER, options=["--workers", "1"])
    one = next(running)
    assert one.get("/jobs?q=apple&sort=friction").json()["jobs"] == []
    jobs = [one.submit(SPEC | {"contact": {"friction": 0.1 * k}}, fruit="Apple", seconds=0) for k in (3, 1, 2)]
    found, counts = pages(one, "/jobs?q=apple&sort=friction&limit=1")
    assert found == [jobs[1], jobs[2], jobs[0]] and sum(counts.values()) == 3
    for job in jobs:
        assert one.ended(job)["status"] == "successful"
    assert pages(one, "/jobs?q=APPLE&sort=-friction&status=successful&limit=2")[0] == [jobs[0], jobs[2], jobs[1]]
    assert one.get("/jobs?q=apple&value.angle_deg=0..90").json()["counts"]["successful"] == 3
    assert requests.delete(f"{one.url}/jobs/{jobs[2]}", timeout=30).status_code == 200
    assert pages(one, "/jobs?q=apple&sort=friction")[0] == [jobs[1], jobs[0]]
    for _ in running:
        pass
