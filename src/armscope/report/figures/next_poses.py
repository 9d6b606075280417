"""Poses to measure next, drawn as small arms."""

from __future__ import annotations

from collections.abc import Iterator

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from armscope.core.types import Array
from armscope.report.figures.arm_shape import ArmShape, View, arm_shape, view_from
from armscope.report.style import BLACK, BLUE, GREY, VERMILION, styled
from armscope.report.subject import Drawn, Subject
from armscope.robot import Arm

MOST_POSES = 8
ELEVATION = np.radians(12)


def draw_poses(arm: Arm, motor_angles: Array) -> Figure:
    """Small drawings of the arm in each pose (at most `MOST_POSES`), each seen from its side, all to one scale.

    Args:
        arm: the arm.
        motor_angles: (K, m) rad, K >= 1.
    """
    shapes = [arm_shape(arm, angles) for angles in motor_angles[:MOST_POSES]]
    views = [_from_the_side(shape) for shape in shapes]
    corners = np.vstack([view.flat(shape.points) for view, shape in zip(views, shapes, strict=True)])
    low, high = corners.min(axis=0), corners.max(axis=0)
    tall = float(np.clip((high - low)[1] / (high - low)[0], 0.5, 1.8))
    margin = 0.08 * float(np.max(high - low))
    columns = min(4, len(shapes))
    rows = -(-len(shapes) // columns)
    with styled():
        figure, panels = plt.subplots(rows, columns, figsize=(2.1 * columns, rows * (0.3 + 2.1 * tall)), squeeze=False)
        for panel in panels.flat:
            panel.set_axis_off()
        for number, (panel, view, shape) in enumerate(zip(panels.flat, views, shapes, strict=False), start=1):
            for _, line in shape.parts:
                panel.plot(*view.flat(line).T, color=BLUE, linewidth=3.2, solid_capstyle="round", zorder=2)
            panel.plot(*view.flat(shape.centres).T, "o", color="white", markeredgecolor=BLACK, markersize=4, zorder=3)
            panel.plot(*view.flat(shape.tool), "P", color=VERMILION, markersize=6, zorder=4)
            panel.plot(*view.flat(np.zeros(3)), "s", color=GREY, markersize=8, zorder=1)
            panel.set_title(f"pose {number}")
            panel.set(xlim=(low[0] - margin, high[0] + margin), ylim=(low[1] - margin, high[1] + margin))
            panel.set_aspect("equal")
    return figure


def _from_the_side(shape: ArmShape) -> View:
    """From where the tool is at the right of the base."""
    azimuth = np.arctan2(shape.tool[1], shape.tool[0]) - np.pi / 2
    return view_from(float(azimuth), float(ELEVATION))


def next_poses_figure(subject: Subject) -> Iterator[Drawn]:
    """The arm in the poses to measure next, where there are some."""
    poses = subject.verdict.next_poses
    if poses is not None and len(poses.motor_angles):
        yield Drawn("next_poses", draw_poses(subject.arm, poses.motor_angles), "The arm in the poses to measure next")
