"""GET /events: every change of any job as it comes, to any number of clients that follow."""
import json
import re
import resource
import socket
import time

import pytest
import requests
from conftest import SPEC


class Stream:
    """A client as browsers are: reads events, and comes back with the id of the last one."""

    def __init__(self, daemon, last_id=None, source="127.0.0.1"):
        self.socket = socket.create_connection(("127.0.0.1", daemon.port), timeout=30, source_address=(source, 0))
        header = f"Last-Event-ID: {last_id}\r\n" if last_id else ""
        self.socket.sendall(f"GET /events HTTP/1.1\r\nHost: 127.0.0.1\r\n{header}\r\n".encode())
        self.file = self.socket.makefile("rb")
        self.status = int(self.file.readline().split()[1])
        self.headers = dict(line.decode().strip().lower().split(": ", 1) for line in iter(self.file.readline, b"\r\n"))
        self.id, self.text = None, ""

    def block(self):
        """The next one, as a dict of its fields; without any where it is a comment."""
        while "\n\n" not in self.text:
            size = int(self.file.readline(), 16)
            assert size > 0, "the stream has ended"
            self.text += self.file.read(size + 2)[:size].decode()
        block, self.text = self.text.split("\n\n", 1)
        fields = dict(line.split(": ", 1) for line in block.split("\n") if not line.startswith(":"))
        self.id = fields.get("id", self.id)
        return fields

    def event(self):
        """Name and data of the next one."""
        while True:
            fields = self.block()
            if "event" in fields:
                return fields["event"], json.loads(fields["data"])

    def until(self, accepts):
        events = [self.event()]
        while not accepts(*events[-1]):
            events.append(self.event())
        return events

    def close(self):
        self.file.close()
        self.socket.close()


def has_ended(name, data):
    return name == "job" and data["status"] == "successful"


def test_a_client_hears_of_every_change_and_comes_back_where_it_left(fake):
    first, second = Stream(fake), Stream(fake)
    assert first.status == 200 and first.headers["content-type"] == "text/event-stream" and first.headers["cache-control"] == "no-store"
    assert int(first.block()["retry"]) > 0
    job = fake.submit(SPEC, seconds=2)
    events = first.until(has_ended)
    assert second.until(has_ended) == events
    told = [data for name, data in events if name == "job"]
    assert len(told) == len(events) and {data["jobID"] for data in told} == {job}
    states = [data["status"] for data in told]
    assert states == sorted(states, key=["accepted", "running", "successful"].index) and len(set(states)) == 3
    progress = [data["progress"] for data in told]
    assert progress == sorted(progress) and progress[-1] == 100 and 4 <= len(told) <= 8  # two seconds, and three changes of state
    for name in ("jobID", "processID", "status", "message", "progress", "attempt", "updated"):
        assert told[-1][name] == fake.job(job)[name], name
    second.close()

    back = first.id
    other = fake.submit(SPEC)
    events = first.until(has_ended)
    again = Stream(fake, back)
    assert again.until(has_ended) == events and again.id == first.id and {data["jobID"] for _, data in events} == {other}
    for unknown in ("1-1", "nothing", f"{back}0000"):  # of another daemon, of none, and of a time to come
        assert Stream(fake, unknown).event() == ("jobs", {"reason": "missed"}), unknown
    assert requests.delete(f"{fake.url}/jobs/{other}", timeout=30).status_code == 200
    assert first.event() == ("jobs", {"reason": "deleted"})
    study = {"base": {"inputs": SPEC}, "repeats": 70}
    assert requests.post(f"{fake.url}/studies", json=study, timeout=30).status_code == 201
    assert ("jobs", {"reason": "many"}) in [first.event() for _ in range(3)]
    head = requests.head(f"{fake.url}/events", timeout=30)
    assert head.status_code == 200 and head.headers["Content-Type"] == "text/event-stream"


def test_who_was_away_while_nobody_listened_has_missed_it(fake):
    stream = Stream(fake)
    stream.block()
    stream.close()
    with_nobody = stream.id
    for _ in range(100):  # the daemon learns by and by that it has left
        fake.ended(fake.submit(SPEC))
        again = Stream(fake, with_nobody)
        name, data = again.event()
        again.close()
        if (name, data) == ("jobs", {"reason": "missed"}):
            return
        assert name == "job"
    raise AssertionError("the daemon keeps events for nobody")


def test_one_address_does_not_take_all_streams_and_leaving_ends_them(fake):
    mine = [Stream(fake, source="127.0.0.2") for _ in range(256)]
    assert {stream.status for stream in mine} == {200}
    refused, other = Stream(fake, source="127.0.0.2"), Stream(fake, source="127.0.0.3")
    assert (refused.status, other.status) == (503, 200) and int(refused.headers["retry-after"]) > 0
    assert fake.get("/jobs").status_code == 200
    begun = time.monotonic()
    fake.stop()
    assert time.monotonic() - begun < 10  # streams hold nothing up
    assert other.file.read().endswith(b"0\r\n\r\n")


@pytest.mark.torture
def test_a_thousand_streams_take_little_memory_and_hardly_any_time(fake):
    def facts():
        fields = open(f"/proc/{fake.process.pid}/stat").read().split()
        size = int(re.search(r"VmRSS:\s+(\d+)", open(f"/proc/{fake.process.pid}/status").read())[1]) / 1024
        return size, (int(fields[13]) + int(fields[14])) / 100

    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    if hard < 4096:
        pytest.skip("this user may not open a thousand connections")
    resource.setrlimit(resource.RLIMIT_NOFILE, (4096, hard))
    try:
        before, _ = facts()
        streams = [Stream(fake, source=f"127.0.0.{2 + k // 200}") for k in range(1000)]
        assert {stream.status for stream in streams} == {200}
        after, seconds = facts()
        time.sleep(30)
        assert after - before < 64 and facts()[1] - seconds < 0.3  # of 30 s, in which two beats went out
        fake.ended(fake.submit(SPEC))
        assert all(has_ended(*stream.until(has_ended)[-1]) for stream in streams)
    finally:
        resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))
