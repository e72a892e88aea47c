"""What every physics test has: the programs, runs of drums side by side, and the table of verification.

A test records each of its numbers beside what it must be; every one becomes a row of tests/physics/RESULTS.md, whether
it holds or not, and the test fails where one does not. A tolerance is stated with its reason.
"""
import json
import math
import os
import re
import subprocess
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ.get("REPOSED_BUILD", ROOT / "build")).resolve()
BUILDS = {"single": BUILD / "tests/single", "double": BUILD / "tests/double"}  # of this folder's own programs
HEAD = """# Verification: what the code gives beside what it must give

Written by `make physics LONG=1`; `make physics` renews all but the rows marked *long*. Each number comes from a run of
the programs that users run, or of the core's own step driven by a program in this folder; the references are closed
forms, published values, or other codes' results, as each row says.
"""
COLUMNS = "| case | reference | here | tolerance | holds | source, and why this tolerance |\n|---|---|---|---|---|---|\n"


# ---- the table ----

class Table:
    """Rows of one test. `record(...)` compares at once, but says so only at the end, so that no row is missing."""

    def __init__(self, section, is_long):
        self.section, self.mark, self.rows, self.missed = section, " *long*" if is_long else "", [], []

    def _row(self, case, reference, here, tolerance, holds, why):
        cells = [case, reference, here, tolerance, ("yes" if holds else "NO") + self.mark, why]
        self.rows.append((self.section, case, "| " + " | ".join(str(c).replace("|", "/") for c in cells) + " |"))
        if not holds:
            self.missed.append(f"{case}: {here}, must be {reference} within {tolerance} ({why})")

    def __call__(self, case, here, reference, tolerance, why, unit=""):
        """A number against another; the tolerance in the same unit. A NaN does not hold."""
        holds = here is not None and abs(here - reference) <= tolerance
        self._row(case, text(reference, unit), text(here, unit), "+- " + text(tolerance, unit), holds, why)

    def between(self, case, here, low, high, why, unit=""):
        holds = here is not None and low <= here <= high
        self._row(case, f"{text(low)} to {text(high, unit)}", text(here, unit), "bounds", holds, why)

    def same(self, case, here, reference, why):
        """What must be equal, or for a set: be one of it."""
        one_of = sorted(reference) if isinstance(reference, set) else [reference]
        self._row(case, " or ".join(map(str, one_of)), here, "exact", here in one_of, why)


def text(number, unit=""):
    if number is None:
        return "none"
    return (f"{number:.7g}" + (" " + unit if unit else "")) if isinstance(number, (int, float)) else str(number)


RECORDED = pytest.StashKey()


@pytest.fixture
def record(request):
    in_double = "build" in request.fixturenames and request.getfixturevalue("build") == BUILDS["double"]
    section = request.module.SECTION + (", in double precision" if in_double else "")
    table = Table(section, request.node.get_closest_marker("long") is not None)
    request.node.stash[RECORDED] = table
    return table


@pytest.hookimpl(hookwrapper=True)
def pytest_pyfunc_call(pyfuncitem):
    outcome = yield
    table = pyfuncitem.stash.get(RECORDED, None)
    if table is not None:
        pyfuncitem.config.stash[RECORDED].extend(table.rows)
    outcome.get_result()
    if table is not None and (table.missed or not table.rows):
        pytest.fail("\n".join(table.missed or ["nothing was recorded"]), pytrace=False)


def pytest_addoption(parser):
    parser.addoption("--results", metavar="FILE", help="write the table of what was recorded; rows of tests not run stay")


def pytest_configure(config):
    config.stash[RECORDED] = []


def natural(words):
    """Sorts 2 before 10."""
    return [(0, float(w), "") if re.fullmatch(r"\d+(\.\d+)?", w) else (1, 0.0, w) for w in re.split(r"(\d+(?:\.\d+)?)", words)]


def rows_of(path):
    """(section, case) -> row, of a table written before."""
    rows, section = {}, None
    for line in path.read_text().splitlines() if path.exists() else []:
        if line.startswith("## "):
            section = line[3:]
        elif section and line.startswith("| ") and not line.startswith("| case |"):
            rows[section, line[2:].split(" | ")[0]] = line
    return rows


def pytest_terminal_summary(terminalreporter, config):
    recorded = {(section, case): row for section, case, row in config.stash[RECORDED]}
    if len(recorded) != len(config.stash[RECORDED]):
        terminalreporter.write_line("two rows of the table have one name", red=True)
    if not config.getoption("--results"):
        return
    path = Path(config.getoption("--results"))
    rows = {**rows_of(path), **recorded}
    lines = [HEAD]
    for section in sorted({section for section, _ in rows}, key=natural):
        lines += [f"\n## {section}\n{COLUMNS}".rstrip("\n")]
        lines += [rows[key] for key in sorted(rows, key=lambda k: natural(k[1])) if key[0] == section]
    path.write_text("\n".join(lines).replace("\n\n\n", "\n\n") + "\n")
    terminalreporter.write_line(path.read_text())
    held = sum("| NO" not in row for row in rows.values())
    terminalreporter.write_line(f"{held} of {len(rows)} rows hold, {path}")


# ---- programs ----

@pytest.fixture(params=BUILDS)
def build(request):
    """The folder of this folder's own programs, in single precision and in double."""
    assert BUILDS[request.param].is_dir(), f"{BUILDS[request.param]} is not built: make physics-programs"
    return BUILDS[request.param]


def program(name, build=BUILDS["single"], **numbers):
    """What a program of this folder, given numbers by name, printed: a JSON object."""
    command = [build / name, *(f"{k}={v!r}" if isinstance(v, float) else f"{k}={v}" for k, v in numbers.items())]
    done = subprocess.run(command, capture_output=True, text=True, timeout=900)
    assert done.returncode == 0, f"{command}: {done.stdout}{done.stderr}"
    return json.loads(done.stdout)


# ---- drums ----

def drum(friction, rate=math.pi / 2, *, diameter=0.126, length=0.0189, grain=0.00378, fill=0.5, revolutions=1.25, contact=None,
         wall=None, seed=1, **inputs):
    """The paper's drum as a spec, but for what is said."""
    return {"inputs": {
        "drum": {"diameter": diameter, "length": length, "ends": "periodic", "rotation_rate": rate},
        "particles": [{"shape": "sphere", "diameter": grain, "density": 2500}],
        "fill_fraction": fill,
        "contact": {"friction": friction, "restitution": 0.8, **(contact or {})},
        "wall": {"friction": 0.5, **(wall or {})},
        "duration": {"revolutions": revolutions},
        "snapshots": {"interval": 0},
        "seed": seed, **inputs}}


class Drums:
    """Runs specs with as many workers side by side as there are processors; a spec that was run before is not run again."""

    def __init__(self, folder):
        self.folder, self.known = folder, {}

    def _run(self, spec):
        folder = self.folder / f"{len(self.known)}-{os.urandom(4).hex()}"
        folder.mkdir()
        (folder / "spec.json").write_text(json.dumps(spec))
        done = subprocess.run([BUILD / "repose", "run", folder / "spec.json", "--out", folder / "job"], capture_output=True, text=True)
        assert done.returncode == 0, f"{json.dumps(spec)}: {done.stdout}{done.stderr}"
        result = json.loads((folder / "job/result.json").read_text())
        events = [json.loads(line) for line in (folder / "job/events.ndjson").read_text().splitlines()]
        result["folder"] = folder / "job"
        result["samples"] = [e["values"] for e in events if e["event"] == "sample"]
        return result

    def __call__(self, specs):
        """specs: by name. Returns results by the same names."""
        key = {name: json.dumps(spec, sort_keys=True) for name, spec in specs.items()}
        todo = {key[name]: spec for name, spec in specs.items() if key[name] not in self.known}
        with ThreadPoolExecutor(os.cpu_count()) as pool:
            running = {k: pool.submit(self._run, spec) for k, spec in todo.items()}
            self.known.update({k: future.result() for k, future in running.items()})
        return {name: self.known[k] for name, k in key.items()}


@pytest.fixture(scope="session")
def drums(tmp_path_factory):
    return Drums(tmp_path_factory.mktemp("drums"))
