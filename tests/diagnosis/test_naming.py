"""Names out of backgrounds and lines out of curves: as specific as the evidence, and no price paid twice."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from armscope.diagnosis import Settings, diagnose
from armscope.physics.recorded_drivers import side_of_approach
from armscope.physics.scene import Scene
from armscope.recordings import Recordings, read_recordings
from armscope.robot import Arm, chain, load_arm
from armscope.robot.kinematics import joint_jacobian
from armscope.verdict.schema import Verdict
from tests.seeds import seeds

from .planted import planted

POINTS = Settings(resamples=0, cross_validation=False, orientation=False)
QUICK = Settings(resamples=0, cross_validation=False)
IIWA = Path(__file__).parents[3] / "shared" / "recordings" / "iiwa7-payload"
DRIVES = {("joint_compliance", f"joint {j}") for j in (2, 3, 4)}


def names(verdict: Verdict) -> set[tuple[str, str]]:
    return {(effect.effect, effect.location) for effect in verdict.effects}


def elastic_everywhere(seed: int) -> tuple[Arm, Recordings, dict[str, float]]:
    """An arm all of whose drives give way, the outer ones more, and all of whose bearings tilt a third as much."""
    rng = np.random.default_rng(seed)
    drives = {f"joint {j}": 3e-7 * (1 + j / 2) * rng.uniform(0.7, 1.5) for j in range(2, 6)}
    tilts = {f"joint {j}": 1e-7 * (1 + j / 2) * rng.uniform(0.7, 1.5) for j in range(2, 6)}
    wanted = {("joint_compliance", joint): [give] for joint, give in drives.items()}
    wanted |= {("bearing_compliance", joint): [give] for joint, give in tilts.items()}
    return *planted("six-axis", wanted, 250, 0.05, seed), drives


@pytest.mark.parametrize("seed", seeds(1, 2))
def test_drives_are_named_in_an_arm_that_is_elastic_everywhere(seed: int) -> None:
    arm, table, true = elastic_everywhere(seed)
    effects = diagnose(arm, table, QUICK).effects
    found = {e.location: e.parameters[0] for e in effects if e.effect == "joint_compliance"}
    assert {"joint 2", "joint 3"} <= set(found)
    for location, compliance in found.items():
        assert abs(compliance.value - true[location]) < 3 * compliance.stderr


def test_nothing_gives_way_against_its_load() -> None:
    arm, table = planted("four-axis", {("joint_compliance", "joint 2"): [-4e-7]}, 120, 0.02, seed=5)
    verdict = diagnose(arm, table, QUICK)
    assert verdict.mismatch
    for effect in verdict.effects:
        if effect.family == "elastic" and len(effect.parameters) == 1:
            assert effect.parameters[0].value > 0


def bent_spring(name: str, beyond: float, rows: int = 250) -> tuple[Arm, Recordings]:
    """A drive of joint 2 that gives way in proportion to its load, and more beyond half of the largest load."""
    arm, table = planted(name, {}, rows, 0.01, seed=4)
    scene = Scene(arm, table)
    load = scene.torques[:, 1]
    turn = 4e-7 * (load + beyond * np.sign(load) * np.maximum(np.abs(load) - 0.5 * np.abs(load).max(), 0.0))
    moved = joint_jacobian(chain(arm, table.motor_angles))[:, :, 1] * turn[:, None]
    return arm, replace(table, positions=table.positions + moved)


@pytest.mark.long
@pytest.mark.parametrize("name", ["four-axis", pytest.param("six-axis", marks=pytest.mark.long)])
def test_a_spring_that_is_nearly_straight_is_called_a_compliance_and_its_rest_unknown(name: str) -> None:
    verdict = diagnose(*bent_spring(name, 0.5), QUICK)
    assert names(verdict) == {("joint_compliance", "joint 2"), ("unknown", "joint 2")}
    line, rest = sorted(verdict.effects, key=lambda effect: effect.effect)
    assert 4e-7 < line.parameters[0].value < 6e-7
    assert rest.rms_at_tool_mm < line.rms_at_tool_mm / 3
    assert rest.driver == "load of joint 2"


@pytest.mark.long
def test_a_spring_that_is_far_from_straight_is_no_compliance() -> None:
    verdict = diagnose(*bent_spring("six-axis", 4.0, rows=120), QUICK)
    assert names(verdict) == {("unknown", "joint 2")}


@pytest.mark.long
@pytest.mark.parametrize(
    "elsewhere",
    [
        pytest.param(0.0, id="right elsewhere", marks=pytest.mark.long),
        pytest.param(2e-3, id="a little wrong everywhere"),
    ],
)
def test_a_zero_within_a_curve_gets_its_name(elsewhere: float) -> None:
    """A curve of a joint's angle holds its zero, too: 20 mrad of it are a zero, 3 mrad have no name."""
    rng = np.random.default_rng(2)
    wanted = {("joint_offset", f"joint {j}"): [elsewhere * rng.normal()] for j in (2, 3, 5)}
    arm, table = planted("six-axis", {**wanted, ("joint_offset", "joint 4"): [20e-3]}, 80, 0.05, seed=4)
    angle = table.motor_angles[:, 3]
    turn = 3e-3 / 1.7 * (np.sin(3.3 * angle) + np.sin(5.7 * angle + 1) + np.sin(8.9 * angle + 2))
    moved = joint_jacobian(chain(arm, table.motor_angles))[:, :, 3] * turn[:, None]
    verdict = diagnose(arm, replace(table, positions=table.positions + moved), QUICK)
    zero = next(e for e in verdict.effects if (e.effect, e.location) == ("joint_offset", "joint 4"))
    assert abs(zero.parameters[0].value - 20e-3) < 1e-3
    curve = next(e for e in verdict.effects if (e.effect, e.location) == ("unknown", "joint 4"))
    assert curve.rms_at_tool_mm < zero.rms_at_tool_mm / 3


@pytest.mark.long
@pytest.mark.parametrize(("uneven", "told"), [(0.2, True), (1.0, False)])
def test_play_that_is_nearly_even_is_called_play_and_its_rest_unknown(uneven: float, told: bool) -> None:
    """A gap of 1 mrad, and a part of it that changes with the angle; where that is all, there is no gap."""
    arm, table = planted("four-axis", {}, 150, 0.03, seed=6)
    side, angle = side_of_approach(Scene(arm, table), 2), table.motor_angles[:, 1]
    turn = -0.5e-3 * side * ((1.0 if told else 0.0) + uneven * np.sin(4 * angle + 0.5))
    moved = joint_jacobian(chain(arm, table.motor_angles))[:, :, 1] * turn[:, None]
    found = {e.effect: e for e in diagnose(arm, replace(table, positions=table.positions + moved), QUICK).effects}
    assert set(found) == ({"backlash", "unknown"} if told else {"unknown"})
    assert found["unknown"].driver.startswith("side of approach and angle")
    if told:
        gap = found["backlash"].parameters[0]
        assert abs(gap.value - 1e-3) < 0.1e-3
        assert found["unknown"].rms_at_tool_mm < found["backlash"].rms_at_tool_mm / 3


@pytest.mark.long
@pytest.mark.long
@pytest.mark.shared
@pytest.mark.skipif(not IIWA.is_dir(), reason=f"../shared/recordings/{IIWA.name} is not here")
@pytest.mark.parametrize("torques", ["recorded", "withheld"])
def test_a_real_arm_that_gives_way_is_told_so_joint_by_joint(torques: str) -> None:
    """README: 62.5, 67.7 and 54.6 urad per N m where nothing else gives; the mass table is too light by 1.3 to 1.46.

    By its points, as in the README: beside orientations the drive of joint 3 and the tilt of its neighbours' bearings,
    which turn the arm about nearly one axis under one moment, are not told apart.
    """
    arm = load_arm(IIWA / "robot.yaml")
    table = read_recordings(IIWA / "recordings.csv.gz", arm.n_motors)
    table = table.rows(table.run == "2016-11-18")
    verdict = diagnose(arm, table if torques == "recorded" else replace(table, torque=None), POINTS)
    assert names(verdict) >= DRIVES
    drives = [e for e in verdict.effects if e.effect == "joint_compliance"]
    rivals = {other.effect for drive in drives for other in drive.alternatives}
    assert not rivals & {"gear_mesh", "gear_ratio", "axis_wobble"}  # beside all that gives way these explain nothing
    found = {e.location: e.parameters[0] for e in drives}
    for location in ("joint 2", "joint 3", "joint 4"):
        assert 2e-5 < found[location].value < 1e-4
        assert found[location].stderr < 0.4 * found[location].value
