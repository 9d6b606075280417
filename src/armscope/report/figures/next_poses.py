"""Poses to measure next, drawn as small arms."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from armscope.core.types import Array
from armscope.report.colours import AFTER, BEFORE, INK, PAPER, QUIET
from armscope.report.figures.arm_shape import ArmShape, View, arm_shape, view_from
from armscope.report.sectioning import Drawn, Subject
from armscope.report.svg import Drawing
from armscope.robot import Arm

MOST_POSES = 8
ELEVATION = np.radians(12)
WIDE = 210.0  # Of one pose's picture, px


def draw_poses(arm: Arm, motor_angles: Array) -> Drawing:
    """Small drawings of the arm in each pose (at most `MOST_POSES`), each seen from its side, all to one scale.
    ``motor_angles``: (K, m) rad, K >= 1."""
    shapes = [arm_shape(arm, angles) for angles in motor_angles[:MOST_POSES]]
    views = [_from_the_side(shape) for shape in shapes]
    corners = np.vstack([view.flat(shape.points) for view, shape in zip(views, shapes, strict=True)])
    low, high = corners.min(axis=0), corners.max(axis=0)
    scale = (WIDE - 24) / float(np.max(high - low))
    tall = scale * float((high - low)[1]) + 40
    columns = min(4, len(shapes))
    drawing = Drawing(WIDE * columns, tall * -(-len(shapes) // columns), "The arm in the poses to measure next")
    for place, (view, shape) in enumerate(zip(views, shapes, strict=True)):
        corner = np.array([WIDE * (place % columns) + 12, tall * (place // columns + 1) - 10])

        def to(points: Array, view: View = view, corner: Array = corner) -> Array:
            return np.asarray(corner + scale * (view.flat(points) - low) * [1, -1])

        drawing.text((corner[0] + WIDE / 2 - 12, corner[1] - tall + 22), f"pose {place + 1}", anchor="middle")
        drawing.rectangle(tuple(to(np.zeros(3)) - 5), (10, 10), QUIET)
        for _, line in shape.parts:
            drawing.line(to(line), AFTER, 4)
        for centre in shape.centres:
            drawing.circle(to(centre), 3, PAPER, INK)
        tool = to(shape.tool)
        for way in (np.array([6, 0]), np.array([0, 6])):
            drawing.line(np.array([tool - way, tool + way]), BEFORE, 2.4)
    return drawing


def _from_the_side(shape: ArmShape) -> View:
    """From where the tool is at the right of the base."""
    azimuth = np.arctan2(shape.tool[1], shape.tool[0]) - np.pi / 2
    return view_from(float(azimuth), float(ELEVATION))


def next_poses_figure(subject: Subject) -> Iterator[Drawn]:
    """The arm in the poses to measure next, where there are some."""
    poses = subject.verdict.next_poses
    if poses is not None and len(poses.motor_angles):
        yield Drawn("next_poses", draw_poses(subject.arm, poses.motor_angles))
