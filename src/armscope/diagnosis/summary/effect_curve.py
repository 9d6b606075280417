"""What an effect does over its driver, as a curve with a band, and in words."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from armscope.core.types import Array
from armscope.diagnosis.summary.constants import TELLING
from armscope.physics.drivers import KINDS, cubic_spline
from armscope.physics.effect import ONE, Driver, Placed
from armscope.physics.scene import Scene
from armscope.verdict.effects import Curve

SIDE = "load side"
"""The driver of play by a load, which has a value on either side of it."""


def source_of(placed: Placed) -> Driver | None:
    """The one driver that all of an effect's terms are functions of; None where there are several or none."""
    drivers = {product.driver for term in placed.terms for product in term.products}
    sources = {_root(driver) for driver in drivers if driver != ONE}
    if placed.parametrisation == "curve":  # one of load holds a step where the load changes its side
        sources = {Driver("torque", each.arguments) if each and each.kind == SIDE else each for each in sources}
    source = sources.pop() if len(sources) == 1 else None
    return None if source is None or source.kind == SIDE else source


def _root(driver: Driver) -> Driver | None:
    if driver.kind in ("sine", "cosine"):
        return Driver("angle", (driver.arguments[0],))
    if driver.kind in ("spline", "held"):
        return _root(driver.arguments[0]) if isinstance(driver.arguments[0], Driver) else None
    return driver if KINDS[driver.kind].unit or driver.kind == SIDE else None


def curve_of(placed: Placed, values: Array, covariance: Array, scene: Scene) -> Curve | None:
    """The turn or shift that an effect makes over its driver's recorded range; the direction that moves most.

    Args:
        placed: the effect.
        values: (k,) of its terms, SI.
        covariance: (k, k) of them.
        scene: the recorded rows.

    Returns:
        Values with standard errors over the driver.
    """
    source = source_of(placed)
    if source is None:
        return None
    recorded, unit = scene.driver(source), KINDS[source.kind].unit
    at = np.linspace(recorded.min(), recorded.max(), TELLING.grid)
    directions = {term.products[0].direction for term in placed.terms}
    best: tuple[float, Array, Array, str] | None = None
    for direction in sorted(directions, key=lambda d: (d.location, d.axis)):
        inside = [n for n, term in enumerate(placed.terms) if term.products[0].direction == direction]
        basis = _basis(placed, inside, at)
        if placed.parametrisation == "curve":
            # a constant is the base's or the joint's zero: only the shape about the mean is the curve's own
            basis = basis - _basis(placed, inside, recorded).mean(axis=0)
        value = basis @ values[inside]
        band = np.sqrt(np.maximum(np.einsum("ni,ij,nj->n", basis, covariance[np.ix_(inside, inside)], basis), 0.0))
        telling = float(np.std(value) / max(float(np.median(band)), 1e-30))
        if best is None or telling > best[0]:
            best = telling, value, band, "m" if direction.axis[0] == "t" and direction.axis != "turn" else "rad"
    assert best is not None
    value, band = best[1], best[2]
    periods = _periods(placed, values) if source.kind == "angle" else ()
    return Curve(placed.driver, unit, at, value, band, best[3], describe(at, value, recorded, periods, unit))


def _basis(placed: Placed, inside: Sequence[int], at: Array) -> Array:
    """(K, terms) what the terms ``inside`` do at values of their driver."""
    products = [placed.terms[n].products[0] for n in inside]
    return np.column_stack([product.factor * _value(product.driver, at) for product in products])


def _value(driver: Driver, at: Array) -> Array:
    """A driver as a function of its source's values."""
    if driver.kind == "sine":
        return np.sin(driver.number(1) * at)
    if driver.kind == "cosine":
        return np.cos(driver.number(1) * at)
    if driver.kind == "spline":
        return cubic_spline(at, driver.number(1), driver.number(2))
    if driver.kind == SIDE:
        return np.sign(at)
    return np.ones_like(at) if driver == ONE else at


def _periods(placed: Placed, values: Array) -> tuple[tuple[float, float], ...]:
    """The strongest waves per turn and their amplitudes, rad."""
    lines: dict[float, float] = {}
    for term, value in zip(placed.terms, values, strict=True):
        driver = term.products[0].driver
        if driver.kind in ("sine", "cosine"):
            count = driver.number(1)
            lines[count] = lines.get(count, 0.0) + float(value) ** 2
    strongest = sorted(lines.items(), key=lambda line: -line[1])[:5]
    return tuple((count, float(np.sqrt(power))) for count, power in strongest)


def describe(
    at: Array, value: Array, recorded: Array, periods: tuple[tuple[float, float], ...] = (), unit: str = ""
) -> str:
    """The simple shape that comes closest to a curve over values in ``unit``, weighted by where rows were recorded.

    Args:
        at: (G,) the driver's values.
        value: (G,) the curve.
        recorded: (N,) the driver's values in the table.
        periods: of the waves that it holds, with their amplitudes.
        unit: of the values.

    Returns:
        A few words.
    """
    density, _ = np.histogram(recorded, bins=np.append(at, at[-1] + 1e-9))
    weight = np.convolve(density, np.ones(9) / 9, mode="same") + 1e-6 * max(density.max(), 1)
    shapes: list[tuple[float, str]] = [(_explained(value, [at], weight), "a trend in proportion to its driver")]
    span = at[-1] - at[0]
    for cut in np.linspace(at[0] + 0.1 * span, at[-1] - 0.1 * span, 33):
        place = f"{np.degrees(cut):.0f} deg" if unit == "rad" else f"{cut:.3g} {unit}".rstrip()
        shapes.append((_explained(value, [np.tanh((at - cut) / (0.03 * span))], weight), f"a step at {place}"))
        shapes.append((_explained(value, [np.clip(at - cut, 0, None)], weight), f"only beyond {place}"))
        shapes.append((_explained(value, [np.clip(cut - at, 0, None)], weight), f"only below {place}"))
        for width in (0.04, 0.08):
            bump = np.exp(-0.5 * ((at - cut) / (width * span)) ** 2)
            shapes.append((_explained(value, [bump], weight), f"a local bump at {place}"))
    for count, _ in periods[:3]:
        waves = [np.cos(count * at), np.sin(count * at)]
        shapes.append((_explained(value, waves, weight), f"a wave, {count:.3g} per turn"))
    share, words = max(shapes)
    trend = shapes[0]
    if trend[0] > share - 0.02:
        share, words = trend
    return words if share > TELLING.telling_share else "a free curve" + _strongest(periods)


def _strongest(periods: tuple[tuple[float, float], ...]) -> str:
    if not periods:
        return ""
    return ", strongest waves per turn: " + ", ".join(f"{count:.3g}" for count, _ in periods[:3])


def _explained(value: Array, shapes: list[Array], weight: Array) -> float:
    root = np.sqrt(weight)
    X = np.column_stack([np.ones_like(value), *shapes]) * root[:, None]
    y = value * root
    left = y - X @ np.linalg.lstsq(X, y, rcond=None)[0]
    centred = (value - np.average(value, weights=weight)) * root
    return 1 - float(left @ left) / max(float(centred @ centred), 1e-300)
