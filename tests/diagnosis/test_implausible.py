"""What no arm can have is found by its fitted values: what gives way can't push, what is huge must show at the tool."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.core.types import unheard
from armscope.diagnosis import Settings, diagnose
from armscope.diagnosis.implausible import _pushing, _taken_back, more_plausible
from armscope.diagnosis.selection_loop import SelectionLoop
from armscope.fitting.registration import fit_frames
from armscope.inference.evidence import evaluate
from armscope.inference.problem import SelectedEffect
from armscope.measurement.noise import Noise
from armscope.physics.effect import Part
from armscope.physics.frames import free_frames
from armscope.robot.arm import build_arm

from ..backgrounds import sizes
from ..physics.scenes import arm_named
from .planted import Wanted, one_run, planted, recorded

ROWS = 100


def named(wanted: Wanted, nested: bool) -> tuple[SelectionLoop, int]:
    """A loop after one round on planted effects, its best hypothesis that has the first alone, and its candidate."""
    arm, table = planted("six-axis", wanted, ROWS, 0.02, seed=3)
    blocks = np.arange(ROWS) % 5
    loop = SelectionLoop(fit_frames(arm, table), table, Noise(0.0, 0.0, ""), free_frames(table, False), blocks, unheard)
    loop.round([sizes()])
    key = next(iter(wanted))
    (number,) = [n for n, p in enumerate(loop.space.placed) if p.key == key and not p.variant]
    loop.best = replace(loop.best, chosen=(SelectedEffect(number, 4, nested=nested),))
    return loop, number


@pytest.mark.parametrize(("compliance", "pushes"), [(2e-6, False), (-2e-6, True)])
def test_a_name_within_a_background_may_not_be_negative_where_it_gives_way(compliance: float, pushes: bool):
    loop, number = named({("joint_compliance", "joint 2"): [compliance]}, nested=True)
    fit = loop._fitted(loop.best)
    assert np.sign(fit.model.parts[0].values[0]) == np.sign(compliance)
    assert _pushing(loop.space, loop.best, fit) == ([number] if pushes else [])


@pytest.mark.parametrize(
    ("planted_ratio", "fitted_ratio", "is_none"),
    [
        (0.02, 0.02, False),  # another gear than the one stated: beyond what arms show, and seen
        (0.0005, 0.02, True),  # something else takes it back
        (0.0005, 0.002, False),  # may be taken back in part, but arms have it
    ],
)
def test_a_value_beyond_what_arms_show_is_no_name_where_the_tool_misses_by_less(
    planted_ratio: float, fitted_ratio: float, is_none: bool
):
    loop, number = named({("gear_ratio", "joint 5"): [planted_ratio]}, nested=False)
    fit = loop._fitted(loop.best)
    (part,) = fit.model.parts
    # as a fit leaves it beside gears' waves that are as large: their sum is what the rows hold
    told = replace(fit, model=replace(fit.model, parts=(Part(part.placed, np.array([fitted_ratio])),)))
    assert _taken_back(loop.problem, loop.space, loop.best, told) == ([number] if is_none else [])


def test_a_row_whose_length_another_row_tells_is_asked_by_the_terms_that_it_keeps() -> None:
    """Of parallel axes d is told once, so that a fitted row may have a term less than its candidate: that crashed."""
    loop, number = named({("link_geometry", "link 3"): [0.02, 0.0, 0.0]}, nested=False)
    fit = loop._fitted(loop.best)
    (part,) = fit.model.parts
    d = next(term for term in part.placed.terms if term.name == "d")
    less = part.placed.without({d})
    assert less is not None
    kept = np.array([term is not d for term in part.placed.terms])
    told = replace(fit, model=replace(fit.model, parts=(Part(less, part.values[kept]),)))
    assert Part(less, part.values[kept]).implausible
    assert _taken_back(loop.problem, loop.space, loop.best, told) == []
    far = replace(told, model=replace(told.model, parts=(Part(less, 50 * part.values[kept]),)))
    assert _taken_back(loop.problem, loop.space, loop.best, far) == [number]


@pytest.mark.parametrize(("joint", "gives_way"), [("joint 6", True), ("joint 3", False)])
def test_a_value_beyond_what_arms_show_gives_way_to_a_name_that_says_the_same(joint: str, gives_way: bool):
    """The zero of joint 6 hardly moves a tool on its axis: other names say as much. Nothing does of joint 3."""
    loop, number = named({("joint_offset", joint): [3e-4]}, nested=False)
    loop.best = evaluate(loop.problem, loop.best.chosen, loop.best.background, loop.best.noise)
    fit = loop._fitted(loop.best)
    (part,) = fit.model.parts
    told = replace(fit, model=replace(fit.model, parts=(Part(part.placed, np.array([0.075])),)))
    other, fitted = more_plausible(loop.problem, loop.best, told, loop._fitted)
    assert (number not in other.candidates) == gives_way
    assert bool(fitted.model.parts[0].implausible) != gives_way
    assert more_plausible(loop.problem, loop.best, fit, loop._fitted) == (loop.best, fit)


@pytest.mark.long
def test_two_rows_that_are_wrong_by_the_same_are_named_though_each_moves_more_than_is_missed():
    """An offset that belongs to one row, stated on the next: each alone would move the tool by more than it misses."""
    arm = arm_named("parallelogram-120kg")
    rows = list(arm.description.dh.joints)
    for row, more_mm in ((3, 36.0), (4, -36.0)):
        rows[row] = rows[row].model_copy(update={"a_mm": rows[row].a_mm + more_mm})
    dh = arm.description.dh.model_copy(update={"joints": rows})
    true = build_arm(arm.description.model_copy(update={"dh": dh}))
    table = recorded(true, one_run(true, 250, 4), {}, 0.02, 4)
    verdict = diagnose(arm, table, Settings(resamples=0, cross_validation=False))
    assert {(e.effect, e.location) for e in verdict.effects} == {
        ("link_geometry", "link 4"),
        ("link_geometry", "link 5"),
    }
    assert verdict.residual_after_mm < 0.03
    assert "far beyond what arms show" in verdict.headline
    assert not [word for word in ("36", "length") if word in verdict.headline]
