"""An MJCF stands where the arm stands, also where joints slide and axes lie anywhere."""

from __future__ import annotations

from dataclasses import replace

import mujoco
import numpy as np
import pinocchio as pin

from armscope.motion.mujoco_model import mujoco_model
from armscope.motion.pipeline import MotionDiagnosis
from armscope.robot.model import TIP
from tests.motion.test_export import found, simulated

assert found  # the fixture


def test_mujoco_has_the_chain_and_its_inverse_dynamics_where_axes_lie_anywhere(found: MotionDiagnosis) -> None:
    rng, chain = np.random.default_rng(8), pin.Model()
    axes = np.array([[0, 0, 1], [0.6, 0, 0.8], [0, -1, 0]])
    for n, joint in enumerate((pin.JointModelRZ(), pin.JointModelRevoluteUnaligned(axes[1]), pin.JointModelPY())):
        placement = pin.SE3(pin.exp3(rng.uniform(-1, 1, 3)), rng.uniform(-0.5, 0.5, 3))
        chain.addJoint(n, joint, placement, found.arm.joint_names[n])
    plain = found.arm.model
    tip = plain.frames[plain.getFrameId(TIP)]
    chain.addFrame(pin.Frame(tip.name, 3, 0, tip.placement, pin.FrameType.OP_FRAME))
    body = [pin.Inertia(2.0, rng.uniform(-0.1, 0.1, 3), np.diag([0.02, 0.03, 0.04])) for _ in range(3)]
    inertial = np.concatenate([each.toDynamicParameters() for each in body])
    model = replace(
        found.model, arm=replace(found.arm, model=chain), inertial=inertial, causes=(), joints=0 * found.model.joints
    )
    for n, each in enumerate(body, start=1):
        chain.inertias[n] = each
    q, dq, ddq = rng.uniform(-1, 1, (3, 10, 3))
    data = chain.createData()
    expected = [pin.rnea(chain, data, *row).copy() for row in zip(q, dq, ddq, strict=True)]
    made = mujoco.MjModel.from_xml_string(mujoco_model(model))
    np.testing.assert_allclose(simulated(made, q, dq, ddq), expected, atol=1e-7)


def test_an_arm_of_one_slide_is_one(found: MotionDiagnosis) -> None:
    """Seen on a public recording of a slide on a table: a single joint's columns come as a row."""
    model = found.arm.model
    one = pin.Model()
    one.addJoint(0, pin.JointModelPX(), pin.SE3.Identity(), "slide")
    tip = model.frames[model.getFrameId(TIP)]
    one.addFrame(pin.Frame(tip.name, 1, 0, tip.placement, pin.FrameType.OP_FRAME))
    inertial = pin.Inertia(3.0, np.zeros(3), np.eye(3)).toDynamicParameters()
    arm = replace(found.arm, model=one, inertial=inertial, actuation=np.eye(1))
    slide = replace(found.model, arm=arm, inertial=inertial, causes=(), joints=np.array([[0.0, 1.0, 2.0, 0.5]]))
    made = mujoco.MjModel.from_xml_string(mujoco_model(slide))
    assert made.jnt_type.tolist() == [mujoco.mjtJoint.mjJNT_SLIDE]
    np.testing.assert_allclose(made.jnt_axis[0], [1, 0, 0])
    assert (float(made.dof_damping[0]), float(made.dof_armature[0])) == (2.0, 0.5)
