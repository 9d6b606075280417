"""Whether there is more of a cause since it changed, or less: by what it was before and is, as far as that is known.

How far a zero moved is known far better than where it stands: other errors of the arm look like a part of it. Those
decide by chance, too, whether less is left of the recording when the change is taken back, so that this says nothing of
what the cause did: a crash may make up for a part of them.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from armscope.comparison.at_the_tool import beyond_frames
from armscope.comparison.constants import SHARED
from armscope.comparison.dispersion import Possible
from armscope.comparison.levels import own_values
from armscope.comparison.result import Sense
from armscope.comparison.shared_model import SharedModel
from armscope.comparison.valued import Valued
from armscope.core.types import Array
from armscope.physics.effect import Placed
from armscope.physics.registry import effect_named
from armscope.verdict.effects import INTERVAL

NOT_NEGATIVE = ("backlash",)
"""Beside what gives way: a gap that is less than none is none."""


def cannot_be_negative(effect: str, numbers: int) -> bool:
    """Whether a cause is told by one number that is not below zero; mass moments carry their sign."""
    known = effect_named(effect)
    return numbers == 1 and (effect in NOT_NEGATIVE or (known is not None and known.nonnegative))


def more_or_less(placed: Placed, numbers: Sequence[Valued], sigmas: float) -> Sense:
    """Whether there is more of a cause where it changed, or less; "" where that is not known.

    Args:
        placed: the cause.
        numbers: how it changed.
        sigmas: by how many standard errors there is more of it, of a cause that may have either sign.

    Returns:
        By the sign of the change where that says it: who cannot be below zero has more than nothing before and after.
    """
    if cannot_be_negative(placed.name, len(numbers)):
        low, high = numbers[0].interval_95
        return "more" if low > 0 else "less" if high < 0 else ""
    return "more" if sigmas > INTERVAL else "less" if sigmas < -INTERVAL else ""


def more_sigmas(
    model: SharedModel, found: Possible, beside: Sequence[Possible], there: Array, elsewhere: Array
) -> float:
    """By how many standard errors there is more of a cause where it changed than elsewhere; below zero: less.

    With d the change and m the middle of before and after, the squares of what both do at the tool, beyond base and
    tool, differ by 2 d'Gm. The other errors that recordings share are taken to be as large as what the best of the
    recordings is left with: a cause that came or went is in one of them only.

    Args:
        model: what recordings share.
        found: the change.
        beside: changes of other effects.
        there: (sets,) the share of each recording in what it is with the change, and
        elsewhere: without it.

    Returns:
        d'Gm in its own standard errors.
    """
    best = np.sqrt(3) * min(model.left_mm(())[0])
    count, q = len(there), len(found.placed.terms)
    values, covariance, _ = own_values(model, found.number, beside, count, min(SHARED.prior_mm, float(best)))
    change, middle = (np.kron(part, np.eye(q)) for part in (there - elsewhere, (there + elsewhere) / 2))
    columns = beyond_frames(model, model.columns_of(found.number, tuple(range(count))))
    along = columns.T @ (columns @ (change @ values)) @ middle
    return float(along @ values / np.sqrt(along @ covariance @ along))
