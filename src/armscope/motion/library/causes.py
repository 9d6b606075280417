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
    """A kind of cause."""

    # name, family: as the verdict has them
    name: str
    family: str
    # physics, confirm, cure: one sentence each
    physics: str
    confirm: str
    cure: str
    nonnegative: bool = False  # its one parameter can't be negative
    in_bodies: bool = False  # masses, dry and viscous friction and armature of a simulator's joint can say it
    # its parameters' names on a card, where their own don't say it
    labels: Mapping[str, str] = field(default_factory=dict, repr=False, compare=False)
    # what a headline says of it; its title and size where not given
    clause: Clause | None = field(default=None, repr=False, compare=False)
    # its cure with the numbers found; the cure as it stands where not given
    remedy: Remedy | None = field(default=None, repr=False, compare=False)
    # of its forms (`PlacedCause.variant`) that are put right in another way
    cures: Mapping[str, str] = field(default_factory=dict, repr=False, compare=False)
    # open_clause, open_cure: both where its number is not determined
    open_clause: Clause | None = field(default=None, repr=False, compare=False)
    open_cure: str = field(default="", repr=False, compare=False)
    # how it is confirmed where all joints have it in common; as elsewhere where not given
    confirm_common: str = field(default="", repr=False, compare=False)
    # whether its forms may stand side by side, each with a name of its own; not while the arm runs, where each run has
    # one moment, and two slopes foretell the next one worse than one
    each_form: bool = field(default=False, repr=False, compare=False)

    @property
    def nameless(self) -> bool:
        """Whether no known law explains it: it is known by what it follows alone."""
        return self.family == UNKNOWN


@dataclass(frozen=True, eq=False)
class Moment:
    """What columns are functions of: samples, and what the model says of them so far."""

    signals: Signals  # the samples
    rigid: Array  # (N, m) torque that the masses ask for
    predicted: Array  # (N, m) torque with friction and whatever else is in the model
    rate: float  # samples per second
    bodies: Bodies | None = None  # what asks for torque on other motions than the samples'; None where no law has any
    dry: DryFriction | None = None  # the dry friction that is in ``predicted``; None where that holds none
    # (N, m) torque that the stated masses ask for; None where that is ``rigid``. Of a fitted torque a gain, or a curve
    # that holds one, would be the whole model once more, at the price of one number, and put an end to friction and
    # masses
    stated: Array | None = None
    # (N, m) the same with friction and rotors as they are so far; None where that is ``predicted``
    bare: Array | None = None
    read: Array | None = None  # (N, m) torque that a gain is of; None where that is ``predicted``

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
    """A cause at a place."""

    cause: Cause  # of which kind
    location: str  # "joint 2", "link 3", "payload", ...
    driver: str  # what it follows
    parameters: tuple[tuple[str, str], ...]  # (name, unit) of each column
    joints: tuple[int, ...]  # whose torque it is part of, from 0
    columns: Columns | None = None  # (N, joints, c) at samples; None where it is made of other columns
    inertial: Array | None = None  # (10 n, c) inertial parameters per unit of its own; None where it has columns
    # (joint, number in `BACKGROUND`): it is one of every joint's own columns
    of_background: tuple[int, int] | None = None
    runs: tuple[str, ...] = ()  # the only runs in which it is there; empty for all
    variant: str = ""  # which of several forms of the kind at this place
    multiplicity: int = 1  # how many values of a scanned number compete
    is_curve: bool = False  # a free curve
    scanned: tuple[tuple[str, str, float], ...] = ()  # (name, unit, value) of numbers that were scanned
    expected: tuple[float, ...] = ()  # (c,) how large its parameters are expected to be beside each other; empty: alike
    # (c,) how large they are as a rule where it is there at all; empty: anything is usual
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
    """What an arm stands on that rings."""

    # hz, damping: of its ringing; damping as a share of the critical one
    hz: float
    damping: float
    held: tuple[float, float]  # N m about x and y of the base in the mean, by which it was levelled
    tried: int  # how many frequencies were


@dataclass(frozen=True, eq=False)
class Seen:
    """What the table lets a library know: ranges of what causes follow."""

    arm: MovingArm  # the arm
    # q, dq: (m, 2) least and largest position and velocity
    q: Array
    dq: Array
    speeds: Array  # (m, K) speeds without their sign, evenly spaced among all
    load: Array  # (m,) largest torque that the stated masses ask for, N m
    effort: Array  # (m,) RMS of the recorded torque
    time: Array  # (2,) s, first and last, of runs since each began
    temperature: Array | None  # (m, 2) deg C, or None
    running_min: float  # min that all runs take together
    runs: tuple[str, ...]  # names in order
    moving: NDArray[np.bool_]  # (m,) whether each joint moves
    regressor: Array  # (K, 10 n) torque per inertial parameter in some of the samples, joints below each other
    motion_hz: float = CUTOFF.widest_hz  # above which nothing of the motion is seen for noise
    # by joint (from 0), the waves per turn that stand out of what is left, and how many were tried
    waves: Mapping[int, tuple[tuple[int, ...], int]] = field(default_factory=dict)
    stand: Stand | None = None  # that rings; None where none does
    # (m,) whether each joint's link was recorded beside its motor; None where none was
    both_sides: NDArray[np.bool_] | None = None
    # (m,) rad/s (m/s) within which each joint's friction changes sides; None: as in `sides`
    width_of_sides: Array | None = None

    def unit(self, joint: int) -> str:
        """Of a joint's position."""
        return "m" if self.arm.sliding[joint] else "rad"

    def torque(self, joint: int) -> str:
        """Unit of a motor's torque."""
        return "N" if self.arm.sliding[joint] else "N m"
