"""When, and within which speed, each joint's friction changes sides, as a plain fit of the motion tells it.

A slide under preload, or a stiff grease, comes to its dry friction over a speed that is many times what a dry gear
takes. Taken to be as sharp as that, what such a joint lacks near rest has the shape of a name: friction that falls, or
rises, with speed. So widths compete first. One is chosen where by itself it says more than the sharp change of sides
with any law that the library has for friction over speed, and with a delay: a single number beside two or three.

So do moments: what turns 40 ms later than the speed is behind a low-pass of 25 Hz no small shift, and steps from none
would not lead there. And so do low-passes of all torques, behind which friction does not change sides as a step does,
however late: what is rounded off by one would ask for laws of friction near rest.
"""

from __future__ import annotations

import functools
import itertools
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from armscope.core.types import Array
from armscope.inference.linear_algebra import spanned
from armscope.motion.constants import LIBRARY, PRIOR
from armscope.motion.fitting.model_estimate import stated_model
from armscope.motion.fitting.rows import MotionRows, build_rows
from armscope.motion.fitting.weights import fitted_together
from armscope.motion.library.clinging import taken_along
from armscope.motion.library.dry_friction import LATE_BY_ORDER, ChangeOfSides, is_shown, motion_before, passed
from armscope.motion.library.layout import BLUNTER, DRY, LATER, OWN, ROUNDER, TorqueLayout
from armscope.motion.library.sides import coulomb_width, sharp_width, side
from armscope.motion.samples.constants import FILTER
from armscope.motion.samples.preparation import Preparation, Signals
from armscope.motion.samples.timing import Stretch
from armscope.robot.dynamics import MovingArm
from armscope.verdict.effects import INDISTINGUISHABLE_NATS

OfSpeed = Callable[[Signals], Array]
"""(N, c) columns at samples of one joint."""
SIDES = [DRY, BLUNTER, ROUNDER, LATER]
"""Numbers of dry friction, and of how and when it changes sides, among a joint's own columns."""


def plain_rows(arm: MovingArm, stretches: Sequence[Stretch], how: Preparation) -> MotionRows:
    """Rows of as much of a motion as shows how friction turns, without a cause.

    Args:
        arm: the arm.
        stretches: even samples, ``effort`` in N m.
        how: filters and decimation.

    Returns:
        The rows.
    """
    layout = TorqueLayout(arm, (), False)
    seconds = np.cumsum([len(stretch) / stretch.rate for stretch in stretches])
    enough = 1 + int(np.searchsorted(seconds, LIBRARY.turns_in_s))
    return build_rows(layout, stretches[:enough], how, stated_model(arm))


def how_friction_turns(rows: MotionRows, how: Preparation) -> ChangeOfSides:
    """Within which speed, how much later than it, and behind which low-pass each joint's dry friction changes sides.

    Args:
        rows: `plain_rows`.
        how: filters and decimation.

    Returns:
        It; how much later is a first guess.
    """
    arm = rows.layout.arm
    modelled = rows.nominal + rows.modelled(fitted_together(rows, np.arange(rows.layout.width)))
    joints = [_Joint(rows, how, j) for j in range(arm.n_motors)]
    shifts = [joint.shifted_later() for joint in joints]
    late, order = _one_filter([(joint, cost) for joint, (cost, _) in zip(joints, shifts, strict=True) if joint.is_told])
    for joint, (_, own) in zip(joints, shifts, strict=True):
        joint.late, joint.order = (late, order) if order else (own, 0)
    widths = [joint.width(modelled[:, j]) for j, joint in enumerate(joints)]
    lates, orders = ([getattr(joint, name) for joint in joints] for name in ("late", "order"))
    return ChangeOfSides.of(arm, np.array(lates), np.array(widths), np.array(orders, dtype=np.intp))


def _one_filter(shifted: Sequence[tuple[_Joint, float]]) -> tuple[float, int]:
    """Seconds and order of a low-pass that all torques pass; 0, 0 where there is none.

    Friction that clings is like a low-pass of each joint's own. One of all is there only where it is as good as what
    suits each joint best by itself, a shift or another low-pass, and clearly better than shifts.
    """
    if len(shifted) < LIBRARY.joints_of_a_clock:
        return 0.0, 0
    tried = list(itertools.product(LIBRARY.filters_s, LATE_BY_ORDER))
    cost = np.array([[joint.turning_at(*each)[0] for each in tried] for joint, _ in shifted])
    shifts = np.array([cost for _, cost in shifted])
    common, own = cost.sum(axis=0), float(np.minimum(cost.min(axis=1), shifts).sum())
    best = int(common.argmin())
    alike = common[best] < own + INDISTINGUISHABLE_NATS * len(shifted)
    return tried[best] if alike and common[best] < shifts.sum() - INDISTINGUISHABLE_NATS else (0.0, 0)


class _Joint:
    """The rows of one joint, in which widths and moments compete."""

    def __init__(self, rows: MotionRows, how: Preparation, j: int) -> None:
        self.rows, self.how, self.j, self.late, self.order = rows, how, j, 0.0, 0
        arm = rows.layout.arm
        self.usual, self.sharp = float(coulomb_width(arm)[j]), float(sharp_width(arm)[j])
        self.moving = np.flatnonzero(rows.moving[:, j])
        own = rows.columns[j][self.moving].astype(np.float64)
        sides = np.isin(rows.at[j], OWN * j + np.array(SIDES))
        self.basis = spanned(np.hstack([own[:, ~sides], *self._loads_of_runs(own)]), FILTER.single)
        stated = np.nan_to_num(arm.stated_background[j, DRY]) * own[:, np.searchsorted(rows.at[j], OWN * j + DRY)]
        self.left = self.apart(rows.torque[self.moving, j] - rows.nominal[self.moving, j] + stated)
        self.slope = self.apart(-np.gradient(rows.nominal[:, j])[self.moving, None])
        per_cycle = how.rate / how.every / how.cutoff
        self.independent = len(self.moving) * min(FILTER.rows_per_cutoff / per_cycle, 1.0)

    def _loads_of_runs(self, own: Array) -> Iterator[Array]:
        """(moving, 10) of each run but the first: what the last link would have there alone.

        A load that nobody stated is no torque of friction, and larger than all that tells how friction turns.
        """
        of_last, run = np.isin(self.rows.at[self.j], self.rows.layout.inertial[-10:]), self.rows.run[self.moving]
        for name in np.unique(run)[1:]:
            yield own[:, of_last] * (run == name)[:, None]

    @property
    def is_told(self) -> bool:
        """Whether there are more rows than columns."""
        return bool(len(self.moving) > self.rows.columns[self.j].shape[1])

    def shifted_later(self) -> tuple[float, float]:
        """What its friction costs, and by how many s it changes sides later than the speed, 0 where it is not clear.

        What clings over a way is later the more slowly it turns, and is no shift.
        """
        if not self.is_told:
            return 0.0, 0.0
        ways = tuple(np.array(LIBRARY.ways) * np.ptp(self.rows.q[:, self.j]))
        clings = self.formed(functools.partial(_clings, joint=self.j, ways=ways))
        in_time = np.hstack([self.formed(functools.partial(_turns, width=self.sharp)), self.slope])
        none = min(self.cost(in_time), self.cost(np.hstack([in_time, clings])))
        found = [(*self.turning_at(late), late) for late in LIBRARY.turnings_s]
        for _ in range(LIBRARY.turning_steps):
            _, step, late = min(found)
            late = float(np.clip(late + step, -PRIOR.longest_turning_s, PRIOR.longest_turning_s))
            found.append((*self.turning_at(late), late))
        cost, _, late = min(found)
        return (cost, late) if cost < none - INDISTINGUISHABLE_NATS else (none, 0.0)

    def turning_at(self, late: float, order: int = 0) -> tuple[float, float]:
        """What friction costs that changes sides so, all its torque being late, too; and by how many s it is later.

        It takes some time, or none: what is sharper than a step is no friction.
        """
        self.late, self.order = late, order
        if order and not is_shown(order, late, self.rows.samples[0].signals.period):
            return np.inf, 0.0
        columns = np.hstack([self.slope, self.formed(functools.partial(_turns, width=self.sharp))])
        _, dry, later, over = np.linalg.lstsq(columns, self.left, rcond=None)[0]
        if over * dry < 0:
            columns = columns[:, :-1]
            _, dry, later = np.linalg.lstsq(columns, self.left, rcond=None)[0]
        return self.cost(columns), float(later / dry) if dry > 0 else 0.0

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
        ago[j] = self.late if not self.order else 0.0
        for each in self.rows.samples:
            before = motion_before(each.signals, ago)
            own = replace(each.signals, dq=before.dq[:, j], ddq=before.ddq[:, j])
            columns = law(own)
            if self.order:
                columns = np.column_stack([passed(c, self.order, self.late, 1 / own.period) for c in columns.T])
            made.append(self.how.low_passed(columns, own.kept, own.stride))
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
