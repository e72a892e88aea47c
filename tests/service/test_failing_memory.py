"""Whichever allocation of a daemon fails: it answers 5xx, or leaves with a message, and nothing that it has acknowledged is lost."""
import mmap
import struct

import pytest
import requests
from conftest import FAKE_WORKER, Daemon, compiled_shim

NO_MEMORY = (500, 503)


class Memory:
    """The counts of failing_memory.c, shared with the daemon."""

    def __init__(self, path):
        path.write_bytes(bytes(32))
        with open(path, "r+b") as file:
            self.counts = mmap.mmap(file.fileno(), 32)

    def fail(self, first, failures=1):
        struct.pack_into("<qqq", self.counts, 0, 0, first, failures)

    @property
    def made(self):
        return struct.unpack_from("<q", self.counts, 0)[0]

    @property
    def alive(self):
        return struct.unpack_from("<q", self.counts, 24)[0]


@pytest.fixture(scope="module")
def shim(tmp_path_factory):
    return compiled_shim("failing_memory", tmp_path_factory.mktemp("shim"))


@pytest.fixture
def memory(shim, tmp_path, monkeypatch):
    counts = Memory(tmp_path / "counts")
    monkeypatch.setenv("FAILING_MEMORY", str(tmp_path / "counts"))
    monkeypatch.setenv("LD_PRELOAD", str(shim))
    return counts


def start_of(daemon):
    """None, or what is wrong with how a daemon starts or refuses to. One that has started is stopped."""
    told = len(daemon.log()) if (daemon.folder / "daemon.log").exists() else 0
    try:
        daemon.start()
    except AssertionError:
        code = daemon.process.wait(20)
        daemon.process.stdout.close()
        return None if code > 0 and daemon.log()[told:].strip() else f"ended by {code} with \"{daemon.log()[told:]}\""
    try:
        answer = daemon.get("/jobs")
        if answer.status_code not in (200, *NO_MEMORY) or daemon.get("/jobs").status_code != 200:
            return f"GET /jobs: {answer.status_code} {answer.text}"
    except requests.RequestException as problem:
        return f"GET /jobs: {problem}"
    code = daemon.stop()
    return None if code == 0 else f"stopped with {code}: {daemon.log()[told:]}"


def starts(folder, memory, numbers):
    """What is wrong where the n-th allocation of a start fails, for these n of all that a start makes."""
    daemon = Daemon(folder, FAKE_WORKER)
    memory.fail(0)
    daemon.start()
    job = daemon.submit(fake="quick")
    daemon.ended(job)
    daemon.stop()
    memory.fail(0)
    daemon.start()
    made = memory.made
    daemon.stop()
    wrong = {}
    for n in numbers(made):
        memory.fail(n)
        problem = start_of(daemon)
        if problem:
            wrong[n] = problem
    memory.fail(0)
    daemon.start()
    status = daemon.job(job)["status"]
    daemon.stop()
    return wrong, status, made


def some(count):
    """n that are close at first and then ever wider apart, up to all that are made."""
    return lambda made: sorted({max(1, round(made ** ((k + 0.5) / count))) for k in range(count)})


def every(made):
    return range(1, made + 1)


def posts(folder, memory, numbers):
    """What is wrong where the n-th allocation from a POST on fails, for these n of all that one makes, and how many there are."""
    daemon = Daemon(folder, FAKE_WORKER, options=["--workers", "1"]).start()
    daemon.submit(fake="slow", seconds=60)  # the others wait behind it
    memory.fail(0)
    daemon.submit()
    made = memory.made
    accepted, wrong = [], {}
    for n in numbers(made):
        memory.fail(n)
        try:
            answer = daemon.post()
            if answer.status_code == 201:
                accepted.append(answer.json()["jobID"])
            elif answer.status_code not in NO_MEMORY:
                wrong[n] = answer.status_code, answer.text
        except requests.RequestException:  # without memory a connection may be closed; the daemon stays
            pass
        memory.fail(0)
        if not daemon.is_running():
            wrong[n] = "the daemon ended: " + daemon.log()[-300:]
            daemon.start()
    accepted.append(daemon.submit())
    daemon.stop()
    daemon.start()
    wrong |= {job: "lost" for job in accepted if daemon.get(f"/jobs/{job}").status_code != 200}
    daemon.stop()
    return wrong, made


def test_a_start_without_memory_is_refused_or_goes_on_and_loses_nothing(memory, tmp_path):
    wrong, status, made = starts(tmp_path, memory, some(12))
    assert made > 1000 and status == "successful" and not wrong


def test_a_post_without_memory_is_answered_or_cut_off_and_loses_nothing(memory, tmp_path):
    wrong, made = posts(tmp_path, memory, some(60))
    assert made > 100 and not wrong


@pytest.mark.torture
def test_no_allocation_of_a_start_is_missed_in_silence(memory, tmp_path):
    """Every one of the first thousand, and of the other tens of thousands, which a schema makes over and over, every hundredth."""
    wrong, status, made = starts(tmp_path, memory, lambda made: [*range(1, 1000), *range(1000, made, 100)])
    assert made > 1000 and status == "successful" and not wrong


@pytest.mark.torture
def test_no_allocation_of_a_post_ends_the_daemon_or_loses_a_job(memory, tmp_path):
    wrong, made = posts(tmp_path, memory, every)
    assert made > 100 and not wrong
