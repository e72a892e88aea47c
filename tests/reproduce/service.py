"""A daemon of our own on a data folder that is kept, and what we ask of it over HTTP."""
import os
import subprocess
import time
from pathlib import Path

import requests

ROOT = Path(__file__).resolve().parents[2]
ENDED = ("successful", "failed", "dismissed")


class Refused(Exception):
    """The daemon would not start, or would not take what was posted."""


class Service:
    """`with Service(build, data) as service:` starts the daemon and stops it in good order: what runs goes back to the
    queue, and goes on from its checkpoint when the next daemon starts on the same folder."""

    def __init__(self, build, data, workers=None):
        self.build, self.data, self.workers = Path(build), Path(data), workers
        self.process, self.url = None, None

    def __enter__(self):
        self.data.mkdir(parents=True, exist_ok=True)
        port_file = self.data / "port"
        port_file.unlink(missing_ok=True)
        command = [self.build / "reposed", "serve", "--port", "0", "--data", self.data, "--port-file", port_file,
                   "--web", ROOT / "web", "--api-file", ROOT / "api/openapi.yaml"]
        command += ["--workers", str(self.workers)] if self.workers else []
        with open(self.data / "daemon.log", "ab") as log:
            self.process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=log)
        for _ in range(200):
            if port_file.exists() and port_file.read_text().strip():
                self.url = f"http://127.0.0.1:{port_file.read_text().strip()}"
                return self
            if self.process.poll() is not None:
                break
            time.sleep(0.05)
        self.__exit__()
        raise Refused(f"the daemon did not start; {self.data / 'daemon.log'} says why")

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.terminate()
            self.process.wait(60)

    # --- asking ---

    def get(self, path):
        answer = requests.get(path if path.startswith("http") else self.url + path, timeout=90)
        answer.raise_for_status()
        return answer.json()

    def pages(self, path, member):
        """All entries of a list that comes a page at a time."""
        entries = []
        while path:
            page = self.get(path)
            entries += page[member]
            path = next((link["href"] for link in page["links"] if link["rel"] == "next"), None)
        return entries

    def post_study(self, document):
        answer = requests.post(f"{self.url}/studies", json=document, timeout=90)
        if answer.status_code != 201:
            problems = [f"  {error['pointer']} {error['detail']}" for error in answer.json().get("errors", [])]
            raise Refused("\n".join([f"{document['name']}: {answer.json().get('title')}", *problems]))
        return answer.json()["studyID"]

    def studies(self):
        """Newest first."""
        return self.pages("/studies?limit=500", "studies")

    def jobs(self, study):
        return self.pages(f"/jobs?study={study}&limit=400", "jobs")[::-1]

    def samples(self, job):
        return [row["values"] for row in self.pages(f"/jobs/{job}/samples", "samples")]

    def folder(self, job):
        return self.data / "jobs" / job


def processors():
    return len(os.sched_getaffinity(0))
