"""The linear problem: every column of the library at the current model, boiled down to a Gram matrix.

Columns live only chunk by chunk; what stays is X'WX, X'Wy and y'Wy per block of rows. Selection, resampling and
cross-validation work on sums of blocks, so their cost does not depend on the number of rows.
Lengths are mm here: y and the columns are displacements of the tool in base axes, mm per SI unit of a term.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array, Indices
from armscope.fitting.constants import STEPS
from armscope.fitting.design_matrix import structured_design
from armscope.fitting.parameter_layout import ParameterLayout
from armscope.inference.normal_equations import NormalEquations
from armscope.measurement.row_weights import Missed, RowWeights
from armscope.physics.lens import Lens
from armscope.physics.model import FittedModel
from armscope.physics.scene import Posture, Scene
from armscope.recordings import Recordings


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
    if len(table) <= STEPS.kept_rows:
        _KEPT[table] = Kept(order)
    return table


def chunks(
    model: FittedModel, recordings: Recordings, order: Indices | None = None
) -> Iterator[tuple[Indices, Posture]]:
    """(rows, posture) of the model, chunk by chunk; in an order of rows, where one is given.

    Args:
        model: the point of linearisation.
        recordings: N rows.
        order: (N,) of the rows; None: as they stand.

    Yields:
        Numbers of rows, and the arm's posture in them.
    """
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
    for start in range(0, len(recordings), STEPS.chunk_rows):
        rows = order[start : start + STEPS.chunk_rows]
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
    """(n, 3 or 6) what a model leaves of a posture's rows, as a lens shows it: W^1/2 y, mm.

    Args:
        model: whose residuals they are.
        posture: the arm's, in n rows.
        lens: how rows are whitened.

    Returns:
        (n, 3 or 6) mm.
    """
    shift = _shift(model, posture)
    if lens.turn is None:
        return lens.through(shift, shift)
    return lens.through(shift, 1e3 * np.nan_to_num(model.missed_turns(posture)))


def normal_equations_by_block(
    pool: ParameterLayout, model: FittedModel, recordings: Recordings, weights: RowWeights, blocks: Indices
) -> list[NormalEquations]:
    """Gram matrices per block of rows.

    The response is the residual of the model plus what its own effects contribute linearly, so that every hypothesis
    starts from no effects while the linearisation stands where the model stands.

    Args:
        pool: of the model's columns.
        model: the point of linearisation.
        recordings: N rows.
        weights: of the rows.
        blocks: (N,) number of each row's block, from 0.

    Returns:
        One per block, mm per SI unit.
    """
    column_order = pool.column_order
    current = current_parameters(pool, model)[column_order.order]
    count, p = int(blocks.max()) + 1, len(pool.terms)
    G = [np.zeros((p, p)) for _ in range(count)]
    b, yy, n = np.zeros((count, p)), np.zeros(count), np.zeros(count)
    order = np.argsort(blocks, kind="stable") if count > 1 and recordings not in _KEPT else None
    for rows, posture in chunks(model, recordings, order):
        lens = weights.lens(rows)
        seen = structured_design(posture.through(lens), column_order)
        y = response(model, posture, lens).T + seen.matvec(current)
        numbers, inside = weights.numbers(rows), blocks[rows]
        for block in np.unique(inside):
            at = _where(inside == block)
            part, yb = seen.at(at), y[:, at]
            part.add_products(G[block])
            b[block] += part.rmatvec(yb)
            yy[block] += np.vdot(yb, yb)
            n[block] += numbers[at].sum()
    back = column_order.back
    # one after the other: each has millions of numbers
    return [NormalEquations(column_order.whole(G.pop(0)), b[k][back], float(yy[k]), float(n[k])) for k in range(count)]


def _where(inside: NDArray[np.bool_]) -> slice | Indices:
    """Where a mask holds: as a slice, if it holds in one stretch."""
    at = np.flatnonzero(inside)
    return slice(int(at[0]), int(at[-1]) + 1) if at[-1] - at[0] + 1 == len(at) else at


def current_parameters(pool: ParameterLayout, model: FittedModel) -> Array:
    """(p,) the model's values of the pool's terms (frames count as zero: they are part of the linearisation point)."""
    values = np.zeros(len(pool.terms))
    for part in (*model.background, *model.parts):
        for term, value in zip(part.placed.terms, part.values, strict=True):
            values[pool.index[term]] += value
    return values
