"""Do the printed numbers agree with each other? The printed equations on the printed trajectories against Table 2.

On N points let u be the measured errors of one axis and f what a printed equation predicts there. Table 2 prints |u|
("uncompensated") and |u - f| (the model's error) in some norm, so that for any u whatever

    ||u| - |u - f||  <=  |f|  <=  |u| + |u - f|            (one model)
    |f - g|  <=  |u - f| + |u - g|                         (two models on the same errors)

|f| follows from the equations and the trajectory, so a cell that breaks this can't be right together with its equation,
whatever the robot was. Both readings of "RMS" are tried, root of the sum of squares and root of the mean square. What
the text leaves open is scanned: the rise of the third coordinate of trajectories II and III, and three corners of
trajectory I. The audit concerns Cartesian input only: angular input needs the lost Table 1.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy.optimize import Bounds, differential_evolution

from armscope.core.types import Array
from armscope.paper.audit_scope import AuditScope
from armscope.paper.printed import (
    AXES,
    HALF_DIGIT_MM,
    IDENTIFICATION,
    TEST_TRAJECTORIES,
    UNCOMPENSATED,
    predict_printed,
    printed_features,
    printed_half_digits,
    printed_matrix,
    printed_table2,
)
from armscope.world.of_the_paper import archimedes_spiral

MODELS = ("FDP(CI)", "SDP(CI)")
CHECKS = (*MODELS, " and ".join(MODELS))
READINGS = ("rss", "rms")

Predictions = dict[str, tuple[Array, Array]]
"""By model: predicted errors (variants, N, 3), mm, and how far the rounding of the coefficients may move each."""


def audit(scope: AuditScope | None = None) -> pd.DataFrame:
    """What of the printed numbers agrees, for each trajectory, reading of "RMS", axis and check, and for all together.

    All bounds are widened by the half digit that Table 2 and the coefficients were rounded by.

    Returns:
        Columns trajectory, reading ("rss" or "rms"), axis (x, y, z; "x, y, z": all axes on the same path), check
        ("FDP(CI)", "SDP(CI)", "FDP(CI) and SDP(CI)", "all together"), varied (what was scanned), tried (how many
        variants), consistent (share of them that obey the inequalities), possible (whether any does, after a search for
        the best), best_gap_mm (by how much the best misses; 0 where one obeys), best_variant (which), allowed_low_mm,
        allowed_high_mm (where |f| or |f - g| must lie for the best variant), best_value_mm (where it does lie); and of
        all rows searched (the scope in words) and thorough (whether it is enough to say that there is none).
    """
    scope = scope or AuditScope()
    printed = printed_table2().set_index(["model", "trajectory", "axis"])["printed"]
    rows: list[dict[str, object]] = []
    for trajectory in TEST_TRAJECTORIES:
        family = _family(trajectory, scope)
        predicted = _predicted(family.paths(family.samples), MODELS)
        for reading in READINGS:
            audited = _Audited(printed, trajectory, reading, family, predicted, scope.search_generations)
            single = [(axis, check) for axis in AXES for check in CHECKS]
            rows += [audited.row([each]) for each in single]
            rows.append(audited.row(single))
    rows += _identification_rows(printed, scope)
    return pd.DataFrame(rows).assign(searched=scope.in_words, thorough=scope.thorough)


@dataclass(frozen=True)
class _Family:
    """The paths that the text allows for one trajectory: ``path`` of parameters (variants, P) within bounds."""

    varied: str
    samples: Array
    low: Array
    high: Array
    paths: Callable[[Array], Array]
    label: Callable[[Array], str]


def _family(trajectory: str, scope: AuditScope) -> _Family:
    if trajectory == TEST_TRAJECTORIES[0]:
        from scipy.stats import qmc  # takes half a second: seldom needed

        low = np.array([*scope.low, *scope.low, *[-0.5] * 3])
        high = np.array([*scope.high, *scope.high, *[0.5] * 3])
        unit = qmc.Sobol(9, rng=np.random.default_rng(scope.seed)).random(scope.corner_samples)
        samples = low + unit * (high - low)
        return _Family(
            "three corners",
            samples,
            low,
            high,
            lambda p: _rectangles(_corners(p, scope)),
            lambda p: _corner_text(_corners(p[None], scope)[0]),
        )
    plane, start = ("xy", scope.spiral_starts[0]) if trajectory == "test 2" else ("yz", scope.spiral_starts[1])
    rises = np.array(scope.rises)[:, None]

    def spirals(parameters: Array) -> Array:
        return np.stack([archimedes_spiral(start, plane, 20.0, 5.0, 200, float(rise)) for rise in parameters[:, 0]])

    return _Family(
        "rise of the third coordinate",
        rises,
        rises.min(axis=0),
        rises.max(axis=0),
        spirals,
        lambda p: f"rise {p[0]:.0f} mm",
    )


def _corners(parameters: Array, scope: AuditScope) -> Array:
    """(variants, 4, 3): the first corner as printed, its two neighbours anywhere in the box, the one opposite closing a
    parallelogram that is bent by up to a tenth of its diagonal ("rectangle-like")."""
    second, fourth, bend = parameters[:, :3], parameters[:, 3:6], parameters[:, 6:]
    first = np.broadcast_to(np.array(scope.first_corner), second.shape)
    third = second + fourth - first + 0.2 * bend * np.abs(second - fourth)
    return np.stack([first, second, np.clip(third, scope.low, scope.high), fourth], axis=1)


def _rectangles(corners: Array) -> Array:
    """(variants, 200, 3), as `rectangle` for each."""
    along = np.arange(50)[:, None] / 50
    ends = np.roll(corners, -1, axis=1)
    sides = corners[:, :, None] + along * (ends - corners)[:, :, None]
    return sides.reshape(len(corners), -1, 3)


def _corner_text(corners: Array) -> str:
    return "corners " + ", ".join("(" + " ".join(f"{value:.0f}" for value in corner) + ")" for corner in corners[1:])


def _predicted(paths: Array, models: tuple[str, ...]) -> Predictions:
    predicted = {}
    for model in models:
        terms = printed_features(model).matrix(paths.reshape(-1, 3))
        values = (terms @ printed_matrix(model).T).reshape(paths.shape)
        rounding = (np.abs(terms) @ printed_half_digits(model).T).reshape(paths.shape)
        predicted[model] = values, rounding
    return predicted


@dataclass(frozen=True)
class _Audited:
    """The inequalities of one trajectory under one reading."""

    printed: pd.Series
    trajectory: str
    reading: str
    family: _Family
    of_samples: Predictions
    search_generations: int

    def row(self, checks: list[tuple[str, str]]) -> dict[str, object]:
        """One row for one (axis, check), or for several that the same path must pass."""
        parameters = self.family.samples
        gaps = self._gap(self.of_samples, checks)
        best, best_gap = parameters[int(np.argmin(gaps))], float(gaps.min())
        if best_gap > 0 and len(best) > 1:  # a single parameter is scanned densely enough
            best, best_gap = self._searched(checks, best, best_gap)
        single = checks[0] if len(checks) == 1 else None
        low, value, high = (np.nan,) * 3
        if single:
            predicted = _predicted(self.family.paths(best[None]), MODELS)
            low, value, high = (float(each[0]) for each in self._compare(predicted, *single))
        return {
            "trajectory": self.trajectory,
            "reading": self.reading,
            "axis": single[0] if single else ", ".join(AXES),
            "check": single[1] if single else "all together",
            "varied": self.family.varied,
            "tried": len(parameters),
            "consistent": float(np.mean(gaps == 0)),
            "possible": best_gap == 0,
            "best_gap_mm": best_gap,
            "best_variant": self.family.label(best),
            "allowed_low_mm": low,
            "allowed_high_mm": high,
            "best_value_mm": value,
        }

    def _searched(self, checks: list[tuple[str, str]], start: Array, start_gap: float) -> tuple[Array, float]:
        """The path that comes nearest to obeying, by differential evolution between the family's bounds."""
        models = tuple(model for model in MODELS if any(model in check for _, check in checks))

        def gap(columns: Array) -> Array:
            return self._gap(_predicted(self.family.paths(columns.T), models), checks)

        found = differential_evolution(
            gap,  # type: ignore[arg-type]  # vectorised: many variants at once
            Bounds(self.family.low, self.family.high),
            x0=start,
            vectorized=True,
            updating="deferred",
            maxiter=self.search_generations,
            polish=False,
            rng=np.random.default_rng(0),
        )
        return (found.x, float(found.fun)) if found.fun < start_gap else (start, start_gap)

    def _gap(self, predicted: Predictions, checks: list[tuple[str, str]]) -> Array:
        """(variants,) by how many mm the worst of the checks is missed."""
        gaps = []
        for axis, check in checks:
            low, value, high = self._compare(predicted, axis, check)
            gaps.append(np.maximum(0, np.maximum(low - value, value - high)))
        worst: Array = np.max(gaps, axis=0)
        return worst

    def _compare(self, predicted: Predictions, axis: str, check: str) -> tuple[Array, Array, Array]:
        """(variants,) low, value, high of one inequality."""
        k = AXES.index(axis)
        models = [model for model in MODELS if model in check]
        rounding = np.sum([self._norm(predicted[model][1][..., k]) for model in models], axis=0)
        left = [float(self.printed[model, self.trajectory, axis]) for model in models]
        slack = rounding + 2 * HALF_DIGIT_MM
        if len(models) == 2:
            value = self._norm(predicted[models[0]][0][..., k] - predicted[models[1]][0][..., k])
            return np.zeros_like(value), value, sum(left) + slack
        value = self._norm(predicted[models[0]][0][..., k])
        before = float(self.printed[UNCOMPENSATED, self.trajectory, axis])
        return np.maximum(0, abs(before - left[0]) - slack), value, before + left[0] + slack

    def _norm(self, values: Array) -> Array:
        """(variants,) of values (variants, N)."""
        squares = np.sum(values**2, axis=1)
        norm: Array = np.sqrt(squares if self.reading == "rss" else squares / values.shape[1])
        return norm


def _identification_rows(printed: pd.Series, scope: AuditScope) -> Iterator[dict[str, object]]:
    """The identification poses are lost, but in a box no equation can predict more than its extreme, nor less than 0.

    A linear or quadratic prediction without products has its extremes at corners, edges or the vertex along each axis;
    a fine grid of the box finds them closely enough for a bound.
    """
    grids = [np.linspace(low, high, 41) for low, high in zip(scope.low, scope.high, strict=True)]
    points = np.stack(np.meshgrid(*grids, indexing="ij"), axis=-1).reshape(-1, 3)
    terms = {model: printed_features(model).matrix(points) for model in MODELS}
    halves = {model: printed_half_digits(model) for model in MODELS}
    for reading in READINGS:
        scale = np.sqrt(85) if reading == "rss" else 1.0
        for number, axis in enumerate(AXES):
            before = float(printed[UNCOMPENSATED, IDENTIFICATION, axis])
            for model in MODELS:
                values = predict_printed(model, points)[:, number]
                largest = scale * float(np.abs(values).max())
                smallest = 0.0 if values.min() < 0 < values.max() else scale * float(np.abs(values).min())
                left = float(printed[model, IDENTIFICATION, axis])
                slack = 2 * HALF_DIGIT_MM + scale * float((np.abs(terms[model]) @ halves[model].T)[:, number].max())
                low, high = max(0.0, abs(before - left) - slack), before + left + slack
                gap = max(0.0, low - largest, smallest - high)
                yield {
                    "trajectory": IDENTIFICATION,
                    "reading": reading,
                    "axis": axis,
                    "check": model,
                    "varied": "any 85 poses in the box",
                    "tried": len(points),
                    "consistent": np.nan,
                    "possible": gap == 0,
                    "best_gap_mm": gap,
                    "best_variant": "",
                    "allowed_low_mm": low,
                    "allowed_high_mm": high,
                    "best_value_mm": min(max(low, smallest), largest),
                }
