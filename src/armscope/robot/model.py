"""An arm as a pinocchio model, from D-H rows or a URDF: the one place where an arm's geometry is interpreted."""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from armscope.robot.description import DHRow, LinkMass, RobotDescription
from armscope.robot.urdf import cut, frame_named, read_urdf, refuse_other_than_turning

TIP = "armscope_tip"


def pinocchio_model(description: RobotDescription, sliding: bool = False) -> pin.Model:
    """The arm's chain as a pinocchio model (m, kg): joints about z for D-H arms, as in the file for a URDF.

    Joint frame j has its origin in the D-H origin that lies on axis j: frame j-1 for `standard`, frame j for
    `modified` rows. The frame `TIP` is the last D-H frame, or the URDF's `tip`. Joints of a URDF may be ``sliding``
    where only torques are asked for.
    """
    if description.dh is not None:
        return _from_dh(description)
    return _from_urdf(description, sliding)


def dh_halves(row: DHRow, convention: str) -> tuple[pin.SE3, pin.SE3]:
    """The fixed transforms (before, behind) the joint's rotation: one D-H row is before * Rz(q) * behind.

    Standard rows (Denavit & Hartenberg 1955; Paul 1981): Rz(theta) Tz(d) Tx(a) Rx(alpha) Ry(beta). Modified rows
    (Craig 1986): Rx(alpha) Tx(a) Ry(beta) Rz(theta) Tz(d), with d before the joint, so that the joint's frame has
    the D-H origin. beta is 0 except in calibrated rows.
    """
    turn = pin.SE3(pin.utils.rotate("z", np.radians(row.theta_offset_deg)), np.zeros(3))
    along_z = pin.SE3(np.eye(3), np.array([0, 0, row.d_mm * 1e-3]))
    twist_x = pin.SE3(pin.utils.rotate("x", np.radians(row.alpha_deg)), np.array([row.a_mm * 1e-3, 0, 0]))
    twist_x = twist_x * pin.SE3(pin.utils.rotate("y", np.radians(row.beta_deg)), np.zeros(3))
    if convention == "standard":
        return pin.SE3.Identity(), turn * along_z * twist_x
    return twist_x * along_z, turn


def _from_dh(description: RobotDescription) -> pin.Model:
    assert description.dh is not None
    model = pin.Model()
    model.name = description.name
    joint, behind = 0, pin.SE3.Identity()
    for number, row in enumerate(description.dh.joints, start=1):
        before, after = dh_halves(row, description.dh.convention)
        joint = model.addJoint(joint, pin.JointModelRZ(), behind * before, f"joint {number}")
        behind = after
        if description.links is not None:
            link = description.links[number - 1]
            model.appendBodyToJoint(joint, _inertia(link), behind)
    model.addFrame(pin.Frame(TIP, joint, 0, behind, pin.FrameType.OP_FRAME))
    _append_tool_load(model, description)
    model.gravity.linear = np.array(description.gravity_m_s2)
    return model


def _from_urdf(description: RobotDescription, sliding: bool) -> pin.Model:
    assert description.urdf is not None
    full = read_urdf(description.urdf)
    locked, configuration, tip_name = cut(description, full)
    model = pin.buildReducedModel(full, locked, configuration)
    refuse_other_than_turning(description.urdf, model, sliding)
    tip = frame_named(model, tip_name)
    model.addFrame(pin.Frame(TIP, tip.parentJoint, 0, tip.placement, pin.FrameType.OP_FRAME))
    _append_tool_load(model, description)
    model.gravity.linear = np.array(description.gravity_m_s2)
    return model


def _append_tool_load(model: pin.Model, description: RobotDescription) -> None:
    if description.tool_load is not None:
        tip = model.frames[model.getFrameId(TIP)]
        model.appendBodyToJoint(tip.parentJoint, _inertia(description.tool_load), tip.placement)


def _inertia(body: LinkMass) -> pin.Inertia:
    """In the frame that the body is described in; a point where no inertia is stated, which is enough for statics."""
    about_centre = np.zeros((3, 3))
    if body.inertia_kg_m2 is not None:
        xx, yy, zz, xy, xz, yz = body.inertia_kg_m2
        about_centre = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    return pin.Inertia(body.mass_kg, np.array(body.com_mm) * 1e-3, about_centre)
