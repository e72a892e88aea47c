"""Programs of npm that know nothing of this service but its OpenAPI document or the standard: they find no fault with the one, and
their way by the other. Packages are fetched once, into build/npm; without npm or a network the tests are left out."""
import functools
import json
import shutil
import socket
import subprocess
import time
from pathlib import Path

import pytest
import requests
from conftest import BUILD, FAKE_WORKER, SPEC, Daemon, read_yaml

pytestmark = pytest.mark.torture  # for the time that npm takes
HERE = Path(__file__).parent
PACKAGES = {
    "types": ["openapi-typescript@7", "openapi-fetch@0.13", "typescript@5", "@types/node@20"],
    "redocly": ["@redocly/cli@1.34.0"],
    "spectral": ["@stoplight/spectral-cli@6"],
    "prism": ["@stoplight/prism-cli@5"],
    "ogc": ["@camptocamp/ogc-client@1"],
}


@functools.cache
def folder_of(name):
    """With these packages in its node_modules."""
    if not shutil.which("npm") or not shutil.which("node"):
        pytest.skip("npm or node is not installed")
    folder = BUILD.absolute() / "npm" / name
    if not (folder / "whole").exists():
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        (folder / "package.json").write_text('{"name": "clients", "private": true, "type": "module"}')
        done = subprocess.run(["npm", "install", "--no-audit", "--no-fund", "--ignore-scripts", *PACKAGES[name]], cwd=folder, capture_output=True,
                              text=True, timeout=300)
        if done.returncode != 0:
            pytest.skip(f"npm can't fetch {PACKAGES[name]}: {done.stderr[-200:]}")
        (folder / "whole").touch()
    return folder


def run_in(folder, *command):
    return subprocess.run([folder / "node_modules/.bin" / command[0], *command[1:]], cwd=folder, capture_output=True, text=True, timeout=300)


@pytest.fixture(scope="module")
def service(tmp_path_factory):
    """A daemon, with one job that has ended and one that runs."""
    daemon = Daemon(tmp_path_factory.mktemp("npm"), worker=FAKE_WORKER, options=["--workers", "2"]).start()
    done, running = daemon.submit(fake="quick"), daemon.submit(fake="quick", seconds=500.0)
    daemon.ended(done)
    folder = daemon.data / "jobs" / done
    for name in ("fields.hdf", "walls.vtp"):
        (folder / name).write_text("as the worker writes it")
    (folder / "snapshots.hdf.series").write_text('{"files": []}')
    yield daemon, done, running
    daemon.stop()


@pytest.fixture(params=["f=json", "f=yaml&version=3.1"], ids=["3.0", "3.1"])
def document(request, service, tmp_path):
    file = tmp_path / ("api.json" if request.param == "f=json" else "api.yaml")
    file.write_text(service[0].get(f"/api?{request.param}").text)
    return file


def test_redocly_finds_no_error(document):
    done = run_in(folder_of("redocly"), "redocly", "lint", str(document), "--format=json")
    assert done.returncode == 0 and json.loads(done.stdout)["totals"]["errors"] == 0, done.stdout[-3000:]


def test_spectral_finds_no_error(document):
    folder = folder_of("spectral")
    (folder / ".spectral.yaml").write_text('extends: ["spectral:oas"]\n')
    done = run_in(folder, "spectral", "lint", str(document), "-r", str(folder / ".spectral.yaml"), "--fail-severity=error", "-f", "json")
    assert done.returncode == 0, done.stdout[-3000:]


def test_a_client_that_is_made_from_the_document_compiles_and_calls_every_operation(document, service):
    daemon, done, running = service
    folder = folder_of("types")
    made = run_in(folder, "openapi-typescript", str(document), "-o", "api.d.ts", "--default-non-nullable=false")
    assert made.returncode == 0, made.stderr
    shutil.copy(HERE / "client_of_every_operation.ts", folder / "client.ts")
    compiled = run_in(folder, "tsc", "--strict", "--target", "es2022", "--module", "nodenext", "--types", "node", "client.ts")
    assert compiled.returncode == 0, compiled.stdout[-3000:]
    ran = subprocess.run(["node", "client.js", daemon.url, done, running, "000000.hdf"], cwd=folder, capture_output=True, text=True, timeout=60)
    assert ran.returncode == 0, ran.stdout + ran.stderr
    called = {tuple(line.rsplit(" ", 1)) for line in ran.stdout.splitlines()}
    refused = {name for name, status in called if status not in ("200", "201")}
    assert refused <= {"POST /studies/{id}/retry"}, called  # a study that is successful is not tried again
    paths = read_yaml(document.read_text())["paths"]
    assert {name for name, _ in called} == {f"{method.upper()} {path}" for path, item in paths.items() for method in item if method != "parameters"}


@pytest.fixture
def prism(service, tmp_path):
    """A proxy before the daemon that compares requests and answers with the document, and is 500 where one is otherwise."""
    folder = folder_of("prism")
    (tmp_path / "api.json").write_text(service[0].get("/api?f=json").text)
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    process = subprocess.Popen(["node", folder / "node_modules/.bin/prism", "proxy", tmp_path / "api.json", service[0].url, "--errors", "-h", "127.0.0.1",
                                "-p", str(port)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    for _ in range(200):
        with socket.socket() as probe:
            if probe.connect_ex(("127.0.0.1", port)) == 0:
                break
        time.sleep(0.1)
    yield f"http://127.0.0.1:{port}"
    process.terminate()
    process.wait(20)


def test_prism_finds_every_answer_as_documented(prism, service):
    daemon, done, running = service
    job = f"/jobs/{done}"
    study = {"base": {"inputs": SPEC, "label": {"fake": "quick"}}, "repeats": 2}
    made = requests.post(f"{daemon.url}/studies", json=study, timeout=30).headers["Location"].removeprefix(daemon.url)
    requests.get(f"{daemon.url}{made}?wait=30", timeout=40)
    gets = ["/", "/conformance", "/processes", "/processes/drum", "/processes/fill", "/processes/heap", "/processes/granule", "/jobs?limit=2",
            "/jobs?status=failed,successful&q=a", job, f"/jobs/{running}", f"{job}/results", f"{job}/results?profile=ogc-results", f"{job}/results/repose",
            f"{job}/spec", f"{job}/log", f"{job}/samples", f"{job}/samples?f=csv", f"{job}/snapshots", f"{job}/snapshots/000000.hdf", f"{job}/files.tar",
            f"{job}/snapshots.hdf.series", "/studies", made, f"{made}/results", f"{made}/results?f=csv", f"{made}/results.csv", f"{made}/spec",
            "/query?sql=select%20id%20from%20job", "/query?sql=select%201&f=csv", "/healthz", "/readyz", "/metrics", "/problems", "/problems/not-found",
            f"/jobs/{running}/results", "/jobs/20200101-000000-00000000", "/query?sql=delete", "/problems/none"]
    for path in gets:
        answer = requests.get(prism + path, timeout=30)
        assert "stoplight" not in answer.text[:3000], (path, answer.text[:1000])
        assert answer.status_code == requests.get(daemon.url + path, timeout=30).status_code, path
    posts = [("/processes/drum/execution", {"inputs": SPEC, "label": {"fake": "quick"}}, {}, 201),
             ("/processes/drum/execution", {"inputs": SPEC, "label": {"fake": "quick"}}, {"Prefer": "respond-sync"}, 200),
             ("/processes/granule/execution", {"inputs": {"friction": 0.5}}, {}, 201), ("/studies", study, {}, 201)]
    for path, body, headers, status in posts:
        answer = requests.post(prism + path, json=body, headers=headers, timeout=60)
        assert answer.status_code == status, (path, answer.text[:1000])
    assert requests.delete(f"{prism}/jobs/{running}?only=dismiss", timeout=30).status_code == 200
    assert requests.post(f"{prism}/jobs/{running}/retry", timeout=30).status_code == 200
    assert "stoplight" in requests.get(f"{prism}/jobs?limit=0", timeout=30).text  # it does look


def test_ogc_client_reads_the_service(service):
    folder = folder_of("ogc")
    (folder / "read.js").write_text("""import { OgcApiEndpoint } from '@camptocamp/ogc-client';
const endpoint = new OgcApiEndpoint(process.argv[2]);
console.log(JSON.stringify({ info: await endpoint.info, classes: await endpoint.conformanceClasses }));
""")
    done = subprocess.run(["node", "read.js", f"{service[0].url}/"], cwd=folder, capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    read = json.loads(done.stdout)
    assert read["info"]["title"] == "reposed" and read["classes"] == service[0].get("/conformance").json()["conformsTo"]
