"""What hangs at the last link in the place of that link's own weight: people load an arm, and seldom change its links.

Both move together, and where the load's centre lies no motion tells them apart by much. A search that has struck out a
load beside a link's mass, as one that takes back the other, never asks for the load alone.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from armscope.inference.evidence import Hypothesis
from armscope.inference.problem import SelectedEffect
from armscope.inference.search import Search
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.library import catalogue
from armscope.motion.summary.constants import INTERVALS, NAMING
from armscope.motion.summary.unnamed_masses import is_of_masses
from armscope.verdict.effects import INDISTINGUISHABLE_NATS, INTERVAL


def rather_carried(selected: SelectedCauses) -> SelectedCauses:
    """The selection with a load in the place of a last link that is heavier than stated, where it fits about as well.

    A link that is heavier by a tenth may be; one that weighs eight times what is stated is another one. By so much
    the load may fit worse. Of loads that rows don't tell apart, the one beside the fewest names.

    Args:
        selected: a selection.

    Returns:
        It, or the selection itself where no link that carries the load is heavier, or the link fits clearly better.
    """
    heavier = _how_much_heavier(selected)
    if heavier < INTERVALS.link_known:
        return selected
    tried = list(_with_a_load(selected))
    least = max((each.log_posterior for each in tried), default=-np.inf) - INDISTINGUISHABLE_NATS
    alike = [each for each in tried if each.log_posterior >= least]
    best = min(alike, key=lambda each: (len(each.chosen), -each.log_posterior), default=None)
    most = INDISTINGUISHABLE_NATS + (heavier / NAMING.another_link[0]) ** 2 / 2
    if best is None or selected.best.log_posterior - best.log_posterior > most:
        return selected
    return replace(selected, best=best)


def _how_much_heavier(selected: SelectedCauses) -> float:
    """Share by which a name says that the last link is heavier; 0 where none does."""
    layout = selected.rows.layout
    link = layout.arm.n_links
    for number in selected.best.candidates:
        placed = layout.placed[number]
        if placed.cause is catalogue.LINK_MASS and placed.location == f"link {link}" and not placed.runs:
            stated = float(layout.arm.inertial[10 * link - 10])
            return max(float(selected.coefficients[layout.columns[number][0]]) / stated, 0.0) if stated > 0 else 0.0
    return 0.0


def _with_a_load(selected: SelectedCauses) -> Iterator[Hypothesis]:
    """A load of every form and size in the place of the last link's names, and of all names of masses.

    One whose mass is not determined says no more than that the link is otherwise than stated.
    """
    layout, best, search = selected.rows.layout, selected.best, Search.on(selected.problem)
    loads = [n for n, each in enumerate(layout.placed) if each.cause is catalogue.PAYLOAD and not each.runs]
    link, families = f"link {layout.arm.n_links}", [family.name for family in selected.space.families]
    masses, gains = families.index("masses"), families.index("gains")
    of_masses = {each for each in best.chosen if is_of_masses(layout.placed[each.candidate])}
    at_last = {each for each in of_masses if layout.placed[each.candidate].location in (link, "payload")}
    for gone in [at_last] if at_last == of_masses else [at_last, of_masses]:
        kept = [each for each in best.chosen if each not in gone]
        for number in loads:
            for of_gains in {best.background[gains], 1}:
                background = list(best.background)
                background[masses], background[gains] = 0, of_gains
                sizes = range(len(selected.problem.sizes))
                tried = [
                    search.evaluated([*kept, SelectedEffect(number, size)], best, tuple(background)) for size in sizes
                ]
                found = search.with_best_sizes(max(tried, key=lambda each: each.log_posterior))
                if _is_determined(found, layout.columns[number][0]):
                    yield found


def _is_determined(best: Hypothesis, mass: int) -> bool:
    """Whether a load has a mass, known to much less than itself; in the problem's units."""
    column = np.array([mass])
    return bool(NAMING.determined * best.means(column)[0] > INTERVAL * np.sqrt(best.variances(column)[0]))
