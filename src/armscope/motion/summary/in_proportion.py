"""Friction that is told as a curve of the speed though a straight line says it as well."""

from __future__ import annotations

from dataclasses import replace

from armscope.inference.problem import SelectedEffect
from armscope.inference.search import Search
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.library import catalogue
from armscope.verdict.effects import INDISTINGUISHABLE_NATS


def rather_in_proportion(selected: SelectedCauses) -> SelectedCauses:
    """The selection with viscous friction in the place of curves that hold it and that rows hardly tell from it.

    Where friction is stated, a curve of the speed has the straight line as one of its numbers. Of two names that fit
    alike, the one of fewer numbers is told, whichever the search met first.

    Args:
        selected: a selection, all of whose names can stand.

    Returns:
        It, or the selection itself where every curve is a curve.
    """
    layout, best, search = selected.rows.layout, selected.best, Search.on(selected.problem)
    lines = {each.joints: n for n, each in enumerate(layout.placed) if each.cause is catalogue.VISCOUS}
    for effect in best.chosen:
        placed = layout.placed[effect.candidate]
        straight = placed.cause is catalogue.VISCOUS_CURVE and ("viscous" in dict(placed.parameters))
        if not straight or placed.joints not in lines:
            continue
        others = tuple(each for each in best.chosen if each is not effect)
        tried = [
            search.evaluated((*others, SelectedEffect(lines[placed.joints], size)), best)
            for size in range(len(selected.problem.sizes))
        ]
        line = max(tried, key=lambda each: each.log_posterior)
        if best.log_posterior - line.log_posterior < INDISTINGUISHABLE_NATS:
            best = line
    return selected if best is selected.best else replace(selected, best=best)
