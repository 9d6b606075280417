"""Recordings of a real arm with a simulated effect on the arm: what it does to the points and orientations.

The motion is the difference between the nominal arm with and without the effect, both simulated by the engine of the
virtual worlds (`armscope.world`) at the recorded joint angles, and turned into the measurement frame. Where joint
torques were recorded, they are what a compliant joint gives way under; elsewhere it is gravity's torque by the mass
table, in equilibrium.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from armscope.core.types import Array, Indices
from armscope.real.prepared_recordings import PreparedRecordings
from armscope.robot import chain
from armscope.world.judge import Judge
from armscope.world.kinds import Concealed, number
from armscope.world.spec import KINDS
from armscope.world.statics import Hidden, Session, balance
from armscope.world.strength import frame_columns, make_scene
from armscope.world.tolerances import geometric_errors

SPRING = KINDS["joint_compliance"]  # What gives way under the recorded torque where there is one


class SimulatedEffects:
    """The nominal arm simulated at the poses of prepared recordings, one scene per target."""

    def __init__(self, prepared: PreparedRecordings) -> None:
        self.prepared = prepared
        self.rows = [np.flatnonzero(prepared.target == k) for k in range(len(prepared.targets))]
        self.scenes, self.nominal = [], np.empty((len(prepared.table), 3))
        self.turns, self.straight = np.empty((2, len(prepared.table), 3, 3))
        session = _session(prepared)
        for rows, tool in zip(self.rows, prepared.tools, strict=True):
            x, y, z = (float(value) for value in tool * 1e3)
            description = prepared.arm.description.model_copy(update={"tool_mm": (x, y, z)})
            scene, points = make_scene(description, session.rows(rows))
            self.scenes.append(scene)
            self.nominal[rows], self.turns[rows] = points, scene.tool_turn
            true = balance(scene.geometry, scene.session, Hidden.nothing(scene.geometry, scene.session))
            self.straight[rows] = true.tool_turn

    def moved(self, effect: Concealed) -> Array:
        """(N, 3) displacement of the tool point by an effect, base axes, m."""
        return self.motion(effect)[0]

    def motion(self, effect: Concealed) -> tuple[Array, Array]:
        """(N, 3) displacement of the tool point by an effect, m, and (N, 3, 3) turn of the tool, base axes."""
        points, turns = np.empty_like(self.nominal), np.empty_like(self.straight)
        torque = self.prepared.recordings.torque
        for rows, scene in zip(self.rows, self.scenes, strict=True):
            hidden = Hidden.nothing(scene.geometry, scene.session)
            if effect.kind is SPRING and torque is not None:
                joint = number(effect.location)
                hidden.motor[:, joint] += effect.values["compliance"] * np.nan_to_num(torque[rows, joint])
            else:
                effect.hide(hidden, scene)
            stands = balance(scene.geometry, scene.session, hidden)
            points[rows], turns[rows] = stands.tool, stands.tool_turn
        return points - self.nominal, turns @ np.swapaxes(self.straight, 1, 2)

    def left(self, moved: Array) -> Array:
        """(N, 3) what base and tools, fitted to the training rows, leave of a displacement."""
        columns = self._frames
        train = np.concatenate([3 * self.prepared.train + axis for axis in range(3)])
        step = np.linalg.lstsq(columns[train], moved.ravel()[train], rcond=None)[0]
        return np.asarray(moved - (columns @ step).reshape(-1, 3))

    def beyond_geometry(self, left: Array, noise: float) -> float:
        """Squared size, in noise units, of what frames leave of a motion and an arm's geometry can't make either.

        Links are off by a millimetre and a milliradian (one sigma, as on the paper's virtual arms), and each is paid
        for: it is what the evidence for a motion gains where the geometry is only known so well.

        Args:
            left: (N, 3) what frames leave of it, m.
            noise: per axis, m.

        Returns:
            p^T (1 + G G^T)^-1 p over the training rows, p and G in units of the noise.
        """
        motion, geometry = left[self.prepared.train].ravel() / noise, self._geometry / noise
        overlap = geometry.T @ motion
        taken = overlap @ np.linalg.solve(np.eye(len(overlap)) + geometry.T @ geometry, overlap)
        return float(motion @ motion - taken)

    @cached_property
    def _geometry(self) -> Array:
        """(3 T, K) what frames leave, in the training rows, of geometric errors of one sigma each, m."""
        arm, train = self.prepared.arm, self.prepared.train
        moved = geometric_errors(arm).jacobian(chain(arm, self.prepared.recordings.motor_angles))
        return np.stack([self.left(moved[:, :, k])[train].ravel() for k in range(moved.shape[2])], axis=1)

    @cached_property
    def _frames(self) -> Array:
        columns = frame_columns(self.nominal, self.turns)
        tools = [
            np.where((self.prepared.target == k).repeat(3)[:, None], columns[:, 6:], 0) for k in range(len(self.rows))
        ]
        return np.concatenate([columns[:, :6], *tools], axis=1)

    def judge(self) -> Judge:
        """Compares an effect with all others at the training rows of the first target."""
        of_first = np.isin(self.rows[0], self.prepared.train)
        return Judge(self.scenes[0].rows(np.flatnonzero(of_first)), self.nominal[self.rows[0][of_first]])

    def first_training(self) -> Indices:
        """The rows that `judge` sees."""
        return self.rows[0][np.isin(self.rows[0], self.prepared.train)]


def _session(prepared: PreparedRecordings) -> Session:
    """The recorded rows as the engine takes them; time is the number of the configuration."""
    rows, count = prepared.recordings, len(prepared.recordings)
    assert rows.temperature is not None
    assert rows.approach is not None
    return Session(
        commanded=rows.motor_angles,
        payload=np.zeros(count) if rows.payload is None else np.nan_to_num(rows.payload),
        time=prepared.configuration.astype(float),
        temperature=rows.temperature,
        run=np.ones(count, dtype=np.int64),
        approach=rows.approach,
        speed=np.zeros_like(rows.motor_angles),
    )
