"""A motion proof's folder read for scoring: this is where the truth is unsealed.

visible/<world>/   robot.yaml, motions.csv, test_motions.csv
sealed.tar.gz      truth.yaml and test.csv of each world
verdicts/<world>/  what the diagnosis answered
seen.txt           the files that the diagnosing job could see
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from armscope.core.inputs import InputError
from armscope.proof.motion.answers import read_answer
from armscope.proof.motion.scoring import MotionWorld
from armscope.proof.motion.truth import unseal

ALLOWED = {"robot.yaml", "motions.csv", "test_motions.csv"}
"""All that a diagnosing job may see of a world."""


def read_worlds(folder: Path) -> Iterator[MotionWorld]:
    """Every world of a proof with its answer.

    Raises:
        InputError: a diagnosing job could see more than it may.
    """
    check_seal(folder / "seen.txt")
    for world, truth in unseal(folder / "sealed.tar.gz").items():
        yield MotionWorld(truth, read_answer(folder / "verdicts" / world))


def check_seal(seen: Path) -> None:
    """Make sure that the diagnosing job saw nothing but what may be seen.

    Raises:
        InputError: the list holds another file.
    """
    files = seen.read_text(encoding="utf-8").splitlines()
    if not files:
        raise InputError(seen, "", "nothing", "the list says what the diagnosing job saw, its motions at least")
    for line in files:
        if Path(line).name not in ALLOWED:
            raise InputError(seen, "", line, f"a diagnosing job may see {', '.join(sorted(ALLOWED))} and nothing else")
