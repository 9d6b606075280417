"""Laws of torque: each is what its equation says."""

import numpy as np
import pytest
from scipy.interpolate import make_interp_spline

from armscope.motion.library.causes import Moment
from armscope.motion.library.laws import Law
from armscope.motion.samples.low_pass import without_lag
from armscope.motion.samples.preparation import Signals
from armscope.robot.bodies import Bodies
from tests.motion.moving import path, robot

RNG = np.random.default_rng(3)
Q, DQ, DDQ, RIGID, PREDICTED = RNG.normal(size=(5, 50, 2))
TIME = np.linspace(0, 1, 50)
SIGNALS = Signals("", 0, TIME, Q, DQ, DDQ, RIGID, None, 20 + Q, np.arange(50))
MOMENT = Moment(SIGNALS, RIGID, PREDICTED, 49.0)


def test_friction_laws_are_their_equations() -> None:
    # the speed changes within a sample, and friction's side is the mean over it
    within = DQ[:, 1] + DDQ[:, 1] / 49 * ((np.arange(20_000) + 0.5) / 20_000 - 0.5)[:, None]
    side = np.tanh(within / 0.01).mean(axis=0)
    stribeck = Law("stribeck", (1,), (0.01, 0.5))(MOMENT)[:, 0, 0]
    np.testing.assert_allclose(stribeck, side * np.exp(-((DQ[:, 1] / 0.5) ** 2)), atol=1e-6)
    load = Law("load friction", (1,), (0.01,))(MOMENT)[:, 0, 0]
    np.testing.assert_allclose(load, np.abs(RIGID[:, 1]) * side, atol=1e-5)
    uneven = Law("uneven friction", (1,), (0.01,))(MOMENT)[:, 0]
    np.testing.assert_allclose(uneven, side[:, None] * np.column_stack([np.sin(Q[:, 1]), np.cos(Q[:, 1])]), atol=1e-5)
    np.testing.assert_allclose(Law("warm speed", (0,), (25.0,))(MOMENT)[:, 0, 0], (Q[:, 0] - 5) * DQ[:, 0])


def test_what_acts_between_two_joints_acts_on_both() -> None:
    rubbing = Law("rubbing of two", (0, 1), (-1.0, 0.01))(MOMENT)
    np.testing.assert_allclose(rubbing[:, 0], -rubbing[:, 1])
    np.testing.assert_allclose(rubbing[:, 0, 1], DQ[:, 0] - DQ[:, 1])


def test_a_curve_can_be_constant_and_ends_where_its_range_does() -> None:
    for driver in ("joint angle", "speed", "load", "time", "temperature"):
        columns = Law(f"curve over {driver}", (0,), (-0.5, 0.5, 6.0))(MOMENT)
        assert columns.shape == (50, 1, 6)
        np.testing.assert_allclose(columns.sum(axis=2), 1.0)


def test_a_stribeck_speed_is_refined_along_its_own_slope() -> None:
    def at(speed: float) -> np.ndarray:
        return Law("stribeck", (1,), (0.01, speed))(MOMENT)[:, 0, 0]

    slope = (at(0.5 * np.exp(1e-4)) - at(0.5 * np.exp(-1e-4))) / 2e-4
    np.testing.assert_allclose(Law("stribeck", (1,), (0.01, 0.5))(MOMENT)[:, 0, 1], slope, atol=1e-6)


def test_friction_near_rest_falls_as_a_bell_or_exponentially() -> None:
    def at(*fall: float) -> np.ndarray:
        return Law("stribeck", (1,), (1e-9, *fall))(MOMENT)[:, 0]

    v = MOMENT.signals.dq[:, 1]
    np.testing.assert_allclose(at(1.0, 0.5)[:, 0], np.sign(v) * np.exp(-np.abs(v) / 0.5), atol=1e-9)
    np.testing.assert_allclose(at(2.0, 0.5), at(0.5))
    slope = (at(1.0, 0.5 * np.exp(1e-4)) - at(1.0, 0.5 * np.exp(-1e-4)))[:, 0] / 2e-4
    np.testing.assert_allclose(at(1.0, 0.5)[:, 1], slope, atol=1e-6)


def test_a_spring_and_a_warm_gear_own_their_constants() -> None:
    spring = Law("spring", (0,), (0.3,))(MOMENT)[:, 0]
    np.testing.assert_allclose(spring, np.column_stack([Q[:, 0] - 0.3, np.ones(50)]))
    warm = Law("warm speed", (0,), (25.0, 1.0))(MOMENT)[:, 0]
    np.testing.assert_allclose(warm[:, 1], DQ[:, 0])


def test_a_delay_is_exact_where_it_is_stated() -> None:
    late = PREDICTED[:, 0] + 0.04 * Law("delayed torque", (0,), (2 / 49,))(MOMENT)[:, 0, 0] * (2 / 49) / 0.04
    np.testing.assert_allclose(late[2:], PREDICTED[:-2, 0], atol=1e-12)


def test_a_delayed_torque_falls_short_by_its_slope() -> None:
    slope = Law("delayed torque", (0,))(MOMENT)[1:-1, 0, 0]
    np.testing.assert_allclose(slope, -(PREDICTED[2:, 0] - PREDICTED[:-2, 0]) * 49.0 / 2)


def behind(compliance: float, noise: float = 0.0) -> tuple[Moment, np.ndarray]:
    """Samples of motors, one of which is ahead of its link by compliance x torque, and what that changes, exactly.

    The links' motion is given; where the motors must be follows from it, so that nothing has to be solved.
    """
    arm = robot()
    time, *links = path(np.random.default_rng(2), 3, 15.0, 200.0)
    bodies = Bodies(arm, arm.inertial, None)
    torque = bodies.torques(*links)
    ahead = make_interp_spline(time, compliance * torque[:, 1], k=5)
    motors = [values + np.eye(3)[1] * ahead(time, order)[:, None] for order, values in enumerate(links)]
    if noise:
        read = make_interp_spline(time, motors[0] + noise * np.random.default_rng(4).normal(size=(len(time), 3)), k=5)
        motors = [read(time, order) for order in range(3)]
    rigid = bodies.torques(*motors)
    signals = Signals("", 0, time, *motors, rigid, None, None, np.arange(len(time)))
    return Moment(signals, rigid, rigid, 200.0, bodies), torque - rigid


@pytest.mark.parametrize(("numbers", "off"), [((10.0,), 0.04), ((10.0, 5e-4), 2e-3)], ids=["slope", "exact"])
def test_a_link_lags_behind_a_drive_that_gives_way(numbers: tuple[float, ...], off: float) -> None:
    moment, change = behind(5e-4)
    column = Law("behind a drive", (1, 0, 2), numbers)(moment)[:, :, 0]
    inside = slice(200, -200)  # a filter's ends are left out of the rows, too
    expected = change[inside][:, [1, 0, 2]]
    assert np.linalg.norm(expected, axis=0).min() > 0.05 * np.linalg.norm(expected)  # every joint feels it
    missed = np.linalg.norm(5e-4 * column[inside] - expected, axis=0) / np.linalg.norm(expected, axis=0)
    assert missed.max() < off


def test_the_torque_is_derived_where_there_is_motion_and_not_noise() -> None:
    (clean, _), (noisy, _) = behind(2e-3), behind(2e-3, noise=2e-6)
    inside = slice(200, -200)
    for cutoff in (4.0, 50.0):  # beyond its swing, which is slower than either, the link does not follow
        of_motion, read = (Law("behind a drive", (1, 0, 2), (cutoff, 2e-3))(each)[inside] for each in (clean, noisy))
        low = low_passed(read), low_passed(of_motion)
        assert np.linalg.norm(low[0] - low[1]) < 0.03 * np.linalg.norm(low[1])


def low_passed(values: np.ndarray) -> np.ndarray:
    """Through the low-pass of the rows, at 20 Hz."""
    return without_lag(values, 20.0, 200.0, 60)


def test_a_link_that_swings_more_slowly_than_positions_are_noisy_is_where_its_motor_puts_it() -> None:
    """Motor = link + compliance x torque, and noise of the motor's position at four times the link's swing."""
    arm, joint, compliance = robot(), 1, 1.2e-3
    time, *link = path(np.random.default_rng(4), 3, 10.0, 200.0)
    bodies = Bodies(arm, arm.inertial, None)
    torque = bodies.torques(*link)
    motor = [values.copy() for values in link]
    lag, faster = make_interp_spline(time, compliance * torque[:, joint], k=5), 2 * np.pi * 12.0
    for order, values in enumerate(motor):
        values[:, joint] += lag(time, order) + 1e-5 * faster**order * np.sin(faster * time + order * np.pi / 2)
    signals = Signals("", 0, time, *motor, torque, None, None, np.arange(len(time)))
    rigid = bodies.torques(*motor)
    moment = Moment(signals, rigid, rigid, 200.0, bodies)
    found = rigid + compliance * Law("behind a drive", (1, 0, 2), (15.0, compliance))(moment)[:, [1, 0, 2], 0]
    smooth = without_lag(found - torque, 2.0, 200.0, 100)[200:-200]
    whole = without_lag(rigid - torque, 2.0, 200.0, 100)[200:-200]
    assert np.std((found - torque)[200:-200, joint]) < 2 * np.std((rigid - torque)[200:-200, joint])
    assert np.std(smooth[:, joint]) < 0.15 * np.std(whole[:, joint])
