"""The workflow: killed and resumed by the documented command, and the same on any number of cores and on SLURM."""

from __future__ import annotations

import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from tests.campaign.slurm import cluster, unavailable
from tests.campaign.trial import (
    ENVIRONMENT,
    ROOT,
    Outcome,
    contents,
    cpu_seconds_of_children,
    ended,
    leftovers,
    python,
    run,
)

TARGETS = ("results/small/proof/small/report.html", "results/small/paper/table2.csv")
FLEET = "four/fleet.csv"
SHORTER = ("results/small/paper/table2.csv", "results/small/fleet/four-fleet/report.html")
FIXED = ("--configfile", "config/small.yaml", "--config", "proof_seed=5", "recordings_dir=nowhere")


def checkout(folder: Path) -> Path:
    """A copy of what the workflow needs."""
    for name in ("config", "workflow", "profiles", "src", "examples"):
        shutil.copytree(ROOT / name, folder / name, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(ROOT / "Snakefile", folder)
    return folder


def snakemake(*arguments: str, targets: tuple[str, ...] = TARGETS) -> list[str]:
    """The workflow on the campaign's targets."""
    return [sys.executable, "-m", "snakemake", *targets, "--nocolor", *arguments, *FIXED]


def shorter(*arguments: str) -> list[str]:
    """A workflow that is ended many times: the paper's table and a fleet of four arms, some forty CPU seconds."""
    return [*snakemake(*arguments, targets=SHORTER), f"fleet={FLEET}"]


def campaign(home: Path) -> Iterator[Outcome]:
    """The same on one core, on two and on SLURM.

    Args:
        home: a folder for the copies.
    """
    done = run(snakemake("-j1"), cwd=checkout(home / "one"))
    if done.returncode:
        said = [line for line in done.stderr.splitlines() if "rror" in line]
        yield Outcome("the workflow ends well", "`-j1`", 1, ("; ".join(said)[-1000:],))
        return
    reference = contents(home / "one" / "results")
    done = run(snakemake("-j2"), cwd=checkout(home / "two"))
    same = done.returncode == 0 and contents(home / "two" / "results") == reference
    yield Outcome("the same results, byte by byte", "`-j1` and `-j2`", 1, () if same else (done.stderr[-500:],))
    yield slurm(home, reference)


def shorter_campaign(home: Path, times: int, rng: np.random.Generator) -> Iterator[Outcome]:
    """Of a shorter workflow: killed, interrupted, on a disk that fills up, two at once.

    Args:
        home: a folder for the copies.
        times: how often it is killed; a quarter as often the others.
        rng: draws the moments and the disk's sizes.
    """
    work = checkout(home / "shorter")
    simulated = ("fleet", "simulate", str(work / "config" / "robots"), "--arms", "4")
    run(python(*simulated, "-o", str(work / Path(FLEET).parent)), check=True)
    before = cpu_seconds_of_children()
    run(shorter("-j2"), cwd=work, check=True)
    cpu_s, reference = cpu_seconds_of_children() - before, contents(work / "results")
    few = max(1, times // 4)
    for sign, how, tries in ((signal.SIGKILL, "kill -9", times), (signal.SIGINT, "Ctrl-C", few)):
        broken = []
        for _ in range(tries):
            shutil.rmtree(work / "results", ignore_errors=True)
            ended(shorter("-j2"), float(rng.uniform(0, cpu_s)), sign, cwd=work)
            if sign is signal.SIGKILL:
                run(shorter("--unlock"), cwd=work)
            broken += _differs(run(shorter("-j2"), cwd=work), work, reference)
        first = "`snakemake --unlock` and the same command" if sign is signal.SIGKILL else "the same command"
        promise, tested = "the same results, nothing left behind", f"{how} to the whole process group at random moments"
        yield Outcome(f"{first}: {promise}", tested, tries, tuple(broken))
    yield _full_disk(work, few, rng, reference)
    broken = []
    for _ in range(few):
        shutil.rmtree(work / "results", ignore_errors=True)
        both = [subprocess.Popen(shorter("-j1"), cwd=work, env=ENVIRONMENT, stderr=subprocess.DEVNULL) for _ in "12"]
        codes = sorted(process.wait() for process in both)
        broken += [f"{codes}"] if codes != [0, 1] or contents(work / "results") != reference else []
    yield Outcome("one runs, the other is refused by Snakemake's lock", "two of the workflow", few, tuple(broken))


def _differs(again: subprocess.CompletedProcess[str], work: Path, reference: dict[str, str]) -> list[str]:
    """What is wrong after a workflow was resumed."""
    results = work / "results"
    if again.returncode or contents(results) != reference or leftovers(results):
        return [f"{again.stderr[-500:]} {leftovers(results)}"]
    return []


def _full_disk(work: Path, times: int, rng: np.random.Generator, reference: dict[str, str]) -> Outcome:
    """Results on a disk that fills up; then there is room again."""
    promise, tested = "it fails; with room, the same command: the same results", "a disk that fills up at random sizes"
    results, broken = work / "results", []
    needed = sum((results / name).stat().st_size for name in reference)
    for _ in range(times):
        shutil.rmtree(results, ignore_errors=True)
        results.mkdir()
        size = int(rng.uniform(0.05, 0.9) * needed)
        mount = ["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", str(results)]
        if subprocess.run(mount, capture_output=True, check=False).returncode:
            return Outcome(promise, tested, 0, (), "file systems can't be mounted here")
        try:
            if run(shorter("-j2"), cwd=work).returncode == 0:
                broken.append("it said that it ended well")
            subprocess.run(["mount", "-o", "remount,size=1g", str(results)], check=True)
            broken += _differs(run(shorter("-j2"), cwd=work), work, reference)
        finally:
            subprocess.run(["umount", str(results)], check=True)
    return Outcome(promise, tested, times, tuple(broken))


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
