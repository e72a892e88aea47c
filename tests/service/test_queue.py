"""In what order jobs run: by priority, and clients take turns; a job that waits says where it stands."""
import sqlite3
from datetime import datetime, timezone

import pytest
import requests
from conftest import FAKE_WORKER, SPEC, run_daemon


@pytest.fixture
def one(tmp_path):
    """With a place for one job."""
    yield from run_daemon(tmp_path, worker=FAKE_WORKER, options=["--workers", "1"])


def post(daemon, priority=None, **label):
    body = {"inputs": SPEC, "label": label} | ({} if priority is None else {"priority": priority})
    return requests.post(f"{daemon.url}/processes/drum/execution", json=body, timeout=30)


def order_of(daemon, jobs):
    """The names of these jobs in the order in which they started."""
    for job in jobs.values():
        assert daemon.ended(job)["status"] == "successful"
    return sorted(jobs, key=lambda name: daemon.job(jobs[name])["started"])


def test_jobs_run_by_priority_and_clients_take_turns(one):
    first = one.submit(seconds=100)
    one.until(first, lambda job: job["status"] == "running")
    jobs = {}
    for name, priority in (("a1", None), ("a2", 0), ("a3", 0), ("b1", 0), ("b2", 0), ("low", -3), ("high", 10), ("c1", 0)):
        answer = post(one, priority, client=name[0], fake="quick")
        assert answer.status_code == 201 and answer.json()["priority"] == (priority or 0), answer.text
        jobs[name] = answer.json()["jobID"]
    study = {"base": {"inputs": SPEC, "label": {"client": "d"}}, "vary": {"/inputs/contact/friction": [0.1, 0.2]}, "priority": 5}
    answer = requests.post(f"{one.url}/studies", json=study, timeout=30)
    assert answer.json()["priority"] == 5, answer.text
    of_study = one.get(f"/jobs?study={answer.json()['studyID']}").json()["jobs"]
    assert [job["priority"] for job in of_study] == [5, 5]
    jobs |= {name: job["jobID"] for name, job in zip(("d1", "d2"), sorted(of_study, key=lambda job: job["summary"]["friction"]))}
    expected = ["high", "d1", "d2", "a1", "b1", "c1", "a2", "b2", "a3", "low"]
    waiting = {name: one.job(jobs[name]) for name in expected}
    assert [waiting[name]["position"] for name in expected] == list(range(1, 11))
    starts = [datetime.fromisoformat(waiting[name]["expected_start"]) for name in expected]
    assert starts == sorted(starts) and starts[0] < starts[-1]
    requests.delete(f"{one.url}/jobs/{first}", timeout=30)
    assert order_of(one, jobs) == expected
    assert "position" not in one.job(jobs["low"])


def test_who_comes_late_waits_no_longer_than_a_turn(one):
    """A client's turn does not lie behind all jobs that another one has posted before, nor before those that wait since long."""
    first = one.submit(seconds=100)
    one.until(first, lambda job: job["status"] == "running")
    jobs = {f"a{i}": post(one, client="a", fake="quick").json()["jobID"] for i in range(4)}
    jobs["b0"] = post(one, client="b", fake="quick").json()["jobID"]
    requests.delete(f"{one.url}/jobs/{first}", timeout=30)
    assert order_of(one, jobs) == ["a0", "b0", "a1", "a2", "a3"]
    second = one.submit(seconds=100)  # what has run counts no more
    one.until(second, lambda job: job["status"] == "running")
    jobs = {f"a{i}": post(one, client="a", fake="quick").json()["jobID"] for i in range(2)}
    jobs["c0"] = post(one, client="c", fake="quick").json()["jobID"]
    requests.delete(f"{one.url}/jobs/{second}", timeout=30)
    assert order_of(one, jobs) == ["a0", "c0", "a1"]


def test_a_priority_is_a_whole_number_from_minus_ten_to_ten(one):
    for priority in (11, -11, 1.5, "high", True, [1]):
        answer = post(one, priority)
        assert answer.status_code == 400 and answer.json()["errors"][0]["pointer"] == "/priority", answer.text
        study = requests.post(f"{one.url}/studies", json={"base": {"inputs": SPEC}, "priority": priority}, timeout=30)
        assert study.status_code == 400 and [e["pointer"] for e in study.json()["errors"]] == ["/priority"], study.text


def test_the_next_job_is_found_without_a_look_at_the_others(one):
    """By the plan of the very statements: with a scan, the time to claim a job would grow with the number that wait."""
    with sqlite3.connect(f"file:{one.data}/reposed.sqlite?mode=ro", uri=True) as database:
        plan = database.execute("EXPLAIN QUERY PLAN SELECT number FROM job INDEXED BY job_waiting_turn WHERE status='accepted'"
                                " AND not_before NOT BETWEEN 1 AND 2 ORDER BY priority DESC, turn, number LIMIT 1").fetchall()
    assert len(plan) == 1 and "USING INDEX job_waiting_turn" in plan[0][3]


def test_jobs_are_found_by_a_member_of_their_label(one):
    labels = [{"project": "axial"}, {"project": "axial", "1": "x"}, {"project": "axial flow"}, {"other": "axial"},
              {"project": 3}, {"project": 1.5}, {"a.b": "dot", '"': "quote", "$": "money", "[0]": "list"}, {}]
    jobs = [post(one, **label).json()["jobID"] for label in labels]

    def found(**parameters):
        answer = one.get("/jobs", params={name.replace("label_", "label."): value for name, value in parameters.items()})
        assert answer.status_code == 200, answer.text
        listed = answer.json()
        assert sum(listed["counts"].values()) == len(listed["jobs"]) or "limit" in parameters
        return [jobs.index(job["jobID"]) for job in listed["jobs"]]

    for name, value in (("project", "axial"), ("project", "3"), ("project", "1.5"), ("1", "x"), ("a.b", "dot"), ('"', "quote"),
                        ("$", "money"), ("[0]", "list"), ("project", "Axial"), ("nothing", "")):
        expected = [i for i, label in enumerate(labels) if str(label.get(name, "missing")) == value]
        assert found(**{f"label_{name}": value}) == expected[::-1], (name, value)
    page = one.get("/jobs?label.project=axial&limit=1").json()
    second = one.get(next(link["href"] for link in page["links"] if link["rel"] == "next")).json()
    assert [job["jobID"] for job in page["jobs"] + second["jobs"]] == jobs[1::-1]
    for query in ("label.=x", "label.project=axial&label.other=axial", "lable.project=axial", "label.project=a&label.project=b"):
        assert one.get(f"/jobs?{query}").status_code == 400, query


# --- short jobs do not wait for long ones ---

LONG = SPEC | {"duration": {"seconds": 900.0}, "snapshots": {"interval": 0}}  # takes minutes, by its estimate


def post_long(daemon, **label):
    body = {"inputs": LONG, "label": {"fake": "slow", "seconds": 100} | label}
    answer = requests.post(f"{daemon.url}/processes/drum/execution", json=body, timeout=30)
    assert answer.status_code == 201 and answer.json()["estimate"]["wall_seconds"] > 10, answer.text
    return answer.json()["jobID"]


@pytest.fixture
def two(tmp_path):
    yield from run_daemon(tmp_path, worker=FAKE_WORKER, options=["--workers", "2"])


def test_a_short_job_behind_long_ones_starts_soon_and_one_at_a_time(two):
    long = [post_long(two, client="a") for _ in range(5)]
    two.until(long[1], lambda job: job["status"] == "running")
    busy = two.submit(client="b", seconds=3)
    two.until(busy, lambda job: job["status"] == "running")
    assert [two.job(job)["status"] for job in long] == ["running"] * 2 + ["accepted"] * 3
    waiting = {name: post(two, priority, client="b", fake="quick").json()["jobID"]
               for name, priority in (("first", 0), ("second", 0), ("high", 5))}
    places = {name: two.job(job) for name, job in waiting.items()}
    assert [places[name].get("position") for name in ("high", "first", "second")] == [1, 2, 3]
    starts = [datetime.fromisoformat(places[name]["expected_start"]) for name in ("high", "first", "second")]
    last_long = two.job(long[4])
    assert starts == sorted(starts) and (starts[-1] - datetime.now(timezone.utc)).total_seconds() < 10
    assert (datetime.fromisoformat(last_long["expected_start"]) - starts[-1]).total_seconds() > 60
    assert last_long["position"] == 6  # two long ones are before it, and the short ones by priority or by turn
    assert order_of(two, waiting) == ["high", "first", "second"]
    ended, begun = two.job(busy)["finished"], two.job(waiting["high"])["started"]
    assert ended <= begun  # one place, for one at a time
    assert [two.job(job)["status"] for job in long] == ["running"] * 2 + ["accepted"] * 3


def test_short_jobs_that_overtake_put_nobody_back(two):
    """Many of one client run beside the long ones; the turn of another client's long job is not behind theirs."""
    for _ in range(2):
        post_long(two, client="a")
    waiting = [post_long(two, client="a") for _ in range(3)]
    short = [two.submit(client="c") for _ in range(8)]
    for job in short:
        assert two.ended(job)["status"] == "successful"
    late = post_long(two, client="b")
    assert [two.job(job)["position"] for job in (waiting[0], late, waiting[1], waiting[2])] == [1, 2, 3, 4]


def test_the_lane_stays_shut_while_a_short_job_has_a_place(one):
    first = one.submit(seconds=6)
    one.until(first, lambda job: job["status"] == "running")
    second = one.submit()
    assert one.ended(second)["started"] >= one.job(first)["finished"]
