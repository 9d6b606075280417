"""Scales of an instrument: of all lengths, or of heights alone; what each does, is found as, and how it is cured."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from armscope.core.averages import rms
from armscope.diagnosis import Settings, diagnose
from armscope.physics.effect import Part, Placed
from armscope.physics.instrument import INSTRUMENT_SCALE
from armscope.physics.model import Base, FittedModel, predict
from armscope.physics.model_file import load_model, save_model
from armscope.physics.scene import Scene
from armscope.recordings import Recordings
from armscope.robot import Arm, forward_kinematics
from armscope.robot.arm import build_arm
from armscope.verdict.sentences import exact_phrase

from ..diagnosis.planted import one_run, recorded
from .scenes import arm_named

QUICK = Settings(resamples=0, cross_validation=False)
SHARE = 5e-4


def setting(rows: int = 120) -> tuple[Arm, Recordings]:
    arm = arm_named("six-axis")
    return arm, replace(one_run(arm, rows, seed=8), approach=None, temperature=None, speed=None, time=None)


def of_heights(arm: Arm, table: Recordings) -> Placed:
    (placed,) = [p for p in INSTRUMENT_SCALE.place(arm, table) if p.variant == "height"]
    return placed


def test_heights_that_read_too_large_move_points_along_gravity_alone() -> None:
    arm, table = setting(30)
    side = build_arm(arm.description.model_copy(update={"gravity_m_s2": (-9.81, 0.0, 0.0)}))  # on a wall
    for each, axis in ((arm, 2), (side, 0)):
        points = forward_kinematics(each, table.motor_angles)
        wanted = points.copy()
        wanted[:, axis] *= 1 + SHARE
        read = Scene(each, table).posture([Part(of_heights(each, table), np.array([SHARE]))]).tool
        np.testing.assert_allclose(read, wanted, atol=1e-12)


def test_where_nothing_falls_there_are_no_heights() -> None:
    arm, table = setting(30)
    afloat = build_arm(arm.description.model_copy(update={"gravity_m_s2": (0.0, 0.0, 0.0)}))
    assert [p.variant for p in INSTRUMENT_SCALE.place(afloat, table)] == [""]


def test_the_model_of_wrong_heights_is_saved_and_predicts_the_same(tmp_path: Path) -> None:
    arm, table = setting(30)
    model = FittedModel(
        arm, {"1": Base(np.eye(3), np.zeros(3))}, (), (Part(of_heights(arm, table), np.array([SHARE])),)
    )
    save_model(tmp_path / "model.yaml", model)
    np.testing.assert_allclose(predict(load_model(tmp_path / "model.yaml"), table), predict(model, table), atol=1e-12)


@pytest.mark.parametrize(("axes", "name"), [([0, 0, 1], "height_scale"), ([1, 1, 1], "scale")])
def test_which_lengths_an_instrument_reads_wrong_is_told_and_its_cure_puts_them_right(
    axes: list[int], name: str
) -> None:
    arm, table = setting()
    right = recorded(arm, table, {("link_geometry", "link 3"): [3e-4, 2e-4, 0.0]}, 0.03, seed=5)
    wrong = replace(right, positions=right.positions * (1 + SHARE * np.array(axes)))
    verdict = diagnose(arm, wrong, QUICK)
    (found,) = (e for e in verdict.effects if e.effect == "instrument_scale")
    assert [p.name for p in found.parameters] == [name]
    assert found.parameters[0].value == pytest.approx(SHARE, abs=3 * found.parameters[0].stderr)
    assert found.parameters[0].stderr < SHARE / 10
    assert ("heights" in exact_phrase(found)) == (name == "height_scale")
    (part,) = [p for p in verdict.model.parts if p.placed.effect.name == "instrument_scale"]
    cure = part.placed.effect.cure
    assert cure.readings is not None
    left = cure.readings(wrong.positions, part) - right.positions
    assert rms(left) < 0.1 * rms(wrong.positions - right.positions)
