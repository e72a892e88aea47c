"""What the daemon lets in, and how it sends files. Raw sockets where a client library would tidy up the request."""
import json
import os
import re
import shutil
import socket
import subprocess
import time

import pytest
import requests

from conftest import BUILD, SPEC, Daemon, FAKE_WORKER, run_daemon


@pytest.fixture(scope="module")
def untouched(tmp_path_factory):
    """One for all that leave nothing behind."""
    yield from run_daemon(tmp_path_factory.mktemp("untouched"), worker=FAKE_WORKER)


def raw(daemon, text, wait=30.0):
    """Status of the answer to these bytes; None when the connection ends without one."""
    with socket.create_connection(("127.0.0.1", daemon.port), timeout=wait) as connection:
        connection.sendall(text.encode("latin-1"))
        answer = b""
        while b"\r\n\r\n" not in answer:
            piece = connection.recv(65536)
            if not piece:
                break
            answer += piece
    return int(answer.split()[1]) if answer else None


def head(daemon, *lines, method="GET", target="/jobs", host=True):
    lines = ([f"Host: 127.0.0.1:{daemon.port}"] if host else []) + list(lines)
    return "\r\n".join([f"{method} {target} HTTP/1.1", *lines, "", ""])


JSON = "Content-Type: application/json"


def test_headers_that_can_be_read_two_ways_are_refused(fake):
    post = {"method": "POST", "target": "/processes/drum/execution"}
    assert raw(fake, head(fake)) == 200
    assert raw(fake, head(fake, host=False)) == 400
    assert raw(fake, head(fake, "Host: localhost")) == 400
    assert raw(fake, head(fake, JSON, "Content-Length: 2", "Content-Length: 2", **post) + "{}") == 400
    assert raw(fake, head(fake, JSON, "Content-Length: 2", "Transfer-Encoding: chunked", **post) + "2\r\n{}\r\n0\r\n\r\n") == 400
    assert raw(fake, head(fake, JSON, "Transfer-Encoding: chunked", **post) + "2\r\n{}\r\n0\r\n\r\n") == 411
    assert raw(fake, head(fake, "X-One: 1\r\n Content-Length: 5")) == 400  # folded over two lines
    assert fake.get("/jobs").json()["counts"]["accepted"] == 0


@pytest.mark.parametrize("target", ["/web/%2e%2e/secret", "/web/../secret", "/web/..", "//jobs", "/jobs/./x", "/jobs%00", "/jobs/%6a",
                                    "/jobs/é", "http://127.0.0.1/jobs", "*", "/jobs?q=%00", "/jobs?q=%zz", "/jobs?q=%ff"])
def test_strange_addresses_are_refused(untouched, target):
    assert raw(untouched, head(untouched, target=target)) == 400


def test_only_known_hosts_are_answered(untouched):
    for host, status in {"localhost": 200, "LOCALHOST:80": 200, "192.168.1.7:8080": 200, "[::1]:8080": 200, "evil.example": 421,
                         "evil.example:8080": 421, "localhost.evil.example": 421, "127.0.0.1.evil.example": 421, "127.0.0.1:80x": 421,
                         "": 421}.items():
        assert raw(untouched, head(untouched, f"Host: {host}", host=False)) == status, host


def test_writes_come_from_programs_or_our_own_page(fake):
    own, path = f"http://127.0.0.1:{fake.port}", f"{fake.url}/processes/drum/execution"
    assert fake.post(headers={"Origin": own}).status_code == 201
    for origin in ("http://evil.example", "null", own + "0", f"http://evil.example/{own}"):
        assert fake.post(headers={"Origin": origin}).status_code == 403, origin
        assert requests.delete(f"{fake.url}/jobs/20200101-000000-00000000", headers={"Origin": origin}).status_code == 403
    for content_type in ("text/plain", "application/x-www-form-urlencoded", "application/jsonx"):
        answer = requests.post(path, data=json.dumps({"inputs": SPEC}), headers={"Content-Type": content_type})
        assert answer.status_code == 415 and "curl --json" in answer.json()["detail"]
    assert requests.post(path, data=json.dumps({"inputs": SPEC}), headers={"Content-Type": "application/json; charset=utf-8"}).status_code == 201


def test_bad_bodies_are_told_apart(fake):
    path = f"{fake.url}/processes/drum/execution"
    headers = {"Content-Type": "application/json"}
    for body in ("", "{", "[]", "7", '{"inputs": {}, "inputs": {}}', '{"inputs": {"seed": 1e999}}', "[" * 5000, '{"inputs": "\\ud800"}'):
        answer = requests.post(path, data=body, headers=headers)
        assert answer.status_code == 400 and answer.headers["Content-Type"] == "application/problem+json", body[:40]
        assert answer.headers["Connection"] == "close"
        assert answer.json()["errors"][0]["detail"], body[:40]
    vanishing = json.dumps({"inputs": SPEC}).replace('"interval": 0.1', '"interval": 1e-400')  # would be 0: no series of snapshots
    answer = requests.post(path, data=vanishing, headers=headers)
    assert answer.status_code == 400 and "too close to 0" in answer.json()["errors"][0]["detail"]
    answer = fake.post(SPEC | {"fill_fraction": 1.4, "friction": 1, "contact": {"friction": -1}})
    pointers = {error["pointer"] for error in answer.json()["errors"]}
    assert pointers == {"/inputs/fill_fraction", "/inputs/friction", "/inputs/contact/friction"}
    assert fake.get("/jobs").json()["jobs"] == []


def test_a_refusal_is_told_whatever_it_quotes(fake):
    for path in ("/jobs?" + "ä" * 30 + "=1", "/jobs?xä" + "ä" * 30 + "=1", "/jobs?limit=x" + "€" * 30, "/query?sql=select 1;" + "x" + "ä" * 30):
        answer = fake.get(path)
        assert answer.status_code == 400 and answer.json()["detail"], path
    job = fake.submit()
    fake.ended(job)
    answer = fake.get(f"/jobs/{job}/snapshots/0.hdf", headers={"Range": b"bytes=999-"})
    assert answer.status_code == 416 and answer.json()["detail"]


def test_a_body_of_more_than_a_megabyte_is_refused(fake):
    padded = json.dumps({"inputs": SPEC}).ljust(1 << 20)
    path, headers = f"{fake.url}/processes/drum/execution", {"Content-Type": "application/json"}
    assert requests.post(path, data=padded, headers=headers).status_code == 201
    assert requests.post(path, data=padded + " ", headers=headers).status_code == 413
    assert requests.post(path, data=padded * 5, headers=headers).status_code == 413
    assert raw(fake, head(fake, JSON, "Content-Length: 99999999999999999999999", method="POST", target="/processes/drum/execution")) in (400, 413)


def test_unknown_addresses_and_methods_are_problems(fake):
    for path in ("/nothing", "/jobs/x/y/z", "/processes/mill", "/jobs/20200101-000000-00000000", "/web/none.js", "/web/.git", "/study"):
        answer = fake.get(path)
        assert answer.status_code == 404 and answer.json()["status"] == 404, path
    assert fake.get("/processes/mill").json()["type"].endswith("/no-such-process")
    assert fake.get("/jobs/20200101-000000-00000000").json()["type"].endswith("/no-such-job")
    answer = requests.put(f"{fake.url}/jobs")
    assert answer.status_code == 405 and answer.headers["Allow"] == "GET, HEAD"
    assert requests.post(f"{fake.url}/jobs/x", json={}).headers["Allow"] == "GET, HEAD, DELETE"
    assert requests.head(f"{fake.url}/jobs").status_code == 200
    assert requests.options(f"{fake.url}/processes/drum/execution").headers["Allow"] == "POST"


def test_every_answer_forbids_foreign_content(untouched):
    for path in ("/", "/jobs", "/nothing", "/web/index.html"):
        headers = untouched.get(path).headers
        assert headers["Content-Security-Policy"].startswith("default-src 'self'") and headers["X-Content-Type-Options"] == "nosniff"


def test_browsers_get_the_page_and_programs_the_landing_page(fake):
    page = fake.get("/", headers={"Accept": "text/html,application/xhtml+xml,*/*;q=0.8"})
    assert page.headers["Content-Type"].startswith("text/html") and "<html" in page.text
    links = {link["rel"].rsplit("/", 1)[-1]: link["href"] for link in fake.get("/").json()["links"]}
    for rel in ("conformance", "processes", "job-list", "service-desc"):
        assert fake.get(links[rel]).status_code == 200
    again = fake.get("/web/index.html", headers={"If-None-Match": page.headers["ETag"]})
    assert again.status_code == 304 and again.content == b""


def test_page_files_are_never_reached_through_links(tmp_path):
    web = tmp_path / "web"
    web.mkdir()
    (tmp_path / "secret.html").write_text("secret")
    (web / "link.html").symlink_to(tmp_path / "secret.html")
    (web / "good.html").write_text("good")
    (web / "notes.txt").write_text("not of the page")
    os.mkfifo(web / "pipe.js")
    daemon = Daemon(tmp_path, worker=FAKE_WORKER, options=["--web", str(web)]).start()
    try:
        got = {name: daemon.get(f"/web/{name}").status_code for name in ("good.html", "link.html", "notes.txt", "pipe.js")}
    finally:
        daemon.stop()
    assert got == {"good.html": 200, "link.html": 404, "notes.txt": 404, "pipe.js": 404}


def test_snapshots_come_whole_in_part_and_from_the_cache(fake):
    job = fake.submit()
    fake.ended(job)
    listed = fake.get(f"/jobs/{job}/snapshots").json()["snapshots"]
    assert [snapshot["number"] for snapshot in listed] == [0, 1]
    path = listed[1]["href"]
    whole = fake.get(path)
    text, etag = whole.content, whole.headers["ETag"]
    assert text.startswith(b"snapshot 1") and whole.headers["Accept-Ranges"] == "bytes" and not etag.startswith("W/")
    assert "immutable" in whole.headers["Cache-Control"]
    part = fake.get(path, headers={"Range": "bytes=5-9"})
    assert part.status_code == 206 and part.content == text[5:10] and part.headers["Content-Range"] == f"bytes 5-9/{len(text)}"
    assert fake.get(path, headers={"Range": "bytes=-4"}).content == text[-4:]
    assert fake.get(path, headers={"Range": "bytes=100-"}).content == text[100:]
    outside = fake.get(path, headers={"Range": "bytes=999-"})
    assert outside.status_code == 416 and outside.headers["Content-Range"] == f"bytes */{len(text)}"
    assert fake.get(path, headers={"If-None-Match": etag}).status_code == 304
    assert fake.get(path, headers={"Range": "bytes=5-9", "If-Range": etag}).status_code == 206
    assert fake.get(path, headers={"Range": "bytes=5-9", "If-Range": '"other"'}).content == text
    for name in ("2.hdf", "x.hdf", "1", "-1.hdf", "spec.json", "1.hdf.tmp"):
        assert fake.get(f"/jobs/{job}/snapshots/{name}").status_code == 404, name


def test_frames_come_one_by_one_and_several_as_one_in_whole_and_in_part(fake):
    """The fake worker's frames are heads alone, which differ in their times."""
    job = fake.submit()
    fake.ended(job)
    listed = fake.get(f"/jobs/{job}/snapshots").json()["snapshots"]
    single = [fake.get(snapshot["frame"]) for snapshot in listed]
    frames = [answer.content for answer in single]
    assert [len(frame) for frame in frames] == [snapshot["frame_bytes"] for snapshot in listed] == [64, 64] and frames[0] != frames[1]
    assert "immutable" in single[0].headers["Cache-Control"]
    assert fake.get(listed[1]["frame"], headers={"Range": "bytes=16-23"}).content == frames[1][16:24]
    all_of_them = f"/jobs/{job}/frames.bin"
    whole = fake.get(all_of_them)
    assert whole.content == b"".join(frames) and whole.headers["Content-Length"] == "128" and whole.headers["Accept-Ranges"] == "bytes"
    assert requests.head(fake.url + all_of_them, timeout=30).headers["Content-Length"] == "128"
    for query, content in (("from=1", frames[1]), ("to=0", frames[0]), ("every=2", frames[0]), ("from=1&every=7&to=9", frames[1])):
        assert fake.get(f"{all_of_them}?{query}").content == content, query
    for part, content in (("0-9", whole.content[:10]), ("60-67", whole.content[60:68]), ("64-64", frames[1][:1]), ("-3", frames[1][-3:]),
                          ("100-", whole.content[100:]), ("0-999", whole.content)):
        answer = fake.get(all_of_them, headers={"Range": f"bytes={part}"})
        assert answer.status_code == 206 and answer.content == content and answer.headers["Content-Length"] == str(len(content)), part
    assert fake.get(all_of_them, headers={"Range": "bytes=128-"}).status_code == 416
    etag = whole.headers["ETag"]
    assert fake.get(all_of_them, headers={"If-None-Match": etag}).status_code == 304
    assert fake.get(all_of_them, headers={"Range": "bytes=0-3", "If-Range": '"other"'}).status_code == 200
    assert etag != fake.get(f"{all_of_them}?from=1").headers["ETag"]
    for bad, status in (("from=-1", 400), ("every=0", 400), ("to=x", 400), ("from=2", 404)):
        assert fake.get(f"{all_of_them}?{bad}").status_code == status, bad
    (fake.data / "jobs" / job / "snapshots" / "000000.bin").unlink()  # as of a job of an earlier version
    listed = fake.get(f"/jobs/{job}/snapshots").json()["snapshots"]
    assert "frame" not in listed[0] and "frame" in listed[1]
    assert fake.get(all_of_them, headers={"If-None-Match": etag}).content == frames[1]
    assert fake.get(f"/jobs/{job}/snapshots/0.bin").status_code == 404


def test_a_dripping_client_is_cut_off(fake):
    with socket.create_connection(("127.0.0.1", fake.port)) as connection:
        start = time.monotonic()
        connection.settimeout(2)
        connection.sendall(b"GET /jobs HTTP/1.1\r\n")
        while time.monotonic() - start < 50:
            try:
                connection.sendall(b"X")
                if connection.recv(100) == b"":
                    break
            except TimeoutError:
                continue
            except OSError:
                break
        assert 14 < time.monotonic() - start < 35


def test_many_waiting_clients_hold_up_nobody(fake):
    job = fake.submit(fake="slow", seconds="60")
    waiting = [subprocess.Popen(["curl", "-s", f"{fake.url}/jobs/{job}?wait=60"], stdout=subprocess.PIPE) for _ in range(40)]
    end = time.monotonic() + 30
    while metrics_of(fake)["reposed_http_connections"] < 40:
        assert time.monotonic() < end
        time.sleep(0.05)
    assert fake.get("/healthz").status_code == 200
    assert [client.poll() for client in waiting] == [None] * 40  # all wait still
    assert requests.delete(f"{fake.url}/jobs/{job}", timeout=30).status_code == 200
    answers = [json.loads(client.communicate()[0])["status"] for client in waiting]
    assert answers == ["dismissed"] * 40


def test_a_token_is_asked_for(tmp_path):
    token = tmp_path / "token"
    token.write_text("a-token-of-some-length\n")
    token.chmod(0o644)
    command = [BUILD / "reposed", "serve", "--port", "0", "--data", tmp_path / "data", "--worker", FAKE_WORKER, "--token-file", token]
    refused = subprocess.run(command, capture_output=True, text=True, timeout=60)
    assert refused.returncode == 1 and "mode 644; must be 0600" in refused.stderr
    token.chmod(0o600)
    daemon = Daemon(tmp_path, worker=FAKE_WORKER, options=["--token-file", str(token)]).start()
    try:
        for wrong in (None, "Bearer", "Bearer a-token-of-some-lengt", "Bearer a-token-of-some-length2", "Basic a-token-of-some-length"):
            answer = daemon.get("/jobs", headers={"Authorization": wrong} if wrong else {})
            assert answer.status_code == 401 and answer.headers["WWW-Authenticate"] == "Bearer", wrong
            assert daemon.post(headers={"Authorization": wrong} if wrong else {}).status_code == 401
        assert daemon.get("/jobs", headers={"Authorization": "Bearer a-token-of-some-length"}).status_code == 200
        assert daemon.post(headers={"Authorization": "bearer a-token-of-some-length"}).status_code == 201
    finally:
        daemon.stop()


@pytest.mark.parametrize("text, says", [("x" * 300, "300 characters; must hold 16 to 255"), ("x" * 256, "256 characters"),
                                        ("x" * 400, "320 characters or more"), ("a-token-of-some length", "at character 16"),
                                        ("a-token-of-some-\0length", "at character 17"), ("a-token-of-söme-length", "at character 13"),
                                        ("short", "5 characters")])
def test_a_token_is_never_taken_in_part(tmp_path, text, says):
    token = tmp_path / "token"
    token.write_text(text + "\n")
    token.chmod(0o600)
    command = [BUILD / "reposed", "serve", "--port", "0", "--data", tmp_path / "data", "--worker", FAKE_WORKER, "--token-file", token]
    refused = subprocess.run(command, capture_output=True, text=True, timeout=60)
    assert refused.returncode == 1 and says in refused.stderr


def test_the_longest_token_is_taken_whole(tmp_path):
    token = tmp_path / "token"
    token.write_text("y" * 255 + "\r\n")
    token.chmod(0o600)
    daemon = Daemon(tmp_path, worker=FAKE_WORKER, options=["--token-file", str(token)]).start()
    try:
        assert daemon.get("/jobs", headers={"Authorization": "Bearer " + "y" * 255}).status_code == 200
        assert daemon.get("/jobs", headers={"Authorization": "Bearer " + "y" * 254}).status_code == 401
    finally:
        daemon.stop()


def test_listening_to_the_world_needs_a_token(tmp_path):
    command = [BUILD / "reposed", "serve", "--host", "0.0.0.0", "--port", "0", "--data", tmp_path / "data", "--worker", FAKE_WORKER]
    refused = subprocess.run(command, capture_output=True, text=True, timeout=60)
    assert refused.returncode == 1 and "needs --token-file" in refused.stderr


@pytest.mark.parametrize("options, says", [(["--port", "70000"], '--port is "70000"; must be a whole number in [0, 65535]'),
                                           (["--workers", "0"], "[1, 256]"), (["--worker", "/nowhere"], "/nowhere can't be started"),
                                           (["surplus"], '"surplus" is not understood'), (["--bogus"], "reposed: unrecognized option '--bogus'")])
def test_a_wrong_command_line_says_what_is_wrong(tmp_path, options, says):
    command = [BUILD / "reposed", "serve", "--data", tmp_path / "data", "--worker", FAKE_WORKER, *options]
    result = subprocess.run(command, capture_output=True, text=True, timeout=60)
    assert result.returncode == 2 and says in result.stderr
    assert subprocess.run([BUILD / "reposed", "--version"], capture_output=True, text=True).stdout.startswith("reposed ")
    assert "--port NUMBER" in subprocess.run([BUILD / "reposed", "--help"], capture_output=True, text=True).stdout


def test_the_port_file_tells_the_port(tmp_path):
    daemon = Daemon(tmp_path, worker=FAKE_WORKER, options=["--port-file", str(tmp_path / "port")]).start()
    daemon.stop()
    assert int((tmp_path / "port").read_text()) == daemon.port


def metrics_of(daemon):
    text = daemon.get("/metrics").text
    for line in text.splitlines():
        assert re.fullmatch(r"# (HELP|TYPE) [a-z_]+ .+|[a-z_]+(\{[^{}]*(\{\}[^{}]*)*\})? [0-9.e+-]+", line), line
    assert set(re.findall(r"# HELP (\S+)", text)) == set(re.findall(r"# TYPE (\S+)", text))
    return {line.rsplit(" ", 1)[0]: float(line.rsplit(" ", 1)[1]) for line in text.splitlines() if not line.startswith("#")}


def test_metrics_count_jobs_requests_and_work(fake):
    slow = [fake.submit(fake="slow", seconds="4") for _ in range(3)]
    fake.until(slow[1], lambda info: info["progress"] > 30)
    metrics = metrics_of(fake)
    assert metrics['reposed_jobs{status="running"}'] == 2 and metrics["reposed_queue_depth"] == 1
    assert 0 < metrics["reposed_queue_age_seconds"] < 60
    disk = os.statvfs(fake.data)
    assert metrics["reposed_disk_bytes"] == disk.f_blocks * disk.f_frsize and metrics["reposed_disk_free_inodes"] > 0
    assert metrics["reposed_pruned_jobs_total"] == metrics["reposed_pruned_bytes_total"] == 0
    assert metrics["reposed_particle_steps_per_second"] == 2e6  # each of two says one million
    assert metrics['reposed_http_requests_total{route="/processes/{}/execution",method="POST",code="201"}'] == 3
    assert metrics["reposed_http_request_seconds_count"] >= 4
    fake.get("/nothing")
    assert metrics_of(fake)['reposed_http_requests_total{route="none",method="",code="404"}'] == 1


@pytest.mark.skipif(not shutil.which("promtool"), reason="promtool (Debian's package prometheus) is not installed")
def test_metrics_are_as_prometheus_wants_them(fake):
    fake.ended(fake.submit())
    checked = subprocess.run(["promtool", "check", "metrics"], input=fake.get("/metrics").content, capture_output=True, timeout=60)
    assert checked.returncode == 0 and checked.stderr == b"", checked.stderr.decode()


def test_an_idle_daemon_stays_small(fake):
    for job in [fake.submit(fake="fault") for _ in range(20)]:
        fake.ended(job)
    resident = metrics_of(fake)["process_resident_memory_bytes"]
    assert resident < 30e6  # what is promised to small machines

