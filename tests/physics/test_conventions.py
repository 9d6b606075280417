"""Signs, units and places of the vocabulary, each against a model built in another way."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq

from armscope.physics.effect import Part, Placed
from armscope.physics.registry import library
from armscope.physics.scene import Scene
from armscope.recordings import Recordings
from armscope.robot import Arm, forward_kinematics
from armscope.robot.arm import build_arm
from armscope.robot.description import RobotDescription
from armscope.robot.description_file import load_description

from .scenes import ARMS, ROBOTS, arm_named, full_table


def placed(arm: Arm, table: Recordings, effect: str, location: str, variant: str | None = None) -> Placed:
    return next(
        p
        for p in library(arm, table)
        if p.key == (effect, location) and (variant is None or p.variant == variant) and p.parametrisation != "curve"
    )


def moved(arm: Arm, table: Recordings, effect: str, location: str, values: list[float], variant: str | None = None):
    part = Part(placed(arm, table, effect, location, variant), np.array(values))
    return Scene(arm, table).posture([part]).tool


def turned(arm: Arm, table: Recordings, extra: np.ndarray) -> np.ndarray:
    return forward_kinematics(arm, table.motor_angles + extra)


@pytest.fixture(params=ARMS)
def arm(request: pytest.FixtureRequest) -> Arm:
    return arm_named(request.param)


@pytest.fixture
def table(arm: Arm) -> Recordings:
    return full_table(arm, 30, seed=11)


def test_what_follows_a_motor_is_an_extra_motor_angle(arm: Arm, table: Recordings) -> None:
    q, one = table.motor_angles, np.eye(arm.n_motors)
    assert table.approach is not None
    assert table.speed is not None
    cases = {
        ("joint_offset", "joint 2", None): ([1e-3], 1e-3 * one[1] * np.ones_like(q)),
        ("gear_ratio", "joint 3", None): ([1e-3], 1e-3 * q * one[2]),
        ("gear_eccentricity", "joint 2", "2"): ([3e-4, 1e-4], (3e-4 * np.cos(2 * q) + 1e-4 * np.sin(2 * q)) * one[1]),
        ("backlash", "joint 3", "approach"): ([1e-3], -table.approach * 0.5e-3 * one[2]),
        ("servo_lag", "joint 2", None): ([5e-3], -table.speed * 5e-3 * one[1]),
        ("joint_coupling", "joint 5 from joint 4", None): ([1e-3], 1e-3 * q[:, [3]] * one[4]),
    }
    for (effect, location, variant), (values, extra) in cases.items():
        expected = turned(arm, table, extra)
        np.testing.assert_allclose(
            moved(arm, table, effect, location, values, variant), expected, atol=1e-12, err_msg=effect
        )


def test_a_joint_gives_way_along_gravitys_pull() -> None:
    """One horizontal metre with ten kilograms at its end: it must sink by compliance x m g l, and by no sign error.

    Where it stands in equilibrium the lever arm is l cos(turn).
    """
    arm = build_arm(
        RobotDescription.model_validate(
            {
                "name": "lever",
                "dh": {"joints": [{"a_mm": 1000, "alpha_deg": 0, "d_mm": 0}]},
                "links": [{"mass_kg": 10, "com_mm": [0, 0, 0]}],
                "gravity_m_s2": [0, -9.81, 0],
            }
        )
    )
    table = Recordings(np.zeros((1, 1)), np.zeros((1, 3)), *(np.array(["1"]) for _ in range(3)))
    tool = moved(arm, table, "joint_compliance", "joint 1", [1e-5])
    turn = brentq(lambda angle: angle - 1e-5 * 10 * 9.81 * np.cos(angle), 0, 1e-2, xtol=1e-15)
    assert tool[0, 1] == pytest.approx(-np.sin(turn), rel=1e-9)


def test_a_bending_link_is_an_euler_bernoulli_cantilever() -> None:
    """F L^3 / (3 E I) at the tip of a horizontal beam with a weight at its end."""
    arm = build_arm(
        RobotDescription.model_validate(
            {
                "name": "beam",
                "dh": {"joints": [{"a_mm": 800, "alpha_deg": 0, "d_mm": 0}]},
                "links": [{"mass_kg": 10, "com_mm": [0, 0, 0]}],
                "gravity_m_s2": [0, -9.81, 0],
            }
        )
    )
    table = Recordings(np.zeros((1, 1)), np.zeros((1, 3)), *(np.array(["1"]) for _ in range(3)))
    tool = moved(arm, table, "link_bending", "link 1", [1e-6])
    assert tool[0, 1] == pytest.approx(-10 * 9.81 * 0.8**3 / 3 * 1e-6, rel=1e-9)


@pytest.mark.parametrize("name", ARMS)
@pytest.mark.parametrize("sizes", [{"a": 2e-3, "alpha": 1.5e-3, "d": -1e-3}, {"beta": 1e-4}])
def test_row_errors_are_those_of_an_arm_built_with_other_rows(name: str, sizes: dict[str, float]) -> None:
    description = load_description(ROBOTS / f"{name}.yaml")
    nominal = build_arm(description)
    table = full_table(nominal, 20, seed=3)
    scene = Scene(nominal, table)
    assert description.dh is not None
    for j in range(1, nominal.n_joints + 1):
        link = placed(nominal, table, "link_geometry", f"link {j}")
        part = Part(link, np.array([sizes.get(term.name, 0.0) for term in link.terms]))
        rows = list(description.dh.joints)
        row = rows[j - 1]
        skewed = any(term.name == "beta" for term in link.terms)
        rows[j - 1] = row.model_copy(
            update={
                "a_mm": row.a_mm + 1e3 * sizes.get("a", 0.0),
                "alpha_deg": row.alpha_deg + np.degrees(sizes.get("alpha", 0.0)),
                "d_mm": row.d_mm + 1e3 * sizes.get("d", 0.0),
                "beta_deg": row.beta_deg + np.degrees(sizes.get("beta", 0.0)) * skewed,
            }
        )
        other = build_arm(
            description.model_copy(update={"dh": description.dh.model_copy(update={"joints": tuple(rows)})})
        )
        expected = forward_kinematics(other, table.motor_angles)
        # a and alpha along one axis, d along another, beta small: exact but for the order within one row
        np.testing.assert_allclose(scene.posture([part]).tool, expected, atol=5e-9, err_msg=f"link {j}")


def test_lengths_hold_at_20_degrees_and_grow_with_temperature(arm: Arm, table: Recordings) -> None:
    assert table.temperature is not None
    table.temperature[0] = 20.0
    grown = moved(arm, table, "thermal_expansion", "link 3", [2e-5])
    nominal = forward_kinematics(arm, table.motor_angles)
    np.testing.assert_allclose(grown[0], nominal[0], atol=1e-15)
    row = arm.description.dh.joints[2]  # type: ignore[union-attr]
    length = np.hypot(row.a_mm, row.d_mm) * 1e-3
    step = np.linalg.norm(grown - nominal, axis=1)
    np.testing.assert_allclose(step, 2e-5 * np.abs(table.temperature - 20) * length, rtol=1e-6, atol=1e-12)


def test_the_linkage_closes_its_loop(table: Recordings) -> None:
    """Both ends of the rod, computed from the lengths in error, must stand one rod apart."""
    arm = arm_named("parallelogram-120kg")
    table = full_table(arm, 30, seed=11)
    scene = Scene(arm, table)
    part = Part(placed(arm, table, "parallelogram_geometry", "parallelogram"), np.array([2e-3, -1e-3]))
    turn = scene.twists([part])["joint 3"][:, 5]
    bars = scene.linkage
    crank = scene.elbow_angle + bars.crank_angle
    rocker = crank + turn
    reach = np.stack([bars.upper_arm + (bars.rocker - 1e-3) * np.cos(rocker) - bars.crank * np.cos(crank),
                      (bars.rocker - 1e-3) * np.sin(rocker) - bars.crank * np.sin(crank)])  # fmt: skip
    np.testing.assert_allclose(np.hypot(*reach), bars.rod + 2e-3, atol=1e-12)
    assert np.abs(turn).max() > 1e-4


def test_an_instrument_that_reads_long_stretches_everything(arm: Arm, table: Recordings) -> None:
    stretched = moved(arm, table, "instrument_scale", "instrument", [1e-4])
    np.testing.assert_allclose(stretched, 1.0001 * forward_kinematics(arm, table.motor_angles), rtol=1e-12)


def test_recorded_torque_is_the_load_where_it_is_recorded(arm: Arm, table: Recordings) -> None:
    from dataclasses import replace

    torque = np.full_like(table.motor_angles, 7.0)
    torque[3, 1] = np.nan
    scene = Scene(arm, replace(table, torque=torque))
    gravity = Scene(arm, table).torques
    assert scene.torques[0, 1] == 7.0
    assert scene.torques[3, 1] == pytest.approx(gravity[3, 1])
