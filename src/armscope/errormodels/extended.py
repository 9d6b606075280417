"""The paper's models as its outlook extends them (sections 6.3 and 8), by least squares: products, blended regions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from armscope.core.types import Array
from armscope.errormodels.features import FeatureSet, ModelSpec
from armscope.errormodels.products import ProductFeatures, fit_products
from armscope.errormodels.regions import Cut, blended, divide, fit_regions, halvings_of


@dataclass(frozen=True)
class ModelSet:
    """Which models are fitted."""

    plain: tuple[ModelSpec, ...] = ()
    products: tuple[ModelSpec, ...] = ()  # with a sparse choice of products
    regions: tuple[tuple[ModelSpec, int], ...] = ()  # divided into so many blended regions


@dataclass(frozen=True, eq=False)
class ExtendedModel:
    """A model fitted by least squares."""

    name: str  # the model's name and how it is extended
    features: FeatureSet | ProductFeatures
    coefficients: Array  # (regions, axes, terms) mm per unit of a term
    cut: Cut | None = None  # the borders of the regions; None for a single one

    def predict(self, inputs: ArrayLike) -> Array:
        """(N, axes) mm at inputs (N, k), mm or rad."""
        return blended(self.features, self.cut, self.coefficients, inputs)


def with_regions(spec: ModelSpec, inputs: Array, errors_mm: Array, count: int) -> ExtendedModel:
    """A model divided into blended regions.

    Args:
        spec: of every region.
        inputs, errors_mm: (M, k), (M, axes) identification rows.
        count: 1, 2, 4, ... regions.

    Returns:
        The fitted model.
    """
    features, cut = spec.features(inputs), divide(inputs, halvings_of(count))
    name = f"{spec.name}, {count} regions" if count > 1 else spec.name
    return ExtendedModel(name, features, fit_regions(features, cut, inputs, errors_mm), cut)


def with_products(
    spec: ModelSpec, inputs: Array, errors_mm: Array, rng: np.random.Generator
) -> tuple[ExtendedModel, pd.DataFrame]:
    """A model with a sparse choice of products.

    Args:
        spec: whose products.
        inputs, errors_mm: (M, k), (M, axes) identification rows.
        rng: draws the folds.

    Returns:
        The fitted model, and how the number of terms was chosen (see `fit_products`).
    """
    features, coefficients, compared = fit_products(spec, inputs, errors_mm, rng)
    return ExtendedModel(features.name, features, coefficients[None]), compared
