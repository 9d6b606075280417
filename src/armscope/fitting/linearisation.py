"""The linear problem: every column of the library at the current model, boiled down to a Gram matrix.

Columns live only chunk by chunk; what stays is X'WX, X'Wy and y'Wy per block of rows. Selection, resampling and
cross-validation work on sums of blocks, so their cost does not depend on the number of rows.
Lengths are mm here: y and the columns are displacements of the tool in base axes, mm per SI unit of a term.
"""

from __future__ import annotations

import functools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array, Indices
from armscope.fitting.design_matrix import Arrangement, arranged, stacked
from armscope.measurement.row_weights import Missed, RowWeights
from armscope.physics.effect import Placed, Term, clash
from armscope.physics.lens import Lens
from armscope.physics.model import FittedModel
from armscope.physics.scene import Posture, Scene
from armscope.recordings import Recordings

CHUNK_ROWS = 1500
KEPT_ROWS = 15_000
"""Drivers of tables up to this long are kept between passes: at most some 150 MB."""
LEAST_SEEN = 0.02
"""A column of which frames absorb more than all but this share is scaled as if this share were left."""


@dataclass(frozen=True, eq=False)
class Pool:
    """All distinct terms that take part, and where each effect's terms stand among them.

    Attributes:
        terms: the columns, in order.
        frames: columns of the free frames.
        background: columns of each family's background, in the order of `armscope.physics.backgrounds.FAMILIES`.
        background_shape: relative size that each of these columns is expected to have.
        candidates: effects that compete.
        columns: columns of each candidate.
    """

    terms: tuple[Term, ...]
    frames: Indices
    background: tuple[Indices, ...]
    background_shape: tuple[Array, ...]
    candidates: tuple[Placed, ...]
    columns: tuple[Indices, ...]

    @functools.cached_property
    def clashes(self) -> tuple[frozenset[int], ...]:
        """For each candidate, those that can't stand beside it: other forms of it, and curves that contain it."""
        places: dict[str, list[int]] = {}
        for number, placed in enumerate(self.candidates):
            places.setdefault(placed.location, []).append(number)
        return tuple(
            frozenset(
                other for other in places[placed.location] if other != number and clash(placed, self.candidates[other])
            )
            for number, placed in enumerate(self.candidates)
        )

    @functools.cached_property
    def special_cases(self) -> tuple[tuple[frozenset[int], int], ...]:
        """For every free curve, the candidates that it contains, and how many of them may well stand side by side.

        What follows a joint's own angle is one, as a rule; an offset and a compliance are a common pair.
        """
        return tuple(
            (
                frozenset(n for n in self.clashes[number] if self.candidates[n].reading != "curve"),
                1 if placed.variant == "angle" else 2,
            )
            for number, placed in enumerate(self.candidates)
            if placed.reading == "curve" and not placed.fine
        )

    def crowding(self, candidates: frozenset[int]) -> int:
        """By how many effects some curve's special cases at one place exceed what is common."""
        return max((len(special & candidates) - common for special, common in self.special_cases), default=0)

    @functools.cached_property
    def resting(self) -> dict[int, frozenset[int]]:
        """Candidates that do nothing by themselves, and those that each of them can rest on."""
        return {
            number: frozenset(
                n
                for n, other in enumerate(self.candidates)
                if other.family == placed.effect.rests_on and not other.effect.rests_on
            )
            for number, placed in enumerate(self.candidates)
            if placed.effect.rests_on
        }

    @functools.cached_property
    def along(self) -> NDArray[np.bool_]:
        """Whether each candidate has one value that can't be negative."""
        return np.array([placed.effect.along and len(placed.terms) == 1 for placed in self.candidates], dtype=np.bool_)

    def stands(self, candidates: frozenset[int]) -> bool:
        """Whether every one of some candidates has what it rests on."""
        return all(candidates & needed for number, needed in self.resting.items() if number in candidates)

    @functools.cached_property
    def arrangement(self) -> Arrangement:
        """The columns sorted by how they are best multiplied."""
        return arranged(self.terms)

    def of(self, placed: Placed) -> Indices:
        """Columns of an effect whose terms are all in the pool."""
        return np.array([self.index[term] for term in placed.terms])

    @functools.cached_property
    def index(self) -> dict[Term, int]:
        """Where each term stands among the columns."""
        return {term: number for number, term in enumerate(self.terms)}


def pool(frames: Sequence[Placed], backgrounds: Sequence[Sequence[Placed]], candidates: Sequence[Placed]) -> Pool:
    """Gather the terms of all effects, each once."""
    index: dict[Term, int] = {}

    def add(placed: Placed) -> Indices:
        return np.array([index.setdefault(term, len(index)) for term in placed.terms], dtype=np.intp)

    frame_columns = np.concatenate([add(p) for p in frames])
    shapes = [{int(n): s for p in family for n, s in zip(add(p), p.shape, strict=True)} for family in backgrounds]
    columns = tuple(add(p) for p in candidates)
    return Pool(
        tuple(index),
        frame_columns,
        tuple(np.array(sorted(family), dtype=np.intp) for family in shapes),
        tuple(np.array([family[column] for column in sorted(family)], dtype=np.float64) for family in shapes),
        tuple(candidates),
        columns,
    )


@dataclass(frozen=True, eq=False)
class Gram:
    """Sums over rows: G = X'WX (p, p), b = X'Wy (p,), yy = y'Wy, n = number of weighted residuals; mm."""

    G: Array
    b: Array
    yy: float
    n: float

    def __add__(self, other: Gram) -> Gram:
        return Gram(self.G + other.G, self.b + other.b, self.yy + other.yy, self.n + other.n)

    def __sub__(self, other: Gram) -> Gram:
        return Gram(self.G - other.G, self.b - other.b, self.yy - other.yy, self.n - other.n)

    def scaled(self, scale: Array) -> Gram:
        """With column k divided by scale[k]."""
        return Gram(self.G / np.outer(scale, scale), self.b / scale, self.yy, self.n)

    def rss(self, coefficients: Array) -> float:
        """Residual sum of squares with these coefficients of all columns."""
        return float(self.yy - 2 * self.b @ coefficients + coefficients @ self.G @ coefficients)


@dataclass(eq=False)
class Kept:
    """What is kept of a table between passes: the order of its rows, and chunk by chunk what was computed last.

    Attributes:
        order: (N,) of the rows.
        scenes: (rows, scene) of each chunk, once they were computed.
        model: whose postures are kept.
        postures: how that model stands at each chunk.
    """

    order: Indices
    scenes: list[tuple[Indices, Scene]] = field(default_factory=list)
    model: FittedModel | None = None
    postures: list[Posture] = field(default_factory=list)


_KEPT: WeakKeyDictionary[Recordings, Kept] = WeakKeyDictionary()


def keep_drivers(recordings: Recordings, order: Indices) -> Recordings:
    """A copy of a table; what drives the effects on its rows is computed once, unless it is long.

    Args:
        order: (N,) of the rows in which chunks take them: rows of one block side by side.
    """
    table = replace(recordings)
    if len(table) <= KEPT_ROWS:
        _KEPT[table] = Kept(order)
    return table


def chunks(
    model: FittedModel, recordings: Recordings, order: Indices | None = None
) -> Iterator[tuple[Indices, Posture]]:
    """(rows, posture) of the model, chunk by chunk; in an order of rows, where one is given."""
    kept = _KEPT.get(recordings)
    if kept is None:
        order = np.arange(len(recordings)) if order is None else order
        yield from ((rows, model.posture(scene)) for rows, scene in _scenes(model, recordings, order))
        return
    kept.scenes = kept.scenes or list(_scenes(model, recordings, kept.order))
    if kept.model is not model:
        kept.postures = [model.posture(scene) for _, scene in kept.scenes]
        kept.model = model
    yield from ((rows, posture) for (rows, _), posture in zip(kept.scenes, kept.postures, strict=True))


def _scenes(model: FittedModel, recordings: Recordings, order: Indices) -> Iterator[tuple[Indices, Scene]]:
    for start in range(0, len(recordings), CHUNK_ROWS):
        rows = order[start : start + CHUNK_ROWS]
        yield rows, model.scene(recordings.rows(rows))


def residuals(model: FittedModel, recordings: Recordings) -> Array:
    """(N, 3) measured minus modelled tool points, base axes, mm."""
    left = np.empty((len(recordings), 3))
    for rows, posture in chunks(model, recordings):
        left[rows] = _shift(model, posture)
    return left


def missed(model: FittedModel, recordings: Recordings) -> Missed:
    """What a model leaves of every row: measured minus modelled tool points, and the turns between orientations."""
    if recordings.orientation is None:
        return Missed(residuals(model, recordings))
    shift, turn = np.empty((len(recordings), 3)), np.empty((len(recordings), 3))
    for rows, posture in chunks(model, recordings):
        shift[rows], turn[rows] = _shift(model, posture), model.missed_turns(posture)
    return Missed(shift, turn)


def _shift(model: FittedModel, posture: Posture) -> Array:
    """(n, 3) measured minus modelled tool points of a posture's rows, base axes, mm."""
    table = posture.scene.recordings
    return np.asarray((model.to_base(table.positions, table.run) - posture.tool) * 1e3)


def response(model: FittedModel, posture: Posture, lens: Lens) -> Array:
    """(n, 3 or 6) what a model leaves of a posture's rows, as a lens shows it: W^1/2 y, mm."""
    shift = _shift(model, posture)
    if lens.turn is None:
        return lens.through(shift, shift)
    return lens.through(shift, 1e3 * np.nan_to_num(model.missed_turns(posture)))


def accumulate(
    pool: Pool, model: FittedModel, recordings: Recordings, weights: RowWeights, blocks: Indices
) -> list[Gram]:
    """Gram matrices per block of rows.

    The response is the residual of the model plus what its own effects contribute linearly, so that every hypothesis
    starts from no effects while the linearisation stands where the model stands.

    Args:
        weights: of the rows.
        blocks: (N,) number of each row's block, from 0.
    """
    arrangement = pool.arrangement
    current = pool_values(pool, model)[arrangement.order]
    count, p = int(blocks.max()) + 1, len(pool.terms)
    G = [np.zeros((p, p)) for _ in range(count)]
    b, yy, n = np.zeros((count, p)), np.zeros(count), np.zeros(count)
    order = np.argsort(blocks, kind="stable") if count > 1 and recordings not in _KEPT else None
    for rows, posture in chunks(model, recordings, order):
        lens = weights.lens(rows)
        seen = stacked(posture.through(lens), arrangement)
        y = response(model, posture, lens).T + seen.combined(current)
        numbers, inside = weights.numbers(rows), blocks[rows]
        for block in np.unique(inside):
            at = _where(inside == block)
            part, yb = seen.at(at), y[:, at]
            part.add_products(G[block])
            b[block] += part.onto(yb)
            yy[block] += np.vdot(yb, yb)
            n[block] += numbers[at].sum()
    back = arrangement.back
    # one after the other: each has millions of numbers
    return [Gram(arrangement.whole(G.pop(0)), b[k][back], float(yy[k]), float(n[k])) for k in range(count)]


def _where(inside: NDArray[np.bool_]) -> slice | Indices:
    """Where a mask holds: as a slice, if it holds in one stretch."""
    at = np.flatnonzero(inside)
    return slice(int(at[0]), int(at[-1]) + 1) if at[-1] - at[0] + 1 == len(at) else at


def pool_values(pool: Pool, model: FittedModel) -> Array:
    """(p,) the model's values of the pool's terms (frames count as zero: they are part of the linearisation point)."""
    values = np.zeros(len(pool.terms))
    for part in (*model.background, *model.parts):
        for term, value in zip(part.placed.terms, part.values, strict=True):
            values[pool.index[term]] += value
    return values


def total(blocks: Sequence[Gram]) -> Gram:
    """The sum of blocks."""
    whole = blocks[0]
    for block in blocks[1:]:
        whole = whole + block
    return whole


def scales(gram: Gram, frames: Indices) -> Array:
    """(p,) RMS per axis at the tool of each column beyond what the free frames absorb, mm per SI unit."""
    Gf = gram.G[np.ix_(frames, frames)]
    ridge = 1e-10 * np.diag(np.diag(Gf)) + 1e-300 * np.eye(len(frames))
    absorbed = np.sum(gram.G[frames] * np.linalg.solve(Gf + ridge, gram.G[frames]), axis=0)
    raw = np.diag(gram.G)
    seen = np.maximum(raw - absorbed, LEAST_SEEN**2 * raw)
    seen[frames] = raw[frames]
    return np.sqrt(np.maximum(seen / max(gram.n, 1.0), 1e-24))


def contribution(gram: Gram, frames: Indices, coefficients: Array) -> float:
    """RMS per axis at the tool, beyond the free frames, of a combination of columns (p,), mm."""
    Gc = gram.G @ coefficients
    Gf = gram.G[np.ix_(frames, frames)]
    absorbed = Gc[frames] @ np.linalg.lstsq(Gf, Gc[frames], rcond=1e-12)[0]
    left = float(coefficients @ Gc - absorbed)
    return float(np.sqrt(max(left, 0.0) / max(gram.n, 1.0)))
