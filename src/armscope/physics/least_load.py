"""What a free curve of a joint's load comes to where that load is least: without any, all that is left is a zero."""

from __future__ import annotations

import numpy as np

from armscope.core.types import Array
from armscope.physics.drivers import cubic_spline
from armscope.physics.effect import ONE, Driver, Placed


def at_least_load(curve: Placed) -> Array:
    """(k,) what each term of a free curve of load does where the load is least: none, where rows bore it on both sides.

    Without a load nothing follows it: what is left there of a joint's turn is its zero.
    """
    splines = [p.driver for each in curve.terms for p in each.products if p.driver.kind == "spline"]
    centres = [driver.number(1) for driver in splines]
    load = float(np.clip(0.0, min(centres), max(centres)))

    def does(driver: Driver) -> float:
        if driver.kind == "spline":
            return float(cubic_spline(np.array([load]), driver.number(1), driver.number(2))[0])
        if driver.kind == "load side":
            return float(np.sign(load))
        return 1.0 if driver == ONE else load

    return np.array([sum(p.factor * does(p.driver) for p in each.products[:1]) for each in curve.terms])
