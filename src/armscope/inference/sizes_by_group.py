"""How large the values of a background are, learned group by group: Student's t in the place of one Gaussian for all.

A gear's error is a few of its waves, not all of them a little. Where all have one size, rows are spent on waves that
aren't there and the others are held down. So every group of values (a wave's two) has a size of its own, about that of
a larger group (its gear), and both follow from the values' mean squares, in turns with the fit (MacKay 1992; Tipping
2001). A group's prior counts like `freedom` values of the usual size: its values follow Student's t.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array, Indices
from armscope.inference.constants import SIZES_BY_GROUP
from armscope.inference.evidence import Hypothesis, evaluate
from armscope.inference.model_space import ToleranceFamily
from armscope.inference.problem import Problem


@dataclass(frozen=True, eq=False)
class SizeGroups:
    """Which of a family's values are of a size."""

    family: int  # number of the family
    small: Indices  # (c,) number of each value's own group
    large: Indices  # (c,) number of the larger one
    learned: NDArray[np.bool_]  # (c,) where not, a value's size stays as it is: it has a name, too


def sizes_by_group(
    problem: Problem, hypothesis: Hypothesis, groups: SizeGroups, freedom: float
) -> tuple[Array, Hypothesis]:
    """Sizes of a family's values as the rows have them, given all else that a hypothesis holds.

    Args:
        problem: the normal equations and priors.
        hypothesis: in which the family has a size.
        groups: which values are of a size.
        freedom: of Student's t; infinite: only the large groups have a size of their own.

    Returns:
        (c,) by what factors the values are larger than stated, and the hypothesis with that.
    """
    family = problem.space.families[groups.family]
    assert isinstance(family, ToleranceFamily)
    stated = family.prior_variance(hypothesis.background[groups.family], problem.scale)
    of_small, of_large = np.ones(len(stated)), np.ones(len(stated))
    factor, found = np.ones(len(stated)), hypothesis
    for _ in range(SIZES_BY_GROUP.steps):
        square = (found.means(family.columns) ** 2 + found.variances(family.columns)) / stated
        if np.isfinite(freedom):
            of_small = _usual(square / of_large, groups.small, groups.learned, freedom)
        of_large = _usual(square / of_small, groups.large, groups.learned, SIZES_BY_GROUP.weight_of_stated)
        factor = np.where(groups.learned, np.sqrt(of_small * of_large), 1.0)
        found = evaluate(
            _with_sizes(problem, groups.family, family, factor), found.chosen, found.background, found.noise
        )
    return factor, found


def _usual(square: Array, group: Indices, counts: NDArray[np.bool_], weight: float) -> Array:
    """(c,) mean square of each value's group, of which 1 is believed beforehand like ``weight`` values."""
    many = int(group.max()) + 1
    total = np.bincount(group[counts], square[counts], minlength=many)
    return np.asarray(((weight + total) / (weight + np.bincount(group[counts], minlength=many)))[group])


def _with_sizes(problem: Problem, number: int, family: ToleranceFamily, factor: Array) -> Problem:
    families = list(problem.space.families)
    families[number] = replace(family, tolerance=family.tolerance * factor)
    return replace(problem, space=replace(problem.space, families=tuple(families)))
