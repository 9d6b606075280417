"""The error of the nominal arm where orientations were measured, too: base and tool are placed by its points alone.

Orientations that the nominal arm gets wrong would drag the base away from its points, and the error before anything is
mended would be told larger than anybody measures it.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from armscope.core.types import Array, Indices
from armscope.diagnosis.linearised_rows import LinearisedRows
from armscope.physics.effect import Term


def placed_by_points(all_rows: LinearisedRows, frames: Sequence[Term], errors: Array, held: Sequence[Indices]) -> Array:
    """Errors of points once base and tool are placed anew by the points of the rows that are not held out.

    Args:
        all_rows: N rows; those that look like bad shots place nothing.
        frames: the terms of bases and tools.
        errors: (N, 3) mm, base axes, under any frames, the same for all rows.
        held: rows that are held out together, fold by fold; frames that only they have are placed by themselves.

    Returns:
        (N, 3) mm; of rows in no fold as they were.
    """
    count = len(all_rows.recordings)
    X = all_rows.unweighted_columns(frames).reshape(count, -1, len(frames))[:, :3]
    X = X / np.maximum(np.linalg.norm(X, axis=(0, 1)), 1e-300)
    root = all_rows.weights.unwhitened.of_channels[0].factor(np.arange(count)) * all_rows.trusted
    left = errors.copy()
    for at in held:
        learn = np.setdiff1d(np.arange(count), at)
        known = np.linalg.norm(X[learn], axis=(0, 1)) > 0
        for rows, which in ((learn, known), (at, ~known)):
            if which.any():
                weighted = root[rows, None, None] * X[rows][:, :, which]
                response = root[rows, None] * left[rows] if rows is at else root[rows, None] * errors[rows]
                flat = weighted.reshape(-1, int(which.sum()))
                values = np.linalg.lstsq(flat, response.reshape(-1), rcond=1e-12)[0]
                left[at] -= X[at][:, :, which] @ values
    return left
