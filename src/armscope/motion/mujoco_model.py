"""A fitted model as an MJCF that MuJoCo simulates as it is: bodies, joints with friction, damping and armature."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Iterable, Sequence

import numpy as np
import pinocchio as pin

from armscope.motion.model.fitted import MotionModel
from armscope.motion.simulated_bodies import as_comment, bodies, joint_numbers, not_in_a_file
from armscope.robot.model import TIP

WRITTEN = "armscope: masses, inertias, dry friction, damping and rotors as fitted; no shapes, no contacts, no limits"


def mujoco_model(model: MotionModel, payloads: Sequence[float] = ()) -> str:
    """The arm as MJCF, in m, kg, N m, N m s/rad and kg m^2, each joint at its link's origin.

    Args:
        model: the fitted model.
        payloads: kg, that its samples state.

    Returns:
        The file's text; comments name what it has no place for.
    """
    made, notes = bodies(model, payloads)
    numbers, also = joint_numbers(model)
    left = not_in_a_file(model)
    told = [WRITTEN, *notes, *also, *([f"not in this file: {'; '.join(left)}"] if left else [])]
    arm, root = model.arm, ET.Element("mujoco", model=model.arm.name)
    root.append(ET.Comment(as_comment(told)))
    ET.SubElement(root, "compiler", angle="radian")
    # nothing may touch: where links are drawn is not known
    ET.SubElement(ET.SubElement(root, "option", gravity=_row(arm.model.gravity.linear)), "flag", contact="disable")
    parent = ET.SubElement(root, "worldbody")
    for n, name in enumerate(arm.joint_names):
        parent = ET.SubElement(parent, "body", {"name": f"link {n + 1}"} | _placed(arm.model.jointPlacements[n + 1]))
        dry, damping, armature = (_row([value]) for value in numbers[n])
        kind = "slide" if arm.model.joints[n + 1].shortname().startswith("JointModelP") else "hinge"
        axis = _axis(arm.model, n + 1)
        ET.SubElement(
            parent, "joint", name=name, type=kind, axis=axis, frictionloss=dry, damping=damping, armature=armature
        )
        _add_inertia(parent, made[n])
    tip = arm.model.frames[arm.model.getFrameId(TIP)].placement
    ET.SubElement(parent, "site", {"name": "tool"} | _placed(tip * pin.SE3(np.eye(3), _tool(model))))
    ET.indent(root)
    return ET.tostring(root, encoding="unicode") + "\n"


def _tool(model: MotionModel) -> np.ndarray:
    return np.array(model.arm.description.tool_mm) * 1e-3


def _axis(chain: pin.Model, joint: int) -> str:
    """The axis of a joint in its own frame: how its frame moves when it alone does."""
    data = chain.createData()
    columns = pin.computeJointJacobian(chain, data, pin.neutral(chain), joint).reshape(6, -1)  # one joint: (6,)
    moving = columns[:, chain.joints[joint].idx_v]
    return _row(moving[:3] if np.linalg.norm(moving[:3]) > np.linalg.norm(moving[3:]) else moving[3:])


def _placed(placement: pin.SE3) -> dict[str, str]:
    x, y, z, w = pin.Quaternion(placement.rotation).coeffs()
    return {"pos": _row(placement.translation), "quat": _row([w, x, y, z])}


def _add_inertia(body: ET.Element, inertia: pin.Inertia) -> None:
    about_centre = inertia.inertia
    six = [about_centre[at] for at in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))]
    ET.SubElement(body, "inertial", pos=_row(inertia.lever), mass=_row([inertia.mass]), fullinertia=_row(six))


def _row(numbers: Iterable[float]) -> str:
    return " ".join(f"{float(number) + 0.0:.12g}" for number in numbers)
