"""Rows of torque and model: every column formed at full rate, filtered as the torque is, and kept every n-th time."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array, Indices, Progress
from armscope.motion.causes import Moment, coulomb_width, sharp_width, side
from armscope.motion.layout import CAUSES_OF_OWN, OWN, TorqueLayout
from armscope.motion.preparation import Preparation, Signals, parts
from armscope.motion.sampling_constants import FILTER
from armscope.motion.timing import Stretch
from armscope.robot.dynamics import MovingArm


@dataclass(frozen=True, eq=False)
class MotionRows:
    """K rows of m joints.

    Attributes:
        layout: of the columns.
        time, run, stretch: (K,) of each row.
        q, dq: (K, m) positions and velocities.
        torque: (K, m) measured, as motors' torque, low-passed.
        nominal: (K, m) that the stated masses ask for.
        still: (K, m) where a joint stands, and its friction may be anything.
        columns: of each joint (K, p_j).
        at: of each joint (p_j,) where these columns stand.
    """

    layout: TorqueLayout
    time: Array
    run: NDArray[np.str_]
    stretch: Indices
    q: Array
    dq: Array
    torque: Array
    nominal: Array
    still: NDArray[np.bool_]
    columns: tuple[NDArray[np.float32], ...]
    at: tuple[Indices, ...]

    def __len__(self) -> int:
        return len(self.time)

    def modelled(self, coefficients: Array) -> Array:
        """(K, m) torque that coefficients (p,) add to the nominal one."""
        parts = [
            columns @ coefficients[at].astype(np.float32) for columns, at in zip(self.columns, self.at, strict=True)
        ]
        return np.column_stack(parts).astype(np.float64)


@dataclass(frozen=True, eq=False)
class SoFar:
    """The model so far, of which further columns are functions.

    Attributes:
        inertial: (10 n,) inertial parameters.
        background: (m, 4) offset, dry and viscous friction, rotor inertia, with what is stated.
        delay: (m,) s by which torques are late: where friction changes sides is then seen later, too.
    """

    inertial: Array
    background: Array
    delay: Array


def stated_model(arm: MovingArm) -> SoFar:
    """What robot.yaml states."""
    return SoFar(arm.inertial, np.nan_to_num(arm.stated_background), np.zeros(arm.n_motors))


def torque_of(arm: MovingArm, stretch_effort: Array, kind: str) -> Array:
    """Motor torque from what was recorded.

    Args:
        arm: its gains.
        stretch_effort: (N, m) N m (N) or A.
        kind: "torque" or "current".

    Returns:
        (N, m) N m (N).
    """
    return stretch_effort * np.where(np.isnan(arm.gains), 1.0, arm.gains) if kind == "current" else stretch_effort


def build_rows(
    layout: TorqueLayout,
    stretches: Sequence[Stretch],
    how: Preparation,
    model: SoFar,
    progress: Progress = lambda t, s: None,
) -> MotionRows:
    """All rows of a table.

    Args:
        layout: of the columns.
        stretches: even samples, ``effort`` in N m.
        how: filters and decimation.
        model: of which load, delay and gain are functions.
        progress: hears how far it is.

    Returns:
        The rows, in the order of the stretches.
    """
    pieces, done, total = [], 0, sum(len(stretch) for stretch in stretches)
    for signals in parts(stretches, how):
        pieces.append(_piece(layout, signals, how, model))
        done += len(signals.kept) * how.every
        progress("forming the model's columns", min(done / total, 1.0))
    return MotionRows(
        layout=layout,
        time=np.concatenate([piece.time for piece in pieces]),
        run=np.concatenate([piece.run for piece in pieces]),
        stretch=np.concatenate([piece.stretch for piece in pieces]),
        q=np.concatenate([piece.q for piece in pieces]),
        dq=np.concatenate([piece.dq for piece in pieces]),
        torque=np.concatenate([piece.torque for piece in pieces]),
        nominal=np.concatenate([piece.nominal for piece in pieces]),
        still=np.concatenate([piece.still for piece in pieces]),
        columns=tuple(np.concatenate(of_joint) for of_joint in zip(*(piece.columns for piece in pieces), strict=True)),
        at=pieces[0].at,
    )


def _piece(layout: TorqueLayout, signals: Signals, how: Preparation, model: SoFar) -> MotionRows:
    arm, kept = layout.arm, signals.kept
    regressor = arm.regressor(signals.q, signals.dq, signals.ddq)
    background = own_columns(arm, signals, model.delay)
    rigid = regressor @ model.inertial
    if signals.payload is not None:
        rigid = rigid + signals.payload[:, None] * (regressor @ arm.point_load())
    predicted = rigid + np.einsum("nmk,mk->nm", background[:, :, :CAUSES_OF_OWN], model.background)
    gravity = None
    if any(cause.cause.name == "gravity_direction" for cause in layout.placed):
        gravity = np.stack([arm.gravity_torques(signals.q, axis) for axis in np.eye(3)], axis=2)
    moment = Moment(signals, rigid, predicted, gravity, how.rate)
    low = functools.partial(how.low_passed, kept=kept)
    regressor = low(regressor)
    stated = np.nan_to_num(arm.stated_background)
    nominal = regressor @ arm.inertial
    if np.any(stated):
        nominal += low(np.einsum("nmk,mk->nm", background[:, :, :CAUSES_OF_OWN], stated))
    if signals.payload is not None:
        nominal += signals.payload[kept, None] * (regressor @ arm.point_load())
    columns, at = [], []
    own = _own_columns(layout, moment)
    inertial = _made_of_masses(layout, regressor, signals.run)
    rounded = bend(predicted, how.rate)
    for j in range(arm.n_motors):
        of_joint, where = own[j]
        gain = [predicted[:, j]] if layout.with_gains else []
        filtered = low(np.column_stack([background[:, j], *of_joint, *gain, rounded[:, j]]))
        whole = np.column_stack(
            [filtered, regressor[:, j] * layout.inertial_scale, *(made[:, j] for made, _ in inertial)]
        )
        columns.append(whole.astype(np.float32))
        at.append(
            np.concatenate(
                [
                    OWN * j + np.arange(OWN),
                    *where,
                    *([layout.gains[j : j + 1]] if layout.with_gains else []),
                    layout.response,
                    layout.inertial,
                    *(index for _, index in inertial),
                ]
            )
        )
    return MotionRows(
        layout=layout,
        time=signals.time[kept],
        run=np.full(len(kept), signals.run),
        stretch=np.full(len(kept), signals.stretch),
        q=signals.q[kept],
        dq=signals.dq[kept],
        torque=low(signals.effort),
        nominal=nominal,
        still=_still(arm, signals, how)[kept],
        columns=tuple(columns),
        at=tuple(at),
    )


def bend(torque: Array, rate: float) -> Array:
    """(N, m) second derivative of torques, N m/s^2: what drives' filters and rounding take part of."""
    slope = np.gradient(torque, 1 / rate, axis=0)
    return np.asarray(np.gradient(slope, 1 / rate, axis=0))


def own_columns(arm: MovingArm, signals: Signals, delay: Array) -> Array:
    """What every joint has, per unit of each.

    Args:
        arm: the arm.
        signals: N samples.
        delay: (m,) s by which torques are late: how friction changes sides is seen later by as much.

    Returns:
        (N, m, 6) of `layout.OWN_NAMES`.
    """
    width = sharp_width(arm)
    turned = side(signals, width)
    blunter = side(signals, coulomb_width(arm)) - turned
    later = -np.gradient(turned, signals.period, axis=0)
    for j in np.flatnonzero(delay):
        for shape in (blunter, later):
            shape[:, j] = np.interp(signals.time - delay[j], signals.time, shape[:, j])
    return np.stack([np.ones_like(signals.q), turned, signals.dq, signals.ddq, blunter, later], axis=2)


def _own_columns(layout: TorqueLayout, moment: Moment) -> list[tuple[list[Array], list[Indices]]]:
    """By joint: columns (N, c) at full rate of its causes, and where they stand."""
    own: list[tuple[list[Array], list[Indices]]] = [([], []) for _ in range(layout.arm.n_motors)]
    for cause, index in zip(layout.placed, layout.columns, strict=True):
        if cause.columns is not None:
            values = cause.columns(moment)
            for number, joint in enumerate(cause.joints):
                own[joint][0].append(values[:, number])
                own[joint][1].append(index)
    return own


def _made_of_masses(layout: TorqueLayout, regressor: Array, run: str) -> list[tuple[Array, Indices]]:
    """Columns (K, m, c) of causes that are combinations of inertial parameters, and where they stand."""
    made = []
    for cause, index in zip(layout.placed, layout.columns, strict=True):
        if cause.inertial is not None:
            there = 0.0 if cause.runs and run not in cause.runs else 1.0
            made.append((there * (regressor @ cause.inertial), index))
    return made


def _still(arm: MovingArm, signals: Signals, how: Preparation) -> NDArray[np.bool_]:
    """Where a joint is slow for longer than it takes to turn back."""
    width = FILTER.still * np.where(arm.sliding, FILTER.coulomb_width_m_s, FILTER.coulomb_width_rad_s)
    slow = np.abs(signals.dq) < width
    length = max(int(FILTER.still_s * how.rate), 1)
    total = np.cumsum(np.vstack([np.zeros(arm.n_motors), slow]), axis=0)
    stood = np.zeros_like(slow)
    if len(slow) > length:
        whole = (total[length:] - total[:-length]) == length  # windows that are slow all through
        for shift in (0, length // 2, length - 1):
            stood[shift : shift + len(whole)] |= whole
    return np.asarray(stood & slow)
