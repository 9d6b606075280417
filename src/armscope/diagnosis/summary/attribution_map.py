"""Where: the share of the residual that each location x direction x driver explains on top of a model."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from armscope.core.location import Location
from armscope.core.sampling import spread_evenly
from armscope.diagnosis.summary.constants import TELLING
from armscope.fitting.block_sums import normal_equations_by_block
from armscope.fitting.column_blocks import ModelColumns, TermBlocks
from armscope.fitting.linearisation import LinearisedTable
from armscope.fitting.parameter_layout import ParameterLayout
from armscope.inference.linear_algebra import lower_cholesky, rss_reduction, solve_lower
from armscope.inference.normal_equations import steadied
from armscope.measurement.row_weights import RowWeights
from armscope.physics.effect import AXES, ONE, Direction, Driver, Term, motor, term
from armscope.physics.model import FittedModel
from armscope.physics.placing import varies
from armscope.physics.registry import effects
from armscope.recordings import Recordings
from armscope.verdict.diagnosis import TOGETHER, Atlas

DIRECTIONS = (*AXES, TOGETHER)
Cell = tuple[int, int, int]


GENERAL = {
    "constant": "one",
    "own angle": "angle",
    "once per turn": "1",
    "twice per turn": "2",
    "gravity load": "load",
    "side of approach": "approach",
    "speed": "speed",
    "temperature": "warmth",
    "time": "hours",
    "payload": "payload",
}
"""Columns that every joint and the base have, where the recordings hold what drives them, and their kind of driver."""


def atlas(layout: ParameterLayout, model: FittedModel, recordings: Recordings, weights: RowWeights) -> Atlas:
    """The atlas on top of the free frames and on top of the fitted model.

    Args:
        layout: of the fitted model.
        model: the fitted one.
        recordings: N rows.
        weights: of the rows.

    Returns:
        Shares of the mean square by location, direction and driver.
    """
    rows = spread_evenly(len(recordings), TELLING.atlas_rows)
    share = len(rows) / len(recordings)
    table, w = LinearisedTable(recordings.rows(rows), order=np.arange(len(rows))), weights.take(rows, share)
    # columns and response must stand at one and the same point and on the same rows, or what the frames absorb does not
    # cancel
    (of_rows,) = normal_equations_by_block(layout, model, table, w, np.zeros(len(rows), dtype=np.intp))
    fitted = steadied(of_rows, layout.frames)
    drivers = _drivers(model, recordings)
    whole = _whole_effects(model, table.recordings)
    names = tuple(dict.fromkeys([*(name for name, _ in drivers), *(name for _, name, _ in whole)]))
    locations = _locations(model, whole)
    before = np.full((len(locations), len(DIRECTIONS), len(names)), np.nan)
    left = before.copy()
    total = fitted.least_rss(layout.frames)
    found = _cells(model, recordings, locations, drivers)
    found += [((locations.index(place), len(AXES), names.index(name)), terms) for place, name, terms in whole]
    everything = np.arange(len(layout.terms))
    sizes = sorted({len(terms) for _, terms in found})
    by_size = [[cell for cell in found if len(cell[1]) == size] for size in sizes]
    blocks = [TermBlocks.of([terms for _, terms in cells]) for cells in by_size]
    for cells, sums in zip(by_size, ModelColumns(layout, everything, model, table, w).sums(blocks), strict=True):
        for target, inside in ((before, layout.frames), (left, everything)):
            G = fitted.G[np.ix_(inside, inside)]
            factor = lower_cholesky(G, 1e-9 * np.diag(G) + 1e-12)
            beside = replace(sums, cross=sums.cross[:, inside])
            own, b = beside.conditioned(factor, solve_lower(factor, fitted.b[inside]))
            gain = rss_reduction(own, b, sums.diagonal)
            for (at, _), value in zip(cells, gain, strict=True):
                target[at] = value / max(total, 1e-30)
    return Atlas(locations, DIRECTIONS, names, np.clip(before, 0, 1), np.clip(left, 0, 1))


def _whole_effects(model: FittedModel, recordings: Recordings) -> list[tuple[str, str, tuple[Term, ...]]]:
    """(location, driver, terms) of the library's effects that are weighed as a whole.

    Those elsewhere than at a joint or the base, and those with a column of their own; what follows one driver at one
    place (a link that grows, and that bows, with temperature) together; the widest of an effect's variants.
    """
    at: dict[tuple[str, str], dict[str, tuple[Term, ...]]] = {}
    for effect in effects():
        for placed in effect.place(model.arm, recordings) if isinstance(effect.atlas, str) and effect.atlas else ():
            if effect.atlas not in GENERAL or Location.of(placed.location).kind not in ("base", "joint"):
                there = at.setdefault((placed.location, str(effect.atlas)), {})
                there[effect.name] = max(there.get(effect.name, ()), placed.terms, key=len)
    return [
        (place, name, tuple(each for terms in those.values() for each in terms)) for (place, name), those in at.items()
    ]


def _locations(model: FittedModel, whole: list[tuple[str, str, tuple[Term, ...]]]) -> tuple[str, ...]:
    """From the base outwards, each link after the joint before it (modified D-H rows: before the joint behind it)."""
    there = dict.fromkeys(location for location, _, _ in whole)
    order = ["link", "joint"] if model.arm.is_modified_dh else ["joint", "link"]
    along = ["base", *(f"{kind} {j}" for j in range(1, model.arm.n_joints + 1) for kind in order)]
    along = [place for place in along if Location.of(place).kind != "link" or place in there]
    return (*along, *(place for place in there if place not in along))


def _drivers(model: FittedModel, recordings: Recordings) -> list[tuple[str, str]]:
    """(name, kind) of the drivers that the recordings hold."""
    there = {
        "gravity load": model.arm.has_masses or recordings.torque is not None,
        "side of approach": recordings.approach is not None,
        "speed": recordings.speed is not None,
        "temperature": varies(recordings.temperature, 0.1),
        "time": varies(recordings.time, 1.0),
        "payload": varies(recordings.payload, 1e-6),
    }
    return [(name, kind) for name, kind in GENERAL.items() if there.get(name, True)]


def _cells(
    model: FittedModel,
    recordings: Recordings,
    locations: tuple[str, ...],
    drivers: list[tuple[str, str]],
) -> list[tuple[Cell, tuple[Term, ...]]]:
    """Cells of base and joints, direction by direction: where they stand in the atlas, and their terms."""
    cells = []
    for row, location in enumerate(locations):
        if Location.of(location).kind not in ("base", "joint"):
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
        number = Location.of(location).number
        if number <= model.arm.n_motors and model.arm.actuation[number - 1, number - 1] != 0:
            return motor(number)
    return Direction(location, axis)


def _driver(model: FittedModel, recordings: Recordings, location: str, axis: str, kind: str) -> tuple[Driver, ...]:
    """The driver(s) of a kind at one direction of a location; empty where there is none."""
    number = Location.of(location).number
    if kind == "one":
        return (ONE,)
    if kind in ("hours", "warmth", "payload"):
        return (Driver(kind, (0.0,)) if kind == "hours" else Driver(kind),)
    if kind == "load":
        return _load(model, location, axis, number)
    if number == 0:
        return ()
    own = "" if _direction(model, location, axis).axis == "turn" else "chain "
    if kind in ("1", "2"):
        return Driver(f"{own}cosine", (number, int(kind))), Driver(f"{own}sine", (number, int(kind)))
    if kind == "angle":
        return (Driver(f"{own}angle", (number,)),)
    moves = np.flatnonzero(model.arm.actuation[number - 1])
    return (Driver(kind, (int(moves[-1] if number - 1 not in moves else number - 1) + 1,)),)


def _load(model: FittedModel, location: str, axis: str, number: int) -> tuple[Driver, ...]:
    """The load in the direction that it pushes: force for shifts, moment for tilts, torque for turns about the axis."""
    if axis[0] == "t":
        return (Driver("force", (location, "xyz".index(axis[1]))),)
    if number and axis == "rz":
        moves = np.flatnonzero(model.arm.actuation[number - 1])
        return (Driver("torque", (int(number if number - 1 in moves else moves[-1] + 1),)),)
    return (Driver("moment", (location, "xyz".index(axis[1]))),)
