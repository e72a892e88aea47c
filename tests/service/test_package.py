"""What an administrator installs: files, package, service, file of options."""
import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest
import requests
from conftest import BUILD, FAKE_WORKER, ROOT, Daemon

PACKAGE = ROOT / "server/package"
PROGRAMS = ("reposed", "repose")
VARIANTS = [f"repose-{name}" for name in ("single-avx512", "single-avx2", "double-avx512", "double-avx2", "double-plain", "plan")]


def run(*words, **options):
    return subprocess.run([str(word) for word in words], capture_output=True, text=True, timeout=300, cwd=ROOT, **options)


def whole_build(folder):
    """The build, or where a variant was not built (which costs a minute each) an empty file in its place."""
    folder.mkdir()
    for name in (*PROGRAMS, *VARIANTS):
        if (BUILD / name).exists():
            shutil.copy2(BUILD / name, folder / name)
        else:
            (folder / name).write_text("")
    return folder


@pytest.fixture(scope="module")
def tree(tmp_path_factory):
    folder = tmp_path_factory.mktemp("installed")
    done = run("sh", PACKAGE / "install.sh", whole_build(folder / "build"), folder / "tree", "/opt/x")
    assert done.returncode == 0 and done.stdout + done.stderr == ""
    shutil.rmtree(folder / "build")
    return folder / "tree/opt/x"


def test_what_is_installed_serves_its_page_and_runs_its_example(tree, tmp_path):
    installed = Daemon(tmp_path)
    installed.program, installed.options = tree / "bin/reposed", []
    installed.start()
    try:
        page = installed.get("/", headers={"Accept": "text/html"})
        assert page.status_code == 200 and page.text == (ROOT / "web/index.html").read_text()
        script = re.search(r'src="(web/[a-z_]+\.js)"', page.text).group(1)
        assert installed.get(f"/{script}").text == (ROOT / script).read_text()
        assert installed.get("/api").status_code == 200
        example = (tree / "share/reposed/api/examples/granule.json").read_bytes()
        answer = requests.post(installed.url + "/processes/granule/execution", data=example,
                               headers={"Content-Type": "application/json"}, timeout=30)
        assert installed.ended(answer.json()["jobID"])["status"] == "successful"
    finally:
        installed.stop()


def test_both_programs_tell_the_commit_that_they_were_made_from():
    commit = run("git", "rev-parse", "HEAD").stdout.strip()
    for program in PROGRAMS:
        text = run(BUILD / program, "--version").stdout
        assert re.fullmatch(program + r" \d+\.\d+\.\d+( \(commit [0-9a-f]{7,}(-dirty)?\))?\n", text)
        if commit:
            assert "commit" in text


@pytest.mark.parametrize("program, page", [("reposed", "reposed.8"), ("repose", "repose.1")])
def test_the_manual_has_every_command_option_and_exit_status_and_no_other_option(program, page):
    names = r"--[a-z][a-z-]+"
    help_text = run(BUILD / program, "--help").stdout
    told = set(re.findall(names, help_text))
    manual = (PACKAGE / page).read_text().replace("\\", "")
    assert told - {"--help", "--version"} == set(re.findall(names, manual)) - {"--help", "--version"}
    commands = set(re.findall(rf"^ *{program} ([a-z]+)", help_text, re.M))
    assert len(commands) > 5 and commands == set(re.findall(rf"^\.B {program} ([a-z]+)$", manual.partition(".SH DESCRIPTION")[0], re.M))
    assert commands - {"serve"} <= set(re.findall(rf"^\.B {program} ([a-z]+)$", manual.partition(".SH DESCRIPTION")[2], re.M))
    ends = set(re.findall(r"\b([0-9])\b", help_text.partition("\nExit: ")[2]))
    assert ends <= set(re.findall(r"\b([0-9]):", manual.partition(".SH EXIT STATUS")[2]))
    if shutil.which("man"):
        shown = run("man", "--warnings", "-l", PACKAGE / page, env=os.environ | {"LC_ALL": "C.UTF-8", "MANWIDTH": "80"})
        assert shown.returncode == 0 and shown.stderr == "" and "SYNOPSIS" in shown.stdout


def completed(*words):
    script = f"source {PACKAGE}/reposed; COMP_WORDS=(\"$@\"); COMP_CWORD=$(($# - 1)); _reposed; printf '%s\\n' \"${{COMPREPLY[@]}}\""
    return run("bash", "-c", script, "bash", *words).stdout.split()


def test_the_shell_completes_commands_and_options():
    told = re.findall(r"^  reposed (\w+)", run(BUILD / "reposed", "--help").stdout, re.M)
    assert set(told) <= set(completed(BUILD / "reposed", ""))
    assert completed(BUILD / "reposed", "serve", "--q") == ["--queue-limit"]
    assert completed(BUILD / "repose", "run", "--isa", "av") == ["avx512", "avx2"]
    assert completed(BUILD / "reposed", "serve", "--executor", "") == ["local", "slurm"]
    assert "--checkpoint-seconds" in completed(BUILD / "repose", "run", "--")


def test_the_service_is_understood_and_confined(tmp_path):
    if not shutil.which("systemd-analyze"):
        pytest.skip("there is no systemd-analyze here")
    unit = tmp_path / "reposed.service"
    unit.write_text((ROOT / "server/reposed.service").read_text().replace("@PREFIX@/bin/reposed", "/bin/true"))
    verified = run("systemd-analyze", "verify", "--man=no", unit)
    assert (verified.returncode, verified.stdout + verified.stderr) == (0, "")
    rated = run("systemd-analyze", "security", "--offline=true", "--threshold=20", "--no-pager", unit)
    assert rated.returncode == 0, rated.stdout[-400:]  # at most 2.0 of 10
    if shutil.which("systemd-sysusers"):
        (tmp_path / "etc").mkdir()
        done = run("systemd-sysusers", f"--root={tmp_path}", PACKAGE / "sysusers.d/reposed.conf")
        assert done.returncode == 0 and (tmp_path / "etc/passwd").read_text().startswith("reposed:")


@pytest.mark.torture
def test_a_package_installs_and_purges_in_a_bare_tree(tmp_path):
    for tool in ("dpkg-deb", "dpkg-shlibdeps", "strip"):
        if not shutil.which(tool):
            pytest.skip(f"there is no {tool} here")
    if not all((BUILD / name).exists() for name in VARIANTS):
        pytest.skip("a package has all variants of repose, which are not built: make programs")
    build = whole_build(tmp_path / "build")
    made = run("sh", PACKAGE / "deb.sh", build)
    assert made.returncode == 0, made.stderr
    package = made.stdout.strip()
    needs = run("dpkg-deb", "-f", package, "Depends").stdout
    assert {"libmicrohttpd12", "libjansson4", "libsqlite3-0", "libc6"} <= set(re.findall(r"[a-z0-9.+-]+(?= \(|,|\n)", needs))
    assert all(re.match(r"lib[a-z0-9]|zlib1g", name.strip()) for name in needs.split(",")), needs  # libraries alone
    bare = tmp_path / "bare"
    (bare / "var/lib/dpkg/info").mkdir(parents=True)
    (bare / "var/lib/dpkg/updates").mkdir()
    (bare / "var/lib/dpkg/status").write_text("")
    dpkg = ["dpkg", f"--root={bare}", "--force-script-chrootless", "--force-depends", "--force-not-root", "--log=/dev/null"]
    done = run(*dpkg, "-i", package, stdin=subprocess.DEVNULL)
    assert done.returncode == 0, done.stderr
    assert run(bare / "usr/bin/reposed", "--version").stdout == run(BUILD / "reposed", "--version").stdout
    assert (bare / "etc/reposed.conf").exists() and (bare / "lib/systemd/system/reposed.service").exists()
    (bare / "var/lib/reposed/jobs").mkdir(parents=True)
    done = run(*dpkg, "--purge", "reposed", stdin=subprocess.DEVNULL)
    assert done.returncode == 0, done.stderr
    left = [path for path in bare.rglob("*") if not path.is_dir() and "var/lib/dpkg" not in str(path)]
    assert left == [] and not (bare / "var/lib/reposed").exists() and not (bare / "usr/lib/reposed").exists()


# --- the file of options ---

def serve_with(tmp_path, text, *options):
    file = tmp_path / "reposed.conf"
    file.write_text(text)
    command = [BUILD / "reposed", "serve", "--config", file, "--worker", FAKE_WORKER, "--data", tmp_path / "data", *options]
    return run(*command), file


def test_a_file_gives_options_and_the_command_line_has_the_last_word(tmp_path):
    file = tmp_path / "reposed.conf"
    file.write_text(f"# ours\n\n  queue-limit = 1\r\nport=1\nworkers =\t3\nallow-host = one.example\nallow-host = two.example\n"
                    f"data = {tmp_path / 'a folder'}")
    daemon = Daemon(tmp_path, worker=FAKE_WORKER, options=["--config", str(file)])
    daemon.data = tmp_path / "a folder"
    daemon.start()
    try:
        assert daemon.port != 1 and (tmp_path / "a folder/reposed.sqlite").exists()
        assert "reposed_workers 3\n" in daemon.get("/metrics").text
        codes = [daemon.get("/healthz", headers={"Host": name}).status_code for name in ("one.example", "two.example", "three.example")]
        assert codes[:2] == [200, 200] and codes[2] != 200
    finally:
        daemon.stop()


def test_every_fault_of_a_file_is_told_with_its_line_and_what_may_stand_there(tmp_path):
    done, file = serve_with(tmp_path, "port = 70000\nprot = 1\nworkers = 2\nworkers = 3\nhost\nqueue-limit = many\n"
                                      "public-url = ftp://x\nconfig = other\nhelp = 1\ntoken-file =\n")
    assert done.returncode == 2 and not (tmp_path / "data").exists()
    lines = [line.removeprefix(f"reposed: {file}, ") for line in done.stderr.splitlines()]
    assert lines[0] == 'line 1: port is "70000"; must be a whole number in [0, 65535]'
    assert lines[1].startswith('line 2: there is no option "prot"')
    assert lines[2] == "line 4: workers was given on line 3 already; must be given once"
    assert lines[3] == 'line 5: "host" is not understood; must be a name, = and a value'
    assert lines[4] == 'line 6: queue-limit is "many"; must be a whole number in [1, 1000000]'
    assert lines[5].startswith('line 7: public-url is "ftp://x"; must be http:// or https://')
    assert [line[:6] for line in lines[6:]] == ["line 8", "line 9", "line 1"] and lines[8].startswith("line 10: token-file")


@pytest.mark.parametrize("kind, says", [("absent", "No such file"), ("folder", "no plain file"), ("long", "more than 64 kB"),
                                        ("bytes", "no text")])
def test_a_file_that_is_none_is_refused(tmp_path, kind, says):
    file = tmp_path / "file"
    if kind == "folder":
        file.mkdir()
    elif kind != "absent":
        file.write_bytes(b"#" * 70000 if kind == "long" else b"port = 1\0\n")
    done = run(BUILD / "reposed", "serve", "--config", file, "--worker", FAKE_WORKER)
    assert done.returncode == 2 and f"{file} can't be read" in done.stderr and says in done.stderr
