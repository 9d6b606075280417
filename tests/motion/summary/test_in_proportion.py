"""Friction that a straight line says as well is told as that; friction that bends is not."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.inference.edits import by_posterior
from armscope.inference.problem import SelectedEffect
from armscope.inference.search import Search
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.library import catalogue
from armscope.motion.pipeline import MotionSettings, diagnose_motion
from armscope.motion.summary.in_proportion import rather_in_proportion
from tests.motion.moving import COULOMB, ROTOR, VISCOUS, moved, robot
from tests.seeds import seeds

JOINT = 1
DRIVES = [
    {"coulomb_nm": float(c), "viscous_nm_s_rad": float(v), "rotor_inertia_kg_m2": float(r)}
    for c, v, r in zip(COULOMB, VISCOUS, ROTOR, strict=True)
]


def beside(power: float, seed: int) -> SelectedCauses:
    """Of an arm whose friction is stated, and grows beyond it with that power of the speed at one joint."""

    def plant(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
        return np.asarray(2.0 * np.sign(dq) * np.abs(dq) ** power * (np.arange(3) == JOINT))

    return diagnose_motion(robot(drives=DRIVES), moved(robot(), seed, plant), MotionSettings(cutoff=10.0)).selected


def with_a_curve(selected: SelectedCauses) -> SelectedCauses:
    """With the likeliest curve that holds a line, in the place of whatever friction is named at the joint."""
    layout, best, search = selected.rows.layout, selected.best, Search.on(selected.problem)
    kept = [each for each in best.chosen if layout.placed[each.candidate].joints != (JOINT,)]
    curves = [
        n
        for n, each in enumerate(layout.placed)
        if each.cause is catalogue.VISCOUS_CURVE and each.joints == (JOINT,) and "viscous" in dict(each.parameters)
    ]
    tried = [search.with_best_sizes(search.evaluated((*kept, SelectedEffect(n, 0)), best)) for n in curves]
    return dataclasses.replace(selected, best=max(tried, key=by_posterior))


def names(selected: SelectedCauses) -> list[str]:
    return [str(selected.rows.layout.placed[n]) for n in selected.best.candidates]


@pytest.mark.parametrize("seed", seeds(3, 4))
def test_what_a_line_says_as_well_is_a_line(seed: int) -> None:
    selected = beside(1.0, seed)
    assert names(selected) == [f"viscous friction at joint {JOINT + 1}"]
    curved = with_a_curve(selected)
    assert names(curved) == [f"viscous curve at joint {JOINT + 1}"]
    assert names(rather_in_proportion(curved)) == names(selected)


@pytest.mark.parametrize("seed", seeds(3, 4))
def test_what_bends_is_a_curve(seed: int) -> None:
    curved = with_a_curve(beside(2.2, seed))
    assert rather_in_proportion(curved) is curved
