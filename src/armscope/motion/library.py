"""The library placed on an arm: every cause at every joint or link where the table can show it."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator

import numpy as np
from scipy.interpolate import BSpline

from armscope.core.types import Array
from armscope.motion import causes
from armscope.motion.causes import Columns, Moment, PlacedCause, Seen, coulomb_width
from armscope.motion.constants import LIBRARY


def place(seen: Seen) -> list[PlacedCause]:
    """Every cause that the table can show, at every place."""
    moving = [int(j) for j in np.flatnonzero(seen.moving)]
    placed = [cause for joint in moving for cause in _background(seen, joint)]
    placed += [cause for joint in moving for cause in _at_joint(seen, joint)]
    placed += [cause for one, other in itertools.pairwise(moving) for cause in _coupled(seen, one, other)]
    return [*placed, *_masses(seen)]


def _own(joint: int, column: Callable[[Moment], Array]) -> Columns:
    """Columns of one joint's own torque from (N,) or (N, c)."""

    def columns(moment: Moment) -> Array:
        values = column(moment)
        return values[:, None, None] if values.ndim == 1 else values[:, None, :]

    return columns


def _background(seen: Seen, j: int) -> Iterator[PlacedCause]:
    """The joint's offset, and what of its friction and rotor robot.yaml states: departures from that are causes."""
    torque, unit = seen.torque(j), seen.unit(j)
    units = (torque, torque, f"{torque} s/{unit}", "kg" if seen.arm.sliding[j] else "kg m^2")
    names = ("offset", "coulomb", "viscous", "inertia")
    for number, cause in enumerate(causes.BACKGROUND):
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
        cause: causes.Cause,
        driver: str,
        parameters: tuple[tuple[str, str], ...],
        column: Callable[[Moment], Array],
        **more: object,
    ) -> PlacedCause:
        return PlacedCause(cause, place, driver, parameters, (j,), _own(j, column), **more)  # type: ignore[arg-type]

    def speed(m: Moment) -> Array:
        return m.signals.dq[:, j]

    def side(m: Moment) -> Array:
        return np.asarray(np.tanh(speed(m) / width))

    both_ways = seen.dq[j, 0] < -LIBRARY.slow * width and seen.dq[j, 1] > LIBRARY.slow * width
    if both_ways:
        yield at(
            causes.ASYMMETRY, "direction", (("viscous_difference", f"{torque} s/{unit}"),), lambda m: np.abs(speed(m))
        )
        fastest = float(np.abs(seen.dq[j]).max())
        widths = np.geomspace(LIBRARY.slow * width, max(fastest / 2, 2 * LIBRARY.slow * width), LIBRARY.stribeck_widths)
        for v in widths:
            yield at(
                causes.STRIBECK,
                "speed",
                (("stribeck", torque),),
                _stribeck(side, speed, float(v)),
                variant=f"{v:.3g}",
                multiplicity=len(widths),
                scanned=(("speed", f"{unit}/s", float(v)),),
            )
        yield at(causes.LOAD_FRICTION, "load", (("per_load", ""),), lambda m: np.abs(m.rigid[:, j]) * side(m))
        yield at(
            causes.VISCOUS_CURVE,
            "speed",
            (("square", f"{torque} s^2/{unit}^2"), ("cube", f"{torque} s^3/{unit}^3")),
            lambda m: np.column_stack([speed(m) * np.abs(speed(m)), speed(m) ** 3]),
        )
        if seen.temperature is not None and np.ptp(seen.temperature[j]) > LIBRARY.least_warming_k:
            middle = float(np.mean(seen.temperature[j]))
            yield at(
                causes.TEMPERATURE_FRICTION,
                "temperature",
                (("per_kelvin", f"{torque} s/({unit} K)"),),
                lambda m: _warm(m, j, middle) * speed(m),
                variant="viscous",
            )
            yield at(
                causes.TEMPERATURE_FRICTION,
                "temperature",
                (("dry_per_kelvin", f"{torque}/K"),),
                lambda m: _warm(m, j, middle) * side(m),
                variant="dry",
            )
            yield at(
                causes.CURVE,
                "temperature",
                _knots(LIBRARY.knots_of_others, torque),
                _curve(lambda m: _warm(m, j, 0.0), seen.temperature[j], LIBRARY.knots_of_others),
                variant="temperature",
                is_curve=True,
            )
    yield at(causes.GAIN, "torque", (("gain", ""),), lambda m: m.predicted[:, j])
    yield at(causes.DELAY, "torque", (("delay", "s"),), lambda m: -np.gradient(m.predicted[:, j], 1 / m.rate))
    middle_q = float(np.mean(seen.q[j]))
    yield at(
        causes.BALANCER, "joint angle", (("stiffness", f"{torque}/{unit}"),), lambda m: m.signals.q[:, j] - middle_q
    )
    if not seen.arm.sliding[j]:
        yield at(
            causes.BALANCER, "joint angle", (("sine", torque), ("cosine", torque)), _wave(j, 1), variant="counterweight"
        )
        span = float(np.ptp(seen.q[j]))
        counts = [n for n in LIBRARY.ripple_counts if n * span > 2 * np.pi * LIBRARY.least_waves]
        for n in counts:
            yield at(
                causes.RIPPLE,
                "joint angle",
                (("sine", torque), ("cosine", torque)),
                _wave(j, n),
                variant=str(n),
                multiplicity=len(counts),
                scanned=(("per_turn", "", float(n)),),
            )
    yield at(
        causes.CABLE,
        "joint angle",
        _knots(LIBRARY.knots_of_position, torque),
        _curve(lambda m: m.signals.q[:, j], seen.q[j], LIBRARY.knots_of_position),
        is_curve=True,
    )
    ranges: tuple[tuple[str, Callable[[Moment], Array], Array], ...] = (
        ("speed", speed, seen.dq[j]),
        ("load", lambda m: m.rigid[:, j], np.array([-1.0, 1.0]) * seen.load[j]),
        ("time", lambda m: m.signals.time, seen.time),
    )
    for driver, of, limits in ranges:
        if np.ptp(limits) > 0:
            yield at(
                causes.CURVE,
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
            causes.COUPLED_FRICTION,
            place,
            "the neighbour's speed",
            rubbing,
            (j, k),
            _rubbing(j, k, sign, float(min(width[j], width[k]))),
            variant=variant,
        )
        yield PlacedCause(
            causes.COUPLED_INERTIA,
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


def _masses(seen: Seen) -> Iterator[PlacedCause]:
    arm, every = seen.arm, tuple(range(seen.arm.n_motors))
    identity = np.eye(len(arm.inertial))
    for link in range(arm.n_links):
        own, mass, place = slice(10 * link, 10 * link + 10), arm.inertial[10 * link], f"link {link + 1}"
        if mass > 0:
            heavier = np.zeros((len(arm.inertial), 1))
            heavier[own, 0] = arm.inertial[own] / mass
            yield PlacedCause(
                causes.LINK_MASS, place, "gravity and acceleration", (("mass", "kg"),), every, inertial=heavier
            )
        if arm.n_links > 1:
            moments = tuple((f"m{axis}", "kg m") for axis in "xyz")
            yield PlacedCause(
                causes.LINK_CENTRE,
                place,
                "gravity and acceleration",
                moments,
                every,
                inertial=identity[:, 10 * link + 1 : 10 * link + 4],
            )
            names = tuple((name, "kg m^2") for name in ("Ixx", "Ixy", "Iyy", "Ixz", "Iyz", "Izz"))
            yield PlacedCause(
                causes.LINK_INERTIA,
                place,
                "acceleration",
                names,
                every,
                inertial=identity[:, 10 * link + 4 : 10 * link + 10],
                variant="all six",
            )
            round_ = identity[:, [10 * link + 4, 10 * link + 6, 10 * link + 9]].sum(axis=1, keepdims=True)
            yield PlacedCause(
                causes.LINK_INERTIA, place, "acceleration", (("inertia", "kg m^2"),), every, inertial=round_
            )
    if arm.n_links > 1:
        yield from _payloads(seen, identity[:, -10:-6])
        yield from _gravity(seen, every)


def _payloads(seen: Seen, columns: Array) -> Iterator[PlacedCause]:
    """Mass at the tool point, or anywhere on the last link: in all runs, and in each run by itself."""
    anywhere = (("mass", "kg"), *((f"m{axis}", "kg m") for axis in "xyz"))
    every, point = tuple(range(seen.arm.n_motors)), seen.arm.point_load()
    variants: list[tuple[str, ...]] = [()]
    if len(seen.runs) > 1:
        variants += [(run,) for run in seen.runs]
    for runs in variants:
        name = runs[0] if runs else ""
        yield PlacedCause(
            causes.PAYLOAD,
            "payload",
            "load",
            (("mass", "kg"),),
            every,
            inertial=point[:, None],
            runs=runs,
            variant=f"{name} at the tool point".strip(),
            multiplicity=len(variants),
        )
        yield PlacedCause(
            causes.PAYLOAD,
            "payload",
            "load",
            anywhere,
            every,
            inertial=columns,
            runs=runs,
            variant=f"{name} anywhere".strip(),
            multiplicity=len(variants),
        )
    for name, inertial in seen.arm.attached:
        yield PlacedCause(causes.BODY, name, "load", (("times", ""),), every, inertial=inertial[:, None])


def _gravity(seen: Seen, every: tuple[int, ...]) -> Iterator[PlacedCause]:
    down = seen.arm.model.gravity.linear
    if np.linalg.norm(down) == 0:
        return
    level = np.linalg.svd(down[None] / np.linalg.norm(down))[2][1:]  # two axes across gravity
    if abs(down[2]) == np.linalg.norm(down):
        level = np.eye(3)[:2]
    names = tuple((axis, "rad") for axis in "xy")
    leans = -np.cross(level, down)  # gravity in axes that are turned about each

    def columns(m: Moment) -> Array:
        assert m.gravity is not None
        return np.asarray(m.gravity @ leans.T)

    yield PlacedCause(causes.GRAVITY, "base", "load", names, every, columns)
