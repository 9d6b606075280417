"""A proof's folder read for scoring: this is where the truth is unsealed.

visible/<batch>/<world>/   robot.yaml, recordings.csv, test_poses.csv
sealed/<batch>.tar.gz      truth.yaml and test.csv of each world
verdicts/<batch>/<world>/  what the diagnosis answered
seen/<batch>.txt           the files that the diagnosing job could see
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from pathlib import Path

import pandas as pd

from armscope.core.inputs import InputError
from armscope.proof.answers import read_answer
from armscope.proof.scoring import World
from armscope.proof.truth import unseal

ALLOWED = {"robot.yaml", "recordings.csv", "test_poses.csv"}  # All that a diagnosing job may see of a world


def read_worlds(folder: Path) -> Iterator[World]:
    """Every world of a proof with its answer. Raises InputError: a diagnosing job could see more than it may."""
    for batch, archive in sealed_batches(folder):
        verdicts = folder / "verdicts" / batch
        for world, truth in unseal(archive).items():
            recorded = pd.read_csv(folder / "visible" / batch / world / "recordings.csv")
            times = recorded.get("time_s")
            runs = int(recorded["run"].nunique()) if "run" in recorded else 1
            yield World(truth, read_answer(verdicts / world), times, runs)


def sealed_batches(folder: Path) -> Iterator[tuple[str, Path]]:
    """Name and archive of every batch of worlds, once it is sure that its diagnosing job saw what it may and no
    more. Raises InputError: one could see more."""
    for archive in sorted((folder / "sealed").glob("*.tar.gz")):
        batch = archive.name.removesuffix(".tar.gz")
        check_seal(folder / "seen" / f"{batch}.txt")
        yield batch, archive


def check_seal(seen: Path, allowed: Collection[str] = ALLOWED) -> None:
    """Make sure that a diagnosing job saw nothing but what may be seen. Raises InputError: the list holds another
    file."""
    files = seen.read_text(encoding="utf-8").splitlines()
    if not files:
        raise InputError(seen, "", "nothing", "the list says what the diagnosing job saw, what was measured at least")
    for line in files:
        if Path(line).name not in allowed:
            raise InputError(seen, "", line, f"a diagnosing job may see {', '.join(sorted(allowed))} and nothing else")
