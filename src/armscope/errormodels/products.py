"""Products between inputs, and a sparse choice among them (section 6.3), against the paper's sums of one-input terms.

Candidates are products of one-input factors up to a total order: Chebyshev polynomials of the standardised input
(family "polynomial"), or cosines and sines of its multiples (family "fourier"). Terms enter one by one: the next is the
one that takes most off the squared errors of all axes together, given those that are in (orthogonal least squares;
Chen, Billings & Luo 1989). How many: cross-validation that repeats the choice in every fold; the fewest terms within
one standard error of the best.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from itertools import product
from typing import Any

import numpy as np
import pandas as pd
import scipy.linalg
from numpy.polynomial import chebyshev
from numpy.typing import ArrayLike

from armscope.core.types import Array
from armscope.errormodels.features import STILL, ModelSpec, checked_inputs, input_names
from armscope.errormodels.folds import FOLDS, compare_sizes, fold_numbers

Factor = tuple[int, str, int]  # (input, "T" or "cos" or "sin", order)
Term = tuple[Factor, ...]

MOST_INPUTS = 3  # A term multiplies at most so many inputs
LARGEST_SHARE = 0.4  # At most so many terms per row
CARRIES_NOTHING = 1e-10
"""A column whose square falls to this share once the chosen ones are taken out of it is one of their combinations."""


@dataclass(frozen=True, eq=False)
class ProductFeatures:
    """The chosen products, in the form of `FeatureSet`; k inputs, n terms."""

    spec: ModelSpec  # family, total order, and space of the inputs
    # centre, half_range: (k,) of the identification rows; inputs that stand still have half_range 0 and no factor
    centre: Array
    half_range: Array
    terms: tuple[Term, ...]  # in the order in which they entered; () is the constant

    @property
    def inputs(self) -> tuple[str, ...]:
        """The names of all inputs."""
        return input_names(self.spec.space, len(self.centre))

    @property
    def name(self) -> str:
        """The sums' name, marked: "SDP(AI) with products"."""
        return f"{self.spec.name} with products"

    @property
    def term_names(self) -> tuple[str, ...]:
        """One name per term: "const", "T2(px) T1(pz)", "cos(theta2) sin(2 theta3)"."""
        return tuple(" ".join(_factor_name(self.inputs, factor) for factor in term) or "const" for term in self.terms)

    @property
    def coefficients_per_axis(self) -> int:
        """The number of terms."""
        return len(self.terms)

    def matrix(self, inputs: ArrayLike) -> Array:
        """The terms' values (N, n) at ``inputs`` (N, k), mm or rad."""
        table = checked_inputs(inputs)
        values, one = {factor: self._value(factor, table) for factor in self._factors}, np.ones(len(table))
        columns = [np.prod([values[factor] for factor in term], axis=0) if term else one for term in self.terms]
        return np.stack(columns, axis=1)

    def slopes(self, inputs: ArrayLike) -> Array:
        """The terms' derivatives by the inputs (N, n, k), per mm or rad."""
        table = checked_inputs(inputs)
        values = {factor: self._value(factor, table) for factor in self._factors}
        derivatives = {factor: self._slope(factor, table) for factor in self._factors}
        slopes = np.zeros((len(table), len(self.terms), len(self.centre)))
        for n, term in enumerate(self.terms):
            for factor in term:
                others = [values[other] for other in term if other != factor]
                slopes[:, n, factor[0]] = np.prod([derivatives[factor], *others], axis=0)
        return slopes

    def to_dict(self) -> dict[str, Any]:
        """Plain values, for YAML or JSON."""
        return {
            "model": asdict(self.spec),
            "centre": self.centre.tolist(),
            "half_range": self.half_range.tolist(),
            "products": [[list(factor) for factor in term] for term in self.terms],
        }

    @staticmethod
    def from_dict(content: dict[str, Any]) -> ProductFeatures:
        """The inverse of `to_dict`."""
        return ProductFeatures(
            ModelSpec(**content["model"]),
            np.array(content["centre"], dtype=float),
            np.array(content["half_range"], dtype=float),
            tuple(tuple((int(k), str(kind), int(order)) for k, kind, order in term) for term in content["products"]),
        )

    @property
    def _factors(self) -> set[Factor]:
        return {factor for term in self.terms for factor in term}

    def _unit(self, k: int) -> float:
        """Radians per unit of an input; in millimetres the first harmonic is twice the range, as in the sums."""
        return 1.0 if self.spec.space == "angular" else float(np.pi / (2 * self.half_range[k]))

    def _value(self, factor: Factor, table: Array) -> Array:
        k, kind, order = factor
        if kind == "T":
            z = (table[:, k] - self.centre[k]) / self.half_range[k]
            return np.asarray(chebyshev.chebval(z, np.eye(order + 1)[order]))
        return np.asarray((np.cos if kind == "cos" else np.sin)(order * self._unit(k) * table[:, k]))

    def _slope(self, factor: Factor, table: Array) -> Array:
        k, kind, order = factor
        if kind == "T":
            z = (table[:, k] - self.centre[k]) / self.half_range[k]
            return np.asarray(chebyshev.chebval(z, chebyshev.chebder(np.eye(order + 1)[order])) / self.half_range[k])
        angle = order * self._unit(k)
        slope = -np.sin(angle * table[:, k]) if kind == "cos" else np.cos(angle * table[:, k])
        return np.asarray(angle * slope)


def candidate_terms(spec: ModelSpec, half_range: Array) -> tuple[Term, ...]:
    """All products of up to `MOST_INPUTS` inputs that move, of total order up to ``spec.order``; the constant first.

    Args:
        spec: the model's input, degree and kind.
        half_range: (k,) half of each input's range; an input with none stands still and enters no product.

    Returns:
        The terms by total order, then by how many inputs they join.
    """
    options: list[list[Factor | None]] = []
    for k, width in enumerate(half_range):
        orders = range(1, spec.order + 1) if width > 0 else ()
        kinds = ("T",) if spec.family == "polynomial" else ("cos", "sin")
        options.append([None, *((k, kind, order) for order in orders for kind in kinds)])
    terms: list[Term] = []
    for chosen in product(*options):
        term = tuple(factor for factor in chosen if factor is not None)
        if len(term) <= MOST_INPUTS and sum(order for _, _, order in term) <= spec.order:
            terms.append(term)
    return tuple(sorted(terms, key=lambda term: (sum(order for _, _, order in term), len(term), term)))


def fit_products(
    spec: ModelSpec, inputs: ArrayLike, errors_mm: Array, rng: np.random.Generator
) -> tuple[ProductFeatures, Array, pd.DataFrame]:
    """Choose terms and fit them.

    Args:
        spec: family ("polynomial" or "fourier"), total order of a product, space.
        inputs: (M, k) identification rows.
        errors_mm: (M, A).
        rng: draws the folds.

    Returns:
        The chosen terms; their coefficients (A, n), mm; and the table of `compare_sizes`.
    """
    table = checked_inputs(inputs)
    centre, half_range = _standard(spec, table)
    terms = candidate_terms(spec, half_range)
    columns = ProductFeatures(spec, centre, half_range, terms).matrix(table)
    most = max(1, int(LARGEST_SHARE * len(table) * (FOLDS - 1) / FOLDS))
    order = _greedy(columns, errors_mm, most)
    fold_of = fold_numbers(len(table), rng)
    held_out = np.full((FOLDS, len(order)), np.nan)
    for fold in range(FOLDS):
        kept = fold_of != fold
        steps = _greedy(columns[kept], errors_mm[kept], len(order))
        missed = _missed(columns[kept], errors_mm[kept], columns[~kept], errors_mm[~kept], steps)
        held_out[fold, : len(steps)] = missed
    compared = _compared(_missed(columns, errors_mm, columns, errors_mm, order), held_out)
    chosen = order[: int(compared.loc[compared["chosen"], "terms"].iloc[0])]
    coefficients = np.asarray(np.linalg.lstsq(columns[:, chosen], errors_mm, rcond=None)[0].T, dtype=float)
    return ProductFeatures(spec, centre, half_range, tuple(terms[n] for n in chosen)), coefficients, compared


def _standard(spec: ModelSpec, table: Array) -> tuple[Array, Array]:
    """Middle and half the range of each input; half the range is 0 where it stands still."""
    low, high = table.min(axis=0), table.max(axis=0)
    return (low + high) / 2, np.where(high - low > STILL[spec.space], (high - low) / 2, 0.0)


def _greedy(columns: Array, errors: Array, most: int) -> list[int]:
    """Numbers of the columns in the order of orthogonal least squares; the constant (column 0) is always first."""
    rest, left = columns.copy(), errors.copy()
    whole = np.sum(columns**2, axis=0)
    chosen: list[int] = []
    for _ in range(min(most, columns.shape[1])):
        length = np.sum(rest**2, axis=0)
        usable = length > CARRIES_NOTHING * whole
        usable[chosen] = False
        if not usable.any():
            break
        gain = np.where(usable, np.sum((rest.T @ left) ** 2, axis=1) / np.where(usable, length, 1.0), -1.0)
        best = 0 if not chosen else int(np.argmax(gain))
        direction = rest[:, best] / np.sqrt(length[best])
        left = left - np.outer(direction, direction @ left)
        rest = rest - np.outer(direction, direction @ rest)
        chosen.append(best)
    return chosen


def _missed(columns: Array, errors: Array, at: Array, true: Array, steps: list[int]) -> Array:
    """(steps,) mean squared length of the error vector left at other rows, for the first 1, 2, ... terms."""
    q, r = np.linalg.qr(columns[:, steps])
    # R^-1 is triangular, so that its first k columns belong to the first k terms
    along = scipy.linalg.solve_triangular(r, at[:, steps].T, trans="T").T
    predicted = np.cumsum(along[:, :, None] * (q.T @ errors), axis=1)
    return np.asarray(np.mean(np.sum((true[:, None] - predicted) ** 2, axis=2), axis=0))


def _compared(fit: Array, held_out: Array) -> pd.DataFrame:
    """The table of `fit_products`; numbers of terms that not every fold reached are left out."""
    complete = np.flatnonzero(np.isfinite(held_out).all(axis=0))
    return compare_sizes("terms", complete + 1, fit[complete], held_out[:, complete])


def _factor_name(inputs: tuple[str, ...], factor: Factor) -> str:
    k, kind, order = factor
    if kind == "T":
        return f"T{order}({inputs[k]})"
    return f"{kind}({inputs[k] if order == 1 else f'{order} {inputs[k]}'})"
