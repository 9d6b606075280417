"""Where the arm stands in the measurement frame, in closed form: base frame and tool offsets without a first guess."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array


@dataclass(frozen=True, eq=False)
class Similarity:
    """to = scale * rotation @ from + translation; ``determinant`` is -1 where a mirror image would fit better."""

    rotation: Array
    translation: Array
    scale: float
    determinant: int
    rms: float


def kabsch(points: Array, measured: Array, mirrored: bool = False) -> Similarity:
    """The rigid motion that brings ``points`` (N, 3) nearest to ``measured`` (N, 3), in the least-squares sense.

    Kabsch (1976), with Umeyama's (1991) scale told beside it; the scale is not applied in ``rms``, which is the root
    mean square per axis in the unit of the points.

    Args:
        points: in the arm's base frame.
        measured: the same points in the measurement frame.
        mirrored: allow only improper rotations: the fit that a left-handed measurement frame would need.

    Returns:
        Rotation, translation, scale, handedness and RMS.
    """
    centre, goal = points.mean(axis=0), measured.mean(axis=0)
    from_centre, from_goal = points - centre, measured - goal
    left, spread, right = np.linalg.svd(from_goal.T @ from_centre)
    handed = int(np.sign(np.linalg.det(left @ right)) or 1)
    signs = np.array([1.0, 1.0, handed * (-1.0 if mirrored else 1.0)])
    rotation = (left * signs) @ right
    size = float(np.sum(from_centre**2))
    scale = float(spread @ signs) / size if size > 0 else 1.0
    translation = goal - rotation @ centre
    left_over = measured - points @ rotation.T - translation
    return Similarity(rotation, translation, scale, handed, float(np.sqrt(np.mean(left_over**2))))


@dataclass(frozen=True, eq=False)
class Placement:
    """Base frame of one run and the tool offsets of its targets.

    Attributes:
        rotation, translation: measurement frame from arm base, (3, 3) and (3,) m.
        tools: (K, 3) offsets in the last frame, m; NaN for targets that the run does not have.
    """

    rotation: Array
    translation: Array
    tools: Array


def starts(flange: Array, turned: Array, target: NDArray[np.intp], measured: Array, tools: Array) -> list[Placement]:
    """Placements to start from, without any first guess of where the instrument stands.

    The first trusts the nominal tools (Kabsch); the second finds tools and base together from the linear equations
    measured = R flange + sum_k (R (x) tool_k) turned + t, with R made a rotation afterwards. Whichever fits better
    after refinement counts: the second fails where the poses hardly turn, the first where the tool is far from nominal.

    Args:
        flange: (N, 3) origin of the last frame in the arm's base frame, m.
        turned: (N, 3, 3) its rotation.
        target: (N,) number of the target of each row.
        measured: (N, 3) in the measurement frame, m.
        tools: (K, 3) nominal offsets, m.

    Returns:
        One or two placements: rotation, translation (m) and tools (K, 3), m.
    """
    nominal = kabsch(flange + np.einsum("nij,nj->ni", turned, tools[target]), measured)
    found = [Placement(nominal.rotation, nominal.translation, _of_run(tools, target))]
    linear = _linear_start(flange, turned, target, measured, len(tools))
    return found if linear is None else [*found, linear]


def _of_run(tools: Array, target: NDArray[np.intp]) -> Array:
    there = np.isin(np.arange(len(tools)), target)
    return np.where(there[:, None], tools, np.nan)


def _linear_start(
    flange: Array, turned: Array, target: NDArray[np.intp], measured: Array, n_tools: int
) -> Placement | None:
    present = np.unique(target)
    n_rows = len(flange)
    by_target = np.zeros((n_rows, len(present), 9))
    by_target[np.arange(n_rows), np.searchsorted(present, target)] = turned.reshape(n_rows, 9)
    centre = flange.mean(axis=0)
    columns = np.column_stack([flange - centre, by_target.reshape(n_rows, -1), np.ones(n_rows)])
    if n_rows < columns.shape[1]:
        return None
    solution = np.linalg.lstsq(columns, measured, rcond=1e-9)[0]
    left, _, right = np.linalg.svd(solution[:3].T)
    rotation = (left * [1.0, 1.0, np.sign(np.linalg.det(left @ right)) or 1.0]) @ right
    return _tools_for(rotation, flange, turned, np.searchsorted(present, target), present, measured, n_tools)


def _tools_for(
    rotation: Array,
    flange: Array,
    turned: Array,
    target: NDArray[np.intp],
    present: NDArray[np.intp],
    measured: Array,
    n_tools: int,
) -> Placement:
    """Translation and tools for a known rotation: linear least squares, of smallest size where not determined."""
    n_rows = len(flange)
    columns = np.zeros((n_rows, 3, 3 * len(present) + 3))
    in_measured = rotation @ turned
    for k in range(len(present)):
        columns[target == k, :, 3 * k : 3 * k + 3] = in_measured[target == k]
    columns[:, :, -3:] = np.eye(3)
    away = measured - flange @ rotation.T
    mean = away.mean(axis=0)
    solution = np.linalg.lstsq(columns.reshape(3 * n_rows, -1), (away - mean).ravel(), rcond=1e-9)[0]
    tools = np.full((n_tools, 3), np.nan)
    tools[present] = solution[:-3].reshape(-1, 3)
    return Placement(rotation, solution[-3:] + mean, tools)
