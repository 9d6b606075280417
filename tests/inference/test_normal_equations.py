"""Sums over rows of frames that all but cancel: they take up nothing that they could not move."""

from __future__ import annotations

import numpy as np
import pytest

from armscope.inference.constants import NUMERICS
from armscope.inference.normal_equations import NormalEquations, column_scales, projected_rms, steadied

FRAMES = np.arange(3)


def sums_where(apart: float) -> NormalEquations:
    """Two frame columns that differ by a share of their size, along what a fourth column does, too; another frame."""
    rng = np.random.default_rng(4)
    common, other, effect = rng.normal(size=(3, 300))
    X = np.column_stack([common, common + apart * effect, other, effect])
    y = 0.2 * effect + 0.01 * rng.normal(size=300)
    return NormalEquations(X.T @ X, X.T @ y, float(y @ y), 300.0)


@pytest.mark.parametrize("apart", [1e-4, 1e-5])
def test_frames_that_would_move_by_metres_take_up_nothing(apart: float) -> None:
    """Of a planar arm 98 % of a link's error went into base and tool, which moved by 1.9 m against each other."""
    sums = sums_where(apart)
    held = steadied(sums, FRAMES)
    before, raw = (np.sqrt(each.least_rss(FRAMES) / 300) for each in (held, sums))
    assert before == pytest.approx(0.2, rel=0.1)
    assert raw < 0.1 * before
    assert column_scales(held, FRAMES)[3] == pytest.approx(1, rel=0.1)
    assert projected_rms(held, FRAMES, np.array([0, 0, 0, 0.2])) == pytest.approx(0.2, rel=0.1)


def test_frames_that_rows_tell_apart_stay_free() -> None:
    sums = sums_where(3 * NUMERICS.cancelling)
    assert steadied(sums, FRAMES) is sums
