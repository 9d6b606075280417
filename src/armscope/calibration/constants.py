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


CALIBRATING, IDENTIFYING, FITTING = CalibratingRules(), IdentifyingRules(), FittingRules()
