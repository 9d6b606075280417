"""Causes that are made of inertial parameters: links, payloads, bodies that are not there; and gravity's direction."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import scipy.linalg

from armscope.core.types import Array, Indices
from armscope.motion.constants import LIBRARY
from armscope.motion.library import catalogue
from armscope.motion.library.causes import Cause, PlacedCause, Seen
from armscope.motion.library.for_a_while import INERTIA, OF_A_LOAD, of_a_load
from armscope.motion.library.laws import Law
from armscope.robot.dynamics import MovingArm, leaning_gravity, moved_centre


def place_masses(seen: Seen) -> Iterator[PlacedCause]:
    """Every cause that is made of inertial parameters, and gravity's direction."""
    arm, identity = seen.arm, np.eye(len(seen.arm.inertial))
    for link in range(arm.n_links):
        own, mass, place = slice(10 * link, 10 * link + 10), arm.inertial[10 * link], f"link {link + 1}"
        if mass > 0:
            heavier = np.zeros((len(arm.inertial), 1))
            heavier[own, 0] = arm.inertial[own] / mass
            yield from _inertial(seen, catalogue.LINK_MASS, place, (("mass", "kg"),), heavier)
            alone = np.zeros_like(heavier)
            alone[own, 0] = at_its_centre(arm.inertial[own])
            if _says_more(seen, alone, heavier):
                form: dict[str, Any] = {"variant": catalogue.AT_ITS_CENTRE}
                yield from _inertial(seen, catalogue.LINK_MASS, place, (("mass", "kg"),), alone, **form)
        if arm.n_links > 1:
            first, second = identity[:, own] @ moved_centre(arm.inertial[own]), identity[:, 10 * link + 4 : own.stop]
            moments = tuple((f"m{axis}", "kg m") for axis in "xyz")
            if _says_more(seen, first, second):
                yield from _inertial(seen, catalogue.LINK_CENTRE, place, moments, first)
            if len(shown(seen, second)) > 1:
                yield from _inertial(seen, catalogue.LINK_INERTIA, place, INERTIA, second, variant="all six")
            alike = second[:, [0, 2, 5]].sum(axis=1, keepdims=True)
            yield from _inertial(seen, catalogue.LINK_INERTIA, place, (("inertia", "kg m^2"),), alike)
    if arm.n_links > 1:
        yield from _payloads(seen, of_a_load(arm, arm.point_load()[-10:-6]))
        yield from _gravity(seen, tuple(range(arm.n_motors)))


def at_its_centre(inertial: Array) -> Array:
    """(10,) per kg, of a body (10,) that is heavier at its centre of mass and has the inertia about it that is stated.

    Who corrects a mass alone, or mounts something small there, changes no more.
    """
    centre = inertial[1:4] / inertial[0]
    return np.concatenate([[1.0], centre, moved_centre(inertial)[4:] @ centre / 2])


def at_its_place(placed: PlacedCause, arm: MovingArm, values: Array) -> PlacedCause:
    """A link whose centre lies elsewhere, its inertia about its joint exact for the moments fitted.

    The slope leaves out their square, which a light link's motion shows: an inertia was named beside it.

    Args:
        placed: of `catalogue.LINK_CENTRE`.
        arm: the arm as stated.
        values: (c,) its moments, kg m.

    Returns:
        It, with other columns.
    """
    axes = ["xyz".index(name[1]) for name, _ in placed.parameters]
    link, by = int(placed.location.split()[1]) - 1, np.zeros(3)
    by[axes] = values
    own = slice(10 * link, 10 * link + 10)
    inertial = np.zeros((len(arm.inertial), len(axes)))
    inertial[own] = moved_centre(arm.inertial[own], by)[:, axes]
    return replace(placed, inertial=inertial)


def as_a_body(placed: PlacedCause, arm: MovingArm, values: Array, stated: float = 0.0) -> PlacedCause:
    """A load anywhere on the last link, with the inertia that a body of its mass has at its place.

    Args:
        placed: of `catalogue.PAYLOAD`, with its mass and moments.
        arm: the arm as stated.
        values: (4,) its mass, kg, and moments, kg m.
        stated: kg at the tool point, besides.

    Returns:
        It, with other columns; itself where what is carried has no mass, or where the motion tells no mass.
    """
    axes = [OF_A_LOAD.index(name) for name, _ in placed.parameters if name in OF_A_LOAD]
    if 0 not in axes or stated + values[0] <= 0 or placed.inertial is None:
        return placed
    own = placed.inertial[:, len(axes) :]
    return replace(placed, inertial=np.hstack([of_a_load(arm, values, stated)[:, axes], own]))


def has_its_own_inertia(placed: PlacedCause) -> bool:
    """Whether it is a load that is no point: all that the numbers of its link can be off by."""
    return placed.cause is catalogue.PAYLOAD and any(parameter in INERTIA for parameter in placed.parameters)


def shown(seen: Seen, inertial: Array) -> Indices:
    """Which columns of inertial parameters the motion can tell, by pivoted QR.

    Args:
        seen: of the table.
        inertial: (10 n, c) inertial parameters per unit of each column.

    Returns:
        Their numbers, ascending.
    """
    torque = seen.regressor @ inertial
    size = np.sqrt(np.mean(torque**2, axis=0))
    weighs = (inertial != 0).reshape(-1, 10, inertial.shape[1]).any(axis=1).T @ seen.arm.inertial[::10]
    usual = np.maximum(LIBRARY.heavy_link * weighs, 1.0)
    at_all = np.flatnonzero(
        usual * size > LIBRARY.least_shown * np.sqrt(np.mean((seen.regressor @ seen.arm.inertial) ** 2))
    )
    if not len(at_all):
        return at_all
    _, R, order = scipy.linalg.qr(torque[:, at_all] / size[at_all], mode="economic", pivoting=True)
    diagonal = np.abs(np.diag(R))
    told = np.sort(at_all[order[: len(diagonal)][diagonal > LIBRARY.redundant_columns * diagonal[0]]])
    return np.asarray(told)


def _says_more(seen: Seen, inertial: Array, than: Array) -> bool:
    """Whether what the motion shows of some inertial parameters is not all said by others.

    Of a first link that stands upright a centre that lies elsewhere is one inertia, and no motion tells it from that.
    """
    torque, said = seen.regressor @ inertial[:, shown(seen, inertial)], seen.regressor @ than[:, shown(seen, than)]
    left = torque - said @ np.linalg.lstsq(said, torque, rcond=None)[0]
    return bool(np.any(np.linalg.norm(left, axis=0) > LIBRARY.redundant_columns * np.linalg.norm(torque, axis=0)))


def _inertial(
    seen: Seen,
    cause: Cause,
    place: str,
    names: tuple[tuple[str, str], ...],
    inertial: Array,
    likely: Array | None = None,
    **more: Any,
) -> Iterator[PlacedCause]:
    """A cause made of inertial parameters, with those of its columns that the motion can tell."""
    told = shown(seen, inertial)
    if not len(told):
        return
    if likely is not None:
        torque = np.sqrt(np.mean((seen.regressor @ inertial[:, told]) ** 2, axis=0)) * likely[told]
        more["expected"] = tuple(map(float, torque / torque[0]))
    every = tuple(range(seen.arm.n_motors))
    driver = "acceleration" if cause is catalogue.LINK_INERTIA else "load"
    yield PlacedCause(cause, place, driver, tuple(names[k] for k in told), every, inertial=inertial[:, told], **more)


def _payloads(seen: Seen, columns: Array) -> Iterator[PlacedCause]:
    """Mass at the tool point, or anywhere on the last link: in all runs, and in each run by itself."""
    anywhere = (("mass", "kg"), *((f"m{axis}", "kg m") for axis in "xyz"))
    extended = np.hstack([columns, np.eye(len(columns))[:, -len(INERTIA) :]])
    likely = np.array([1.0, *[LIBRARY.wide_load_m] * 3, *[LIBRARY.wide_load_m**2] * len(INERTIA)])
    variants: list[tuple[str, ...]] = [()]
    if len(seen.runs) > 1:
        variants += [(run,) for run in seen.runs]
    for runs in variants:
        name = runs[0] if runs else ""
        more: dict[str, Any] = {"runs": runs, "multiplicity": len(variants)}
        point = seen.arm.point_load()[:, None]
        yield from _inertial(
            seen, catalogue.PAYLOAD, "payload", anywhere[:1], point, variant=f"{name} tool".strip(), **more
        )
        yield from _inertial(
            seen, catalogue.PAYLOAD, "payload", anywhere, columns, variant=f"{name} free".strip(), **more
        )
        names, form = (*anywhere, *INERTIA), f"{name} extended".strip()
        yield from _inertial(seen, catalogue.PAYLOAD, "payload", names, extended, likely, variant=form, **more)
    for body, inertial in seen.arm.attached:
        if inertial[::10].max() > LIBRARY.least_body * seen.arm.inertial[10 * int(inertial[::10].argmax())]:
            yield from _inertial(seen, catalogue.BODY, body, (("times", ""),), inertial[:, None])


def as_it_leans(placed: PlacedCause, arm: MovingArm, values: Array) -> PlacedCause:
    """A leaning gravity whose pull keeps its size: along the plumb line it loses what it gains across.

    A base that leans by 2 degrees takes 0.06 % off the pull downwards; without that, a link was told to be lighter.

    Args:
        placed: of `catalogue.GRAVITY`.
        arm: the arm as stated.
        values: (2,) rad, by which it leans.

    Returns:
        It, with columns that give the exact pull at these numbers.
    """
    down, straight = arm.model.gravity.linear, leaning_gravity(arm.model.gravity.linear)
    across = values @ straight
    size = float(np.linalg.norm(down))
    lost = size - np.sqrt(max(size**2 - float(across @ across), 0.0))
    square = float(values @ values)
    if square == 0 or not isinstance(placed.columns, Law):
        return placed
    exact = straight - np.outer(values / square, lost * down / size)
    return replace(placed, columns=replace(placed.columns, numbers=tuple(map(float, exact.ravel()))))


def _gravity(seen: Seen, every: tuple[int, ...]) -> Iterator[PlacedCause]:
    down = seen.arm.model.gravity.linear
    if np.linalg.norm(down) == 0:
        return
    names = tuple((axis, "rad") for axis in "xy")
    law = Law("leaning gravity", every, tuple(map(float, leaning_gravity(down).ravel())))
    yield PlacedCause(catalogue.GRAVITY, "base", "load", names, every, law)
