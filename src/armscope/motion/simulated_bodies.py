"""A fitted model as a simulator can have it: bodies, friction and rotors that can be, and what has no place there."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pinocchio as pin

from armscope.core.types import Array
from armscope.motion.constants import EXPORT
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.model.fitted import MotionModel
from armscope.robot.dynamics import PARAMETERS, MovingArm


def stated_payloads(selected: SelectedCauses) -> tuple[float, ...]:
    """The payloads, kg, that samples of a selection state, each once, the lightest first; none: they state none."""
    of_samples = [each.signals.payload for each in selected.rows.samples]
    return tuple(np.unique(np.concatenate([each for each in of_samples if each is not None] or [np.zeros(0)])).tolist())


def bodies(model: MotionModel, payloads: Sequence[float] = ()) -> tuple[list[pin.Inertia], list[str]]:
    """Every link's mass, centre and inertia about its joint's frame, and what had to be changed for it to be a body.

    A combination of parameters that the motion does not tell may come out as no body has it: then the nearest body
    (by its pseudo-inertia's eigenvalues, Wensing, Kim & Slotine 2018) stands in for it. A payload that all samples
    state is part of the last link: what the model adds to it is only the difference.
    """
    throughout, notes = _throughout(payloads)
    made = []
    total = (model.followed().inertial + throughout * model.arm.point_load()).reshape(-1, len(PARAMETERS))
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


def _throughout(payloads: Sequence[float]) -> tuple[float, list[str]]:
    """The payload, kg, that goes into a file, and what to say of it, or of payloads that differ."""
    if not any(payloads):
        return 0.0, []
    *lighter, heaviest = payloads
    if lighter:
        told = f"payload_kg went from {lighter[0]:.4g} to {heaviest:.4g} kg: none of it is in this file"
        return 0.0, [f"{told}; add what is carried to the last link, as a point mass at the tool point"]
    told = f"the {heaviest:.4g} kg of payload_kg, stated in all samples, are in the last link, too"
    return heaviest, [f"{told}; leave that column out where this file is the arm"]


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
