"""What was measured minus what the model says, along each joint's motion."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from armscope.core.sampling import spread_evenly
from armscope.core.types import Array
from armscope.recordings.motion import moving
from armscope.report.colours import AFTER, BEFORE
from armscope.report.sectioning import Drawn, Subject
from armscope.report.svg import Drawing, Panel
from armscope.robot import chain, position_jacobian

MOST_DOTS = 400
WIDE, HIGH = 290.0, 190.0  # Of one joint's panel, px
MOST_ROWS = 20_000  # Running means along the joints need no more rows than this
WINDOWS = 12  # The running mean along an angle has so many windows over its range


def along_joints_figure(subject: Subject) -> Iterator[Drawn]:
    """The residual along each joint's motion against its angle, where one moves."""
    rows = spread_evenly(len(subject.recordings), MOST_ROWS)
    angles, residuals = subject.recordings.motor_angles[rows], subject.verdict.residuals
    if moving(angles).any():
        jacobian = position_jacobian(subject.arm, chain(subject.arm, angles))
        drawn = draw_along_joints(angles, jacobian, residuals.before[rows], residuals.after[rows])
        yield Drawn("along_joints", drawn)


def draw_along_joints(motor_angles: Array, jacobian: Array, before: Array, after: Array) -> Drawing:
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
    alt = "Residual along each joint's motion against its angle, before and after"
    drawing = Drawing(56 + WIDE * columns, HIGH * -(-len(joints) // columns) + 26, alt)
    for place, joint in enumerate(joints):
        angle = np.degrees(motor_angles[:, joint])
        corner = 56 + WIDE * (place % columns), 24 + HIGH * (place // columns)
        panel = Panel(drawing, *corner, WIDE - 16, HIGH - 52, (angle.min(), angle.max()), (-limit, limit))
        label = "residual along its motion (mm)" if place == 0 else ""
        panel.frame(f"joint {joint + 1}", "angle (deg)", label, y_ticks=place % columns == 0)
        for values, colour in zip(along, (BEFORE, AFTER), strict=True):
            drawing.dots(panel.at(angle[shown], values[shown, joint]), colour, 2.2, 0.45)
            drawing.line(panel.at(*running_mean(angle, values[:, joint])), colour, 2.2, 1)
    for x, colour, name in ((56.0, BEFORE, "before"), (150.0, AFTER, "after")):
        drawing.line(np.array([[x, drawing.height - 9], [x + 22, drawing.height - 9]]), colour, 2.4)
        drawing.text((x + 28, drawing.height - 9), name)
    return drawing


def running_mean(angle: Array, values: Array) -> tuple[Array, Array]:
    """Means of angle and value in windows of equal numbers of rows."""
    order = np.argsort(angle, kind="stable")
    windows = np.array_split(order, max(2, min(WINDOWS, len(order) // 8)))
    return np.array([angle[w].mean() for w in windows]), np.array([values[w].mean() for w in windows])
