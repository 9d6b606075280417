"""Where base and tools stand: an arm's points brought onto measured ones, from closed-form starts anywhere in space."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from armscope.core.rotations import cross_matrices, turned_by
from armscope.core.sampling import in_one_stretch
from armscope.core.types import Array, Indices
from armscope.fitting.constants import STEPS
from armscope.fitting.gauge import FrameColumns, gauge
from armscope.fitting.gauss_newton import FitResult, NonlinearProblem, Quadratic, gauss_newton
from armscope.measurement import robust


def rigid_motion(points: Array, measured: Array) -> tuple[Array, Array]:
    """Rotation (3, 3) and translation (3,) that bring ``points`` (N, 3) near ``measured`` (N, 3): a robust start.

    The least-squares rotation (Kabsch 1976) of the points about the medians of their coordinates, which a few wild rows
    hardly move. As these do not turn with the points, it is near the least-squares motion but is not that itself.
    """
    here, there = np.median(points, axis=0), np.median(measured, axis=0)
    if len(points) < 2:
        return np.eye(3), there - here
    rotation = nearest_rotation((measured - there).T @ (points - here))  # a line leaves a turn open: any is a start
    return rotation, there - rotation @ here


def nearest_rotation(matrix: Array) -> Array:
    """(3, 3) the rotation R with the largest trace of R' matrix, by its singular vectors (Kabsch 1976)."""
    left, _, right = np.linalg.svd(matrix)
    return np.asarray((left * [1.0, 1.0, np.sign(np.linalg.det(left @ right)) or 1.0]) @ right)


@dataclass(frozen=True, eq=False)
class Frames:
    """Where R bases and K tools stand."""

    rotations: Array  # (R, 3, 3) m, measurement frame from arm base
    translations: Array  # (R, 3) m, measurement frame from arm base
    tools: Array  # (K, 3) offsets in the last frame, m

    def moved(self, step: Array) -> Frames:
        """A step further: twists (translation, rotation) of the bases in their own axes, then the tools' offsets."""
        twists = step[: 6 * len(self.rotations)].reshape(-1, 6)
        return Frames(
            self.rotations @ turned_by(twists[:, 3:]),
            self.translations + np.einsum("rij,rj->ri", self.rotations, twists[:, :3]),
            self.tools + step[6 * len(self.rotations) :].reshape(-1, 3),
        )


@dataclass(frozen=True, eq=False)
class FlangePoses:
    """N poses of an arm's flange and the points measured there."""

    origin: Array  # (N, 3) m
    turned: Array  # (N, 3, 3) what the tools' offsets are counted from, in the arm's base frame
    measured: Array  # (N, 3) m, measurement frame
    # base, tool: (N,) numbers of each row's base and tool
    base: Indices
    tool: Indices

    def points(self, tools: Array) -> Array:
        """(N, 3) the tool points in the arm's base frame, m."""
        return np.asarray(self.origin + np.einsum("nij,nj->ni", self.turned, tools[self.tool]))

    def start(self, tools: Array, n_bases: int) -> Frames:
        """Every base by the rigid motion that its rows ask for, with the tools where they are said to be."""
        rotations, translations = np.tile(np.eye(3), (n_bases, 1, 1)), np.zeros((n_bases, 3))
        points = self.points(tools)
        for base in np.unique(self.base):
            rows = self.base == base
            rotations[base], translations[base] = rigid_motion(points[rows], self.measured[rows])
        return Frames(rotations, translations, tools)

    def start_of_far_tools(self, tools: Array, n_bases: int) -> Frames | None:
        """Bases and tools together, wherever the tools are; None where the rows of all bases are too few for that.

        Linear equations: measured = R flange + sum_k (R (x) tool_k) turned + t, with R made a rotation afterwards.
        Fails where the poses hardly turn; a tool that several bases share starts at the mean.
        """
        usual = self.start(tools, n_bases)
        rotations, translations = usual.rotations, usual.translations
        sums, counts = np.zeros_like(tools), np.zeros((len(tools), 1))
        for base in np.unique(self.base):
            rows = self.base == base
            present, tool = np.unique(self.tool[rows], return_inverse=True)
            found = _linear_start(self.origin[rows], self.turned[rows], tool, self.measured[rows])
            if found is not None:
                rotations[base], translations[base] = found[:2]
                sums[present] += found[2]
                counts[present] += 1
        if not counts.any():
            return None
        return Frames(rotations, translations, np.where(counts > 0, sums / np.maximum(counts, 1), tools))


def _linear_start(origin: Array, turned: Array, tool: Indices, measured: Array) -> tuple[Array, Array, Array] | None:
    """Rotation, translation and tools (k, 3) of one base, ``tool`` (N,) being numbered from 0 to k - 1."""
    n_rows, n_tools = len(origin), int(tool.max()) + 1
    by_tool = np.zeros((n_rows, n_tools, 9))
    by_tool[np.arange(n_rows), tool] = turned.reshape(n_rows, 9)
    columns = np.column_stack([origin - origin.mean(axis=0), by_tool.reshape(n_rows, -1), np.ones(n_rows)])
    if n_rows < columns.shape[1]:
        return None
    rotation = nearest_rotation(np.linalg.lstsq(columns, measured, rcond=1e-9)[0][:3].T)
    # translation and tools for a known rotation: of smallest size where not determined
    beside = np.zeros((n_rows, 3, n_tools + 1, 3))
    beside[np.arange(n_rows), :, tool] = rotation @ turned
    beside[:, :, -1] = np.eye(3)
    away = measured - origin @ rotation.T
    mean = away.mean(axis=0)
    solution = np.linalg.lstsq(beside.reshape(3 * n_rows, -1), (away - mean).ravel(), rcond=1e-9)[0].reshape(-1, 3)
    return rotation, solution[-1] + mean, solution[:-1]


def frame_columns(points: Array, turned: Array, base: Indices, tool: Indices, counts: tuple[int, int]) -> Array:
    """(N, 3, 6 R + 3 K) displacement of tool points by unit twists of R bases and shifts of K tools, base axes.

    Args:
        points, turned: (N, 3), (N, 3, 3) tool points and the last frame's rotations.
        base, tool: (N,) numbers of each row's base and tool.
        counts: (R, K).

    Returns:
        (N, 3, 6 R + 3 K) m per m or rad.
    """
    n_bases, n_tools = counts
    if counts == (1, 1):
        return _columns_of_one_frame(points, turned)
    rows, axes = np.arange(len(points))[:, None], np.arange(3)
    x, y, z = points.T
    columns = np.zeros((len(points), 3, 6 * n_bases + 3 * n_tools))
    columns[rows, axes, 6 * base[:, None] + axes] = 1.0
    for axis, turn, moved in ((1, 3, -z), (2, 3, y), (0, 4, z), (2, 4, -x), (0, 5, -y), (1, 5, x)):  # axis x tool
        columns[rows[:, 0], axis, 6 * base + turn] = moved
    for axis in range(3):
        columns[rows, axis, 6 * n_bases + 3 * tool[:, None] + axes] = turned[:, axis]
    return columns


def _columns_of_one_frame(points: Array, turned: Array) -> Array:
    """(N, 3, 9) the same where all rows share base and tool: nothing has to be looked up."""
    columns = np.zeros((len(points), 3, 9))
    for axis in range(3):
        columns[:, axis, axis] = 1.0
    columns[:, :, 3:6] = cross_matrices(-points)  # axis x tool
    columns[:, :, 6:] = turned
    return columns


class _Placement(NonlinearProblem[Frames, Array]):
    """Bases and tools of a rigid arm; residuals (N, 3) m in the axes of each row's base."""

    least_damping = 1e-9
    """A held wrist leaves the tool's offset to the base: one step then takes it no farther than it must."""

    def __init__(self, poses: FlangePoses, weigh: Callable[[Array], Array]) -> None:
        self.poses, self.weigh = poses, weigh
        self.weights = np.ones(len(poses.base))
        self._last: tuple[Frames, Array] | None = None
        self._squared: tuple[Array, Array] | None = None

    def residual(self, state: Frames) -> Array:
        base = self.poses.base
        back = np.swapaxes(state.rotations, 1, 2)[base]
        seen = np.einsum("nij,nj->ni", back, self.poses.measured - state.translations[base])
        return np.asarray(seen - self._points(state))

    def _points(self, state: Frames) -> Array:
        """(N, 3) tool points; a step asks for them twice."""
        if self._last is None or self._last[0] is not state:
            self._last = state, self.poses.points(state.tools)
        return self._last[1]

    def quadratic(self, state: Frames, residual: Array) -> Quadratic:
        self.weights = self.weigh(residual)
        points, turned = self._points(state), self.poses.turned
        n_bases, n_tools = len(state.rotations), len(state.tools)
        right = np.zeros(6 * n_bases + 3 * n_tools)
        matrix = np.zeros((len(right), len(right)))
        for base, tool, rows in self.together:
            at = np.concatenate([6 * base + np.arange(6), 6 * n_bases + 3 * tool + np.arange(3)])
            X = _columns_of_one_frame(points[rows], turned[rows]).reshape(-1, len(at))
            weighted = X * np.repeat(self.weights[rows], 3)[:, None]
            matrix[at[:, None], at] += weighted.T @ X
            right[at] += weighted.T @ residual[rows].reshape(-1)
        return Quadratic(matrix, right, np.zeros(len(right)))

    @functools.cached_property
    def together(self) -> list[tuple[int, int, slice | Indices]]:
        """(base, tool, rows) of rows whose columns are their base's and their tool's alone, some at a time."""
        base, tool = self.poses.base, self.poses.tool
        pair = base * (int(tool.max(initial=0)) + 1) + tool
        order = np.argsort(pair, kind="stable")
        kinds = np.split(order, np.flatnonzero(np.diff(pair[order])) + 1) if len(order) else []
        return [
            (int(base[rows[0]]), int(tool[rows[0]]), in_one_stretch(rows[start : start + STEPS.chunk_rows]))
            for rows in kinds
            for start in range(0, len(rows), STEPS.chunk_rows)
        ]

    def misfit(self, state: Frames, residual: Array) -> float:
        if self._squared is None or self._squared[0] is not residual:
            self._squared = residual, np.sum(residual**2, axis=1)
        return float(self.weights @ self._squared[1])

    def moved(self, state: Frames, step: Array) -> Frames:
        return state.moved(step)

    def settled(self, before: Array, after: Array) -> bool:
        return float(np.abs(after - before).max()) < STEPS.negligible_m


def all_alike(residual: Array) -> Array:
    """(N,) ones: weights by which every row counts the same."""
    return np.ones(len(residual))


def place_frames(
    poses: FlangePoses, start: Frames, most_steps: int, weigh: Callable[[Array], Array], stated: Array
) -> FitResult[Frames, Array]:
    """Bases and tools together, refined from a start; rows weighed by what is left of them (N, 3), m.

    Where rows do not tell a tool from the base it stays as stated, wherever the start took it.

    Args:
        poses: the last frame in N rows, and what was measured.
        start: bases and tools to start from.
        most_steps: after so many steps the fit stops where it is.
        weigh: (N, 3) m to (N,) weights.
        stated: (K, 3) the tools as stated, m.

    Returns:
        Bases and tools, and what is left, m.
    """
    problem = _Placement(poses, weigh)
    found = gauss_newton(problem, start, most_steps)
    information = 1e6 * problem.quadratic(found.state, found.residual).matrix
    noise_mm = 1e3 * robust.scale_of(found.residual) if len(found.residual) else 0.0
    every = np.arange(len(information))
    at = FrameColumns(every, every[6 * len(start.rotations) :])
    held = gauge(information, information, at, (found.state.tools - stated).reshape(-1), noise_mm)
    if held is None:
        return found
    state = found.state.moved(held.step)
    return replace(found, state=state, residual=problem.residual(state))
