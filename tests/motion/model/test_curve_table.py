"""What has no law is cured by the points of curves.csv, as the card says: whoever adds them has the torque."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from armscope.core.types import Array
from armscope.motion.library.remedies_of_curves import unit_of
from armscope.motion.model.curve_table import COLUMNS, curve_table
from armscope.motion.pipeline import MotionDiagnosis, MotionSettings, diagnose_motion
from tests.motion.moving import clinging, moved, path, robot


def cabled(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
    extra = np.zeros_like(q)
    extra[:, 1] = 6 * np.sin(3.1 * q[:, 1]) * (q[:, 1] > 0)
    return extra


def cured(found: MotionDiagnosis, kind: str, shape: str) -> pd.DataFrame:
    """The rows of joint 2's cause."""
    causes = [each for each in found.verdict.effects if each.location == "joint 2" and each.effect == kind]
    assert causes
    assert "curves.csv" in causes[0].cure
    table = curve_table(found.model)
    rows = table[(table["cause"] == kind) & (table["place"] == "joint 2")]
    assert set(rows["shape"]) == {shape}
    assert set(rows["torque_unit"]) == {"N m"}
    assert set(rows["at_unit"]) == {"rad"}
    return rows


def missed(added: Array, planted: Array, own: Array) -> float:
    """What is left of what was planted, beyond ordinary friction and an offset, which the table of friction has."""
    ordinary = np.column_stack([np.ones(len(own)), own, np.sign(own)])
    beyond = lambda values: values - ordinary @ np.linalg.lstsq(ordinary, values, rcond=None)[0]
    return float(np.linalg.norm(beyond(planted - added)) / np.linalg.norm(beyond(planted)))


def test_a_cables_curve_is_added_as_it_stands_in_the_file() -> None:
    found = diagnose_motion(robot(), moved(robot(), 1, cabled, seconds=10.0), MotionSettings(cutoff=10.0))
    rows = cured(found, "cable_torque", "curve")
    _, q, dq, ddq = path(np.random.default_rng(1), 3, 10.0, 200.0)
    added = np.interp(q[:, 1], rows["at"], rows["torque"])
    assert missed(added, cabled(q, dq, ddq, q)[:, 1], dq[:, 1]) < 0.15


@pytest.mark.long
def test_stops_are_taken_along_as_the_card_says() -> None:
    found = diagnose_motion(robot(), moved(robot(), 1, clinging, seconds=10.0), MotionSettings(cutoff=10.0))
    rows = cured(found, "unknown", "stop")
    _, q, dq, ddq = path(np.random.default_rng(1), 3, 10.0, 200.0)
    steps = np.diff(q[:, 1])
    added, s = np.zeros(len(q)), np.full(len(rows), np.sign(steps[0]))
    for number in range(len(q)):
        s = np.clip(s + (steps[number - 1] / rows["at"] if number else 0.0), -1, 1)
        added[number] = rows["torque"] @ s
    turned = slice(int(np.flatnonzero(np.diff(np.sign(steps)))[0]), None)  # nobody knows what came before the motion
    assert missed(added[turned], clinging(q, dq, ddq, q)[turned, 1], dq[turned, 1]) < 0.15


def test_an_arm_without_curves_has_a_table_without_rows() -> None:
    found = diagnose_motion(robot(), moved(robot(), 1, seconds=10.0), MotionSettings(cutoff=10.0))
    table = curve_table(found.model)
    assert tuple(table.columns) == COLUMNS
    assert not len(table)


def test_units_are_those_of_what_is_followed() -> None:
    assert [unit_of(each, False) for each in ("joint angle", "speed", "load", "time")] == ["rad", "rad/s", "N m", "s"]
    assert [unit_of(each, True) for each in ("joint angle", "speed", "load")] == ["m", "m/s", "N"]
