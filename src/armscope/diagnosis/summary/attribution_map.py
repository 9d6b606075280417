"""Where: the share of the residual that each location x direction x driver explains on top of a model."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cholesky, solve_triangular

from armscope.fitting.column_blocks import rss_reduction, schur_complement, weigh_blocks
from armscope.fitting.linearisation import normal_equations_by_block
from armscope.fitting.model_space import Pool
from armscope.inference.normal_equations import NormalEquations
from armscope.measurement.row_weights import RowWeights
from armscope.physics.effect import AXES, ONE, Direction, Driver, Term, motor, term
from armscope.physics.elastic import has_load
from armscope.physics.model import FittedModel
from armscope.physics.placing import varies
from armscope.physics.registry import EFFECTS
from armscope.recordings import Recordings
from armscope.verdict.schema import TOGETHER, Atlas

ATLAS_ROWS = 4000
DIRECTIONS = (*AXES, TOGETHER)
Cell = tuple[int, int, int]
WHOLE = {
    "link_geometry": "constant",
    "parallelogram_geometry": "constant",
    "instrument_scale": "constant",
    "link_bending": "gravity load",
    "payload_error": "gravity load",
    "thermal_expansion": "temperature",
}
"""Effects at links, linkage, instrument and payload: each is weighed as a whole, on the driver that it follows."""


def atlas(pool: Pool, model: FittedModel, recordings: Recordings, weights: RowWeights) -> Atlas:
    """The atlas on top of the free frames and on top of the fitted model.

    Args:
        pool: of the fitted model.
    """
    rows = np.unique(np.linspace(0, len(recordings) - 1, min(len(recordings), ATLAS_ROWS)).astype(np.intp))
    share = len(rows) / len(recordings)
    table, w = recordings.rows(rows), weights.take(rows, share)
    # columns and response must stand at one and the same point and on the same rows, or what the frames absorb does not
    # cancel
    fitted = normal_equations_by_block(pool, model, table, w, np.zeros(len(rows), dtype=np.intp))[0]
    drivers = _drivers(model, recordings)
    names = tuple(name for name, _ in drivers)
    whole = _whole_effects(model, recordings, names)
    locations = _locations(model, whole)
    before = np.full((len(locations), len(DIRECTIONS), len(names)), np.nan)
    left = before.copy()
    total = _left_after(fitted, pool.frames)
    found = _cells(model, recordings, locations, drivers)
    found += [((locations.index(place), len(AXES), names.index(name)), terms) for place, name, terms in whole]
    for size in sorted({len(terms) for _, terms in found}):
        cells = [cell for cell in found if len(cell[1]) == size]
        for target, inside in ((before, pool.frames), (left, np.arange(len(pool.terms)))):
            sums = weigh_blocks([terms for _, terms in cells], pool, inside, model, table, w)
            G = fitted.G[np.ix_(inside, inside)]
            ridge = 1e-9 * np.diag(G) + 1e-12
            factor = cholesky(G + np.diag(ridge), lower=True)
            whitened_rhs = solve_triangular(factor, fitted.b[inside], lower=True)
            gain = rss_reduction(*schur_complement(sums, factor, whitened_rhs), np.einsum("mcc->mc", sums.own))
            for (at, _), value in zip(cells, gain, strict=True):
                target[at] = value / max(total, 1e-30)
    return Atlas(locations, DIRECTIONS, names, np.clip(before, 0, 1), np.clip(left, 0, 1))


def _whole_effects(
    model: FittedModel, recordings: Recordings, drivers: tuple[str, ...]
) -> list[tuple[str, str, tuple[Term, ...]]]:
    """(location, driver, terms) of the library's effects that act elsewhere than at a joint or the base."""
    return [
        (placed.location, WHOLE[effect.name], placed.terms)
        for effect in EFFECTS
        if WHOLE.get(effect.name) in drivers
        for placed in effect.place(model.arm, recordings)
    ]


def _locations(model: FittedModel, whole: list[tuple[str, str, tuple[Term, ...]]]) -> tuple[str, ...]:
    """From the base outwards, each link after the joint before it (modified D-H rows: before the joint behind it)."""
    there = dict.fromkeys(location for location, _, _ in whole)
    order = ["link", "joint"] if model.arm.is_modified_dh else ["joint", "link"]
    along = ["base", *(f"{kind} {j}" for j in range(1, model.arm.n_joints + 1) for kind in order)]
    along = [place for place in along if not place.startswith("link") or place in there]
    return (*along, *(place for place in there if place not in along))


def _left_after(gram: NormalEquations, inside: NDArray[np.intp]) -> float:
    G = gram.G[np.ix_(inside, inside)]
    return float(gram.yy - gram.b[inside] @ np.linalg.lstsq(G, gram.b[inside], rcond=1e-12)[0])


def _drivers(model: FittedModel, recordings: Recordings) -> list[tuple[str, str]]:
    """(name, kind) of the drivers that the recordings hold."""
    drivers = [("constant", "one"), ("own angle", "angle"), ("once per turn", "1"), ("twice per turn", "2")]
    if has_load(model.arm) or recordings.torque is not None:
        drivers.append(("gravity load", "load"))
    if recordings.approach is not None:
        drivers.append(("side of approach", "approach"))
    if recordings.speed is not None:
        drivers.append(("speed", "speed"))
    if varies(recordings.temperature, 0.1):
        drivers.append(("temperature", "warmth"))
    if varies(recordings.time, 1.0):
        drivers.append(("time", "hours"))
    if varies(recordings.payload, 1e-6):
        drivers.append(("payload", "payload"))
    return drivers


def _cells(
    model: FittedModel,
    recordings: Recordings,
    locations: tuple[str, ...],
    drivers: list[tuple[str, str]],
) -> list[tuple[Cell, tuple[Term, ...]]]:
    """Cells of base and joints, direction by direction: where they stand in the atlas, and their terms."""
    cells = []
    for row, location in enumerate(locations):
        if location != "base" and not location.startswith("joint"):
            continue
        for column, axis in enumerate(AXES):
            for depth, (_, kind) in enumerate(drivers):
                chosen = _driver(model, recordings, location, axis, kind)
                if chosen:
                    direction = _direction(model, location, axis)
                    terms = tuple(term(f"{n}", "", (direction, d)) for n, d in enumerate(chosen))
                    cells.append(((row, column, depth), terms))
    return cells


def _direction(model: FittedModel, location: str, axis: str) -> Direction:
    """What turns about a joint's axis is its motor, which on a parallelogram arm turns another chain joint with it."""
    if axis == "rz" and location != "base":
        number = int(location.split()[1])
        if number <= model.arm.n_motors and model.arm.actuation[number - 1, number - 1] != 0:
            return motor(number)
    return Direction(location, axis)


def _driver(model: FittedModel, recordings: Recordings, location: str, axis: str, kind: str) -> tuple[Driver, ...]:
    """The driver(s) of a kind at one direction of a location; empty where there is none."""
    number = int(location.split()[1]) if location != "base" else 0
    if kind == "one":
        return (ONE,)
    if kind in ("hours", "warmth", "payload"):
        return (Driver(kind, (0.0,)) if kind == "hours" else Driver(kind),)
    if kind == "load":
        return _load(model, recordings, location, axis, number)
    if number == 0:
        return ()
    own = "" if _direction(model, location, axis).axis == "turn" else "chain "
    if kind in ("1", "2"):
        return Driver(f"{own}cosine", (number, int(kind))), Driver(f"{own}sine", (number, int(kind)))
    if kind == "angle":
        return (Driver(f"{own}angle", (number,)),)
    moves = np.flatnonzero(model.arm.actuation[number - 1])
    return (Driver(kind, (int(moves[-1] if number - 1 not in moves else number - 1) + 1,)),)


def _load(model: FittedModel, recordings: Recordings, location: str, axis: str, number: int) -> tuple[Driver, ...]:
    """The load in the direction that it pushes: force for shifts, moment for tilts, torque for turns about the axis."""
    if axis[0] == "t":
        return (Driver("force", (location, "xyz".index(axis[1]))),)
    if number and axis == "rz":
        moves = np.flatnonzero(model.arm.actuation[number - 1])
        return (Driver("torque", (int(number if number - 1 in moves else moves[-1] + 1),)),)
    return (Driver("moment", (location, "xyz".index(axis[1]))),)
