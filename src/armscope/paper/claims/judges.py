"""How each claim is turned into one yes or no, and one number, per robot."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import pandas as pd

from armscope.core.types import Array
from armscope.errormodels.features import FOURIER_2_AI, POLYNOMIAL_4_AI
from armscope.errormodels.fitted import SwarmFit
from armscope.paper.claims.evidence import Evidence, Judged, printed_cells, printed_spatial
from armscope.paper.enough_poses import PRINTED_COUNT, smallest_sufficient
from armscope.paper.outlook import PLAIN, SUB_VOLUMES
from armscope.paper.printed import AXES, IDENTIFICATION, TEST_TRAJECTORIES, TRAJECTORIES, UNCOMPENSATED

CLOSE_PER_CENT = 1.0  # A swarm counts as equal to least squares if it stays within this above it
SIMILAR = 2.0  # Errors of two axes count as "quite similar" up to this ratio
SMALL_COST = 10.0  # The swarm's cost counts as small up to so many times the arithmetic of least squares

PRINTED_ITERATIONS = 200  # Of a swarm in the paper (Sec. 5)

FOURTH, FOURIER = POLYNOMIAL_4_AI.name, FOURIER_2_AI.name


def reduced(evidence: Evidence) -> Judged:
    """Every model of the paper leaves less than there was, on every test trajectory."""
    pairs = [(model, name) for model in evidence.papers_models for name in TEST_TRAJECTORIES]
    ratios = np.min([evidence.spatial(UNCOMPENSATED, t) / evidence.spatial(m, t) for m, t in pairs], axis=0)
    printed = printed_spatial()
    return Judged(ratios > 1, ratios, min(printed[UNCOMPENSATED, t] / printed[m, t] for m, t in pairs))


def shrunk_as_printed(evidence: Evidence) -> Judged:
    """At least half of the cells shrink at least as much as the printed ones."""
    cells, printed = evidence.cells, printed_cells()
    shrunk = [
        cells[UNCOMPENSATED, t, a] / cells[m, t, a] >= printed[UNCOMPENSATED, t, a] / printed[m, t, a]
        for m in evidence.papers_models
        for t in TRAJECTORIES
        for a in AXES
    ]
    share = np.asarray(np.mean(shrunk, axis=0))
    return Judged(share >= 0.5, 100 * share, 100.0)


def axes_similar(evidence: Evidence) -> Judged:
    """The errors left on the identification poses are alike in x, y and z."""

    def ratio(cells: pd.DataFrame | pd.Series) -> Array:
        by_model = [[np.asarray(cells[m, IDENTIFICATION, a]) for a in AXES] for m in evidence.papers_models]
        return np.asarray(np.max([np.max(axes, axis=0) / np.min(axes, axis=0) for axes in by_model], axis=0))

    ratios = ratio(evidence.cells)
    return Judged(ratios <= SIMILAR, ratios, float(ratio(printed_cells())))


def second_degree(evidence: Evidence) -> Judged:
    """Second degree fits its own rows at least as well as first degree."""
    pairs = [
        (f"SDP({space})", f"FDP({space})", axis)
        for space in ("CI", "AI")
        for axis in AXES
        if {f"SDP({space})", f"FDP({space})"} <= set(evidence.models)
    ]

    def largest(cells: pd.DataFrame | pd.Series) -> Array:
        ratios = [cells[s, IDENTIFICATION, a] / cells[f, IDENTIFICATION, a] for s, f, a in pairs]
        return np.asarray(np.max(ratios, axis=0))

    ratios = largest(evidence.cells)
    # the swarm's last digits must not decide between two equal fits
    return Judged(ratios <= 1 + 1e-4, ratios, float(largest(printed_cells())))


def cartesian_beats_angular(evidence: Evidence, trajectory: str) -> Judged:
    """Both Cartesian models leave less on a trajectory than the angular ones of the same degree."""
    degrees = [d for d in ("FDP", "SDP") if {f"{d}(CI)", f"{d}(AI)"} <= set(evidence.models)]
    ratios = [evidence.spatial(f"{d}(AI)", trajectory) / evidence.spatial(f"{d}(CI)", trajectory) for d in degrees]
    smaller, printed = np.asarray(np.min(ratios, axis=0)), printed_spatial()
    return Judged(
        smaller > 1, smaller, min(printed[f"{d}(AI)", trajectory] / printed[f"{d}(CI)", trajectory] for d in degrees)
    )


def fourier_beats_ordinary(evidence: Evidence) -> Judged:
    """Fourier leaves less than the ordinary polynomial with as many coefficients."""
    ratios = evidence.over_tests(FOURTH) / evidence.over_tests(FOURIER)
    return Judged(ratios > 1, ratios)


def same_outcome(evidence: Evidence) -> Judged:
    """The comparison of Fourier and ordinary polynomials has the same winner by this method as by least squares."""
    by_swarm = evidence.over_tests(FOURTH) / evidence.over_tests(FOURIER)
    exact = evidence.over_tests(FOURTH, True) / evidence.over_tests(FOURIER, True)
    return Judged((by_swarm > 1) == (exact > 1), by_swarm / exact)


def remedied(evidence: Evidence) -> Judged:
    """The better of the two large angular models comes at least as close as FDP(CI)."""
    best = np.minimum(evidence.over_tests(FOURTH), evidence.over_tests(FOURIER))
    ratios = evidence.over_tests("FDP(CI)") / best
    return Judged(ratios >= 1, ratios)


def improved(evidence: Evidence) -> Judged:
    """Both large angular models come closer than FDP(AI)."""
    worse = np.maximum(evidence.over_tests(FOURTH), evidence.over_tests(FOURIER))
    ratios = evidence.over_tests("FDP(AI)") / worse
    return Judged(ratios > 1, ratios)


def equals_least_squares(evidence: Evidence) -> Judged:
    """No fit of the paper's models ends far above least squares."""
    worst = _worst(evidence, evidence.fits, lambda fit: float(fit.excess_percent.max()))
    return Judged(worst <= CLOSE_PER_CENT, worst)


def iterations_suffice(evidence: Evidence) -> Judged | None:
    """Every fit of the paper's models gets close to least squares in as many iterations as the paper has.

    Swarms that were stopped sooner do not say what those that had not arrived would have done.
    """
    numbers = _worst(evidence, evidence.fits, arrival)
    stopped = min(fit.history_mm.shape[2] - 1 for fit in evidence.fits)
    if stopped < PRINTED_ITERATIONS and not np.isfinite(numbers).all():
        return None
    return Judged(numbers <= PRINTED_ITERATIONS, numbers)


def beats_random_search(evidence: Evidence) -> Judged | None:
    """Every fit of the paper's models ends nearer to least squares than random search."""
    if not evidence.random:
        return None
    blind = {(fit.label, fit.name): float(np.median(fit.excess_percent)) for fit in evidence.random}

    def ratio(fit: SwarmFit) -> float:
        return float(np.median(fit.excess_percent)) / blind[fit.label, fit.name]

    ratios = _worst(evidence, evidence.fits, ratio)
    return Judged(ratios < 1, ratios)


def small_cost(evidence: Evidence) -> Judged:
    """Getting close to least squares takes little more arithmetic than solving it."""
    numbers = _worst(evidence, evidence.fits, cost_ratio)
    return Judged(numbers <= SMALL_COST, numbers)


def arrival(fit: SwarmFit) -> float:
    """The iteration at which the last of a fit's swarms is close to least squares; infinite if one never is."""
    close = fit.history_mm <= fit.optimum_mm[None, :, None] * (1 + CLOSE_PER_CENT / 100)
    first = np.where(close.any(axis=2), close.argmax(axis=2), np.inf)
    return float(first.max())


def cost_ratio(fit: SwarmFit) -> float:
    """Evaluations until a fit is close, over what least squares costs: as much as one evaluation per coefficient.

    One evaluation of n coefficients on N rows takes 2 N n operations, a QR solution 2 N n^2.
    """
    return (1 + arrival(fit)) * fit.particles / len(fit.features.term_names)


def _worst(evidence: Evidence, fits: Sequence[SwarmFit], number: Callable[[SwarmFit], float]) -> Array:
    """The largest number over each robot's fits of the paper's models, robots in their order."""
    worst: dict[str, float] = {}
    for fit in fits:
        if fit.name in evidence.papers_models:
            worst[fit.label] = max(worst.get(fit.label, -np.inf), number(fit))
    return np.array([worst[robot] for robot in evidence.robots])


def poses_not_wasted(evidence: Evidence) -> Judged | None:
    """No smaller number of poses would do."""
    if evidence.poses.empty:
        return None
    needed = evidence.by_robot(smallest_sufficient(evidence.poses).to_frame("poses"))["poses"].to_numpy(dtype=float)
    return Judged(needed >= PRINTED_COUNT, needed, float(PRINTED_COUNT))


def sub_volumes_help(evidence: Evidence, regions: int, held_out: bool) -> Judged | None:
    """Several regions, each with its own FDP(CI), leave less than one.

    Args:
        evidence: of one method.
        regions: how many.
        held_out: whether the test trajectories are looked at, or the identification poses.

    Returns:
        By robot whether they do; None where nothing was computed.
    """
    table = evidence.sub_volumes
    if table.empty:
        return None
    chosen = table[(table["model"] == "FDP(CI)") & ((table["trajectory"] != IDENTIFICATION) == held_out)]
    squares = chosen.assign(square=chosen["rms_mm"] ** 2).groupby(["robot", "regions"])["square"].mean()
    rms = evidence.by_robot(squares.unstack("regions") ** 0.5)
    ratios = (rms[1] / rms[regions]).to_numpy()
    return Judged(ratios > 1, ratios)


def chosen_by_cross_validation(evidence: Evidence) -> Judged | None:
    """Cross-validation takes more than one region."""
    table = evidence.outlook
    if table.empty:
        return None
    chosen = table[(table["model"] == "FDP(CI)") & (table["kind"] == SUB_VOLUMES)].groupby("robot")["size"].first()
    numbers = evidence.by_robot(chosen.to_frame())["size"].to_numpy(dtype=float)
    return Judged(numbers > 1, numbers)


def extension_helps(evidence: Evidence, model: str, kind: str) -> Judged | None:
    """A model extended by regions or products leaves less on the test trajectories than without.

    Args:
        evidence: of one method.
        model: which.
        kind: of extension.

    Returns:
        By robot whether it does; None where nothing was computed.
    """
    table = evidence.outlook
    if table.empty:
        return None
    tests = table[(table["model"] == model) & (table["trajectory"] != IDENTIFICATION)]
    squares = tests.assign(square=tests["rms_mm"] ** 2).groupby(["robot", "kind"])["square"].mean()
    rms = evidence.by_robot(squares.unstack("kind") ** 0.5)
    ratios = (rms[PLAIN] / rms[kind]).to_numpy()
    return Judged(ratios > 1, ratios)
