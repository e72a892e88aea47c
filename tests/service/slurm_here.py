"""A whole Slurm on this machine, of Debian's packages, in a folder of its own and on free ports: munge, a controller and a node
daemon, of one node with two processors."""
import os
import pwd
import shutil
import signal
import socket
import subprocess
import time
from pathlib import Path

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "scancel", "scontrol")
CONFIGURATION = """
ClusterName=here
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller}
SlurmdPort={node}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.sock
CredType=cred/munge
MpiDefault=none
JobAcctGatherType=jobacct_gather/linux
JobAcctGatherFrequency=1
{memory}
SwitchType=switch/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
SchedulerType=sched/backfill
SchedulerParameters=batch_sched_delay=0,sched_min_interval=0
ReturnToService=2
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
AccountingStorageType=accounting_storage/none
MinJobAge=300
KillWait=5
NodeName={host} NodeAddr=127.0.0.1 CPUs=2 RealMemory=2000 State=UNKNOWN
PartitionName=drums Nodes={host} Default=YES MaxTime=00:30:00 State=UP
"""


# How a Slurm sees to it that no job takes more memory than it was given: by cgroups, of which it tells as OUT_OF_MEMORY, or by
# looking once a second, and then it calls the job FAILED.
BY_LOOKING = "ProctrackType=proctrack/linuxproc\nTaskPlugin=task/none\nJobAcctGatherParams=OverMemoryKill"
BY_CGROUPS = "ProctrackType=proctrack/cgroup\nTaskPlugin=task/cgroup"
CGROUPS = Path("/sys/fs/cgroup")
CGROUPS_CONFIGURATION = "CgroupPlugin=cgroup/v1\nCgroupMountpoint=/sys/fs/cgroup\nCgroupAutomount=no\nConstrainRAMSpace=yes\n"


def why_no_cgroups():
    """"": there are."""
    if os.geteuid() != 0:
        return "only root makes cgroups"
    there = all(os.access(CGROUPS / name, os.W_OK) for name in ("memory/tasks", "freezer/tasks", "cpuset/tasks"))
    return "" if there else "this machine has no cgroups of version 1 that may be written"


def what_is_missing():
    """"": nothing."""
    path = f"{os.environ['PATH']}:/usr/sbin:/sbin"
    missing = [name for name in PROGRAMS if not shutil.which(name, path=path)]
    if missing:
        return f"not installed: {', '.join(missing)}"
    return "" if (os.cpu_count() or 1) > 1 else "this machine has one processor"


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


class Slurm:
    def __init__(self, folder, memory=BY_LOOKING):
        self.folder = folder
        for name in ("state", "spool"):
            (folder / name).mkdir(parents=True)
        self.environment = os.environ | {"SLURM_CONF": str(folder / "slurm.conf"),
                                         "PATH": f"{os.environ['PATH']}:/usr/sbin:/sbin"}
        self.host = socket.gethostname().split(".")[0]
        (folder / "slurm.conf").write_text(CONFIGURATION.format(
            host=self.host, folder=folder, controller=free_port(), node=free_port(), user=pwd.getpwuid(os.geteuid()).pw_name, memory=memory))
        (folder / "cgroup.conf").write_text(CGROUPS_CONFIGURATION)
        (folder / "munge.key").write_bytes(os.urandom(128))
        (folder / "munge.key").chmod(0o400)
        self.running = {}

    def start(self):
        for above in [self.folder, *self.folder.parents]:  # munge trusts no folder that others may write
            if above.stat().st_uid == os.geteuid() and above.stat().st_mode & 0o022 and not above.stat().st_mode & 0o1000:
                above.chmod(above.stat().st_mode & ~0o022)
        self.launch("munged", "-F", "--force", f"--socket={self.folder}/munge.sock", f"--key-file={self.folder}/munge.key",
                    f"--log-file={self.folder}/munged.log", f"--pid-file={self.folder}/munged.pid",
                    f"--seed-file={self.folder}/munged.seed")
        self.wait(lambda: (self.folder / "munge.sock").exists())
        self.launch("slurmctld", "-D")
        self.launch("slurmd", "-D", "-N", self.host)
        self.wait(lambda: "idle" in self.run("sinfo", "-h", "-o", "%T"))
        return self

    def launch(self, name, *arguments):
        with open(self.folder / f"{name}.out", "ab") as log:
            self.running[name] = subprocess.Popen([name, *arguments], env=self.environment, stdin=subprocess.DEVNULL, stdout=log,
                                                  stderr=log, start_new_session=True)

    def kill(self, name):
        self.running[name].kill()
        self.running.pop(name).wait()

    def run(self, *command):
        return subprocess.run(command, env=self.environment, capture_output=True, text=True, timeout=60).stdout

    def wait(self, condition, seconds=30):
        end = time.monotonic() + seconds
        while not condition():
            assert time.monotonic() < end, "".join(log.read_text(errors="replace")[-2000:] for log in self.folder.glob("*.*o*"))
            time.sleep(0.1)

    def jobs(self):
        """Of all that it remembers: number, state, name."""
        return [line.split("|") for line in self.run("squeue", "-h", "-t", "all", "-o", "%i|%T|%j").splitlines()]

    def stop(self):
        self.run("scancel", "--full", "--signal=KILL", *(number for number, *_ in self.jobs()))
        for name in ("slurmd", "slurmctld", "munged"):
            if name in self.running:
                self.running[name].send_signal(signal.SIGTERM)
        for name in list(self.running):
            try:
                self.running[name].wait(10)
            except subprocess.TimeoutExpired:
                self.kill(name)
        for left in CGROUPS.glob(f"*/slurm_{self.host}"):
            left.rmdir()
