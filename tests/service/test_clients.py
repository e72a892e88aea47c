"""What clients of OGC API - Processes ask of a service: filters of the list of jobs, requests in the forms that the standard
allows, and OWSLib itself."""
import socket
import sqlite3

import pytest
import requests
from conftest import FAKE_WORKER, SPEC, Daemon, read_yaml

EXECUTION = "/processes/drum/execution"
GRANULE = {"friction": 0.5, "rotation_rate": 18.0}


@pytest.fixture(scope="module")
def listed(tmp_path_factory):
    """A daemon with six ended jobs whose times a hand has written: created at noon of 1, 2, ... 6 March, run for 10, 20, ... s."""
    daemon = Daemon(tmp_path_factory.mktemp("listed"), worker=FAKE_WORKER, options=["--workers", "2"]).start()
    jobs = []
    for i in range(6):
        process, inputs = ("drum", SPEC) if i % 2 == 0 else ("granule", GRANULE)
        label = {"project": f"p{i}", "fake": "fault" if i >= 4 else "quick"}
        answer = requests.post(f"{daemon.url}/processes/{process}/execution", json={"inputs": inputs, "label": label}, timeout=30)
        jobs.append(answer.json()["jobID"])
    for job in jobs:
        daemon.ended(job)
    daemon.stop()
    with sqlite3.connect(daemon.data / "reposed.sqlite") as database:
        for i, job in enumerate(jobs):
            noon = f"2026-03-{i + 1:02}T12:00:"
            database.execute("UPDATE job SET created=?, started=?, finished=? WHERE id=?",
                             (f"{noon}00.250Z", f"{noon}01.000Z", f"2026-03-{i + 1:02}T12:00:{10 * i + 11:02}.000Z" if i < 5
                              else "2026-03-06T12:01:01.000Z", job))
    daemon.start()
    yield daemon, jobs
    daemon.stop()


FAILED = [4, 5]
LISTS = [
    ("processID=drum,granule", [0, 1, 2, 3, 4, 5]),
    ("processID=drum&processID=granule", [0, 1, 2, 3, 4, 5]),
    ("processID=granule", [1, 3, 5]),
    ("processID=granule,heap&processID=fill", [1, 3, 5]),
    ("processID=nothing", []),
    ("status=failed&status=successful", [0, 1, 2, 3, 4, 5]),
    ("status=failed,running&status=accepted", FAILED),
    ("type=process", [0, 1, 2, 3, 4, 5]),
    ("type=process,other", [0, 1, 2, 3, 4, 5]),
    ("type=other", []),
    ("datetime=2026-03-02T12:00:00.250Z", [1]),
    ("datetime=2026-03-02T12:00:00Z", [1]),
    ("datetime=2026-03-02T14:00:00%2B02:00", [1]),
    ("datetime=2026-03-02T14:00:00+02:00", [1]),
    ("datetime=2026-03-02", [1]),
    ("datetime=2026-03-02T12:00:01Z", []),
    ("datetime=2026-03-02T00:00:00Z/2026-03-04T12:00:00Z", [1, 2, 3]),
    ("datetime=2026-03-02T00:00:00Z/..", [1, 2, 3, 4, 5]),
    ("datetime=../2026-03-02T12:00:00.249Z", [0]),
    ("datetime=/2026-03-02", [0, 1]),
    ("datetime=../..", [0, 1, 2, 3, 4, 5]),
    ("minDuration=30", [2, 3, 4, 5]),
    ("maxDuration=30", [0, 1, 2]),
    ("minDuration=20&maxDuration=40", [1, 2, 3]),
    ("minDuration=20.5&maxDuration=40", [2, 3]),
    ("minDuration=50&maxDuration=10", []),
    ("processID=drum&status=failed&q=P4&datetime=2026-03-05T00:00:00Z/..&minDuration=1", [4]),
    ("f=json&q=p3", [3]),
]


@pytest.mark.parametrize("query, expected", LISTS)
def test_a_list_holds_what_the_filters_let_through(listed, query, expected):
    daemon, jobs = listed
    answer = daemon.get(f"/jobs?{query}").json()
    assert [job["jobID"] for job in answer["jobs"]] == [jobs[i] for i in reversed(expected)]
    if "status" not in query:  # every job let through is counted, by its status
        failed = [i for i in expected if i in FAILED]
        assert answer["counts"] == {"accepted": 0, "running": 0, "successful": len(expected) - len(failed), "failed": len(failed),
                                    "dismissed": 0}
    assert daemon.get(f"/jobs?{query}&limit=2").json()["counts"] == answer["counts"]


def test_pages_keep_filters_that_are_given_several_times(listed):
    daemon, jobs = listed
    seen, path = [], "/jobs?status=failed&status=successful&processID=granule&processID=drum&limit=4"
    while path:
        page = daemon.get(path).json()
        seen += [job["jobID"] for job in page["jobs"]]
        path = next((link["href"] for link in page["links"] if link["rel"] == "next"), None)
    assert seen == jobs[::-1]
    assert len(daemon.get("/jobs?limit=10000").json()["jobs"]) == 6


@pytest.mark.parametrize("query", ["datetime=yesterday", "datetime=2026-02-30", "datetime=2026-03-02T12:00:00", "datetime=", "datetime=/",
                                   "datetime=2026-03-04/2026-03-02", "datetime=2026-03-02/2026-03-03/2026-03-04", "minDuration=-1",
                                   "maxDuration=long", "minDuration=nan", "status=failed&status=lost", "limit=1&limit=2", "f=xml",
                                   "datetime=2026-03-02&datetime=2026-03-02"])
def test_what_is_no_filter_is_refused(listed, query):
    answer = listed[0].get(f"/jobs?{query}")
    assert answer.status_code == 400 and query.split("=")[0] in answer.json()["detail"], answer.text


def test_counts_are_those_of_a_study(fake):
    study = {"base": {"inputs": SPEC}, "vary": {"/inputs/contact/friction": [0.1, 0.2, 0.3]}}
    fake.submit(project="alone")
    made = requests.post(f"{fake.url}/studies", json=study, timeout=30).json()["studyID"]
    requests.get(f"{fake.url}/studies/{made}?wait=30", timeout=40)
    assert sum(fake.get(f"/jobs?study={made}").json()["counts"].values()) == 3
    assert sum(fake.get("/jobs").json()["counts"].values()) == 4


def test_processes_come_a_page_at_a_time(listed):
    daemon, _ = listed
    every = daemon.get("/processes").json()["processes"]
    seen, path = [], "/processes?limit=3"
    while path:
        page = daemon.get(path).json()
        assert len(page["processes"]) <= 3
        seen += page["processes"]
        path = next((link["href"] for link in page["links"] if link["rel"] == "next"), None)
    assert seen == every and len(daemon.get("/processes?limit=10000").json()["processes"]) == len(every)
    assert daemon.get("/processes?limit=0").status_code == 400


@pytest.mark.parametrize("path", ["/", "/conformance", "/processes", "/processes/drum", "/jobs", "/studies", "/api"])
def test_f_asks_for_json(listed, path):
    answer = listed[0].get(f"{path}?f=json", headers={"Accept": "text/html"})
    assert answer.status_code == 200 and isinstance(answer.json(), dict)


@pytest.fixture(scope="module")
def running(tmp_path_factory):
    """One daemon for all that only post."""
    daemon = Daemon(tmp_path_factory.mktemp("running"), worker=FAKE_WORKER, options=["--workers", "2"]).start()
    yield daemon
    daemon.stop()


QUALIFIED = {name: {"value": value} for name, value in SPEC.items()}
BODIES = [
    {"inputs": SPEC, "response": "document"},
    {"inputs": SPEC, "response": "raw", "outputs": {"repose": {"transmissionMode": "value"}, "regime": {}}},
    {"inputs": SPEC, "outputs": {}, "subscriber": None},
    {"inputs": SPEC, "outputs": None, "response": None},
    {"inputs": QUALIFIED},
    {"inputs": SPEC | {"drum": {"value": SPEC["drum"], "mediaType": "application/json"}}},
    {"inputs": SPEC | {"particles": [{"value": SPEC["particles"][0]}], "fill_fraction": {"value": 0.3}}},
]


@pytest.mark.parametrize("body", BODIES)
def test_requests_in_the_forms_of_the_standard_are_the_same_job(running, body):
    answer = requests.post(running.url + EXECUTION, json=body, headers={"Prefer": "respond-async"}, timeout=30)
    assert answer.status_code == 201, answer.text
    assert answer.headers["Preference-Applied"] == "respond-async"
    assert answer.headers["Location"] == f"{running.url}/jobs/{answer.json()['jobID']}"
    inputs = requests.get(answer.headers["Location"] + "/spec", timeout=30).json()["inputs"]
    assert inputs["drum"]["rotation_rate"] == SPEC["drum"]["rotation_rate"] and inputs["fill_fraction"] == 0.3
    assert inputs["particles"][0]["diameter"] == SPEC["particles"][0]["diameter"] and inputs["seed"] == SPEC["seed"]


@pytest.mark.parametrize("change, pointer", [
    ({"response": "parts"}, "/response"),
    ({"outputs": {"colour": {}}}, "/outputs/colour"),
    ({"outputs": {"repose": {"transmissionMode": "post"}}}, "/outputs/repose/transmissionMode"),
    ({"outputs": [1]}, "/outputs"),
    ({"subscriber": {"successUri": "http://example.org/"}}, "/subscriber/successUri"),
    ({"inputs": SPEC | {"drum": {"value": SPEC["drum"], "mediaType": "text/xml"}}}, "/inputs/drum"),
    ({"inputs": SPEC | {"drum": {"value": SPEC["drum"], "colour": 1}}}, "/inputs/drum/colour"),
    ({"inputs": SPEC | {"fill_fraction": {"value": 1.4}}}, "/inputs/fill_fraction"),
])
def test_what_is_not_offered_is_refused_by_name(running, change, pointer):
    answer = requests.post(running.url + EXECUTION, json={"inputs": SPEC} | change, timeout=30)
    assert answer.status_code == 400 and [error["pointer"] for error in answer.json()["errors"]] == [pointer]


def hrefs_of(node):
    if isinstance(node, dict):
        if isinstance(node.get("href"), str):
            yield node["href"]
        for value in node.values():
            yield from hrefs_of(value)
    elif isinstance(node, list):
        for value in node:
            yield from hrefs_of(value)


@pytest.mark.parametrize("host", ["127.0.0.1", "localhost"])
def test_every_address_is_whole_and_of_the_host_that_was_asked(running, host):
    url = f"http://{host}:{running.port}"
    job = requests.post(url + EXECUTION, json={"inputs": SPEC, "label": {"href": "/mine"}}, timeout=30).headers["Location"]
    running.ended(job.rsplit("/", 1)[1])
    assert job.startswith(f"{url}/jobs/")
    for path in (f"{url}/", f"{url}/processes", f"{url}/jobs", job, f"{job}/samples", f"{job}/snapshots", f"{url}/studies"):
        document = requests.get(path, headers={"Accept": "application/json"}, timeout=30).json()
        found = [href for href in hrefs_of(document) if href != "/mine"]
        assert found and all(href.startswith(url + "/") for href in found), path
    assert requests.get(job, timeout=30).json()["label"] == {"href": "/mine"}


def test_a_strange_host_gets_no_addresses_of_its_own(running):
    with socket.create_connection(("127.0.0.1", running.port)) as connection:
        connection.sendall(b"GET / HTTP/1.1\r\nHost: evil.example\r\nConnection: close\r\n\r\n")
        answer = b"".join(iter(lambda: connection.recv(65536), b""))
    assert answer.startswith(b"HTTP/1.1 421") and b"evil" not in answer


def test_owslib_reads_the_service_and_what_it_submits_is_taken(running):
    processes = pytest.importorskip("owslib.ogcapi.processes", reason="python3-owslib is not installed")
    client = processes.Processes(running.url)
    assert client.response["title"] == "reposed"
    described = client.api()
    assert described["openapi"].startswith("3.0") and "post" in described["paths"]["/processes/{process}/execution"]
    assert any(name.endswith("/conf/job-list") for name in client.conformance()["conformsTo"])
    names = [process["id"] for process in client.processes()["processes"]]
    assert names == ["drum", "fill", "heap", "granule", "orifice"]
    assert "friction" in client.process("granule")["inputs"]
    for link in client.links:
        assert requests.get(link["href"], timeout=30).status_code in (200, 400), link  # /query wants its sql
    answer = requests.post(client._build_url("processes/granule/execution"), json={"inputs": GRANULE, "response": "document"},
                           headers={"Prefer": "respond-async"}, timeout=30)
    assert answer.status_code == 201
    status = requests.get(answer.headers["Location"], timeout=30).json()
    assert status["processID"] == "granule" and status["type"] == "process"


def test_both_descriptions_name_the_same_addresses(running):
    yaml = pytest.importorskip("yaml")
    whole, outline = read_yaml(running.get("/api").text), running.get("/api?f=json").json()
    assert outline["servers"] == [{"url": running.url}]
    assert set(outline["paths"]) == set(whole["paths"])
    for path, operations in outline["paths"].items():
        assert set(operations) == set(whole["paths"][path]) & {"get", "post", "delete"}
    types = {link["type"] for link in running.get("/").json()["links"] if link["rel"] == "service-desc"}
    assert {"application/vnd.oai.openapi+json;version=3.0", "application/vnd.oai.openapi;version=3.0"} <= types
