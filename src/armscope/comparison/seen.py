"""How far the zero of a joint must move to be seen."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.special import nctdtrinc, stdtrit

from armscope.comparison.constants import COMPARING, SHARED
from armscope.comparison.dispersion import Possible
from armscope.comparison.result import Seen
from armscope.comparison.scoring import numbers_behind
from armscope.comparison.shared_model import SharedModel
from armscope.core.types import Array
from armscope.physics.geometric import JOINT_OFFSET


def seen(model: SharedModel, possible: Sequence[Possible], found: Sequence[Possible]) -> tuple[Seen, ...]:
    """How far the zero of each joint must move to be seen, whichever of the recordings it moves in.

    Args:
        model: what recordings share.
        possible: all changes that are tried.
        found: what changed, and is no noise.

    Returns:
        One for each joint.
    """
    zeros = [each for each in possible if each.placed.effect is JOINT_OFFSET]
    if not zeros:
        return ()
    least: dict[str, float] = {}
    sizes = _smallest(model, zeros, COMPARING.level / len(possible), found)
    for each, size in zip(zeros, sizes, strict=True):
        least[each.placed.location] = max(float(size), least.get(each.placed.location, 0.0))
    return tuple(Seen(location, size) for location, size in least.items())


def _smallest(model: SharedModel, zeros: Sequence[Possible], level: float, found: Sequence[Possible]) -> Array:
    """(n,) rad, of zeros each alone beside all that is shared; infinite where the rows tell nothing of it."""
    base = model.base(())
    variance, free = model.left(model.base(found))
    columns = np.column_stack([model.columns(each)[:, 0] for each in zeros])
    square = np.array([model.size(each)[0] ** 2 for each in zeros])
    beyond = base.beyond(columns)
    information = np.sum(columns * beyond, axis=0)
    usual = np.array([each.plausible[0] for each in zeros])
    unseen = (square <= variance / usual**2) | (base.fixed.information(columns).diagonal() <= SHARED.unseen * square)
    # F of one number is the square of t, of which a change makes a noncentral one
    known = numbers_behind(base, beyond, free, model.own) - 1
    least = nctdtrinc(known, 1 - COMPARING.power, stdtrit(known, 1 - level / 2))
    return np.where(unseen, np.inf, least * np.sqrt(model.dispersion * variance / np.where(unseen, 1, information)))
