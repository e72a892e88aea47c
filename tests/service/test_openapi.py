"""api/openapi.yaml against the daemon: every documented operation is called and its answer, good or bad, is what
the document says; every address the daemon knows is in the document; the inputs in it are those of the process
description."""
import json
import re
import subprocess
import textwrap
from contextlib import contextmanager
from pathlib import Path

import jsonschema
import pytest
import requests
from conftest import BUILD, SPEC, run_daemon, read_yaml

ROOT = Path(__file__).resolve().parents[2]
ENDLESS = SPEC | {"duration": {"seconds": 2000.0}, "snapshots": {"interval": 0}}
NO_JOB = "20200101-000000-00000000"


class Contract:
    """The document, and the check of one answer against it."""

    def __init__(self, document):
        self.document = document
        self.operations = {(method.upper(), path): operation
                           for path, item in document["paths"].items()
                           for method, operation in item.items() if method in ("get", "post", "delete", "put")}

    def validate(self, value, schema):
        root = {"components": self.document["components"], **schema}
        jsonschema.Draft202012Validator(root).validate(value)

    def check(self, answer, path):
        responses = self.operations[answer.request.method, path]["responses"]
        status = str(answer.status_code)
        if answer.status_code < 400:
            assert status in responses, f"{path} answers {status}, which is not documented"
        response = resolved(self.document, responses.get(status, responses["default"]))
        if "content" not in response:
            assert answer.content == b""
            return
        media_type = answer.headers["Content-Type"].replace("; charset=utf-8", "").replace("; version=0.0.4", "")
        assert media_type in response["content"], f"{path} {status}: {media_type}, documented: {list(response['content'])}"
        if media_type.endswith("json"):
            self.validate(answer.json(), response["content"][media_type]["schema"])
        for name in response.get("headers", {}):
            assert name in answer.headers, f"{path} {status} has no {name}"


def resolved(document, node):
    """The node that a chain of $ref ends at; a KeyError where one leads nowhere."""
    while "$ref" in node:
        target = document
        for step in node["$ref"].removeprefix("#/").split("/"):
            target = target[step]
        node = target
    return node


def refs_in(node):
    if isinstance(node, dict):
        if isinstance(node.get("$ref"), str):
            yield node["$ref"]
        for value in node.values():
            yield from refs_in(value)
    elif isinstance(node, list):
        for value in node:
            yield from refs_in(value)


@pytest.fixture(scope="module")
def contract():
    return Contract(read_yaml((ROOT / "api/openapi.yaml").read_text()))


def test_the_document_is_sound(contract):
    assert contract.document["openapi"] == "3.1.0"
    for reference in refs_in(contract.document):
        resolved(contract.document, {"$ref": reference})
    for schema in contract.document["components"]["schemas"].values():
        jsonschema.Draft202012Validator.check_schema(schema)
    names = [operation["operationId"] for operation in contract.operations.values()]
    assert len(names) == len(set(names))
    for (_, path), operation in contract.operations.items():
        declared = [resolved(contract.document, parameter) for parameter in
                    operation.get("parameters", []) + contract.document["paths"][path].get("parameters", [])]
        in_path = {parameter["name"] for parameter in declared if parameter["in"] == "path"}
        assert in_path == set(re.findall(r"{(\w+)}", path))


def test_every_address_of_the_daemon_is_documented_and_no_other(contract):
    table = re.findall(r'\{ ?"(\w+)", "([^"]+)", "([^"]*)"', (ROOT / "api/http/route_table.c").read_text())
    daemon = {(method, pattern): set(parameters.split()) for method, pattern, parameters in table}
    documented = {}
    for (method, path), operation in contract.operations.items():
        parameters = [resolved(contract.document, p) for p in operation.get("parameters", [])]
        documented[method, re.sub(r"{\w+}", "{}", path)] = {
            p["name"] + "*" * (p["schema"].get("type") == "array") for p in parameters if p["in"] == "query"}
    assert daemon == documented


def test_every_documented_operation_answers_as_documented(daemon, contract):
    url = daemon.url
    done, endless = daemon.submit(SPEC | {"tracers": [0, 3]}, of="contract"), daemon.submit(ENDLESS, of="contract")
    ended = daemon.ended(done)
    assert ended["status"] == "successful", ended
    job = f"{url}/jobs/{done}"
    called = set()

    def call(path, address, expected, method="GET", **options):
        answer = requests.request(method, address, **options)
        assert answer.status_code == expected, f"{method} {address}: {answer.status_code} {answer.text[:300]}"
        contract.check(answer, path)
        called.add((method, path))
        return answer

    landing = call("/", f"{url}/", 200, headers={"Accept": "application/json"})
    call("/", f"{url}/?status=failed", 200, headers={"Accept": "text/html"})
    for name in ("style.css", "jobs.js", "icon.svg"):
        asset = call("/web/{name}", f"{url}/web/{name}", 200)
    call("/web/vendor/{name}", f"{url}/web/vendor/uPlot.min.css", 200)
    call("/web/{name}", f"{url}/web/icon.svg", 304, headers={"If-None-Match": asset.headers["ETag"]})
    call("/conformance", f"{url}/conformance", 200)
    assert read_yaml(call("/api", f"{url}/api", 200).text) == contract.document
    call("/api", f"{url}/api?f=json", 200)
    kinds = call("/problems", f"{url}/problems", 200).json()["problems"]
    call("/problems/{name}", next(kind["type"] for kind in kinds if kind["type"].startswith(url)), 200)
    for page in ("/jobs?f=html&q=contract", f"/jobs/{done}?f=html", "/studies?f=html"):
        call(re.sub(r"/\d{8}-\d{6}-[0-9a-f]{8}", "/{id}", page.split("?")[0]), url + page, 303, allow_redirects=False)
    csv = {"Content-Type": "text/csv"}
    bed = call("/beds", f"{url}/beds", 201, "POST", data="x,y,z\n0,0,0\n", headers=csv).headers["Location"]
    call("/beds", f"{url}/beds", 400, "POST", data="x,y,z\n0,0,far\n", headers=csv)
    call("/beds", f"{url}/beds", 200)
    call("/beds/{id}", bed, 200)
    call("/beds/{id}", bed, 200, "DELETE")
    call("/beds/{id}", bed, 404)
    call("/session", f"{url}/session", 200, "POST", json={"token": "of a daemon that asks for none"})
    call("/session", f"{url}/session", 200, "DELETE")
    call("/healthz", f"{url}/healthz", 200)
    call("/events", f"{url}/events", 200, stream=True).close()
    call("/readyz", f"{url}/readyz", 200)
    call("/metrics", f"{url}/metrics", 200)
    call("/processes", f"{url}/processes", 200)
    call("/processes/{process}", f"{url}/processes/drum", 200)
    examples = call("/examples", f"{url}/examples", 200).json()["examples"]
    assert len(examples) > 20
    for one in examples:
        call("/examples/{example}", one["links"][0]["href"], 200)
    call("/examples/{example}", f"{url}/examples/no-such", 404)
    checked = call("/processes/{process}/execution", f"{url}/processes/drum/execution?check=true", 200, "POST", json={"inputs": ENDLESS})
    contract.validate(checked.json(), {"$ref": "#/components/schemas/Checked"})
    created = call("/processes/{process}/execution", f"{url}/processes/drum/execution", 201, "POST",
                   json={"inputs": ENDLESS})
    assert created.headers["Location"] == f"{url}/jobs/{created.json()['jobID']}"

    first = call("/jobs", f"{url}/jobs?limit=1", 200).json()
    assert len(first["jobs"]) == 1
    older = next(link["href"] for link in first["links"] if link["rel"] == "next")
    call("/jobs", older, 200)
    call("/jobs", f"{url}/jobs?status=accepted,running,successful&processID=drum&q=contract", 200)
    call("/jobs/{id}", job, 200)
    call("/jobs/{id}", f"{url}/jobs/{endless}?wait=0", 200)
    plain = call("/jobs/{id}/results", f"{job}/results", 200).json()
    contract.validate(plain, {"$ref": "#/components/schemas/Results"})
    qualified = call("/jobs/{id}/results", f"{job}/results?profile=ogc-results", 200).json()
    contract.validate(qualified, {"$ref": "#/components/schemas/QualifiedResults"})
    call("/jobs/{id}/results/{output}", f"{job}/results/repose", 200)
    call("/jobs/{id}/spec", f"{job}/spec", 200)
    call("/jobs/{id}/log", f"{job}/log", 200)
    samples = call("/jobs/{id}/samples", f"{job}/samples?limit=2", 200).json()
    assert len(samples["samples"]) == 2 and any(link["rel"] == "next" for link in samples["links"])
    call("/jobs/{id}/samples", f"{job}/samples?after=1", 200, headers={"Accept": "text/csv"})
    call("/jobs/{id}/samples", f"{job}/samples?format=csv", 200)
    snapshots = call("/jobs/{id}/snapshots", f"{job}/snapshots", 200).json()["snapshots"]
    fields = call("/jobs/{id}/fields.hdf", f"{job}/fields.hdf", 200)
    assert fields.content[:4] == b"\x89HDF"
    call("/jobs/{id}/fields.hdf", f"{job}/fields.hdf", 206, headers={"Range": "bytes=0-99"})
    call("/jobs/{id}/fields.hdf", f"{job}/fields.hdf", 304, headers={"If-None-Match": fields.headers["ETag"]})
    assert any(link["href"].endswith("/fields.hdf") for link in requests.get(job).json()["links"])
    call("/jobs/{id}/samples", f"{job}/samples?points=4&columns=angle_deg", 200)
    for name in ("tracers.hdf", "tracers.csv"):
        call(f"/jobs/{{id}}/{name}", f"{job}/{name}", 200)
        call(f"/jobs/{{id}}/{name}", f"{job}/{name}", 206, headers={"Range": "bytes=0-9"})
    for name in ("walls.vtp", "snapshots.hdf.series", "files.tar", "picture.png", "fields.json"):
        call(f"/jobs/{{id}}/{name}", f"{job}/{name}", 200)
    frame = call("/jobs/{id}/snapshots/{file}", snapshots[-1]["frame"], 200)
    assert len(frame.content) == snapshots[-1]["frame_bytes"]
    frames = call("/jobs/{id}/frames.bin", f"{job}/frames.bin?from=0&every=1", 200)
    assert len(frames.content) == sum(snapshot["frame_bytes"] for snapshot in snapshots)
    call("/jobs/{id}/frames.bin", f"{job}/frames.bin", 206, headers={"Range": "bytes=10-200"})
    call("/jobs/{id}/frames.bin", f"{job}/frames.bin", 304, headers={"If-None-Match": frames.headers["ETag"]})
    call("/jobs/{id}/frames.bin", f"{job}/frames.bin", 416, headers={"Range": "bytes=99999999999-"})
    path, href = "/jobs/{id}/snapshots/{file}", snapshots[-1]["href"]
    whole = call(path, href, 200)
    assert len(whole.content) == snapshots[-1]["bytes"]
    part = call(path, href, 206, headers={"Range": "bytes=100-199"})
    assert part.content == whole.content[100:200]
    call(path, href, 304, headers={"If-None-Match": whole.headers["ETag"]})
    call(path, href, 416, headers={"Range": "bytes=99999999999-"})
    for format in ("json", "csv"):
        call("/query", f"{url}/query?f={format.replace('csv', 'html')}", 200)
        call("/query", f"{url}/query?sql=select id, angle_deg from run_summary&format={format}", 200)
    call("/jobs/{id}/results", f"{url}/jobs/{endless}/results", 404)
    call("/jobs/{id}", f"{url}/jobs/{endless}?only=delete", 409, "DELETE")
    call("/jobs/{id}", f"{url}/jobs/{created.json()['jobID']}?only=dismiss", 200, "DELETE")
    call("/jobs/{id}", f"{url}/jobs/{endless}", 200, "DELETE")
    call("/jobs/{id}/results", f"{url}/jobs/{endless}/results", 404)
    call("/jobs/{id}/retry", f"{url}/jobs/{endless}/retry", 200, "POST")
    call("/jobs/{id}/pin", f"{url}/jobs/{done}/pin", 200, "POST")
    call("/jobs/{id}/unpin", f"{url}/jobs/{done}/unpin", 200, "POST")
    call("/jobs/{id}/retry", f"{url}/jobs/{done}/retry", 409, "POST")
    call("/jobs/{id}/continue", f"{url}/jobs/{done}/continue", 400, "POST", json={"revolutions": -1})
    for what in ("cancel", "delete"):
        call(f"/jobs/{what}", f"{url}/jobs/{what}?type=process&dry_run=true", 200, "POST")
        call(f"/jobs/{what}", f"{url}/jobs/{what}?q=nothing&value.friction=0.1..0.2", 200, "POST")
        call(f"/jobs/{what}", f"{url}/jobs/{what}", 400, "POST")
    call("/jobs", f"{url}/jobs?value.friction=0..&sort=-angle_deg&limit=1", 200)
    call("/jobs", f"{url}/jobs?f=csv&limit=1", 200)
    for once in (200, 200, 404):  # dismissed, deleted, gone
        call("/jobs/{id}", f"{url}/jobs/{endless}", once, "DELETE")

    study = {"name": "of the contract", "base": {"inputs": SPEC}, "repeats": 2,
             "cases": [{"name": "one", "inputs": {"contact": {"friction": 0.2}}, "label": {"paper": "25"}}]}
    assert call("/studies", f"{url}/studies?check=true", 200, "POST", json=study).json()["estimate"]["jobs"] > 1
    created = call("/studies", f"{url}/studies", 201, "POST", json=study)
    study = created.headers["Location"]
    assert study == f"{url}/studies/{created.json()['studyID']}"
    call("/studies/{id}", f"{study}?wait=60", 200)
    table = call("/studies/{id}/results", f"{study}/results", 200).json()
    assert table["status"] == "successful" and table["cases"][0]["results"]["angle_deg"]["error_from"] in ("repeats", "runs")
    call("/studies/{id}/results", f"{study}/results?format=csv", 200)
    call("/studies/{id}/results.csv", f"{study}/results.csv", 200)
    again = call("/studies/{id}/spec", f"{study}/spec", 200).json()
    call("/jobs", f"{url}/jobs?study={study.removeprefix(f'{url}/studies/')}", 200)
    call("/studies/{id}", f"{study}?only=dismiss", 409, "DELETE")
    call("/studies/{id}/retry", f"{study}/retry", 409, "POST")
    again = call("/studies", f"{url}/studies", 201, "POST", json=again).headers["Location"]
    call("/studies/{id}", f"{again}?only=dismiss", 200, "DELETE")
    older = call("/studies", f"{url}/studies?limit=1", 200).json()["links"][1]["href"]
    call("/studies", older, 200)
    call("/studies/{id}", study, 200, "DELETE")
    call("/studies/{id}", study, 404)
    calibration = {"base": {"process": "granule", "inputs": {"friction": 0.4}}, "parameters": {"/inputs/friction": {"range": [0.2, 0.6]}},
                   "targets": [{"result": "/granule/minimum_rotation_rate", "value": 20.0, "standard_error": 0.5}], "stop": {"jobs": 12}}
    created = call("/calibrations", f"{url}/calibrations", 201, "POST", json=calibration)
    calibration = created.headers["Location"]
    assert calibration == f"{url}/calibrations/{created.json()['calibrationID']}"
    assert call("/calibrations/{id}", f"{calibration}?wait=60", 200).json()["status"] == "successful"
    found = call("/calibrations/{id}/results", f"{calibration}/results", 200)
    assert found.json()["answer"]["status"] == "identified"
    call("/calibrations/{id}/results", f"{calibration}/results", 304, headers={"If-None-Match": found.headers["ETag"]})
    call("/calibrations/{id}/results", f"{calibration}/results?format=csv", 200)
    call("/calibrations/{id}/results.csv", f"{calibration}/results.csv", 200)
    again = call("/calibrations/{id}/spec", f"{calibration}/spec", 200).json()
    again = call("/calibrations", f"{url}/calibrations", 201, "POST", json=again).headers["Location"]
    call("/calibrations/{id}", f"{again}?only=dismiss", 200, "DELETE")
    call("/calibrations/{id}/results", f"{again}/results", 200)
    call("/calibrations/{id}/retry", f"{again}/retry", 200, "POST")
    call("/calibrations/{id}/retry", f"{calibration}/retry", 409, "POST")
    call("/calibrations", call("/calibrations", f"{url}/calibrations?limit=1", 200).json()["links"][1]["href"], 200)
    call("/calibrations/{id}", calibration, 200, "DELETE")
    call("/calibrations/{id}", calibration, 404)
    call("/session", f"{url}/session", 200, "POST", json={"token": "none is asked for"})
    call("/session", f"{url}/session", 400, "POST", json={})
    call("/session", f"{url}/session", 200, "DELETE")

    assert called == set(contract.operations)
    addresses = {re.sub(r"{\w+}", "", path) for _, path in contract.operations}
    assert {link["href"].removeprefix(url).split("?")[0] for link in landing.json()["links"]} <= addresses


def test_every_error_is_a_documented_problem(daemon, contract):
    url = daemon.url
    execution, jobs = "/processes/{process}/execution", "/jobs/{id}"
    post = {"method": "POST", "url": f"{url}/processes/drum/execution"}
    bad = [
        (400, execution, post | {"json": {"inputs": {"drum": {"diametre": 1}}, "lable": {}}}),
        (400, execution, post | {"data": "{", "headers": {"Content-Type": "application/json"}}),
        (400, execution, post | {"json": []}),
        (415, execution, post | {"data": "inputs=1", "headers": {"Content-Type": "text/plain"}}),
        (413, execution, post | {"data": b" " * 1_100_000, "headers": {"Content-Type": "application/json"}}),
        (404, execution, post | {"url": f"{url}/processes/stirrer/execution", "json": {}}),
        (404, "/processes/{process}", {"url": f"{url}/processes/stirrer"}),
        (404, jobs, {"url": f"{url}/jobs/{NO_JOB}"}),
        (404, jobs, {"method": "DELETE", "url": f"{url}/jobs/{NO_JOB}"}),
        (400, jobs, {"method": "DELETE", "url": f"{url}/jobs/{NO_JOB}?only=look"}),
        (404, "/jobs/{id}/retry", {"method": "POST", "url": f"{url}/jobs/{NO_JOB}/retry"}),
        (404, "/jobs/{id}/results", {"url": f"{url}/jobs/{NO_JOB}/results"}),
        (404, "/jobs/{id}/snapshots/{file}", {"url": f"{url}/jobs/{NO_JOB}/snapshots/000000.hdf"}),
        (404, "/jobs/{id}/fields.hdf", {"url": f"{url}/jobs/{NO_JOB}/fields.hdf"}),
        (404, "/web/{name}", {"url": f"{url}/web/nothing.js"}),
        (400, "/jobs", {"url": f"{url}/jobs?status=lost"}),
        (400, "/jobs", {"url": f"{url}/jobs?limit=0"}),
        (400, "/jobs", {"url": f"{url}/jobs?colour=red"}),
        (400, jobs, {"url": f"{url}/jobs/{NO_JOB}?wait=forever"}),
        (400, "/query", {"url": f"{url}/query?sql=delete from job"}),
        (400, "/query", {"url": f"{url}/query?sql=select 1&f=html"}),
        (400, "/studies", {"method": "POST", "url": f"{url}/studies", "json": {"base": {"inputs": {}}, "cases": [1]}}),
        (400, "/studies", {"url": f"{url}/studies?limit=x"}),
        (404, "/studies/{id}", {"url": f"{url}/studies/{NO_JOB}"}),
        (404, "/studies/{id}", {"method": "DELETE", "url": f"{url}/studies/{NO_JOB}"}),
        (404, "/studies/{id}/results", {"url": f"{url}/studies/{NO_JOB}/results"}),
        (404, "/studies/{id}/results.csv", {"url": f"{url}/studies/nothing/results.csv"}),
        (404, "/studies/{id}/spec", {"url": f"{url}/studies/{NO_JOB}/spec"}),
        (400, "/calibrations", {"method": "POST", "url": f"{url}/calibrations", "json": {"base": {"inputs": {}}}}),
        (404, "/calibrations/{id}", {"url": f"{url}/calibrations/{NO_JOB}"}),
        (404, "/calibrations/{id}/results", {"url": f"{url}/calibrations/{NO_JOB}/results"}),
    ]
    for status, path, request in bad:
        answer = requests.request(**({"method": "GET"} | request))
        assert answer.status_code == status, (request["url"], answer.status_code, answer.text[:300])
        contract.check(answer, path)
        assert answer.json()["status"] == status
    # What is no operation at all still gets the same kind of document.
    for method, path, status in (("GET", "/nowhere", 404), ("PUT", "/jobs", 405)):
        answer = requests.request(method, url + path, headers={"Content-Type": "application/json"})
        assert answer.status_code == status
        assert answer.headers["Content-Type"].startswith("application/problem+json")
        contract.validate(answer.json(), {"$ref": "#/components/schemas/Problem"})


def test_a_bad_specification_names_every_problem(daemon):
    inputs = SPEC | {"fill_fraction": 1.4, "colour": "red", "particles": [{"diameter": -1}]}
    answer = requests.post(f"{daemon.url}/processes/drum/execution", json={"inputs": inputs})
    pointers = {error["pointer"] for error in answer.json()["errors"]}
    assert {"/inputs/fill_fraction", "/inputs/colour", "/inputs/particles/0/diameter"} <= pointers


PROCESSES = (("drum", "Drum"), ("fill", "Fill"), ("heap", "Heap"), ("granule", "Granule"), ("orifice", "Orifice"))


def test_documented_processes_are_those_that_are_listed(daemon, contract):
    listed = [process["id"] for process in requests.get(f"{daemon.url}/processes").json()["processes"]]
    assert listed == contract.document["components"]["schemas"]["ProcessId"]["enum"] == [name for name, _ in PROCESSES]


def with_units(schema, contract):
    """The document has the units of a dimension once, in the order in which they come first."""
    if isinstance(schema, list):
        return [with_units(one, contract) for one in schema]
    if not isinstance(schema, dict):
        return schema
    if schema.get("$ref", "").startswith("#/components/schemas/UnitOf"):
        schema = contract.document["components"]["schemas"][schema["$ref"].rsplit("/", 1)[1]]
    if schema.get("title", "").startswith("unit of "):
        return schema | {"enum": sorted(schema["enum"])}
    return {name: with_units(member, contract) for name, member in schema.items()}


@pytest.mark.parametrize("process, schemas", PROCESSES)
def test_documented_inputs_are_those_of_the_process_description(daemon, contract, process, schemas):
    description = requests.get(f"{daemon.url}/processes/{process}").json()["inputs"]
    documented = contract.document["components"]["schemas"][f"{schemas}Inputs"]
    assert with_units(documented["properties"], contract) == with_units({name: given["schema"] for name, given in description.items()}, contract)
    assert set(documented["required"]) == {name for name, given in description.items() if given["minOccurs"] == 1}


@pytest.mark.parametrize("process, schemas", PROCESSES)
def test_documented_results_are_those_of_the_process_description(daemon, contract, process, schemas):
    description = requests.get(f"{daemon.url}/processes/{process}").json()["outputs"]
    documented = contract.document["components"]["schemas"][f"{schemas}Results"]["properties"]
    assert set(documented) == set(description)
    for output, given in description.items():
        told, given = documented[output].get("items", documented[output]), given["schema"].get("items", given["schema"])
        assert set(told["properties"]) == set(given["properties"]), output
        for name, schema in given["properties"].items():
            assert told["properties"][name].get("type") == schema.get("type"), (output, name)
            assert told["properties"][name].get("x-unit") == schema.get("x-unit"), (output, name)


@pytest.mark.parametrize("inputs", [{"friction": 0.5, "rotation_rate": 18.0}, {"friction": 0.02}])
def test_a_granule_is_answered_as_documented(daemon, contract, inputs):
    url, execution = daemon.url, "/processes/{process}/execution"
    created = requests.post(f"{url}/processes/granule/execution", json={"inputs": inputs})
    assert created.status_code == 201
    contract.check(created, execution)
    job = created.json()["jobID"]
    assert daemon.ended(job)["status"] == "successful"
    for path in ("", "/results", "/spec", "/log", "/samples", "/snapshots"):
        answer = requests.get(f"{url}/jobs/{job}{path}")
        assert answer.status_code == 200
        contract.check(answer, "/jobs/{id}" + path)
    contract.check(requests.get(f"{url}/jobs"), "/jobs")
    contract.check(requests.get(f"{url}/processes/granule"), "/processes/{process}")
    contract.check(requests.post(f"{url}/processes/granule/execution", json={"inputs": {"friction": -1}}), execution)


def test_examples_are_valid(contract):
    execute = {"$ref": "#/components/schemas/Execute"}
    body = contract.operations["POST", "/processes/{process}/execution"]["requestBody"]
    contract.validate(body["content"]["application/json"]["example"], execute)
    examples = list((ROOT / "api/examples").glob("*.json"))
    assert examples
    for example in examples:
        is_calibration = example.stem == "calibration"
        contract.validate(json.loads(example.read_text()), {"$ref": "#/components/schemas/Calibration"} if is_calibration else execute)
    study = {"$ref": "#/components/schemas/Study"}
    contract.validate(contract.operations["POST", "/studies"]["requestBody"]["content"]["application/json"]["example"], study)
    studies = list((ROOT / "api/studies").glob("*.json"))
    assert studies
    for example in studies:
        contract.validate(json.loads(example.read_text()), study)
    with pytest.raises(jsonschema.ValidationError):
        contract.validate({"inputs": SPEC | {"colour": "red"}}, execute)


def test_the_program_writes_the_schemas_of_inputs_and_results_into_the_document(contract, tmp_path):
    """The file is what the program makes of it; what is by hand stays, and what is missing or stale is made anew."""
    document = ROOT / "api/openapi.yaml"
    by_hand, line = document.read_text().split("    # From here on", 1)
    for name, text in (("current", document.read_text()), ("stale", f"{by_hand}    # From here on{line.splitlines()[0]}\n    Old: {{}}\n")):
        copy = tmp_path / f"{name}.yaml"
        copy.write_text(text)
        assert subprocess.run([BUILD / "reposed", "openapi", copy], check=False).returncode == 0
        assert copy.read_text() == document.read_text(), name
    (tmp_path / "other.yaml").write_text("openapi: 3.1.0\n")
    assert subprocess.run([BUILD / "reposed", "openapi", tmp_path / "other.yaml"], stderr=subprocess.DEVNULL, check=False).returncode == 1
    assert (tmp_path / "other.yaml").read_text() == "openapi: 3.1.0\n"
    written = set(read_yaml(textwrap.dedent(line.split("\n", 1)[1])))
    units = {name for name in written if name.startswith("UnitOf")}
    assert len(units) > 8 and {"UnitOfLength", "UnitOfRotation"} <= units
    assert {f"{name}{what}" for _, name in PROCESSES for what in ("Inputs", "Results")} | {"Summary", "ProcessId", "Results"} | units == written


def test_a_stale_document_is_served_with_the_schemas_of_the_program(tmp_path, contract):
    document = (ROOT / "api/openapi.yaml").read_text()
    (tmp_path / "stale.yaml").write_text(document.split("    ProcessId:")[0])
    with contextmanager(run_daemon)(tmp_path, options=["--api-file", str(tmp_path / "stale.yaml")]) as daemon:
        assert read_yaml(daemon.get("/api").text) == contract.document


def test_the_whole_document_is_served_as_json_too(daemon, contract):
    for accept in ("application/json", "application/vnd.oai.openapi+json;version=3.1", "application/vnd.oai.openapi+json"):
        answer = requests.get(f"{daemon.url}/api", headers={"Accept": accept})
        assert answer.status_code == 200 and answer.headers["Content-Type"] == "application/vnd.oai.openapi+json;version=3.1"
        assert answer.json() == contract.document
        contract.check(answer, "/api")
    assert read_yaml(requests.get(f"{daemon.url}/api", headers={"Accept": "*/*"}).text) == contract.document


YAML = r"""# a comment
plain: two words   # and another
'200': {a: 1, 'b c': [x, -2, 3.5, 1.0e-05, '7', null, true], empty: {}, none: []}
url: http://127.0.0.1:8080/a#b
folded: >-
  one line
  and on,

  another
literal: |
  first
    further in
  last
quoted: 'it''s: {not} a # mapping,
  over two lines'
double: "a \"word\" \\"
long: a plain text
  that goes on
list:
- first
- name: second
  of: [a,
    b]   # over two lines
-
  - nested
  - {deep: {er: yes or no}}
  - - twice
nothing:
last: /jobs/{id}
"""


def test_yaml_of_every_kind_that_documents_use_is_read_as_others_read_it(tmp_path):
    """PyYAML is the other."""
    (tmp_path / "any.yaml").write_text(YAML)
    with contextmanager(run_daemon)(tmp_path, options=["--api-file", str(tmp_path / "any.yaml")]) as daemon:
        accept = {"Accept": "application/json"}
        assert daemon.get("/api", headers=accept).json() == read_yaml(YAML)
        for number, bad in enumerate(("a: {b: [1, 2}\n", "a: 1\n b: 2\n", "a: 1\na: 2\n", "a: 'open\n", "[" * 500, "- a\nb: 1\n",
                                       "a: &again 1\nb: *again\n", "a: !kind 1\n", "a: 1\n---\nb: 2\n", "[a]: 1\n", "")):
            (tmp_path / "any.yaml").write_text(bad)
            answer = daemon.get("/api", headers=accept)
            assert answer.status_code == 500 and "line" in answer.json()["detail"], (number, answer.text)
