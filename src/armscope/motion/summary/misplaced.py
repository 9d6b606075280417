"""Masses that are off without a name and leave more at a joint than masses as stated do: they say what is elsewhere.

Torque that one joint's reading takes from another's looks like masses. Beside these the other joint is met badly, which
counts as noise that lasts, and so for nothing: evidence asks for such masses all the more, and what has no law is told
at the joint that is in order.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from armscope.inference.search import Search
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.fitting.selection import at_own_gain, chosen
from armscope.motion.fitting.space import OF_MASSES, without_backgrounds
from armscope.motion.summary.constants import HELD_OUT


def without_misplaced_masses(selected: SelectedCauses) -> SelectedCauses:
    """The selection with masses as stated, weighed by what it leaves then, where that is clearly less at some joint.

    It has the same names. Those that hid such masses, as the other half of what they say, may have gone just before.
    """
    stated = _as_stated(selected)
    if stated is None:
        return selected
    moves = selected.weights.row > 0
    left, of_stated = (np.sum(moves * each.residuals**2, axis=0) for each in (selected, stated))
    if not np.any(left > HELD_OUT.leaves_more * of_stated):
        return selected
    before = stated.best, stated.best.chosen
    again = chosen(stated.rows, stated.noise, stated.block, stated.space, before, stated)
    return at_own_gain(replace(again, best=Search.on(again.problem).evaluated(stated.best.chosen, again.best)))


def _as_stated(selected: SelectedCauses) -> SelectedCauses | None:
    """The same names beside masses as stated; None where they are as stated already."""
    best, families = selected.best, [family.name for family in selected.space.families]
    sizes = tuple(0 if name in OF_MASSES else size for name, size in zip(families, best.background, strict=True))
    if sizes == best.background:
        return None
    stated = Search.on(selected.problem).evaluated(best.chosen, best, sizes)
    return replace(selected, space=without_backgrounds(selected.space, OF_MASSES), best=stated)
