"""Play that turns over with gravity's load, with a row at the turn that true masses put on the other flank."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.diagnosis import Settings, diagnose
from armscope.diagnosis.sided_by_loads import rows_at_turn
from armscope.physics.constants import PLAUSIBLE
from armscope.physics.scene import Scene
from armscope.recordings import Recordings
from armscope.robot import Arm
from armscope.robot.arm import build_arm

from ..physics.scenes import arm_named
from .planted import one_run, recorded

QUICK = Settings(resamples=0, cross_validation=False)
OFF = np.array([0.0, 0.12, -0.1, 0.1, -0.08, 0.15])
"""Of the stated masses, by which the true ones differ."""
GIVE, NOISE_MM = 2e-7, 0.04


def truly(arm: Arm) -> Arm:
    links = [
        link.model_copy(update={"mass_kg": link.mass_kg * (1 + off)})
        for link, off in zip(arm.description.links or (), OFF, strict=True)
    ]
    return build_arm(arm.description.model_copy(update={"links": tuple(links)}))


def poses(arm: Arm, rows: int, seed: int) -> Recordings:
    table = one_run(arm, rows, seed)
    return replace(table, approach=None, temperature=None, speed=None, payload=None, torque=None, time=None)


def with_one_row_at_the_turn(arm: Arm, rows: int) -> Recordings:
    """Poses whose sides are as stated, but for one that lies between the stated and the true turn of joint 2's load."""
    table = poses(arm, 40 * rows, seed=7)
    stated, true = (Scene(each, table).torques[:, 1] for each in (arm, truly(arm)))
    agreed = np.flatnonzero(~rows_at_turn(Scene(arm, table), 2))[: rows - 1]
    other = np.flatnonzero((stated > 0) != (true > 0))[:1]
    return table.rows(np.sort(np.concatenate([agreed, other])))


@pytest.mark.parametrize(("play", "seed"), [(1.5e-4, 3), (2.5e-4, 3)])
def test_one_row_on_the_wrong_flank_takes_the_name_from_no_play(play: float, seed: int) -> None:
    arm = arm_named("six-axis")
    table = with_one_row_at_the_turn(arm, 100)
    wanted = {("backlash", "joint 2"): [play], ("joint_compliance", "joint 2"): [GIVE]}
    wanted["joint_compliance", "joint 3"] = [GIVE]
    verdict = diagnose(arm, recorded(truly(arm), table, wanted, NOISE_MM, seed), QUICK)
    (found,) = (e for e in verdict.effects if e.effect == "backlash")
    assert (found.location, found.driver) == ("joint 2", "side that gravity loads joint 2")
    assert found.parameters[0].value == pytest.approx(play, rel=0.1)
    assert not [e for e in verdict.effects if e.nameless]


def test_masses_that_are_off_as_stated_ones_are_turn_the_side_of_rows_at_the_turn_alone() -> None:
    arm = arm_named("six-axis")
    table = poses(arm, 2000, seed=3)
    scene = Scene(arm, table)
    turned = np.sign(Scene(truly(arm), table).torques[:, 1]) != np.sign(scene.torques[:, 1])
    at_turn = rows_at_turn(scene, 2)
    assert turned.any()
    assert np.mean(at_turn[turned]) > 0.9
    assert np.mean(at_turn) < 2 * PLAUSIBLE.mass_share


def test_a_recorded_torque_tells_the_side_of_every_row() -> None:
    arm = arm_named("six-axis")
    table = poses(arm, 2000, seed=3)
    measured = replace(table, torque=Scene(arm, table).gravity_torques)
    assert rows_at_turn(Scene(arm, table), 2).any()
    assert not rows_at_turn(Scene(arm, measured), 2).any()
