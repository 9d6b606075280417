"""Common mistakes are named by what they are."""

import re
from dataclasses import replace

import numpy as np
import pytest

from armscope.check.constants import TRIALS
from armscope.check.report import check
from armscope.robot import load_arm
from armscope.robot.arm import build_arm
from tests.calibration.worlds import far_away, measured, planted, poses, ur_like
from tests.check.test_check import problems


def _exchange(table):
    positions = table.positions.copy()
    positions[[10, 40]] = positions[[40, 10]]
    return replace(table, positions=positions)


def _off(table, motor, zero):
    return replace(table, motor_angles=table.motor_angles + np.where(np.arange(6) == motor, zero, 0))


def _flip(table, motor):
    return replace(table, motor_angles=table.motor_angles * np.where(np.arange(6) == motor, -1, 1))


def _relative(table, sign):
    """Angle 3 with that of joint 2 added or taken off."""
    return table.motor_angles + sign * table.motor_angles[:, [1]] * (np.arange(6) == 2)


def _again(mistake, words):
    """A mistake that is like another one."""
    return pytest.param(mistake, words, marks=pytest.mark.long)


@pytest.mark.parametrize(
    ("mistake", "words"),
    [
        (lambda t: replace(t, motor_angles=np.degrees(t.motor_angles)), "degrees that were declared as radians"),
        (lambda t: replace(t, motor_angles=np.radians(t.motor_angles)), "radians that were declared as degrees"),
        (lambda t: replace(t, positions=t.positions / 1e3), "metres that were declared as millimetres"),
        # asked of a run and beside a tool that explains nothing as well
        _again(lambda t: replace(t, positions=t.positions * 1e3), "millimetres that were declared as metres"),
        (lambda t: replace(t, positions=t.positions * [1, -1, 1]), "left-handed"),
        (lambda t: _flip(_flip(t, 1), 4), "joints 2 and 5 turn the other way than the arm's model says"),
        _again(lambda t: replace(t, positions=t.positions[:, [1, 0, 2]]), "left-handed"),
        (lambda t: replace(t, motor_angles=t.motor_angles[:, ::-1]), "reverse order"),
        pytest.param(
            lambda t: replace(t, positions=np.roll(t.positions, 1, axis=0)), "1 row(s) too late", marks=pytest.mark.long
        ),
        (lambda t: replace(t, positions=np.roll(t.positions, -2, axis=0)), "2 row(s) too early"),
        (lambda t: _flip(t, 2), "joint 3 turns the other way"),
        # an arm upside down: the same to the points, wherever its base may be
        (lambda t: _flip(t, 0), "joint 1 turns the other way"),
        (lambda t: _flip(t, 0), "Or the zero of joint 2 is 180 degrees off: the points can't tell."),
        (_exchange, "2 rows seem to have exchanged their points: a: 11, a: 41"),
        (lambda t: replace(t, orientation=np.roll(t.orientation, -1, axis=1)), "in the order x, y, z, w ("),
        (lambda t: replace(t, orientation=t.orientation * [1, -1, -1, -1]), "turn the other way"),
        (
            lambda t: replace(t, orientation=np.roll(t.orientation * [1, -1, -1, -1], -1, axis=1)),
            "order x, y, z, w and turn the other way",
        ),
        (lambda t: replace(t, orientation=np.roll(t.orientation, 1, axis=1)), "the real part stands in qx"),
        (lambda t: replace(t, motor_angles=-t.motor_angles), "every joint turns the other way"),
        (lambda t: replace(t, motor_angles=_relative(t, 1)), "q3 holds the forearm's angle absolute"),
        (lambda t: replace(t, motor_angles=_relative(t, -1)), "q3 holds the forearm's angle relative to link 2"),
        (lambda t: replace(t, positions=t.positions * 1e-4), "Are these errors, measured minus nominal?"),
        (lambda t: replace(t, positions=t.positions / 10), "centimetres that were declared as millimetres"),
        (lambda t: replace(t, positions=t.positions * [1, 1, 1e-3]), "z looks like metres, where x and y are millim"),
        pytest.param(
            lambda t: replace(t, positions=t.positions * [1e-3, 1, 1]),
            "x looks like metres, where y and z are millim",
            marks=pytest.mark.long,
        ),
        (lambda t: replace(t, positions=t.positions / 25.4), "inches that were declared as millimetres"),
        (
            lambda t: replace(t, positions=t.positions / [1, 10, 1]),
            "y looks like centimetres, where x and z are millim",
        ),
        (lambda t: replace(t, positions=t.positions / [1, 1, 25.4]), "z looks like inches, where x and y are millim"),
        (
            lambda t: replace(t, motor_angles=t.motor_angles[:, [0, 1, 2, 4, 3, 5]]),
            "joints 4 and 5 are exchanged",
        ),
        (lambda t: _off(t, 1, np.pi / 2), "zero of joint 2 is 90 degrees off. Add -90 degrees to q2"),
        (lambda t: _off(t, 3, np.pi), "zero of joint 4 is 180 degrees off"),
        (lambda t: replace(t, orientation=t.orientation * [1, 1, -1, -1]), "mirrored axis x"),
        pytest.param(
            lambda t: replace(t, orientation=t.orientation * [1, -1, -1, 1]), "mirrored axis z", marks=pytest.mark.long
        ),
        (
            lambda t: replace(t, positions=t.positions[np.random.default_rng(0).permutation(len(t))]),
            "does not explain the points",
        ),
    ],
)
def test_a_mistake_is_named_by_what_it_is(mistake, words, arm, sound):
    found = problems(mistake(sound), arm)
    assert len(found) == 1
    assert words in found[0]


def test_a_joint_near_a_short_tool_that_turns_the_other_way_is_named():
    """It moves the tool by centimetres alone: base and tool explain all but 4 % of the points' spread."""
    rng = np.random.default_rng(1)
    arm = ur_like()
    real, angles = planted(arm, rng), poses(rng, 80, 6)
    table = measured(real, angles, far_away(rng), {"": [0.03, 0.02, 0.1]}, 5e-5, rng)
    assert problems(table, arm) == []
    found = check(_flip(table, 5), arm)
    assert found.consistency.rms < TRIALS.fits * found.consistency.spread
    (problem,) = problems(_flip(table, 5), arm)
    assert "joint 6 turns the other way" in problem


def test_a_zero_that_is_degrees_off_is_not_called_right(arm, sound):
    (hint,) = check(replace(_off(sound, 2, np.radians(2)), orientation=None), arm).suspicions
    assert hint.weight == "hint"
    assert "Is a joint's zero degrees off" in hint.text()


def test_a_row_that_fits_nobody_is_told_with_its_id_and_by_how_much(arm, sound):
    """A digit mistyped in one point; a third of the rows is a pattern, and twenty times the misfit may be physics."""
    moved = sound.positions + np.where(np.arange(len(sound)) == 10, 0.12, 0)[:, None] * [0, 1, 0]
    (hint,) = check(replace(sound, positions=moved), arm).suspicions
    told = re.fullmatch(r"1 row lies (\S+) mm from where all others put the tool: a: 11\. .*", hint.text())
    assert hint.weight == "hint"
    assert told is not None
    assert float(told[1]) == pytest.approx(120, rel=0.02)
    less = sound.positions + (moved - sound.positions) * 0.3
    assert check(replace(sound, positions=less), arm).suspicions == ()
    far = np.random.default_rng(2).normal(0, 0.05, sound.positions.shape) * (np.arange(len(sound)) % 3 == 0)[:, None]
    some = check(replace(sound, positions=sound.positions + far), arm).suspicions
    assert not [each for each in some if "all others" in each.text()]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (
            lambda dh: dh.model_copy(update={"convention": "modified"}),
            "are in the standard convention, not the mod",
        ),
        (
            lambda dh: dh.model_copy(
                update={"joints": [row.model_copy(update={"alpha_deg": -row.alpha_deg}) for row in dh.joints]}
            ),
            "every alpha of the D-H rows has the other sign",
        ),
        (
            lambda dh: dh.model_copy(
                update={"joints": [row.model_copy(update={"a_mm": row.d_mm, "d_mm": row.a_mm}) for row in dh.joints]}
            ),
            "a and d of the D-H rows are exchanged. Exchange a_mm and d_mm",
        ),
    ],
)
def test_a_mistake_in_the_rows_of_robot_yaml_is_named_as_one(change, words, arm, sound):
    stated = arm.description.model_copy(update={"dh": change(arm.description.dh)})
    (found,) = problems(sound, build_arm(stated))
    assert words in found


@pytest.mark.parametrize("mirrored", [False, True])
def test_a_symmetric_arm_is_mirrored_by_signs_or_by_its_frame_and_both_are_said(mirrored):
    """KUKA counts joints 1, 4 and 6 the other way. Who mirrored the frame in the place of them sent the arm astray."""
    arm = load_arm("kr6-r900")
    rng = np.random.default_rng(4)
    angles = rng.uniform(-1, 1, (40, 6)) * [2.5, 0.7, 1.0, 2.8, 1.8, 3.0] + [0, -0.8, 1.0, 0, 0, 0]
    table = measured(arm, angles, far_away(rng), {"ball": (0.03, 0.02, 0.1)}, noise=1e-5, rng=rng)
    if mirrored:
        table = replace(table, positions=table.positions * [1, -1, 1])
    else:
        table = replace(table, motor_angles=angles * [-1, 1, 1, -1, 1, -1])
    (said,) = problems(table, arm)
    assert said.startswith("joints 1, 4 and 6 turn the other way than the arm's model says. Give q1, q4 and q6 the")
    assert "Or the measurement frame is left-handed" in said
    assert "Jog joint 1" in said
