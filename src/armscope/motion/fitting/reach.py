"""Which runs go where others go: what no other run shows, none can foretell."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armscope.core.constants import Constants, constant
from armscope.core.types import Array, Indices


@dataclass(frozen=True)
class ReachRules(Constants):
    """When others can foretell a run's motion."""

    shown: float = constant(
        0.25,
        "of a run's rows that others must show at every joint, to foretell it",
        "judgement: of what lies beyond all others nothing is learned; random waves of some seconds share a third",
    )
    wider: float = constant(0.05, "of what others show, by which it may be exceeded", "judgement: curves go on so far")


REACH = ReachRules()


def within_reach(run: NDArray[np.str_], block: Indices, moving: NDArray[np.bool_], state: tuple[Array, ...]) -> Indices:
    """Blocks of whose motion the others show enough at every joint; all of them, where they are parts of one run.

    Others show what lies between the least and the most of theirs, gaps among them or not.

    Args:
        run: (K,) name of each row's run.
        block: (K,) number of its block.
        moving: (K, m) where each joint moves.
        state: (K, m) each, what must be within what others show: positions, speeds.

    Returns:
        Their numbers; all where there would be none.
    """
    numbers = np.unique(block)
    if len(set(run.tolist())) == 1:
        return numbers
    shown = [number for number in numbers if _shown(block == number, moving, state) >= REACH.shown]
    return np.array(shown, dtype=np.intp) if shown else numbers


def _shown(held: NDArray[np.bool_], moving: NDArray[np.bool_], state: tuple[Array, ...]) -> float:
    """Share of the held rows that others show, at the joint where it is least."""
    inside = np.ones((np.count_nonzero(held), moving.shape[1]), dtype=np.bool_)
    for values in state:
        low, high = values[~held].min(axis=0), values[~held].max(axis=0)
        wider = REACH.wider * (high - low)
        inside &= (values[held] >= low - wider) & (values[held] <= high + wider)
    counts = moving[held].sum(axis=0)
    shares = np.sum(inside & moving[held], axis=0)[counts > 0] / counts[counts > 0]
    return float(shares.min()) if len(shares) else 1.0
