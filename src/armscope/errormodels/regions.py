"""Several models for several regions, blended without jumps, and how many regions the data can bear (sections 6.3, 8).

The rule: the identification rows are halved at their median along the input in which they spread most (in units of
that input's spread over all rows), then each half again, as a k-d tree does; errors are not looked at. Around each cut
the two sides are blended by a smooth step (twice continuously differentiable), so that the weights of all regions add
up to one everywhere; each region's model is a least-squares fit with these weights.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray

from armscope.core.types import Array
from armscope.errormodels.features import FeatureSet, ModelSpec, checked_inputs
from armscope.errormodels.folds import FOLDS, compare_sizes, fold_numbers
from armscope.errormodels.products import ProductFeatures

OVERLAP = 0.5  # Half the width of the blended band, in standard deviations of the rows that a cut divides
ROWS_PER_TERM = 1.5  # A region needs at least so many rows (by weight) per term


@dataclass(frozen=True)
class Cut:
    """A border between two regions, each of which may be divided again."""

    axis: int
    at: float  # where, in its unit
    half_width: float  # of the blended band
    # below, above: how the sides are divided; None: not
    below: Cut | None = None
    above: Cut | None = None

    def to_dict(self) -> dict[str, Any]:
        """Plain values."""
        return asdict(self)

    @staticmethod
    def from_dict(content: dict[str, Any] | None) -> Cut | None:
        """The inverse of `to_dict`."""
        if content is None:
            return None
        sides = (Cut.from_dict(content[side]) for side in ("below", "above"))
        return Cut(int(content["axis"]), float(content["at"]), float(content["half_width"]), *sides)


def divide(inputs: ArrayLike, halvings: int, overlap: float = OVERLAP) -> Cut | None:
    """The borders that divide identification rows (M, k) into 2^halvings regions; None for a single one.

    Args:
        inputs: (M, k) identification rows, mm or rad.
        halvings: how often the workspace is halved.
        overlap: of neighbours, in standard deviations of the rows along the axis that is cut.

    Returns:
        The cuts as a tree.
    """
    table = checked_inputs(inputs)
    spread = np.std(table, axis=0)
    return _halved(table, np.where(spread > 0, spread, np.inf), halvings, overlap)


def _halved(rows: Array, unit: Array, halvings: int, overlap: float) -> Cut | None:
    if halvings == 0:
        return None
    axis = int(np.argmax(rows.std(axis=0) / unit))
    at = float(np.median(rows[:, axis]))
    below = rows[:, axis] < at
    return Cut(
        axis,
        at,
        overlap * float(rows[:, axis].std()),
        _halved(rows[below], unit, halvings - 1, overlap),
        _halved(rows[~below], unit, halvings - 1, overlap),
    )


def weights(cut: Cut | None, inputs: Array) -> Array:
    """(N, regions) how much each region's model counts at ``inputs`` (N, k); rows add up to 1."""
    if cut is None:
        return np.ones((len(inputs), 1))
    t = np.clip((inputs[:, cut.axis] - cut.at) / (2 * cut.half_width) + 0.5, 0.0, 1.0)
    share = (t**3 * (10 - 15 * t + 6 * t**2))[:, None]
    return np.concatenate([(1 - share) * weights(cut.below, inputs), share * weights(cut.above, inputs)], axis=1)


def fit_regions(features: FeatureSet, cut: Cut | None, inputs: ArrayLike, errors_mm: Array) -> Array:
    """Coefficients (regions, axes, terms) of each region's weighted least-squares fit.

    Args:
        features: the model's terms.
        cut: the borders; None for one region.
        inputs: (M, k), mm or rad.
        errors_mm: (M, axes).

    Returns:
        Coefficients, mm per unit of a term.

    Raises:
        ValueError: a region with too few rows for its terms.
    """
    table = checked_inputs(inputs)
    by_region, terms = weights(cut, table), features.matrix(table)
    fewest = float(by_region.sum(axis=0).min())
    if fewest < ROWS_PER_TERM * terms.shape[1]:
        raise ValueError(
            f"a region has {fewest:.0f} rows: {terms.shape[1]} terms need at least {ROWS_PER_TERM * terms.shape[1]:.0f}"
        )
    scale = np.linalg.norm(terms, axis=0)
    scale = np.where(scale > 0, scale, 1.0)
    fitted = []
    for weight in by_region.T:
        root = np.sqrt(weight)[:, None]
        solved = np.linalg.lstsq(root * terms / scale, root * errors_mm, rcond=1e-12)[0]
        fitted.append((solved / scale[:, None]).T)
    return np.array(fitted)


def blended(features: FeatureSet | ProductFeatures, cut: Cut | None, coefficients: Array, inputs: ArrayLike) -> Array:
    """Predicted errors (N, axes), mm, of all regions' models together.

    Args:
        features: the model's terms.
        cut: the borders; None for one region.
        coefficients: (regions, axes, terms) of `fit_regions`.
        inputs: (N, k), mm or rad.

    Returns:
        (N, axes) mm.
    """
    table = checked_inputs(inputs)
    predicted: Array = np.einsum("nr,nt,rat->na", weights(cut, table), features.matrix(table), coefficients)
    return predicted


def compare_regions(
    spec: ModelSpec, inputs: ArrayLike, errors_mm: Array, rng: np.random.Generator, most_halvings: int = 4
) -> pd.DataFrame:
    """Held-out error by number of regions.

    Args:
        spec: the model of every region.
        inputs: (M, k) identification rows.
        errors_mm: (M, axes).
        rng: draws the folds; borders and fits are made anew in each.
        most_halvings: at most 2^this regions are tried; fewer where rows run out.

    Returns:
        See `compare_sizes`; empty where the rows are too few for any.
    """
    table = checked_inputs(inputs)
    fold_of = fold_numbers(len(table), rng)
    fit, held_out = [], []
    for halvings in range(most_halvings + 1):
        try:
            left = errors_mm - _predicted(spec, halvings, table, errors_mm, table)
            missed = [_missed(spec, halvings, table, errors_mm, fold_of == fold) for fold in range(FOLDS)]
        except ValueError:
            break
        fit.append(np.mean(np.sum(left**2, axis=1)))
        held_out.append(missed)
    if not fit:
        return pd.DataFrame()
    return compare_sizes("regions", 2 ** np.arange(len(fit)), np.array(fit), np.array(held_out).T)


def _missed(spec: ModelSpec, halvings: int, inputs: Array, errors_mm: Array, held_out: NDArray[np.bool_]) -> float:
    """Mean squared length of the error vector left on held-out rows."""
    predicted = _predicted(spec, halvings, inputs[~held_out], errors_mm[~held_out], inputs[held_out])
    return float(np.mean(np.sum((errors_mm[held_out] - predicted) ** 2, axis=1)))


def _predicted(spec: ModelSpec, halvings: int, inputs: Array, errors_mm: Array, at: Array) -> Array:
    features, cut = spec.features(inputs), divide(inputs, halvings)
    return blended(features, cut, fit_regions(features, cut, inputs, errors_mm), at)


def halvings_of(regions: int) -> int:
    """How many times the rows are halved for a number of regions. Raises ValueError: not a power of two."""
    if regions < 1 or regions & (regions - 1):
        raise ValueError(f"{regions} regions: must be 1, 2, 4, 8, ...")
    return regions.bit_length() - 1


def chosen_regions(compared: pd.DataFrame) -> int:
    """The number of regions that `compare_regions` chose; 1 where nothing could be compared."""
    which: Sequence[int] = compared.loc[compared["chosen"], "regions"].tolist() if len(compared) else [1]
    return int(which[0])
