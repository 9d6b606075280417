"""What clings is Prandtl's stop, and follows the torque of the motion, not the noise of its positions."""

from dataclasses import replace

import numpy as np

from armscope.motion.library.causes import Moment
from armscope.motion.library.clinging import smooth_torque, taken_along
from armscope.motion.library.dry_friction import ChangeOfSides, DryFriction
from armscope.motion.samples.preparation import Signals

RNG = np.random.default_rng(3)


def test_what_clings_over_a_way_is_prandtls_stop() -> None:
    values = np.cumsum(RNG.normal(size=400)) * 0.1
    expected, state = np.empty((400, 2)), np.full(2, np.sign(values[1] - values[0]))
    for row in range(400):
        step = values[row] - values[row - 1] if row else 0.0
        state = np.clip(state + step / np.array([0.05, 0.3]), -1, 1)
        expected[row] = state
    np.testing.assert_allclose(taken_along(values, (0.05, 0.3)), expected, atol=1e-12)


def test_noise_of_positions_moves_nothing_that_clings_and_friction_stays_sharp() -> None:
    rate, count = 250.0, 5000
    time = np.arange(count) / rate
    dq = np.cos(2 * np.pi * 0.4 * time)
    zero = np.zeros((count, 1))
    signals = Signals(
        "", 0, time, zero, dq[:, None], np.gradient(dq, time)[:, None], zero, None, None, np.arange(count)
    )
    dry = DryFriction(
        np.array([5.0]), ChangeOfSides(np.array([0.002]), np.zeros(1), np.zeros(1, dtype=np.intp), np.array([0.01]))
    )
    quiet = 8 * np.sin(2 * np.pi * 0.3 * time) + dry.of_joint(signals, 0)
    noisy = quiet + RNG.normal(0, 0.5, count)
    calm, loud = (Moment(signals, zero, each[:, None], rate, dry=dry) for each in (quiet, noisy))

    inside = slice(250, -250)
    followed = smooth_torque(loud, 0, 4.0)[inside]
    assert np.std(followed - quiet[inside]) < 0.4 * np.std(noisy - quiet)
    assert np.abs(np.diff(followed)).max() > 7.0  # friction changes sides from one sample to the next, as it did
    moved = taken_along(noisy, (0.5,))[inside] - taken_along(quiet, (0.5,))[inside]
    still = taken_along(smooth_torque(loud, 0, 4.0), (0.5,))[inside] - taken_along(quiet, (0.5,))[inside]
    assert np.std(still) < 0.5 * np.std(moved)
    np.testing.assert_allclose(smooth_torque(replace(calm, dry=None), 0, 4.0)[inside], quiet[inside], atol=6.0)
