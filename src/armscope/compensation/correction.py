"""Newton's method on the real arm from where the nominal arm would be sent, and what it gains."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armscope.compensation.constants import COMMANDS
from armscope.compensation.forward import Forward
from armscope.compensation.newton import Solution, Wanted, lever, solve_commands, weakest
from armscope.core.types import Array, Indices


@dataclass(frozen=True, eq=False)
class Corrected:
    """What `correct` finds for n rows: m and rad as in `Compensated`; ``pole`` (n,) where the arm can't be led."""

    uncorrected: Array
    uncorrected_turn: Array
    solution: Solution
    predicted: Array
    residual_turn: Array
    pole: NDArray[np.bool_]


def correct(real: Forward, wanted: Wanted, nominal: Array, free: NDArray[np.bool_], rows: Indices) -> Corrected:
    """Some rows of a path: where the real arm would be at the nominal posture, and the commands that put it right.

    Args:
        real: the arm.
        wanted: n points, or full poses, base axes.
        nominal: (n, m) rad, the nominal posture.
        free: (m,) motors that may move.
        rows: (n,) their numbers in the path.

    Returns:
        Commands and misses with and without them.
    """
    before = real.at(nominal, rows)
    solution = solve_commands(real, wanted, nominal, free, rows)
    at_start = weakest(wanted, before, free, lever(real))
    after = real.at(solution.angles, rows)
    return Corrected(
        np.linalg.norm(wanted.points - before.points, axis=1),
        np.linalg.norm(wanted.turn(before), axis=1),
        solution,
        after.points,
        np.linalg.norm(wanted.turn(after), axis=1),
        np.where(solution.converged, solution.singular, at_start) < COMMANDS.pole,
    )
