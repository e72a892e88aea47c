"""What README.md tells a reader to paste can be pasted: every block and every piece of JSON in it is tried."""
import json
import os
import re
import subprocess
from pathlib import Path

import pytest
import requests
from conftest import BUILD, SPEC, Daemon

ROOT = Path(__file__).resolve().parents[2]
TEXT = (ROOT / "README.md").read_text()
BLOCKS = re.findall(r"^```(\w*)\n(.*?)^```$", TEXT, re.DOTALL | re.MULTILINE)
PROSE = re.sub(r"^```.*?^```$", "", TEXT, flags=re.DOTALL | re.MULTILINE)
EXAMPLE_JOB = "20261122-014455-3f9a2c71"
DRUM = 4  # the block with every input of a drum


def blocks_of(language):
    return [text for kind, text in BLOCKS if kind == language]


def pieces_of_inputs():
    """Code in the prose that shows members of inputs: `"contact": {...}`."""
    return [code for code in re.findall(r"`([^`\n]+)`", PROSE) if re.match(r'^"\w+": *[\d{]', code)]


def commands():
    lines = "".join(blocks_of("sh")).replace("\\\n", " ")
    return [line.strip() for line in re.split(r"\n(?=curl|make|build/)", lines) if line.strip()]


def merged(base, patch):
    """RFC 7396, but nothing is removed."""
    if not isinstance(patch, dict) or not isinstance(base, dict):
        return patch
    return base | {name: merged(base.get(name), value) for name, value in patch.items()}



@pytest.fixture(scope="module")
def service(tmp_path_factory):
    daemon = Daemon(tmp_path_factory.mktemp("readme")).start()
    daemon.first = daemon.submit(SPEC)
    assert daemon.ended(daemon.first)["status"] == "successful"
    yield daemon
    daemon.stop(9)


def submit(service, body):
    answer = requests.post(f"{service.url}/processes/{body['process']}/execution", json=body, timeout=30)
    assert answer.status_code == 201, f"{json.dumps(body)}: {answer.text}"
    requests.delete(f"{service.url}/jobs/{answer.json()['jobID']}", timeout=30)


def test_every_block_says_what_it_is():
    assert {kind for kind, _ in BLOCKS} == {"sh", "json"}


@pytest.mark.parametrize("block", blocks_of("json"))
def test_blocks_of_json_are_accepted_as_they_stand(service, block):
    submit(service, json.loads(block))


@pytest.mark.parametrize("block", blocks_of("json"))
def test_blocks_of_json_are_taken_as_files(tmp_path, block):
    (tmp_path / "spec.json").write_text(block)
    check = subprocess.run([BUILD / "repose", "check", tmp_path / "spec.json"], capture_output=True, text=True, timeout=60)
    assert check.returncode == 0, check.stderr


def the_example_with(piece, first):
    """The README's drum with what stands in place of one of its members; what starts from a job needs that job's drum."""
    start = piece.get("start", {})
    if start.get("job") == EXAMPLE_JOB:
        return merged(SPEC, piece | {"start": start | {"job": first}})
    inputs = json.loads(blocks_of("json")[DRUM])["inputs"]
    replaced = {"particle_count": (inputs, "fill_fraction"), "duration": (inputs, "duration"), "start": (inputs, "fill_fraction"),
                "stiffness": (inputs["contact"], "maximum_overlap"), "youngs_modulus": (inputs["contact"], "maximum_overlap")}
    for name in [*piece, *piece.get("contact", {})]:
        if name in replaced:
            members, old = replaced[name]
            members.pop(old)
    if "start" in piece:
        inputs["particles"][0].pop("share")
    if "end_friction" in piece.get("wall", {}):
        inputs["drum"]["ends"] = "walls"
    return merged(inputs, piece)


TWO_PARTICLES = "x,y,z\n0,-0.01,0.004\n0.005,-0.01,0.004\n"


@pytest.mark.parametrize("code", pieces_of_inputs())
def test_members_of_inputs_in_the_prose_are_accepted(service, tmp_path, code):
    piece = json.loads("{" + code + "}")
    if "file" in piece.get("start", {}):
        checkpoint = service.data / "jobs" / service.first / "checkpoint.hdf"
        (tmp_path / "first").mkdir()
        (tmp_path / "first/checkpoint.hdf").write_bytes(checkpoint.read_bytes())
        (tmp_path / "bed.csv").write_text(TWO_PARTICLES)
        inputs = merged(SPEC, piece)
        if piece["start"]["file"].endswith(".csv"):
            inputs.pop("fill_fraction")  # the table says how many there are
        (tmp_path / "spec.json").write_text(json.dumps({"inputs": inputs}))
        check = subprocess.run([BUILD.resolve() / "repose", "check", "spec.json"], cwd=tmp_path, capture_output=True, text=True, timeout=60)
        assert check.returncode == 0, check.stderr
    elif "plate" in piece:
        submit(service, {"process": "heap", "inputs": merged(json.loads((ROOT / "api/examples/heap.json").read_text())["inputs"], piece)})
    else:
        if "bed" in piece.get("start", {}):
            sent = requests.post(f"{service.url}/beds", data=TWO_PARTICLES, headers={"Content-Type": "text/csv"}, timeout=30)
            piece["start"]["bed"] = sent.json()["bedID"]
        around = {name: piece.pop(name) for name in ("label", "priority") if name in piece}  # of the request, not of its inputs
        submit(service, {"process": "drum", "inputs": the_example_with(piece, service.first)} | around)


def test_commands_do_what_they_say(service, tmp_path):
    """Each on the daemon here, with a job, a study and a calibration that there are. Of make, the targets are there."""
    study = requests.post(f"{service.url}/studies", timeout=30, json={
        "name": "two", "base": {"inputs": SPEC}, "cases": [{"name": "one", "inputs": {}}]}).json()["studyID"]
    calibration = requests.post(f"{service.url}/calibrations", timeout=30, json={
        "base": {"process": "granule", "inputs": {"friction": 0.4}}, "parameters": {"/inputs/friction": {"range": [0.2, 0.6]}},
        "targets": [{"result": "/granule/minimum_rotation_rate", "value": 20.0, "standard_error": 0.5}]}).json()["calibrationID"]
    targets = re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(), re.MULTILINE)
    seen = 0
    for command in commands():
        command = re.sub(r"\s+#[^'\"]*$", "", command)
        if command.startswith("make "):
            assert command.split()[1] in targets, command
            continue
        command = command.replace("http://127.0.0.1:8080", service.url).replace("build/repose", str(BUILD / "repose"))
        command = command.replace("/calibrations/ID", f"/calibrations/{calibration}")
        command = command.replace("/studies/ID", f"/studies/{study}").replace("/jobs/ID", f"/jobs/{service.first}")
        command = command.replace("wait=60", "wait=0").replace("--out first", f"--out {tmp_path}/first")
        if " run " in command:  # the demo's drum takes half a minute: that it can be read is seen above
            continue
        done = subprocess.run(["bash", "-c", 'curl() { command curl -sS --fail-with-body "$@"; }; ' + command], cwd=ROOT,
                              capture_output=True, text=True, timeout=60, env=os.environ | {"HOME": str(tmp_path)})
        assert done.returncode == 0, f"{command}\n{done.stdout}{done.stderr}"
        seen += 1
    assert seen >= 9
