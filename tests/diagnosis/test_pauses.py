"""A base that drifts while nobody notes the time: one name, whatever pauses there were; a jump stays a jump."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.diagnosis.pipeline import Settings, diagnose
from armscope.physics.drift import Pause, base_shift, drift_with_pauses, pauses_of
from armscope.physics.registry import library
from armscope.physics.scene import Scene

from ..physics.scenes import arm_named
from .planted import one_run, recorded

QUICK = Settings(resamples=0, cross_validation=False)
ROW_S, ROWS = 30.0, 120
DRIFT = [2e-4, -1e-4, 5e-5, 1e-4, -2e-4, 1.5e-4]
"""Per hour, m and rad."""


def timed(arm, pauses, seed):
    """A table in which every row takes 30 s, and more before the given rows."""
    table = one_run(arm, ROWS, seed)
    steps = np.full(ROWS, ROW_S)
    for row, seconds in pauses.items():
        steps[row - 1] += seconds
    return replace(table, time=np.cumsum(steps), temperature=np.full(ROWS, 20.0))


def drift_in(verdict):
    return next(p for p in (part.placed for part in verdict.model.parts) if p.name == "base_drift")


@pytest.mark.long
@pytest.mark.parametrize(
    ("pauses", "seed"), [pytest.param({61: 2400.0}, 3, marks=pytest.mark.long), ({41: 1800.0, 90: 1500.0}, 4)]
)
def test_a_drift_with_pauses_is_one_drift_where_the_time_is_not_told(pauses, seed):
    arm = arm_named("six-axis")
    told = recorded(arm, timed(arm, pauses, seed), {("base_drift", "base"): DRIFT}, 0.02, seed)
    verdict = diagnose(arm, replace(told, time=None), QUICK)
    assert [effect.effect for effect in verdict.effects] == ["base_drift"]
    found = pauses_of(drift_in(verdict))
    assert [pause.row for pause in found] == list(pauses)
    for pause, seconds in zip(found, pauses.values(), strict=True):
        assert pause.rows == pytest.approx(seconds / ROW_S, rel=0.2)
    assert str(next(iter(pauses))) in verdict.effects[0].driver


@pytest.mark.long
def test_a_drift_without_pauses_has_none():
    arm = arm_named("four-axis")
    told = recorded(arm, timed(arm, {}, 5), {("base_drift", "base"): DRIFT}, 0.02, 5)
    verdict = diagnose(arm, replace(told, time=None), QUICK)
    assert [effect.effect for effect in verdict.effects] == ["base_drift"]
    assert pauses_of(drift_in(verdict)) == []


@pytest.mark.long
@pytest.mark.parametrize("way", [pytest.param([-1] * 6, marks=pytest.mark.long), [1, 2, -2, 1, 1, -1]])
def test_a_jump_that_goes_another_way_than_the_drift_stays_a_jump(way):
    """Back where the drift came from, or aside: no pause does that."""
    arm = arm_named("four-axis")
    told = recorded(arm, timed(arm, {}, 6), {("base_drift", "base"): DRIFT}, 0.02, 6)
    posture, jump = Scene(arm, told).posture(), np.multiply(way, DRIFT)
    moved = sum(v * posture.column(term) for v, term in zip(jump, base_shift(told, 70, 1).terms, strict=True))
    verdict = diagnose(arm, replace(told, positions=told.positions + moved, time=None), QUICK)
    assert {effect.effect for effect in verdict.effects} == {"base_drift", "base_shift"}
    assert pauses_of(drift_in(verdict)) == []


def test_pauses_make_the_order_of_rows_the_time():
    arm = arm_named("six-axis")
    pauses = {41: 1800.0, 90: 1500.0}
    table = timed(arm, pauses, 7)
    by_time = next(p for p in library(arm, table) if p.name == "base_drift")
    untold = replace(table, time=None)
    by_rows = drift_with_pauses([Pause(float(row), "1", s / ROW_S) for row, s in pauses.items()], 2)
    hours, rows = Scene(arm, table).posture(), Scene(arm, untold).posture()
    for one, other in zip(by_time.terms, by_rows.terms, strict=True):
        # a constant between them is the base's own place
        ratio = 1000 * ROW_S / 3600
        off = hours.column(one) - ratio * rows.column(other)
        still = rows.displacement(one.products[0].direction)
        np.testing.assert_allclose(off, off[0].sum() / still[0].sum() * still, atol=1e-12)
