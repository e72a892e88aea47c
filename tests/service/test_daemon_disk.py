"""A full disk: refused with 507, and nothing that was accepted is lost."""
import os
import re
import subprocess

import pytest

from conftest import FAKE_WORKER, Daemon


@pytest.fixture
def small_disk(tmp_path):
    """A daemon whose data folder is a file system of 4 MB."""
    data = tmp_path / "data"
    data.mkdir()
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=4m", "tmpfs", data], capture_output=True).returncode != 0:
        pytest.skip("mounting a small file system is not allowed here")
    daemon = Daemon(tmp_path, worker=FAKE_WORKER).start()
    yield daemon
    if daemon.is_running():
        daemon.stop()
    subprocess.run(["umount", "-l", data], check=True)


def fill(daemon):
    ballast = daemon.data / "ballast"
    with open(ballast, "wb", buffering=0) as file:
        for size in (65536, 512, 1):
            try:
                while True:
                    file.write(b"x" * size)
            except OSError:
                continue
    assert os.statvfs(daemon.data).f_bavail == 0
    return ballast


def test_a_job_that_finds_no_room_is_refused_and_leaves_nothing(small_disk):
    kept = small_disk.submit(fake="quick")
    small_disk.ended(kept)
    ballast = fill(small_disk)
    answer = small_disk.post()
    assert answer.status_code == 507 and "disk is full" in answer.json()["detail"]
    said = re.search(r"has (\S+) MB and \d+ inodes free, of which (\S+) MB .* snapshots of (\d+) jobs .* take (\S+) MB.* DELETE of the (\d+) jobs",
                     answer.json()["detail"])
    sizes = [snapshot["bytes"] for snapshot in small_disk.get(f"/jobs/{kept}/snapshots").json()["snapshots"]]
    assert sizes and said.group(1, 3, 5) == ("0", "1", "1") and abs(float(said[4]) - sum(sizes) / 1e6) <= 0.01 * sum(sizes) / 1e6
    assert abs(float(said[2]) - 0.084) < 0.001  # 2 % of 4 MiB
    assert small_disk.get("/readyz").status_code == 503
    assert [info["jobID"] for info in small_disk.get("/jobs").json()["jobs"]] == [kept]
    ballast.unlink()
    assert os.listdir(small_disk.data / "jobs") == [kept]
    assert small_disk.ended(small_disk.submit())["status"] == "successful"


def test_jobs_are_refused_before_the_disk_is_full(small_disk):
    disk = os.statvfs(small_disk.data)
    (small_disk.data / "ballast").write_bytes(b"x" * (disk.f_bavail * disk.f_frsize - 60_000))  # 2 % of 4 MB are 84 kB
    answer = small_disk.post()
    assert answer.status_code == 507 and "--keep-bytes" in answer.json()["detail"]
    assert small_disk.get("/jobs").json()["jobs"] == [] and os.listdir(small_disk.data / "jobs") == []
    assert os.statvfs(small_disk.data).f_bavail > 0


def test_jobs_are_refused_before_there_are_no_inodes(small_disk):
    assert subprocess.run(["mount", "-o", "remount,nr_inodes=400", small_disk.data]).returncode == 0
    number = 0
    while os.statvfs(small_disk.data).f_favail > 6:
        (small_disk.data / f"ballast{number}").touch()
        number += 1
    assert small_disk.post().status_code == 507
    for file in small_disk.data.glob("ballast*"):
        file.unlink()
    assert small_disk.ended(small_disk.submit())["status"] == "successful"


def test_an_end_that_can_not_be_recorded_is_recorded_later(small_disk):
    slow = small_disk.submit(fake="slow", seconds="4")
    small_disk.until(slow, lambda info: info["progress"] > 0)
    ballast = fill(small_disk)
    # The worker leaves when it can't write; the daemon can't write that down either, and must not forget it.
    small_disk.until(slow, lambda info: not small_disk.workers(), 20)
    assert small_disk.job(slow)["status"] == "running"
    assert small_disk.get("/healthz").status_code == 200
    ballast.unlink()
    info = small_disk.until(slow, lambda info: "could not write to the disk" in info["message"], 20)
    assert info["status"] == "accepted" and info["attempt"] == 1
    assert "reposed_store_failures_total 0" not in small_disk.get("/metrics").text


def test_a_stop_ends_and_a_start_serves_reads_on_a_full_disk(small_disk):
    job = small_disk.submit(fake="slow", seconds="4")
    small_disk.until(job, lambda info: info["progress"] > 0)
    ballast = fill(small_disk)
    assert small_disk.stop(seconds=30) == 0
    with open(ballast, "ab", buffering=0) as file, pytest.raises(OSError):  # what the stop has left
        while True:
            file.write(b"x" * 512)
    small_disk.start()
    assert small_disk.job(job)["status"] in ("accepted", "running") and small_disk.job(job)["attempt"] == 1
    answer = small_disk.get("/readyz")
    assert answer.status_code == 503 and "No space left on device" in answer.json()["detail"]
    ballast.unlink()
    assert small_disk.ended(job)["status"] == "successful" and small_disk.job(job)["attempt"] == 1
