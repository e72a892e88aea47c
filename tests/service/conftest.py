"""A real daemon on a free port with a fresh data folder, and a real client."""
import contextlib
import fcntl
import functools
import os
import re
import signal
import subprocess
import tempfile
import time
from pathlib import Path

import pytest
import requests
import yaml

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ.get("REPOSED_BUILD", ROOT / "build"))
read_yaml = functools.partial(yaml.load, Loader=yaml.CSafeLoader)  # as safe_load(), five times as fast
FAKE_WORKER = Path(__file__).with_name("fake_worker.py")
BROWSER_FLAGS = ["--headless", "--no-sandbox", "--disable-gpu", "--enable-unsafe-swiftshader", "--disable-quic", "--no-first-run",
                 "--disable-background-networking", "--disable-component-update", "--disable-sync",
                 "--disable-dev-shm-usage", "--window-size=1280,1000"]
ENDED = ("successful", "failed", "dismissed")
SPEC = {
    "drum": {"diameter": 0.04, "length": 0.012, "rotation_rate": 6.0},
    "particles": [{"diameter": 0.004}],
    "fill_fraction": 0.3,
    "contact": {"friction": 0.3, "maximum_overlap": 0.05},
    "duration": {"seconds": 0.4},
    "snapshots": {"interval": 0.1},
    "seed": 7,
}


def compiled_shim(name, folder):
    """NAME.c of this folder as a library to be preloaded."""
    library = folder / f"{name}.so"
    source = Path(__file__).with_name(f"{name}.c")
    subprocess.run(["cc", "-O1", "-fPIC", "-shared", "-fno-builtin", "-o", library, source, "-ldl"], check=True)
    return library


@pytest.fixture(scope="session", autouse=True)
def cache(tmp_path_factory):
    """A user's cache that is the tests' own, one for all that run at once: the cache of whoever runs them stays as it is. And
    threads that sleep when they wait: where more run than there are cores, others wait for those that spin."""
    folder = tmp_path_factory.getbasetemp()
    folder = (folder.parent if "PYTEST_XDIST_WORKER" in os.environ else folder) / "cache"
    folder.mkdir(exist_ok=True)
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_CACHE_HOME", str(folder))
        patch.setenv("OMP_WAIT_POLICY", "passive")
        yield


@contextlib.contextmanager
def alone_at_measuring():
    """Of the tests that run at once: of two that measure the machine one would give up."""
    with open(Path(os.environ["XDG_CACHE_HOME"]) / "lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield


@functools.cache
def ready_calibration():
    """The file in that cache, where daemons find it, so that none has the machine measured while tests run. The first test that
    needs it makes it, in some seconds of processor time; those that run at once wait for it."""
    with alone_at_measuring(), tempfile.TemporaryDirectory() as data:
        for _ in range(100):  # a calibration that a daemon of before has begun may be at it
            done = subprocess.run([BUILD.absolute() / "repose", "calibrate", "--data", data], capture_output=True, text=True)
            if "another process measures" not in done.stderr:
                break
            time.sleep(0.5)
        assert done.returncode == 0, done.stderr
    return Path(os.environ["XDG_CACHE_HOME"]) / "reposed" / "calibration.json"


class Daemon:
    """One data folder, and the daemon that may be running on it."""

    def __init__(self, folder, worker=None, options=()):
        self.folder, self.data = folder, folder / "data"
        self.options = list(options) + (["--worker", str(worker)] if worker else [])
        self.measures = worker is None
        if BUILD.parent != ROOT:  # the page and the OpenAPI document are looked for beside the build folder
            self.options = ["--web", str(ROOT / "web"), "--api-file", str(ROOT / "api/openapi.yaml"), *self.options]
        self.port, self.process = 0, None
        self.program = BUILD / "reposed"

    @property
    def url(self):
        return f"http://127.0.0.1:{self.port}"

    def start(self):
        """On the port it had before, if it was running before."""
        if self.measures:
            ready_calibration()
        command = [self.program, "serve", "--port", str(self.port), "--data", self.data, *self.options]
        with open(self.folder / "daemon.log", "ab") as log:
            # SIGHUP as it is by default, also where nohup has it ignored
            self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=log, text=True,
                                            preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_DFL))
        line = self.process.stdout.readline()
        assert line.startswith("listening on http://"), self.log()
        self.port = int(line.rsplit(":", 1)[1])
        return self

    def stop(self, how=signal.SIGTERM, seconds=20):
        self.process.send_signal(how)
        code = self.process.wait(seconds)
        self.process.stdout.close()
        assert code >= 0 or code == -how, f"ended by signal {-code}, which nobody sent\n{self.log()}"
        return code

    def is_running(self):
        return self.process is not None and self.process.poll() is None

    def log(self):
        return (self.folder / "daemon.log").read_text()

    def workers(self):
        """Process ids of the daemon's children."""
        tasks = Path(f"/proc/{self.process.pid}/task")
        return [int(child) for task in tasks.iterdir() for child in (task / "children").read_text().split()]

    # --- the client ---

    def get(self, path, **options):
        return requests.get(path if path.startswith("http") else self.url + path, timeout=30, **options)

    def post(self, inputs=SPEC, label=None, **options):
        return requests.post(f"{self.url}/processes/drum/execution", json={"inputs": inputs, "label": label or {}},
                             timeout=30, **options)

    def submit(self, inputs=SPEC, **label):
        answer = self.post(inputs, label)
        assert answer.status_code == 201, answer.text
        return answer.json()["jobID"]

    def job(self, job, wait=0):
        answer = self.get(f"/jobs/{job}?wait={wait}")
        assert answer.status_code == 200, answer.text
        return answer.json()

    def until(self, job, accepts, seconds=30):
        """The job's status as soon as accepts(status) is true."""
        end = time.monotonic() + seconds
        while True:
            status = self.job(job)
            if accepts(status):
                return status
            assert time.monotonic() < end, f"still {status}\n{self.log()}"
            time.sleep(0.05)

    def ended(self, job, seconds=60):
        return self.until(job, lambda status: status["status"] in ENDED, seconds)


def run_daemon(folder, **how):
    daemon = Daemon(folder, **how).start()
    try:
        yield daemon
    finally:
        if daemon.is_running():
            daemon.stop(signal.SIGKILL)


@pytest.fixture
def daemon(tmp_path):
    """With the real worker."""
    yield from run_daemon(tmp_path)


@pytest.fixture
def fake(tmp_path):
    """With a worker that does what the job's label says, quickly."""
    yield from run_daemon(tmp_path, worker=FAKE_WORKER, options=["--workers", "2"])


@pytest.fixture
def daemon_with_token(tmp_path):
    file = tmp_path / "token"
    file.write_text("a-token-of-this-test\n")
    file.chmod(0o600)
    yield from run_daemon(tmp_path, worker=FAKE_WORKER, options=["--token-file", file])


@pytest.fixture(scope="session")
def chromium(tmp_path_factory):
    """One for all tests of the process, because its start takes seconds."""
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service
    options = webdriver.ChromeOptions()
    options.binary_location = "/usr/bin/chromium"
    for flag in BROWSER_FLAGS + [f"--user-data-dir={tmp_path_factory.mktemp('browser') / 'profile'}"]:
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    driver = webdriver.Chrome(options=options, service=Service("/usr/bin/chromedriver"))
    yield driver
    driver.quit()


@pytest.fixture
def browser(chromium):
    """With a tab of its own, and nothing kept of the tests before."""
    first = chromium.current_window_handle
    chromium.switch_to.new_window("tab")
    chromium.execute_cdp_cmd("Network.clearBrowserCookies", {})
    chromium.execute_cdp_cmd("Network.clearBrowserCache", {})
    yield chromium
    complaints = [entry["message"] for entry in chromium.get_log("browser")
                  if entry["level"] == "SEVERE" and not re.search(r"ERR_(CONNECTION|SOCKET)_|status of 401|check=true - .*status of 400|/events - .*status of 503|picture.png.*status of 404", entry["message"])]
    origin = chromium.execute_script("return origin")
    if origin.startswith("http"):
        chromium.execute_cdp_cmd("Storage.clearDataForOrigin", {"origin": origin, "storageTypes": "all"})
    chromium.close()
    chromium.switch_to.window(first)
    assert complaints == []  # neither script errors nor violations of the content security policy
