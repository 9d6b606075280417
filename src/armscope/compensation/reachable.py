"""In which directions an arm can move and turn its tool at all: a SCARA arm only in its plane, and about its normal."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armscope.compensation.constants import COMMANDS
from armscope.compensation.forward import frame_jacobian
from armscope.core.types import Array
from armscope.core.words import enumerated
from armscope.robot import Arm, chain


@dataclass(frozen=True, eq=False)
class Reachable:
    """Directions of the base in which an arm can be commanded."""

    # shifts, turns: (k, 3) orthonormal, in which its tool can be moved, and about which it can be turned
    shifts: Array
    turns: Array
    # no_shifts, no_turns: (3 - k, 3) the others
    no_shifts: Array
    no_turns: Array

    @property
    def is_everywhere(self) -> bool:
        """Whether it can do so in all directions, in some postures at least."""
        return not len(self.no_shifts) and not len(self.no_turns)

    def left_out_of(self, gap: Array) -> Array:
        """(N,) how long gaps (N, 3) are where the arm can't be moved."""
        return np.asarray(np.linalg.norm(gap @ self.no_shifts.T, axis=1))

    def told(self, left_m: Array, pose: bool) -> str:
        """What commands leave as it is.

        Args:
            left_m: (N,) what is missed where the arm can't be moved, m.

        Returns:
            A note; "" for an arm that can be led anywhere.
        """
        cannot = [f"moved along {_axes(self.no_shifts)}"] if len(self.no_shifts) else []
        cannot += [f"turned about {_axes(self.no_turns)}"] if pose and len(self.no_turns) else []
        if not cannot:
            return ""
        farthest = float(np.max(left_m[np.isfinite(left_m)], initial=0.0))
        most = f" (up to {1e3 * farthest:.2g} mm)" if farthest > COMMANDS.told_m else ""
        return (
            f"this arm can't be {enumerated(cannot, 'or')} of the base: commands put right what it can do, and leave "
            f"what it misses there as it is{most}"
        )


def reachable_by(arm: Arm, free: NDArray[np.bool_]) -> Reachable:
    """In which directions an arm moves its tool in any posture, from postures spread over its limits.

    A direction in which a unit turn of the motors moves it hardly anywhere by more than at a pole is none.

    Args:
        free: (m,) motors that may move.
    """
    limits = np.where(np.isfinite(arm.limits), arm.limits, [-np.pi, np.pi])
    low, high = limits.T
    angles = low + (high - low) * np.random.default_rng(0).random((COMMANDS.postures, arm.n_motors))
    jacobian = frame_jacobian(arm, chain(arm, angles)) * free
    least = COMMANDS.pole * COMMANDS.lever * arm.reach
    shifts, no_shifts = _split(jacobian[:, :3], least)
    turns, no_turns = _split(jacobian[:, 3:], COMMANDS.pole)
    return Reachable(shifts, turns, no_shifts, no_turns)


def _split(jacobian: Array, least: float) -> tuple[Array, Array]:
    """Directions (k, 3) along which Jacobians (N, 3, m) do more than ``least``, root mean square, and the others."""
    squares, axes = np.linalg.eigh(np.einsum("nij,nkj->ik", jacobian, jacobian) / len(jacobian))
    moves = np.sqrt(np.maximum(squares, 0.0)) > least
    return axes.T[moves], axes.T[~moves]


def _axes(directions: Array) -> str:
    """Directions in words: axes of the base where they are such, else as vectors."""
    covered = np.sum(directions**2, axis=0)
    along = [name for name, share in zip("xyz", covered, strict=True) if share > 1 - COMMANDS.along_an_axis]
    if len(along) == len(directions):
        return enumerated(along, "or")
    return enumerated([f"({', '.join(f'{value:.2f}' for value in each)})" for each in directions], "or")
