"""A motion proof's folder read for scoring: this is where the truth is unsealed.

visible/<world>/   robot.yaml, motions.csv, test_motions.csv
sealed.tar.gz      truth.yaml and test.csv of each world
verdicts/<world>/  what the diagnosis answered
seen.txt           the files that the diagnosing job could see
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from armscope.proof.motion.answers import read_answer
from armscope.proof.motion.scoring import MotionWorld
from armscope.proof.motion.truth import unseal
from armscope.proof.reading import check_seal

ALLOWED = {"robot.yaml", "motions.csv", "test_motions.csv"}  # All that a diagnosing job may see of a world


def read_worlds(folder: Path) -> Iterator[MotionWorld]:
    """Every world of a proof with its answer. Raises InputError: a diagnosing job could see more than it may."""
    check_seal(folder / "seen.txt", ALLOWED)
    for world, truth in unseal(folder / "sealed.tar.gz").items():
        yield MotionWorld(truth, read_answer(folder / "verdicts" / world))
