"""Another load at the flange is told as that, a drive that became softer as a drive."""

from dataclasses import replace

import numpy as np
import pandas as pd
from scipy.spatial.transform import Rotation

from armscope.comparison import compare
from armscope.comparison.flange_load import ANOTHER_LOAD, load_at_the_flange
from armscope.comparison.remedies import remedy_of
from armscope.recordings import Recordings, as_recordings
from armscope.robot import chain
from armscope.robot.gravity import gravity_torques
from tests.comparison.test_changes import ARM, OWN

GIVES = np.array([2e-7, 1.5e-7, 2.5e-7, 8e-7, 1e-6, 1e-6])
"""Of every drive, rad/(N m)."""


def loaded(seed: int, kg: float = 0.0, gives: np.ndarray = GIVES, rows: int = 80) -> Recordings:
    """An arm all of whose drives give way, with a load at its flange that nobody wrote down."""
    rng = np.random.default_rng(seed)
    q = rng.uniform(-1, 1, (rows, 6)) * [2, 0.6, 0.6, 2, 1.5, 2]
    turned = q + OWN + gives * gravity_torques(ARM, chain(ARM, q), np.full(rows, kg))
    points = Rotation.from_rotvec(rng.normal(0, 0.5, 3)).apply(chain(ARM, turned).tool) + rng.normal(0, 1, 3)
    points = points * 1e3 + rng.normal(0, 0.03, (rows, 3))
    columns = {f"q{j + 1}_rad": q[:, j] for j in range(6)} | {f"{a}_mm": points[:, k] for k, a in enumerate("xyz")}
    return as_recordings(pd.DataFrame(columns), "made", 6)


def test_another_gripper_is_named_as_a_load_with_what_it_turns_each_drive_by() -> None:
    before, after = loaded(101), loaded(201, kg=40.0)
    found = compare(ARM, {"before": before, "after": after})
    assert [(each.effect, each.location) for each in found.changes] == [("load", "flange")]
    assert found.headline.startswith("Load at flange changed")
    assert "was another gripper, workpiece or cable on it?" in found.headline
    (change,) = found.changes
    for number in change.parameters:
        joint = int(number.name.removeprefix("turn_of_joint_")) - 1
        poses = chain(ARM, np.vstack([before.motor_angles, after.motor_angles]))
        by_load = gravity_torques(ARM, poses, np.full(160, 40.0)) - gravity_torques(ARM, poses)
        truth = GIVES[joint] * np.sqrt(np.mean(by_load[:, joint] ** 2))
        low, high = number.interval_95
        assert low - (high - low) / 2 < truth < high + (high - low) / 2
    remedy = remedy_of(found, change)
    assert remedy.instruction.startswith("Weigh what hangs at the flange")
    assert "payload_kg" in remedy.rule


def test_a_drive_that_became_softer_is_no_load() -> None:
    softer = GIVES * [1, 1, 2, 1, 1, 1]
    found = compare(ARM, {"before": loaded(100), "after": loaded(200, gives=softer)})
    assert [(each.effect, each.location) for each in found.changes] == [("joint_compliance", "joint 3")]
    assert found.other_load == "Another load at the flange alone would not look like it."


def test_no_load_is_asked_for_where_it_was_recorded_or_no_mass_is_known() -> None:
    table = loaded(7)
    asked = load_at_the_flange(ARM, table)
    assert asked is not None
    assert asked.effect is ANOTHER_LOAD
    assert load_at_the_flange(ARM, replace(table, torque=np.zeros((len(table), 6)))) is None
    assert load_at_the_flange(replace(ARM, masses=np.zeros(6)), table) is None
