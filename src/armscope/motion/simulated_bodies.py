"""A fitted model as a simulator can have it: bodies, friction and rotors that can be, and what has no place there."""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from armscope.core.types import Array
from armscope.motion.constants import EXPORT
from armscope.motion.model.fitted import MotionModel
from armscope.robot.dynamics import PARAMETERS, MovingArm


def bodies(model: MotionModel) -> tuple[list[pin.Inertia], list[str]]:
    """Every link's mass, centre and inertia about its joint's frame, and what had to be changed for it to be a body.

    A combination of parameters that the motion does not tell may come out as no body has it: then the nearest body
    (by its pseudo-inertia's eigenvalues, Wensing, Kim & Slotine 2018) stands in for it.
    """
    made, notes = [], []
    total = model.followed().inertial.reshape(-1, len(PARAMETERS))
    for number, parameters in enumerate(total, start=1):
        pseudo = pin.PseudoInertia.FromDynamicParameters(parameters)
        values, vectors = np.linalg.eigh(pseudo.toMatrix())
        least = EXPORT.least_eigenvalue * max(float(values.max()), EXPORT.lightest_kg)
        if values.min() < least:
            mended = (vectors * np.maximum(values, least)) @ vectors.T
            parameters = pin.PseudoInertia.FromMatrix(mended).toDynamicParameters()
            notes.append(f"link {number}: no body has the fitted inertia; the nearest that a body has stands here")
        made.append(pin.Inertia.FromDynamicParameters(parameters))
    return made, notes


def one_to_one(arm: MovingArm) -> bool:
    """Whether each motor turns its own joint alone, as far as itself, either way: its friction is the joint's."""
    return np.array_equal(np.abs(arm.actuation), np.eye(arm.n_links))


def joint_numbers(model: MotionModel) -> tuple[Array, list[str]]:
    """(n, 3) dry friction, damping and armature of each joint, none of them negative, and what was left out.

    Where motors and joints are not one to one, friction belongs to motors and has no place at a joint: zeros.
    """
    if not one_to_one(model.arm):
        return np.zeros((model.arm.n_links, 3)), ["friction and rotors are those of motors, which turn several joints"]
    numbers, notes = model.joints[:, 1:4], []
    for joint, name in np.argwhere(numbers < 0):
        what = ("dry friction", "viscous friction", "rotor inertia")[name]
        notes.append(f"joint {joint + 1}: {what} came out at {numbers[joint, name]:.4g}; simulators take none below 0")
    return np.maximum(numbers, 0.0), notes


def not_in_a_file(model: MotionModel) -> list[str]:
    """Causes and numbers of the model for which a URDF has no place."""
    causes = [str(each.placed) for each in model.causes if not each.placed.cause.in_bodies or each.placed.runs]
    gains = [f"gain of joint {j + 1} {gain:+.3g}" for j, gain in enumerate(model.gains) if gain]
    return [*causes, *gains]


def as_comment(lines: list[str]) -> str:
    """Lines as the text of an XML comment."""
    return f" {'. '.join(lines)} ".replace("--", "- -")
