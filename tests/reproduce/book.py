"""What the report is written from: every study's results, the paper's rows, and where snapshots and pictures are."""
import json
from pathlib import Path

from collecting import runs_of

PAPER = Path(__file__).with_name("paper.json")


class Book:
    """studies: {file: collected}; investigations: {(file, case): collected}; data: the daemon's folder, or None."""

    def __init__(self, studies, investigations, pictures, data=None, wanted=None):
        self.studies, self.investigations, self.pictures, self.data = studies, investigations, Path(pictures), data
        self.wanted = wanted or list(studies)
        self.paper = json.loads(PAPER.read_text())

    def rows(self, file):
        return self.paper["rows"].get(file, [])

    def study(self, file):
        return self.studies.get(file)

    def runs(self, file, case):
        return runs_of(self.studies[file], case) if file in self.studies else []

    def snapshots(self, run):
        return Path(self.data or "") / "jobs" / run["job"] / "snapshots"
