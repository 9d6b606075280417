"""What torques of a moving arm say of signs, order, units and zeros: the simplest mistake that explains them, first.

A turned sign spoils what masses explain as another order does, and another order can pass for turned signs. So each is
mended for a trial, and what is then still found decides between them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import chain
from typing import Literal

import numpy as np

from armscope.check.motion_channels import OF_MASSES, SIGN, Channels, odd_channels, turn
from armscope.check.motion_constants import MOTION
from armscope.check.motion_directions import (
    left_of_either_sign,
    moved_zeros,
    other_way_round,
    told_by_masses,
    zeros_elsewhere,
)
from armscope.check.motion_load import factors_of, is_of_another_size
from armscope.check.motion_readings import OtherReading, Samples, exchanged, left_in_all, read_otherwise, tried_readings
from armscope.check.suspicion import Suspicion
from armscope.core.sampling import spread_evenly
from armscope.robot.dynamics import MovingArm


def signs_and_sizes(samples: Samples, arm: MovingArm, of: Channels) -> Iterator[Suspicion]:
    """Sign and size of torques against what the stated masses ask for, with friction and a rotor fitted.

    Args:
        samples: differenced over a twentieth of a second.
        arm: as stated.
        of: the columns; of currents the sign alone is judged, as the size is their gain's.

    Yields:
        A problem for every sign that is turned, and what is far from the masses' torque.
    """
    few = samples.rows(spread_evenly(len(samples.q), MOTION.rows))
    rigid = arm.torques(few.q, few.dq, few.ddq, arm.inertial)
    factors = factors_of(few, rigid)
    most = float(np.median(np.abs(list(factors.values())))) if factors else 1.0
    for j, factor in factors.items():
        if factor < 0:
            yield Suspicion("problem", f"{of.names[j]} {SIGN} to {OF_MASSES}", _turned(arm, of))
        elif not of.currents and is_of_another_size(factor):
            yield _other_size(of.names[j], factor, most)


def _turned(arm: MovingArm, of: Channels) -> str:
    cure = turn(of.currents) if of.currents else f"Is it the load's torque? {turn(of.currents)}"
    if arm.model.gravity.linear[2] > 0:
        cure = f"gravity_m_s2 of robot.yaml points up: does the arm hang from a ceiling? If it does: {cure}"
    return cure


def _other_size(name: str, factor: float, most: float) -> Suspicion:
    # a load that nobody stated does that to a wrist, and is no mistake of the table
    far = not 1 / MOTION.no_load <= factor <= MOTION.no_load or not 1 / MOTION.no_load <= most <= MOTION.no_load
    weight: Literal["problem", "hint"] = (
        "problem" if far or not 1 / MOTION.other_size < most < MOTION.other_size else "hint"
    )
    cure = "Is it the torque before the gear, another unit, or another load than stated?"
    return Suspicion(weight, f"{name} is {factor:.3g} times what the stated masses ask for", cure)


@dataclass(frozen=True, eq=False)
class _Table:
    """Samples as they are read for a trial, with what is odd in them."""

    samples: Samples
    arm: MovingArm
    of: Channels

    @property
    def odd(self) -> list[Suspicion]:
        """Of single channels."""
        told = signs_and_sizes(self.samples, self.arm, self.of)
        return list(odd_channels(self.samples, self.arm, self.of, told))

    @property
    def reading(self) -> OtherReading | None:
        """Units or an order other than stated."""
        otherwise = read_otherwise(self.samples, self.arm)
        return next(chain(otherwise, exchanged(self.samples, self.arm, self.of.names)), None)

    @property
    def left(self) -> float:
        """Logarithm of the share that each joint's motion leaves of its torque, summed."""
        return left_in_all(self.samples, self.arm)

    def has_better_zero(self, reading: OtherReading) -> bool:
        """Whether a zero elsewhere leaves less than a reading does."""
        few = self.samples.rows(spread_evenly(len(self.samples.q), MOTION.reading_rows))
        left = left_in_all(reading.samples, self.arm)
        return any(left_in_all(moved, self.arm) < left for _, _, moved in moved_zeros(few, self.arm))

    def counted(self, *others: OtherReading | None) -> OtherReading | None:
        """With joints counted the other way round, if that explains more than other readings and zeros elsewhere."""
        counted = other_way_round(self.samples, self.arm, self.of.names)
        if counted is None:
            return None
        least = left_of_either_sign(counted.samples, self.arm)
        few = self.samples.rows(spread_evenly(len(self.samples.q), MOTION.reading_rows))
        rivals = chain(
            (each.samples for each in others if each is not None),
            (moved for _, _, moved in moved_zeros(few, self.arm)),
            (each.then(few) for each in tried_readings(few, self.arm)),
        )
        return counted if all(left_of_either_sign(each, self.arm) > least for each in rivals) else None

    def of_either(self, odd: Suspicion) -> Suspicion:
        """A sign as told; where masses do not tell it from a position that is counted the other way, as either."""
        joint = next((j for j, name in enumerate(self.of.names) if odd.statement.startswith(f"{name} {SIGN}")), None)
        if joint is None or told_by_masses(self.samples, self.arm, joint):
            return odd
        either = f" Or q{joint + 1}, with its speeds, is counted the other way round: masses tell these not apart."
        return replace(odd, cure=odd.cure + either)

    def turned(self, odd: list[Suspicion]) -> _Table:
        """With every sign turned of which that is told."""
        names = {each.statement.split()[0] for each in odd if _of_sign(each)}
        return replace(self, samples=self.samples.turned([j for j, name in enumerate(self.of.names) if name in names]))

    def read(self, reading: OtherReading) -> _Table:
        """As a reading has it."""
        return replace(self, samples=reading.samples, of=self.of.reordered(reading.order))


def mistakes(samples: Samples, arm: MovingArm, of: Channels) -> list[Suspicion]:
    """What torques say of units, signs, order and zeros; where order or a zero says more than signs, that alone.

    Args:
        samples: differenced over a twentieth of a second.
        arm: as stated.
        of: the columns of torque or current.

    Returns:
        Problems and hints, what is to be mended first before what is seen after that.
    """
    backward = np.flatnonzero(np.array(of.gains) < 0).tolist()
    table = _Table(samples.turned(backward), arm, replace(of, gains=tuple(map(abs, of.gains))))
    odd, reading = table.odd, table.reading
    if (counted := table.counted(reading, table.turned(odd).reading)) is not None:
        return _in_turn(list(counted.told), table.read(counted).odd, "counted so")
    odd = [table.of_either(each) for each in odd]
    if reading is None or table.has_better_zero(reading):
        zeros = list(zeros_elsewhere(table.samples, arm))
        sure = any(each.weight == "problem" for each in zeros)
        return [*zeros, *(each for each in odd if not (sure and OF_MASSES in each.statement))]
    signs, then = [each for each in odd if _of_sign(each)], table.read(reading)
    odd_then = then.odd
    if not signs:
        return _in_turn(list(reading.told), odd_then, "in that order or unit")
    turned = table.turned(odd)
    return _sooner(_Trial(turned, signs, odd, turned.reading), _Trial(then, list(reading.told), odd_then))


@dataclass(frozen=True, eq=False)
class _Trial:
    """A mistake that is taken to be there, and what is left to tell once it is mended."""

    table: _Table
    first: list[Suspicion]
    odd: list[Suspicion]  # all that is told of single channels beside it
    reading: OtherReading | None = None  # that is still needed

    @property
    def settles(self) -> bool:
        """Whether no other mistake is left to mend."""
        return self.reading is None and not any(_of_sign(each) for each in self.odd if each not in self.first)


def _sooner(signs: _Trial, reading: _Trial) -> list[Suspicion]:
    """Turned signs, or a reading: what settles it, leaves less, or is the simpler of two alike."""
    more = signs.table.left - reading.table.left
    if signs.settles != reading.settles:
        first_signs = signs.settles
    elif abs(more) > np.log(MOTION.clearly):
        first_signs = more < 0
    else:
        first_signs = len(signs.first) == 1
    if not first_signs:
        return _in_turn(reading.first, reading.odd, "in that order or unit")
    after = [] if signs.reading is None else list(signs.reading.told)
    return _in_turn(signs.odd, after, "with turned signs put right")


def _in_turn(first: list[Suspicion], then: list[Suspicion], mended: str) -> list[Suspicion]:
    """What is to be mended first, and what is told after it, in words that say so."""
    return [*first, *(replace(each, statement=f"{mended}, {each.statement}") for each in then)]


def _of_sign(each: Suspicion) -> bool:
    return SIGN in each.statement
