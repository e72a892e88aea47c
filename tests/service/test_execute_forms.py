"""How a client may execute a test and have its results: at once or later, as a document or raw, some outputs or all, by value or
by reference."""
import email
import json
import re
import signal
import sqlite3
import subprocess
import time

import jsonschema
import pytest
import requests
from conftest import BUILD, ENDED, FAKE_WORKER, SPEC, Daemon
from test_daemon_clients import ask_and_keep, job_of_long_specification

EXECUTION = "/processes/drum/execution"
PROFILE = "http://www.opengis.net/def/profile/OGC/0/ogc-results"
# results.yaml of OGC API - Processes, Part 1, 1.0: each output is a value that is no object, a qualified value, or a link.
OGC_RESULTS = {"type": "object", "additionalProperties": {"oneOf": [
    {"type": ["string", "number", "integer", "boolean", "array"]},
    {"type": "object", "required": ["value"], "properties": {
        "value": {}, "mediaType": {"type": "string"}, "encoding": {"type": "string"}, "schema": {}}, "additionalProperties": False},
    {"type": "object", "required": ["href"], "properties": {
        "href": {"type": "string"}, "rel": {"type": "string"}, "type": {"type": "string"}, "hreflang": {}, "title": {}}, "additionalProperties": False}]}}


@pytest.fixture(scope="module")
def service(tmp_path_factory):
    daemon = Daemon(tmp_path_factory.mktemp("forms"), worker=FAKE_WORKER, options=["--workers", "2"]).start()
    yield daemon
    daemon.stop()


def execute(daemon, prefer=None, label=None, **around):
    return requests.post(daemon.url + EXECUTION, json={"inputs": SPEC, "label": label or {"fake": "quick"}} | around, timeout=90,
                         headers={"Prefer": prefer} if prefer else {})


def results_of(daemon, **around):
    """The address of the results of a job that was asked so, and all of them as they are."""
    made = execute(daemon, **around)
    assert made.status_code == 201, made.text
    job = made.headers["Location"]
    assert requests.get(f"{job}?wait=30", timeout=40).json()["status"] == "successful"
    with sqlite3.connect(daemon.data / "reposed.sqlite") as database:
        (document,) = database.execute("SELECT document FROM result JOIN job ON result.job=job.number WHERE id=?", (made.json()["jobID"],)).fetchone()
    return f"{job}/results", json.loads(document)


# --- now or later ---

@pytest.mark.parametrize("prefer, applied", [("respond-sync", "respond-sync"), ("wait=30", "wait=30"), ("respond-async, wait=30", "wait=30"),
                                             ("RESPOND-SYNC; wait=20", "respond-sync"), ("wait=100000", "wait=60")])
def test_who_prefers_to_wait_gets_the_results(service, prefer, applied):
    answer = execute(service, prefer)
    assert answer.status_code == 200 and answer.headers["Preference-Applied"] == applied
    job = answer.headers["Location"]
    assert job.startswith(f"{service.url}/jobs/") and answer.json() == requests.get(f"{job}/results", timeout=30).json()
    assert answer.json()["repose"]["angle_deg"] == 23.5


@pytest.mark.parametrize("prefer", ["wait=0.4", "respond-async;wait=0.3"])
def test_who_waits_too_short_is_told_that_the_job_goes_on(service, prefer):
    answer = execute(service, prefer, {"fake": "quick", "seconds": 1.2})
    assert answer.status_code == 201 and answer.headers["Preference-Applied"] == "respond-async"
    assert answer.json()["status"] not in ENDED
    assert answer.json()["estimate"] and answer.json()["warnings"]
    assert requests.get(f"{answer.headers['Location']}?wait=30", timeout=40).json()["status"] == "successful"


@pytest.mark.parametrize("prefer", [None, "respond-async", "handling=lenient", "wait=0", "wait=x", "respond-asynchronously"])
def test_who_does_not_prefer_to_wait_does_not(service, prefer):
    answer = execute(service, prefer)
    assert answer.status_code == 201 and answer.headers.get("Preference-Applied") == ("respond-async" if prefer == "respond-async" else None)


def test_one_request_makes_one_job_however_long_it_waits(service):
    label = {"fake": "quick", "seconds": 0.5, "only": "this one"}
    assert execute(service, "wait=20", label).status_code == 200
    assert len(service.get("/jobs?q=this one").json()["jobs"]) == 1


def test_a_long_specification_is_awaited_too(service):
    """It is read in a lane of its own, from which the request comes back to wait."""
    body = json.dumps({"inputs": SPEC, "label": {"fake": "quick"}}).ljust(30_000)
    answer = requests.post(service.url + EXECUTION, data=body, timeout=90, headers={"Prefer": "respond-sync", "Content-Type": "application/json"})
    assert answer.status_code == 200 and answer.headers["Preference-Applied"] == "respond-sync"


def test_a_failure_that_is_awaited_is_told_with_its_kind(service):
    answer = execute(service, "respond-sync", {"fake": "numerical"})
    assert answer.status_code == 500 and answer.json()["type"] == f"{service.url}/problems/numerical-failure"
    assert answer.json()["failure"]["status"] == "overlap-too-large"
    assert requests.get(answer.headers["Location"], timeout=30).json()["status"] == "failed"


def test_nobody_is_kept_waiting_by_a_daemon_that_leaves(tmp_path):
    from concurrent.futures import ThreadPoolExecutor
    daemon = Daemon(tmp_path, worker=FAKE_WORKER).start()
    with ThreadPoolExecutor(1) as pool:
        waiting = pool.submit(execute, daemon, "respond-sync", {"fake": "quick", "seconds": 30.0})
        while not daemon.get("/jobs?status=running").json()["jobs"]:
            time.sleep(0.05)
        daemon.stop()
        assert waiting.result().status_code == 201 and waiting.result().json()["jobID"]


def test_an_answer_that_is_on_its_way_reaches_its_client_before_the_daemon_ends(tmp_path):
    daemon = Daemon(tmp_path, worker=FAKE_WORKER).start()
    job = job_of_long_specification(daemon)
    client = ask_and_keep(daemon, f"/jobs/{job}/spec", receive_buffer=4096)
    client.settimeout(20)
    parts = [client.recv(4096)]
    daemon.process.send_signal(signal.SIGTERM)
    time.sleep(0.5)  # the daemon has nothing left to do but this
    while parts[-1]:
        parts.append(client.recv(1 << 20))
    daemon.stop()
    headers, body = b"".join(parts).split(b"\r\n\r\n", 1)
    assert len(body) == int(re.search(rb"Content-Length: (\d+)", headers)[1]) > 1 << 20


# --- in which form ---

def test_who_says_nothing_gets_all_outputs_as_one_object(service):
    for around in ({}, {"response": "document"}, {"outputs": {}}, {"outputs": None, "response": None}):
        address, stored = results_of(service, **around)
        answer = requests.get(address, timeout=30)
        assert answer.json() == stored and "Link" not in answer.headers


def test_qualified_values_are_as_the_standard_has_them(service):
    address, stored = results_of(service)
    for options in ({"headers": {"Accept": f'application/json;profile="{PROFILE}"'}}, {"headers": {"Accept": "application/json; profile=ogc-results"}},
                    {"params": {"profile": "ogc-results"}}, {"params": {"profile": PROFILE}}):
        answer = requests.get(address, timeout=30, **options)
        jsonschema.Draft202012Validator(OGC_RESULTS).validate(answer.json())
        assert {name: output["value"] for name, output in answer.json().items()} == stored
        assert answer.headers["Link"] == f'<{PROFILE}>; rel="profile"'
    assert not jsonschema.Draft202012Validator(OGC_RESULTS).is_valid(stored)
    refused = requests.get(address, params={"profile": "other"}, timeout=30)
    assert refused.status_code == 400 and PROFILE in refused.json()["detail"]


def test_outputs_that_were_named_come_alone_and_by_reference_where_wanted(service):
    address, stored = results_of(service, outputs={"repose": {}, "regime": {"transmissionMode": "reference"}})
    answer = requests.get(address, timeout=30).json()
    assert answer == {"repose": stored["repose"], "regime": {"href": f"{address}/regime", "type": "application/json"}}
    jsonschema.Draft202012Validator(OGC_RESULTS).validate(requests.get(f"{address}?profile=ogc-results", timeout=30).json())
    output = requests.get(answer["regime"]["href"], timeout=30)
    assert output.json() == stored["regime"] and output.headers["Content-Disposition"].endswith('-regime.json"')
    missing = requests.get(f"{address}/colour", timeout=30)
    assert missing.status_code == 404 and missing.json()["type"].endswith("/problems/no-such-output")


def test_one_raw_output_is_the_answer(service):
    address, stored = results_of(service, response="raw", outputs={"packing": {"transmissionMode": "value"}})
    assert requests.get(address, timeout=30).json() == stored["packing"]
    assert requests.get(f"{address}?f=json", timeout=30).json() == {"packing": stored["packing"]}


def parts_of(answer):
    message = email.message_from_bytes(b"Content-Type: " + answer.headers["Content-Type"].encode() + b"\r\n\r\n" + answer.content)
    assert message.get_content_type() == "multipart/related" and not message.defects
    return {part["Content-ID"].strip("<>"): part for part in message.get_payload()}


def test_several_raw_outputs_are_parts(service):
    address, stored = results_of(service, response="raw")
    answer = requests.get(address, timeout=30)
    assert {name: json.loads(part.get_payload()) for name, part in parts_of(answer).items()} == stored
    assert requests.get(address, headers={"Accept": "application/json"}, timeout=30).json() == stored
    address, stored = results_of(service, response="raw", outputs={"repose": {}, "run": {"transmissionMode": "reference"}})
    parts = parts_of(requests.get(address, timeout=30))
    assert json.loads(parts["repose"].get_payload()) == stored["repose"]
    assert parts["run"].get_payload().strip() == "" and requests.get(parts["run"]["Content-Location"], timeout=30).json() == stored["run"]


def test_raw_references_alone_are_links(service):
    wanted = {name: {"transmissionMode": "reference"} for name in ("repose", "regime")}
    made = execute(service, "respond-sync", response="raw", outputs=wanted)
    answer = requests.get(f"{made.headers['Location']}/results", timeout=30)
    for one in (made, answer):
        assert one.status_code == 204 and one.content == b""
        links = requests.utils.parse_header_links(one.headers["Link"])
        assert [link["title"] for link in links] == ["repose", "regime"]
        assert all(requests.get(link["url"], timeout=30).status_code == 200 for link in links)


def test_how_results_are_wanted_outlives_the_daemon_and_is_no_part_of_the_specification(tmp_path):
    daemon = Daemon(tmp_path, worker=FAKE_WORKER).start()
    address, stored = results_of(daemon, response="raw", outputs={"packing": {}})
    daemon.stop()
    daemon.start()
    assert requests.get(address, timeout=30).json() == stored["packing"]
    assert requests.get(address.replace("results", "spec"), timeout=30).json().keys() == {"process", "inputs", "label"}
    daemon.stop()


def test_numbers_with_units_are_kept_in_si_and_other_dimensions_are_refused_all_at_once(service):
    mm = lambda value: {"value": value, "unit": "mm"}
    inputs = {"drum": {"diameter": mm(50), "length": {"value": 2, "unit": "cm"}, "rotation_rate": {"value": 30, "unit": "rpm"}},
              "particles": [{"diameter": mm(5), "density": {"value": 2.5, "unit": "g/cm3"}}], "seed": 1,
              "duration": {"seconds": {"value": 50, "unit": "ms"}}}
    posted = service.post(inputs, {"fake": "quick"})
    assert posted.status_code == 201, posted.text
    kept = service.get(f"/jobs/{posted.json()['jobID']}/spec").json()["inputs"]
    assert kept["drum"]["diameter"] == 0.05 and kept["drum"]["length"] == 0.02 and kept["particles"][0]["diameter"] == 0.005
    assert abs(kept["drum"]["rotation_rate"] - 3.141592653589793) < 1e-15 and kept["duration"] == {"seconds": 0.05}
    assert kept["particles"][0]["density"] == 2500
    inputs["drum"]["diameter"]["unit"], inputs["particles"][0]["density"]["unit"] = "kg", "mm"
    errors = {error["pointer"]: error["detail"] for error in
              service.post(inputs, {"fake": "quick"}).json()["errors"]}
    assert errors.keys() == {"/inputs/drum/diameter", "/inputs/particles/0/density"}
    assert errors["/inputs/drum/diameter"].startswith('is 50 with the unit "kg"; units allowed: m, cm, mm, ')
    schema = service.get("/processes/drum").json()["inputs"]["drum"]["schema"]
    check = jsonschema.Draft202012Validator(schema)
    assert check.is_valid({"diameter": mm(50), "length": 0.02, "rotation_rate": {"value": 30, "unit": "rpm"}})
    assert not check.is_valid({"diameter": mm(50), "length": 0.02, "rotation_rate": {"value": 30, "unit": "kg"}})
    assert not check.is_valid({"diameter": {"value": 50}, "length": 0.02, "rotation_rate": 1})
    assert not check.is_valid({"diameter": 50, "length": 0.02, "rotation_rate": 1})


def test_inputs_by_reference_are_refused_each_with_the_reason(service):
    reference = {"href": "http://elsewhere.example/input.json", "type": "application/json"}
    inputs = {"drum": reference, "particles": [{"diameter": 0.003}, reference], "seed": reference}
    answer = execute(service, inputs=inputs, priority=11)
    assert answer.status_code == 400
    errors = {error["pointer"]: error["detail"] for error in answer.json()["errors"]}
    assert set(errors) == {"/inputs/drum", "/inputs/particles/1", "/inputs/seed", "/priority"}
    assert all(errors[name].startswith("is a reference (href); must be given by value") for name in errors if name != "/priority")


def test_a_study_with_units_tells_its_cases_in_si(service):
    base = {"inputs": {"friction": 0.3, "radius": {"value": 63, "unit": "mm"}}, "process": "granule"}
    posted = requests.post(f"{service.url}/studies", timeout=30, json={"base": base, "cases": [
        {"name": "slow", "inputs": {"rotation_rate": {"value": 30, "unit": "rpm"}}}, {"name": "fast", "inputs": {"rotation_rate": 18}}]})
    assert posted.status_code == 201, posted.text
    address = f"/studies/{posted.json()['studyID']}"
    service.get(f"{address}?wait=30")
    # The table has 15 digits.
    rates = [case["inputs"]["rotation_rate"] for case in service.get(f"{address}/results").json()["cases"]]
    assert abs(rates[0] - 3.141592653589793) < 5e-14 and rates[1] == 18


SLIPS = [  # what is given, where the warning is, and the reason in it
    ({"particles": [{"diameter": 0.005, "density": 2.5}]}, "/inputs/particles/0/density", "if 2.5 g/cm3 were meant"),
    ({"drum": {"diameter": 0.1, "length": 0.02, "rotation_rate": 15}}, "/inputs/drum/rotation_rate", "if 15 revolutions a minute were meant"),
    ({"drum": {"diameter": 2.5, "length": 0.4, "rotation_rate": 0.5}, "particles": [{"diameter": 0.1}]}, "/inputs/drum/diameter", "usual is 0.005 to 2 m"),
    ({"particles": [{"diameter": 0.006}]}, "/inputs/drum/diameter", "fewer than 10 across"),
    ({"duration": {"revolutions": 0.8}}, "/inputs/duration", "less than one"),
    ({"duration": {"seconds": 9000}, "drum": {"diameter": 0.1, "length": 0.1, "rotation_rate": 1}, "snapshots": {"interval": 0}}, "/inputs/duration", "on this machine"),
    ({"threads": 256}, "/inputs/threads", "more threads bring no speed"),
]


def test_every_slip_is_told_in_the_201_and_by_check_with_its_reason(service, tmp_path):
    sound = {"drum": {"diameter": 0.05, "length": 0.02, "rotation_rate": 3}, "particles": [{"diameter": 0.005}], "seed": 1,
             "duration": {"revolutions": 1.5}}
    for given, field, reason in SLIPS:
        (tmp_path / "spec.json").write_text(json.dumps({"inputs": sound | given}))
        checked = subprocess.run([BUILD / "repose", "check", tmp_path / "spec.json"], capture_output=True, text=True, check=True)
        posted = service.post(sound | given, {"fake": "quick"})
        assert posted.status_code == 201, posted.text
        for told in (json.loads(checked.stdout), posted.json()):
            texts = [warning["text"] for warning in told["warnings"] if warning["field"] == field]
            assert any(reason in text for text in texts), (given, told["warnings"])
            assert told["understood"].keys() >= {"rotation_rate_rpm", "froude_number", "diameter_ratio", "expected_overlap", "duration", "wall_time"}
