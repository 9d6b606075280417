"""What a recordings table covers: its points in the workspace, and where each joint was."""

from __future__ import annotations

from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from armscope.recordings import Recordings
from armscope.report.style import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILION, legend_above, styled
from armscope.robot import Arm, forward_kinematics

Array = NDArray[np.float64]

RUN_COLOURS = (BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY, BLACK)
BIN_DEG = 10
MOST_POINTS = 4000


def draw_check(recordings: Recordings, arm: Arm | None = None) -> Figure:
    """Points from above and from the side by run, and how many rows each joint has in every 10 degrees.

    Args:
        recordings: the table.
        arm: its robot: points are then drawn where the nominal arm has them, in its base frame, so that runs with
            different measurement frames can be compared, and joint limits are marked. None draws measured points.
    """
    fits = arm is not None and arm.n_motors == recordings.n_motors
    points = forward_kinematics(arm, recordings.motor_angles) if arm is not None and fits else recordings.positions
    frame = "arm base frame, nominal" if fits else "measurement frame"
    with styled():
        figure = plt.figure(figsize=(8.2, 2.9 + 0.22 * recordings.n_motors))
        panels = figure.subplot_mosaic([["above", "coverage"], ["side", "coverage"]], width_ratios=[1, 1.35])
        for name, (across, up) in (("above", (0, 1)), ("side", (0, 2))):
            _draw_points(panels[name], recordings, points, across, up)
        panels["above"].set_title(f"Tool points ({frame})", loc="left")
        _draw_coverage(figure, panels["coverage"], recordings, arm if fits else None)
        runs = list(dict.fromkeys(recordings.run.tolist()))
        if len(runs) > 1:
            legend_above(
                figure, [Line2D([], [], marker="o", linestyle="", color=_colour(k)) for k in range(len(runs))], runs
            )
    return figure


def _draw_points(panel: Any, recordings: Recordings, points: Array, across: int, up: int) -> None:
    step = max(1, len(points) // MOST_POINTS)
    for number, run in enumerate(dict.fromkeys(recordings.run.tolist())):
        rows = np.flatnonzero(recordings.run == run)[::step]
        panel.plot(points[rows, across], points[rows, up], ".", color=_colour(number), markersize=2.5, alpha=0.6)
    panel.set(xlabel=f"{'xyz'[across]} (m)", ylabel=f"{'xyz'[up]} (m)")
    panel.set_aspect("equal", adjustable="datalim")


def _colour(run: int) -> str:
    return RUN_COLOURS[run % len(RUN_COLOURS)]


def _draw_coverage(figure: Figure, panel: Any, recordings: Recordings, arm: Arm | None) -> None:
    angles = np.degrees(recordings.motor_angles)
    low = BIN_DEG * np.floor(min(-180.0, angles.min()) / BIN_DEG)
    high = BIN_DEG * np.ceil(max(180.0, angles.max()) / BIN_DEG)
    edges = np.arange(low, high + BIN_DEG, BIN_DEG)
    counts = np.stack([np.histogram(column, edges)[0] for column in angles.T]).astype(float)
    shown = np.ma.masked_equal(counts, 0)
    motors = np.arange(recordings.n_motors + 1) + 0.5
    image = panel.pcolormesh(edges, motors, shown, cmap="Blues", norm=LogNorm(0.5, max(counts.max(), 2)))
    bar = figure.colorbar(image, ax=panel, label=f"rows per {BIN_DEG} degrees", pad=0.02)
    whole = [step * 10**power for power in range(6) for step in (1, 2, 5) if step * 10**power <= max(counts.max(), 2)]
    bar.set_ticks(whole, labels=[str(count) for count in whole], minor=False)
    bar.set_ticks([], minor=True)
    if arm is not None:
        for motor, limits in enumerate(np.degrees(arm.limits), start=1):
            for limit in limits[np.isfinite(limits) & (limits >= low) & (limits <= high)]:
                panel.plot([limit, limit], [motor - 0.42, motor + 0.42], color=VERMILION, linewidth=2.5)
    panel.hlines(motors[1:-1], low, high, color=GREY, linewidth=0.5)
    panel.set(xlim=(low, high), ylim=(recordings.n_motors + 0.5, 0.5), xlabel="joint angle (degrees)")
    panel.set_yticks(range(1, recordings.n_motors + 1), [f"q{motor}" for motor in range(1, recordings.n_motors + 1)])
    panel.grid(visible=False)
    limits_drawn = arm is not None and np.isfinite(arm.limits).any()
    panel.set_title("Joint coverage" + (" (vermilion bars: limits)" if limits_drawn else ""), loc="left")
