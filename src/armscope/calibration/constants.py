"""Numbers that decide about a plain calibration; see `armscope.core.constants`."""

from __future__ import annotations

from dataclasses import dataclass

from armscope.core.constants import Constants, constant


@dataclass(frozen=True)
class CalibratingRules(Constants):
    """Which rows take part, which constants are told, and when orientations help."""

    suspect_sigmas: float = constant(6.0, "of the noise from which a row is told as suspect", "judgement: no chance")
    suspects: int = constant(12, "rows that are told, at most", "judgement: as many are looked at", unit="rows")
    train_share: float = constant(0.7, "of the configurations, to train on", "convention: the published protocols'")
    numbers_per_parameter: float = constant(
        1.5,
        "measured numbers per parameter, with fewer of which 70 % of a table foretell nothing of the whole",
        "judgement: a third of them is then left for the noise",
    )
    deciding_splits: int = constant(3, "on which it is decided whether orientations help", "judgement: of speed")
    deciding_rows: int = constant(1000, "to train on that are enough for that", "judgement: of speed", unit="rows")
    harm: float = constant(
        1.01, "times the held-out RMS of positions beyond which orientations are left out", "judgement: 1 % is chance"
    )
    rows_of_runs: int = constant(3000, "to train on that are enough run by run", "judgement: of speed", unit="rows")
    rows_of_frames: int = constant(
        1000, "in which it is looked for whether runs share a frame", "judgement: of speed", unit="rows"
    )
    sure_sigmas: float = constant(
        3.0, "standard errors beyond its plausible size at which a constant is doubtful", "convention: three sigma"
    )


@dataclass(frozen=True)
class IdentifyingRules(Constants):
    """Which constants the poses can tell."""

    smallest_trace: float = constant(
        1e-3,
        "of a change of a constant (per metre, or per radian and metre of reach) that must be left at the tool beyond "
        "what the others can imitate",
        "judgement: 1 mm shows as 1 micrometre, and no less helps",
    )
    alike: float = constant(
        0.05,
        "share of what a constant does to the tool up to which it is imitated if no more is left",
        "convention: one in twenty",
    )
    partners: int = constant(6, "of a constant, looked through for what imitates it", "judgement: of speed")
    told_singly: int = constant(2, "partners that are told by name", "judgement: as many are read")


@dataclass(frozen=True)
class FittingRules(Constants):
    """How the fit ends."""

    steps: int = constant(60, "of Gauss-Newton, at most", "judgement: real arms take fewer than ten")
    negligible_m: float = constant(
        1e-8,
        "RMS of the tool's motion below which a step is the last",
        "derived: a hundredth of a micrometre",
        unit="m",
    )
    weighings: int = constant(
        3,
        "fits with orientations",
        "judgement: the first's weight is from the nominal arm, the next's from the fit before",
    )
    least_damping: float = constant(
        1e-13,
        "of Gauss-Newton, share of each column's own square that is always there",
        "judgement: values that the rows do not tell stay where they are; a thousand times rounding",
    )
    unseen: float = constant(
        1e-15,
        "share of the largest eigenvalue below which a direction has no covariance",
        "derived: some times the rounding of one operation",
    )
    no_load_nm: float = constant(
        1e-9, "RMS load at least, by which compliances are scaled", "derived: far below any load", unit="N m"
    )


@dataclass(frozen=True)
class PriorSizes(Constants):
    """How far constants that imitate each other are held near nominal, and how far off a constant may come out."""

    length_m: float = constant(3e-3, "of a length", "convention: the reference figures'", unit="m")
    angle_rad: float = constant(5e-3, "of an angle", "convention: the reference figures'", unit="rad")
    compliance_rad_nm: float = constant(
        1e-3, "of a joint's compliance", "convention: the reference figures'", unit="rad/(N m)"
    )
    noise_m: float = constant(
        1e-4, "of a point, that they are weighed against", "convention: the reference figures'", unit="m"
    )
    wrong_length: float = constant(
        0.05,
        "share of the reach beyond which a length of the drawing is not so wrong: the fit has lost its way",
        "judgement: 50 mm of an arm that reaches 1 m, whose castings are machined to 1 mm",
    )
    wrong_angle_rad: float = constant(
        0.1, "the same of an angle", "judgement: six degrees; ten times the twist that is plausible", unit="rad"
    )


CALIBRATING, IDENTIFYING, FITTING, SIZES = CalibratingRules(), IdentifyingRules(), FittingRules(), PriorSizes()
