"""Tilts of an axis that keep their size as the joint turns, and which of them no row tells from a twisted link.

A tilt that turns with its joint, once per turn, is always the same in the turned link: it is a twist of that link and
the next zero, in every pose that the arm can take. Neither rows nor a dial gauge tell the two apart, and what corrects
the rows corrects it.
"""

from __future__ import annotations

import numpy as np

from armscope.core.types import Array
from armscope.diagnosis.summary.constants import TELLING
from armscope.diagnosis.summary.rivals import Rival
from armscope.inference.problem import Problem
from armscope.physics.wobble import AXIS_WOBBLE

ROUND = 0.5 * np.array([[[1, 0, 0, 1], [0, -1, 1, 0]], [[1, 0, 0, -1], [0, 1, 1, 0]]])
"""(cosine, sine) about x and about y as (x, y) of what turns with the joint and of what turns against it."""


def sense_of_round(values: Array) -> int:
    """Which of `ROUND` is the larger in a tilt (4,): 0 turns with the joint."""
    return int(np.argmax(np.linalg.norm(ROUND @ values[:4], axis=1)))


def runs_round(values: Array, covariance: Array) -> bool:
    """Whether a tilt keeps its size as the joint turns: what turns the other way is nothing that rows show.

    Args:
        values: (4 or more,) cosine and sine about x, cosine and sine about y, rad.
        covariance: of them.
    """
    sizes = np.linalg.norm(ROUND @ values[:4], axis=1)
    larger = sense_of_round(values)
    smaller = 1 - larger
    stderr = float(np.sqrt(np.trace(ROUND[smaller] @ covariance[:4, :4] @ ROUND[smaller].T) / 2))
    return bool(sizes[smaller] < TELLING.runs_round * stderr < TELLING.runs_round_at_least * sizes[larger])


def is_a_turned_link(problem: Problem, rival: Rival) -> bool:
    """Whether a rival is a wobble that turns with its joint once per turn.

    Args:
        problem: whose columns its hypothesis is of.
        rival: in place of a link's geometry or a zero.
    """
    candidate, hypothesis = rival.candidate, rival.hypothesis
    if (candidate.kind, candidate.variant) != (AXIS_WOBBLE.name, "1"):
        return False
    scale = problem.scale[candidate.columns]
    values = hypothesis.means(candidate.columns) / scale
    covariance = hypothesis.covariance(candidate.columns) / np.outer(scale, scale)
    return sense_of_round(values) == 0 and runs_round(values, covariance)
