"""The life of a job, told by the daemon's answers."""
import csv
import io
import shutil
import sqlite3
import time

import pytest
import requests

from conftest import FAKE_WORKER, SPEC, Daemon

OGC = "http://www.opengis.net/def/exceptions/ogcapi-processes-1/1.0/"


def test_a_job_goes_from_accepted_to_its_results(fake):
    answer = fake.post(label={"project": "first"}, headers={"Prefer": "respond-async"})
    assert answer.status_code == 201
    info = answer.json()
    assert answer.headers["Location"] == f"{fake.url}/jobs/{info['jobID']}"
    assert answer.headers["Preference-Applied"] == "respond-async"
    assert info["status"] in ("accepted", "running") and info["type"] == "process" and info["processID"] == "drum"
    assert info["estimate"]["memory_bytes"] > 0 and info["estimate"]["wall_seconds"] > 0
    settling = [info["estimate"][f"settling_seconds{end}"] for end in ("_low", "", "_high")]
    assert 0 < settling[0] < settling[1] < settling[2] < info["estimate"]["simulated_seconds"] * 2
    job = fake.job(info["jobID"], wait=20)
    assert job["status"] == "successful" and job["progress"] == 100 and job["attempt"] == 1
    assert job["created"] <= job["started"] <= job["finished"] <= job["updated"]
    assert job["label"] == {"project": "first"}
    assert job["summary"]["angle_deg"] == 23.5 and job["summary"]["regime"] == "rolling"
    assert job["summary"]["friction"] == SPEC["contact"]["friction"]
    results = fake.get(f"/jobs/{info['jobID']}/results").json()
    assert results["repose"]["angle_deg"] == 23.5 and results["run"]["steps"] == 2000


def test_strange_events_of_a_worker_neither_stop_its_job_nor_spoil_an_answer(fake):
    job, seen = fake.submit(seconds=40), set()
    lines = ['{"event":"progress","phase":"%s"}' % ("\u20ac" * 9), '{"event":"sample","number":1e300,"values":{}}',
             '{"event":"sample","number":9223372036854775807,"step":1e300,"time":-1e300,"values":{"angle_deg":{"a":[]}}}',
             '{"event":"checkpoint","step":1e300,"attempt":-1e300}']
    events = fake.data / "jobs" / job / "events.ndjson"
    until = time.time() + 20
    while "\u20ac" * 7 not in seen and time.time() < until:
        if events.exists():
            with events.open("a") as file:
                file.write("\n".join(lines) + "\n")
        time.sleep(0.3)
        for path in ("/jobs", f"/jobs/{job}", f"/jobs/{job}/samples", f"/jobs/{job}/samples?format=csv"):
            assert fake.get(path).status_code == 200
        seen.add(fake.job(job)["message"])
    assert "\u20ac" * 7 in seen  # 23 bytes of the nine characters: seven, and no part of another


def test_results_outlive_the_job_folder(fake):
    job = fake.submit()
    fake.ended(job)
    for path in sorted((fake.data / "jobs" / job).rglob("*"), reverse=True):
        path.rmdir() if path.is_dir() else path.unlink()
    assert fake.get(f"/jobs/{job}/results").json()["repose"]["angle_deg"] == 23.5
    assert fake.get(f"/jobs/{job}/spec").json()["inputs"]["seed"] == 7
    assert fake.get(f"/jobs/{job}/snapshots/0.hdf").status_code == 404


def test_the_spec_is_in_the_database_before_the_answer_and_in_the_folder_when_a_worker_has_it(fake):
    job = fake.submit()
    with sqlite3.connect(f"file:{fake.data}/reposed.sqlite?mode=ro", uri=True, timeout=30) as database:
        spec, = database.execute("SELECT spec FROM job WHERE id=?", (job,)).fetchone()
    database.close()
    fake.ended(job)
    assert spec == fake.get(f"/jobs/{job}/spec").text == (fake.data / "jobs" / job / "spec.json").read_text()


def test_progress_is_told_while_it_runs(fake):
    job = fake.submit(fake="slow", seconds="6")
    seen = fake.until(job, lambda info: info["progress"] > 0)
    assert seen["status"] == "running" and seen["message"] == "rotating" and 0 < seen["eta_seconds"] <= 6
    answer = fake.get(f"/jobs/{job}/results")
    assert answer.status_code == 404 and answer.json()["type"] == OGC + "result-not-ready"


def test_waiting_ends_with_the_job_or_with_the_time(fake):
    job = fake.submit(fake="slow", seconds="2")
    start = time.monotonic()
    assert fake.job(job, wait=1)["status"] == "running"
    assert 0.9 < time.monotonic() - start < 1.7  # the second asked for, and no tick of the rounds on top
    assert fake.job(job, wait=30)["status"] == "successful"
    assert time.monotonic() - start < 10
    assert fake.get(f"/jobs/{job}?wait=61").status_code == 400


def test_dismissing_a_running_job_stops_its_worker(fake):
    job = fake.submit(fake="slow", seconds="60")
    fake.until(job, lambda info: info["status"] == "running" and fake.workers())
    answer = requests.delete(f"{fake.url}/jobs/{job}")
    assert answer.status_code == 200 and answer.json()["status"] == "dismissed"
    end = time.monotonic() + 8
    while fake.workers():
        assert time.monotonic() < end
        time.sleep(0.05)
    assert fake.job(job)["status"] == "dismissed"
    assert requests.delete(f"{fake.url}/jobs/{job}").status_code == 200  # twice is no mistake
    assert fake.get(f"/jobs/{job}/results").status_code == 404


def test_a_worker_that_ignores_the_request_is_killed(fake):
    job = fake.submit(fake="stubborn", seconds="60")
    fake.until(job, lambda info: info["progress"] > 0)
    requests.delete(f"{fake.url}/jobs/{job}")
    time.sleep(2)
    assert fake.workers()  # it was asked, and stayed
    end = time.monotonic() + 8
    while fake.workers():
        assert time.monotonic() < end
        time.sleep(0.1)


def test_an_ended_job_is_kept_where_it_is_only_to_be_dismissed(fake):
    job = fake.submit()
    fake.ended(job)
    answer = requests.delete(f"{fake.url}/jobs/{job}?only=dismiss")
    assert answer.status_code == 409 and "successful" in answer.json()["detail"]
    assert fake.job(job)["status"] == "successful"


@pytest.mark.parametrize("what, message", [("numerical", "overlap of 0.7 radii at step 12"), ("fault", "a word on standard error"),
                                           ("no result", "no readable result.json")])
def test_a_failed_job_says_why(fake, what, message):
    job = fake.submit(fake=what)
    info = fake.ended(job)
    assert info["status"] == "failed" and message in info["message"] and info["attempt"] == 1
    answer = fake.get(f"/jobs/{job}/results")
    assert answer.status_code == 404 and message in answer.json()["detail"]
    assert answer.headers["Content-Type"] == "application/problem+json"
    if what == "numerical":
        assert answer.json()["failure"]["detail"] == {"step": 12}
    assert "a word on standard error" in fake.get(f"/jobs/{job}/log").text


@pytest.mark.parametrize("what, message", [("disk", "could not write to the disk"), ("machine", "did not give")])
def test_what_the_machine_lacks_puts_a_job_off(fake, what, message):
    info = fake.until(fake.submit(fake=what), lambda info: message in info["message"])
    assert info["status"] == "accepted" and info["attempt"] == 1 and "a word on standard error" in info["message"]


@pytest.mark.torture
def test_what_the_machine_lacks_fails_no_job_however_often(fake):
    job = fake.submit(fake="disk")
    fake.until(job, lambda _: fake.log().count(f"{job}: attempt 1 started") == 4, 120)  # more often than a job may die
    info = fake.job(job)
    assert info["attempt"] == 1 and info["status"] in ("accepted", "running")


def test_the_queue_goes_on_by_itself_when_the_machine_is_sound_again(fake):
    held = [fake.submit(fake="until there is room") for _ in range(2)]
    fake.until(held[0], lambda info: "could not write to the disk" in info["message"])
    after = fake.submit()
    (fake.data / "jobs" / "room").touch()
    assert {fake.ended(job)["status"] for job in [*held, after]} == {"successful"}
    assert {fake.job(job)["attempt"] for job in held} == {1}


def test_jobs_for_which_the_machine_never_suffices_do_not_hold_up_others(fake):
    hopeless = [fake.submit(fake="machine") for _ in range(3)]
    sound = fake.submit()
    assert fake.ended(sound, 20)["status"] == "successful"
    assert {fake.job(job)["status"] for job in hopeless} <= {"accepted", "running"}


def test_a_clock_set_back_does_not_hold_up_a_job_that_was_put_off(fake):
    import sqlite3
    job = fake.submit(fake="disk")
    fake.until(job, lambda info: "disk" in info["message"])
    fake.stop()
    with sqlite3.connect(fake.data / "reposed.sqlite") as database:  # as if the clock had been a day ahead then
        database.execute("UPDATE job SET not_before = not_before + 86400, message = ''")
    fake.start()
    fake.until(job, lambda info: "disk" in info["message"], 10)


def test_a_worker_program_that_is_gone_holds_up_jobs_and_fails_none(tmp_path):
    program = tmp_path / "worker"
    shutil.copy(FAKE_WORKER, program)
    daemon = Daemon(tmp_path, worker=program).start()
    program.unlink()
    try:
        job = daemon.submit()
        info = daemon.until(job, lambda info: "can't be started" in info["message"])
        assert "No such file or directory" in info["message"] and info["status"] == "accepted" and info["attempt"] == 1
        shutil.copy(FAKE_WORKER, program)
        assert daemon.ended(job)["status"] == "successful"
    finally:
        daemon.stop()


def test_numbers_come_back_as_they_were_written(fake):
    job = fake.submit(mu=0.1)
    fake.ended(job)
    assert '"diameter": 0.004,' in fake.get(f"/jobs/{job}/spec").text
    assert fake.get("/query", params={"sql": "select label from run_summary", "format": "csv"}).text.splitlines()[1] == '"{""mu"":0.1}"'


def test_samples_come_as_json_and_csv_a_page_at_a_time(fake):
    job = fake.submit()
    fake.ended(job)
    samples = fake.get(f"/jobs/{job}/samples").json()["samples"]
    assert [sample["number"] for sample in samples] == list(range(20))
    assert samples[3]["values"] == {"angle_deg": 23.0, "wall_slip": 0.5} and samples[0]["values"]["wall_slip"] is None
    page = fake.get(f"/jobs/{job}/samples?limit=15").json()
    rest = fake.get(next(link["href"] for link in page["links"] if link["rel"] == "next")).json()
    assert page["samples"] + rest["samples"] == samples and len(rest["links"]) == 1
    for answer in (fake.get(f"/jobs/{job}/samples?format=csv"), fake.get(f"/jobs/{job}/samples", headers={"Accept": "text/csv"})):
        rows = list(csv.DictReader(io.StringIO(answer.text)))
        assert len(rows) == 20 and float(rows[3]["angle_deg"]) == 23.0 and rows[0]["wall_slip"] == ""
    assert fake.get(f"/jobs/{job}/samples?format=xml").status_code == 400


def test_the_list_is_newest_first_filtered_and_paged(fake):
    jobs = [fake.submit(project=f"p{i}", fake="fault" if i % 2 else "quick") for i in range(6)]
    for job in jobs:
        fake.ended(job)
    everything = fake.get("/jobs").json()
    assert [info["jobID"] for info in everything["jobs"]] == jobs[::-1]
    assert everything["counts"] == {"accepted": 0, "running": 0, "successful": 3, "failed": 3, "dismissed": 0}
    assert [info["jobID"] for info in fake.get("/jobs?status=failed").json()["jobs"]] == jobs[5::-2]
    assert [info["jobID"] for info in fake.get("/jobs?status=failed,successful&q=P4").json()["jobs"]] == [jobs[4]]
    assert fake.get("/jobs?processID=heap").json()["jobs"] == []
    seen, path = [], "/jobs?status=failed&limit=2&q=p"
    while path:
        page = fake.get(path).json()
        seen += [info["jobID"] for info in page["jobs"]]
        path = next((link["href"] for link in page["links"] if link["rel"] == "next"), None)
        assert path is None or "status=failed" in path and "q=p" in path
    assert seen == jobs[5::-2]
    for bad in ("status=done", "limit=0", "cursor=x", "stauts=failed", "q=%00", "limit=1&limit=2"):
        assert fake.get(f"/jobs?{bad}").status_code == 400, bad


def test_jobs_of_more_threads_take_more_of_the_machine(tmp_path, fake):
    wide = fake.submit(SPEC | {"threads": 2}, fake="slow", seconds="2")
    narrow = fake.submit(fake="quick")
    fake.until(wide, lambda info: info["status"] == "running")
    assert fake.job(narrow)["status"] == "accepted"  # two workers of one thread: both threads are taken
    assert fake.ended(wide)["finished"] <= fake.ended(narrow)["started"]


def test_tables_bear_the_results(fake):
    job = fake.submit(project="tables")
    fake.ended(job)
    fake.submit(fake="fault")
    with sqlite3.connect(f"file:{fake.data / 'reposed.sqlite'}?mode=ro", uri=True) as database:
        database.row_factory = sqlite3.Row
        rows = database.execute("SELECT * FROM run_summary").fetchall()
        assert len(rows) == 1
        row = dict(rows[0])
        strict = database.execute("SELECT count(*) FROM pragma_table_list WHERE type='table' AND strict=0 AND schema='main'"
                                  " AND name NOT LIKE 'sqlite%'").fetchone()[0]
    assert strict == 0
    expected = {"id": job, "process": "drum", "status": "successful", "friction": 0.3, "angle_deg": 23.5, "regime": "rolling",
                "steady": 1, "verdict": "steady", "certain": 1, "drift_bound_deg_per_revolution": 0.4, "layers": 6.5, "seed": 7, "solid_fraction": 0.59, "steps": 2000, "radial_index": None, "attempt": 1,
                "slumps_count": 12, "slumps_period": 0.56, "slumps_start_deg": 13.5, "slumps_stop_deg": None, "hysteresis_deg": 15.5, "overlap_99": 0.004,
                "torque": 0.012, "power": 0.019}
    assert {name: row[name] for name in expected} == expected
