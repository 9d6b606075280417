"""The workflow: killed and resumed by the documented command, and the same on any number of cores and on SLURM."""

from __future__ import annotations

import shutil
import signal
import sys
import time
from pathlib import Path

import numpy as np

from tests.campaign.slurm import cluster, unavailable
from tests.campaign.trial import ROOT, Outcome, contents, ended, leftovers, run

TARGETS = ("results/small/proof/small/report.html", "results/small/paper/table2.csv")
FIXED = ("--configfile", "config/small.yaml", "--config", "proof_seed=5", "recordings_dir=nowhere")


def checkout(folder: Path) -> Path:
    """A copy of what the workflow needs."""
    for name in ("config", "workflow", "profiles", "src", "examples"):
        shutil.copytree(ROOT / name, folder / name, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(ROOT / "Snakefile", folder)
    return folder


def snakemake(*arguments: str) -> list[str]:
    """The workflow on the campaign's targets."""
    return [sys.executable, "-m", "snakemake", *TARGETS, "--nocolor", *arguments, *FIXED]


def campaign(home: Path, times: int, rng: np.random.Generator) -> list[Outcome]:
    """Reference with one core, then two, kills, SLURM.

    Args:
        home: a folder for the copies.
        times: how often it is killed.
        rng: draws the moments.
    """
    started = time.monotonic()
    done = run(snakemake("-j1"), cwd=checkout(home / "one"))
    if done.returncode:
        said = [line for line in done.stderr.splitlines() if "rror" in line]
        return [Outcome("the workflow ends well", "`-j1`", 1, ("; ".join(said)[-1000:],))]
    seconds, reference = time.monotonic() - started, contents(home / "one" / "results")
    done = run(snakemake("-j2"), cwd=checkout(home / "two"))
    same = done.returncode == 0 and contents(home / "two" / "results") == reference
    outcomes = [Outcome("the same results, byte by byte", "`-j1` and `-j2`", 1, () if same else (done.stderr[-500:],))]
    broken = []
    work = checkout(home / "killed")
    for _ in range(times):
        shutil.rmtree(work / "results", ignore_errors=True)
        ended(snakemake("-j2"), float(rng.uniform(0, seconds)), signal.SIGKILL, cwd=work)
        unlock = run(snakemake("--unlock"), cwd=work)
        again = run(snakemake("-j2"), cwd=work)
        if (
            unlock.returncode
            or again.returncode
            or contents(work / "results") != reference
            or leftovers(work / "results")
        ):
            broken.append(f"{again.stderr[-500:]} {leftovers(work / 'results')}")
    promise = "`snakemake --unlock` and the same command: the same results, nothing left behind"
    outcomes.append(Outcome(promise, "kill -9 of the whole process group at random moments", times, tuple(broken)))
    return [*outcomes, slurm(home, reference)]


def slurm(home: Path, reference: dict[str, str]) -> Outcome:
    """The same on a SLURM of one node."""
    promise, tested = "the same results on a cluster, byte by byte", "SLURM on one node, `profiles/slurm-generic`"
    if reason := unavailable():
        return Outcome(promise, tested, 0, (), reason)
    work = checkout(home / "slurm")
    with cluster(home / "daemons"):
        done = run(snakemake("--workflow-profile", "profiles/slurm-generic", "--jobs", "4"), cwd=work)
    same = done.returncode == 0 and contents(work / "results") == reference
    return Outcome(promise, tested, 1, () if same else (done.stderr[-1500:],))
