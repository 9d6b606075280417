"""Sums over blocks of rows, structured and chunk by chunk, against products of columns that are written out."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.fitting.block_sums import normal_equations_by_block, slope_at
from armscope.fitting.constants import STEPS
from armscope.fitting.design_matrix import point_columns
from armscope.fitting.linearisation import LinearisedTable, point_residuals
from armscope.fitting.parameter_layout import current_parameters, parameter_layout
from armscope.measurement.row_weights import RowWeights
from armscope.physics.frames import free_frames
from armscope.physics.model import predict
from tests.physics.scenes import arm_named, full_table
from tests.physics.test_model import model_with_everything

ROWS = 40


@pytest.mark.parametrize("chunk_rows", [7, STEPS.chunk_rows])
def test_sums_are_the_products_of_the_columns_block_by_block(chunk_rows: int, monkeypatch: pytest.MonkeyPatch) -> None:
    rng = np.random.default_rng(1)
    monkeypatch.setattr("armscope.fitting.linearisation.STEPS", replace(STEPS, chunk_rows=chunk_rows))
    model, rows = model_with_everything("six-axis", 5), full_table(arm_named("six-axis"), ROWS, 5)
    table = replace(rows, positions=predict(model, rows) + rng.normal(0, 1e-3, (ROWS, 3)), orientation=None)
    placed = [part.placed for part in model.parts]
    layout = parameter_layout(free_frames(table, False), [[p.placed for p in model.background]], placed)
    weight, block_of_row = rng.uniform(0.1, 1, ROWS), rng.integers(0, 3, ROWS)
    weights = RowWeights.of_positions(weight)
    X = point_columns(model.posture(model.scene(table)), layout.terms).reshape(ROWS, 3, -1)
    y = point_residuals(model, table) + X @ current_parameters(layout, model)
    for measured in (table, LinearisedTable(table, order=np.argsort(block_of_row, kind="stable"))):
        found = normal_equations_by_block(layout, model, measured, weights, block_of_row)
        assert len(found) == 3
        for block, sums in enumerate(found):
            at = block_of_row == block
            weighted = weight[at, None, None] * X[at]
            G = np.einsum("nik,nil->kl", weighted, X[at])
            scale = np.sqrt(np.outer(np.diag(G), np.diag(G))) + 1e-300
            assert np.abs((sums.G - G) / scale).max() < 1e-9
            b, yy = np.einsum("nik,ni->k", weighted, y[at]), np.sum(weight[at, None] * y[at] ** 2)
            assert np.abs((sums.b - b) / np.sqrt(np.diag(G) * yy + 1e-300)).max() < 1e-9
            assert sums.yy == pytest.approx(yy)


def test_the_slope_about_known_products_gives_the_same_sums() -> None:
    rng = np.random.default_rng(2)
    model, rows = model_with_everything("six-axis", 5), full_table(arm_named("six-axis"), ROWS, 5)
    table = replace(rows, positions=predict(model, rows) + rng.normal(0, 1e-3, (ROWS, 3)), orientation=None)
    placed = [part.placed for part in model.parts]
    layout = parameter_layout(free_frames(table, False), [[p.placed for p in model.background]], placed)
    weight, at = rng.uniform(0.1, 1, ROWS), current_parameters(layout, model)
    weights = RowWeights.of_positions(weight)
    (whole,) = normal_equations_by_block(layout, model, table, weights, np.zeros(ROWS, dtype=np.intp))
    slope = slope_at(layout, model, table, weights)
    assert slope.left == pytest.approx(np.sum(weight[:, None] * point_residuals(model, table) ** 2))
    again = slope.about(whole.G, at)
    scale = np.sqrt(np.diag(whole.G) * whole.yy) + 1e-300
    assert np.abs((again.b - whole.b) / scale).max() < 1e-9
    assert (again.yy, again.n) == pytest.approx((whole.yy, whole.n))
