"""Free curves of joints' own angles: are they the same on two runs, and what do they turn on rows of another?"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from armscope.core.types import Array
from armscope.diagnosis import Verdict
from armscope.physics.freeform import follows_own_angle
from armscope.physics.model import FittedModel
from armscope.physics.placing import moving_joints
from armscope.physics.scene import Scene
from armscope.real.constants import CURVES
from armscope.recordings import Recordings


@dataclass(frozen=True, eq=False)
class Shared:
    """One joint's curve as two runs tell it, over the angles that both cover, without its slow part."""

    joint: str  # "joint 3"
    runs: tuple[str, str]
    at: Array  # (K,) angle of the joint, rad, evenly spaced
    # one, other: (K,) turn of the joint, rad; NaN where one of the runs hardly knows it
    one: Array
    other: Array

    @property
    def correlation(self) -> float:
        """Of the two curves, where both are known."""
        known = np.isfinite(self.one)
        return float(np.corrcoef(self.one[known], self.other[known])[0, 1])

    @property
    def in_common(self) -> float:
        """How much of the joint's range both runs know, rad."""
        return float(CURVES.step_rad * np.count_nonzero(np.isfinite(self.one)))


def turned_by_curves(model: FittedModel, rows: Recordings) -> Recordings | None:
    """Rows with the motor angles that a model's curves of own angles make of the commanded ones.

    Beyond the range in which it was learned a curve keeps its end's value. None without curves, and where no row is
    turned differently from another (the curves' joints stand still, or stay where no curve was learned): a constant
    turn is an encoder's zero, which every calibration fits anyway.
    """
    moving = {f"joint {motor}" for motor in moving_joints(rows)}
    parts = [part for part in model.parts if follows_own_angle(part.placed) and part.placed.location in moving]
    if not parts:
        return None
    twists = Scene(model.arm, rows).twists(parts)
    joints = len(model.arm.actuation)
    turns = np.column_stack(
        [twists[name][:, 5] if (name := f"joint {j + 1}") in twists else np.zeros(len(rows)) for j in range(joints)]
    )
    if np.ptp(turns, axis=0).max() < CURVES.no_turn_rad:
        return None
    motors = np.linalg.lstsq(model.arm.actuation, turns.T, rcond=None)[0].T
    return replace(rows, motor_angles=rows.motor_angles + motors)


def curve_table(verdicts: Mapping[str, Verdict]) -> pd.DataFrame:
    """Every curve of a joint's own angle: run, joint, angle_rad, turn_rad, stderr_rad."""
    columns = ["run", "joint", "angle_rad", "turn_rad", "stderr_rad"]
    pieces = [
        pd.DataFrame({"run": run, "joint": e.location, "angle_rad": c.at, "turn_rad": c.value, "stderr_rad": c.stderr})
        for run, verdict in verdicts.items()
        for e in verdict.effects
        if (c := e.curve) is not None and e.nameless and e.driver == f"angle of {e.location}"
    ]
    return pd.concat(pieces, ignore_index=True) if pieces else pd.DataFrame(columns=columns)


def shared(table: pd.DataFrame) -> list[Shared]:
    """The curves of `curve_table` that two runs know over enough angles in common."""
    found = []
    for joint, of_joint in table.groupby("joint"):
        by_run = {str(run): rows for run, rows in of_joint.groupby("run", sort=False)}
        for one, other in combinations(by_run, 2):
            at = np.arange(*_overlap(by_run[one]["angle_rad"], by_run[other]["angle_rad"]), CURVES.step_rad)
            known = _known(at, by_run[one]) & _known(at, by_run[other])
            if CURVES.step_rad * np.count_nonzero(known) > CURVES.common_rad:
                values = [_without_slow_part(at, by_run[run], known) for run in (one, other)]
                found.append(Shared(str(joint), (one, other), at, *values))
    return found


def _overlap(one: Iterable[float], other: Iterable[float]) -> tuple[float, float]:
    return max(min(one), min(other)), min(max(one), max(other))


def _known(at: Array, curve: pd.DataFrame) -> NDArray[np.bool_]:
    """Where a curve's standard error is small beside what the curve does."""
    stderr = np.interp(at, curve["angle_rad"], curve["stderr_rad"])
    return np.asarray(stderr < CURVES.known * curve["turn_rad"].std())


def _without_slow_part(at: Array, curve: pd.DataFrame, known: NDArray[np.bool_]) -> Array:
    value = np.interp(at, curve["angle_rad"], curve["turn_rad"])
    slow = np.polynomial.Polynomial.fit(at[known], value[known], CURVES.slow_degree)
    return np.where(known, value - slow(at), np.nan)
