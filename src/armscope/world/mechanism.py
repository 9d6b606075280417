"""A robot arm as a MuJoCo mechanism: rigid bodies, hinges that stand somewhere, springs, bending segments.

This is the engine behind the concealed worlds. It shares no line with the kinematics or the loads that the diagnosis
uses: frames, Jacobians and generalised forces all come from MuJoCo. `armscope.world.mjcf` writes its model.
"""

from __future__ import annotations

from collections.abc import Iterator

import mujoco
import numpy as np

from armscope.core.types import Array
from armscope.world.layout import Geometry, Layout
from armscope.world.mjcf import mjcf


class Mechanism:
    """A compiled arm; `qpos` columns are addressed by the names of hinges and slides.

    Args:
        geometry: the nominal arm.
        layout: what else it is made of.
    """

    def __init__(self, geometry: Geometry, layout: Layout) -> None:
        self.geometry, self.layout = geometry, layout
        self.rows = geometry.rows + layout.row_errors
        self.model = mujoco.MjModel.from_xml_string(mjcf(geometry, layout, self.rows))
        self.data = mujoco.MjData(self.model)
        self.index = {self.model.joint(i).name: i for i in range(self.model.njnt)}
        self.tool_site = self.model.site("tool").id
        self._payload_body = self.model.body("payload").id

    @property
    def n_freedoms(self) -> int:
        """Number of hinges and slides."""
        return int(self.model.nq)

    def angle_columns(self) -> list[int]:
        """Columns of the chain's joint angles."""
        return [self.index[f"angle {j + 1}"] for j in range(self.geometry.n_joints)]

    def set_payload(self, mass: float) -> None:
        """Hang ``mass`` kg at the payload's place."""
        self.model.body_mass[self._payload_body] = mass
        mujoco.mj_setConst(self.model, self.data)

    def each_row(self, payload: Array) -> Iterator[int]:
        """Row numbers of (N,) payloads, kg, payload by payload: the mechanism carries each row's."""
        for mass in np.unique(payload):
            self.set_payload(float(mass))
            yield from np.flatnonzero(payload == mass).tolist()

    def set_joints(self, qpos: Array) -> None:
        """Frames at ``qpos``."""
        self.data.qpos[:] = qpos
        mujoco.mj_kinematics(self.model, self.data)

    def load(self, qpos: Array) -> tuple[Array, Array]:
        """Generalised forces (gravity, springs) at ``qpos``, N m and N, each positive along its freedom."""
        self.set_joints(qpos)
        mujoco.mj_comPos(self.model, self.data)
        mujoco.mj_tendon(self.model, self.data)
        mujoco.mj_fwdVelocity(self.model, self.data)
        return -self.data.qfrc_bias, self.data.qfrc_passive

    def tool(self) -> Array:
        """Tool point (3,) in the base frame, m, at the last `stand` or `load`."""
        return np.array(self.data.site_xpos[self.tool_site])

    def tool_turn(self) -> Array:
        """(3, 3) orientation of the tool in the base frame at the last `stand` or `load`."""
        return np.array(self.data.site_xmat[self.tool_site]).reshape(3, 3)

    def tool_jacobian(self) -> Array:
        """(3, n_freedoms) displacement of the tool point per unit of each freedom, at the last `load`."""
        jacobian = np.zeros((3, self.model.nv))
        mujoco.mj_jacSite(self.model, self.data, jacobian, None, self.tool_site)
        return jacobian
