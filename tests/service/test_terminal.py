"""The service for those who have a terminal and no curl."""
import json
import subprocess

import pytest
from conftest import BUILD, FAKE_WORKER, SPEC, Daemon, run_daemon

TOKEN = "0123456789abcdef0123456789abcdef"


def reposed(daemon, command, *words, **options):
    port = ["--port", str(daemon.port)] if daemon else []
    return subprocess.run([BUILD / "reposed", command, *map(str, words), *port], capture_output=True, text=True, timeout=90, **options)


def spec_file(tmp_path, name="job.json", **document):
    file = tmp_path / name
    file.write_text(json.dumps({"process": "drum", "inputs": SPEC} | document))
    return file


def test_a_job_is_submitted_awaited_listed_and_shown(fake, tmp_path):
    done = reposed(fake, "submit", spec_file(tmp_path, label={"angle": 17, "fake": "slow", "seconds": "1"}), "--wait")
    assert done.returncode == 0, done.stderr
    job, *lines = done.stdout.splitlines()
    told = dict(line.split(maxsplit=1) for line in lines)
    assert fake.job(job)["status"] == told["status"] == "successful" and told["jobID"] == job
    listed = reposed(fake, "jobs").stdout.splitlines()
    assert len(listed) == 1 and listed[0].split()[:5] == [job, "drum", "successful", "100", "%"]
    assert json.loads(reposed(fake, "jobs", "--json").stdout)["jobs"][0]["jobID"] == job
    shown = reposed(fake, "show", job).stdout
    results = json.loads(shown[shown.index("{\n"):])
    assert results["repose"] == fake.get(f"/jobs/{job}/results").json()["repose"] and "message " in shown
    assert json.loads(reposed(fake, "show", job, "--json").stdout)["label"]["angle"] == 17


def test_what_comes_of_it_is_the_exit_status(fake, tmp_path):
    failed = reposed(fake, "submit", spec_file(tmp_path, label={"fake": "fault"}), "--wait")
    assert failed.returncode == 1 and "failed" in failed.stdout
    queued = reposed(fake, "submit", "-", input=spec_file(tmp_path).read_text())
    assert queued.returncode == 0 and fake.ended(queued.stdout.strip())["status"] == "successful"
    study = tmp_path / "study.json"
    study.write_text(json.dumps({"name": "two", "base": {"inputs": SPEC}, "repeats": 2}))
    done = reposed(fake, "submit", study, "--wait")
    assert done.returncode == 0 and fake.get(f"/studies/{done.stdout.split()[0]}").json()["status"] == "successful", done.stdout


def test_what_is_refused_is_told_member_by_member(fake, tmp_path):
    wrong = reposed(fake, "submit", spec_file(tmp_path, inputs=SPEC | {"fill_fraction": 2, "seed": -1}))
    assert wrong.returncode == 2 and "/inputs/fill_fraction is 2" in wrong.stderr and "/inputs/seed" in wrong.stderr and wrong.stdout == ""
    (tmp_path / "text").write_text('{"process": "drum",\n "inputs"}')
    assert "line 2" in reposed(fake, "submit", tmp_path / "text").stderr
    assert "No such file" in reposed(fake, "submit", tmp_path / "nothing").stderr
    assert reposed(fake, "submit", spec_file(tmp_path, process="x\r\nX-Evil: 1")).returncode == 2
    missing = reposed(fake, "show", "20200101-000000-00000000")
    assert missing.returncode == 2 and "404 No such job" in missing.stderr
    assert reposed(fake, "show", "../metrics").returncode == 2
    assert reposed(fake, "show").returncode == 2


def test_what_others_wrote_does_not_reach_the_terminal_as_it_is(fake):
    job = fake.submit(note="\x1b[2J\u202e")
    fake.ended(job)
    shown = reposed(fake, "show", job).stdout
    assert "\x1b" not in shown and "[2J" in shown


def test_a_token_is_sent_and_no_service_is_said_to_be_none(tmp_path):
    token = tmp_path / "token"
    token.write_text(TOKEN + "\n")
    token.chmod(0o600)
    daemon = Daemon(tmp_path, worker=FAKE_WORKER, options=["--token-file", str(token)]).start()
    assert reposed(daemon, "jobs").returncode == 2
    assert reposed(daemon, "jobs", "--token-file", token).returncode == 0
    assert reposed(daemon, "submit", spec_file(tmp_path), "--token-file", token).returncode == 0
    daemon.stop()
    gone = reposed(daemon, "jobs")
    assert gone.returncode == 1 and f"port {daemon.port}: Connection refused" in gone.stderr
