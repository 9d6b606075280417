"""Gains of drives that come out far from what is stated: each has its name, which the share of all gains hides.

Gains are held near the stated ones by their own uncertainty, without a price. One that lies several times as far off
is fitted all the same, and whoever enters the causes into a simulator but not that gain makes it worse. Where no
uncertainty is stated, a gain far off is no less: there the motion itself says how sure it is. What is left without a
name is told by the factor that it asks for.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

import numpy as np

from armscope.core.types import Array
from armscope.inference.edits import by_posterior
from armscope.inference.problem import SelectedEffect
from armscope.inference.search import Search
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.fitting.selection import at_own_gain
from armscope.motion.fitting.space import OF_MASSES
from armscope.motion.library import catalogue
from armscope.motion.library.laws import is_of_a_gain
from armscope.motion.library.layout import TorqueLayout
from armscope.motion.summary.constants import HELD_OUT, NAMING
from armscope.motion.summary.doubts import determined
from armscope.motion.summary.intervals import sureness
from armscope.motion.summary.judgement import cause_parameters
from armscope.motion.verdict import MotionVerdict
from armscope.verdict.schema import Notice
from armscope.verdict.wording import capitalised

FITTED_GAINS = "fitted gains"
"""Kind of the notice that gains without a name are part of the model."""


def with_gains_that_stand_out(selected: SelectedCauses) -> SelectedCauses:
    """The selection with names for gains beyond their stated uncertainty, or clearly off where none is stated.

    Where masses are off, too, without a name, a gain of no stated uncertainty is fitted along: it has no name.

    Args:
        selected: a selection, all of whose names can stand.

    Returns:
        The same fit, with these gains free; itself where none stands out.
    """
    selected = with_named_gains_alone(selected)
    layout = selected.rows.layout
    if not layout.with_gains:
        return selected
    off, stated = np.abs(selected.coefficients[layout.gains]), layout.arm.gain_uncertainty
    far = {int(j) for j in np.flatnonzero(off > NAMING.beyond_gains * np.where(np.isnan(stated), np.inf, stated))}
    clearly = np.isnan(stated) & (off > NAMING.gain_that_matters) & (not _masses_are_free(selected))
    unstated = {int(j) for j in np.flatnonzero(clearly)}
    freed, named = _freed(selected, far | unstated)
    if not unstated & named.keys():
        return freed
    sure = sureness(freed)
    asked = unstated & named.keys()
    loose = {j for j in asked if not determined(cause_parameters(freed, named[j], sure.factor))}
    return _freed(selected, (far | unstated) - loose)[0] if loose else freed


def with_named_gains_alone(selected: SelectedCauses) -> SelectedCauses:
    """The selection in which a gain that has a name has no part without one: they are one column twice.

    What is fitted along would take the named gain up wherever that is cured by itself, so that a motor constant 15 %
    off was worth nothing and stood at the end. Without it a plain gain may do where a curve of the torque was chosen.
    """
    layout, best = selected.rows.layout, selected.best
    named = {n: layout.placed[n].joints[0] for n in best.candidates if is_of_a_gain(layout.placed[n].columns)}
    unnamed = np.intersect1d(layout.gains[sorted(set(named.values()))], best.columns)
    if not len(unnamed):
        return selected

    def of_all_of_it(effect: SelectedEffect) -> SelectedEffect:
        if effect.candidate not in named:
            return effect
        column = layout.columns[effect.candidate][0]
        whole = selected.coefficients[column] + selected.coefficients[layout.gains[named[effect.candidate]]]
        size = selected.problem.nearest_size(float(abs(whole)) * selected.problem.scale[column])
        return replace(effect, size=size)

    problem = selected.problem.holding(unnamed)
    search, chosen = Search.on(problem), tuple(map(of_all_of_it, best.chosen))
    alone = search.evaluated(chosen, best)
    for effect in chosen:
        for plain in _gains_of(layout, named.get(effect.candidate, -1)):
            others = [each for each in alone.chosen if each.candidate not in (effect.candidate, plain)]
            straight = search.evaluated((*others, replace(effect, candidate=plain)), alone)
            alone = max(alone, straight, key=by_posterior)
    return at_own_gain(replace(selected, space=problem.space, problem=problem, best=alone))


def _gains_of(layout: TorqueLayout, joint: int) -> list[int]:
    """The numbers of the causes that are a joint's plain gain: one, or none."""
    return [n for n, each in enumerate(layout.placed) if each.cause is catalogue.GAIN and each.joints[0] == joint]


def _masses_are_free(selected: SelectedCauses) -> bool:
    """Whether masses are off without a name: a joint's gain is then known no better than the masses that it holds."""
    sizes = zip(selected.space.families, selected.best.background, strict=True)
    return any(size > 0 for family, size in sizes if family.name in OF_MASSES)


def _freed(selected: SelectedCauses, joints: Collection[int]) -> tuple[SelectedCauses, dict[int, int]]:
    """The selection with the gains of some joints free under their names, and the numbers of these by joint."""
    layout, best = selected.rows.layout, selected.best
    named: dict[int, SelectedEffect] = {}
    for number, (placed, columns) in enumerate(zip(layout.placed, layout.columns, strict=True)):
        if placed.cause is catalogue.GAIN and placed.joints[0] in joints and number not in best.candidates:
            own = abs(selected.coefficients[layout.gains[placed.joints[0]]]) * selected.problem.scale[columns[0]]
            size = selected.problem.nearest_size(float(own))
            named[placed.joints[0]] = SelectedEffect(number, size, nested=True)
    if not named:
        return selected, {}
    problem = selected.problem.holding(layout.gains[list(named)])
    freed = Search.on(problem).evaluated((*best.chosen, *named.values()), best)
    found = at_own_gain(replace(selected, space=problem.space, problem=problem, best=freed))
    return found, {joint: effect.candidate for joint, effect in named.items()}


def told_gains(selected: SelectedCauses) -> list[Notice]:
    """What is to be entered for gains that are part of the model without a name, where they matter."""
    layout = selected.rows.layout
    gains = selected.coefficients[layout.gains]
    if np.max(np.abs(gains), initial=0.0) < NAMING.gain_that_matters:
        return []
    known = ", within what is known of them" if layout.with_gains else " by a factor each"
    text = (
        f"{capitalised(layout.of_gains)} are fitted along{known}, and the model holds only with these: "
        f"{factors_in_words(gains, layout.with_gains)}"
    )
    return [Notice(FITTED_GAINS, text)]


def rests_on_gains(verdict: MotionVerdict) -> bool:
    """Whether gains without a name, and no masses beside them, mend clearly more than friction and rotors do alone."""
    before, along = (verdict.waterfall[0], *verdict.waterfall[1:2], verdict.waterfall[0])[:2]
    return "masses" not in along.label and along.held_out < HELD_OUT.clearly_better * before.held_out


def factors_in_words(gains: Array, by_currents: bool = True) -> str:
    """What to do about gains without a name; empty where all are as stated.

    Args:
        gains: (m,) shares by which recorded torque exceeds the true one; 0 of those that have a name.
        by_currents: whether torques come from currents.

    Returns:
        A sentence or nothing.
    """
    what = "torque constants, and so the recorded torques," if by_currents else "the recorded torques"
    factors = [f"{1 / (1 + gain):.3f} (joint {j})" for j, gain in enumerate(gains, start=1)]
    told = [each for each in factors if not each.startswith("1.000 ")]
    return f"multiply {what} by {', '.join(told)}." if told else ""
