"""How large an effect is at the tool: its RMS per axis once base and tool frames have been fitted, as in truth.yaml."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from armscope.core.averages import rms
from armscope.core.types import Array
from armscope.robot.description import RobotDescription
from armscope.world.kinds import Concealed, Scene
from armscope.world.layout import Geometry, Layout
from armscope.world.mechanism import Mechanism
from armscope.world.statics import Balance, Hidden, Session, balance


@dataclass(frozen=True)
class Frames:
    """Registration: measured = Rot(rotation) (p + tool turn @ tool error) + translation; m and rad."""

    translation: Array
    rotation: Array
    tool_error: Array

    def place(self, tool: Array, tool_turn: Array) -> Array:
        """(N, 3) where tool points (N, 3) of frames turned by (N, 3, 3) are measured."""
        moved = tool + tool_turn @ self.tool_error
        return np.asarray(moved @ Rotation.from_rotvec(self.rotation).as_matrix().T + self.translation)


def fit_frames(tool: Array, tool_turn: Array, measured: Array) -> Frames:
    """The frames that bring tool points (N, 3) closest to measured ones (N, 3), by Gauss-Newton from no error.

    Args:
        tool: (N, 3) m.
        tool_turn: (N, 3, 3) orientation of the tool.
        measured: (N, 3) m, in the measurement frame.

    Returns:
        Base frame and error of the tool point.
    """
    frames = Frames(np.zeros(3), np.zeros(3), np.zeros(3))
    for _ in range(4):
        placed = frames.place(tool, tool_turn)
        turn = Rotation.from_rotvec(frames.rotation).as_matrix()
        step = np.linalg.lstsq(frame_columns(placed, turn @ tool_turn), (measured - placed).ravel(), rcond=None)[0]
        rotation = (Rotation.from_rotvec(step[3:6]) * Rotation.from_rotvec(frames.rotation)).as_rotvec()
        # the step turns about the origin of the measurement frame, translation included
        translation = Rotation.from_rotvec(step[3:6]).apply(frames.translation) + step[:3]
        frames = Frames(translation, rotation, frames.tool_error + step[6:])
    return frames


def frame_columns(tool: Array, tool_turn: Array) -> Array:
    """(3 N, 9) displacement of tool points by base translation, base rotation about the origin, tool error."""
    count = len(tool)
    turning = np.zeros((count, 3, 3))
    for axis in range(3):
        turning[:, :, axis] = np.cross(np.eye(3)[axis], tool)
    return np.concatenate([np.tile(np.eye(3), (count, 1, 1)), turning, tool_turn], axis=2).reshape(3 * count, 9)


def free_frames(tool: Array, tool_turn: Array, run: NDArray[np.int64] | None = None) -> Array:
    """(3 N, 6 R + 3) what the frames can do that the contract leaves free: a base in each of R runs, one tool point.

    Args:
        tool: (N, 3) tool points, m.
        tool_turn: (N, 3, 3) orientation of the tool.
        run: (N,) run of each row, where the table says it; otherwise the whole table is one.

    Returns:
        Columns, m per m or rad.
    """
    columns = frame_columns(tool, tool_turn)
    base, point = columns[:, :6], columns[:, 6:]
    if run is None:
        return columns
    bases = [np.where((run == one).repeat(3)[:, None], base, 0.0) for one in np.unique(run)]
    return np.concatenate([*bases, point], axis=1)


def rms_after_frames(tool: Array, nominal: Array, tool_turn: Array) -> float:
    """RMS per axis that a model ``nominal`` (N, 3) misses of ``tool`` (N, 3) once its frames are fitted, m.

    Args:
        tool: (N, 3) true tool points, m.
        nominal: (N, 3) the model's, m.
        tool_turn: (N, 3, 3) orientation of the tool.

    Returns:
        RMS per axis, m.
    """
    return rms(fit_frames(nominal, tool_turn, tool).place(nominal, tool_turn) - tool)


def make_scene(description: RobotDescription, session: Session) -> tuple[Scene, Array]:
    """The nominal arm in a session, and its tool points (N, 3), m."""
    geometry = Geometry(description)
    mechanism = Mechanism(geometry, Layout(row_errors=np.zeros((geometry.n_joints, 4))))
    columns = mechanism.angle_columns()
    turns, tools = np.empty((len(session), 3, 3)), np.empty((len(session), 3))
    torque = np.empty((len(session), geometry.n_motors))
    angles = session.commanded @ geometry.actuation.T + geometry.rows[:, 3]
    for row in mechanism.each_row(session.payload):
        qpos = np.zeros(mechanism.n_freedoms)
        qpos[columns] = angles[row]
        gravity, _ = mechanism.load(qpos)
        torque[row] = geometry.actuation.T @ gravity[columns]
        tools[row], turns[row] = mechanism.tool(), mechanism.tool_turn()
    return Scene(description, geometry, session, torque, np.abs(torque).max(axis=0), turns), tools


def equilibrium(scene: Scene, effects: Iterable[Concealed]) -> Balance:
    """The arm with ``effects``, in equilibrium."""
    hidden = Hidden.nothing(scene.geometry, scene.session)
    for effect in effects:
        effect.hide(hidden, scene)
    return balance(scene.geometry, scene.session, hidden)


@dataclass(frozen=True, eq=False)
class Sized:
    """A concealed effect of known size."""

    effect: Concealed  # with its final numbers
    rms: float  # at the tool, m, alone and after the frames
    pattern: Array  # (N, 3) displacement of the tool by it, m
    minor: bool = False  # belongs to the background of a real arm, not to the story


def sized(
    scene: Scene, effect: Concealed, wanted: float, rounds: int = 2, largest_factor: float = np.inf
) -> Sized | None:
    """``effect`` scaled so that its RMS after the frames is ``wanted`` m; None if it can't be seen or would be absurd.

    Args:
        scene: rows over which the RMS is taken.
        effect: at some natural size.
        wanted: RMS per axis, m.
        rounds: linear scalings; each is followed by a simulation, so the RMS returned is that of the numbers returned.
        largest_factor: largest multiple of the natural size that is accepted.

    Returns:
        The effect at its new size, its RMS and its displacements (N, 3), m.
    """
    without = equilibrium(scene, []).tool
    tool = equilibrium(scene, [effect]).tool
    total = 1.0
    for _ in range(rounds):
        after = rms_after_frames(tool, without, scene.tool_turn)
        raw = rms(tool - without)
        if raw < 1e-9 or after < SEEN_SHARE * raw:
            return None
        factor = wanted / after
        total *= factor
        if total > largest_factor or raw * factor > LARGEST_RAW_M:
            return None
        effect = effect.scaled(factor)
        try:
            tool = equilibrium(scene, [effect]).tool
        except RuntimeError:  # springs too weak for the arm
            return None
    return Sized(effect, rms_after_frames(tool, without, scene.tool_turn), tool - without)


SEEN_SHARE = 0.08
"""An effect of which the frames leave less than this share of its RMS isn't concealed: nobody could find it."""
LARGEST_RAW_M = 0.02  # No effect moves the tool by more than this RMS


def carried(scene: Scene, effect: Concealed, carriers: list[Concealed], wanted: float) -> tuple[Sized, list[Sized]]:
    """A payload error and the compliances through which it shows, scaled so that its RMS is ``wanted`` m.

    The error keeps its natural size; what gives way under it is made weaker or stiffer.

    Args:
        scene: rows over which the RMS is taken.
        effect: the payload error.
        carriers: compliances at some natural size.
        wanted: RMS per axis, m.

    Returns:
        The error and its carriers, each with its RMS and displacements.
    """
    for _ in range(2):
        without, tool = equilibrium(scene, carriers).tool, equilibrium(scene, [*carriers, effect]).tool
        factor = wanted / rms_after_frames(tool, without, scene.tool_turn)
        carriers = [carrier.scaled(factor) for carrier in carriers]
    without, tool = equilibrium(scene, carriers).tool, equilibrium(scene, [*carriers, effect]).tool
    rigid = equilibrium(scene, []).tool
    alone = [equilibrium(scene, [carrier]).tool for carrier in carriers]
    sizes = [
        Sized(carrier, rms_after_frames(t, rigid, scene.tool_turn), t - rigid)
        for carrier, t in zip(carriers, alone, strict=True)
    ]
    return Sized(effect, rms_after_frames(tool, without, scene.tool_turn), tool - without), sizes
