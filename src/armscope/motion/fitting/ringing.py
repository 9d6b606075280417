"""Whether the arm's stand rings: the frequency and damping by which a base that rocks explains most of what is left.

Torques that a base's rocking makes hold a narrow line, which no law of one joint has; the moment that shakes it is
known from the arm's own motion. So both are sought by what a plain fit leaves of all joints together, in all runs:
smooth waves hardly shake a stand that rings after starts and stops.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize

from armscope.core.types import Array, Indices
from armscope.inference.linear_algebra import spanned
from armscope.motion.fitting.rows import MotionRows
from armscope.motion.fitting.weights import fitted_together
from armscope.motion.library.causes import Stand
from armscope.motion.library.rocking import ABOUT, rocked
from armscope.motion.library.rocking_constants import ROCKING
from armscope.motion.samples.constants import FILTER
from armscope.motion.samples.preparation import Preparation, Signals
from armscope.robot.bodies import Bodies
from armscope.robot.on_a_stand import OnAStand


def ringing(rows: MotionRows, how: Preparation) -> Stand | None:
    """The stand that suits best, if any rings.

    Args:
        rows: each joint's columns of friction, rotor and masses, and no cause's.
        how: filters and decimation.

    Returns:
        It; None where none explains much, or one that does not ring does nearly as well.
    """
    highest = min(ROCKING.highest_hz, how.cutoff, how.position_cutoff)
    count = int(np.log(max(highest / ROCKING.lowest_hz, 1.0)) / ROCKING.step)
    if count < 1:
        return None
    tried, hz = _Tried(rows, how), np.geomspace(ROCKING.lowest_hz, highest, count + 2)
    found = [tried.explained(ROCKING.damping, each) for each in map(float, hz)]
    best = int(np.argmax(found))
    if found[best] < ROCKING.least_share or best in (0, len(hz) - 1):
        return None
    damping, at = _finest(tried, float(hz[best]))
    if tried.explained(1.0, at) > ROCKING.rings * tried.explained(damping, at):
        return None
    return Stand(at, damping, (float(tried.held[0]), float(tried.held[1])), len(hz))


def _finest(tried: _Tried, hz: float) -> tuple[float, float]:
    """Damping and frequency about a frequency (Nelder & Mead 1965)."""
    start = np.log([ROCKING.damping, hz])
    steps = np.array([[0.0, 0.0], [np.log(2.0), 0.0], [0.0, ROCKING.step / 2]])
    low, high = np.log([ROCKING.least_damping, hz / 2]), np.log([ROCKING.most_damping, 2 * hz])

    def lost(at: Array) -> float:
        return -tried.explained(*map(float, np.exp(np.clip(at, low, high))))

    found = minimize(
        lost,
        start,
        method="Nelder-Mead",
        options={
            "initial_simplex": start + steps,
            "xatol": ROCKING.settled,
            "fatol": np.inf,
            "maxfev": ROCKING.steps,
        },
    )
    damping, at = map(float, np.exp(np.clip(found.x, low, high)))
    return damping, at


@dataclass(frozen=True, eq=False)
class _Joint:
    """Rows that tell of a joint, a basis of its other columns there, what is left beside these, and its unit, N m."""

    rows: Indices
    basis: Array
    left: Array
    unit: float

    def apart(self, values: Array) -> Array:
        own = values[self.rows] / self.unit
        return np.asarray(own - self.basis @ (self.basis.T @ own))


class _Tried:
    """What is left of all joints, in which stands are tried."""

    def __init__(self, rows: MotionRows, how: Preparation) -> None:
        arm, self.how = rows.layout.arm, how
        left = rows.torque - rows.nominal - rows.modelled(fitted_together(rows, np.arange(rows.layout.width)))
        every = ((j, _left_at(rows, j, left[:, j])) for j in range(arm.n_motors))
        self.joints = [(j, joint) for j, joint in every if joint is not None]
        signals = [each.signals for each in rows.samples]
        self.parts: Sequence[tuple[OnAStand, Signals]] = [
            (Bodies(arm, arm.inertial, each.payload).on_a_stand(*each.of_links), each) for each in signals
        ]
        self.held = np.mean(np.concatenate([stand.moment for stand, _ in self.parts]), axis=0)

    def explained(self, damping: float, hz: float) -> float:
        """Share of the squares that are left, each joint in units of its own, that such a stand explains."""
        swing, G, b = (damping, hz), np.zeros((len(ABOUT),) * 2), np.zeros(len(ABOUT))
        made = [
            self.how.low_passed(rocked(stand, self.held, each.period, swing), each.kept, each.stride)
            for stand, each in self.parts
        ]
        felt = np.concatenate(made)
        for j, joint in self.joints:
            alone = joint.apart(felt[:, j])
            G, b = G + alone.T @ alone, b + alone.T @ joint.left
        whole = sum(float(joint.left @ joint.left) for _, joint in self.joints)
        return float(b @ np.linalg.pinv(G, rcond=FILTER.rounding, hermitian=True) @ b) / max(whole, 1e-300)


def _left_at(rows: MotionRows, j: int, left: Array) -> _Joint | None:
    """One joint of them; None where it has no more rows than columns."""
    among = np.flatnonzero(rows.moving[:, j])
    if len(among) <= rows.columns[j].shape[1]:
        return None
    basis = spanned(rows.columns[j][among].astype(np.float64), FILTER.single)
    beyond = left[among] - basis @ (basis.T @ left[among])
    unit = float(np.sqrt(np.mean(beyond**2)))
    return _Joint(among, basis, beyond / unit, unit) if unit > 0 else None
