"""What follows the order of rows, carried on: a pose of now finds the arm as the last row of its run left it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from armscope.physics.effect import Direction, Driver, Part, Product, Term
from armscope.physics.model import FittedModel
from armscope.physics.scene import Scene
from armscope.recordings import Recordings

NOW = "now in run"
OF_ROWS = frozenset({"rows", "after pause", "rows in run", "slow wave of rows"})
"""Drivers that are zero where a row's number is not known. What jumped at a row has jumped by now, as it stands."""


def carried_on(model: FittedModel, recordings: Recordings) -> FittedModel:
    """A model whose drifts and wanders in the order of rows stay, after their run, as its last row found them.

    The held-out rows of a table stand between rows that tell how far things had moved, and so does what is promised of
    other poses. A model without that is of no moment of the recordings: it misses by what was allowed for and dropped.

    Args:
        model: fitted to the recordings.
        recordings: its rows.

    Returns:
        The model; at numbered rows it predicts what it did.
    """
    runs = {str(run): np.flatnonzero(recordings.run == run) for run in np.unique(recordings.run)}
    last = [rows[np.argmax(recordings.number[rows])] for rows in runs.values()]
    scene = model.scene(recordings.rows(np.array(last)))

    def on(part: Part) -> Part:
        terms = tuple(_carried(term, scene, list(runs)) for term in part.placed.terms)
        return Part(replace(part.placed, terms=terms), part.values)

    return replace(model, parts=tuple(map(on, model.parts)), background=tuple(map(on, model.background)))


def _carried(term: Term, scene: Scene, runs: list[str]) -> Term:
    stays: dict[tuple[Direction, str], float] = {}
    for product in term.products:
        if product.driver.kind in OF_ROWS:
            for run, reached in zip(runs, scene.driver(product.driver), strict=True):
                key = product.direction, run
                stays[key] = stays.get(key, 0.0) + product.factor * float(reached)
    now = (Product(direction, Driver(NOW, (run,)), factor) for (direction, run), factor in stays.items() if factor)
    return replace(term, products=(*term.products, *now)) if stays else term
