"""Who may: tokens by name, sessions of the page, guesses that get slow, and one address that can't take what others need."""
import re
import signal
import socket
import subprocess
import time

import pytest
import requests
from conftest import BUILD, FAKE_WORKER, ROOT, run_daemon, read_yaml
from test_daemon_clients import ENDLESS, ask_and_keep, job_of_long_specification, until
from test_daemon_http import head, metrics_of

READER, WRITER, LATER = "reads-only-0123456789", "writes-too-0123456789", "comes-later-0123456789"
LINES = f"# who may\nanna read {READER}\n\n  ci-server\twrite {WRITER}\r\n"


def write_tokens(folder, text):
    file = folder / "tokens"
    file.write_text(text)
    file.chmod(0o600)
    return file


@pytest.fixture
def guarded(tmp_path):
    yield from run_daemon(tmp_path, worker=FAKE_WORKER, options=["--token-file", str(write_tokens(tmp_path, LINES))])


def bearer(token):
    return {"Authorization": f"Bearer {token}"}


def test_a_token_does_what_its_line_says(guarded):
    assert guarded.get("/jobs", headers=bearer(READER)).status_code == 200
    refused = guarded.post(headers=bearer(READER))
    assert refused.status_code == 403 and refused.json()["type"].endswith("/token-may-only-read")
    answer = guarded.post(headers=bearer(WRITER))
    assert answer.status_code == 201
    job = f"{guarded.url}/jobs/{answer.json()['jobID']}"
    assert requests.delete(job, headers=bearer(READER), timeout=30).status_code == 403
    assert requests.delete(job, headers=bearer(WRITER), timeout=30).status_code == 200


def test_who_may_read_may_ask_what_a_write_would_do(guarded):
    body = {"inputs": {"friction": 0.5, "rotation_rate": 18}}
    job = guarded.post(headers=bearer(WRITER)).json()["jobID"]
    study = {"base": {"process": "granule", "inputs": body["inputs"]}, "vary": {"/inputs/friction": [0.5, 0.6]}}
    asks = [("/processes/granule/execution", "check", body), ("/studies", "check", study),
            ("/jobs/cancel?status=accepted,running", "dry_run", None), ("/jobs/delete?status=accepted,running", "dry_run", None)]
    for path, dry, document in asks:
        ask = path + ("&" if "?" in path else "?") + dry
        for end, code in (("=true", 200), ("=false", 403), ("=true&" + dry + "=false", 400), ("=TRUE", 403), ("", 403)):
            answer = requests.post(guarded.url + ask + end, json=document, timeout=30,
                                   headers=bearer(READER) | {"Idempotency-Key": "dry"})
            assert answer.status_code == code, (ask, end, answer.text)
    assert [one["jobID"] for one in guarded.get("/jobs", headers=bearer(READER)).json()["jobs"]] == [job]
    assert guarded.get(f"/jobs/{job}", headers=bearer(READER)).json()["status"] in ("accepted", "running")


def test_every_address_but_the_page_needs_a_token(guarded):
    """By the list of addresses that the OpenAPI document has."""
    paths = read_yaml((ROOT / "api/openapi.yaml").read_text())["paths"]
    asked = 0
    for path, operations in paths.items():
        for method in operations:
            if path in ("/web/{name}", "/web/vendor/{name}", "/session") or method == "parameters":
                continue
            target = path.replace("{", "").replace("}", "")
            answer = requests.request(method, guarded.url + target, timeout=30)
            assert answer.status_code == 401 and answer.headers["WWW-Authenticate"] == "Bearer", (method, path)
            asked += 1
    assert asked > 25
    page = guarded.get("/", headers={"Accept": "text/html"})
    assert page.status_code == 200 and "<html" in page.text
    assert guarded.get("/web/style.css").status_code == 200
    assert requests.get(f"{guarded.url}/", headers=bearer(READER), timeout=30).status_code == 200


@pytest.mark.parametrize("text, says", [
    (f"anna reed {READER} x\n", ["line 1 must be: name"]), (f"anna reed {READER}\n", ["line 1 says neither read nor write"]),
    (f"#\nanna read {READER}\nanna write {WRITER}\n", ["line 3 has a name that is there already"]),
    (f"a/b read {READER}\nb read short\n", ["line 1 has a name", "line 2 has a token that is not 16"]),
    (f"a read {READER}\nb write {READER}\n", ["line 2 has a token that is there already"]), ("# nobody\n", ["has no token"]),
    ("".join(f"n{k} read token-{k:020}\n" for k in range(33)), ["line 33 is one too many"])])
def test_a_token_file_that_is_wrong_is_refused_with_all_lines(tmp_path, text, says):
    command = [BUILD / "reposed", "serve", "--port", "0", "--data", tmp_path / "data", "--worker", FAKE_WORKER,
               "--token-file", write_tokens(tmp_path, text)]
    refused = subprocess.run(command, capture_output=True, text=True, timeout=60)
    assert refused.returncode == 1
    assert [words for words in says if words not in refused.stderr] == []
    assert READER not in refused.stderr


def test_tokens_are_read_again_on_sighup_and_a_wrong_file_leaves_them(guarded, tmp_path):
    session = requests.Session()
    assert session.post(f"{guarded.url}/session", json={"token": READER}, timeout=30).status_code == 201
    other = requests.Session()
    assert other.post(f"{guarded.url}/session", json={"token": WRITER}, timeout=30).status_code == 201
    write_tokens(tmp_path, f"anna read {READER}\nberta write {LATER}\n")
    guarded.process.send_signal(signal.SIGHUP)
    until(lambda: guarded.get("/jobs", headers=bearer(LATER)).status_code == 200, 10)
    assert guarded.get("/jobs", headers=bearer(WRITER)).status_code == 401
    assert session.get(f"{guarded.url}/jobs", timeout=30).status_code == 200
    assert other.get(f"{guarded.url}/jobs", timeout=30).status_code == 401  # its token is gone
    write_tokens(tmp_path, "anna write\n")
    guarded.process.send_signal(signal.SIGHUP)
    until(lambda: "the tokens stay as they were" in guarded.log(), 10)
    assert guarded.get("/jobs", headers=bearer(LATER)).status_code == 200
    assert guarded.is_running()


def test_a_session_is_a_cookie_that_scripts_and_other_sites_do_not_get(guarded):
    page = requests.Session()
    begun = page.post(f"{guarded.url}/session", json={"token": WRITER}, timeout=30)
    assert begun.status_code == 201 and begun.json() == {"name": "ci-server", "access": "write"}
    words = [word.strip() for word in begun.headers["Set-Cookie"].split(";")]
    assert {"HttpOnly", "SameSite=Strict", "Path=/"} <= set(words) and WRITER not in begun.headers["Set-Cookie"]
    assert page.get(f"{guarded.url}/jobs", timeout=30).status_code == 200
    body = {"inputs": {"friction": 0.5}}
    execution = f"{guarded.url}/processes/granule/execution"
    assert page.post(execution, json=body, timeout=30).status_code == 201
    assert page.post(execution, json=body, headers={"Origin": "http://evil.example"}, timeout=30).status_code == 403
    kept = dict(page.cookies)
    assert page.delete(f"{guarded.url}/session", timeout=30).status_code == 200
    assert guarded.get("/jobs", cookies=kept).status_code == 401  # ended, and not only forgotten by the browser
    for wrong in ({"token": 5}, {"tokens": WRITER}, {}, [WRITER]):
        assert requests.post(f"{guarded.url}/session", json=wrong, timeout=30).status_code == 400


def test_guesses_get_slow_for_one_address_alone(guarded):
    """Twenty at once, then one a second, by whichever way they come."""
    codes = [guarded.get("/jobs", headers=bearer(f"guess-{k:020}")).status_code for k in range(12)]
    codes += [requests.post(f"{guarded.url}/session", json={"token": f"guess-{k}"}, timeout=30).status_code for k in range(14)]
    assert codes[:20] == [401] * 20 and 429 in codes[20:]
    late = guarded.get("/jobs", headers=bearer(WRITER))
    if late.status_code == 429:  # not even a right one is looked at, or guesses would not be slow
        assert int(late.headers["Retry-After"]) >= 1 and late.json()["type"].endswith("/too-many-wrong-tokens")
    assert ask_from("127.0.0.9", guarded, "/jobs", f"Authorization: Bearer {READER}\r\n").startswith(b"HTTP/1.1 200")
    until(lambda: guarded.get("/jobs", headers=bearer(WRITER)).status_code == 200, 20)


def connect_from(address, daemon):
    return socket.create_connection(("127.0.0.1", daemon.port), timeout=20, source_address=(address, 0))


def ask_from(address, daemon, target, headers=""):
    with connect_from(address, daemon) as connection:
        connection.sendall(head(daemon, target=target).encode().replace(b"\r\n\r\n", b"\r\n" + headers.encode() + b"\r\n"))
        return connection.recv(65536)


def test_one_address_that_asks_too_fast_is_told_so_and_no_other(tmp_path):
    for daemon in run_daemon(tmp_path, worker=FAKE_WORKER, options=["--address-rate", "5"]):
        answers = [daemon.get("/healthz") for _ in range(30)]
        codes = [answer.status_code for answer in answers]
        assert codes[:10] == [200] * 10 and 429 in codes
        assert all(int(answer.headers["Retry-After"]) >= 1 for answer in answers if answer.status_code == 429)
        assert ask_from("127.0.0.9", daemon, "/healthz").startswith(b"HTTP/1.1 200")
        until(lambda: daemon.get("/healthz").status_code == 200, 10)


def test_pages_of_an_allowed_origin_alone_may_use_the_service(tmp_path):
    ours, evil = "https://lab.example:8443", "https://evil.example"
    options = ["--token-file", str(write_tokens(tmp_path, LINES)), "--allow-origin", ours]
    for daemon in run_daemon(tmp_path, worker=FAKE_WORKER, options=options):
        asked = {"Access-Control-Request-Method": "POST", "Access-Control-Request-Headers": "authorization, content-type"}
        execution = f"{daemon.url}/processes/granule/execution"
        preflight = requests.options(execution, headers={"Origin": ours, **asked}, timeout=30)
        assert preflight.status_code == 204 and preflight.headers["Access-Control-Allow-Origin"] == ours
        assert "POST" in preflight.headers["Access-Control-Allow-Methods"]
        assert {"Authorization", "Content-Type"} <= set(preflight.headers["Access-Control-Allow-Headers"].split(", "))
        body = {"inputs": {"friction": 0.5}}
        answer = requests.post(execution, json=body, headers={"Origin": ours, **bearer(WRITER)}, timeout=30)
        assert answer.status_code == 201 and answer.headers["Access-Control-Allow-Origin"] == ours
        assert "Origin" in answer.headers["Vary"] and "Access-Control-Allow-Credentials" not in answer.headers
        assert {"Location", "Link", "X-Request-Id"} <= set(answer.headers["Access-Control-Expose-Headers"].split(", "))
        for origin in (evil, ours + "0", ours.upper(), "null"):
            refused = requests.options(execution, headers={"Origin": origin, **asked}, timeout=30)
            assert refused.status_code == 405 and "Access-Control-Allow-Origin" not in refused.headers
            assert requests.post(execution, json=body, headers={"Origin": origin, **bearer(WRITER)}, timeout=30).status_code == 403


def test_three_hundred_waiters_of_one_address_stop_no_other(fake):
    job = fake.submit(fake="slow", seconds="60")
    waiters = [connect_from("127.0.0.1", fake) for _ in range(300)]
    try:
        for waiter in waiters:
            waiter.sendall(head(fake, target=f"/jobs/{job}?wait=60").encode())
        start = time.monotonic()
        assert ask_from("127.0.0.9", fake, f"/jobs/{job}").startswith(b"HTTP/1.1 200")
        assert time.monotonic() - start < 5
    finally:
        for waiter in waiters:
            waiter.close()


def test_one_address_has_its_share_of_connections_and_no_more(fake):
    job = fake.submit(fake="slow", seconds="60")
    busy = [connect_from("127.0.0.1", fake) for _ in range(90)]
    for waiter in busy:
        waiter.sendall(head(fake, target=f"/jobs/{job}?wait=60").encode())
    until(lambda: metrics_of(fake)["reposed_http_connections"] >= 90, 20)
    idle = [connect_from("127.0.0.1", fake) for _ in range(500)]
    try:
        for address in ("127.0.0.2", "127.0.0.3"):
            assert ask_from(address, fake, "/healthz").startswith(b"HTTP/1.1 200")
        def connections():
            told = re.search(r"^reposed_http_connections (\d+)", ask_from("127.0.0.2", fake, "/metrics").decode(), re.M)
            return int(told[1]) if told else 500
        until(lambda: connections() <= 322, 10)  # 320, and those that ask; the others are being closed
        assert fake.get("/healthz").status_code == 200  # one that asks nothing makes room for it
        for waiter in busy:  # and none that waits for its answer was closed for that
            waiter.setblocking(False)
            with pytest.raises(BlockingIOError):
                waiter.recv(1)
    finally:
        for connection in busy + idle:
            connection.close()


def test_what_one_address_does_not_read_leaves_memory_for_another(fake):
    job = job_of_long_specification(fake)
    clients = [ask_and_keep(fake, f"/jobs/{job}/spec", receive_buffer=4096) for _ in range(7)]
    try:
        told = [client.recv(100) for client in clients]  # what is refused is short
        assert [answer[9:12] for answer in told].count(b"429") >= 1 and [answer[9:12] for answer in told].count(b"200") == 6
        for _ in range(5):  # 25 MB more: another address has room for them while the first reads nothing
            assert ask_from("127.0.0.2", fake, f"/jobs/{job}/spec").startswith(b"HTTP/1.1 200")
    finally:
        for client in clients:
            client.close()


def test_slow_queries_of_one_address_leave_a_place_for_another(fake):
    clients = [ask_and_keep(fake, f"/query?sql={ENDLESS}") for _ in range(140)]
    try:
        assert ask_from("127.0.0.9", fake, "/query?sql=select+1").startswith(b"HTTP/1.1 200")
    finally:
        for client in clients:
            client.close()
