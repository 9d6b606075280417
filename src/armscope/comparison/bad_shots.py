"""Rows that lie far off whatever is fitted: they count for little, as in a diagnosis, and are listed.

A few of them would hide a change: as noise they make all else unsure, and what is fitted bends towards them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol, Self

import numpy as np

from armscope.comparison.constants import COMPARING, SHARED
from armscope.comparison.penalised import HeldColumns
from armscope.core.types import Array, Indices
from armscope.core.words import rounded
from armscope.measurement import robust
from armscope.measurement.constants import WEIGHTS
from armscope.recordings import Recordings


class Weighed(Protocol):
    """Recordings whose rows count by weights: `armscope.comparison.shared_model`."""

    group: Indices  # (3N,) number of the recording that each is of
    weight: Array  # (3N,) by which each counts; ``robust``: without what whole recordings count by
    robust: Array

    def alone(self, number: int) -> Self:
        """One recording."""

    def trust(self, weights: Array) -> None:
        """Rows count by (3N,)."""

    def weighed_anew(self, weights: Array) -> Self:
        """The same by (3N,)."""

    def base(self, taken: tuple[()]) -> HeldColumns:
        """By what it is fitted."""

    def left(self, base: HeldColumns) -> tuple[float, float]:
        """Variance, and how many numbers are free."""

    def left_by(self, base: HeldColumns) -> Array:
        """(3N,) mm."""


@dataclass(frozen=True)
class BadShot:
    """A row that counts for little."""

    recording: str
    run: str
    id: str
    residual_mm: float  # how far it lies from what the rest of its recording says

    def __str__(self) -> str:
        run = f", {self.run}" if self.run else ""
        return f'{self.id} of "{self.recording}"{run} ({rounded(self.residual_mm)} mm off)'


def weigh_rows(model: Weighed) -> None:
    """Rows count by how far each lies from what the others of its recording say, so that no change counts.
    ``model``: what recordings share; one with a recording too short to be fitted alone stays as it is."""
    sets = range(model.group[-1] + 1)
    model.trust(np.ones(len(model.group)))
    alone = [model.alone(number) for number in sets]
    if min(each.left(each.base(()))[1] for each in alone) < SHARED.free_alone:
        return
    model.trust(np.concatenate([_without_the_farthest(each) for each in alone]))
    for _ in range(SHARED.row_weighings):
        off = [from_the_others(model.alone(number))[1] for number in sets]
        weights = np.concatenate([robust.quartic_weights(each, np.ones(len(each)), 0.0) for each in off])
        change = np.abs(weights - model.robust[::3] ** 2).max()
        model.trust(np.repeat(np.sqrt(weights), 3))
        if change < SHARED.same_weight:
            break


def _without_the_farthest(alone: Weighed) -> Array:
    """(3N,) weights to start from: the farthest rows are left out one by one, as two that bend the fit hide each other.

    As many as leave the last of them far beyond the noise of the rest (Rosner 1983).
    """
    rows = len(alone.group) // 3
    weight, out, far = np.ones(rows), [], 0
    distance = np.linalg.norm(from_the_others(alone)[1], axis=1)
    for number in range(1, int(np.ceil(SHARED.most_bad * rows)) + 1):
        worst = int(np.argmax(np.where(weight < 1, 0.0, distance)))
        size = distance[worst]
        out.append(worst)
        weight[worst] = SHARED.left_out
        alone = alone.weighed_anew(np.repeat(np.sqrt(weight), 3))
        variance, _ = alone.left(alone.base(()))
        if size > WEIGHTS.tuning_constant * np.sqrt(variance * rows / (rows - number)):
            far = number
        distance = np.linalg.norm(from_the_others(alone)[1], axis=1)
    start = np.ones(rows)
    start[out[:far]] = SHARED.left_out
    return np.repeat(np.sqrt(start), 3)


def from_the_others(alone: Weighed) -> tuple[Array, Array]:
    """How far each row lies from what all others say of it: in a fit that it takes part in, it draws that to itself.

    Of n rows fitted beside their penalties, without row i, e / (1 - h) is left of it, of variance 1 + (h / w) / (1 - h)
    (deletion residuals; Cook and Weisberg 1982, 2.2), in blocks of three.

    Returns:
        (N, 3) mm, and (N, 3) in units in which a row of full weight has the noise's variance.
    """
    base = alone.base(())
    left, unit = alone.left_by(base).reshape(-1, 3, 1), np.eye(3)
    parts = base.half.T.reshape(len(left), 3, -1)
    leverage = parts @ parts.transpose(0, 2, 1)
    without = unit - leverage + SHARED.unseen * unit  # a row that alone tells something is fitted exactly
    off = np.linalg.solve(without, left)
    spread = unit + np.linalg.solve(without, leverage) / alone.weight[::3, None, None] ** 2
    half = np.linalg.cholesky((spread + spread.transpose(0, 2, 1)) / 2)
    return np.asarray(off[:, :, 0]), np.asarray(np.linalg.solve(half, off)[:, :, 0])


def bad_shots(model: Weighed, table: Recordings, names: Sequence[str]) -> tuple[BadShot, ...]:
    """The rows that count for little, the farthest first.

    Args:
        model: of the recordings.
        table: all their rows, whose runs are "recording: run".
        names: of the recordings.

    Returns:
        Those of less than half the weight, as in a diagnosis.
    """
    weight, group = model.robust[::3] ** 2, model.group[::3]
    found = []
    for number, name in enumerate(names):
        rows = np.flatnonzero(group == number)
        bad = weight[rows] < WEIGHTS.inlier_weight
        if not bad.any():
            continue
        distance = np.linalg.norm(from_the_others(model.alone(number))[0], axis=1)
        found += [
            BadShot(name, str(table.run[row]).removeprefix(f"{name}: "), str(table.id[row]), float(size))
            for row, size in zip(rows[bad], distance[bad], strict=True)
        ]
    return tuple(sorted(found, key=lambda each: -each.residual_mm))


def told_of_shots(found: Sequence[BadShot], most: int = COMPARING.named_shots) -> str:
    """In words; "" where there is none."""
    if not found:
        return ""
    more = f", ... ({len(found)} in all: comparison.json)" if len(found) > most else ""
    return f"rows that look like bad shots, and count for little: {', '.join(map(str, found[:most]))}{more}"
