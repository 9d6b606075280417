"""What compensation gives: a command for every row of a path, or the reason why there is none."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from armscope.compensation.path import Frame
from armscope.core.averages import rms
from armscope.core.inputs import InputError
from armscope.core.told import InWords
from armscope.core.types import Array, Indices
from armscope.core.words import or_less
from armscope.recordings.columns import angle_columns
from armscope.robot import Arm


@dataclass(frozen=True, eq=False, repr=False)
class Compensated(InWords):
    """Commands for N rows of a path; NaN in rows that are refused."""

    arm: Arm
    # id, run: (N,) of the path's rows
    id: NDArray[np.str_]
    run: NDArray[np.str_]
    reasons: NDArray[np.object_]  # (N,) texts: why a row is refused; "" where it is not
    commands: Array  # (N, m) motor angles, rad
    nominal: Array  # (N, m) motor angles without correction, rad; NaN where the nominal arm can't get there
    false_targets: Array  # (N, 3) nominal tool points at the commands, base frame, m: what a controller is given
    false_rotations: Array  # (N, 3, 3) nominal orientations at the commands
    # wanted, predicted: (N, 3) m, in ``frame``
    wanted: Array
    predicted: Array
    residual: Array  # (N,) distance of the predicted from the wanted point, m
    uncorrected: Array  # (N,) the same without correction, m
    # residual_turn, uncorrected_turn: (N,) the same for the orientation, rad; NaN where it is free
    residual_turn: Array
    uncorrected_turn: Array
    # outside, nearest: (N,) distance of the commands from the identified range, and from the nearest identification row
    # (root mean square over the inputs), in standard deviations
    outside: Array
    nearest: Array
    frame: Frame  # of wanted and predicted points
    pose: bool  # whether the orientation was kept
    iterations: int  # Newton steps of the row that took most
    notes: tuple[str, ...] = ()  # what a user should know
    turn_open: bool = False  # whether a turn of the tool on the flange, the same in all rows, is not known
    # columns of the path's load, temperature and sides of approach, by name, where it has them
    context: Mapping[str, Array] = field(default_factory=dict)

    @property
    def reached(self) -> NDArray[np.bool_]:
        """(N,) rows that have commands."""
        reached: NDArray[np.bool_] = self.reasons == ""
        return reached

    @property
    def refused(self) -> list[tuple[Indices, str]]:
        """Rows without a command by cause, one reason each: how far rows lie outside differs from row to row."""
        rows = np.flatnonzero(~self.reached)
        causes = np.array([re.sub(r" by \S+ standard deviations", "", self.reasons[row]) for row in rows], dtype=object)
        by_cause = []
        for cause in np.unique(causes):
            of_cause = rows[causes == cause]
            alike = len(set(self.reasons[of_cause])) == 1
            by_cause.append((of_cause, str(self.reasons[of_cause[0]]) if alike else str(cause)))
        return by_cause

    @property
    def refusals(self) -> list[str]:
        """How many rows have no command, and why: a sentence per cause."""
        return [f"{len(rows)} of {len(self.reasons)} rows have no command: {why}" for rows, why in self.refused]

    def sentences(self) -> tuple[str, ...]:
        """How many rows have commands, what these leave, and where others say why they have none."""
        reached = self.reached
        left = ""
        if reached.any():
            before, after = (rms(miss[reached]) * 1e3 for miss in (self.uncorrected, self.residual))
            left = f"; RMS of the distance {before:.3g} mm without them, {or_less(after)} mm expected with them"
        return (
            f"{self.arm.name}: commands for {reached.sum()} of {len(reached)} rows of a path{left}.",
            "to_table() is what `armscope compensate` writes, with the reason where a row has none.",
        )

    def to_table(self, rows: slice = slice(None)) -> pd.DataFrame:
        """One row per row of the path, refused ones with their reason and without commands.

        A long path is written some ``rows`` at a time.
        """
        reached = self.reached[rows]
        status = np.where(reached, "ok", "refused")
        head = {"id": self.id[rows], "run": self.run[rows], "status": status, "reason": self.reasons[rows]}
        table = pd.DataFrame(head | angle_columns(self.commands[rows]))
        quaternions = np.full((len(table), 4), np.nan)
        if reached.any():
            turned = Rotation.from_matrix(self.false_rotations[rows][reached]).as_quat(canonical=True)
            quaternions[reached] = turned[:, [3, 0, 1, 2]]
        for prefix, points in (("command", self.false_targets), ("wanted", self.wanted), ("predicted", self.predicted)):
            for n, axis in enumerate("xyz"):
                table[f"{prefix}_{axis}_mm"] = points[rows, n] * 1e3
            if prefix == "command":
                for n, name in enumerate("wxyz"):
                    table[f"command_q{name}"] = quaternions[:, n]
        table["uncorrected_mm"] = self.uncorrected[rows] * 1e3
        table["residual_mm"] = self.residual[rows] * 1e3
        if self.pose:
            table["uncorrected_mrad"] = self.uncorrected_turn[rows] * 1e3
            table["residual_mrad"] = self.residual_turn[rows] * 1e3
        table["outside_sd"] = self.outside[rows]
        table["nearest_sd"] = self.nearest[rows]
        for name, values in self.context.items():
            table[name] = values[rows]
        return table

    def require_all(self, source: object) -> Array:
        """The commands, if every row has one. Raises InputError: names the first refused row and why."""
        refused = np.flatnonzero(~self.reached)
        if len(refused):
            raise InputError(
                source,
                f"line {refused[0] + 2} of the path",
                str(self.reasons[refused[0]]),
                f"every row must be possible, {len(refused)} of {len(self.reasons)} are refused",
                "The table of commands says why for each row; mend the path or leave these rows out yourself.",
            )
        return self.commands
