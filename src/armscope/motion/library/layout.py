"""Which column of a motion's model stands where: every joint's own, masses, gains, the drives' response, causes."""

from __future__ import annotations

import functools
import itertools
from dataclasses import dataclass

import numpy as np

from armscope.core.types import Array, Indices
from armscope.motion.constants import PRIOR
from armscope.motion.library.catalogue import LINK_MASS
from armscope.motion.library.causes import PlacedCause
from armscope.motion.library.laws import Law, is_of_a_gain
from armscope.robot.dynamics import MovingArm

NAMED_OF_OWN = ("offset", "coulomb", "viscous", "inertia")
OWN_NAMES = (*NAMED_OF_OWN, "blunter", "rounder", "later")
"""Columns that every joint has: offset, dry and viscous friction, rotor inertia, how friction changes sides, and when.

The last three are no causes: friction turns over a little more speed, over some milliseconds, and some milliseconds
later than the speed, in a way that grease, presliding, filters and sampling make. They are free within limits, so that
no cause is named for them, and so that no other number of the joint takes them up: a delay of all torque in their place
takes viscous friction, times its seconds, from the rotor's inertia. A step that something rounds off is, beyond its
delay, half the variance of that over time, times the second derivative; so whatever rounds it off, the last two say it
to the second order. It takes longer where a joint turns more slowly: that is the first.
"""
OWN, CAUSES_OF_OWN = len(OWN_NAMES), len(NAMED_OF_OWN)
DRY, VISCOUS, BLUNTER, ROUNDER, LATER = map(OWN_NAMES.index, ("coulomb", "viscous", "blunter", "rounder", "later"))


@dataclass(frozen=True, eq=False)
class TorqueLayout:
    """Which column stands where: background of each joint, inertial parameters, gains, causes."""

    arm: MovingArm  # the arm
    placed: tuple[PlacedCause, ...]  # the causes that compete
    # whether torques come from currents, whose gains are known to some percent; else they are read true, or all of them
    # a little wrong
    with_gains: bool
    # (m,) rad/s (m/s) within which each joint's friction changes sides; None: as in `sides`
    width_of_sides: Array | None = None
    order_of_sides: Indices | None = None  # (m,) of the low-pass by which it does so late; None or 0: it is shifted

    @property
    def own(self) -> Indices:
        """(7 m,) of `OWN`, joint by joint."""
        return np.arange(OWN * self.arm.n_motors)

    @property
    def frames(self) -> Indices:
        """Those of `own` that are always free: friction and rotors that robot.yaml does not state.

        Where it states them all, the drives' response: something must be free for noise to be told from torque.
        """
        free = np.ones((self.arm.n_motors, OWN), dtype=np.bool_)
        free[:, :CAUSES_OF_OWN] = np.isnan(self.arm.stated_background)
        free[:, [0, *range(CAUSES_OF_OWN, OWN)]] = False
        return np.flatnonzero(free.ravel()) if free.any() else self.response

    @property
    def response(self) -> Indices:
        """(1,) how drives round off all torque, in seconds squared; after `gains`."""
        return len(self.own) + len(self.inertial) + len(self.gains) + np.arange(1)

    @property
    def reversals(self) -> Indices:
        """(m, 3) of each joint, how its friction changes sides: the last of `OWN`."""
        return np.arange(self.arm.n_motors)[:, None] * OWN + np.arange(CAUSES_OF_OWN, OWN)

    @property
    def inertial(self) -> Indices:
        """(10 n,) inertial parameters, in shares of `inertial_scale`."""
        return len(self.own) + np.arange(len(self.arm.inertial))

    @functools.cached_property
    def link_masses(self) -> tuple[Indices, Array]:
        """(k,) columns of links that may be heavier in proportion, and (k,) kg that each is stated to weigh.

        None by currents of gains that are not stated to be sure: then a factor of each joint's torque is free, and the
        weights of links would be much the same over again.
        """
        unsure = self.with_gains and bool(np.isnan(self.arm.gain_uncertainty).any())
        heavier = [
            (int(columns[0]), self.arm.inertial[int(cause.inertial[:, 0].argmax()) // 10 * 10])
            for cause, columns in zip(self.placed, self.columns, strict=True)
            if cause.cause is LINK_MASS and not cause.variant and cause.inertial is not None and not unsure
        ]
        return np.array([column for column, _ in heavier], dtype=np.intp), np.array([kg for _, kg in heavier])

    @property
    def masses(self) -> Indices:
        """All columns by which masses may be off without a name."""
        return np.concatenate([self.inertial, self.link_masses[0]])

    @property
    def gains(self) -> Indices:
        """(m,) shares of each joint's torque; none where no causes compete."""
        compete = self.with_gains or bool(self.placed)
        return len(self.own) + len(self.inertial) + np.arange(self.arm.n_motors if compete else 0)

    @property
    def of_gains(self) -> str:
        """What is off by a gain, in words."""
        return "torque constants" if self.with_gains else "recorded torques"

    @functools.cached_property
    def scaling(self) -> list[tuple[int, int]]:
        """(joint, column) of all that says by which share more of a joint's torque is recorded than there is."""
        found = [(j, int(column)) for j, column in enumerate(self.gains)]
        laws = ((cause.columns, index) for cause, index in zip(self.placed, self.columns, strict=True))
        return found + [(law.joints[0], int(at[0])) for law, at in laws if isinstance(law, Law) and is_of_a_gain(law)]

    @functools.cached_property
    def of_readings(self) -> Indices:
        """Columns of the torque as it is recorded: gains, and what bends their curve; all others are true torque."""
        laws = [is_of_a_gain(cause.columns) for cause in self.placed]
        return np.concatenate([self.gains, *itertools.compress(self.columns, laws)]).astype(np.intp)

    @functools.cached_property
    def columns(self) -> list[Indices]:
        """Of each cause."""
        start, columns = int(self.response[0]) + 1, []
        for cause in self.placed:
            if cause.of_background is not None:
                columns.append(np.array([OWN * cause.of_background[0] + cause.of_background[1]]))
            else:
                columns.append(np.arange(start, start + cause.width))
                start += cause.width
        return columns

    @functools.cached_property
    def made_of_masses(self) -> tuple[Indices, Array]:
        """(C,) columns that are combinations of inertial ones, and (10 n, C) their shares of these."""
        made = [
            (cause, index) for cause, index in zip(self.placed, self.columns, strict=True) if cause.inertial is not None
        ]
        if not made:
            return np.empty(0, dtype=np.intp), np.empty((len(self.inertial), 0))
        shares = np.hstack([np.asarray(cause.inertial) for cause, _ in made]) / self.inertial_scale[:, None]
        return np.concatenate([index for _, index in made]), shares

    @functools.cached_property
    def made_in(self) -> list[tuple[str, ...]]:
        """The only runs in which each of these is there; none: all."""
        return [cause.runs for cause in self.placed if cause.inertial is not None for _ in range(cause.width)]

    @property
    def differs_by_run(self) -> bool:
        """Whether some are there in some runs only."""
        return any(self.made_in)

    def shares_in(self, run: str) -> Array:
        """(10 n, C) shares of `made_of_masses` in a run: none of what is not there."""
        there = np.array([not runs or run in runs for runs in self.made_in], dtype=np.float64)
        return self.made_of_masses[1] * there

    @functools.cached_property
    def width(self) -> int:
        """Number of columns."""
        last = max((int(columns[-1]) for columns in self.columns), default=0)
        return max(last, int(self.response[0])) + 1

    @functools.cached_property
    def reach(self) -> float:
        """How far the tool point is from the first moving link's axis along the stretched arm, m."""
        of_links = (
            np.linalg.norm(self.arm.model.jointPlacements[j].translation) for j in range(2, self.arm.model.njoints)
        )
        return float(sum(of_links)) + float(np.linalg.norm(self.arm.point_load()[-9:-6]))

    @property
    def inertial_scale(self) -> Array:
        """(10 n,) kg, kg m, kg m^2 of each link: its mass, mass x length, mass x length^2."""
        mass = self.arm.inertial[::10]
        mass = np.maximum(mass, PRIOR.lightest_share * mass.mean())
        reach = sum(
            np.linalg.norm(self.arm.model.jointPlacements[j].translation) for j in range(2, self.arm.model.njoints)
        )
        length = max(float(reach) / max(self.arm.n_links - 1, 1), 0.05)
        return np.asarray(np.concatenate([m * np.array([1.0, *[length] * 3, *[length**2] * 6]) for m in mass]))
