"""The paper's outlook (sections 6.3 and 8) on its virtual robots: sub-volumes, and products between inputs."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd

from armscope.core.averages import rms_distance
from armscope.core.types import Array, Indices
from armscope.errormodels.features import FDP_CI, FOURIER_2_AI, POLYNOMIAL_4_AI, SDP_AI, SDP_CI, ModelSpec
from armscope.errormodels.fitted import with_products, with_regions
from armscope.errormodels.products import ProductFeatures, candidate_terms
from armscope.errormodels.regions import chosen_regions, compare_regions
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


def paper_regions(measurements: Measurements, specs: Sequence[ModelSpec], seed: int = 0) -> pd.DataFrame:
    """Error against the number of blended regions, for the first robot of a study.

    Args:
        measurements: of a study.
        specs: which models.
        seed: of the folds.

    Returns:
        Columns model, regions, fit_rms_mm, held_out_rms_mm, stderr_mm, chosen (see `compare_regions`), and one per test
        path: the RMS of the error vector that the blended model leaves there, mm.
    """
    identification = measurements.identification
    errors, parts = identification.errors_mm[0], []
    for spec in specs:
        inputs = identification.inputs(spec)
        table = compare_regions(spec, inputs, errors, np.random.default_rng(seed))
        divided = [with_regions(spec, inputs, errors, int(count)) for count in table["regions"]]
        for path in measurements.held_out:
            table[path.name] = [rms_distance(path.errors_mm[0] - model.predict(path.inputs(spec))) for model in divided]
        parts.append(table.assign(model=spec.name))
    table = pd.concat(parts, ignore_index=True)
    return table[["model", *table.columns.drop("model")]]


def paper_products(measurements: Measurements, specs: Sequence[ModelSpec], seed: int = 0) -> pd.DataFrame:
    """Sums of one-input terms against a sparse choice of their products, for the first robot of a study.

    Args:
        measurements: of a study.
        specs: which models.
        seed: of the folds.

    Returns:
        Columns model, kind ("sums", "products"), candidates, terms, fit_rms_mm, held_out_rms_mm, stderr_mm
        (cross-validation on the identification rows), and one per test path: RMS of the error vector left there, mm.
        All by least squares.
    """
    identification = measurements.identification
    errors, rows = identification.errors_mm[0], []
    for spec in specs:
        inputs = identification.inputs(spec)
        one = compare_regions(spec, inputs, errors, np.random.default_rng(seed), most_halvings=0)
        products, compared = with_products(spec, inputs, errors, np.random.default_rng(seed))
        plain, terms = with_regions(spec, inputs, errors, 1), products.features
        assert isinstance(terms, ProductFeatures)
        candidates = len(candidate_terms(spec, terms.half_range))
        by_kind = (
            ("sums", plain, one, plain.features.coefficients_per_axis),
            ("products", products, compared[compared["chosen"]], candidates),
        )
        for kind, model, scores, tried in by_kind:
            left = {
                each.name: rms_distance(each.errors_mm[0] - model.predict(each.inputs(spec)))
                for each in measurements.held_out
            }
            numbers = {name: float(scores[name].iloc[0]) for name in ("fit_rms_mm", "held_out_rms_mm", "stderr_mm")}
            counts = {"candidates": tried, "terms": model.features.coefficients_per_axis}
            rows.append({"model": spec.name, "kind": kind, **counts, **numbers, **left})
    return pd.DataFrame(rows)


PLAIN, SUB_VOLUMES, PRODUCTS = "sums", "sub-volumes", "products"
"""What a model is extended by: nothing; regions or products, as many as cross-validation bears out."""


def outlook(
    measurements: Measurements,
    regions: Sequence[ModelSpec] = (FDP_CI, SDP_AI),
    products: Sequence[ModelSpec] = (SDP_CI, POLYNOMIAL_4_AI, FOURIER_2_AI),
    seed: int = 0,
) -> pd.DataFrame:
    """What blended sub-volumes and products leave of the errors of every robot, each chosen by cross-validation.

    Args:
        measurements: identification and held-out sets of all robots.
        regions: models to divide.
        products: models to extend by products.
        seed: of the folds.

    Returns:
        Columns robot, model, kind (`PLAIN`, `SUB_VOLUMES`, `PRODUCTS`), size (regions, or terms), trajectory, rms_mm
        (of the error vector). All by least squares.
    """
    rows = []
    for robot, name in enumerate(measurements.robots):
        for spec in dict.fromkeys((*regions, *products)):
            extended = _extended(measurements, robot, spec, spec in regions, spec in products, seed)
            rows += [
                {"robot": name, "model": spec.name, "kind": kind, "size": size, "trajectory": path, "rms_mm": rms}
                for kind, size, left in extended
                for path, rms in left.items()
            ]
    return pd.DataFrame(rows)


def _extended(
    measurements: Measurements, robot: int, spec: ModelSpec, divided: bool, multiplied: bool, seed: int
) -> list[tuple[str, int, dict[str, float]]]:
    """(kind, size, RMS by trajectory) of one model of one robot, plain and extended."""
    rows = measurements.identification
    inputs, errors = rows.inputs(spec), rows.errors_mm[robot]
    plain = with_regions(spec, inputs, errors, 1)
    found = [(PLAIN, plain.features.coefficients_per_axis, plain)]
    if divided:
        count = chosen_regions(compare_regions(spec, inputs, errors, np.random.default_rng(seed)))
        found.append((SUB_VOLUMES, count, with_regions(spec, inputs, errors, count)))
    if multiplied:
        model, _ = with_products(spec, inputs, errors, np.random.default_rng(seed))
        found.append((PRODUCTS, model.features.coefficients_per_axis, model))
    return [
        (
            kind,
            size,
            {
                each.name: rms_distance(each.errors_mm[robot] - model.predict(each.inputs(spec)))
                for each in measurements.sets
            },
        )
        for kind, size, model in found
    ]
