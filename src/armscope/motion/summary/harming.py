"""Names beside which motion that took no part is worse foretold than without them: no cause does that.

What is written into the torque of two joints, say, may fit the one of little noise and spoil the other of large torque.
Evidence on the motion that was fitted, in units of noise, does not see it; the error that is told does.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from armscope.inference.problem import SelectedEffect
from armscope.inference.search import Search
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.fitting.selection import at_own_gain
from armscope.motion.library import catalogue
from armscope.motion.summary.constants import HELD_OUT
from armscope.motion.summary.holding_out import Fold
from armscope.motion.summary.intervals import Sureness, sureness
from armscope.motion.summary.misplaced import without_misplaced_masses
from armscope.motion.summary.step_by_step import error_with


def without_what_harms(
    selected: SelectedCauses, sure: Sureness, parts: Sequence[Fold]
) -> tuple[SelectedCauses, Sureness]:
    """The selection without names that make motion which took no part worse, where all together do.

    Not of what is there in some runs alone, or rings where a run stops: other motion never has it.

    Args:
        selected: the selection.
        sure: how far it can be trusted.
        parts: what is held out.

    Returns:
        Both, as they are where names help all together.
    """
    best, placed = selected.best, selected.rows.layout.placed

    def error(chosen: Sequence[SelectedEffect]) -> float:
        return error_with(parts, replace(best, chosen=tuple(chosen)))

    def may_go(effect: SelectedEffect) -> bool:
        cause = placed[effect.candidate]
        return not cause.runs and cause.cause is not catalogue.ROCKING_BASE

    kept = list(best.chosen)
    others = [each for each in kept if not may_go(each)]
    if len(others) == len(kept) or error(others) > HELD_OUT.any_better * (found := error(kept)):
        return selected, sure
    while removable := [each for each in kept if may_go(each)]:
        without = [error([each for each in kept if each is not gone]) for gone in removable]
        least = int(np.argmin(without))
        if without[least] > found:
            break
        kept.remove(removable[least])
        found = without[least]
    search = Search.on(selected.problem)
    selected = at_own_gain(replace(selected, best=search.evaluated(tuple(kept), best)))
    selected = without_misplaced_masses(selected)
    return selected, sureness(selected)
