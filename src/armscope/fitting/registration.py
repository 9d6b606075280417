"""Frames as they are: base per run and tool per target, from a closed-form start anywhere in space."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from armscope.core.types import Array
from armscope.fitting.linearisation import missed
from armscope.measurement.robust import scale_of
from armscope.physics.frames import TOOL_FRAME, ToolKey, free_frames, tool_keys
from armscope.physics.model import Base, FittedModel
from armscope.physics.scene import Part
from armscope.recordings import Recordings
from armscope.robot import Arm, chain

STEPS = 12
CONVERGED_M = 1e-9
HUBER = 2.0
TURN_STEPS = 3
WORSE, EXCHANGED = 2.0, 3.0
"""A tool counts as exchanged when one tool for all runs leaves this many times the residual, and the tool points lie
this many times that residual apart."""


def fit_frames(arm: Arm, recordings: Recordings, tool_per_run: bool = False) -> FittedModel:
    """The arm with base and tool fitted to the recordings and no effects.

    Each run starts from the rigid motion that best maps the nominal tool points onto the measured ones (Kabsch 1976);
    Gauss-Newton with Huber weights then fits bases and tools together.
    """
    frames = chain(arm, recordings.motor_angles)
    keys = tool_keys(recordings, tool_per_run)
    which_tool = _tool_of_row(recordings, keys)
    runs, which_run = np.unique(recordings.run, return_inverse=True)
    bases = [_rigid(frames.tool[which_run == r], recordings.positions[which_run == r]) for r in range(len(runs))]
    tools = np.zeros((len(keys), 3))
    for _ in range(STEPS):
        residual, columns = _linear(recordings, frames.tool, frames.tool_rotation, bases, tools, which_run, which_tool)
        step = _robust_step(residual, columns)
        bases = [moved_base(base, step[6 * r : 6 * r + 6]) for r, base in enumerate(bases)]
        tools = tools + step[6 * len(bases) :].reshape(-1, 3)
        if np.abs(columns @ step).max() < CONVERGED_M:
            break
    return FittedModel(
        arm,
        {str(run): base for run, base in zip(runs, bases, strict=True)},
        _tool_parts(recordings, tool_per_run, tools),
        tool_turns=_tool_turns(recordings, frames.tool_rotation, bases, which_run, keys, which_tool),
    )


def _tool_turns(
    recordings: Recordings,
    modelled: Array,
    bases: list[Base],
    which_run: NDArray[np.intp],
    keys: list[ToolKey],
    which_tool: NDArray[np.intp],
) -> dict[ToolKey, Array]:
    """How each tool is turned on the last frame (N, 3, 3): the mean of its rows without those far off."""
    if recordings.orientation is None:
        return {}
    known = np.isfinite(recordings.orientation).all(axis=1)
    turns = {}
    for number, key in enumerate(keys):
        rows = np.flatnonzero(known & (which_tool == number))
        if not len(rows):
            continue
        placed = np.array([bases[r].rotation for r in which_run[rows]]) @ modelled[rows]
        measured = Rotation.from_quat(recordings.orientation[rows], scalar_first=True)
        on_flange = Rotation.from_matrix(placed).inv() * measured
        mean = on_flange.mean()
        for _ in range(TURN_STEPS):
            away = (mean.inv() * on_flange).magnitude()
            far = HUBER * max(float(np.median(away)), 1e-12)
            mean = on_flange.mean(np.minimum(1.0, far / np.maximum(away, 1e-15)))
        turns[key] = np.asarray(mean.as_matrix())
    return turns


def other_tools(arm: Arm, recordings: Recordings, shared: FittedModel) -> tuple[FittedModel, str] | None:
    """The arm with its tool free in every run, and how far a target's tools lie apart, in words, where they must.

    A tool that was exchanged between runs leaves a multiple of what else there is, in its points or in its
    orientations; lesser shifts are effects and compete with the others.

    Args:
        shared: the arm with one tool for all runs.
    """
    if len(shared.bases) < 2:
        return None
    free = fit_frames(arm, recordings, tool_per_run=True)
    before, after = missed(shared, recordings), missed(free, recordings)
    targets = [str(target) for target in np.unique(recordings.target)]
    told = []
    apart = max(_points_apart(free, target) for target in targets)
    if _exchanged(1e3 * apart, before.shift, after.shift):
        told.append(f"its point up to {apart * 1e3:.3g} mm")
    if before.turn is not None and after.turn is not None:
        apart = max(_turns_apart(free, target) for target in targets)
        known = np.isfinite(before.turn).all(axis=1)
        if known.any() and _exchanged(apart, before.turn[known], after.turn[known]):
            told.append(f"its axes up to {np.degrees(apart):.3g} degrees")
    return (free, " and ".join(told)) if told else None


def _exchanged(apart: float, before: Array, after: Array) -> bool:
    """Whether tools lie apart, seen by residuals (N, 3) with one tool for all runs and with one per run."""
    left = scale_of(after)
    return scale_of(before) > WORSE * left and apart > EXCHANGED * left


def _points_apart(model: FittedModel, target: str) -> float:
    """Largest difference of a coordinate between a target's tool points, m."""
    return float(np.ptp([part.values for part in model.tools if part.placed.variant == target], axis=0).max())


def _turns_apart(model: FittedModel, target: str) -> float:
    """Largest angle between a target's tool and its tool in the first run, rad."""
    turns = Rotation.from_matrix([turn for (of, _), turn in model.tool_turns.items() if of == target] or [np.eye(3)])
    return float((turns[0].inv() * turns).magnitude().max())


def _tool_parts(recordings: Recordings, per_run: bool, tools: Array) -> tuple[Part, ...]:
    placed = [p for p in free_frames(recordings, per_run) if p.effect is TOOL_FRAME]
    return tuple(Part(p, t) for p, t in zip(placed, tools, strict=True))


def _tool_of_row(recordings: Recordings, keys: list[tuple[str, str | None]]) -> NDArray[np.intp]:
    index = {key: number for number, key in enumerate(keys)}
    return np.array(
        [
            index[(str(t), None)] if (str(t), None) in index else index[(str(t), str(r))]
            for t, r in zip(recordings.target, recordings.run, strict=True)
        ]
    )


def _rigid(points: Array, measured: Array) -> Base:
    """The rotation and translation that map points onto measured points, least squares."""
    mean_p, mean_m = np.median(points, axis=0), np.median(measured, axis=0)
    u, _, vt = np.linalg.svd((measured - mean_m).T @ (points - mean_p))
    flip = np.diag([1.0, 1.0, np.sign(np.linalg.det(u @ vt))])
    rotation = u @ flip @ vt
    return Base(rotation, mean_m - rotation @ mean_p)


def _linear(
    recordings: Recordings,
    tool: Array,
    rotation: Array,
    bases: list[Base],
    tools: Array,
    which_run: NDArray[np.intp],
    which_tool: NDArray[np.intp],
) -> tuple[Array, Array]:
    """Residual (3N,) in base axes and its columns by base twists and tool translations."""
    count = len(tool)
    points = tool + np.einsum("nij,nj->ni", rotation, tools[which_tool])
    columns = np.zeros((count, 3, 6 * len(bases) + tools.size))
    residual = np.empty((count, 3))
    for r, base in enumerate(bases):
        rows = which_run == r
        residual[rows] = (recordings.positions[rows] - base.translation) @ base.rotation - points[rows]
        columns[rows, :, 6 * r : 6 * r + 3] = np.eye(3)
        columns[rows, :, 6 * r + 3 : 6 * r + 6] = _cross_columns(points[rows])
    for t in range(len(tools)):
        rows = which_tool == t
        at = 6 * len(bases) + 3 * t
        columns[rows, :, at : at + 3] = rotation[rows]
    return residual.reshape(-1), columns.reshape(3 * count, -1)


def _cross_columns(points: Array) -> Array:
    """(N, 3, 3) displacement of points by unit rotations about x, y, z."""
    x, y, z = points.T
    zero = np.zeros_like(x)
    return np.stack([np.stack([zero, z, -y], 1), np.stack([-z, zero, x], 1), np.stack([y, -x, zero], 1)], axis=1)


def _robust_step(residual: Array, columns: Array) -> Array:
    size = np.linalg.norm(residual.reshape(-1, 3), axis=1)
    scale = HUBER * max(float(np.median(size)), 1e-12)
    weight = np.repeat(np.minimum(1.0, scale / np.maximum(size, 1e-15)), 3)
    left = columns * weight[:, None]
    normal = left.T @ columns
    # a held wrist leaves the tool's offset to the base: the tiny ridge keeps such a fit at its start
    normal[np.diag_indices_from(normal)] += 1e-9 * np.trace(normal) / len(normal)
    return np.asarray(np.linalg.solve(normal, left.T @ residual))


def moved_base(base: Base, twist: Array) -> Base:
    """The base after a twist (translation m, rotation rad) in its own axes."""
    turn = Rotation.from_rotvec(twist[3:]).as_matrix()
    return Base(base.rotation @ turn, base.translation + base.rotation @ twist[:3])
