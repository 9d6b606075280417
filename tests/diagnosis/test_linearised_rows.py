"""Rows at a point of linearisation: what values of their columns leave of them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from armscope.diagnosis.linearised_rows import LinearisedRows
from armscope.diagnosis.selection_loop import SelectionLoop
from armscope.fitting.linearisation import LinearisedTable, point_residuals
from armscope.fitting.registration import fit_frames
from armscope.measurement.noise import Noise
from armscope.physics.frames import free_frames

from ..backgrounds import sizes
from .planted import planted


def test_readings_are_told_at_the_point_where_their_columns_were_taken() -> None:
    """A round may move the frames; errors of its hypotheses must not count that move twice."""
    arm, table = planted("six-axis", {("joint_offset", "joint 3"): [3e-4]}, 100, 0.02, seed=8)
    near = fit_frames(arm, table)
    off = replace(near, tools=tuple(replace(part, values=part.values + 5e-4) for part in near.tools))
    blocks = np.arange(100) % 5
    round_ = SelectionLoop(off, table, Noise(0.0, 0.0, ""), free_frames(table, False), blocks, lambda text, share: None)
    round_.round([sizes()])
    found = round_.selected()
    values = found.best.coefficients(len(found.problem.scale)) / found.problem.scale
    assert found.table.recordings is table
    rows = LinearisedRows(found.point, found.table, found.fit.weights, found.space.layout)
    left = rows.residuals(values[None])[0]
    np.testing.assert_allclose(left, found.fit.residuals, atol=0.004)
    assert np.abs(point_residuals(off, table) - point_residuals(found.fit.model, table)).max() > 0.2
    apart = replace(rows, table=LinearisedTable(table))
    np.testing.assert_allclose(apart.residuals(values[None])[0], left, rtol=0, atol=1e-9)
