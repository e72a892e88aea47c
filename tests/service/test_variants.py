"""The programs behind `repose`: one for each instruction set and precision, chosen by processor, --isa and spec."""
import json
import shutil
import subprocess
from pathlib import Path

import h5py
import numpy
import pytest
import worker_runs as worker

SPEC = worker.small(duration={"seconds": 0.2})
FLAGS = set(next(line for line in Path("/proc/cpuinfo").read_text().splitlines() if line.startswith("flags")).split())
HERE = [isa for isa, flag in (("avx512", "avx512vl"), ("avx2", "avx2"), ("plain", "sse2")) if flag in FLAGS]


def run(folder, name, spec=SPEC, *options):
    code, _, errors = worker.run(worker.write_spec(folder, spec, name + ".json"), folder / name, *options, cwd=folder)
    assert code == 0, errors
    return json.loads((folder / name / "result.json").read_text())


def without_what_may_differ(result):
    return {**result, "run": {k: v for k, v in result["run"].items() if k not in (*worker.WALL_CLOCK, "isa")}}


def test_every_instruction_set_gives_the_same_result_and_says_which_it_was(tmp_path):
    best = run(tmp_path, "best")
    assert best["run"]["isa"] == HERE[0] and best["run"]["precision"] == "single"
    for isa in HERE:
        result = run(tmp_path, isa, SPEC, "--isa", isa)
        assert result["run"]["isa"] == isa
        assert without_what_may_differ(result) == without_what_may_differ(best)


def test_an_instruction_set_that_is_none_or_not_here_is_refused(tmp_path):
    for isa in {"avx512", "avx2", "sse9"} - set(HERE):
        code, _, errors = worker.run(worker.write_spec(tmp_path, SPEC), tmp_path / "job", "--isa", isa)
        assert code == 2 and f'--isa is "{isa}"' in errors and HERE[0] in errors
        assert not (tmp_path / "job").exists()


def test_the_spec_chooses_the_precision(tmp_path):
    """Contacts in double: another program, another path of the particles, the same kind of bed."""
    spec = worker.small(duration={"seconds": 0.2}, precision="double")
    double, single = run(tmp_path, "double", spec), run(tmp_path, "single")
    assert double["run"]["precision"] == "double" and double["run"]["isa"] == HERE[0]
    assert double["run"]["particles"] == single["run"]["particles"]
    assert double["repose"]["angle_deg"] != single["repose"]["angle_deg"]
    for name in ("double", "single"):
        log = (tmp_path / name / "log.txt")
        assert not log.exists() or f"{name} precision" in log.read_text()


def test_a_spec_on_standard_input_reaches_the_program_that_takes_over(tmp_path):
    spec = worker.small(duration={"seconds": 0.1}, precision="double")
    done = subprocess.run([worker.REPOSE, "run", "-", "--out", tmp_path / "job", "--json"], input=json.dumps(spec),
                          capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["run"]["precision"] == "double"


def test_double_costs_more_in_the_estimate(tmp_path):
    def seconds(precision):
        spec = json.dumps(worker.small(precision=precision))
        done = subprocess.run([worker.REPOSE, "check", "-", "--data", tmp_path], input=spec, capture_output=True, text=True, check=True)
        return json.loads(done.stdout)["estimate"]["wall_seconds"]
    assert 1.1 * seconds("single") < seconds("double") < 4 * seconds("single")


@pytest.mark.parametrize("before, after", [("single", "double"), ("double", "single")])
def test_a_run_may_start_from_a_checkpoint_of_the_other_precision(tmp_path, before, after):
    """Places and velocities are double in both, and kept to the bit; what contacts remember is rounded to single. So the
    first snapshot, of the same step, is the last one of the run before."""
    run(tmp_path, "first", worker.small(duration={"seconds": 0.2}, precision=before))
    second = run(tmp_path, "second", {**worker.small(duration={"seconds": 0.2}, precision=after, start={"file": "first/checkpoint.hdf"})})
    assert second["run"]["precision"] == after and second["run"]["settling_seconds"] == 0
    snapshots = [sorted((tmp_path / name / "snapshots").glob("0*.hdf")) for name in ("first", "second")]
    with h5py.File(snapshots[0][-1]) as last, h5py.File(snapshots[1][0]) as first:
        assert numpy.array_equal(last["VTKHDF/Points"][:], first["VTKHDF/Points"][:])


def test_repose_by_itself_runs_anywhere_but_in_single(tmp_path):
    alone = shutil.copy(worker.REPOSE, tmp_path / "repose")
    for precision, code in (("single", 0), ("double", 1)):
        path = worker.write_spec(tmp_path, worker.small(duration={"seconds": 0.1}, precision=precision), precision + ".json")
        done = subprocess.run([alone, "run", path, "--out", tmp_path / precision], capture_output=True, text=True, timeout=120)
        assert done.returncode == code, done.stderr
        assert HERE[0] == "plain" and code == 0 or f"repose-{precision}-{HERE[0]}" in done.stderr
    assert json.loads((tmp_path / "single/result.json").read_text())["run"]["isa"] == "plain"
