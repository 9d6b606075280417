"""Numbers that decide which motion shows masses and friction best; see `armscope.core.constants`."""

from __future__ import annotations

from dataclasses import dataclass

from armscope.core.constants import Constants


@dataclass(frozen=True)
class AssumedDrives(Constants):
    """What drives do where nobody states it, and what is plain of how friction and drives behave."""

    speed_rad_s: float = 1.0
    """where no speed limit is stated [rad/s]; judgement: half of what a small industrial arm's slowest joint does"""
    rise_s: float = 0.4
    """in which full speed is reached where no acceleration is stated [s]; judgement: 2.5 rad/s2 for the speed
    assumed"""
    unlimited: float = 1e6
    """from which a limit is a file's way to say that there is none [rad/s or N m]; convention: pinocchio's and URDFs'
    are larger"""
    standstill_rad_s: float = 0.01
    """width over which the sign of a speed turns [rad/s]; judgement: a hundredth of a joint's speed"""
    stribeck_rad_s: float = 0.1
    """speed within which friction is that of standing [rad/s]; judgement: typical of the Stribeck effect"""
    curve_degree: int = 5
    """of the polynomial that a cable's torque follows over the angle; judgement: a curve, not a table"""
    lag: float = 1e-5
    """share of a motion by which a link is put behind its drive, for torque's slope; derived: hardly bent, and far
    above rounding"""


@dataclass(frozen=True)
class Showing(Constants):
    """What any motion at all could show."""

    states: int = 400
    """random states of the arm from which it is seen; judgement: four times the parameters of an arm of seven joints,
    with seven torques each"""
    dependent: float = 1e-8
    """share of the largest, below which a column is zero or depends on others; derived: exact in floating point, far
    above rounding"""
    same: float = 1e-6
    """share of torque in random states below which two causes differ by none: no motion tells them apart; derived: far
    above what is dependent, far below any noise"""
    nothing: float = 1e-9
    """below which a torque, a scale or a share is none; derived: far above rounding"""
    rank: float = 1e-9
    """share of the largest singular value below which rivals imitate nothing; derived: far above rounding"""


@dataclass(frozen=True)
class MotionSearch(Constants):
    """How a motion is found."""

    period_s: float = 20.0
    """after which a motion repeats, where none is asked for [s]; judgement: a minute records three"""
    harmonics: int = 5
    """of it; judgement: up to 0.25 Hz in 20 s, which arms follow"""
    rate_hz: float = 100.0
    """samples per second of the table, where none is asked for [Hz]; judgement: controllers take that"""
    rounds: int = 600
    """of bettering [rounds]; judgement: time"""
    looked_at: int = 2500
    """samples of the table, spread evenly, that are kept clear while a motion is bettered; the one that is told is seen
    in all of them [samples]; judgement: time; more than the usual table has"""
    at_once: int = 20_000
    """samples that are looked at together [samples]; judgement: memory"""
    samples: int = 80
    """of a motion while it is looked for [samples]; judgement: time"""
    per_wave: int = 8
    """of its shortest wave at least [samples]; derived: a peak is met to 8 % at worst"""
    finer: int = 4
    """times as fine as positions, in which torque is looked at; judgement: it peaks where several joints' waves meet"""
    starts: int = 24
    """random motions, the best of which is bettered; their median is what "before" means; judgement: time"""
    uses: tuple[float, float, float, float] = (0.95, 0.7, 0.5, 0.35)
    """shares of the limits that are tried in turn; judgement: until torques and surroundings allow the motion"""
    smaller: tuple[float, float, float, float, float] = (0.5, 0.35, 0.25, 0.15, 0.1)
    """shares of their waves that are tried about clear poses; judgement: where no motion over the limits is allowed"""
    clear_poses: int = 2000
    """random poses among which clear ones are looked for [poses]; judgement: of an arm that folds onto itself one in a
    hundred would do"""
    torque_use: float = 0.99
    """share of the torques' limits that may be used; judgement: between its samples a torque is higher by less"""
    narrowing: float = 0.35
    """by which coefficients are moved at first, as a share of their size; less and less towards the end; judgement: a
    third; other motions, not others altogether"""
    least_step: float = 0.02
    """by which they are moved at the end; judgement: a finer one betters little"""


DRIVES, SHOWING, MOTION = AssumedDrives(), Showing(), MotionSearch()
