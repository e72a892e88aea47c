"""Files whose bytes are not those that were written: refused wherever the damage is, and the run ends as if it had never
happened. And files that somebody made to do harm."""
import itertools
import json
import math
import random
import shutil
import signal

import conftest
import h5py
import numpy
import pytest
import worker_runs as worker

POLYNOMIAL = 0xC96C5795D7870F42
CELL_SUMS = 17  # numbers of a cell in a checkpoint


def crc64(content):
    """By bits, as ECMA-182 defines it."""
    rest = 2**64 - 1
    for byte in content:
        rest ^= byte
        for _ in range(8):
            rest = (rest >> 1) ^ (POLYNOMIAL if rest & 1 else 0)
    return rest ^ (2**64 - 1)


def line_of(content):
    return b"crc64 %016x\n" % crc64(content)


def seal(path):
    """As a run would have ended it: whoever makes a file to do harm can do that, too."""
    path.write_bytes(path.read_bytes() + line_of(path.read_bytes()))


def events(folder, kind):
    return worker.events(folder, kind)


SPEC = worker.small(duration={"seconds": 0.3}, snapshots={"interval": 0.05})


@pytest.fixture(scope="module")
def stopped(tmp_path_factory):
    """A run that was stopped between two snapshots, with both its checkpoints; and the same run whole."""
    folder = tmp_path_factory.mktemp("stopped")
    spec = worker.write_spec(folder, SPEC)
    assert worker.run(spec, folder / "whole")[0] == 0
    process = worker.start(spec, folder / "job", "--checkpoint-seconds", 0)
    worker.wait_until(lambda: len(events(folder / "job", "snapshot")) > 2)
    process.send_signal(signal.SIGTERM)
    process.communicate(timeout=60)
    assert process.returncode == 3
    return folder


def damages(content, count, seed=1):
    """Copies of it: a bit flipped, a piece zeroed, cut, pieces exchanged, bytes put in; the first and last bytes are never
    left out."""
    chance = random.Random(seed)
    places = itertools.chain((0, 8, len(content) - 1, len(content) - 24, len(content) - 25),
                             (chance.randrange(len(content)) for _ in itertools.count()))
    for number, at in zip(range(count), places):
        bad = bytearray(content)
        kind = number % 5
        if kind == 0:
            bad[at] ^= 1 << chance.randrange(8)
        elif kind == 1:
            bad[at:at + 512] = bytes(len(bad[at:at + 512]))
        elif kind == 2:
            del bad[at:]
        elif kind == 3:
            other = chance.randrange(len(content))
            bad[at:at + 8], bad[other:other + 8] = bad[other:other + 8], bad[at:at + 8]
        else:
            bad[at:at] = b"\0" * 7
        if bytes(bad) != content:
            yield bytes(bad)


def resumed_step(folder):
    return events(folder, "start")[-1]["step"]


def go_on_with(stopped, folder, newest=None, before=None):
    """The stopped run with other bytes in its checkpoints: returns where it went on and what it said."""
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(stopped / "job", folder)
    for name, content in (("checkpoint.hdf", newest), ("checkpoint.before.hdf", before)):
        if content is not None:
            (folder / name).write_bytes(content)
    code, _, said = worker.run(stopped / "request.json", folder)
    assert code == 0, said
    return resumed_step(folder), said


def test_a_damaged_checkpoint_gives_way_to_the_one_before_and_then_to_a_new_beginning(stopped, tmp_path):
    content = {name: (stopped / "job" / name).read_bytes() for name in ("checkpoint.hdf", "checkpoint.before.hdf")}
    steps = [event["step"] for event in events(stopped / "job", "checkpoint")]
    bad = next(damages(content["checkpoint.hdf"], 1))
    for newest, before, expected in ((None, None, steps[-1]), (bad, None, steps[-2]), (bad, bad, 0)):
        step, said = go_on_with(stopped, tmp_path / "job", newest, before)
        assert step == expected and ("damaged" in said) == (newest is not None), said
        assert worker.timeless_result(tmp_path / "job") == worker.timeless_result(stopped / "whole")
        assert worker.samples(tmp_path / "job") == worker.samples(stopped / "whole")
        assert worker.snapshot_bytes(tmp_path / "job") == worker.snapshot_bytes(stopped / "whole")
    assert not (tmp_path / "job" / "checkpoint.before.hdf").exists()  # the result is there: it serves nobody any more


def refused_beds(folder, contents):
    """How many of these contents of a file to start from are refused."""
    spec = worker.write_spec(folder, worker.small(duration={"seconds": 0.001}, start={"file": "bed.hdf"}))
    refused = 0
    for content in contents:
        (folder / "bed.hdf").write_bytes(content)
        code, out, said = worker.run(spec, folder / "out", cwd=folder)
        assert code in (0, 2), said
        refused += code == 2 and "is damaged" in out
    return refused


@pytest.mark.parametrize("name", ["checkpoint.hdf", "snapshots/000000.hdf"])
def test_a_damaged_bed_to_start_from_is_refused(stopped, tmp_path, name):
    content = (stopped / "job" / name).read_bytes()
    assert content.endswith(line_of(content[:-23]))
    bad = list(damages(content, 15))
    assert refused_beds(tmp_path, bad) == len(bad)
    assert refused_beds(tmp_path, [content]) == 0


@pytest.mark.torture
@pytest.mark.parametrize("name", ["checkpoint.hdf", "snapshots/000000.hdf"])
def test_hundreds_of_damages_are_all_found(stopped, tmp_path, name):
    bad = list(damages((stopped / "job" / name).read_bytes(), 400, seed=2))
    assert refused_beds(tmp_path, bad) == len(bad)
    if name == "checkpoint.hdf":
        for content in bad[::10]:
            assert go_on_with(stopped, tmp_path / "job", content, content)[0] == 0
            assert worker.timeless_result(tmp_path / "job") == worker.timeless_result(stopped / "whole")


def test_a_damaged_result_or_spec_is_made_anew(stopped, tmp_path):
    whole = worker.timeless_result(stopped / "whole")
    text = (stopped / "whole" / "result.json").read_bytes()
    made_from = (stopped / "whole" / "spec.json").read_bytes()
    assert (stopped / "whole" / "result.json.sum").read_bytes() == line_of(text) + line_of(text + made_from)
    digit = text.index(b'"angle_deg": ') + len(b'"angle_deg": ')
    flipped = text[:digit] + (b"8" if text[digit:digit + 1] != b"8" else b"9") + text[digit + 1:]
    for bad in (flipped, text[:-20], bytes(len(text)), b"[1]"):
        shutil.rmtree(tmp_path / "job", ignore_errors=True)
        shutil.copytree(stopped / "whole", tmp_path / "job")
        (tmp_path / "job" / "result.json").write_bytes(bad)
        code, _, said = worker.run(stopped / "request.json", tmp_path / "job")
        assert code == 0 and "result.json is damaged" in said
        assert worker.timeless_result(tmp_path / "job") == whole
        assert events(tmp_path / "job", "start")[-1]["resumed"]  # from the checkpoint of the end
    spec = (tmp_path / "job" / "spec.json").read_bytes()
    (tmp_path / "job" / "spec.json").write_bytes(spec.replace(b'"seed": 7', b'"seed": 8'))
    (tmp_path / "job" / "result.json").unlink()
    code, _, said = worker.run(stopped / "request.json", tmp_path / "job")
    assert code == 0 and events(tmp_path / "job", "start")[-1]["resumed"], said
    assert (tmp_path / "job" / "spec.json").read_bytes() == spec and worker.timeless_result(tmp_path / "job") == whole


def test_the_result_of_another_spec_of_the_same_seed_is_not_taken_for_this_ones(stopped, tmp_path):
    """Whether its checksums came along or not; the spec's own results are the oracle."""
    whole = worker.timeless_result(stopped / "whole")
    other = worker.small(contact={"friction": 0.1})
    assert worker.run(worker.write_spec(tmp_path, other), tmp_path / "other")[0] == 0
    for names in (["result.json"], ["result.json", "result.json.sum"]):
        shutil.rmtree(tmp_path / "job", ignore_errors=True)
        shutil.copytree(stopped / "whole", tmp_path / "job")
        (tmp_path / "job" / "result.json.sum").unlink()
        for name in names:
            shutil.copy(tmp_path / "other" / name, tmp_path / "job")
        assert worker.timeless_result(tmp_path / "job") != whole
        assert worker.run(stopped / "request.json", tmp_path / "job")[0] == 0
        assert worker.timeless_result(tmp_path / "job") == whole


# --- made to do harm

def harmful(path, change):
    """A sound checkpoint that `change` works on, sealed as a run would."""
    content = path.read_bytes()
    path.write_bytes(content[:-23])
    with h5py.File(path, "r+") as file:
        change(file)
    seal(path)


def many_texts(file):
    text = file["run"].attrs["params_json"]
    text = text if isinstance(text, bytes) else text.encode()
    del file["run"].attrs["params_json"]
    file["run"].attrs.create("params_json", numpy.full(60, text[:1000], dtype="S1000"))


def text_of_any_length(file):
    del file["run"].attrs["params_json"]
    file["run"].attrs["params_json"] = "{}"


def many_arrays(file):
    del file["state"].attrs["arrays"]
    file["state"].attrs["arrays"] = numpy.arange(1000)


def in_place_of(name, **how):
    def change(file):
        kept = dict(file[name].attrs)
        del file[name]
        made = file.create_dataset(name, **how)
        for key, value in kept.items():
            made.attrs[key] = value
    return change


def elsewhere(file):
    del file["state/3"]
    file["state/3"] = h5py.ExternalLink("/etc/passwd", "/")


def round_about(file):
    del file["state/3"]
    file["state/3"] = h5py.SoftLink("/state/4")


HARM = {
    "a text of many": many_texts, "a text of any length": text_of_any_length, "a number of many": many_arrays,
    "an extent that no file holds": in_place_of("state/3", shape=(2**61, 8), dtype="f8", chunks=(1, 8)),
    "an extent beyond 64 bits": in_place_of("state/3", shape=(2**33, 2**32), dtype="f8", chunks=(1, 8)),
    "a chunk of gigabytes": in_place_of("state/3", shape=(4, 3), maxshape=(None, None), dtype="f8", chunks=(2**14, 2**14)),
    "texts": in_place_of("state/3", shape=(4, 3), dtype="S9"),
    "three dimensions": in_place_of("state/3", shape=(4, 3, 2), dtype="f8"),
    "no dimension": in_place_of("state/3", shape=(), dtype="f8"), "wide numbers": in_place_of("state/3", shape=(4, 3), dtype="c16"),
    "frames without end": in_place_of("frames", shape=(2**40, 2**30), dtype="f8", chunks=(1, 8)),
    "a link to another file": elsewhere, "a link to a neighbor": round_about,
}


@pytest.mark.parametrize("harm", HARM)
def test_a_file_made_to_do_harm_is_refused(stopped, tmp_path, harm):
    shutil.copytree(stopped / "job", tmp_path / "job")
    (tmp_path / "job" / "checkpoint.before.hdf").unlink()
    harmful(tmp_path / "job" / "checkpoint.hdf", HARM[harm])
    shutil.copy(tmp_path / "job" / "checkpoint.hdf", tmp_path / "bed.hdf")
    code, _, said = worker.run(stopped / "request.json", tmp_path / "job")
    assert code == 0 and resumed_step(tmp_path / "job") == 0, said
    spec = worker.small(duration={"seconds": 0.01}, start={"file": "bed.hdf"})
    code, _, said = worker.run(worker.write_spec(tmp_path, spec), tmp_path / "started", cwd=tmp_path)
    assert code in (1, 2) or harm == "frames without end" and code == 0, said  # a bed has no frames


def of_other_cells(file):
    """Sums of the fields as a program with cells of another width kept them: a sound number of rows, and no damage."""
    name = next(f"state/{k}" for k, array in file["state"].items() if array.attrs["name"] in (b"tally", "tally"))
    cells = math.isqrt(file[name].size // CELL_SUMS)
    assert file[name].size == 1 + cells**2 * CELL_SUMS
    in_place_of(name, data=numpy.ones((1 + (cells // 2)**2 * CELL_SUMS, 1)))(file)


def test_a_checkpoint_with_fields_of_other_cells_is_refused_for_going_on_and_good_as_a_bed(stopped, tmp_path):
    shutil.copytree(stopped / "job", tmp_path / "job")
    (tmp_path / "job" / "checkpoint.before.hdf").unlink()
    harmful(tmp_path / "job" / "checkpoint.hdf", of_other_cells)
    shutil.copy(tmp_path / "job" / "checkpoint.hdf", tmp_path / "bed.hdf")
    code, _, said = worker.run(stopped / "request.json", tmp_path / "job")
    assert code == 0 and "checkpoint.hdf can't be used" in said and resumed_step(tmp_path / "job") == 0
    assert worker.timeless_result(tmp_path / "job") == worker.timeless_result(stopped / "whole")
    with h5py.File(stopped / "whole" / "fields.hdf") as whole, h5py.File(tmp_path / "job" / "fields.hdf") as again:
        for name in whole["fields"]:
            assert numpy.array_equal(whole["fields"][name], again["fields"][name], equal_nan=True)
    spec = worker.small(duration={"seconds": 0.05}, start={"file": "bed.hdf"})
    assert worker.run(worker.write_spec(tmp_path, spec), tmp_path / "started", cwd=tmp_path)[0] == 0


# --- under the daemon

@pytest.fixture
def damaging(tmp_path):
    """A daemon whose worker program damages what `repose` has written, the first time."""
    program = tmp_path / "worker"
    program.write_text(f"""#!/bin/sh
[ "$1" = run ] || exit 0
cp "$2" "$4/spec.seen.$6"
"{worker.REPOSE}" "$@" || exit
[ "$6" = 1 ] && sed -i 's/"angle_deg": [-0-9.]*/"angle_deg": 89.0/' "$4/result.json"
exit 0
""")
    program.chmod(0o755)
    yield from conftest.run_daemon(tmp_path, worker=program, options=["--workers", "1"])


def test_the_daemon_takes_no_damaged_result_and_keeps_its_own_copy_of_the_specification(damaging):
    blocker = damaging.submit(SPEC["inputs"] | {"duration": {"seconds": 1.0}})
    job = damaging.submit(SPEC["inputs"])
    spec = damaging.data / "jobs" / job / "spec.json"
    text = damaging.get(f"/jobs/{job}/spec").content
    spec.parent.mkdir()  # while it waits
    spec.write_bytes(text.replace(b'"friction": 0.3', b'"friction": 0.7'))
    damaging.ended(blocker)
    info = damaging.ended(job, 120)
    assert info["status"] == "successful" and info["attempt"] == 2
    assert json.loads(spec.read_bytes()) == json.loads(text) and spec.read_bytes() == spec.with_name("spec.seen.1").read_bytes()
    kept = json.loads(spec.with_name("result.json").read_text())
    answer = damaging.get(f"/jobs/{job}/results").json()
    assert answer == kept and answer["repose"]["angle_deg"] != 89.0
