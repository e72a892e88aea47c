"""What whoever follows a run sees."""
import json
import re
import subprocess

from conftest import BUILD, SPEC


def test_a_log_tells_each_tenth_and_a_pipe_gets_the_answer(tmp_path):
    spec = tmp_path / "spec.json"
    spec.write_text(json.dumps({"process": "drum", "inputs": SPEC | {"particles": [{"diameter": 0.001}]}}))
    done = subprocess.run([BUILD / "repose", "run", spec, "--out", tmp_path / "out"], capture_output=True, text=True, timeout=300)
    assert done.returncode == 0
    tenths = [int(number) for number in re.findall(r"(\d+) % done at step \d+, about [\d.]+ \w+ left", done.stderr)]
    assert tenths == sorted(set(tenths)) and all(number % 10 == 0 and 0 < number <= 100 for number in tenths), done.stderr
    seconds = json.loads((tmp_path / "out/result.json").read_text())["run"]["wall_seconds"]
    assert seconds > 1 and len(tenths) >= min(3, int(seconds))  # one report a second
    assert len(done.stdout.splitlines()) >= 5 and "regime" in done.stdout and "\x1b" not in done.stdout + done.stderr
