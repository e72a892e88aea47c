"""`repose` by itself: specs checked, a run from spec to result, and what survives when it is interrupted."""
import json
import math
import pathlib
import resource
import signal
import subprocess

import pytest
from conftest import ready_calibration
from worker_runs import (REPOSE, SMALL, events, result, run, samples, small, snapshot_bytes, start, timeless_result,
                         wait_until, write_spec)


def check(text):
    ready_calibration()  # else the first that are checked measure the machine, all at once
    done = subprocess.run([REPOSE, "check", "-"], input=text, capture_output=True, text=True, timeout=60)
    return done.returncode, done.stdout


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """A run of SMALL that nothing interrupted: the oracle for those that were."""
    folder = tmp_path_factory.mktemp("whole")
    code, stdout, stderr = run(write_spec(folder, SMALL), folder / "job", "--json")
    assert code == 0, stderr
    return folder / "job", stdout


# --- specs

def test_check_prints_the_canonical_spec_and_an_estimate():
    code, text = check(json.dumps(SMALL))
    assert code == 0
    answer = json.loads(text)
    assert answer["spec"]["inputs"]["contact"]["friction"] == 0.3
    assert answer["spec"]["inputs"]["drum"]["ends"] == "periodic"
    estimate = answer["estimate"]
    # pi/4 D^2 L fill 0.6 / (pi/6 d^3)
    assert estimate["particles"] == round(0.03**2 * 0.01 / 4 * 0.5 * 0.6 / (0.003**3 / 6))
    assert estimate["steps"] * estimate["time_step"] > 4 * math.pi / 6.0
    assert estimate["wall_seconds"] > 0 and estimate["memory_bytes"] > 0


def test_a_canonical_spec_is_checked_into_itself():
    _, text = check(json.dumps(SMALL))
    spec = json.loads(text)["spec"]
    code, again = check(json.dumps(spec))
    assert code == 0 and again == text


def test_check_lists_every_problem_and_ends_with_2():
    bad = small(fill_fraction=1.4, contact={"friction": -1, "law": "hertz"})
    bad["inputs"]["colour"] = "red"
    code, text = check(json.dumps(bad))
    assert code == 2
    errors = {error["pointer"]: error["detail"] for error in json.loads(text)["errors"]}
    assert errors["/inputs/fill_fraction"] == "is 1.4; must be in (0, 0.95]"
    assert set(errors) == {"/inputs/fill_fraction", "/inputs/contact/friction", "/inputs/contact/law", "/inputs/colour"}


@pytest.mark.parametrize("text, expected", [
    ("{", "is not JSON"),
    ('{"inputs": {"seed": 1, "seed": 2}}', "duplicate object key"),
    ('{"inputs": {"snapshots": {"interval": 1e-400}}}', "too close to 0"),
    ('{"inputs": {"seed": NaN}}', "is not JSON"),
    ('{"inputs": {"seed": 1e400}}', "is not JSON"),
    ('{"inputs": {}} x', "is not JSON"),
    ("[]", "must be an object"),
    ("[" * 3000, "is not JSON"),
])
def test_text_that_is_no_spec_is_refused_in_words(text, expected):
    code, answer = check(text)
    assert code == 2
    assert expected in json.loads(answer)["errors"][0]["detail"]


def test_a_seed_is_chosen_when_none_is_given():
    spec = small()
    del spec["inputs"]["seed"]
    seeds = {json.loads(check(json.dumps(spec))[1])["spec"]["inputs"]["seed"] for _ in range(3)}
    assert len(seeds) == 3 and all(0 <= seed < 2**53 for seed in seeds)


def test_wrong_usage_ends_with_2_and_help_with_0(tmp_path):
    assert subprocess.run([REPOSE, "fly"], capture_output=True).returncode == 2
    assert subprocess.run([REPOSE, "run", "x.json"], capture_output=True).returncode == 2
    wrong = subprocess.run([REPOSE, "run", "x.json", "--out", str(tmp_path / "o"), "--threads", "none"], capture_output=True, text=True)
    assert wrong.returncode == 2 and wrong.stderr == 'repose: --threads is "none"; must be a whole number in [1, 256]\n'
    unknown = subprocess.run([REPOSE, "run", "x.json", "--speed", "2"], capture_output=True, text=True)
    assert unknown.returncode == 2 and unknown.stderr == f"{REPOSE}: unrecognized option '--speed'\n"
    shown = subprocess.run([REPOSE, "--help"], capture_output=True, text=True)
    assert shown.returncode == 0 and "--out DIR" in shown.stdout


# --- a run

def test_a_run_leaves_every_result_that_is_promised(whole):
    document = result(whole[0])
    assert set(document) == {"repose", "regime", "segregation", "packing", "drive", "run", "stages"}
    promised = {
        "repose": ["angle_deg", "standard_error_deg", "minimum_deg", "maximum_deg", "steady",
                   "drift_deg_per_revolution", "method", "other_methods", "interface_fluctuation",
                   "dynamic_cohesive_index", "interface"],
        "regime": ["name", "omega2_outer", "omega2_inner", "predicted", "evidence"],
        "segregation": ["radial_index", "axial_index", "lacey_index"],
        "packing": ["solid_fraction", "coordination_number", "mean_overlap", "overlap_99"],
        "drive": ["torque", "torque_standard_error", "weight_torque", "weight_torque_standard_error", "torque_number", "power"],
        "run": ["particles", "steps", "time_step", "simulated_seconds", "wall_seconds", "particle_steps_per_second",
                "maximum_overlap", "threads", "seed"],
    }
    for output, names in promised.items():
        assert set(names) <= set(document[output]), output
    assert document["repose"]["method"] == "surface-fit"
    assert document["segregation"]["radial_index"] is None  # one species
    assert document["run"]["simulated_seconds"] == pytest.approx(4 * math.pi / 6, abs=1e-4)


def test_the_angle_is_that_of_a_bed_of_frictional_spheres(whole):
    # Ten diameters across is a coarse drum: any dynamic angle of spheres with friction lies well within this.
    repose = result(whole[0])["repose"]
    assert 10 < repose["angle_deg"] < 50
    assert repose["minimum_deg"] <= repose["angle_deg"] <= repose["maximum_deg"]


def test_no_overlap_is_beyond_what_the_highest_fall_can_give(whole):
    # A pair that meets at v overlaps by v sqrt(m/2 / K1); nothing falls further than the drum's diameter, on a wall
    # that moves at omega D/2.
    facts = result(whole[0])["run"]
    mass = math.pi / 6 * 0.003**3 * 2500
    speed = math.sqrt(2 * 9.81 * 0.03) + 6.0 * 0.015
    assert 0 < facts["maximum_overlap"] < speed * math.sqrt(mass / 2 / facts["stiffness"]) / 0.003


def test_json_prints_the_results_file(whole):
    assert json.loads(whole[1]) == result(whole[0])


def test_events_begin_with_the_start_and_number_samples_without_a_gap(whole):
    out = whole[0]
    assert events(out)[0]["event"] == "start" and events(out)[0]["resumed"] is False
    numbers = [event["number"] for event in events(out, "sample")]
    assert numbers == list(range(result(out)["run"]["samples"]))
    first = events(out, "sample")[0]
    assert first["time"] == 0 and "angle_deg" in first["values"]
    for event in events(out):
        assert {"event", "step", "time"} <= set(event)


def test_samples_come_at_least_twenty_times_a_second(whole):
    times = [event["time"] for event in events(whole[0], "sample")]
    steps = [b - a for a, b in zip(times, times[1:])]
    assert max(steps) <= 0.05 * 1.001
    assert max(steps) - min(steps) < 2.1 * result(whole[0])["run"]["time_step"]


def test_snapshots_are_regular_and_end_with_the_run(whole):
    out = whole[0]
    written = events(out, "snapshot")
    assert [event["file"] for event in written] == ["%06d.hdf" % n for n in range(len(written))]
    assert written[0]["time"] == 0
    assert written[-1]["time"] == pytest.approx(result(out)["run"]["simulated_seconds"], rel=1e-11)
    for number, event in enumerate(written[:-1]):
        assert event["time"] == pytest.approx(0.1 * number, abs=2e-4)
        assert event["bytes"] == (out / "snapshots" / event["file"]).stat().st_size
    assert not list(out.rglob("*.tmp"))


def test_an_interval_of_0_writes_the_last_snapshot_alone(tmp_path):
    spec = small(snapshots={"interval": 0}, duration={"seconds": 0.05})
    assert run(write_spec(tmp_path, spec), tmp_path / "job")[0] == 0
    assert list(snapshot_bytes(tmp_path / "job")) == ["000000.bin", "000000.hdf"]
    assert events(tmp_path / "job", "snapshot")[0]["time"] == pytest.approx(0.05, abs=1e-3)


def test_the_number_of_threads_changes_nothing(tmp_path):
    # Short: two threads that share a core with others wait for each other at every step.
    spec = write_spec(tmp_path, small(duration={"seconds": 0.05}, snapshots={"interval": 0.02}))
    for threads in (1, 2):
        code, _, stderr = run(spec, tmp_path / str(threads), "--threads", threads)
        assert code == 0, stderr
    alone, with_two = timeless_result(tmp_path / "1"), timeless_result(tmp_path / "2")
    assert alone["run"].pop("threads") == 1 and with_two["run"].pop("threads") == 2
    assert with_two == alone
    assert snapshot_bytes(tmp_path / "2") == snapshot_bytes(tmp_path / "1")
    assert samples(tmp_path / "2") == samples(tmp_path / "1")


def test_progress_is_told_once_a_second_and_never_goes_back(tmp_path):
    out = tmp_path / "job"
    worker = start(write_spec(tmp_path, small(duration={"revolutions": 20}, snapshots={"interval": 0})), out)
    try:
        wait_until(lambda: len(events(out, "progress")) >= 3)
    finally:
        worker.kill()
        worker.communicate()
    told = events(out, "progress")
    percents = [event["progress"] for event in told]
    assert percents == sorted(percents) and 0 < percents[0] and percents[-1] < 100
    assert all(event["eta_seconds"] > 0 and event["particle_steps_per_second"] > 0 for event in told)
    assert told[-1]["phase"] == "rotating"


def test_another_seed_gives_another_run(whole, tmp_path):
    assert run(write_spec(tmp_path, small(seed=8)), tmp_path / "job")[0] == 0
    assert result(tmp_path / "job")["repose"]["angle_deg"] != result(whole[0])["repose"]["angle_deg"]


def test_the_angle_is_printed_also_where_nobody_sits_at_a_terminal(whole):
    folder, _ = whole
    code, stdout, _ = run(folder.parent / "request.json", folder)  # complete: says what came out
    repose = result(folder)["repose"]
    error = repose["standard_error_deg"]
    known = f"{repose['angle_deg']:.2f} degrees, of unknown error" if error is None else f"{repose['angle_deg']:.2f} +- {error:.2f} degrees"
    assert code == 0 and known in stdout
    assert "\r" not in stdout and "\033" not in stdout


@pytest.mark.parametrize("program, commands", [("repose", ("run", "check", "calibrate", "plan")), ("reposed", ("serve",))])
def test_help_is_on_stdout_and_a_word_too_few_is_a_mistake(program, commands):
    def call(*words):
        done = subprocess.run([str(pathlib.Path(REPOSE).with_name(program)), *words], capture_output=True, text=True, timeout=20)
        return done.returncode, done.stdout, done.stderr

    code, out, _ = call("--help")
    assert code == 0 and all(f"{program} {command}" in out for command in commands)
    assert call() == (2, "", out)
    for command in commands:
        for word in ("--help", "-h"):
            code, text, complaint = call(command, word)
            assert (code, complaint) == (0, "") and f"{program} {command}" in text
    code, nothing, complaint = call("walk")
    assert code == 2 and nothing == "" and "walk" in complaint


# --- interrupted runs

def expect_as_if_never_interrupted(out, whole_out):
    assert timeless_result(out) == timeless_result(whole_out)
    assert samples(out) == samples(whole_out)
    assert snapshot_bytes(out) == snapshot_bytes(whole_out)


def interrupt(spec_path, out, with_signal, samples_before=20):
    """Starts a run and sends the signal when it has a checkpoint taken while rotating, and samples after it."""
    worker = start(spec_path, out, "--checkpoint-seconds", 0.1)
    wait_until(lambda: worker.poll() is not None or len(events(out, "sample")) >= samples_before
               and any(event["time"] > 0 for event in events(out, "checkpoint")))
    assert worker.poll() is None, "ended before it could be interrupted: " + worker.communicate()[1]
    worker.send_signal(with_signal)
    worker.communicate(timeout=20)
    return worker.returncode


def test_a_killed_run_goes_on_from_its_checkpoint_to_the_same_result(whole, tmp_path):
    spec, out = write_spec(tmp_path, SMALL), tmp_path / "job"
    assert interrupt(spec, out, signal.SIGKILL) == -signal.SIGKILL
    assert not (out / "result.json").exists()
    code, _, stderr = run(spec, out, "--attempt", 2)
    assert code == 0, stderr
    starts = events(out, "start")
    assert [s["attempt"] for s in starts] == [1, 2]
    assert starts[1]["resumed"] is True and starts[1]["step"] > 0
    expect_as_if_never_interrupted(out, whole[0])
    assert (out / "fields.hdf").read_bytes() == (whole[0] / "fields.hdf").read_bytes()


def test_a_run_killed_before_its_first_checkpoint_starts_anew(whole, tmp_path):
    spec, out = write_spec(tmp_path, SMALL), tmp_path / "job"
    worker = start(spec, out, "--checkpoint-seconds", 3600)
    wait_until(lambda: len(events(out, "sample")) > 3)
    worker.kill()
    worker.communicate()
    assert not (out / "checkpoint.hdf").exists()
    assert run(spec, out, "--attempt", 2)[0] == 0
    assert events(out, "start")[1]["resumed"] is False
    expect_as_if_never_interrupted(out, whole[0])


def test_sigterm_saves_a_checkpoint_and_ends_with_3(whole, tmp_path):
    spec, out = write_spec(tmp_path, SMALL), tmp_path / "job"
    assert interrupt(spec, out, signal.SIGTERM) == 3
    last = events(out)[-1]
    assert last["event"] == "checkpoint"
    assert run(spec, out, "--attempt", 2)[0] == 0
    assert events(out, "start")[1]["step"] == last["step"]
    expect_as_if_never_interrupted(out, whole[0])


OUTSIDE = (set(range(1, 32)) | set(range(signal.SIGRTMIN, signal.SIGRTMAX + 1))) - {
    signal.SIGKILL, signal.SIGSTOP, signal.SIGTSTP, signal.SIGTTIN, signal.SIGTTOU,  # end or stop whatever we do
    signal.SIGABRT, signal.SIGBUS, signal.SIGFPE, signal.SIGILL, signal.SIGSEGV, signal.SIGSYS, signal.SIGTRAP}  # faults of its own
HARMLESS = {signal.SIGCHLD, signal.SIGCONT, signal.SIGURG, signal.SIGWINCH, signal.SIGPIPE, signal.SIGXFSZ}


def test_no_signal_from_outside_ends_a_run_without_a_checkpoint(tmp_path):
    endless = small(duration={"seconds": 2000.0}, snapshots={"interval": 0})
    spec = write_spec(tmp_path, endless)
    for number in sorted(OUTSIDE - HARMLESS)[:13] + [signal.SIGRTMIN, signal.SIGRTMAX]:
        worker = start(spec, tmp_path / str(int(number)), "--checkpoint-seconds", 3600,
                       preexec_fn=lambda: signal.signal(number, signal.SIG_DFL))  # also where a shell ignores it
        wait_until(lambda: events(tmp_path / str(int(number)), "start"))
        for harmless in HARMLESS:
            worker.send_signal(harmless)
        worker.send_signal(number)
        worker.communicate(timeout=60)
        assert worker.returncode == 3, number
        assert events(tmp_path / str(int(number)))[-1]["event"] == "checkpoint", number


def test_a_signal_that_is_ignored_stays_ignored(tmp_path):
    spec = write_spec(tmp_path, small(duration={"seconds": 0.05}))
    worker = start(spec, tmp_path / "job", preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))
    wait_until(lambda: events(tmp_path / "job", "start"))
    worker.send_signal(signal.SIGHUP)
    worker.communicate(timeout=60)
    assert worker.returncode == 0


def test_sigterm_while_the_bed_settles_is_no_loss_either(whole, tmp_path):
    spec, out = write_spec(tmp_path, SMALL), tmp_path / "job"
    worker = start(spec, out, "--checkpoint-seconds", 0)
    wait_until(lambda: events(out, "checkpoint"))
    worker.terminate()
    worker.communicate(timeout=20)
    assert worker.returncode == 3 and events(out)[-1]["time"] < 0
    assert run(spec, out)[0] == 0
    expect_as_if_never_interrupted(out, whole[0])


def limit_files_to(size):
    """What a full disk looks like to a worker: a write that fails. (The signal is ignored by the worker.)"""
    return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))


def test_a_full_disk_ends_with_5_and_leaves_no_half_file(whole, tmp_path):
    spec, out = write_spec(tmp_path, SMALL), tmp_path / "job"
    smallest = min(path.stat().st_size for path in (whole[0] / "snapshots").glob("*.hdf"))
    code, _, stderr = run(spec, out, "--checkpoint-seconds", 3600, preexec_fn=limit_files_to(smallest // 2))
    assert code == 5
    assert "can't write snapshots/000000.hdf" in stderr
    assert events(out, "failure")[0]["status"] == "disk"
    assert not list(out.rglob("*.hdf")) and not list(out.rglob("*.tmp")) and not (out / "result.json").exists()
    assert run(spec, out, "--attempt", 2)[0] == 0
    expect_as_if_never_interrupted(out, whole[0])


def test_a_disk_that_fills_up_leaves_the_checkpoint_of_before(whole, tmp_path):
    spec, out = write_spec(tmp_path, SMALL), tmp_path / "job"
    assert interrupt(spec, out, signal.SIGTERM) == 3
    before = (out / "checkpoint.hdf").read_bytes()
    code, _, _ = run(spec, out, "--attempt", 2, "--checkpoint-seconds", 0,
                     preexec_fn=limit_files_to(len(before) // 2))
    assert code == 5
    assert (out / "checkpoint.hdf").read_bytes() == before
    assert run(spec, out, "--attempt", 3)[0] == 0
    expect_as_if_never_interrupted(out, whole[0])


def test_a_damaged_checkpoint_is_not_believed(whole, tmp_path):
    spec, out = write_spec(tmp_path, SMALL), tmp_path / "job"
    assert interrupt(spec, out, signal.SIGTERM) == 3
    content = (out / "checkpoint.hdf").read_bytes()
    (out / "checkpoint.hdf").write_bytes(content[:len(content) // 2])
    code, _, stderr = run(spec, out, "--attempt", 2)
    assert code == 0 and "starting anew" in stderr
    expect_as_if_never_interrupted(out, whole[0])


def test_a_line_that_was_cut_by_a_crash_is_removed(tmp_path):
    spec, out = write_spec(tmp_path, small(duration={"seconds": 0.02})), tmp_path / "job"
    assert run(spec, out)[0] == 0
    (out / "result.json").unlink()
    with open(out / "events.ndjson", "a") as log:
        log.write('{"event":"sample","num')
    (out / "snapshots" / "000001.hdf.tmp").write_text("half")
    assert run(spec, out, "--attempt", 2)[0] == 0
    assert len(events(out, "start")) == 2  # every line was read as JSON
    assert not list(out.rglob("*.tmp"))


def test_two_workers_do_not_write_in_one_folder(tmp_path):
    spec, out = write_spec(tmp_path, small(duration={"revolutions": 1000}, snapshots={"interval": 0})), tmp_path / "job"
    first = start(spec, out)
    try:
        wait_until(lambda: events(out, "start"))
        code, _, stderr = run(spec, out)
        assert code == 5 and "another worker is at work" in stderr
        assert first.poll() is None
    finally:
        first.kill()
        first.communicate()


def test_a_complete_run_is_not_run_again(whole):
    out = whole[0]
    before = (out / "events.ndjson").read_bytes(), (out / "result.json").read_bytes()
    code, stdout, _ = run(out / "spec.json", out, "--json")
    assert code == 0 and json.loads(stdout) == json.loads(before[1])
    assert (out / "events.ndjson").read_bytes() == before[0]


def test_results_of_another_spec_are_never_overwritten(tmp_path):
    long, short = small(duration={"seconds": 0.35}), small(duration={"seconds": 0.02})
    out = tmp_path / "job"
    assert run(write_spec(tmp_path, long), out)[0] == 0
    result = (out / "result.json").read_bytes()
    code, _, said = run(write_spec(tmp_path, short), out)
    assert code == 2 and "results of another spec" in said
    assert (out / "result.json").read_bytes() == result and len(snapshot_bytes(out)) == 2 * 5  # each with its frame


def test_another_spec_leaves_nothing_of_an_unfinished_run(tmp_path):
    long, short = small(duration={"seconds": 0.35}), small(duration={"seconds": 0.02})
    out = tmp_path / "job"
    assert run(write_spec(tmp_path, long), out)[0] == 0
    (out / "result.json").unlink()
    assert run(write_spec(tmp_path, short), out)[0] == 0
    assert len(snapshot_bytes(out)) == 2 * 2
    assert len(events(out, "start")) == 1
    assert json.loads((out / "spec.json").read_text())["inputs"]["duration"] == {"seconds": 0.02}


def test_a_spec_without_a_seed_is_the_same_run_in_the_same_folder(tmp_path):
    spec = small(duration={"seconds": 0.02})
    del spec["inputs"]["seed"]
    path, out = write_spec(tmp_path, spec), tmp_path / "job"
    assert run(path, out)[0] == 0
    seed, result = json.loads((out / "spec.json").read_text())["inputs"]["seed"], (out / "result.json").read_bytes()
    assert run(path, out)[0] == 0 and (out / "result.json").read_bytes() == result
    (out / "result.json").unlink()
    assert run(path, out)[0] == 0
    assert json.loads((out / "spec.json").read_text())["inputs"]["seed"] == seed


# --- runs that fail

def test_particles_that_do_not_fit_are_a_bad_spec(tmp_path):
    # The lining takes a quarter of the diameter away from a drum that is nearly full: that is told before anything is run.
    spec = small(drum={"length": 0.012}, fill_fraction=0.95, wall={"lining": {"diameter": 0.00375}})
    code, stdout, stderr = run(write_spec(tmp_path, spec), tmp_path / "job")
    assert code == 2 and "/inputs/fill_fraction" in stdout + stderr and "at most" in stdout + stderr, stdout + stderr
    assert not (tmp_path / "job" / "result.json").exists()


def test_too_little_memory_is_said_so(tmp_path):
    spec = small(drum={"diameter": 1.0, "length": 0.1}, particles=[{"diameter": 0.003}], particle_count=2000000,
                 duration={"seconds": 0.01})
    spec["inputs"]["snapshots"]["interval"] = 0
    limit = lambda: resource.setrlimit(resource.RLIMIT_AS, (200_000_000, 200_000_000))
    code, _, stderr = run(write_spec(tmp_path, spec), tmp_path / "job", preexec_fn=limit)
    assert code == 6, stderr
    assert events(tmp_path / "job", "failure")[0]["status"] == "no-memory"


def test_what_a_checkpoint_takes_is_estimated(tmp_path):
    """Most of this one are the sums of its fields' 120 x 120 cells, since few particles lie in a wide drum."""
    spec = {"inputs": {"drum": {"diameter": 0.12, "length": 0.006, "rotation_rate": 1}, "particles": [{"diameter": 0.002}],
                       "fill_fraction": 0.1, "contact": {"maximum_overlap": 0.05}, "duration": {"seconds": 0.1}}}
    estimated = json.loads(check(json.dumps(spec))[1])["estimate"]["checkpoint_bytes"]
    code, _, stderr = run(write_spec(tmp_path, spec), tmp_path / "job", "--checkpoint-seconds", 0)
    assert code == 0, stderr
    assert (tmp_path / "job" / "checkpoint.hdf").stat().st_size == pytest.approx(estimated, rel=0.2)
