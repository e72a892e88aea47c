"""In which form an answer comes, under which addresses, and what kind of problem it tells of."""
import re
import subprocess
import threading
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import jsonschema
import pytest
import requests
from conftest import BUILD, FAKE_WORKER, SPEC, Daemon, run_daemon, read_yaml
from test_page import find, find_all, until

ROOT = Path(__file__).resolve().parents[2]
OPENAPI = "application/vnd.oai.openapi"


@pytest.fixture(scope="module")
def service(tmp_path_factory):
    """A daemon with one successful job, and the job's address."""
    daemon = Daemon(tmp_path_factory.mktemp("negotiation"), worker=FAKE_WORKER, options=["--workers", "2"]).start()
    job = daemon.submit(fake="quick")
    daemon.ended(job)
    yield daemon, f"/jobs/{job}"
    daemon.stop()


FORMS = [
    ("/", "*/*", "application/json"),
    ("/", "text/html", "text/html"),
    ("/", "application/json;q=0.9, text/html;q=0.8", "application/json"),
    ("/", "application/json;q=0.8, text/html;q=0.9", "text/html"),
    ("/?f=json", "text/html", "application/json"),
    ("/?f=html", "application/json", "text/html"),
    ("{job}/samples", "text/csv;q=0.2, application/json;q=0.1", "text/csv"),
    ("{job}/samples?f=csv", "application/json", "text/csv"),
    ("{job}/samples?f=json", "text/csv", "application/json"),
    ("{job}/samples?format=csv", "*/*", "text/csv"),
    ("/query?sql=select%201&f=csv", "*/*", "text/csv"),
    ("/api", "*/*", f"{OPENAPI};version=3.1"),
    ("/api", "application/json", f"{OPENAPI}+json;version=3.1"),
    ("/api", f"{OPENAPI}+json", f"{OPENAPI}+json;version=3.1"),
    ("/api", f"{OPENAPI}+json;version=3.0", f"{OPENAPI}+json;version=3.0"),
    ("/api", f"{OPENAPI}; version=3.0", f"{OPENAPI};version=3.0"),
    ("/api", f"{OPENAPI};version=3.0;q=0.5, {OPENAPI}+json;version=3.0;q=0.6", f"{OPENAPI}+json;version=3.0"),
    ("/api", "application/yaml", f"{OPENAPI};version=3.1"),
    ("/api?f=json", "*/*", f"{OPENAPI}+json;version=3.0"),
    ("/api?f=yaml", "*/*", f"{OPENAPI};version=3.0"),
    ("/api?f=yaml&version=3.1", "*/*", f"{OPENAPI};version=3.1"),
    ("/api?version=3.0", "application/json", f"{OPENAPI}+json;version=3.0"),
]


@pytest.mark.parametrize("path, accept, expected", FORMS)
def test_an_answer_comes_in_the_form_that_is_preferred(service, path, accept, expected):
    daemon, job = service
    answer = daemon.get(path.format(job=job), headers={"Accept": accept})
    assert answer.status_code == 200 and answer.headers["Content-Type"].removesuffix("; charset=utf-8") == expected


@pytest.mark.parametrize("path, known", [("/jobs?f=xml", "json html csv"), ("/?f=xml", "json html"), ("/api?f=html", "json yaml"),
                                         ("/conformance?f=html", "json"), ("{job}/samples?format=xls", "json csv"),
                                         ("/api?version=2.0", "3.0 or 3.1"), ("{job}?f=", "json html")])
def test_a_form_that_there_is_not_is_refused_with_those_that_there_are(service, path, known):
    answer = service[0].get(path.format(job=service[1]))
    assert answer.status_code == 400 and known in answer.json()["detail"]


def test_html_of_what_the_page_shows_is_the_page(service):
    daemon, job = service
    for path, page in (("/jobs", "/"), ("/jobs?q=%C3%A4%20b&status=failed&limit=3", "/?status=failed&q=%C3%A4%20b"), (job, f"/web/job.html?id={job[6:]}"),
                       ("/studies", "/web/studies.html"), ("/calibrations", "/web/calibrations.html")):
        answer = daemon.get(path + "&f=html" * ("?" in path) + "?f=html" * ("?" not in path), allow_redirects=False)
        assert answer.status_code == 303 and answer.headers["Location"] == daemon.url + page
        assert daemon.get(answer.headers["Location"], headers={"Accept": "text/html"}).text.startswith("<!doctype html>")


# --- the document as 3.0 ---

def test_the_document_as_3_0_is_the_same_contract(service):
    daemon, _ = service
    new = read_yaml(daemon.get("/api").text)
    old = daemon.get("/api?f=json").json()
    assert read_yaml(daemon.get("/api?f=yaml").text) == old and daemon.get("/api?f=json&version=3.1").json() == new
    assert old["openapi"] == "3.0.3" and old["servers"] == [{"url": daemon.url}]
    assert old["paths"].keys() == new["paths"].keys() and old["components"]["schemas"].keys() == new["components"]["schemas"].keys()
    for path, item in new["paths"].items():
        for method in set(item) - {"parameters"}:
            assert old["paths"][path][method]["responses"].keys() == item[method]["responses"].keys()
            assert len(old["paths"][path][method]["parameters"]) == len(item[method].get("parameters", []) + item.get("parameters", []))


WORDS_OF_3_1 = {"const", "examples", "unevaluatedProperties", "propertyNames", "prefixItems", "$schema"}


def faults_of_3_0(schema, place="schemas"):
    """What a schema of OpenAPI 3.0.3 may not have."""
    if "$ref" in schema:
        return
    yield from (f"{place} has {word}" for word in WORDS_OF_3_1 & set(schema))
    if not isinstance(schema.get("type", ""), str) or schema.get("type") == "null":
        yield f"{place} has the type {schema['type']}"
    if schema.get("nullable") and "type" not in schema:
        yield f"{place} is nullable without a type"
    if schema.get("type") == "array" and "items" not in schema:
        yield f"{place} is a list of nobody knows what"
    for word in ("exclusiveMinimum", "exclusiveMaximum"):
        if not isinstance(schema.get(word, True), bool):
            yield f"{place} has {word} {schema[word]}"
    inner = [schema[word] for word in ("items", "not") if word in schema] + list(schema.get("properties", {}).values())
    inner += [one for word in ("oneOf", "anyOf", "allOf") for one in schema.get(word, [])]
    inner += [schema["additionalProperties"]] if isinstance(schema.get("additionalProperties"), dict) else []
    for one in inner:
        yield from faults_of_3_0(one, f"{place}/{schema.get('title', '')}") if isinstance(one, dict) else [f"{place} has {one}"]


def as_draft_4(schema):
    """A schema of 3.0 as the JSON Schema that it is a dialect of: nullable says that null is good, too."""
    if isinstance(schema, list):
        return [as_draft_4(one) for one in schema]
    if not isinstance(schema, dict):
        return schema
    schema = {name: as_draft_4(value) for name, value in schema.items()}
    if schema.pop("nullable", False) is True:
        schema["type"] = [schema["type"], "null"]
        schema |= {"enum": schema["enum"] + [None]} if "enum" in schema else {}
    return schema


def test_schemas_of_3_0_have_its_words_and_let_through_what_the_service_says(service):
    daemon, job = service
    document = daemon.get("/api?f=json").json()
    for name, schema in document["components"]["schemas"].items():
        assert list(faults_of_3_0(schema)) == [], name
    components = as_draft_4(document["components"])
    for path, name in (("/", "Landing"), ("/conformance", "Conformance"), ("/processes", "ProcessList"), ("/processes/heap", "Process"),
                       ("/jobs", "JobList"), (job, "StatusInfo"), (f"{job}/spec", "Spec"), ("/studies", "StudyList"), ("/jobs/none", "Problem")):
        validator = jsonschema.Draft4Validator({"components": components, "$ref": f"#/components/schemas/{name}"})
        validator.validate(daemon.get(path, headers={"Accept": "application/json"}).json())
        assert not validator.is_valid({"what": "else"}), name


# --- kinds of problem ---

def test_every_kind_of_problem_has_an_address_that_says_what_it_means(service):
    daemon, job = service
    kinds = daemon.get("/problems").json()["problems"]
    assert len({kind["type"] for kind in kinds}) == len({kind["title"] for kind in kinds}) == len(kinds)
    for kind in kinds:
        if kind["type"].startswith(daemon.url):
            assert daemon.get(kind["type"]).json() == kind
    sources = "".join(path.read_text() for folder in ("api/http", "server/daemon") for path in (ROOT / folder).rglob("*.c"))
    told = set(re.findall(r'(?:respond_problem|respond_problems|refuse)\((?:&exchange->)?response, \d+, (?:NULL, )?"([^"]+)"', re.sub(r"\s+", " ", sources)))
    assert len(told) > 25 and told <= {kind["title"] for kind in kinds}


PROBLEMS = [
    (400, "invalid-parameter", {"url": "/jobs?limit=0"}),
    (400, "unknown-parameter", {"url": "/jobs?colour=red"}),
    (400, "invalid-specification", {"url": "/processes/drum/execution", "method": "POST", "json": {"inputs": {}}}),
    (400, "invalid-study", {"url": "/studies", "method": "POST", "json": {"base": {}}}),
    (400, "invalid-json", {"url": "/studies", "method": "POST", "data": "{", "headers": {"Content-Type": "application/json"}}),
    (400, "invalid-query", {"url": "/query?sql=delete from job"}),
    (404, "not-found", {"url": "/nowhere"}),
    (404, "no-such-snapshot", {"url": "{job}/snapshots/9999.hdf"}),
    (405, "method-not-allowed", {"url": "/jobs", "method": "PUT"}),
    (415, "invalid-json", {"url": "/studies", "method": "POST", "data": "a=1"}),
    (421, "unknown-host", {"url": "/jobs", "headers": {"Host": "evil.example"}}),
]


@pytest.mark.parametrize("status, name, request_", PROBLEMS)
def test_a_problem_says_of_which_kind_it_is(service, status, name, request_):
    daemon, job = service
    answer = requests.request(**{"method": "GET"} | request_ | {"url": daemon.url + request_["url"].format(job=job)}, timeout=30)
    base = "" if status == 421 else daemon.url  # the address of a strange host is not repeated
    assert answer.status_code == status and answer.json()["type"] == f"{base}/problems/{name}"


@pytest.mark.parametrize("fake, kind", [("numerical", "numerical-failure"), ("fault", "job-failed")])
def test_the_results_of_a_failed_job_say_why(service, fake, kind):
    daemon, _ = service
    job = daemon.submit(fake=fake)
    assert daemon.ended(job)["status"] == "failed"
    answer = daemon.get(f"/jobs/{job}/results")
    assert answer.status_code == 404 and answer.json()["type"] == f"{daemon.url}/problems/{kind}"


# --- names of files ---

def test_files_have_names_that_tell_the_job(service):
    daemon, job = service
    for path, end, kept in (("/results", "-results.json", "inline"), ("/spec", "-spec.json", "inline"), ("/log", "-log.txt", "inline"),
                            ("/samples", "-samples.json", "inline"), ("/samples?f=csv", "-samples.csv", "attachment"),
                            ("/snapshots", "-snapshots.json", "inline")):
        assert daemon.get(job + path).headers["Content-Disposition"] == f'{kept}; filename="{job[6:]}{end}"'
    assert "Content-Disposition" not in daemon.get(f"{job}/snapshots/9999.hdf").headers


# --- behind a proxy ---

class Proxy(ThreadingHTTPServer):
    """What is below /lab/drums goes to a daemon, without that or with it; all else is 404, as of another service."""

    daemon_threads = True
    prefix = "/lab/drums"

    def __init__(self, strips):
        super().__init__(("127.0.0.1", 0), Proxy.Handler)
        self.strips, self.port = strips, 0
        self.url = f"http://127.0.0.1:{self.server_address[1]}{self.prefix}"
        threading.Thread(target=self.serve_forever, daemon=True).start()

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self):
            if not self.path.startswith(Proxy.prefix):
                self.send_error(404)
                return
            path = self.path.removeprefix(Proxy.prefix) if self.server.strips else self.path
            body = self.rfile.read(int(self.headers.get("Content-Length", 0)))
            headers = {name: value for name, value in self.headers.items() if name in ("Accept", "Content-Type", "Origin")}
            answer = requests.request(self.command, f"http://127.0.0.1:{self.server.port}{path}", data=body or None, headers=headers,
                                      allow_redirects=False, timeout=70)
            self.send_response(answer.status_code)
            for name in ("Content-Type", "Location", "Content-Security-Policy"):
                if name in answer.headers:
                    self.send_header(name, answer.headers[name])
            self.send_header("Content-Length", str(len(answer.content)))
            self.end_headers()
            self.wfile.write(answer.content)

        do_POST = do_DELETE = do_GET

        def log_message(self, *_):
            pass


@pytest.fixture(params=[True, False], ids=["stripped", "whole"])
def behind(request, tmp_path):
    proxy = Proxy(request.param)
    with contextmanager(run_daemon)(tmp_path, worker=FAKE_WORKER, options=["--public-url", proxy.url + "/"]) as daemon:
        proxy.port = daemon.port
        yield proxy
    proxy.shutdown()
    proxy.server_close()


def test_a_program_finds_its_way_through_a_proxy(behind):
    made = requests.post(f"{behind.url}/processes/drum/execution", json={"inputs": SPEC, "label": {"fake": "quick"}}, timeout=30)
    job = made.headers["Location"]
    assert job.startswith(f"{behind.url}/jobs/")
    assert requests.get(f"{job}?wait=30", timeout=40).json()["status"] == "successful"
    seen = set()
    for start in (f"{behind.url}/", job, f"{behind.url}/jobs", f"{job}/samples"):
        for link in requests.get(start, headers={"Accept": "application/json"}, timeout=30).json()["links"]:
            assert link["href"].startswith(behind.url), link
            seen.add(link["href"])
            assert requests.get(link["href"], timeout=30).status_code in (200, 400) or link["rel"] in ("fields", "series", "walls", "picture"), link
    assert len(seen) > 15
    for form in ("?f=json", "?f=yaml", "", "?f=json&version=3.1"):
        assert read_yaml(requests.get(f"{behind.url}/api{form}", timeout=30).text)["servers"] == [{"url": behind.url}]
    assert requests.get(f"{behind.url}/nowhere", timeout=30).json()["type"] == f"{behind.url}/problems/not-found"
    origin = {"Origin": behind.url.removesuffix(Proxy.prefix)}
    assert requests.delete(job, headers=origin, timeout=30).status_code == 200
    assert requests.delete(job, headers={"Origin": "http://127.0.0.1:1"}, timeout=30).status_code == 403


@pytest.mark.parametrize("behind", [True], indirect=True)
def test_a_session_behind_a_proxy_ends_where_it_began(behind):
    """The cookie that is taken back has the path of the one that was given: browsers tell cookies apart by it."""
    answer = requests.delete(f"http://127.0.0.1:{behind.port}/session", timeout=30)
    assert "Path=/lab/drums/;" in answer.headers["Set-Cookie"] and "Max-Age=0" in answer.headers["Set-Cookie"]


@pytest.mark.parametrize("behind", [True], indirect=True)
def test_the_page_works_behind_a_proxy(behind, browser):
    study = {"base": {"inputs": SPEC, "label": {"fake": "quick"}}, "vary": {"/inputs/contact/friction": [0.1, 0.3]}}
    made = requests.post(f"{behind.url}/studies", json=study, timeout=30).headers["Location"]
    requests.get(f"{made}?wait=30", timeout=40)
    browser.get(f"{behind.url}/")
    until(browser, lambda b: len(find_all(b, "tr.job .value")) == 2)
    find(browser, "tr.job .opener").click()
    until(browser, lambda b: find(b, ".links"))
    assert browser.current_url.startswith(f"{behind.url}/?open=")
    find(browser, ".places a[href*=studies]").click()
    until(browser, lambda b: len(find_all(b, "#rows tr")) == 1)
    find(browser, "#rows a").click()
    until(browser, lambda b: len(find_all(b, "#cases tbody tr")) == 2)


@pytest.mark.parametrize("url", ["lab.example", "ftp://lab.example", "http://", "http:///drums", "https://lab.example?x=1", "https://lab.example/a b",
                                 "https://lab.example/a//b", "https://lab.example/../a", "https://lab.example:port/", "https://a\"b/", ""])
def test_a_public_url_that_is_none_is_refused(url, tmp_path):
    done = subprocess.run([BUILD / "reposed", "serve", "--data", tmp_path, "--public-url", url], capture_output=True, text=True, timeout=20)
    assert done.returncode == 2 and "--public-url" in done.stderr and url in done.stderr
