"""A base that rocks: its oscillator beside an integrator of another kind."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from armscope.motion.library.rocking import swung


def test_a_push_makes_it_swing_as_its_equation_says() -> None:
    damping, hz, period = 0.06, 5.5, 0.004
    omega, time = 2 * np.pi * hz, period * np.arange(1000)
    pushed = np.clip(time - 0.3, 0, 0.2)[:, None] * np.array([[1.0, -2.0]])
    turned, speed, turning = swung(pushed, period, (damping, hz))

    def slope(t: float, state: np.ndarray) -> list[float]:
        push = np.interp(t, time, pushed[:, 0])
        return [state[1], omega**2 * (push - state[0]) - 2 * damping * omega * state[1]]

    found = solve_ivp(slope, (0, time[-1]), [0.0, 0.0], t_eval=time, rtol=1e-9, atol=1e-12, max_step=period).y
    assert turned[:, 0] == pytest.approx(found[0], abs=1e-6)
    assert speed[:, 0] == pytest.approx(found[1], abs=1e-5)
    assert turning[:, 0] == pytest.approx([slope(t, s)[1] for t, s in zip(time, found.T, strict=True)], abs=1e-3)
    assert turned[:, 1] == pytest.approx(-2 * turned[:, 0])
