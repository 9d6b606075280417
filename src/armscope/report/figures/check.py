"""What a recordings table covers: its points in the workspace, and where each joint was."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from scipy.spatial import cKDTree

from armscope.core.types import Array
from armscope.recordings import Recordings
from armscope.report.style import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILION, legend_above, styled
from armscope.robot import Arm, forward_kinematics

RUN_COLOURS = (BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY, BLACK)
BIN_DEG = 10
MOST_POINTS = 4000
FARTHEST_LIMIT_DEG = 400
ONE_POINT = 2e-3  # Points within so many metres of each other are one point in the figure

VISIBLE = 0.01  # Share of the workspace below which points can't be told apart in the figure


def draw_check(recordings: Recordings, arm: Arm | None = None) -> Figure:
    """Points from above and from the side by run, and how many rows each joint has in every 10 degrees.

    Args:
        arm: its robot: points are then drawn where the nominal arm has them, in its base frame, so that runs with
            different measurement frames can be compared, and joint limits are marked. None draws measured points.
    """
    fits = arm is not None and arm.n_motors == recordings.n_motors
    frame = "arm base frame, nominal" if fits else "measurement frame"
    runs = _points_by_run(recordings, arm if fits else None)
    with styled():
        figure = plt.figure(figsize=(8.2, 2.9 + 0.22 * recordings.n_motors))
        panels = figure.subplot_mosaic([["above", "coverage"], ["side", "coverage"]], width_ratios=[1, 1.35])
        for name, (across, up) in (("above", (0, 1)), ("side", (0, 2))):
            _draw_points(panels[name], runs, across, up)
        panels["above"].set_title(f"Tool points ({frame})", loc="left")
        _draw_coverage(figure, panels["coverage"], recordings, arm if fits else None)
        if len(runs) > 1:
            legend_above(figure, [_key(number, run) for number, run in enumerate(runs)])
    return figure


@dataclass(frozen=True)
class _Run:
    """A run's points (N, 3), m, thinned where there are many.

    ``shared``: how many earlier runs have the same points; ``still``: all its points are one, measured again.
    """

    name: str
    points: Array
    shared: int
    still: bool


def _points_by_run(recordings: Recordings, arm: Arm | None) -> list[_Run]:
    step = max(1, len(recordings) // MOST_POINTS)
    found: list[_Run] = []
    for name in dict.fromkeys(recordings.run.tolist()):
        rows = np.flatnonzero(recordings.run == name)[::step]
        points = recordings.positions[rows] if arm is None else forward_kinematics(arm, recordings.motor_angles[rows])
        shared = sum(_mostly_same(points, other.points) for other in found)
        found.append(_Run(name, points, shared, bool(np.ptp(points, axis=0).max() < ONE_POINT)))
    return found


def _mostly_same(points: Array, others: Array) -> bool:
    """Whether most points lie on others, as far as a figure can show, so that these would be hidden."""
    distance, _ = cKDTree(others).query(points)
    return bool(np.median(distance) < VISIBLE * np.ptp(others, axis=0).max())


def _draw_points(panel: Any, runs: list[_Run], across: int, up: int) -> None:
    for number, run in enumerate(runs):
        panel.plot(run.points[:, across], run.points[:, up], **_style(number, run))
    panel.set(xlabel=f"{'xyz'[across]} (m)", ylabel=f"{'xyz'[up]} (m)")
    panel.set_aspect("equal", adjustable="datalim")


def _style(number: int, run: _Run) -> dict[str, Any]:
    """Dots; a diamond for one point; where earlier runs have the same points rings about theirs."""
    look = {"marker": "o", "linestyle": "", "color": RUN_COLOURS[number % len(RUN_COLOURS)], "markeredgewidth": 0.7}
    if run.shared:
        return look | {"markerfacecolor": "none", "markersize": 1.6 + 1.9 * run.shared}
    if run.still:
        return look | {"marker": "D", "markersize": 4.5, "markeredgecolor": "white", "zorder": 3}
    return look | {"markersize": 1.6, "alpha": 0.6}


def _key(number: int, run: _Run) -> Line2D:
    style = _style(number, run)
    plain = style | {"alpha": 1.0, "markersize": max(style["markersize"], 4)}
    return Line2D([], [], label=f"run {run.name}" if run.name.isdigit() else run.name, **plain)


def _draw_coverage(figure: Figure, panel: Any, recordings: Recordings, arm: Arm | None) -> None:
    angles = np.degrees(recordings.motor_angles)
    limits = np.empty((0, 2)) if arm is None else np.degrees(arm.limits)
    shown_limits = limits[np.abs(limits) < FARTHEST_LIMIT_DEG]
    low = BIN_DEG * np.floor(min(-180.0, angles.min(), *shown_limits) / BIN_DEG)
    high = BIN_DEG * np.ceil(max(180.0, angles.max(), *shown_limits) / BIN_DEG)
    edges = np.arange(low, high + BIN_DEG, BIN_DEG)
    counts = np.stack([np.histogram(column, edges)[0] for column in angles.T]).astype(float)
    shown = np.ma.masked_equal(counts, 0)
    motors = np.arange(recordings.n_motors + 1) + 0.5
    image = panel.pcolormesh(edges, motors, shown, cmap="Blues", norm=LogNorm(0.5, max(counts.max(), 2)))
    bar = figure.colorbar(image, ax=panel, label=f"rows per {BIN_DEG} degrees", pad=0.02)
    whole = [step * 10**power for power in range(6) for step in (1, 2, 5) if step * 10**power <= max(counts.max(), 2)]
    bar.set_ticks(whole, labels=[str(count) for count in whole], minor=False)
    bar.set_ticks([], minor=True)
    for motor, of_motor in enumerate(limits, start=1):
        for limit in of_motor[np.abs(of_motor) < FARTHEST_LIMIT_DEG]:
            panel.plot([limit] * 2, [motor - 0.42, motor + 0.42], color=VERMILION, linewidth=2.5, clip_on=False)
    panel.hlines(motors[1:-1], low, high, color=GREY, linewidth=0.5)
    panel.set(xlim=(low, high), ylim=(recordings.n_motors + 0.5, 0.5), xlabel="joint angle (degrees)")
    panel.set_yticks(range(1, recordings.n_motors + 1), [f"q{motor}" for motor in range(1, recordings.n_motors + 1)])
    panel.grid(visible=False)
    panel.set_title("Joint coverage" + (" (vermilion bars: limits)" if len(shown_limits) else ""), loc="left")
