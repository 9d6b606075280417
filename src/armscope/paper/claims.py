"""The paper's claims, each judged on every robot that agrees with its printed equations.

A claim `holds` where at least 95 % of the robots bear it out, `does not hold` where at most 5 % do, else it `depends`.
Each is turned into one yes or no per robot, and into one number; both stand in the table with the paper's own.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from armscope.core.types import Array
from armscope.errormodels import FOURIER_2_AI, POLYNOMIAL_4_AI, SDP_CI, FittedModel
from armscope.paper.outlook import PLAIN, PRODUCTS, SUB_VOLUMES
from armscope.paper.printed import (
    AXES,
    IDENTIFICATION,
    PRINTED_MODELS,
    TEST_TRAJECTORIES,
    TRAJECTORIES,
    UNCOMPENSATED,
    printed_table2,
)
from armscope.paper.residuals import SPATIAL, typical

HOLDS_FROM, FAILS_TO = 0.95, 0.05
CLOSE_PER_CENT = 1.0
"""A swarm counts as equal to least squares if it stays within this above it."""

FOURTH, FOURIER = POLYNOMIAL_4_AI.name, FOURIER_2_AI.name


@dataclass(frozen=True)
class _Judged:
    """One claim's outcome: yes or no and a number per robot, and the number that Table 2 itself gives."""

    per_robot: NDArray[np.bool_]
    numbers: Array
    printed: float = float("nan")


@dataclass(frozen=True)
class _Claim:
    """What the paper says, where, what counts as yes for one robot, what the number is, and who judges."""

    claim: str
    source: str
    criterion: str
    unit: str
    number_is: str
    judge: Callable[[_Evidence], _Judged | None]


def claims(
    residuals: pd.DataFrame,
    fits: Sequence[FittedModel],
    sub_volume_residuals: pd.DataFrame,
    outlook: pd.DataFrame,
    fits_as_printed: Sequence[FittedModel] = (),
) -> pd.DataFrame:
    """Each claim with its verdict.

    Args:
        residuals: of all robots and of the six models (see `residual_table`); the swarm's median seed counts.
        fits: of all robots.
        sub_volume_residuals: see `sub_volumes`.
        outlook: see `armscope.paper.outlook.outlook`.
        fits_as_printed: swarms with the update rule as the paper prints it ("original"), for the claim about it.

    Returns:
        Columns claim, source (page and section), criterion (what counts as yes for one robot), verdict ("holds", "does
        not hold", "depends"), anchored (yes or no for the anchored robot), share_of_robots, robots, number (median over
        the robots), number_anchored, number_low, number_high (5 and 95 % of the robots), number_printed (the same
        number from the printed Table 2, if it has one), unit, number_is.
    """
    evidence = _Evidence(typical(residuals), list(fits), list(fits_as_printed), sub_volume_residuals, outlook)
    judged = [(each, each.judge(evidence)) for each in CLAIMS]
    return pd.DataFrame([_row(each, outcome) for each, outcome in judged if outcome is not None])


def _row(claim: _Claim, judged: _Judged) -> dict[str, object]:
    share = float(np.mean(judged.per_robot))
    low, median, high = _quantiles(judged.numbers)
    return {
        "claim": claim.claim,
        "source": claim.source,
        "criterion": claim.criterion,
        "verdict": "holds" if share >= HOLDS_FROM else "does not hold" if share <= FAILS_TO else "depends",
        "anchored": "yes" if judged.per_robot[0] else "no",
        "share_of_robots": share,
        "robots": len(judged.per_robot),
        "number": median,
        "number_anchored": float(judged.numbers[0]),
        "number_low": low,
        "number_high": high,
        "number_printed": judged.printed,
        "unit": claim.unit,
        "number_is": claim.number_is,
    }


def _quantiles(numbers: Array) -> tuple[float, float, float]:
    """5, 50, 95 %, also where some are infinite (no interpolation between values)."""
    low, median, high = np.quantile(numbers, [0.05, 0.5, 0.95], method="nearest")
    return float(low), float(median), float(high)


@dataclass(frozen=True, eq=False)
class _Evidence:
    """What verdicts rest on: RMS errors by robot (rows) and (model, trajectory, axis), fits, sub-volumes, products."""

    cells: pd.DataFrame
    fits: list[FittedModel]
    fits_as_printed: list[FittedModel]
    sub_volumes: pd.DataFrame
    outlook: pd.DataFrame

    @cached_property
    def spatial(self) -> pd.DataFrame:
        """3D errors by robot and (model, trajectory)."""
        return pd.DataFrame(self.cells.xs(SPATIAL, axis=1, level="axis"))

    @cached_property
    def printed(self) -> pd.Series:
        """Table 2 by (model, trajectory, axis)."""
        return printed_table2().set_index(["model", "trajectory", "axis"])["printed"]

    @cached_property
    def printed_spatial(self) -> pd.Series:
        """3D length of Table 2's x, y, z errors by (model, trajectory)."""
        return (self.printed**2).groupby(["model", "trajectory"]).sum() ** 0.5

    def over_tests(self, model: str) -> Array:
        """3D RMS over the held-out trajectories together, each with the same weight (they have equally many points)."""
        squares = [self.spatial[model, name].to_numpy() ** 2 for name in TEST_TRAJECTORIES]
        return np.asarray(np.sqrt(np.mean(squares, axis=0)))


def _reduced(evidence: _Evidence) -> _Judged:
    pairs = [(model, trajectory) for model in PRINTED_MODELS for trajectory in TEST_TRAJECTORIES]

    def smallest(errors: pd.DataFrame | pd.Series) -> Array:
        return np.asarray(np.min([errors[UNCOMPENSATED, t] / errors[m, t] for m, t in pairs], axis=0))

    ratios = smallest(evidence.spatial)
    return _Judged(ratios > 1, ratios, float(smallest(evidence.printed_spatial)))


def _shrunk_as_printed(evidence: _Evidence) -> _Judged:
    cells, printed = evidence.cells, evidence.printed
    shrunk = [
        cells[UNCOMPENSATED, t, a] / cells[m, t, a] >= printed[UNCOMPENSATED, t, a] / printed[m, t, a]
        for m in PRINTED_MODELS
        for t in TRAJECTORIES
        for a in AXES
    ]
    share = np.mean(shrunk, axis=0)
    return _Judged(share >= 0.5, 100 * share, 100.0)


def _second_degree(evidence: _Evidence) -> _Judged:
    pairs = [(f"SDP({space})", f"FDP({space})", axis) for space in ("CI", "AI") for axis in AXES]

    def largest(errors: pd.DataFrame | pd.Series) -> Array:
        ratios = [errors[s, IDENTIFICATION, a] / errors[f, IDENTIFICATION, a] for s, f, a in pairs]
        return np.asarray(np.max(ratios, axis=0))

    ratios = largest(evidence.cells)
    # the swarm's last digits must not decide between two equal fits
    return _Judged(ratios <= 1 + 1e-4, ratios, float(largest(evidence.printed)))


def _cartesian_beats_angular(evidence: _Evidence, trajectory: str) -> _Judged:
    pairs = [("FDP(AI)", "FDP(CI)"), ("SDP(AI)", "SDP(CI)")]

    def smaller(errors: pd.DataFrame | pd.Series) -> Array:
        return np.asarray(np.min([errors[a, trajectory] / errors[c, trajectory] for a, c in pairs], axis=0))

    ratios = smaller(evidence.spatial)
    return _Judged(ratios > 1, ratios, float(smaller(evidence.printed_spatial)))


def _fourier_beats_ordinary(evidence: _Evidence) -> _Judged:
    ratios = evidence.over_tests(FOURTH) / evidence.over_tests(FOURIER)
    return _Judged(ratios > 1, ratios)


def _remedied(evidence: _Evidence) -> _Judged:
    best = np.minimum(evidence.over_tests(FOURTH), evidence.over_tests(FOURIER))
    ratios = evidence.over_tests("FDP(CI)") / best
    return _Judged(ratios >= 1, ratios)


def _improved(evidence: _Evidence) -> _Judged:
    worse = np.maximum(evidence.over_tests(FOURTH), evidence.over_tests(FOURIER))
    ratios = evidence.over_tests("FDP(AI)") / worse
    return _Judged(ratios > 1, ratios)


def _equals_least_squares(evidence: _Evidence) -> _Judged:
    worst = _by_robot(evidence.fits, lambda fit: float(fit.excess_percent.max()))
    return _Judged(worst <= CLOSE_PER_CENT, worst)


def _iterations_suffice(evidence: _Evidence) -> _Judged:
    numbers = _by_robot(evidence.fits, _slowest)
    return _Judged(np.isfinite(numbers), numbers)


def _as_printed_suffices(evidence: _Evidence) -> _Judged | None:
    if not evidence.fits_as_printed:
        return None
    worst = _by_robot(evidence.fits_as_printed, lambda fit: float(fit.excess_percent.max()))
    middle = _by_robot(evidence.fits_as_printed, lambda fit: float(np.median(fit.excess_percent)))
    return _Judged(worst <= CLOSE_PER_CENT, middle)


def _by_robot(fits: Sequence[FittedModel], number: Callable[[FittedModel], float]) -> Array:
    """The largest number over each robot's fits, robots in the order of the fits."""
    worst: dict[str, float] = {}
    for fit in fits:
        worst[fit.label] = max(worst.get(fit.label, -np.inf), number(fit))
    return np.array(list(worst.values()))


def _slowest(fit: FittedModel) -> float:
    """The iteration at which the last of the swarms is close to least squares; infinite if one never is."""
    close = fit.history_mm <= fit.least_squares_mm[None, :, None] * (1 + CLOSE_PER_CENT / 100)
    first = np.where(close.any(axis=2), close.argmax(axis=2), np.inf)
    return float(first.max())


def _sub_volumes_help(evidence: _Evidence, regions: int, held_out: bool) -> _Judged:
    table = evidence.sub_volumes
    chosen = table[(table["model"] == "FDP(CI)") & ((table["trajectory"] != IDENTIFICATION) == held_out)]
    squares = chosen.assign(square=chosen["rms_mm"] ** 2).groupby(["robot", "regions"])["square"].mean()
    rms = (squares.unstack("regions") ** 0.5).reindex(evidence.cells.index)
    ratios = (rms[1] / rms[regions]).to_numpy()
    return _Judged(ratios > 1, ratios)


def _chosen_by_cross_validation(evidence: _Evidence) -> _Judged:
    table = evidence.outlook
    chosen = table[(table["model"] == "FDP(CI)") & (table["kind"] == SUB_VOLUMES)].groupby("robot")["size"].first()
    numbers = chosen.reindex(evidence.cells.index).to_numpy(dtype=float)
    return _Judged(numbers > 1, numbers)


def _extension_helps(evidence: _Evidence, model: str, kind: str) -> _Judged:
    table = evidence.outlook
    tests = table[(table["model"] == model) & (table["trajectory"] != IDENTIFICATION)]
    squares = tests.assign(square=tests["rms_mm"] ** 2).groupby(["robot", "kind"])["square"].mean()
    rms = (squares.unstack("kind") ** 0.5).reindex(evidence.cells.index)
    ratios = (rms[PLAIN] / rms[kind]).to_numpy()
    return _Judged(ratios > 1, ratios)


def _regions_claim(model: str, words: str) -> _Claim:
    return _Claim(
        f"Sub-volumes improve accuracy: as many as cross-validation chooses, {words}",
        "p. 961, section 6.3; p. 965, section 8",
        f"3D error of {model} with the chosen number of blended regions below that with one, over I-III together",
        "",
        "ratio one region / chosen number, 3D errors over trajectories I-III",
        partial(_extension_helps, model=model, kind=SUB_VOLUMES),
    )


def _products_claim(model: str, words: str) -> _Claim:
    return _Claim(
        f"Products improve accuracy: {words}",
        "p. 962, section 6.3 (outlook)",
        f"3D error of {model} with products chosen sparsely by cross-validation below the sums', over I-III together",
        "",
        "ratio sums / products, 3D errors over trajectories I-III",
        partial(_extension_helps, model=model, kind=PRODUCTS),
    )


CLAIMS = (
    _Claim(
        "The models predict the errors: what is left is smaller",
        "p. 965, section 8",
        "each of the four models leaves a smaller 3D error on each of the three test trajectories",
        "",
        "smallest ratio uncompensated / residual of the 3D errors",
        _reduced,
    ),
    _Claim(
        "The models predict the errors: they shrink as printed",
        "p. 961, Table 2; p. 965, section 8",
        "in at least half of the printed cells the error shrinks at least by the printed factor",
        "%",
        "share of the 48 printed cells that shrink at least by the printed factor",
        _shrunk_as_printed,
    ),
    _Claim(
        "Second-degree polynomials fit the identification poses at least as well as first-degree ones",
        "p. 961, Table 2",
        "SDP <= FDP in x, y and z, for both inputs",
        "",
        "largest ratio SDP / FDP",
        _second_degree,
    ),
    _Claim(
        "Cartesian input beats angular input on trajectory I",
        "p. 962, section 7.1",
        "3D error of FDP(CI) below FDP(AI), and of SDP(CI) below SDP(AI)",
        "",
        "ratio AI / CI of the 3D errors, the smaller of FDP and SDP",
        partial(_cartesian_beats_angular, trajectory=TEST_TRAJECTORIES[0]),
    ),
    _Claim(
        "Cartesian input beats angular input on trajectory II",
        "p. 964, section 7.2",
        "3D error of FDP(CI) below FDP(AI), and of SDP(CI) below SDP(AI)",
        "",
        "ratio AI / CI of the 3D errors, the smaller of FDP and SDP",
        partial(_cartesian_beats_angular, trajectory=TEST_TRAJECTORIES[1]),
    ),
    _Claim(
        "PSO is an alternative to least squares",
        "p. 961, section 6.3",
        f"no fit ends more than {CLOSE_PER_CENT:g} % above least squares (with the configured update rule)",
        "%",
        "largest excess over the least-squares RMS residual",
        _equals_least_squares,
    ),
    _Claim(
        "200 iterations suffice",
        "p. 960, section 5",
        f"every fit is within {CLOSE_PER_CENT:g} % of least squares by its last iteration (configured update rule)",
        "iterations",
        f"until the slowest fit is within {CLOSE_PER_CENT:g} % of least squares (infinite: never)",
        _iterations_suffice,
    ),
    _Claim(
        "200 iterations suffice with the velocity update as printed",
        "p. 960, section 5",
        f"every fit is within {CLOSE_PER_CENT:g} % of least squares by its last iteration",
        "%",
        "median excess over the least-squares RMS residual",
        _as_printed_suffices,
    ),
    _Claim(
        "Fourier polynomials are more accurate than ordinary polynomials",
        "p. 962, section 6.3",
        "over I-III together, Fourier with 2 harmonics comes closer than the 4th degree (75 coefficients each)",
        "",
        "ratio ordinary / Fourier of the 3D errors over trajectories I-III",
        _fourier_beats_ordinary,
    ),
    _Claim(
        "75 coefficients remedy the angular models",
        "p. 962, section 7.1",
        "over I-III together, Fourier or 4th degree (AI) comes at least as close as FDP(CI)",
        "",
        "ratio FDP(CI) / best of the two, 3D errors over trajectories I-III",
        _remedied,
    ),
    _Claim(
        "75 coefficients improve on the angular first degree",
        "p. 964, section 7.2",
        "over I-III together, both Fourier and 4th degree (AI) come closer than FDP(AI)",
        "",
        "ratio FDP(AI) / worse of the two, 3D errors over trajectories I-III",
        _improved,
    ),
    _Claim(
        "Sub-volumes improve accuracy: 2 regions",
        "p. 961, section 6.3; p. 965, section 8",
        "3D error of FDP(CI) with 2 regions below that with one, over I-III together (held out)",
        "",
        "ratio one region / several, 3D errors over trajectories I-III",
        partial(_sub_volumes_help, regions=2, held_out=True),
    ),
    _Claim(
        "Sub-volumes improve accuracy: 4 regions",
        "p. 961, section 6.3; p. 965, section 8",
        "3D error of FDP(CI) with 4 regions below that with one, over I-III together (held out)",
        "",
        "ratio one region / several, 3D errors over trajectories I-III",
        partial(_sub_volumes_help, regions=4, held_out=True),
    ),
    _Claim(
        "Sub-volumes improve accuracy: 4 regions, on their own poses",
        "p. 961, section 6.3; p. 965, section 8",
        "3D error of FDP(CI) with 4 regions below that with one on the identification poses",
        "",
        "ratio one region / several, 3D errors on the identification poses",
        partial(_sub_volumes_help, regions=4, held_out=False),
    ),
    _Claim(
        "Sub-volumes are called for: cross-validation divides the workspace",
        "p. 961, section 6.3; p. 965, section 8",
        "cross-validation on the identification poses takes more than one blended region for FDP(CI)",
        "regions",
        "chosen (the fewest within one standard error of the best)",
        _chosen_by_cross_validation,
    ),
    _regions_claim("FDP(CI)", "first degree, Cartesian input"),
    _regions_claim("SDP(AI)", "second degree, angular input"),
    _products_claim(SDP_CI.name, "second degree, Cartesian input"),
    _products_claim(FOURTH, "fourth degree, angular input"),
    _products_claim(FOURIER, "two harmonics, angular input"),
)
"""Each claim that is judged, in the order of the table."""
