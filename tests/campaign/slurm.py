"""A real SLURM on this machine alone, for as long as a test lasts; without accounting."""

from __future__ import annotations

import contextlib
import importlib.util
import os
import shutil
import socket
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path

from tests.campaign.trial import ENVIRONMENT

CONF = """ClusterName=one
SlurmctldHost={host}
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
MpiDefault=none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
ReturnToService=2
SlurmctldPidFile={home}/slurmctld.pid
SlurmdPidFile={home}/slurmd.pid
SlurmdSpoolDir={home}/spool
StateSaveLocation={home}/state
SlurmctldLogFile={home}/slurmctld.log
SlurmdLogFile={home}/slurmd.log
SchedulerType=sched/backfill
SchedulerParameters=sched_interval=2,batch_sched_delay=0,sched_min_interval=100000
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
DefMemPerCPU=1000
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MinJobAge=600
NodeName={host} CPUs=2 RealMemory={memory} State=UNKNOWN
PartitionName=short Nodes={host} Default=YES MaxTime=04:00:00 State=UP
"""
DAEMONS = ("munged", "slurmctld", "slurmd", "sbatch", "scontrol")


def unavailable() -> str:
    """Why no SLURM can be started here; "" where it can."""
    missing = [name for name in DAEMONS if shutil.which(name, path=f"{os.environ['PATH']}:/usr/sbin") is None]
    if missing:
        return f"{missing[0]} is not installed (Debian: slurm-wlm, munge)"
    if os.geteuid() != 0:
        return "slurmd must be started by root"
    if importlib.util.find_spec("snakemake_executor_plugin_cluster_generic") is None:
        return "requirements-cluster.lock is not installed"
    return ""


@contextlib.contextmanager
def cluster(home: Path) -> Iterator[None]:
    """Start munge, the controller and the node; commands find them by SLURM_CONF. They are ended afterwards.

    Args:
        home: a folder for their files.
    """
    for name in ("spool", "state"):
        (home / name).mkdir(parents=True)
    host = socket.gethostname().partition(".")[0]
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") // 2**20 * 3 // 4
    conf = home / "slurm.conf"
    conf.write_text(CONF.format(host=host, home=home, memory=memory), encoding="utf-8")
    Path("/run/munge").mkdir(exist_ok=True)
    shutil.chown("/run/munge", "munge", "munge")
    ENVIRONMENT["SLURM_CONF"] = str(conf)
    where = {**ENVIRONMENT, "PATH": f"{ENVIRONMENT['PATH']}:/usr/sbin"}
    started = []
    if subprocess.run(["munge", "-n"], capture_output=True, check=False).returncode:
        subprocess.run(["runuser", "-u", "munge", "--", "/usr/sbin/munged"], check=True)
        started.append("munged")
    try:
        for daemon in ("slurmctld", "slurmd"):
            subprocess.run([daemon, "-f", str(conf)], env=where, check=True)
            started.append(daemon)
        _wait_for_the_node(where)
        yield
    finally:
        for daemon in reversed(started):
            with contextlib.suppress(OSError, ValueError):
                file = Path("/run/munge/munged.pid") if daemon == "munged" else home / f"{daemon}.pid"
                os.kill(int(file.read_text()), 15)
        del ENVIRONMENT["SLURM_CONF"]


def _wait_for_the_node(where: dict[str, str]) -> None:
    for _ in range(60):
        said = subprocess.run(
            ["sinfo", "-h", "-o", "%T"], env=where, capture_output=True, text=True, check=False
        ).stdout
        if said.strip() in ("idle", "mixed"):
            return
        time.sleep(1)
    raise RuntimeError(f"the node did not come up: {said}")
