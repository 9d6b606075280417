"""A curve over a joint's torque holds beside the model that it is part of, or is none."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from armscope.motion.library import catalogue
from armscope.motion.library.laws import Law, higher_powers
from armscope.motion.library.layout import DRY, OWN
from armscope.motion.summary.of_own_torque import of_another_model

CURVE = np.arange(OWN, OWN + 3)
"""Columns of the curve, behind those of the one joint."""


def fitted_beside(dry: float) -> Any:
    """A joint of friction, and a curve that was formed where dry friction was one; it was fitted beside another."""
    rng, width = np.random.default_rng(3), OWN + 3
    side, nominal = np.sign(rng.normal(size=400)), 0.2 * rng.normal(size=(400, 1))
    formed = higher_powers(nominal[:, 0] + side, 1.0)
    columns = np.zeros((400, width))
    columns[:, DRY], columns[:, CURVE[0]], columns[:, CURVE[1:]] = side, nominal[:, 0], formed
    coefficients = np.zeros(width)
    coefficients[DRY], coefficients[CURVE] = dry, [0.0, -0.5, 0.3]
    noise = 0.01 * rng.normal(size=(400, 1))
    rows = SimpleNamespace(
        nominal=nominal,
        moving=np.ones((400, 1), dtype=bool),
        torque=nominal + (columns @ coefficients)[:, None] + noise,
        modelled=lambda at: (columns @ at)[:, None],
        layout=SimpleNamespace(
            width=width,
            columns={0: CURVE},
            placed=[
                SimpleNamespace(
                    cause=catalogue.CURVE,
                    driver=catalogue.SCALE,
                    joints=(0,),
                    columns=Law("powers of torque", (0,), (1.0,)),
                )
            ],
        ),
    )
    return SimpleNamespace(rows=rows, best=SimpleNamespace(candidates=frozenset({0})), coefficients=coefficients)


@pytest.mark.parametrize(("dry", "wrong"), [(1.0, []), (1.3, [0])])
def test_a_curve_that_trades_with_friction_is_of_another_model(dry: float, wrong: list[int]) -> None:
    """Its rows were met to 0.02 N m, and the model that was written missed its own recording by 0.23 N m."""
    assert list(of_another_model(fitted_beside(dry))) == wrong
