"""How much of the mismatch each effect is worth, when several overlap or cancel.

An effect's share is the part of the residual variance after the free frames that it explains, averaged over the orders
in which effects and backgrounds can be let in (Shapley 1953; for regression Lindeman, Merenda & Gold 1980). Shares are
never negative, and together they are what the whole model explains. (The variance of an effect by itself has neither
property: of two that nearly cancel, each would be worth many times the mismatch.)

They order and weigh what was found. What a verdict prints is what a cure as it was found is worth, which can be below
zero (`armscope.verdict.importance`).
"""

from __future__ import annotations

import itertools
from collections.abc import Collection, Iterator, Sequence

import numpy as np

from armscope.core.types import Array, Indices
from armscope.inference.constants import BUDGET
from armscope.inference.linear_algebra import among, lower_cholesky, solve_lower
from armscope.inference.normal_equations import NormalEquations


def shares(
    equations: NormalEquations,
    ridge: Array,
    frames: Indices,
    members: Sequence[Indices],
    last: Collection[int] = (),
) -> Array:
    """(members,) share of the variance after the frames that each member explains, 0 ... 1.

    Args:
        equations: sums over the rows.
        ridge: (p,) noise variance over prior variance of each column: what a value that is held near zero costs.
        frames: columns of the free frames; they come first in every order.
        members: columns of each effect or background.
        last: members that come after all others: they count for what nothing else explains.

    Returns:
        (members,) 0 ... 1; with what is left they add up to one.
    """
    count = len(members)
    scale = np.sqrt(np.maximum(np.diag(equations.G) + ridge, 1e-300))
    G, b = equations.G / np.outer(scale, scale), equations.b / scale
    held = ridge / scale**2
    left = float(equations.yy - _explained(G, b, held, frames).sum())
    if count == 0 or left <= 0:
        return np.zeros(count)
    totals, orders = np.zeros(count), 0
    first = np.concatenate([frames, *(each for m, each in enumerate(members) if m not in last)])
    beyond = _beyond(G, b, held, first) if last else None  # however those before the last ones are ordered
    for drawn in _orders(count):
        totals += _in_order(G, b, held, frames, [(m, members[m]) for m in drawn if m not in last], count)
        if beyond is not None:
            own = [(m, members[m]) for m in drawn if m in last]
            totals += _in_order(*beyond, held, frames[:0], own, count)
        orders += 1
    return np.asarray(totals / (orders * left))


def _in_order(
    G: Array, b: Array, held: Array, before: Indices, order: Sequence[tuple[int, Indices]], count: int
) -> Array:
    """(count,) what each of some members explains beyond some columns and the members before it, mm^2."""
    explained = _explained(G, b, held, np.concatenate([before, *(columns for _, columns in order)]))
    parts = np.split(explained, np.cumsum([len(before), *(len(columns) for _, columns in order)])[:-1])
    found = np.zeros(count)
    for (member, _), part in zip(order, parts[1:], strict=True):
        found[member] = part.sum()
    return found


def _beyond(G: Array, b: Array, held: Array, columns: Indices) -> tuple[Array, Array]:
    """Sums of all columns beyond what some of them explain."""
    factor = lower_cholesky(among(G, columns), held[columns])
    taken = solve_lower(factor, G[columns])
    return G - taken.T @ taken, b - taken.T @ solve_lower(factor, b[columns])


def _explained(G: Array, b: Array, held: Array, columns: Indices) -> Array:
    """What each column explains beyond those before it, mm^2."""
    factor = lower_cholesky(among(G, columns), held[columns])
    return solve_lower(factor, b[columns]) ** 2


def _orders(count: int) -> Iterator[tuple[int, ...]]:
    everything = itertools.permutations(range(count))
    if count <= 5:
        yield from everything
        return
    rng = np.random.default_rng(count)
    for _ in range(BUDGET.most_orders // 2):
        order = tuple(int(m) for m in rng.permutation(count))
        yield order
        yield order[::-1]
