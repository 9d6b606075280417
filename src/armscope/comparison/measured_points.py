"""Where the measured point of each recording sits on the flange: no cause of the arm, but a fact about the set-up.

Each recording has a tool of its own, so that one that was put on again is no change of the arm. Where it sits is known
all the same, and a target that moved by millimetres is what somebody who repeats a measurement wants to hear first.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.special import stdtrit

from armscope.comparison.constants import COMPARING
from armscope.comparison.scoring import Possible
from armscope.comparison.shared_model import SharedModel
from armscope.core.types import Array
from armscope.core.words import enumerated
from armscope.robot import Arm, chain
from armscope.verdict.wording import decimals_for


@dataclass(frozen=True)
class MeasuredPoint:
    """Where a target of a recording sits in the arm's last frame."""

    # recording, target: which; the target is empty where the table names none
    recording: str
    target: str
    # point_mm, stderr_mm: its place as `tool_mm` states it, and how sure that is
    point_mm: tuple[float, ...]
    stderr_mm: tuple[float, ...]
    than: str = ""  # the recording before it that has a target of that name; empty for the first one
    # moved_mm, interval_95: how far from its place there, and between which distances; NaN for the first one
    moved_mm: float = math.nan
    interval_95: tuple[float, float] = (math.nan, math.nan)
    is_moved: bool = False  # that it surely sits elsewhere than there, by more than a reflector that is put on again
    may_be_zero: bool = False  # that it moved about the last joint's axis, as if that joint's zero had

    def told(self, also: bool = False) -> str:
        """How far it sits from where it was, as a clause; shorter where another one was told before."""
        digits = max(decimals_for((self.interval_95[1] - self.interval_95[0]) / 2) - 1, 0)
        low, high = (f"{each:.{digits}f}" for each in self.interval_95)
        what = f' "{self.target}"' if self.target else ""
        between = f'in "{self.recording}" than in "{self.than}"'
        by = f"{self.moved_mm:.{digits}f} mm ({low} … {high})"
        return f"{by}{what} {between}" if also else f"measured point{what} lies {by} elsewhere on the flange {between}"


def measured_points(model: SharedModel, taken: Sequence[Possible], names: Sequence[str]) -> tuple[MeasuredPoint, ...]:
    """Every target of every recording, beside what all share and what changed.

    Args:
        model: what recordings share; targets are called "recording: target".
        taken: the changes.
        names: of the recordings, in the order of time.

    Returns:
        In that order.
    """
    base = model.base(taken)
    inverse = np.linalg.inv(base.gram + np.diag(base.penalty))
    unit = 1e-3 * np.linalg.norm(model.frames, axis=0)
    start = np.concatenate([*model.tools.values()])
    of_tools = np.arange(model.frames.shape[1])[-len(start) :]
    at = base.drawn + of_tools
    moved = (inverse @ (base.columns.T @ model.residual))[at] / unit[of_tools]
    variance, free = model.left(base)
    covariance = model.dispersion * variance * inverse[np.ix_(at, at)] / np.outer(*[unit[of_tools]] * 2)
    points = 1e3 * start + moved
    where = dict(zip(model.tools, np.arange(len(start)).reshape(len(model.tools), -1), strict=True))
    found: list[MeasuredPoint] = []
    for recording in names:
        for name in [name for name in where if name.startswith(f"{recording}: ")]:
            own, target = where[name], name.removeprefix(f"{recording}: ")
            place = tuple(points[own].tolist()), tuple(np.sqrt(covariance[own, own]).tolist())
            point = MeasuredPoint(recording, target, *place)
            than = next((each.recording for each in reversed(found) if each.target == target), "")
            if than:
                other = where[f"{than}: {target}"]
                contrast = np.hstack([np.eye(len(own)), -np.eye(len(own))])
                spread = contrast @ covariance[np.ix_(both := [*own, *other], both)] @ contrast.T
                step, half = points[own] - points[other], float(stdtrit(free, COMPARING.interval))
                distance, interval = _apart(step, spread, half)
                point = replace(
                    point,
                    than=than,
                    moved_mm=distance,
                    interval_95=interval,
                    is_moved=interval[0] > COMPARING.moved_point * math.sqrt(variance),
                    may_be_zero=_about_last_axis(model.arm, points[other], step, half**2 * spread),
                )
            found.append(point)
    return tuple(found)


def _apart(step: Array, covariance: Array, half: float) -> tuple[float, tuple[float, float]]:
    """How far, and the 95 % interval of that. ``step``: (3,) mm; ``covariance``: (3, 3) of it."""
    distance = float(np.linalg.norm(step))
    along = step / max(distance, 1e-300)
    error = half * float(np.sqrt(along @ covariance @ along))
    return distance, (max(distance - error, 0.0), distance + error)


def _about_last_axis(arm: Arm, point: Array, step: Array, within: Array) -> bool:
    """Whether a step keeps a point's way along the last joint's axis and its distance from that, as turning it does.

    Args:
        point: (3,) mm in the last frame, before.
        step: (3,) mm.
        within: (3, 3) covariance of the step, times the square of half an interval.
    """
    frames = chain(arm, np.zeros((1, arm.n_motors)))
    turn = frames.tool_rotation[0]
    axis = turn.T @ frames.joint_rotation[0, -1, :, 2]
    origin = 1e3 * (arm.tool + turn.T @ (frames.joint_origin[0, -1] - frames.tool[0]))
    before, after = (each - axis * (axis @ each) for each in (point - origin, point + step - origin))
    away = (before + after) / max(float(np.linalg.norm(before + after)), 1e-300)
    farther = float(np.linalg.norm(after) - np.linalg.norm(before))
    checked = ((axis @ step, axis), (farther, away))
    return all(size**2 <= along @ within @ along for size, along in checked)


def told_of_points(points: Sequence[MeasuredPoint]) -> str:
    """Which sit elsewhere than in the recording before, and why that may be; "" where none does."""
    moved = [each for each in points if each.is_moved]
    if not moved:
        return ""
    told = [each.told(also=each is not moved[0]) for each in moved[: COMPARING.named]]
    more = [f"{len(moved) - len(told)} more"] * (len(moved) > len(told))
    said = f"The {enumerated([*told, *more])}: another target"
    if all(each.may_be_zero for each in moved):
        return f"{said}, a bent tool, or the zero of the last joint, which moves it so."
    return f"{said}, or a bent tool. That is no cause of the arm."
