"""A study without a service: written as folders, run by a shell, and collected."""
import json
import sqlite3
import subprocess

from conftest import BUILD, SPEC

STUDY = {"name": "two commands", "base": {"inputs": SPEC | {"duration": {"seconds": 0.02}}},
         "vary": {"/inputs/contact/friction": [0.1, 0.5]}, "repeats": 2}


def repose(*arguments):
    return subprocess.run([BUILD / "repose", *arguments], capture_output=True, text=True, timeout=100)


def test_a_study_is_split_run_by_tasks_and_collected_with_what_each_came_to(tmp_path):
    (tmp_path / "study.json").write_text(json.dumps(STUDY))
    split = tmp_path / "it's here"
    done = repose("split", tmp_path / "study.json", "--out", split)
    assert done.returncode == 0, done.stderr
    assert "--array=1-4 " in (split / "job.sbatch").read_text()
    for task in ("1", "2", "4"):
        subprocess.run(["sh", split / "job.sbatch"], env={"TASK": task, "PATH": "/usr/bin:/bin"}, check=True, timeout=100)
    done = repose("collect", split)
    assert done.returncode == 0 and done.stdout.startswith("3 of 4 jobs have results, 0 failed"), done.stderr
    angles = {number: json.loads((split / "jobs" / number / "result.json").read_text())["repose"]["angle_deg"]
              for number in ("000001", "000002", "000004")}
    with sqlite3.connect(split / "reposed.sqlite") as database:
        assert dict(database.execute("select id, angle_deg from run_summary")) == angles
        assert database.execute("select id from job where status='accepted'").fetchall() == [("000003",)]
    head, *rows = [line.split(",") for line in (split / "results.csv").read_text().splitlines()]
    assert [row[head.index("finished")] for row in rows] == ["2", "1"]
    # Results are not written over.
    assert repose("split", tmp_path / "study.json", "--out", split).returncode == 5
