"""api/CONFORMANCE.md: it has every requirement of the classes that the service claims, and each of its tests is there. And what
no other test shows of them."""
import email
import json
import re
from pathlib import Path

import jsonschema
import pytest
import requests
from conftest import ENDED, FAKE_WORKER, SPEC, Daemon

ROOT = Path(__file__).resolve().parents[2]
OGC = "http://www.opengis.net/def/exceptions/ogcapi-processes-1/1.0/"
NO_JOB = "20200101-000000-00000000"
# The identifiers of 18-062r2.
REQUIREMENTS = {
    "core": """landingpage-op landingpage-success api-definition-op api-definition-success conformance-op conformance-success http
        process-list pl-limit-definition pl-limit-response process-list-success pl-links process process-success
        process-exception/no-such-process process-execute-op process-execute-request process-execute-inputs process-execute-input-array
        process-execute-input-inline-object process-execute-input-mixed-type process-execute-input-inline-binary
        process-execute-input-inline-bbox process-execute-input-validation process-execute-default-execution-mode
        process-execute-auto-execution-mode process-execute-default-outputs process-execute-sync-raw-value-one
        process-execute-sync-raw-value-multi process-execute-sync-raw-ref process-execute-sync-raw-mixed-multi
        process-execute-sync-document process-execute-success-async job job-success job-exception-no-such-job job-results
        job-results-async-document job-results-async-raw-value-one job-results-async-raw-value-multi job-results-async-raw-ref
        job-results-async-raw-mixed-multi job-results-success-sync job-results-exception/no-such-job
        job-results-exception/results-not-ready job-results-failed""",
    "ogc-process-description": "json-encoding inputs-def input-def input-mixed-type outputs-def output-def output-mixed-type",
    "json": "definition",
    "oas30": "oas-definition-1 oas-definition-2 oas-impl completeness exceptions-codes security",
    "job-list": """job-list-op type-definition type-response processID-mandatory processID-definition processid-response
        status-definition status-response datetime-definition datetime-response duration-definition duration-response limit-definition
        limit-response job-list-success links""",
    "callback": "job-callback",
    "dismiss": "job-dismiss-op job-dismiss-success",
}


def table():
    """{class: {requirement: test}}"""
    text = (ROOT / "api/CONFORMANCE.md").read_text()
    return {name: {cells[0]: cells[2] for cells in re.findall(r"^\| (\S+) \| (.+?) \| (\S+) \|$", rows, re.MULTILINE) if cells[0] != "requirement"}
            for name, rows in re.findall(r"^## (\S+)\n\|(.*?)(?=\n## |\Z)", text, re.MULTILINE | re.DOTALL)}


@pytest.fixture(scope="module")
def service(tmp_path_factory):
    daemon = Daemon(tmp_path_factory.mktemp("conformance"), worker=FAKE_WORKER, options=["--workers", "2"]).start()
    yield daemon
    daemon.stop()


def test_the_table_has_every_requirement_with_a_test_that_is_there():
    assert {name: set(rows) for name, rows in table().items()} == {name: set(text.split()) for name, text in REQUIREMENTS.items()}
    for rows in table().values():
        for requirement, test in rows.items():
            if test == "-":
                continue
            file, name = test.split("::")
            assert f"\ndef {name}(" in (ROOT / f"tests/service/{file}.py").read_text(), (requirement, test)
    untested = {requirement for rows in table().values() for requirement, test in rows.items() if test == "-"}
    assert untested == {"process-execute-input-inline-binary", "process-execute-input-inline-bbox", "output-mixed-type"}


def test_the_classes_that_are_claimed_are_those_of_the_table(service):
    claimed = service.get("/conformance").json()["conformsTo"]
    assert {name.removeprefix("http://www.opengis.net/spec/ogcapi-processes-1/1.0/conf/") for name in claimed} == set(table())


def test_processes_are_listed_as_the_standard_has_them(service):
    """processSummary.yaml and process.yaml: what they require, and what its members may be."""
    listed = service.get("/processes").json()
    assert any(link["rel"] == "self" for link in listed["links"])
    for summary in listed["processes"]:
        links = {link["rel"].rsplit("/", 1)[-1]: link["href"] for link in summary["links"]}
        assert links["self"] == f"{service.url}/processes/{summary['id']}" and links["execute"] == links["self"] + "/execution"
        assert {"async-execute", "dismiss"} == set(summary["jobControlOptions"]) and summary["version"]
        assert set(summary["outputTransmission"]) == {"value", "reference"}
        described = requests.get(links["self"], timeout=30).json()
        assert {name: described[name] for name in summary} == summary
        for kind in ("inputs", "outputs"):
            for name, one in described[kind].items():
                jsonschema.Draft202012Validator.check_schema(one["schema"])
                assert one["title"] and one["description"], name
        for one in described["inputs"].values():
            assert 0 <= one["minOccurs"] <= one["maxOccurs"]
        assert requests.get(links["job-list"], timeout=30).status_code == 200


def test_an_input_of_several_types_takes_each_of_them(service):
    """The shape of a particle is a word or an object; a list of spheres in it, a lining or nothing."""
    shapes = ["sphere", "dumbbell", {"spheres": [{"position": [0, 0, 0], "diameter": 0.002}, {"position": [0.0015, 0, 0], "diameter": 0.002}]}]
    schema = service.get("/processes/drum").json()["inputs"]["particles"]["schema"]
    for shape in shapes:
        particles = [{"diameter": 0.002, "shape": shape}]
        jsonschema.Draft202012Validator(schema).validate(particles)
        for given in (particles, {"value": particles}, [{"value": particles[0]}]):
            answer = service.post(SPEC | {"particles": given}, {"fake": "quick"})
            assert answer.status_code == 201, answer.text
    for lining in (None, {"diameter": 0.004, "pitch": 0.004}):
        assert service.post(SPEC | {"wall": {"lining": lining}}, {"fake": "quick"}).status_code == 201
    assert service.post(SPEC | {"drum": {"href": "http://127.0.0.1/drum.json"}}).status_code == 400


def test_exceptions_have_the_types_of_the_standard(service):
    for path, name in (("/processes/none", "no-such-process"), (f"/jobs/{NO_JOB}", "no-such-job"), (f"/jobs/{NO_JOB}/results", "no-such-job")):
        answer = service.get(path)
        assert answer.status_code == 404 and answer.json()["type"] == OGC + name
        assert answer.headers["Content-Type"] == "application/problem+json"
    running = service.submit(fake="quick", seconds=2.0)
    answer = service.get(f"/jobs/{running}/results")
    assert answer.status_code == 404 and answer.json()["type"] == OGC + "result-not-ready"


STATUS_INFO = {"type": "object", "required": ["jobID", "status", "type"], "properties": {  # statusInfo.yaml
    "processID": {"type": "string"}, "type": {"enum": ["process"]}, "jobID": {"type": "string"},
    "status": {"enum": ["accepted", "running", "successful", "failed", "dismissed"]}, "message": {"type": "string"},
    **{name: {"type": "string", "pattern": r"^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d(\.\d+)?Z$"} for name in ("created", "started", "finished", "updated")},
    "progress": {"type": "integer", "minimum": 0, "maximum": 100},
    "links": {"type": "array", "items": {"type": "object", "required": ["href"]}}}}


def test_a_job_is_told_of_as_the_standard_has_it(service):
    jobs = [service.submit(fake="quick", seconds=0.3), service.submit(fake="fault"), service.submit(fake="quick", seconds=20.0)]
    check = jsonschema.Draft202012Validator(STATUS_INFO).validate
    while service.job(jobs[0])["status"] not in ENDED:
        check(service.job(jobs[0]))
    service.ended(jobs[1])
    check(requests.delete(f"{service.url}/jobs/{jobs[2]}", timeout=30).json())
    for job in service.get("/jobs").json()["jobs"]:
        check(job)
        assert job["processID"] == "drum" and job["created"] <= job["updated"]
    links = {link["rel"]: link["href"] for link in service.job(jobs[0])["links"]}
    assert requests.get(links["http://www.opengis.net/def/rel/ogc/1.0/results"], timeout=30).status_code == 200


def test_answers_at_once_have_the_forms_of_those_later(service):
    def execute(**around):
        answer = requests.post(f"{service.url}/processes/drum/execution", timeout=60, headers={"Prefer": "respond-sync"},
                               json={"inputs": SPEC, "label": {"fake": "quick"}, "response": "raw"} | around)
        assert answer.status_code == 200 and answer.content == requests.get(f"{answer.headers['Location']}/results", timeout=30).content
        return answer

    assert execute(outputs={"packing": {}}).json()["solid_fraction"] == 0.59
    several = execute()
    parts = email.message_from_bytes(b"Content-Type: " + several.headers["Content-Type"].encode() + b"\r\n\r\n" + several.content).get_payload()
    assert {part["Content-ID"] for part in parts} >= {"<repose>", "<regime>", "<run>"}
    assert next(json.loads(part.get_payload()) for part in parts if part["Content-ID"] == "<repose>")["angle_deg"] == 23.5
    mixed = execute(outputs={"repose": {}, "run": {"transmissionMode": "reference"}})
    assert b"Content-Location: " + service.url.encode() in mixed.content
