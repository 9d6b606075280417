"""Sides that the order of rows tells stand in the fit, and in nothing that is promised of other rows."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from armscope.diagnosis.summary.untold_sides import as_recorded

from ..planted import planted


def test_rows_are_handed_on_as_they_were_recorded() -> None:
    _, table = planted("six-axis", {}, 30, 0.03, seed=6)
    assert as_recorded(table) is table
    bare = replace(table, approach=None)
    filled = replace(bare, approach=np.ones(table.motor_angles.shape), sides_by_order=True)
    assert as_recorded(filled).approach is None
    assert not as_recorded(filled).sides_by_order
