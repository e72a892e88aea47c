"""Everything that can go wrong, while hundreds of jobs are posted and run: daemon and workers killed and held up at random, a clock
that jumps, damaged files and pages. After it, every job that was acknowledged is there once, and each result is right to the bit,
or a failure that says so and that a retry mends."""
import json
import os
import random
import shutil
import signal
import struct
import subprocess
import threading
import time

import pytest
import requests
import worker_runs
from conftest import BUILD, ENDED, Daemon, compiled_shim

GRANULE = {"process": "granule", "inputs": {"friction": 0.5, "radius": 0.05, "rotation_rate": 17.0}}
DRUM = worker_runs.small(duration={"seconds": 0.2}, snapshots={"interval": 0.05}) | {"process": "drum"}
SPECS = [GRANULE | {"inputs": GRANULE["inputs"] | {"friction": friction}} for friction in (0.3, 0.4, 0.5, 0.6)]
SPECS += [DRUM | {"inputs": DRUM["inputs"] | {"seed": seed}} for seed in (1, 2)]
OF_THE_CLOCK = ("wall_seconds", "particle_steps_per_second", "attempt")


def timeless(results):
    return results | {"run": {name: value for name, value in results["run"].items() if name not in OF_THE_CLOCK}}


@pytest.fixture(scope="module")
def right(tmp_path_factory):
    """What each specification comes to where nothing goes wrong, and no daemon is there."""
    folder, results = tmp_path_factory.mktemp("right"), []
    for number, spec in enumerate(SPECS):
        path = worker_runs.write_spec(folder, spec, f"{number}.json")
        assert worker_runs.run(path, folder / f"{number}")[0] == 0
        results.append(timeless(json.loads((folder / f"{number}/result.json").read_text())))
    return results


class Client:
    """Posts each job and study until it is acknowledged: a request that is sent again has the same key."""

    def __init__(self, daemon, jobs, studies):
        self.daemon, self.wanted, self.made, self.stopping = daemon, [("job", n) for n in range(jobs)] + [("study", n) for n in range(studies)], {}, False
        random.Random(1).shuffle(self.wanted)
        self.thread = threading.Thread(target=self.post_all)

    def post(self, kind, number):
        spec = SPECS[number % len(SPECS)]
        body, path = spec | {"label": {"n": number}}, f"/processes/{spec['process']}/execution"
        if kind == "study":
            body, path = {"name": f"s{number}", "base": GRANULE, "vary": {"/inputs/friction": [0.3, 0.4, 0.5, 0.6]}}, "/studies"
        return requests.post(self.daemon.url + path, json=body, headers={"Idempotency-Key": f"{kind}-{number}"}, timeout=20)

    def post_all(self):
        for kind, number in self.wanted:
            while (kind, number) not in self.made and not self.stopping:
                try:
                    answer = self.post(kind, number)
                    if answer.status_code == 201:
                        self.made[kind, number] = answer.json()["jobID" if kind == "job" else "studyID"]
                except (requests.RequestException, ValueError):
                    time.sleep(0.05)


class Blows:
    """One a call, chosen by the seed."""

    def __init__(self, daemon, clock, seed):
        self.daemon, self.clock, self.chance = daemon, clock, random.Random(seed)
        self.kinds = [self.kill_daemon, self.kill_workers, self.kill_all, self.hold_up_workers, self.hold_up_daemon, self.stop, self.jump]
        self.dealt = {kind.__name__: 0 for kind in self.kinds}

    def deal(self):
        kind = self.chance.choice(self.kinds)
        self.dealt[kind.__name__] += 1
        kind()

    def signal_workers(self, how):
        for worker in self.daemon.workers():
            try:
                os.kill(worker, how)
            except ProcessLookupError:
                pass

    def kill_daemon(self):
        self.daemon.stop(signal.SIGKILL)
        self.daemon.start()

    def kill_workers(self):
        self.signal_workers(signal.SIGKILL)

    def kill_all(self):
        self.signal_workers(signal.SIGKILL)
        self.kill_daemon()

    def hold_up_workers(self):
        self.signal_workers(signal.SIGSTOP)
        time.sleep(0.3)
        self.signal_workers(signal.SIGCONT)

    def hold_up_daemon(self):
        self.daemon.process.send_signal(signal.SIGSTOP)
        time.sleep(0.3)
        self.daemon.process.send_signal(signal.SIGCONT)

    def stop(self):
        assert self.daemon.stop(seconds=40) == 0
        self.daemon.start()

    def jump(self):
        """By up to a week, forwards or back."""
        with open(self.clock, "r+b") as file:  # it is mapped, and must never be shorter
            file.write(struct.pack("<q", self.chance.randint(-7 * 86400, 7 * 86400)))


def until_all_have_ended(daemon, seconds):
    """Those that failed, because their workers were killed over and over, are tried again."""
    end = time.monotonic() + seconds
    while True:
        jobs = every_job(daemon)
        for job in jobs:
            if job["status"] == "failed":
                assert "attempts in a row" in job["message"], job
                assert requests.post(f"{daemon.url}/jobs/{job['jobID']}/retry", timeout=30).status_code == 200
        if all(job["status"] == "successful" for job in jobs):
            return jobs
        assert time.monotonic() < end, [job for job in jobs if job["status"] != "successful"]
        time.sleep(0.3)


def every_job(daemon):
    jobs, path = [], "/jobs?limit=100"
    while path:
        page = daemon.get(path).json()
        jobs += page["jobs"]
        path = next((link["href"] for link in page["links"] if link["rel"] == "next"), None)
    return jobs


def results_of(daemon, job):
    answer = daemon.get(f"/jobs/{job}/results")
    return timeless(answer.json()) if answer.status_code == 200 else None


def campaign(folder, monkeypatch, right, jobs, studies, blows, seed):
    """The daemon, with all jobs ended and found to be right."""
    clock = folder / "clock"
    clock.write_bytes(bytes(8))
    daemon = Daemon(folder, options=["--workers", "2"])
    daemon.start()  # measures the machine before the clock jumps
    daemon.stop()
    monkeypatch.setenv("JUMPING_CLOCK", str(clock))
    monkeypatch.setenv("LD_PRELOAD", str(compiled_shim("jumping_clock", folder)))
    daemon.start()
    client, dealer = Client(daemon, jobs, studies), Blows(daemon, clock, seed)
    client.thread.start()
    try:
        while client.thread.is_alive() or sum(dealer.dealt.values()) < blows:
            if sum(dealer.dealt.values()) < blows:
                dealer.deal()
            time.sleep(dealer.chance.uniform(0, 0.5))
    finally:
        client.stopping = True
        client.thread.join()
    ended = until_all_have_ended(daemon, 600)
    alone = {job["label"]["n"]: job["jobID"] for job in ended if "n" in job["label"]}
    assert len(ended) == jobs + 4 * studies and len(client.made) == jobs + studies
    assert alone == {number: job for (kind, number), job in client.made.items() if kind == "job"}  # each once
    wrong = {number for number, job in alone.items() if results_of(daemon, job) != right[number % len(SPECS)]}
    of_studies = [job["jobID"] for job in ended if "n" not in job["label"]]
    wrong |= {job for job in of_studies if results_of(daemon, job) not in right[:4]}
    assert not wrong, dealer.dealt
    return daemon


def damages(content, chance):
    """A file's bytes cut, flipped and zeroed; None: a link in its place."""
    at = chance.randrange(max(1, len(content)))
    yield content[:at]
    if content:
        yield content[:at] + bytes([content[at] ^ 1 << chance.randrange(8)]) + content[at + 1:]
        yield bytes(len(content))
    yield None


def put(path, content, elsewhere):
    path.unlink()
    if content is None:
        path.symlink_to(elsewhere)
    else:
        path.write_bytes(content)


def checked(daemon):
    return subprocess.run([BUILD / "reposed", "check", "--data", daemon.data], capture_output=True, text=True, timeout=120)


def check_files(daemon, job, right_results, chance, files):
    """Whatever becomes of a file of an ended job, its results are right, no link is followed, and `reposed check` tells of all that has
    a checksum."""
    folder = daemon.data / "jobs" / job
    secret = daemon.folder / "secret"
    secret.write_text("not of this job")
    for path in files(sorted(file for file in folder.rglob("*") if file.is_file())):
        before = path.read_bytes()
        for content in damages(before, chance):
            put(path, content, secret)
            assert results_of(daemon, job) == right_results
            for end in ("files.tar", "log", "snapshots/0", "fields.hdf"):
                assert secret.read_bytes() not in daemon.get(f"/jobs/{job}/{end}").content
            if content is not None and content != before and (path.suffix == ".hdf" or path.name == "result.json"):
                told = checked(daemon)
                assert told.returncode != 0 and path.name in told.stdout, (path, told.stdout)
            put(path, before, secret)
    assert results_of(daemon, job) == right_results


def check_bed(daemon, right_results, chance, files):
    """A drum that is stopped in its midst, and of which a file is damaged: it ends right, or fails and a retry mends it."""
    spec = SPECS[4]
    for number in range(files):
        job = requests.post(f"{daemon.url}/processes/drum/execution", json=spec, timeout=30).json()["jobID"]
        folder = daemon.data / "jobs" / job
        daemon.until(job, lambda status: (folder / "events.ndjson").exists() or status["status"] in ENDED)
        daemon.stop(seconds=40)
        paths = sorted(file for file in folder.rglob("*") if file.is_file() and file.name != "lock")
        path = paths[number % len(paths)]
        for content in [chance.choice(list(damages(path.read_bytes(), chance)))]:
            put(path, content, daemon.folder / "secret")
        daemon.start()
        status = daemon.ended(job)
        if status["status"] == "failed":
            assert status["message"]
            assert requests.post(f"{daemon.url}/jobs/{job}/retry", timeout=30).status_code == 200
            status = daemon.ended(job)
        assert status["status"] == "successful" and results_of(daemon, job) == right_results, (path, status)


def check_pages(daemon, right_by_job, chance, pages):
    """A byte of the database flipped: each answer is right, or an error, or `reposed check` says that something is wrong."""
    daemon.stop(seconds=40)
    database, kept = daemon.data / "reposed.sqlite", daemon.folder / "kept.sqlite"
    shutil.copyfile(database, kept)
    for _ in range(pages):
        shutil.copyfile(kept, database)
        for rest in daemon.data.glob("reposed.sqlite-*"):
            rest.unlink()
        with open(database, "r+b") as file:
            at = chance.randrange(database.stat().st_size)
            file.seek(at)
            byte = file.read(1)[0]
            file.seek(at)
            file.write(bytes([byte ^ 1 << chance.randrange(8)]))
        try:
            daemon.start()
        except AssertionError:
            assert daemon.process.wait(20) > 0 and "reposed.sqlite" in daemon.log()
            daemon.process.stdout.close()
            continue
        wrong = set()
        for job, right_results in right_by_job.items():
            answer = daemon.get(f"/jobs/{job}/results")
            if answer.status_code == 200 and timeless(answer.json()) != right_results:
                wrong.add(job)
            assert answer.status_code in (200, 404, 500, 503), answer.text
        assert daemon.is_running() and daemon.stop(seconds=40) == 0
        told = checked(daemon)
        assert not wrong or told.returncode != 0, (at, wrong, told.stdout)
    shutil.copyfile(kept, database)
    for rest in daemon.data.glob("reposed.sqlite-*"):
        rest.unlink()
    daemon.start()


def whole_campaign(folder, monkeypatch, right, jobs, studies, blows, seed, few):
    chance = random.Random(seed)
    daemon = campaign(folder, monkeypatch, right, jobs, studies, blows, seed)
    try:
        alone = {job["label"]["n"]: job["jobID"] for job in every_job(daemon) if "n" in job["label"]}
        choose = (lambda files: chance.sample(files, few)) if few else (lambda files: files)
        check_files(daemon, alone[4], right[4], chance, choose)
        check_bed(daemon, right[4], chance, few or 12)
        check_pages(daemon, {alone[number]: right[number] for number in range(6)}, chance, 3 * few if few else 100)
        job = requests.post(f"{daemon.url}/processes/drum/execution", json=SPECS[5], timeout=30).json()["jobID"]
        assert daemon.ended(job)["status"] == "successful" and results_of(daemon, job) == right[5]
        assert daemon.stop(seconds=40) == 0
        told = checked(daemon)
        assert told.returncode == 0, told.stdout + told.stderr
    finally:
        if daemon.is_running():
            daemon.stop(signal.SIGKILL)


@pytest.mark.torture
def test_a_small_campaign_loses_nothing(tmp_path, monkeypatch, right):
    whole_campaign(tmp_path, monkeypatch, right, jobs=30, studies=2, blows=12, seed=1, few=2)


@pytest.mark.torture
def test_a_campaign_of_five_hundred_jobs_loses_nothing(tmp_path, monkeypatch, right):
    whole_campaign(tmp_path, monkeypatch, right, jobs=500, studies=10, blows=150, seed=2, few=0)
