"""What a recordings table holds, without asking any model: counts, ranges, gaps, repeats."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armscope.check.constants import TABLE
from armscope.core.types import Array
from armscope.recordings import Recordings
from armscope.recordings.motion import moving


@dataclass(frozen=True)
class RunContents:
    """One run: its rows, configurations (ids), targets, motors that move, and the extent of its measured points, m.

    ``flatness``: scatter of the points across the plane that holds them best, as a share of the largest scatter.
    """

    name: str
    rows: int
    configurations: int
    targets: tuple[str, ...]
    moved: tuple[int, ...]
    extent: tuple[float, float, float]
    flatness: float


@dataclass(frozen=True)
class Coverage:
    """Range of one motor, rad; ``moved`` says whether it is more than servo noise."""

    motor: int
    low: float
    high: float
    moved: bool


@dataclass(frozen=True)
class Context:
    """One recorded context quantity: rows without a value, and its range over the rest, in the table's unit."""

    name: str
    unit: str
    missing: int
    low: float
    high: float

    @property
    def constant(self) -> bool:
        """Whether it never changes, so that nothing shows what changes with it."""
        return self.low == self.high


@dataclass(frozen=True)
class Repeats:
    """Poses that were measured more than once."""

    copies: int  # rows that repeat another row's angles and position to the last digit
    visits: int  # poses visited again (apart from copies), as many groups
    rows: int  # rows in these groups
    scatter: float  # RMS per axis about each group's mean, m; NaN without groups
    looked_at: int  # how many rows were looked at (very long tables: the first ones)


@dataclass(frozen=True)
class Contents:
    """What a table holds."""

    source: str
    rows: int
    runs: tuple[RunContents, ...]
    motors: tuple[Coverage, ...]
    context: tuple[Context, ...]
    repeats: Repeats
    notes: tuple[str, ...]


def contents_of(recordings: Recordings) -> Contents:
    """Count what a table holds."""
    return Contents(
        source=recordings.source,
        rows=len(recordings),
        runs=tuple(_run(recordings, name) for name in dict.fromkeys(recordings.run.tolist())),
        motors=tuple(_coverage(recordings, motor) for motor in range(recordings.n_motors)),
        context=tuple(_context(recordings)),
        repeats=_repeats(recordings),
        notes=recordings.notes,
    )


def _run(recordings: Recordings, name: str) -> RunContents:
    rows = recordings.run == name
    points = recordings.positions[rows]
    extent, scatter = np.ptp(points, axis=0), np.linalg.eigvalsh(np.cov(points.T, bias=True))
    moved = np.flatnonzero(moving(recordings.motor_angles[rows])) + 1
    return RunContents(
        name=name,
        rows=int(rows.sum()),
        configurations=len(np.unique(recordings.id[rows])),
        targets=tuple(target for target in dict.fromkeys(recordings.target[rows].tolist()) if target),
        moved=tuple(moved.tolist()),
        extent=(float(extent[0]), float(extent[1]), float(extent[2])),
        flatness=float(np.sqrt(max(scatter[0], 0.0) / max(scatter[2], 1e-30))),
    )


def _coverage(recordings: Recordings, motor: int) -> Coverage:
    angles = recordings.motor_angles[:, motor]
    return Coverage(motor + 1, float(angles.min()), float(angles.max()), bool(moving(angles[:, None])[0]))


def _context(recordings: Recordings) -> list[Context]:
    named: list[tuple[str, str, Array | None]] = [
        ("time", "s", recordings.time),
        ("temperature", "degC", recordings.temperature),
        ("payload", "kg", recordings.payload),
        ("orientation", "", recordings.quaternions[:, 0]),
    ]
    for name, unit, values in (
        ("approach", "", recordings.approach),
        ("speed", "rad/s", recordings.speed),
        ("torque", "N m", recordings.torque),
    ):
        if values is not None:
            named += [(f"{name} {motor + 1}", unit, values[:, motor]) for motor in range(recordings.n_motors)]
    if recordings.sigma is not None:
        named += [(f"sigma {axis}", "mm", recordings.sigma[:, k] * 1e3) for k, axis in enumerate("xyz")]
    # one run of a table may hold nothing in a column that another has
    recorded = ((name, unit, values) for name, unit, values in named if values is not None)
    return [_one_context(*each) for each in recorded if np.isfinite(each[2]).any()]


def _one_context(name: str, unit: str, values: Array) -> Context:
    known = values[np.isfinite(values)]
    return Context(name, unit, len(values) - len(known), float(known.min()), float(known.max()))


def _repeats(recordings: Recordings) -> Repeats:
    looked_at = min(len(recordings), TABLE.rows_for_repeats)
    some = recordings.rows(slice(looked_at))
    _, group = np.unique(np.char.add(some.run, np.char.add("\n", some.target)), return_inverse=True)
    rows = np.column_stack([group, some.motor_angles, some.positions])
    _, first = np.unique(rows, axis=0, return_index=True)
    copies = looked_at - len(first)
    single = np.sort(first)
    # rows of other runs and targets stand far away, so that they are never neighbours
    pairs = close_pairs(np.column_stack([group[single] * 100.0, some.motor_angles[single]]), TABLE.same_pose)
    if not len(pairs):
        return Repeats(copies, 0, 0, float("nan"), looked_at)
    from scipy.sparse import coo_array  # these take long to import, and are seldom needed
    from scipy.sparse.csgraph import connected_components

    links = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(len(single), len(single)))
    _, label = connected_components(links, directed=False)
    size = np.bincount(label)
    again = size[label] > 1
    positions, label = some.positions[single][again], label[again]
    sums = np.stack([np.bincount(label, weights=positions[:, axis], minlength=len(size)) for axis in range(3)], axis=1)
    about_mean = positions - sums[label] / size[label, None]
    visits = int((size > 1).sum())
    scatter = float(np.sqrt(np.sum(about_mean**2) / (3 * (len(positions) - visits))))
    return Repeats(copies, visits, len(positions), scatter, looked_at)


def close_pairs(points: Array, reach: float) -> NDArray[np.intp]:
    """(K, 2) pairs of points (N, d) that lie within ``reach`` of each other.

    Neighbours are neighbours in any direction: of the points in the order of one, few need to be looked at. Where many
    do, as in poses on a grid, a tree finds them.
    """
    direction = np.random.default_rng(0).normal(size=points.shape[1])
    along = points @ (direction / np.linalg.norm(direction))
    order = np.argsort(along, kind="stable")
    # rounding must not lose a pair at the very edge
    end = np.searchsorted(along[order], along[order] + reach * (1 + 1e-9) + 1e-12 * np.abs(along).max(), side="right")
    count = end - np.arange(len(points)) - 1
    if count.sum() > TABLE.candidates * len(points):
        from scipy.spatial import cKDTree  # slow to import

        return np.asarray(cKDTree(points).query_pairs(reach, output_type="ndarray"))
    first = np.repeat(np.arange(len(points)), count)
    second = first + 1 + np.arange(len(first)) - np.repeat(np.cumsum(count) - count, count)
    pairs = np.column_stack([order[first], order[second]])
    apart = np.linalg.norm(points[pairs[:, 0]] - points[pairs[:, 1]], axis=1)
    return np.sort(pairs[apart <= reach], axis=1)
