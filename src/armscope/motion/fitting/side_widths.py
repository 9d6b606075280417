"""Within which speed each joint's friction changes sides, as a plain fit of the motion tells it.

A slide under preload, or a stiff grease, comes to its dry friction over a speed that is many times what a dry gear
takes. Taken to be as sharp as that, what such a joint lacks near rest has the shape of a name: friction that falls, or
rises, with speed. So widths compete first. One is chosen where by itself it says more than the sharp change of sides
with any law that the library has for friction over speed, and with a delay: a single number beside two or three.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

import numpy as np
from scipy.linalg import orth

from armscope.core.types import Array
from armscope.motion.constants import LIBRARY
from armscope.motion.fitting.model_estimate import stated_model
from armscope.motion.fitting.rows import MotionRows, build_rows
from armscope.motion.fitting.weights import fitted_together
from armscope.motion.library.layout import OWN, OWN_NAMES, TorqueLayout
from armscope.motion.library.sides import coulomb_width, sharp_width, side
from armscope.motion.samples.constants import FILTER
from armscope.motion.samples.preparation import Preparation, Signals
from armscope.motion.samples.timing import Stretch
from armscope.robot.dynamics import MovingArm
from armscope.verdict.effects import INDISTINGUISHABLE_NATS

OfSpeed = Callable[[Signals], Array]
"""(N, c) columns at samples of one joint."""
SIDES = [OWN_NAMES.index("coulomb"), OWN_NAMES.index("rounder")]
"""Numbers of dry friction, and of the time over which it changes sides, among a joint's own columns."""


def widths_of_sides(arm: MovingArm, stretches: Sequence[Stretch], how: Preparation) -> Array | None:
    """The width of each joint.

    Args:
        arm: the arm.
        stretches: even samples, ``effort`` in N m.
        how: filters and decimation.

    Returns:
        (m,) rad/s (m/s); None where all friction changes sides as sharply as fits take it to.
    """
    layout = TorqueLayout(arm, (), False)
    rows = build_rows(layout, stretches, how, stated_model(arm))
    modelled = rows.nominal + rows.modelled(fitted_together(rows, np.arange(layout.width)))
    found = sharp_width(arm)
    for j in range(arm.n_motors):
        found[j] = _Joint(rows, how, j).width(modelled[:, j])
    return found if np.any(found > sharp_width(arm)) else None


class _Joint:
    """The rows of one joint, in which widths compete."""

    def __init__(self, rows: MotionRows, how: Preparation, j: int) -> None:
        self.rows, self.how, self.j = rows, how, j
        arm = rows.layout.arm
        self.usual, self.sharp = float(coulomb_width(arm)[j]), float(sharp_width(arm)[j])
        self.moving = np.flatnonzero(rows.moving[:, j])
        others = ~np.isin(rows.at[j], OWN * j + np.array(SIDES))
        own = rows.columns[j][self.moving][:, others].astype(np.float64)
        self.basis = orth(own / np.maximum(np.linalg.norm(own, axis=0), 1e-300))
        self.left = self.apart(rows.torque[self.moving, j] - rows.nominal[self.moving, j])
        per_cycle = how.rate / how.every / how.cutoff
        self.independent = len(self.moving) * min(FILTER.rows_per_cutoff / per_cycle, 1.0)

    def width(self, modelled: Array) -> float:
        """The width that the rows ask for; the sharp one where none does clearly."""
        if len(self.moving) <= self.rows.columns[self.j].shape[1]:
            return self.sharp
        fastest = float(np.percentile(np.abs(self.rows.dq[self.moving, self.j]), 95)) / LIBRARY.slow
        tried = [width for width in self.usual * np.array(FILTER.wider) if width <= fastest]
        sides = self.formed(functools.partial(_sides, width=self.sharp))
        usual = self.formed(functools.partial(_sides, width=self.usual))
        beside = [self.formed(law) for law in _laws(self.sharp, LIBRARY.slow * self.usual, LIBRARY.slow * fastest)]
        beside += [usual, self.apart(-np.gradient(modelled)[self.moving, None])]
        least = min(self.cost(np.hstack([sides, each])) for each in (sides[:, :0], *beside))
        cost = {width: self.cost(self.formed(functools.partial(_sides, width=width))) for width in tried}
        best = min(cost, key=cost.__getitem__, default=self.sharp)
        return best if cost.get(best, np.inf) < least - INDISTINGUISHABLE_NATS else self.sharp

    def formed(self, law: OfSpeed) -> Array:
        """(moving, c) rows of what a law makes of samples, beyond what the joint's other columns have of them."""
        j, made = [self.j], []
        for each in self.rows.samples:
            own = replace(each.signals, dq=each.signals.dq[:, j], ddq=each.signals.ddq[:, j])
            made.append(self.how.low_passed(law(own), own.kept, own.stride))
        return self.apart(np.concatenate(made)[self.moving])

    def apart(self, values: Array) -> Array:
        """Values (moving, ...) without what the joint's other columns have of them."""
        return np.asarray(values - self.basis @ (self.basis.T @ values))

    def cost(self, columns: Array) -> float:
        """Of a fit, nats, by the Bayesian information criterion."""
        remains = self.left - columns @ np.linalg.lstsq(columns, self.left, rcond=None)[0]
        misfit = float(np.log(max(float(remains @ remains), 1e-300)))
        return float((self.independent * misfit + columns.shape[1] * np.log(max(self.independent, 1.0))) / 2)


def _laws(width: float, slowest: float, fastest: float) -> Iterator[OfSpeed]:
    """What the library has for friction over a joint's speed."""
    for speed in np.geomspace(slowest, max(fastest / 2, 2 * slowest), 2 * LIBRARY.stribeck_widths):
        yield functools.partial(_fallen, width=width, speed=float(speed))
    for power in LIBRARY.powers:
        yield functools.partial(_grown, width=width, power=power)


def _fallen(signals: Signals, width: float, speed: float) -> Array:
    share = (signals.dq / speed) ** 2
    fallen = _sides(signals, width) * np.exp(-share)
    return np.hstack([fallen, 2 * share * fallen])


def _grown(signals: Signals, width: float, power: float) -> Array:
    return _sides(signals, width) * np.abs(signals.dq) ** power


def _sides(signals: Signals, width: float) -> Array:
    return side(signals, np.array([width]))
