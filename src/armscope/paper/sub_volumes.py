"""Would several models for several regions be better? (sections 6.3 and 8: dividing the workspace into sub-volumes).

The regions are found without looking at errors: the identification poses' nominal positions are halved at their median
along y, then each half along z, and so on, as a k-d tree does. Each region has its own least-squares model, fitted to
its own identification rows; every other pose uses the model of the region it lies in.
"""

from __future__ import annotations

import numpy as np
import pandas as pd

from armscope.core.types import Array, Indices
from armscope.errormodels.features import FDP_CI, SDP_CI, ModelSpec
from armscope.paper.measurements import Measurements

SPLIT_ORDER = (1, 2)  # Halved along y first, then along z (columns of the nominal position)


def sub_volumes(
    measurements: Measurements, specs: tuple[ModelSpec, ...] = (FDP_CI, SDP_CI), splits: tuple[int, ...] = (0, 1, 2)
) -> pd.DataFrame:
    """Residuals with one, two and four regions, by least squares.

    Args:
        measurements: identification and held-out sets of all robots.
        specs: Cartesian models to fit in each region.
        splits: how many times the workspace is halved.

    Returns:
        Columns robot, model, regions (1, 2, 4), trajectory, coefficients (of all regions and axes together),
        identification_rows (of the smallest region), rss_mm and rms_mm of the error vector (3D).
    """
    parts = []
    fitted = measurements.identification
    for spec in specs:
        features = spec.features(fitted.inputs(spec))
        for n_splits in splits:
            tree = _split(fitted.nominal_mm, np.arange(len(fitted.nominal_mm)), n_splits, 0)
            regions = {each.name: _region(tree, each.nominal_mm) for each in measurements.sets}
            rows_of = [np.flatnonzero(regions[fitted.name] == region) for region in range(2**n_splits)]
            coefficients = [
                _fit(features.matrix(fitted.nominal_mm[rows]), fitted.errors_mm[:, rows]) for rows in rows_of
            ]
            for each in measurements.sets:
                terms = features.matrix(each.nominal_mm)
                chosen = np.stack(coefficients)[regions[each.name]]  # (N, R, terms, 3)
                residual = each.errors_mm - np.einsum("nt,nrta->rna", terms, chosen)
                squares = np.einsum("rna,rna->r", residual, residual)
                parts.append(
                    pd.DataFrame(
                        {
                            "robot": measurements.robots,
                            "model": spec.name,
                            "regions": 2**n_splits,
                            "trajectory": each.name,
                            "coefficients": 3 * features.coefficients_per_axis * 2**n_splits,
                            "identification_rows": min(len(rows) for rows in rows_of),
                            "rss_mm": np.sqrt(squares),
                            "rms_mm": np.sqrt(squares / len(terms)),
                        }
                    )
                )
    return pd.concat(parts, ignore_index=True)


def _fit(terms: Array, errors: Array) -> Array:
    """(R, terms, 3) least squares of R robots' errors (R, N, 3)."""
    scale = np.linalg.norm(terms, axis=0)
    solved: Array = np.linalg.pinv(terms / scale) @ errors
    return np.asarray(solved / scale[:, None])


Tree = tuple[int, float, "Tree", "Tree"] | None


def _split(points: Array, rows: Indices, n_splits: int, depth: int) -> Tree:
    """Median cuts of a k-d tree over the identification positions."""
    if depth == n_splits:
        return None
    axis = SPLIT_ORDER[depth % len(SPLIT_ORDER)]
    cut = float(np.median(points[rows, axis]))
    below = points[rows, axis] < cut
    return (
        axis,
        cut,
        _split(points, rows[below], n_splits, depth + 1),
        _split(points, rows[~below], n_splits, depth + 1),
    )


def _region(tree: Tree, points: Array) -> Indices:
    """(N,) the number of the region that each point lies in."""
    if tree is None:
        return np.zeros(len(points), dtype=np.intp)
    axis, cut, below, above = tree
    first, second = _region(below, points), _region(above, points)
    offset = _leaves(below)
    return np.where(points[:, axis] < cut, first, second + offset)


def _leaves(tree: Tree) -> int:
    return 1 if tree is None else _leaves(tree[2]) + _leaves(tree[3])
