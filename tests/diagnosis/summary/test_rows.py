"""What a verdict holds of the rows: bad shots, what is left of each, and a model that holds for other rows."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from armscope.diagnosis import Settings, diagnose
from armscope.diagnosis.summary import rows
from armscope.measurement.constants import WEIGHTS
from armscope.physics.effect import Part
from armscope.physics.freeform import UNKNOWN
from armscope.physics.geometric import background as geometry_everywhere
from armscope.physics.model import Base, FittedModel, predict
from armscope.physics.wander import is_of_rows
from armscope.recordings import Recordings
from armscope.verdict.diagnosis import Diagnosis
from armscope.verdict.schema import NO_BAD_SHOTS, ROWS_LEFT_OUT, HeldOut
from tests.diagnosis.planted import one_run, recorded
from tests.physics.scenes import arm_named

QUICK = Settings(resamples=0, cross_validation=False)
NOISE_MM = 0.02
BAD = {"7": 0.8, "31": 2.0, "90": 1.2}
"""Bad shots: by their row's id, how far away they were taken, mm."""


@pytest.fixture(scope="module")
def verdict() -> Diagnosis:
    """A base that wanders in the order of the rows (no time is recorded), and three bad shots."""
    arm = arm_named("six-axis")
    table = recorded(arm, one_run(arm, 120, 5), {}, NOISE_MM, 5)
    positions = table.positions.copy()
    positions[:, 0] += 2e-4 * np.sin(np.linspace(0, 1.5 * np.pi, 120))
    for row, far in BAD.items():
        positions[list(table.id).index(row), 2] += far * 1e-3
    return diagnose(arm, replace(table, time=None, temperature=None, positions=positions), QUICK)


def test_bad_shots_are_listed_by_their_ids_the_farthest_first(verdict: Diagnosis) -> None:
    assert [row.id for row in verdict.suspects] == ["31", "90", "7"]
    assert [row.residual_mm for row in verdict.suspects] == pytest.approx([2.0, 1.2, 0.8], abs=5 * NOISE_MM)
    assert all(row.weight < WEIGHTS.inlier_weight for row in verdict.suspects)


def test_what_remains_is_that_of_the_trusted_rows(verdict: Diagnosis) -> None:
    trusted = verdict.residuals.weight > WEIGHTS.inlier_weight
    assert verdict.residual_after_mm == pytest.approx(np.sqrt(np.mean(verdict.residuals.after[trusted] ** 2)))
    assert verdict.residual_after_mm < 1.5 * NOISE_MM
    assert verdict.rows == 120
    assert verdict.runs == ("1",)
    assert verdict.orientations is None


def test_the_model_to_predict_with_holds_what_its_promise_counts(verdict: Diagnosis) -> None:
    """A wander in the order of rows was in the promised error, and not in the file: 0.04 mm were 0.16 mm."""
    assert any(is_of_rows(part.placed) for part in verdict.model.background)
    table = verdict.recordings
    trusted = verdict.residuals.weight > WEIGHTS.inlier_weight
    left = 1e3 * (predict(verdict.model, table) - table.positions)[trusted]
    assert np.sqrt(np.mean(left**2)) == pytest.approx(verdict.residual_after_mm, rel=0.01)


def test_poses_of_now_find_the_wander_where_the_last_row_left_it(verdict: Diagnosis) -> None:
    table = verdict.recordings
    nobody_knows, last = (replace(table, number=np.full(len(table), n)) for n in (np.nan, table.number[-1]))
    of_now = predict(verdict.model, nobody_knows)
    np.testing.assert_allclose(of_now, predict(verdict.model, last), atol=1e-9)
    moved = of_now - predict(verdict.model, replace(table, number=np.full(len(table), table.number[40])))
    assert 1e3 * np.abs(moved.mean(axis=0)[0]) > 0.25  # from one end of the wave to the other it is 0.4 mm


def _with_a_curve(background: bool) -> tuple[FittedModel, Recordings]:
    """A curve of joint 2 whose constant is far larger than its waves, beside small errors of geometry or none."""
    arm = arm_named("six-axis")
    table = one_run(arm, 80, 3)
    curve = next(p for p in UNKNOWN.place(arm, table) if (p.location, p.variant) == ("joint 2", "angle"))
    values = np.random.default_rng(4).normal(0, 2e-4, len(curve.terms))
    values[0] = 6e-3
    link = next(p for p in geometry_everywhere(arm) if p.location == "link 3")
    small = (Part(link, np.full(len(link.terms), 1e-4)),) if background else ()
    model = FittedModel(arm, {run: Base(np.eye(3), np.zeros(3)) for run in np.unique(table.run)})
    return replace(model, parts=(Part(curve, values),), background=small), table


def test_the_mean_of_a_curve_is_the_joints_zero_and_predicts_the_same() -> None:
    model, table = _with_a_curve(background=True)
    told = rows._to_predict(model, table)
    np.testing.assert_allclose(predict(told, table), predict(model, table), atol=1e-12)
    (turned,) = model.scene(table).amounts(model.parts).values()
    (shape,) = told.scene(table).amounts(told.parts).values()
    np.testing.assert_allclose(shape, turned - turned.mean(), atol=1e-15)
    zero = told.background[-1]
    assert (zero.placed.family, zero.placed.location) == ("geometric", "joint 2")
    assert zero.values == pytest.approx([turned.mean()])


def test_without_small_errors_of_geometry_a_curve_keeps_its_mean() -> None:
    model, table = _with_a_curve(background=False)
    told = rows._to_predict(model, table)
    assert not told.background
    np.testing.assert_array_equal(told.parts[0].values, model.parts[0].values)


@pytest.mark.parametrize(("out", "with_them", "told"), [(12, 0.3, True), (12, 0.06, False), (3, 0.3, False)])
def test_what_many_rows_that_fit_nothing_make_of_the_promise_is_told(out: int, with_them: float, told: bool) -> None:
    """0.05 mm were promised and 0.30 mm reached where 30 of 121 good rows had been taken for bad shots."""
    weight = np.r_[np.zeros(out), np.ones(100 - out)]
    fit = SimpleNamespace(weights=SimpleNamespace(robust_weight=weight))
    table = replace(one_run(arm_named("six-axis"), 100, 1), approach=None)
    held_out = HeldOut(before=0.4, after=0.05, before_all_rows=0.45, after_all_rows=with_them)
    found = rows.rows_left_out(SimpleNamespace(fit=fit, recordings=table), held_out)
    assert bool(found) == told
    if told:
        assert "12 of 100 rows fit none of this" in found[0].text
        assert "0.3 mm, not 0.05 mm" in found[0].text
        assert "play whose side was not recorded" in found[0].text


@pytest.mark.parametrize(("out", "kind"), [(8, ROWS_LEFT_OUT), (18, NO_BAD_SHOTS)])
def test_a_tenth_of_the_rows_may_be_bad_shots_and_a_fifth_is_in_the_promise(out: int, kind: str) -> None:
    weight = np.r_[np.zeros(out), np.ones(100 - out)]
    fit = SimpleNamespace(weights=SimpleNamespace(robust_weight=weight))
    table = replace(one_run(arm_named("six-axis"), 100, 1), approach=None)
    (notice,) = rows.rows_left_out(SimpleNamespace(fit=fit, recordings=table), HeldOut(0.4, 0.05, after_all_rows=0.3))
    assert notice.kind == kind
