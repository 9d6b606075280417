"""A curve of the angle that pulls one way all over the range is an offset; one that rests within it is a cable."""

from __future__ import annotations

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.inference.problem import SelectedEffect
from armscope.inference.search import Search
from armscope.motion.fitting.hoses import offsets_for_cables
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.library import catalogue
from armscope.motion.pipeline import MotionSettings, diagnose_motion
from tests.motion.moving import moved, robot

OFFSET, LITTLE = 1.0, 0.02
"""N m that joint 2 reads too much, and N m that follow its angle beside."""


def selected_where(offset: float, hose: float) -> SelectedCauses:
    """What is chosen where joint 2 reads too much, and a hose pulls by so much (RMS) that rests in the middle."""

    def planted(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
        extra, turned = np.zeros_like(q), q[:, 1] - q[:, 1].mean()
        pull = 0.4 * turned + turned**3
        extra[:, 1] = offset + hose * (pull - pull.mean()) / pull.std()
        return extra

    return diagnose_motion(robot(), moved(robot(), 3, planted), MotionSettings(cutoff=10.0)).selected


def names(selected: SelectedCauses, chosen: tuple[SelectedEffect, ...]) -> list[str]:
    return [selected.rows.layout.placed[each.candidate].cause.name for each in chosen]


def test_a_curve_that_pulls_one_way_all_over_is_an_offset() -> None:
    """It says a little more than the offset does, and less than a second name would have to."""
    selected = selected_where(OFFSET, LITTLE)
    placed, search = selected.rows.layout.placed, Search.on(selected.problem)
    (offset,) = [n for n in selected.best.candidates if placed[n].cause is catalogue.OFFSET]
    rest = search.without(selected.best, [offset])
    cables = [n for n, each in enumerate(placed) if each.cause is catalogue.CABLE and each.joints == (1,)]
    for cable in cables:
        sizes = range(len(selected.problem.sizes))
        tried = [search.evaluated((*rest.chosen, SelectedEffect(cable, size)), rest) for size in sizes]
        curve = max(tried, key=lambda each: each.log_posterior)
        told = offsets_for_cables(search, curve, placed)
        assert offset in told.candidates
        assert cable not in told.candidates


@pytest.mark.parametrize("hose", [0.5, 2.0])
def test_a_hose_that_rests_within_the_range_stays_one(hose: float) -> None:
    selected = selected_where(0.0, hose)
    (chosen,) = selected.best.chosen
    assert names(selected, (chosen,)) == ["cable_torque"]
    search = Search.on(selected.problem)
    assert offsets_for_cables(search, selected.best, selected.rows.layout.placed) is selected.best


def test_what_is_worth_a_name_beside_the_offset_keeps_the_curve() -> None:
    selected = selected_where(OFFSET, 0.5)
    assert names(selected, selected.best.chosen) == ["cable_torque"]
