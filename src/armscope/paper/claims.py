"""The paper's claims, each judged on every robot that agrees with its printed equations.

A claim `holds` where at least 95 % of the robots bear it out, `does not hold` where at most 5 % do, else it `depends`.
Each is turned into one yes or no per robot, and into one number; both stand in the table with the paper's own.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from armscope.errormodels import FOURIER_2_AI, POLYNOMIAL_4_AI, FittedModel
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

Array = NDArray[np.float64]

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


def claims(
    residuals: pd.DataFrame,
    fits: Sequence[FittedModel],
    sub_volume_residuals: pd.DataFrame,
    fits_as_printed: Sequence[FittedModel] = (),
) -> pd.DataFrame:
    """Each claim with its verdict.

    Args:
        residuals: of all robots and of the six models (see `residual_table`); the swarm's median seed counts.
        fits: of all robots.
        sub_volume_residuals: see `sub_volumes`.
        fits_as_printed: swarms with the update rule as the paper prints it ("original"), for the claim about it.

    Returns:
        Columns claim, source (page and section), criterion (what counts as yes for one robot), verdict ("holds", "does
        not hold", "depends"), anchored (yes or no for the anchored robot), share_of_robots, robots, number (median over
        the robots), number_anchored, number_low, number_high (5 and 95 % of the robots), number_printed (the same
        number from the printed Table 2, if it has one), unit, number_is.
    """
    cells = typical(residuals)
    three_dimensional = _SpatialErrors(pd.DataFrame(cells.xs(SPATIAL, axis=1, level="axis")), _printed_spatial())
    rows = [
        _row(
            "The models predict the errors: what is left is smaller",
            "p. 965, section 8",
            "each of the four models leaves a smaller 3D error on each of the three test trajectories",
            "",
            "smallest ratio uncompensated / residual of the 3D errors",
            three_dimensional.reduced(),
        ),
        _row(
            "The models predict the errors: they shrink as printed",
            "p. 961, Table 2; p. 965, section 8",
            "in at least half of the printed cells the error shrinks at least by the printed factor",
            "%",
            "share of the 48 printed cells that shrink at least by the printed factor",
            _shrink(cells),
        ),
        _row(
            "Second-degree polynomials fit the identification poses at least as well as first-degree ones",
            "p. 961, Table 2",
            "SDP <= FDP in x, y and z, for both inputs",
            "",
            "largest ratio SDP / FDP",
            _second_degree(cells),
        ),
    ]
    for number, trajectory in enumerate(TEST_TRAJECTORIES[:2]):
        rows.append(
            _row(
                f"Cartesian input beats angular input on trajectory {'I' * (number + 1)}",
                ("p. 962, section 7.1", "p. 964, section 7.2")[number],
                "3D error of FDP(CI) below FDP(AI), and of SDP(CI) below SDP(AI)",
                "",
                "ratio AI / CI of the 3D errors, the smaller of FDP and SDP",
                three_dimensional.cartesian_beats_angular(trajectory),
            )
        )
    rows.append(
        _row(
            "PSO is an alternative to least squares",
            "p. 961, section 6.3",
            f"no fit ends more than {CLOSE_PER_CENT:g} % above least squares (constriction factor)",
            "%",
            "largest excess over the least-squares RMS residual",
            _excess(fits, cells.index),
        )
    )
    rows.append(
        _row(
            "200 iterations suffice",
            "p. 960, section 5",
            f"every fit is within {CLOSE_PER_CENT:g} % of least squares by its last iteration (constriction factor)",
            "iterations",
            f"until the slowest fit is within {CLOSE_PER_CENT:g} % of least squares (infinite: never)",
            _iterations(fits, cells.index),
        )
    )
    if fits_as_printed:
        robots = pd.Index(dict.fromkeys(fit.label for fit in fits_as_printed))
        rows.append(
            _row(
                "200 iterations suffice with the velocity update as printed",
                "p. 960, section 5",
                f"every fit is within {CLOSE_PER_CENT:g} % of least squares by its last iteration",
                "%",
                "median excess over the least-squares RMS residual",
                _excess(fits_as_printed, robots, np.median),
            )
        )
    rows += [
        _row(
            "Fourier polynomials are more accurate than ordinary polynomials",
            "p. 962, section 6.3",
            "over I-III together, Fourier with 2 harmonics comes closer than the 4th degree (75 coefficients each)",
            "",
            "ratio ordinary / Fourier of the 3D errors over trajectories I-III",
            three_dimensional.better(FOURIER, FOURTH),
        ),
        _row(
            "75 coefficients remedy the angular models",
            "p. 962, section 7.1",
            "over I-III together, Fourier or 4th degree (AI) comes at least as close as FDP(CI)",
            "",
            "ratio FDP(CI) / best of the two, 3D errors over trajectories I-III",
            three_dimensional.remedied(),
        ),
        _row(
            "75 coefficients improve on the angular first degree",
            "p. 964, section 7.2",
            "over I-III together, both Fourier and 4th degree (AI) come closer than FDP(AI)",
            "",
            "ratio FDP(AI) / worse of the two, 3D errors over trajectories I-III",
            three_dimensional.improved(),
        ),
    ]
    for regions in (2, 4):
        rows.append(
            _row(
                f"Sub-volumes improve accuracy: {regions} regions",
                "p. 961, section 6.3; p. 965, section 8",
                f"3D error of FDP(CI) with {regions} regions below that with one, over I-III together (held out)",
                "",
                "ratio one region / several, 3D errors over trajectories I-III",
                _sub_volumes(sub_volume_residuals, regions, cells.index, held_out=True),
            )
        )
    rows.append(
        _row(
            "Sub-volumes improve accuracy: 4 regions, on their own poses",
            "p. 961, section 6.3; p. 965, section 8",
            "3D error of FDP(CI) with 4 regions below that with one on the identification poses",
            "",
            "ratio one region / several, 3D errors on the identification poses",
            _sub_volumes(sub_volume_residuals, 4, cells.index, held_out=False),
        )
    )
    return pd.DataFrame(rows)


def _row(claim: str, source: str, criterion: str, unit: str, number_is: str, judged: _Judged) -> dict[str, object]:
    share = float(np.mean(judged.per_robot))
    verdict = "holds" if share >= HOLDS_FROM else "does not hold" if share <= FAILS_TO else "depends"
    low, median, high = _quantiles(judged.numbers)
    return {
        "claim": claim,
        "source": source,
        "criterion": criterion,
        "verdict": verdict,
        "anchored": "yes" if judged.per_robot[0] else "no",
        "share_of_robots": share,
        "robots": len(judged.per_robot),
        "number": median,
        "number_anchored": float(judged.numbers[0]),
        "number_low": low,
        "number_high": high,
        "number_printed": judged.printed,
        "unit": unit,
        "number_is": number_is,
    }


def _quantiles(numbers: Array) -> tuple[float, float, float]:
    """5, 50, 95 %, also where some are infinite (no interpolation between values)."""
    low, median, high = np.quantile(numbers, [0.05, 0.5, 0.95], method="nearest")
    return float(low), float(median), float(high)


def _shrink(cells: pd.DataFrame) -> _Judged:
    printed = printed_table2().set_index(["model", "trajectory", "axis"])["printed"]
    shares = []
    for model in PRINTED_MODELS:
        for trajectory in TRAJECTORIES:
            for axis in AXES:
                factor = printed[UNCOMPENSATED, trajectory, axis] / printed[model, trajectory, axis]
                mine = cells[UNCOMPENSATED, trajectory, axis] / cells[model, trajectory, axis]
                shares.append(mine >= factor)
    share = np.mean(shares, axis=0)
    return _Judged(share >= 0.5, 100 * share, 100.0)


def _second_degree(cells: pd.DataFrame) -> _Judged:
    printed = printed_table2().set_index(["model", "trajectory", "axis"])["printed"]
    pairs = [(f"SDP({space})", f"FDP({space})", axis) for space in ("CI", "AI") for axis in AXES]
    ratios = np.array([cells[s, IDENTIFICATION, a] / cells[f, IDENTIFICATION, a] for s, f, a in pairs]).max(axis=0)
    on_paper = max(printed[s, IDENTIFICATION, a] / printed[f, IDENTIFICATION, a] for s, f, a in pairs)
    # the swarm's last digits must not decide between two equal fits
    return _Judged(ratios <= 1 + 1e-4, ratios, on_paper)


def _printed_spatial() -> pd.Series:
    """(model, trajectory) 3D length of the printed x, y, z errors."""
    printed = printed_table2()
    squares = printed.assign(printed=printed["printed"] ** 2).groupby(["model", "trajectory"])["printed"].sum()
    return squares**0.5


@dataclass(frozen=True)
class _SpatialErrors:
    """3D errors by robot (rows) and (model, trajectory), and the printed ones."""

    cells: pd.DataFrame
    printed: pd.Series

    def cartesian_beats_angular(self, trajectory: str) -> _Judged:
        pairs = [("FDP(AI)", "FDP(CI)"), ("SDP(AI)", "SDP(CI)")]
        ratios = np.min([self.cells[a, trajectory] / self.cells[c, trajectory] for a, c in pairs], axis=0)
        on_paper = min(self.printed[a, trajectory] / self.printed[c, trajectory] for a, c in pairs)
        return _Judged(ratios > 1, ratios, float(on_paper))

    def over_tests(self, model: str) -> Array:
        """3D RMS over the held-out trajectories together, each with the same weight (they have equally many points)."""
        return np.sqrt(np.mean([self.cells[model, name].to_numpy() ** 2 for name in TEST_TRAJECTORIES], axis=0))

    def reduced(self) -> _Judged:
        pairs = [(model, trajectory) for model in PRINTED_MODELS for trajectory in TEST_TRAJECTORIES]
        ratios = np.min([self.cells[UNCOMPENSATED, t] / self.cells[m, t] for m, t in pairs], axis=0)
        on_paper = min(self.printed[UNCOMPENSATED, t] / self.printed[m, t] for m, t in pairs)
        return _Judged(ratios > 1, ratios, float(on_paper))

    def better(self, better: str, worse: str) -> _Judged:
        ratios = self.over_tests(worse) / self.over_tests(better)
        return _Judged(ratios > 1, ratios)

    def remedied(self) -> _Judged:
        best = np.minimum(self.over_tests(FOURTH), self.over_tests(FOURIER))
        ratios = self.over_tests("FDP(CI)") / best
        return _Judged(ratios >= 1, ratios)

    def improved(self) -> _Judged:
        worse = np.maximum(self.over_tests(FOURTH), self.over_tests(FOURIER))
        ratios = self.over_tests("FDP(AI)") / worse
        return _Judged(ratios > 1, ratios)


def _by_robot(fits: Sequence[FittedModel], robots: pd.Index, number: Callable[[FittedModel], float]) -> Array:
    """The largest number over each robot's fits, of robots that have fits."""
    worst: dict[str, float] = {}
    for fit in fits:
        worst[fit.label] = max(worst.get(fit.label, -np.inf), number(fit))
    return np.array([worst[robot] for robot in robots if robot in worst])


def _excess(fits: Sequence[FittedModel], robots: pd.Index, of_seeds: Callable[[Array], float] = np.max) -> _Judged:
    numbers = _by_robot(fits, robots, lambda fit: float(of_seeds(fit.excess_percent)))
    return _Judged(_by_robot(fits, robots, lambda fit: float(fit.excess_percent.max())) <= CLOSE_PER_CENT, numbers)


def _iterations(fits: Sequence[FittedModel], robots: pd.Index) -> _Judged:
    numbers = _by_robot(fits, robots, _slowest)
    return _Judged(np.isfinite(numbers), numbers)


def _slowest(fit: FittedModel) -> float:
    """The iteration at which the last of the swarms is close to least squares; infinite if one never is."""
    close = fit.history_mm <= fit.least_squares_mm[None, :, None] * (1 + CLOSE_PER_CENT / 100)
    first = np.where(close.any(axis=2), close.argmax(axis=2), np.inf)
    return float(first.max())


def _sub_volumes(table: pd.DataFrame, regions: int, robots: pd.Index, held_out: bool) -> _Judged:
    chosen = table[(table["model"] == "FDP(CI)") & ((table["trajectory"] != IDENTIFICATION) == held_out)]
    squares = chosen.assign(square=chosen["rms_mm"] ** 2).groupby(["robot", "regions"])["square"].mean()
    rms = (squares.unstack("regions") ** 0.5).reindex(robots)
    ratios = (rms[1] / rms[regions]).to_numpy()
    return _Judged(ratios > 1, ratios)
