"""What whoever follows a run sees."""
import itertools
import json
import re
import subprocess

from conftest import BUILD, SPEC


def test_a_log_tells_each_tenth_and_a_pipe_gets_the_answer(tmp_path):
    spec = tmp_path / "spec.json"
    drum = SPEC["drum"] | {"length": 0.008}
    spec.write_text(json.dumps({"process": "drum", "inputs": SPEC | {"drum": drum, "particles": [{"diameter": 0.001}]}}))
    done = subprocess.run([BUILD / "repose", "run", spec, "--out", tmp_path / "out"], capture_output=True, text=True, timeout=300)
    assert done.returncode == 0
    tenths = [int(number) for number in re.findall(r"(\d+) % done at step \d+, about [\d.]+ \w+ left", done.stderr)]
    # a report a second, of which those tell that another tenth is done
    events = [json.loads(line) for line in (tmp_path / "out/events.ndjson").read_text().splitlines()]
    reported = [int(event["progress"] // 10) * 10 for event in events if "progress" in event]
    grown = [now for before, now in zip(itertools.accumulate([0, *reported], max), reported) if now > before]
    assert reported and tenths == grown, done.stderr
    assert len(done.stdout.splitlines()) >= 5 and "regime" in done.stdout and "\x1b" not in done.stdout + done.stderr
