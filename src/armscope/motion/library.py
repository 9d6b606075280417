"""The library placed on an arm: every cause at every joint or link where the table can show it."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from scipy.interpolate import BSpline

from armscope.core.types import Array
from armscope.motion import catalogue
from armscope.motion.causes import Cause, Columns, Moment, PlacedCause, Seen, coulomb_width
from armscope.motion.constants import LIBRARY
from armscope.motion.masses import place_masses


def place_causes(seen: Seen) -> list[PlacedCause]:
    """Every cause that the table can show, at every place."""
    moving = [int(j) for j in np.flatnonzero(seen.moving)]
    placed = [cause for joint in moving for cause in _background(seen, joint)]
    placed += [cause for joint in moving for cause in _at_joint(seen, joint)]
    placed += [cause for one, other in itertools.pairwise(moving) for cause in _coupled(seen, one, other)]
    return [*placed, *place_masses(seen)]


def _own(joint: int, column: Callable[[Moment], Array]) -> Columns:
    """Columns of one joint's own torque from (N,) or (N, c)."""

    def columns(moment: Moment) -> Array:
        values = column(moment)
        return values[:, None, None] if values.ndim == 1 else values[:, None, :]

    return columns


def _background(seen: Seen, j: int) -> Iterator[PlacedCause]:
    """The joint's offset, and what of its friction and rotor robot.yaml states: departures from that are catalogue."""
    torque, unit = seen.torque(j), seen.unit(j)
    units = (torque, torque, f"{torque} s/{unit}", "kg" if seen.arm.sliding[j] else "kg m^2")
    names = ("offset", "coulomb", "viscous", "inertia")
    for number, cause in enumerate(catalogue.BACKGROUND):
        if number == 0 or np.isfinite(seen.arm.stated_background[j, number]):
            yield PlacedCause(
                cause,
                f"joint {j + 1}",
                ("constant", "direction", "speed", "acceleration")[number],
                ((names[number], units[number]),),
                (j,),
                of_background=(j, number),
            )


def _at_joint(seen: Seen, j: int) -> Iterator[PlacedCause]:
    unit, torque, place = seen.unit(j), seen.torque(j), f"joint {j + 1}"
    width = float(coulomb_width(seen.arm)[j])

    def at(
        cause: Cause,
        driver: str,
        parameters: tuple[tuple[str, str], ...],
        column: Callable[[Moment], Array],
        **more: Any,
    ) -> PlacedCause:
        return PlacedCause(cause, place, driver, parameters, (j,), _own(j, column), **more)

    def speed(m: Moment) -> Array:
        return m.signals.dq[:, j]

    def side(m: Moment) -> Array:
        return np.asarray(np.tanh(speed(m) / width))

    both_ways = seen.dq[j, 0] < -LIBRARY.slow * width and seen.dq[j, 1] > LIBRARY.slow * width
    if both_ways:
        yield at(
            catalogue.ASYMMETRY,
            "direction",
            (("viscous_difference", f"{torque} s/{unit}"),),
            lambda m: np.abs(speed(m)),
        )
        fastest = float(np.abs(seen.dq[j]).max())
        widths = np.geomspace(LIBRARY.slow * width, max(fastest / 2, 2 * LIBRARY.slow * width), LIBRARY.stribeck_widths)
        for v in widths:
            yield at(
                catalogue.STRIBECK,
                "speed",
                (("stribeck", torque),),
                _stribeck(side, speed, float(v)),
                variant=f"{v:.3g}",
                multiplicity=len(widths),
                scanned=(("speed", f"{unit}/s", float(v)),),
            )
        yield at(catalogue.LOAD_FRICTION, "load", (("per_load", ""),), lambda m: np.abs(m.rigid[:, j]) * side(m))
        yield at(
            catalogue.VISCOUS_CURVE,
            "speed",
            (("square", f"{torque} s^2/{unit}^2"), ("cube", f"{torque} s^3/{unit}^3")),
            lambda m: np.column_stack([speed(m) * np.abs(speed(m)), speed(m) ** 3]),
        )
        if seen.temperature is not None and np.ptp(seen.temperature[j]) > LIBRARY.least_warming_k:
            middle = float(np.mean(seen.temperature[j]))
            yield at(
                catalogue.TEMPERATURE_FRICTION,
                "temperature",
                (("per_kelvin", f"{torque} s/({unit} K)"),),
                lambda m: _warm(m, j, middle) * speed(m),
                variant="viscous",
            )
            yield at(
                catalogue.TEMPERATURE_FRICTION,
                "temperature",
                (("dry_per_kelvin", f"{torque}/K"),),
                lambda m: _warm(m, j, middle) * side(m),
                variant="dry",
            )
            yield at(
                catalogue.CURVE,
                "temperature",
                _knots(LIBRARY.knots_of_others, torque),
                _curve(lambda m: _warm(m, j, 0.0), seen.temperature[j], LIBRARY.knots_of_others),
                variant="temperature",
                is_curve=True,
            )
    yield at(catalogue.GAIN, "torque", (("gain", ""),), lambda m: m.predicted[:, j])
    yield at(catalogue.DELAY, "torque", (("delay", "s"),), lambda m: -np.gradient(m.predicted[:, j], 1 / m.rate))
    middle_q = float(np.mean(seen.q[j]))
    yield at(
        catalogue.BALANCER, "joint angle", (("stiffness", f"{torque}/{unit}"),), lambda m: m.signals.q[:, j] - middle_q
    )
    if not seen.arm.sliding[j]:
        yield at(
            catalogue.BALANCER,
            "joint angle",
            (("sine", torque), ("cosine", torque)),
            _wave(j, 1),
            variant="counterweight",
        )
        span = float(np.ptp(seen.q[j]))
        counts = [n for n in LIBRARY.ripple_counts if n * span > 2 * np.pi * LIBRARY.least_waves]
        for n in counts:
            yield at(
                catalogue.RIPPLE,
                "joint angle",
                (("sine", torque), ("cosine", torque)),
                _wave(j, n),
                variant=str(n),
                multiplicity=len(counts),
                scanned=(("per_turn", "", float(n)),),
            )
    yield at(
        catalogue.CABLE,
        "joint angle",
        _knots(LIBRARY.knots_of_position, torque),
        _curve(lambda m: m.signals.q[:, j], seen.q[j], LIBRARY.knots_of_position),
        is_curve=True,
    )
    yield at(
        catalogue.CURVE,
        "time",
        _knots(LIBRARY.knots_of_time, torque),
        _curve(lambda m: m.signals.time, seen.time, LIBRARY.knots_of_time),
        variant="time",
        is_curve=True,
    )
    ranges: tuple[tuple[str, Callable[[Moment], Array], Array], ...] = (
        ("speed", speed, seen.dq[j]),
        ("load", lambda m: m.rigid[:, j], np.array([-1.0, 1.0]) * seen.load[j]),
    )
    for driver, of, limits in ranges:
        if np.ptp(limits) > 0:
            yield at(
                catalogue.CURVE,
                driver,
                _knots(LIBRARY.knots_of_others, torque),
                _curve(of, limits, LIBRARY.knots_of_others),
                variant=driver,
                is_curve=True,
            )


def _warm(m: Moment, j: int, middle: float) -> Array:
    assert m.signals.temperature is not None
    return np.asarray(m.signals.temperature[:, j] - middle)


def _stribeck(side: Callable[[Moment], Array], speed: Callable[[Moment], Array], v: float) -> Callable[[Moment], Array]:
    return lambda m: side(m) * np.exp(-((speed(m) / v) ** 2))


def _wave(j: int, count: int) -> Callable[[Moment], Array]:
    return lambda m: np.column_stack([np.sin(count * m.signals.q[:, j]), np.cos(count * m.signals.q[:, j])])


def _knots(count: int, unit: str) -> tuple[tuple[str, str], ...]:
    return tuple((f"knot {k + 1}", unit) for k in range(count))


def _curve(of: Callable[[Moment], Array], limits: Array, count: int) -> Callable[[Moment], Array]:
    """Columns of a cubic spline with evenly spaced knots; beyond the limits it goes on as it was there."""
    low, high = float(limits[0]), float(limits[1])
    knots = np.r_[[low] * 3, np.linspace(low, high, count - 2), [high] * 3]

    def columns(m: Moment) -> Array:
        return np.asarray(BSpline.design_matrix(np.clip(of(m), low, high), knots, 3).toarray())

    return columns


def _coupled(seen: Seen, j: int, k: int) -> Iterator[PlacedCause]:
    """What turns with the sum or the difference of two neighbours' motions, and acts on both of them."""
    width, place = coulomb_width(seen.arm), f"joint {k + 1} from joint {j + 1}"
    if seen.arm.sliding[j] != seen.arm.sliding[k]:
        return
    torque, unit = seen.torque(k), seen.unit(k)
    rubbing = (("coulomb", torque), ("viscous", f"{torque} s/{unit}"))
    for sign, variant in ((1.0, ""), (-1.0, "difference")):
        yield PlacedCause(
            catalogue.COUPLED_FRICTION,
            place,
            "the neighbour's speed",
            rubbing,
            (j, k),
            _rubbing(j, k, sign, float(min(width[j], width[k]))),
            variant=variant,
        )
        yield PlacedCause(
            catalogue.COUPLED_INERTIA,
            place,
            "the neighbour's acceleration",
            (("inertia", "kg m^2"),),
            (j, k),
            _inert(j, k, sign),
            variant=variant,
        )


def _rubbing(j: int, k: int, sign: float, width: float) -> Columns:
    def columns(m: Moment) -> Array:
        speed = m.signals.dq[:, j] + sign * m.signals.dq[:, k]
        both = np.column_stack([np.tanh(speed / width), speed])
        return np.stack([both, sign * both], axis=1)

    return columns


def _inert(j: int, k: int, sign: float) -> Columns:
    def columns(m: Moment) -> Array:
        acceleration = m.signals.ddq[:, j] + sign * m.signals.ddq[:, k]
        return np.stack([acceleration, sign * acceleration], axis=1)[:, :, None]

    return columns
