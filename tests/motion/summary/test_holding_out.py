"""Errors on held-out motion that a work order promises: only numbers that a simulator takes are entered."""

from __future__ import annotations

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.inference.evidence import evaluate
from armscope.motion.library.layout import OWN
from armscope.motion.pipeline import MotionSettings, diagnose_motion
from armscope.motion.summary.entering import as_entered
from armscope.motion.summary.holding_out import coefficients_of, folds
from armscope.recordings.motions import as_motions
from tests.motion.fitting.test_pauses import from_point_to_point
from tests.motion.moving import COULOMB, moved, robot
from tests.seeds import seeds

JOINT = 1
LOAD = {"mass_kg": 2.0, "com_mm": [0, 20, 60]}


def driving(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
    """Joint 2 has friction below zero, as a controller that does too much against it leaves in what is recorded."""
    extra = np.zeros_like(q)
    extra[:, JOINT] = -2 * COULOMB[JOINT] * np.sign(dq[:, JOINT])
    return extra


@pytest.mark.long
def test_friction_below_zero_is_not_among_the_numbers_to_enter() -> None:
    arm = robot()
    selected = diagnose_motion(arm, moved(arm, 3, driving), MotionSettings(cutoff=10.0)).selected
    parts = folds(selected)
    layout, best = selected.rows.layout, selected.best
    dry = layout.own.reshape(-1, OWN)[:, 1]
    fitted = [
        coefficients_of(part.problem, evaluate(part.problem, best.chosen, best.background, part.found.noise))
        for part in parts
    ]
    assert all(numbers[dry[JOINT]] < -0.5 * COULOMB[JOINT] for numbers in fitted)
    assert all((np.delete(numbers[dry], JOINT) > 0).all() for numbers in fitted)
    missed, torque = [], []
    for part, numbers in zip(parts, fitted, strict=True):
        entered = np.zeros_like(numbers)
        own = layout.own.reshape(-1, OWN)[:, 1:4]
        entered[own] = numbers[own]
        entered[dry[JOINT]] = 0.0
        moving = ~part.rows.still[part.which]
        said = part.rows.nominal[part.which] + part.rows.modelled(entered, part.which)
        missed.append(moving * (part.rows.torque[part.which] - said))
        torque.append(moving * part.rows.torque[part.which])
    by_hand = np.linalg.norm(np.concatenate(missed)) / np.linalg.norm(np.concatenate(torque))
    assert as_entered(selected, parts, ())[0].whole == pytest.approx(by_hand, rel=1e-6)


@pytest.mark.long
@pytest.mark.parametrize("seed", seeds(5, 6))
def test_errors_do_not_hang_on_what_holds_joints_in_pauses(seed: int) -> None:
    """Recordings that differ in the forces of their pauses alone, in which no model foretells them."""
    tables = [as_motions(from_point_to_point(seed, held), "motions.csv", 3) for held in (0.9, -0.9)]
    apart = np.sqrt(np.mean((tables[0].effort - tables[1].effort) ** 2, axis=0))
    assert np.all(apart > 0.3 * COULOMB)
    noise = 0.01
    for table in tables:
        verdict = diagnose_motion(robot(), table).verdict
        held_out = verdict.held_out
        assert max(held_out.background, held_out.model, *held_out.by_run.values()) < noise
        assert max(step.held_out for step in verdict.waterfall) < noise


@pytest.mark.long
def test_a_fold_names_nothing_that_is_there_in_its_own_run_only() -> None:
    """On a single run a load "in this run" is the load in all runs; it foretold nothing of the other."""
    arm = robot()
    found = diagnose_motion(arm, moved(robot(tool_load=LOAD), 3, seconds=15.0), MotionSettings(cutoff=10.0))
    placed = found.selected.rows.layout.placed
    assert [cause.effect for cause in found.verdict.effects] == ["payload_error"]
    for fold in folds(found.selected):
        (left,) = set(found.selected.rows.run.tolist()) - set(fold.rows.run[fold.which].tolist())
        competing = [placed[n].runs for n, each in enumerate(fold.problem.space.candidates) if each.competes]
        assert () in competing
        assert (left,) not in competing
    assert found.verdict.held_out.model == pytest.approx(found.verdict.waterfall[-1].held_out, rel=0.02)


def test_a_curve_over_time_does_not_compete_where_its_run_is_parted() -> None:
    """A spline of the first part is a constant in the second, wherever it ended."""
    for runs, parted in ((1, True), (2, False)):
        selected = diagnose_motion(robot(), moved(robot(), 1, runs=runs)).selected
        placed = selected.rows.layout.placed
        over_time = [n for n, each in enumerate(placed) if each.is_curve and each.driver == "time"]
        assert len(over_time) == 3
        assert not selected.best.candidates & set(over_time)
        for fold in folds(selected):
            assert all(fold.problem.space.candidates[n].competes is not parted for n in over_time)
