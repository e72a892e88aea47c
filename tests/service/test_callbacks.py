"""Subscribers of a job are told how it goes and how it ended: at least once, whoever dies, and nobody but those that may be."""
import contextlib
import http.server
import json
import signal
import threading
import time

import pytest
import requests
from conftest import FAKE_WORKER, SPEC, Daemon, run_daemon


class Listener(http.server.ThreadingHTTPServer):
    """Keeps what it is sent, and answers with what `answers` says next, then with 204."""

    def __init__(self, answers=()):
        super().__init__(("127.0.0.1", 0), Hook)
        self.answers, self.seen, self.came = list(answers), [], threading.Condition()
        self.url = f"http://127.0.0.1:{self.server_address[1]}"

    def told(self, accepts, seconds=30):
        with self.came:
            assert self.came.wait_for(lambda: accepts(self.seen), seconds), self.seen
            return list(self.seen)

    def subscriber(self):
        return {f"{name}Uri": f"{self.url}/{name}?job=mine" for name in ("success", "inProgress", "failed")}


class Hook(http.server.BaseHTTPRequestHandler):
    def do_POST(self):
        body = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
        server = self.server
        with server.came:
            status, headers = server.answers.pop(0) if server.answers else (204, {})
            server.seen.append((self.path.removeprefix("/").removesuffix("?job=mine"), body, dict(self.headers)))
            server.came.notify_all()
        self.send_response(status)
        for name, value in ({"Content-Length": "0"} | headers).items():
            self.send_header(name, value)
        self.end_headers()

    def log_message(self, *_):
        pass


@contextlib.contextmanager
def listening(answers=()):
    with Listener(answers) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        try:
            yield server
        finally:
            server.shutdown()
            thread.join()


@pytest.fixture
def calling(tmp_path):
    yield from run_daemon(tmp_path, worker=FAKE_WORKER, options=["--workers", "2", "--callback-host", "127.0.0.1"])


def post(daemon, subscriber, **label):
    body = {"inputs": SPEC, "label": label, "subscriber": subscriber}
    return requests.post(f"{daemon.url}/processes/drum/execution", json=body, timeout=30)


def kinds(seen):
    return [kind for kind, _, _ in seen]


def test_a_subscriber_is_told_how_it_goes_and_gets_the_results(calling):
    with listening() as listener:
        job = post(calling, listener.subscriber()).json()["jobID"]
        seen = listener.told(lambda seen: "success" in kinds(seen))
        assert kinds(seen).count("success") == 1 and "failed" not in kinds(seen)
        _, results, headers = next(entry for entry in seen if entry[0] == "success")
        profile = {"profile": "ogc-results"}
        assert results == calling.get(f"/jobs/{job}/results", params=profile).json()
        assert headers["Content-Type"] == "application/json" and f"{calling.url}/jobs/{job}>" in headers["Link"]
        for kind, status, _ in seen:
            if kind == "inProgress":
                assert status["jobID"] == job and status["links"][0]["href"] == f"{calling.url}/jobs/{job}"
        assert len({headers["Idempotency-Key"] for _, _, headers in seen}) == len(seen)


def test_a_failure_and_a_dismissal_are_told_and_progress_by_tenths(calling):
    with listening() as listener:
        failing = post(calling, listener.subscriber(), fake="fault").json()["jobID"]
        slow = post(calling, listener.subscriber(), fake="slow", seconds="4").json()["jobID"]
        gone = post(calling, {"successUri": f"{listener.url}/success", "failedUri": f"{listener.url}/failed"}, fake="slow", seconds="60")
        assert requests.delete(f"{calling.url}/jobs/{gone.json()['jobID']}", timeout=30).json()["status"] == "dismissed"
        seen = listener.told(lambda seen: kinds(seen).count("failed") == 2 and "success" in kinds(seen))
        ends = {body["jobID"]: body["status"] for kind, body, _ in seen if kind == "failed"}
        assert ends == {failing: "failed", gone.json()["jobID"]: "dismissed"}
        of_slow = [body["progress"] for kind, body, _ in seen if kind == "inProgress" and body["jobID"] == slow]
        assert of_slow and of_slow == sorted(of_slow) and len(of_slow) <= 11


def test_what_is_not_taken_is_sent_again_and_no_redirection_is_followed(calling):
    with listening() as elsewhere, listening([(302, {"Location": f"{elsewhere.url}/success"}), (500, {}), (404, {})]) as listener:
        post(calling, {"successUri": f"{listener.url}/success"})
        seen = listener.told(lambda seen: len(seen) == 4)
        assert len({headers["Idempotency-Key"] for _, _, headers in seen}) == 1 and len({json.dumps(body) for _, body, _ in seen}) == 1
        time.sleep(1.5)
        assert len(listener.seen) == 4 and elsewhere.seen == []
        assert calling.get("/query", params={"sql": "select count(*) from callback"}).json()["rows"] == [[0]]


def test_what_nobody_took_is_told_after_a_crash(tmp_path):
    with listening([(503, {})] * 100) as listener:
        daemon = Daemon(tmp_path, worker=FAKE_WORKER, options=["--callback-host", f"127.0.0.1:{listener.server_address[1]}"]).start()
        jobs = [post(daemon, {"successUri": f"{listener.url}/success"}).json()["jobID"] for _ in range(3)]
        for job in jobs:
            daemon.ended(job)
        listener.told(lambda seen: seen)
        daemon.stop(signal.SIGKILL)
        with listener.came:
            listener.answers.clear()
            listener.seen.clear()
        daemon.start()
        try:
            seen = listener.told(lambda seen: len({headers["Link"] for _, _, headers in seen}) == 3, 60)
            assert {headers["Link"].split("/")[-1].split(">")[0] for _, _, headers in seen} == set(jobs)
        finally:
            assert daemon.stop() == 0


def test_a_host_that_is_silent_holds_up_neither_others_nor_the_end(calling):
    silent = http.server.HTTPServer(("127.0.0.1", 0), Hook)  # takes connections, and never answers
    try:
        with listening() as listener:
            post(calling, {"successUri": f"http://127.0.0.1:{silent.server_address[1]}/"})
            calling.ended(post(calling, {"successUri": f"{listener.url}/success"}).json()["jobID"])
            listener.told(lambda seen: seen, 60)
            assert calling.get("/healthz").elapsed.total_seconds() < 5
        start = time.monotonic()
        assert calling.stop() == 0 and time.monotonic() - start < 10
    finally:
        silent.server_close()


@pytest.mark.parametrize("address", [
    "http://127.0.0.2/", "http://127.0.0.1.example/", "http://localhost/", "https://[::1]/", "http://2130706433/",
])
def test_other_hosts_are_refused_by_name(calling, address):
    answer = post(calling, {"successUri": address})
    errors = answer.json()["errors"]
    assert answer.status_code == 400 and [error["pointer"] for error in errors] == ["/subscriber/successUri"]
    assert "--callback-host" in errors[0]["detail"]


@pytest.mark.parametrize("subscriber", [
    "http://127.0.0.1/", {}, {"successUri": 1}, {"successUri": "ftp://127.0.0.1/"}, {"successUri": "file:///etc/passwd"},
    {"successUri": "http://127.0.0.1@example.org/"}, {"successUri": "http://example.org#@127.0.0.1/"},
    {"successUri": "http://example.org\\@127.0.0.1/"}, {"successUri": "http://127.0.0.1:80:80/"}, {"successUri": "http://"},
    {"successUri": "http://127.0.0.1/\r\nX: 1"}, {"successUri": "http://127.0.0.1/" + "x" * 1000},
    {"successUri": "http://127.0.0.1/", "colour": "red"}, {"successUri": "http://127.0.0.1/", "failedUri": "//127.0.0.1/"},
])
def test_what_is_no_subscriber_is_refused(calling, subscriber):
    answer = post(calling, subscriber)
    assert answer.status_code == 400 and all(error["pointer"].startswith("/subscriber") for error in answer.json()["errors"])


def test_without_the_option_nobody_is_called(fake):
    answer = post(fake, {"successUri": "http://127.0.0.1/"})
    assert answer.status_code == 400 and "--callback-host" in answer.json()["errors"][0]["detail"]
    answer = requests.post(f"{fake.url}/studies", json={"base": {"inputs": SPEC, "subscriber": {"successUri": "http://127.0.0.1/"}}}, timeout=30)
    assert answer.status_code == 400 and [error["pointer"] for error in answer.json()["errors"]] == ["/base/subscriber"]
