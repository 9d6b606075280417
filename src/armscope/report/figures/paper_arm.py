"""Figs. 1 and 2: the virtual arm with its D-H lengths and parallelogram, and how it is measured."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from armscope.core.types import Array
from armscope.paper.measurements import PoseSet
from armscope.report.figures.arm_shape import ArmShape, arm_shape
from armscope.report.style import BLACK, BLUE, GREEN, GREY, ORANGE, VERMILION, styled
from armscope.robot import Arm

LEAST_MM = 1.0  # Lengths below this are not drawn
BENT_DEG = (0, 20, -25, 0, 0, 0)  # Motor angles under which the parallelogram is open and no piece covers another


def arm_with_frames(arm: Arm) -> Figure:
    """Fig. 1: the arm from the side, its D-H lengths in mm, and the parallelogram."""
    shape = arm_shape(arm, np.radians(BENT_DEG) if arm.n_motors == len(BENT_DEG) else np.zeros(arm.n_motors))
    with styled():
        figure, panel = plt.subplots(figsize=(7.4, 5.6))
        if shape.rod is not None:
            rod = 1e3 * shape.rod
            panel.plot(rod[:, 0], rod[:, 2], "o-", color=GREEN, markersize=4, linewidth=2, label="parallelogram")
        for number, (location, line) in enumerate(shape.parts):
            points = 1e3 * line
            tool = location == "tool"
            panel.plot(
                points[:, 0], points[:, 2], color=ORANGE if tool else BLACK, linewidth=3, solid_capstyle="round",
                label={0: "links", len(shape.parts) - 1: "L-shaped holder of the reflector"}.get(number),
            )  # fmt: skip
        centres = 1e3 * shape.centres
        panel.plot(centres[:, 0], centres[:, 2], "o", color="white", markeredgecolor=BLACK, markersize=9, zorder=3)
        for place, names in _together(centres):
            panel.annotate(
                names, (place[0], place[2]), xytext=(-8, 8), textcoords="offset points", color=BLUE, ha="right"
            )
        _lengths(panel, arm, shape)
        panel.plot(*(1e3 * shape.tool[[0, 2]]), "*", color=VERMILION, markersize=13, label="reflector", zorder=4)
        panel.axhline(0, color=GREY, linewidth=1)
        panel.set(xlabel="x (mm)", ylabel="z (mm)", aspect="equal")
        panel.margins(0.22, 0.12)
        figure.legend(loc="outside upper center", ncols=4)
    return figure


def _together(centres: Array) -> list[tuple[Array, str]]:
    """Joints whose discs coincide in the side view share a label."""
    places: list[tuple[Array, list[int]]] = []
    for number, centre in enumerate(centres, start=1):
        near = next((names for at, names in places if np.linalg.norm((at - centre)[[0, 2]]) < 40), None)
        if near is None:
            places.append((centre, [number]))
        else:
            near.append(number)
    return [(at, ", ".join(f"$\\theta_{number}$" for number in names)) for at, names in places]


def _lengths(panel: Axes, arm: Arm, shape: ArmShape) -> None:
    """The D-H lengths beside the pieces of the centre line that they are; the rod runs to the right of link 2."""
    description = arm.description.dh
    if description is None:
        return
    for number, row in enumerate(description.joints, start=1):
        line = 1e3 * dict(shape.parts)[f"link {number}"]
        side = -1 if number == 2 and shape.rod is not None else 1
        for (start, end), name, length in zip(
            ((line[0], line[1]), (line[1], line[2])), (f"d_{number}", f"a_{number}"), (row.d_mm, row.a_mm), strict=True
        ):
            if abs(length) >= LEAST_MM:
                _beside(panel, start, end, f"${name}$ = {length:g}", side)
    start, end = 1e3 * dict(shape.parts)["tool"]
    _beside(panel, start, end, f"{1e3 * np.linalg.norm(arm.tool):g}")


def _beside(panel: Axes, start: Array, end: Array, text: str, side: int = 1) -> None:
    """A label to the right of a piece or below it (``side`` -1: to its left); of a level piece, before its start."""
    along = (end - start)[[0, 2]]
    normal = np.array([along[1], -along[0]]) / np.linalg.norm(along)
    if normal[0] - normal[1] < 0:
        normal = -normal
    at, offset, across = (start + end)[[0, 2]] / 2, 11 * side * normal, "left" if side > 0 else "right"
    if abs(along[1]) < 0.05 * abs(along[0]):
        at, offset, across = start[[0, 2]], np.array([-8.0, 0.0]), "right"
    down = "top" if abs(along[1]) < abs(along[0]) and across == "left" else "center"
    panel.annotate(
        text, tuple(at), xytext=tuple(offset), textcoords="offset points", fontsize=8, ha=across, va=down, zorder=5
    )


def measuring_setup(arm: Arm, poses: PoseSet, tracker_mm: Array) -> Figure:
    """Fig. 2: arm, reflector at the identification positions, and the laser tracker with its beam.

    Args:
        arm: the nominal arm.
        poses: identification poses.
        tracker_mm: (3,) where the tracker stands, base frame.

    Returns:
        The figure.
    """
    row = int(np.argmax(poses.nominal_mm[:, 0]))
    shape = arm_shape(arm, poses.motor_angles[row])
    with styled():
        figure = plt.figure(figsize=(7.4, 5))
        space = figure.add_subplot(projection="3d")
        for number, (_, line) in enumerate(shape.parts):
            space.plot(*(1e3 * line.T), color=BLACK, linewidth=3, label="arm" if number == 0 else None)
        space.scatter(
            *poses.nominal_mm.T, color=BLUE, s=9, label=f"{len(poses.nominal_mm)} positions", depthshade=False
        )
        beam = np.stack([tracker_mm, 1e3 * shape.tool])
        space.plot(*beam.T, color=VERMILION, linewidth=1, linestyle="--", label="laser beam")
        space.scatter(*tracker_mm, color=VERMILION, marker="s", s=60, label="tracker", depthshade=False)
        space.plot(*np.stack([tracker_mm * [1, 1, 0], tracker_mm]).T, color=GREY, linewidth=2)
        space.scatter(*(1e3 * shape.tool), color=ORANGE, marker="*", s=110, label="reflector", depthshade=False)
        space.set_xlabel("x (mm)", labelpad=8)
        space.set_ylabel("y (mm)", labelpad=8)
        space.set_zlabel("z (mm)", labelpad=4)
        space.locator_params(nbins=5)
        space.set_aspect("equal")
        space.view_init(elev=20, azim=-62)
        figure.legend(loc="outside upper center", ncols=5)
    return figure
