"""When, and within which speed, each joint's friction changes sides, as a plain fit of the motion tells it.

A slide under preload, or a stiff grease, comes to its dry friction over a speed that is many times what a dry gear
takes. Taken to be as sharp as that, what such a joint lacks near rest has the shape of a name: friction that falls, or
rises, with speed. So widths compete first. One is chosen where by itself it says more than the sharp change of sides
with any law that the library has for friction over speed, and with a delay: a single number beside two or three.

So do moments: what turns 40 ms later than the speed is behind a low-pass of 25 Hz no small shift, and steps from none
would not lead there.
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
from armscope.motion.library.clinging import taken_along
from armscope.motion.library.dry_friction import motion_before
from armscope.motion.library.layout import DRY, LATER, OWN, ROUNDER, TorqueLayout
from armscope.motion.library.sides import coulomb_width, sharp_width, side
from armscope.motion.samples.constants import FILTER
from armscope.motion.samples.preparation import Preparation, Signals
from armscope.motion.samples.timing import Stretch
from armscope.robot.dynamics import MovingArm
from armscope.verdict.effects import INDISTINGUISHABLE_NATS

OfSpeed = Callable[[Signals], Array]
"""(N, c) columns at samples of one joint."""
SIDES = [DRY, ROUNDER, LATER]
"""Numbers of dry friction, and of how and when it changes sides, among a joint's own columns."""


def how_friction_turns(arm: MovingArm, stretches: Sequence[Stretch], how: Preparation) -> tuple[Array | None, Array]:
    """Within which speed, and how much later than it, each joint's dry friction changes sides.

    Args:
        arm: the arm.
        stretches: even samples, ``effort`` in N m.
        how: filters and decimation.

    Returns:
        (m,) rad/s (m/s), None where all friction changes sides as sharply as fits take it to; and (m,) s, at first.
    """
    layout = TorqueLayout(arm, (), False)
    seconds = np.cumsum([len(stretch) / stretch.rate for stretch in stretches])
    enough = 1 + int(np.searchsorted(seconds, LIBRARY.turns_in_s))
    rows = build_rows(layout, stretches[:enough], how, stated_model(arm))
    modelled = rows.nominal + rows.modelled(fitted_together(rows, np.arange(layout.width)))
    widths, turning = sharp_width(arm), np.zeros(arm.n_motors)
    for j in range(arm.n_motors):
        joint = _Joint(rows, how, j)
        turning[j] = joint.turned_later()
        widths[j] = joint.width(modelled[:, j])
    return (widths if np.any(widths > sharp_width(arm)) else None), turning


class _Joint:
    """The rows of one joint, in which widths and moments compete."""

    def __init__(self, rows: MotionRows, how: Preparation, j: int) -> None:
        self.rows, self.how, self.j, self.turning = rows, how, j, 0.0
        arm = rows.layout.arm
        self.usual, self.sharp = float(coulomb_width(arm)[j]), float(sharp_width(arm)[j])
        self.moving = np.flatnonzero(rows.moving[:, j])
        own = rows.columns[j][self.moving].astype(np.float64)
        sides = np.isin(rows.at[j], OWN * j + np.array(SIDES))
        self.basis = orth(own[:, ~sides] / np.maximum(np.linalg.norm(own[:, ~sides], axis=0), 1e-300))
        stated = np.nan_to_num(arm.stated_background[j, DRY]) * own[:, np.searchsorted(rows.at[j], OWN * j + DRY)]
        self.left = self.apart(rows.torque[self.moving, j] - rows.nominal[self.moving, j] + stated)
        per_cycle = how.rate / how.every / how.cutoff
        self.independent = len(self.moving) * min(FILTER.rows_per_cutoff / per_cycle, 1.0)

    @property
    def is_told(self) -> bool:
        """Whether there are more rows than columns."""
        return bool(len(self.moving) > self.rows.columns[self.j].shape[1])

    def turned_later(self) -> float:
        """Seconds by which its friction changes sides later than the speed, if clearly any of those that are tried.

        All its torque may be late, too, which the slope of what masses ask for tells. What clings over a way is later
        the more slowly it turns.
        """
        if not self.is_told:
            return 0.0
        late, cost = self.apart(-np.gradient(self.rows.nominal[:, self.j])[self.moving, None]), {}
        ways = tuple(np.array(LIBRARY.ways) * np.ptp(self.rows.q[:, self.j]))
        clings = self.formed(functools.partial(_clings, joint=self.j, ways=ways))
        for self.turning in LIBRARY.turnings_s:
            turned = np.hstack([self.formed(functools.partial(_turns, width=self.sharp)), late])
            cost[self.turning] = self.cost(turned)
            if not self.turning:
                cost[0.0] = min(cost[0.0], self.cost(np.hstack([turned, clings])))
        best = min(cost, key=cost.__getitem__)
        self.turning = best if cost[best] < cost[0.0] - INDISTINGUISHABLE_NATS else 0.0
        return self.turning

    def width(self, modelled: Array) -> float:
        """The width that the rows ask for; the sharp one where none does clearly."""
        if not self.is_told:
            return self.sharp
        fastest = float(np.percentile(np.abs(self.rows.dq[self.moving, self.j]), 95)) / LIBRARY.slow
        tried = [width for width in self.usual * np.array(FILTER.wider) if width <= fastest]
        sides = self.formed(functools.partial(_later, width=self.sharp))
        usual = self.formed(functools.partial(_sides, width=self.usual))
        beside = [self.formed(law) for law in _laws(self.sharp, LIBRARY.slow * self.usual, LIBRARY.slow * fastest)]
        beside += [usual, self.apart(-np.gradient(modelled)[self.moving, None])]
        least = min(self.cost(np.hstack([sides, each])) for each in (sides[:, :0], *beside))
        cost = {width: self.cost(self.formed(functools.partial(_later, width=width))) for width in tried}
        best = min(cost, key=cost.__getitem__, default=self.sharp)
        return best if cost.get(best, np.inf) < least - INDISTINGUISHABLE_NATS else self.sharp

    def formed(self, law: OfSpeed) -> Array:
        """(moving, c) rows of what a law makes of samples, beyond what the joint's other columns have of them."""
        j, ago, made = [self.j], np.zeros(self.rows.q.shape[1]), []
        ago[j] = self.turning
        for each in self.rows.samples:
            before = motion_before(each.signals, ago)
            own = replace(each.signals, dq=before.dq[:, j], ddq=before.ddq[:, j])
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


def _clings(signals: Signals, joint: int, ways: tuple[float, ...]) -> Array:
    return taken_along(signals.q[:, joint], ways)


def _later(signals: Signals, width: float) -> Array:
    """Its side, and how that changes with the moment."""
    sides = _sides(signals, width)
    return np.hstack([sides, -np.gradient(sides, signals.period, axis=0)])


def _turns(signals: Signals, width: float) -> Array:
    """Besides, with the time over which it changes sides."""
    both = _later(signals, width)
    return np.hstack([both, np.gradient(both[:, 1:], signals.period, axis=0)])
