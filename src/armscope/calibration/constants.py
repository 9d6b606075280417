"""Numbers that decide about a plain calibration; see `armscope.core.constants`."""

from __future__ import annotations

from dataclasses import dataclass

from armscope.core.constants import Constants


@dataclass(frozen=True)
class CalibratingRules(Constants):
    """Which rows take part, which constants are told, and when orientations help."""

    suspect_sigmas: float = 6.0
    """of the noise from which a row is told as suspect; judgement: no chance"""
    suspects: int = 12
    """rows that are told, at most [rows]; judgement: as many are looked at"""
    train_share: float = 0.7
    """of the configurations, to train on; convention: the published protocols'"""
    numbers_per_parameter: float = 1.5
    """measured numbers per parameter, with fewer of which 70 % of a table foretell nothing of the whole; judgement: a
    third of them is then left for the noise"""
    deciding_splits: int = 3
    """on which it is decided whether orientations help; judgement: of speed"""
    deciding_rows: int = 1000
    """to train on that are enough for that [rows]; judgement: of speed"""
    harm: float = 1.01
    """times the held-out RMS of positions beyond which orientations are left out; judgement: 1 % is chance"""
    rows_of_runs: int = 3000
    """to train on that are enough run by run [rows]; judgement: of speed"""
    rows_of_frames: int = 1000
    """in which it is looked for whether runs share a frame [rows]; judgement: of speed"""
    sure_sigmas: float = 3.0
    """standard errors beyond its plausible size at which a constant is doubtful; convention: three sigma"""


@dataclass(frozen=True)
class IdentifyingRules(Constants):
    """Which constants the poses can tell."""

    smallest_trace: float = 1e-3
    """of a change of a constant (per metre, or per radian and metre of reach) that must be left at the tool beyond what
    the others can imitate; judgement: 1 mm shows as 1 micrometre, and no less helps"""
    alike: float = 0.05
    """share of what a constant does to the tool up to which it is imitated if no more is left; convention: one in
    twenty"""
    partners: int = 6
    """of a constant, looked through for what imitates it; judgement: of speed"""
    told_singly: int = 2
    """partners that are told by name; judgement: as many are read"""


@dataclass(frozen=True)
class FittingRules(Constants):
    """How the fit ends."""

    steps: int = 60
    """of Gauss-Newton, at most; judgement: real arms take fewer than ten"""
    negligible_m: float = 1e-8
    """RMS of the tool's motion below which a step is the last [m]; derived: a hundredth of a micrometre"""
    weighings: int = 3
    """fits with orientations; judgement: the first's weight is from the nominal arm, the next's from the fit before"""
    least_damping: float = 1e-13
    """of Gauss-Newton, share of each column's own square that is always there; judgement: values that the rows do not
    tell stay where they are; a thousand times rounding"""
    unseen: float = 1e-15
    """share of the largest eigenvalue below which a direction has no covariance; derived: some times the rounding of
    one operation"""
    no_load_nm: float = 1e-9
    """RMS load at least, by which compliances are scaled [N m]; derived: far below any load"""


@dataclass(frozen=True)
class PriorSizes(Constants):
    """How far constants that imitate each other are held near nominal, and how far off a constant may come out."""

    length_m: float = 3e-3
    """of a length [m]; convention: the reference figures'"""
    angle_rad: float = 5e-3
    """of an angle [rad]; convention: the reference figures'"""
    compliance_rad_nm: float = 1e-3
    """of a joint's compliance [rad/(N m)]; convention: the reference figures'"""
    noise_m: float = 1e-4
    """of a point, that they are weighed against [m]; convention: the reference figures'"""
    wrong_length: float = 0.05
    """share of the reach beyond which a length of the drawing is not so wrong: the fit has lost its way; judgement: 50
    mm of an arm that reaches 1 m, whose castings are machined to 1 mm"""
    wrong_angle_rad: float = 0.1
    """the same of an angle [rad]; judgement: six degrees; ten times the twist that is plausible"""


CALIBRATING, IDENTIFYING, FITTING, SIZES = CalibratingRules(), IdentifyingRules(), FittingRules(), PriorSizes()
