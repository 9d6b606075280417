"""Gains of drives that come out far from what is stated: each has its name, which the share of all gains hides.

Gains are held near the stated ones by their own uncertainty, without a price. One that lies several times as far off
is fitted all the same, and whoever enters the causes into a simulator but not that gain makes it worse.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from armscope.inference.problem import SelectedEffect
from armscope.inference.search import Search
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.fitting.selection import at_own_gain
from armscope.motion.library import catalogue
from armscope.motion.summary.constants import NAMING


def with_gains_that_stand_out(selected: SelectedCauses) -> SelectedCauses:
    """The selection with names for gains that lie beyond their stated uncertainty.

    Args:
        selected: a selection, all of whose names can stand.

    Returns:
        The same fit, with these gains free; itself where none stands out, or none is stated.
    """
    layout, best = selected.rows.layout, selected.best
    if not layout.with_gains:
        return selected
    fitted, stated = selected.coefficients[layout.gains], layout.arm.gain_uncertainty
    far = np.flatnonzero(np.abs(fitted) > NAMING.beyond_gains * np.where(np.isnan(stated), np.inf, stated))
    named, joints = [], []
    for number, (placed, columns) in enumerate(zip(layout.placed, layout.columns, strict=True)):
        if placed.cause is catalogue.GAIN and placed.joints[0] in far and number not in best.candidates:
            own = abs(fitted[placed.joints[0]]) * selected.problem.scale[columns[0]]
            named.append(SelectedEffect(number, selected.problem.nearest_size(float(own)), nested=True))
            joints.append(placed.joints[0])
    if not named:
        return selected
    problem = selected.problem.holding(layout.gains[joints])
    freed = Search.on(problem).evaluated((*best.chosen, *named), best)
    return at_own_gain(replace(selected, space=problem.space, problem=problem, best=freed))
