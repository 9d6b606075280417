"""A curve of load where there is no load, against the same curve evaluated at rows that bear none."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.physics.effect import Part
from armscope.physics.freeform import UNKNOWN
from armscope.physics.least_load import at_least_load
from armscope.physics.scene import Scene

from .scenes import arm_named, full_table


@pytest.mark.parametrize("heavy", [False, True])
def test_what_is_left_of_a_curve_without_load_is_what_it_does_in_rows_of_least_load(heavy: bool) -> None:
    arm = arm_named("six-axis")
    table = replace(full_table(arm, 400, seed=2), payload=None)
    if heavy:  # one side alone: the least load is where the curve begins
        loads = Scene(arm, table).torques[:, 2]
        table = table.rows(np.flatnonzero(loads > 0.3 * loads.max()))
    (curve,) = [p for p in UNKNOWN.place(arm, table) if (p.location, p.variant) == ("joint 3", "load")]
    scene = Scene(arm, table)
    values = 1e-3 * np.random.default_rng(1).normal(size=len(curve.terms))
    names = np.array([term.name for term in curve.terms])
    values[names == "gap"] = 0.0  # a step, where it would stand on either side
    values[names == "compliance"] *= 1e-2
    (turned,) = scene.amounts([Part(curve, values)]).values()
    load = scene.torques[:, 2]
    order = np.argsort(load)
    assert (load.min() > 0) == heavy
    assert at_least_load(curve) @ values == pytest.approx(np.interp(0.0, load[order], turned[order]), abs=1e-5)
    assert np.ptp(turned) > 1e-3
