"""What the page of a moving arm is about: the diagnosis, and what several sections and figures ask of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from armscope.core.types import Array
from armscope.motion.pipeline import MotionDiagnosis
from armscope.motion.summary.holding_out import HeldOutTorque
from armscope.motion.summary.told_gains import factors_in_words
from armscope.motion.verdict import FoundCause, MotionVerdict
from armscope.robot.dynamics import MovingArm


@dataclass(frozen=True, eq=False)
class MotionSubject:
    """A diagnosis of a motion, and the names of its files."""

    found: MotionDiagnosis
    source: str  # the table's name
    robot: Path | str = "robot.yaml"  # the arm's file, as the user named it
    folder: Path | str = ""  # where the diagnosis is written, as the user named it

    @property
    def verdict(self) -> MotionVerdict:
        """What was found."""
        return self.found.verdict

    @property
    def arm(self) -> MovingArm:
        """The arm as stated."""
        return self.found.arm

    @property
    def main(self) -> list[FoundCause]:
        """The causes of the story, largest share first."""
        return [cause for cause in self.verdict.effects if not cause.minor]

    @property
    def minor(self) -> list[FoundCause]:
        """Those worth little."""
        return [cause for cause in self.verdict.effects if cause.minor]

    @property
    def masses_fitted(self) -> bool:
        """Whether inertial parameters of links are part of what was fitted, beside the causes."""
        return bool(len(np.intersect1d(self.found.selected.rows.layout.masses, self.found.selected.best.columns)))

    @property
    def gains_fitted(self) -> str:
        """What to do about gains that were fitted beside the causes; empty where there are none."""
        selected, layout = self.found.selected, self.found.selected.rows.layout
        return factors_in_words(selected.coefficients[layout.gains], layout.with_gains)

    @cached_property
    def held(self) -> HeldOutRows:
        """All rows that took no part, one below the other."""
        parts = self.found.held
        return HeldOutRows(
            *(np.concatenate([getattr(part.rows, name)[part.which] for part in parts]) for name in ("time", "q", "dq")),
            *(np.concatenate([getattr(part, name) for part in parts]) for name in ("measured", "background", "model")),
        )

    @cached_property
    def moving(self) -> list[int]:
        """Joints, from 0, that move in the rows that were fitted."""
        return [int(j) for j in np.flatnonzero((~self.found.selected.rows.still).any(axis=0))]

    def unit(self, joint: int) -> str:
        """Of a joint's torque."""
        return "N" if self.arm.sliding[joint] else "N m"

    def shown(self, joint: int) -> tuple[float, str]:
        """Factor and unit in which a joint's position is shown."""
        return (1e3, "mm") if self.arm.sliding[joint] else (180 / np.pi, "deg")


@dataclass(frozen=True, eq=False)
class HeldOutRows:
    """(K,) time, s, and (K, m) positions, speeds, and torques: measured, with friction fitted, by the model."""

    time: Array
    q: Array
    dq: Array
    measured: Array
    background: Array
    model: Array


def liveliest_piece(parts: Sequence[HeldOutTorque], most: int) -> tuple[HeldOutTorque, slice]:
    """Of all rows that were held out, the piece without a gap in which most happens while joints move."""
    found = [(*_liveliest(part, most), part) for part in parts]
    _, piece, part = max(found, key=lambda each: each[0])
    return part, piece


def _liveliest(part: HeldOutTorque, most: int) -> tuple[float, slice]:
    stretch = part.rows.stretch[part.which]
    best, where = -1.0, slice(0, len(stretch))
    scale = np.maximum(np.std(part.measured, axis=0), 1e-12)
    moving = ~part.rows.still[part.which]
    for number in np.unique(stretch):
        rows = np.flatnonzero(stretch == number)
        for start in range(int(rows[0]), int(rows[-1]) + 1, most):
            piece = slice(start, min(start + most, int(rows[-1]) + 1))
            swing = np.std(part.measured[piece] / scale, axis=0) * np.mean(moving[piece], axis=0)
            lively = float(np.sum(swing)) * (piece.stop - piece.start)
            if lively > best:
                best, where = lively, piece
    return best, where
