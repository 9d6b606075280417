"""What a cause is: a kind with its words, placed at a joint or link with its columns.

Columns are torque, N m (N of a sliding joint), per unit of the cause's parameters, as functions of the samples: the fit
is linear in them. Signs: torque is the motor's, positive along the motion that it drives.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BSpline, make_interp_spline

from armscope.core.types import Array
from armscope.motion.library.clauses import ALL_JOINTS, Clause
from armscope.motion.library.dry_friction import DryFriction
from armscope.motion.library.remedies import Remedy
from armscope.motion.samples.constants import CUTOFF
from armscope.motion.samples.preparation import Signals
from armscope.robot.bodies import Bodies
from armscope.robot.dynamics import MovingArm
from armscope.verdict.effects import UNKNOWN


@dataclass(frozen=True)
class Cause:
    """A kind of cause.

    Attributes:
        name, family: as the verdict has them.
        physics, confirm, cure: one sentence each.
        nonnegative: its one parameter can't be negative.
        in_bodies: masses, dry and viscous friction and armature of a simulator's joint can say it.
        labels: its parameters' names on a card, where their own don't say it.
        clause: what a headline says of it; its title and size where not given.
        remedy: its cure with the numbers found; the cure as it stands where not given.
        cures: of its forms (`PlacedCause.variant`) that are put right in another way.
        open_clause, open_cure: both where its number is not determined.
        each_form: whether its forms may stand side by side, each with a name of its own; not while the arm runs, where
            each run has one moment, and two slopes foretell the next one worse than one.
        confirm_common: how it is confirmed where all joints have it in common; as elsewhere where not given.
    """

    name: str
    family: str
    physics: str
    confirm: str
    cure: str
    nonnegative: bool = False
    in_bodies: bool = False
    labels: Mapping[str, str] = field(default_factory=dict, repr=False, compare=False)
    clause: Clause | None = field(default=None, repr=False, compare=False)
    remedy: Remedy | None = field(default=None, repr=False, compare=False)
    cures: Mapping[str, str] = field(default_factory=dict, repr=False, compare=False)
    open_clause: Clause | None = field(default=None, repr=False, compare=False)
    open_cure: str = field(default="", repr=False, compare=False)
    confirm_common: str = field(default="", repr=False, compare=False)
    each_form: bool = field(default=False, repr=False, compare=False)

    @property
    def nameless(self) -> bool:
        """Whether no known law explains it: it is known by what it follows alone."""
        return self.family == UNKNOWN


@dataclass(frozen=True, eq=False)
class Moment:
    """What columns are functions of: samples, and what the model says of them so far.

    Attributes:
        signals: the samples.
        rigid: (N, m) torque that the masses ask for.
        predicted: (N, m) torque with friction and whatever else is in the model.
        rate: samples per second.
        bodies: what asks for torque on other motions than the samples'; None where no law has any.
        dry: the dry friction that is in ``predicted``; None where that holds none.
        stated: (N, m) torque that the stated masses ask for; None where that is ``rigid``. Of a fitted torque a gain,
            or a curve that holds one, would be the whole model once more, at the price of one number, and put an end
            to friction and masses.
        bare: (N, m) the same with friction and rotors as they are so far; None where that is ``predicted``.
        read: (N, m) torque that a gain is of; None where that is ``predicted``.
    """

    signals: Signals
    rigid: Array
    predicted: Array
    rate: float
    bodies: Bodies | None = None
    dry: DryFriction | None = None
    stated: Array | None = None
    bare: Array | None = None
    read: Array | None = None

    @functools.cached_property
    def without_dry(self) -> Array:
        """(N, m) what is predicted of all joints but for dry friction, where it is known how that turned."""
        return self.predicted if self.dry is None else self.dry.without(self.signals, self.predicted)

    @functools.cached_property
    def path(self) -> BSpline:
        """Of the same over time."""
        return make_interp_spline(self.signals.time, self.without_dry, k=3)

    @functools.cached_property
    def slopes(self) -> tuple[Array, Array, Array]:
        """(N, m, m) how the bodies' torque changes with position, velocity and acceleration of each motor."""
        assert self.bodies is not None
        return self.bodies.slopes(*self.motion)

    @property
    def load(self) -> Array:
        """(N, m) torque that the stated masses ask for."""
        return self.rigid if self.stated is None else self.stated

    @property
    def motion(self) -> tuple[Array, Array, Array]:
        """(N, m) positions, velocities, accelerations of the links."""
        return self.signals.of_links


Columns = Callable[[Moment], Array]


@dataclass(frozen=True, eq=False)
class PlacedCause:
    """A cause at a place.

    Attributes:
        cause: of which kind.
        location: "joint 2", "link 3", "payload", ...
        driver: what it follows.
        parameters: (name, unit) of each column.
        joints: whose torque it is part of, from 0.
        columns: (N, joints, c) at samples; None where it is made of other columns.
        of_background: (joint, number in `BACKGROUND`): it is one of every joint's own columns.
        inertial: (10 n, c) inertial parameters per unit of its own; None where it has columns.
        runs: the only runs in which it is there; empty for all.
        variant: which of several forms of the kind at this place.
        multiplicity: how many values of a scanned number compete.
        is_curve: a free curve.
        scanned: (name, unit, value) of numbers that were scanned.
        expected: (c,) how large its parameters are expected to be beside each other; empty: alike.
        usual: (c,) how large they are as a rule where it is there at all; empty: anything is usual.
    """

    cause: Cause
    location: str
    driver: str
    parameters: tuple[tuple[str, str], ...]
    joints: tuple[int, ...]
    columns: Columns | None = None
    inertial: Array | None = None
    of_background: tuple[int, int] | None = None
    runs: tuple[str, ...] = ()
    variant: str = ""
    multiplicity: int = 1
    is_curve: bool = False
    scanned: tuple[tuple[str, str, float], ...] = ()
    expected: tuple[float, ...] = ()
    usual: tuple[float, ...] = ()

    @property
    def common(self) -> bool:
        """Whether it is one cause of all joints."""
        return self.location == ALL_JOINTS

    @property
    def width(self) -> int:
        """Number of its columns."""
        return len(self.parameters)

    def columns_in(self, moment: Moment) -> Array:
        """(N, joints, c) its columns at samples; zero in runs in which it is not there."""
        assert self.columns is not None
        if self.runs and moment.signals.run not in self.runs:
            return np.zeros((len(moment.rigid), len(self.joints), self.width))
        return self.columns(moment)

    def __str__(self) -> str:
        return f"{self.cause.name.replace('_', ' ')} at {self.location}"


@dataclass(frozen=True)
class Stand:
    """What an arm stands on that rings.

    Attributes:
        hz, damping: of its ringing; damping as a share of the critical one.
        held: N m about x and y of the base in the mean, by which it was levelled.
        tried: how many frequencies were.
    """

    hz: float
    damping: float
    held: tuple[float, float]
    tried: int


@dataclass(frozen=True, eq=False)
class Seen:
    """What the table lets a library know: ranges of what causes follow.

    Attributes:
        arm: the arm.
        q, dq: (m, 2) least and largest position and velocity.
        speeds: (m, K) speeds without their sign, evenly spaced among all.
        load: (m,) largest torque that the stated masses ask for, N m.
        effort: (m,) RMS of the recorded torque.
        time: (2,) s, first and last, of runs since each began.
        temperature: (m, 2) deg C, or None.
        running_min: min that all runs take together.
        runs: names in order.
        moving: (m,) whether each joint moves.
        motion_hz: above which nothing of the motion is seen for noise.
        regressor: (K, 10 n) torque per inertial parameter in some of the samples, joints below each other.
        waves: by joint (from 0), the waves per turn that stand out of what is left, and how many were tried.
        stand: that rings; None where none does.
        both_sides: (m,) whether each joint's link was recorded beside its motor; None where none was.
        width_of_sides: (m,) rad/s (m/s) within which each joint's friction changes sides; None: as in `sides`.
    """

    arm: MovingArm
    q: Array
    dq: Array
    speeds: Array
    load: Array
    effort: Array
    time: Array
    temperature: Array | None
    running_min: float
    runs: tuple[str, ...]
    moving: NDArray[np.bool_]
    regressor: Array
    motion_hz: float = CUTOFF.widest_hz
    waves: Mapping[int, tuple[tuple[int, ...], int]] = field(default_factory=dict)
    stand: Stand | None = None
    both_sides: NDArray[np.bool_] | None = None
    width_of_sides: Array | None = None

    def unit(self, joint: int) -> str:
        """Of a joint's position."""
        return "m" if self.arm.sliding[joint] else "rad"

    def torque(self, joint: int) -> str:
        """Unit of a motor's torque."""
        return "N" if self.arm.sliding[joint] else "N m"
