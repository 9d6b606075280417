"""Figs. 5, 8 and 9: a test trajectory in space and the motor angles that follow it."""

from __future__ import annotations

from itertools import cycle

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from armscope.core.types import Array
from armscope.report.style import BLUE, VERMILION, styled


def trajectory(positions: Array, motor_angles: Array) -> Figure:
    """Figs. 5, 8, 9: a path in space (left) and the motor angles that follow it (right).

    Args:
        positions: (N, 3) nominal tool points in the base frame, mm.
        motor_angles: (N, m) rad.
    """
    with styled():
        figure = plt.figure(figsize=(10, 4.4))
        grid = figure.add_gridspec(1, 2, width_ratios=(1.1, 1))
        space = figure.add_subplot(grid[0], projection="3d")
        space.plot(*positions.T, color=BLUE)
        space.scatter(*positions[0], color=VERMILION, s=25, label="start", depthshade=False)
        space.set_xlabel("x (mm)", labelpad=6)
        space.set_ylabel("y (mm)", labelpad=6)
        space.set_zlabel("z (mm)", labelpad=8)
        space.set_box_aspect((4, 4, 3), zoom=0.85)
        space.locator_params(nbins=5)
        space.legend(loc="upper left")
        joints = figure.add_subplot(grid[1])
        styles = ("-", "--", "-.", ":", (0, (5, 1)), (0, (1, 1)))
        points = np.arange(1, len(motor_angles) + 1)
        for style, (label, angles) in zip(cycle(styles), _joined(motor_angles)):
            joints.plot(points, angles, linestyle=style, label=label)
        joints.set(xlabel="target point", ylabel="motor angle (rad)")
        joints.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    return figure


def _joined(motor_angles: Array) -> list[tuple[str, Array]]:
    """Label and (N,) angles of each motor; motors with the same angles throughout, such as theta4 = theta5, as one."""
    lines: list[tuple[str, Array]] = []
    for motor, angles in enumerate(motor_angles.T, start=1):
        name = f"$\\theta_{motor}$"
        same = next((k for k, (_, others) in enumerate(lines) if np.array_equal(others, angles)), None)
        if same is None:
            lines.append((name, angles))
        else:
            lines[same] = (f"{lines[same][0]} = {name}", angles)
    return lines
