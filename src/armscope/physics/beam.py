"""A link that bends as an Euler-Bernoulli cantilever, under what hangs on its end and under its own weight."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from armscope.core.rotations import cross
from armscope.core.types import Array


class SpreadWeight(NamedTuple):
    """How a link's own weight lies on its beam."""

    even: float  # the share that lies evenly along it
    at_end: float  # the share at its end; the others are at its root, and bend nothing
    off_beam: Array  # (3,) where the even share lies beside the beam, m
    off_end: Array  # (3,) where the end's share lies from the end, m


def spread_weight(centre: Array, e: Array, length: float) -> SpreadWeight:
    """How a link's weight lies on its beam so that its centre of mass is where it is stated.

    A tube is even, and what is heavier than the tube sits at its ends: a motor, the next joint's housing.

    Args:
        centre: (3,) of the link's mass, from the beam's end, m.
        e: (3,) unit vector along the beam, towards its end.
        length: of the beam, m.

    Returns:
        The shares and where they lie.
    """
    along = float(centre @ e)
    from_root = min(max(1 + along / length, 0.0), 1.0)
    beside = centre - along * e
    return SpreadWeight(
        2 * min(from_root, 1 - from_root), max(2 * from_root - 1, 0.0), beside, beside + max(along, 0.0) * e
    )


def bent(e: Array, length: float, force: Array, moment: Array, weight: Array, spread: SpreadWeight) -> Array:
    """(N, 6) shift and turn of a beam's end per unit 1/(E I), in the beam's axes.

    Under an end force F and moment M and an even load U with an even moment V, all across the beam:
    turns L (M + V/2 + L e x (F/2 + U/6)), moves L^2 (M/2 + V/3) x e + L^3 (F/3 + U/8).

    Args:
        e: (3,) unit vector along the beam, towards its end.
        length: L, m.
        force: (N, 3) of everything beyond, N.
        moment: (N, 3) of everything beyond about the beam's end, N m.
        weight: (N, 3) the beam's own, N.
        spread: how that lies.

    Returns:
        Shift, m, and turn, rad, times E I.
    """
    end = spread.at_end * weight
    even = spread.even * weight
    moments = moment + cross(spread.off_end, end), cross(spread.off_beam, even)
    F, M, U, V = (load - np.outer(load @ e, e) for load in (force + end, moments[0], even, moments[1]))
    turn = length * (M + V / 2 + length * cross(e, F / 2 + U / 6))
    move = length**2 * cross(M / 2 + V / 3, e) + length**3 * (F / 3 + U / 8)
    return np.concatenate([move, turn], axis=1)
