"""How torques change with the motion: against differences of inverse dynamics."""

import numpy as np
import pytest

from armscope.robot.bodies import Bodies, last_axis, slopes
from armscope.robot.dynamics import MovingArm
from tests.motion.moving import robot

RNG = np.random.default_rng(8)
MOTION = (RNG.normal(size=(6, 3)), RNG.normal(size=(6, 3)), 3 * RNG.normal(size=(6, 3)))
COUPLED = [{"q1": 1}, {"q2": 1}, {"q2": -1, "q3": 1}]


def by_differences(bodies: Bodies, step: float = 1e-5) -> list[np.ndarray]:
    found = []
    for order in range(3):
        change = np.empty((6, 3, 3))
        for j in range(3):
            more, less = ([values.copy() for values in MOTION] for _ in range(2))
            more[order][:, j] += step
            less[order][:, j] -= step
            change[:, :, j] = (bodies.torques(*more) - bodies.torques(*less)) / (2 * step)
        found.append(change)
    return found


@pytest.mark.parametrize("arm", [robot(), robot(actuation=COUPLED)], ids=["a motor in each joint", "coupled"])
@pytest.mark.parametrize("payload", [None, np.array([0.0, 2.0, 2.0, 0.0, 1.0, 0.0])], ids=["nothing", "a load"])
def test_slopes_are_differences_of_torques(arm: MovingArm, payload: np.ndarray | None) -> None:
    bodies = Bodies(arm, 1.2 * arm.inertial, payload)
    for found, expected in zip(bodies.slopes(*MOTION), by_differences(bodies), strict=True):
        np.testing.assert_allclose(found, expected, atol=1e-5 * np.abs(expected).max())


def test_what_is_carried_counts_in_its_own_samples() -> None:
    arm, load = robot(), np.array([0.0, 2.0, 2.0, 0.0, 1.0, 0.0])
    regressor = arm.regressor(*MOTION)
    expected = regressor @ arm.inertial + load[:, None] * (regressor @ arm.point_load())
    np.testing.assert_allclose(Bodies(arm, arm.inertial, load).torques(*MOTION), expected, atol=1e-9)


def test_among_some_samples_what_is_carried_in_these_counts() -> None:
    """A drive that gives way asked for a link's swing in some poses, with loads of all: it ended in an IndexError."""
    load, some = np.array([0.0, 2.0, 2.0, 0.0, 1.0, 0.0]), slice(None, None, 2)
    bodies, few = Bodies(robot(), robot().inertial, load), [values[::2] for values in MOTION]
    np.testing.assert_allclose(bodies.among(some).torques(*few), bodies.torques(*MOTION)[some], atol=1e-12)
    assert Bodies(robot(), robot().inertial, None).among(some).payload is None


def test_of_masses_that_no_body_has_the_stated_ones_count() -> None:
    arm = robot()
    wild = arm.inertial.copy()
    wild[10] = -1.0
    for found, expected in zip(slopes(arm, MOTION, wild), slopes(arm, MOTION, arm.inertial), strict=True):
        np.testing.assert_array_equal(found, expected)


def test_mass_on_the_last_axis_does_not_turn_the_last_joint() -> None:
    arm, rng = robot(), np.random.default_rng(4)
    q, nothing = rng.normal(size=(30, 3)), np.zeros((30, 3))
    turned = arm.regressor(q, nothing, nothing)[:, 2, -9:-6]
    across = np.cross(last_axis(arm), [1.0, 2.0, 0.0])
    assert turned @ last_axis(arm) == pytest.approx(np.zeros(30), abs=1e-12)
    assert np.abs(turned @ across).max() > 1
