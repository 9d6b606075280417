"""What was measured minus what the model says, along each joint's motion."""

from __future__ import annotations

from collections.abc import Iterator

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from armscope.core.sampling import spread_evenly
from armscope.core.types import Array
from armscope.recordings.motion import moving
from armscope.report.style import BLACK, BLUE, VERMILION, legend_above, styled
from armscope.report.subject import Drawn, Subject
from armscope.robot import chain, position_jacobian

MOST_DOTS = 1500
MOST_ROWS = 20_000
"""Running means along the joints need no more rows than this."""
WINDOWS = 12
"""The running mean along an angle has so many windows over its range."""


def along_joints_figure(subject: Subject) -> Iterator[Drawn]:
    """The residual along each joint's motion against its angle, where one moves."""
    rows = spread_evenly(len(subject.recordings), MOST_ROWS)
    angles, residuals = subject.recordings.motor_angles[rows], subject.verdict.residuals
    if moving(angles).any():
        jacobian = position_jacobian(subject.arm, chain(subject.arm, angles))
        drawn = draw_along_joints(angles, jacobian, residuals.before[rows], residuals.after[rows])
        yield Drawn("along_joints", drawn, "Residual along each joint's motion against its angle, before and after")


def draw_along_joints(motor_angles: Array, jacobian: Array, before: Array, after: Array) -> Figure:
    """The residual along the way that each joint moves the tool, against the joint's angle.

    Args:
        motor_angles: (N, m) rad; joints that never move are left out.
        jacobian: (N, 3, m) displacement of the tool by unit turns of the motors, base axes.
        before, after: (N, 3) residuals in base axes, mm.

    Returns:
        The figure.
    """
    joints = np.flatnonzero(moving(motor_angles))
    shown = spread_evenly(len(motor_angles), MOST_DOTS)
    ways = jacobian / np.maximum(np.linalg.norm(jacobian, axis=1, keepdims=True), 1e-9)
    along = [np.einsum("nci,nc->ni", ways, residual) for residual in (before, after)]
    limit = 1.15 * float(np.percentile(np.abs(along[0]), 99)) + 1e-9
    columns = min(3, len(joints))
    rows = -(-len(joints) // columns)
    dot = float(np.clip(260 / np.sqrt(len(shown)) / 3, 2.5, 12))
    with styled():
        figure, panels = plt.subplots(
            rows, columns, figsize=(2.9 * columns + 0.4, 2.0 * rows + 0.6), sharey=True, squeeze=False
        )
        for panel in panels.flat[len(joints) :]:
            panel.set_visible(False)
        for panel, joint in zip(panels.flat, joints, strict=False):
            angle = np.degrees(motor_angles[:, joint])
            panel.axhline(0, color=BLACK, linewidth=0.6)
            for values, colour, name in zip(along, (VERMILION, BLUE), ("before", "after"), strict=True):
                panel.scatter(angle[shown], values[shown, joint], s=dot, color=colour, alpha=0.35, linewidth=0,
                              rasterized=True)  # fmt: skip
                panel.plot(*running_mean(angle, values[:, joint]), color=colour, linewidth=1.8, label=name)
            panel.set_ylim(-limit, limit)
            panel.set_title(f"joint {joint + 1}")
        figure.supxlabel("angle of the joint (deg)", fontsize=9)
        figure.supylabel("residual along its motion (mm)", fontsize=9)
        legend_above(figure)
    return figure


def running_mean(angle: Array, values: Array) -> tuple[Array, Array]:
    """Means of angle and value in windows of equal numbers of rows."""
    order = np.argsort(angle, kind="stable")
    windows = np.array_split(order, max(2, min(WINDOWS, len(order) // 8)))
    return np.array([angle[w].mean() for w in windows]), np.array([values[w].mean() for w in windows])
