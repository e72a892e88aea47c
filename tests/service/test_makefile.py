"""What make says and does for somebody who has just arrived."""
import os
import re
import shutil
import socket
import subprocess
from pathlib import Path

from conftest import BUILD

ROOT = Path(__file__).resolve().parents[2]


def make(*words, path=os.environ["PATH"]):
    plain = {name: value for name, value in os.environ.items() if not name.startswith("MAKE")}
    return subprocess.run([shutil.which("make"), "-C", ROOT, "--no-print-directory", *words], capture_output=True, text=True,
                          timeout=120, env=plain | {"PATH": str(path)})


def test_help_needs_no_package(tmp_path):
    for tool in ("sh", "grep", "sed", "expand", "nproc"):
        (tmp_path / tool).symlink_to(shutil.which(tool))
    answer = make("help", path=tmp_path)
    assert answer.returncode == 0 and answer.stderr == ""
    for target in ("demo", "serve", "test", "physics", "torture", "bench", "clean"):
        assert any(line.split()[0] == target for line in answer.stdout.splitlines()), answer.stdout


def test_every_target_that_documents_name_is_there_and_none_is_a_file():
    named = set()
    for document in ("README.md", "server/DESIGN.md", "core/NUMERICS.md", "core/SPEED.md"):
        text = (ROOT / document).read_text()
        named |= set(re.findall(r"(?:`|^)make ([a-z-]+)", text, re.M))
        named |= {word for line in re.findall(r"^`make help` lists the targets: (.*)", text, re.M)
                  for word in re.findall(r"`([a-z-]+)`", line)}
    listed = {line.split()[0] for line in make("help").stdout.splitlines()}
    assert len(named) > 8 and named <= listed, named - listed
    phony = re.search(r"^\.PHONY: (.*)$", make("-pn", "help").stdout, re.M)[1].split()
    assert listed <= set(phony)


def test_a_file_that_is_compiled_takes_one_line(tmp_path):
    target = f"{tmp_path}/api/http/routes.o"
    answer = make(f"BUILD={tmp_path}", target)
    assert answer.stdout.split() == ["compile", "api/http/routes.c"] and Path(target).exists(), answer.stdout + answer.stderr
    Path(target).unlink()
    assert " -c api/http/routes.c " in make(f"BUILD={tmp_path}", "V=1", target).stdout


def test_data_may_lie_in_a_folder_with_a_space_in_its_name():
    assert '--data "my data"' in make("-n", "serve", "DATA=my data").stdout


def test_whoever_finds_the_port_taken_is_told_a_way_out(tmp_path):
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()
        port = other.getsockname()[1]
        answer = subprocess.run([BUILD / "reposed", "serve", "--port", str(port), "--data", tmp_path / "data"],
                                capture_output=True, text=True, timeout=30)
    assert answer.returncode == 1
    assert f"port {port} can't be opened: Address already in use; --port N takes another" in answer.stderr
