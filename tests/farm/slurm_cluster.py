"""A cluster of one machine: munged, slurmctld and slurmd of its own, in a folder of its own."""
import os
import pathlib
import secrets
import shutil
import socket
import subprocess
import time

PROGRAMS = ["munged", "slurmctld", "slurmd", "sbatch", "scontrol", "squeue", "sinfo"]
CONFIGURATION = """ClusterName=relief
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge/socket
CryptoType=crypto/munge
MpiDefault=none
ProctrackType=proctrack/pgid
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerType=sched/backfill
SchedulerParameters=bf_interval=5,sched_interval=5
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/log/slurmctld.log
SlurmdLogFile={folder}/log/slurmd.log
SlurmdParameters=config_overrides
ReturnToService=2
KillWait=2
JobRequeue=1
MinJobAge=600
MaxArraySize=41
NodeName={host} NodeAddr=127.0.0.1 CPUs=4 RealMemory=16000 State=UNKNOWN
PartitionName=farm Nodes={host} Default=YES MaxTime=INFINITE State=UP OverSubscribe=FORCE:1
"""


def find_obstacle():
    """Why no cluster can be started here; empty: it can."""
    if os.getuid() != 0:
        return "slurmctld and slurmd of the test need root"
    missing = [name for name in PROGRAMS if not shutil.which(name)]
    return f"there is no {', '.join(missing)}: apt-get install slurm-wlm" if missing else ""


def find_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for one in sockets:
        one.bind(("127.0.0.1", 0))
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return ports


class Cluster:
    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.processes = []
        self.environment = dict(os.environ, SLURM_CONF=str(self.folder / "slurm.conf"))

    def __enter__(self):
        for name in ("munge", "state", "spool", "log"):
            (self.folder / name).mkdir()
        os.chmod(self.folder, 0o755)
        os.chmod(self.folder / "munge", 0o711)
        key = self.folder / "munge/key"
        key.touch(mode=0o600)
        key.write_bytes(secrets.token_bytes(128))
        host = socket.gethostname().split(".")[0]
        (self.folder / "slurm.conf").write_text(CONFIGURATION.format(host=host, folder=self.folder, ports=find_ports(2)))
        munge = {name: self.folder / "munge" / name for name in ("key", "socket", "pid", "log", "seed")}
        self.start("munged", "--foreground", "--force", *(f"--{name}{'' if name == 'socket' else '-file'}={file}"
                                                           for name, file in munge.items()))
        self.await_true(munge["socket"].exists, "munged")
        self.start("slurmctld", "-D", "-f", self.folder / "slurm.conf")
        self.start("slurmd", "-D", "-f", self.folder / "slurm.conf", "-N", host)
        self.await_true(lambda: "idle" in self.ask("sinfo", "-h", "-o", "%T"), "an idle node")
        return self

    def __exit__(self, *_):
        for process in reversed(self.processes):
            process.terminate()
        for process in self.processes:
            try:
                process.wait(timeout=20)
            except subprocess.TimeoutExpired:
                process.kill()

    def start(self, *words):
        log = open(self.folder / "log" / f"{words[0]}.txt", "w")
        self.processes.append(subprocess.Popen(list(map(str, words)), env=self.environment, stdout=log, stderr=log))

    def ask(self, *words):
        return subprocess.run(list(map(str, words)), env=self.environment, capture_output=True, text=True).stdout

    def await_true(self, is_true, what, patience=60):
        end = time.monotonic() + patience
        while not is_true():
            if time.monotonic() > end or any(process.poll() is not None for process in self.processes):
                logs = "".join(f"--- {file.name}\n{file.read_text()[-2000:]}" for file in (self.folder / "log").iterdir())
                raise AssertionError(f"not within {patience} s: {what}\n{logs}")
            time.sleep(0.2)
