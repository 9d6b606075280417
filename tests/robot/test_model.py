"""The pinocchio model of a described arm, against a pendulum worked out by hand."""

import numpy as np
import pinocchio as pin
import pytest

from armscope.robot.description import RobotDescription
from armscope.robot.model import pinocchio_model

MASS, LEVER, ABOUT_CENTRE, GRAVITY = 3.0, 0.4, 0.05, 9.81


def pendulum(inertia):
    """Turns about the horizontal z axis; hangs along x where its angle is zero."""
    link = {"mass_kg": MASS, "com_mm": [LEVER * 1e3 - 500, 0, 0], "inertia_kg_m2": inertia}
    return RobotDescription.model_validate(
        {
            "name": "pendulum",
            "dh": {"joints": [{"a_mm": 500, "alpha_deg": 0, "d_mm": 0}]},
            "links": [link],
            "gravity_m_s2": [GRAVITY, 0, 0],
        }
    )


@pytest.mark.parametrize(("inertia", "about_centre"), [([0.01, 0.05, ABOUT_CENTRE, 0, 0, 0], ABOUT_CENTRE), (None, 0)])
def test_a_pendulum_needs_the_torque_of_the_textbook(inertia, about_centre):
    model = pinocchio_model(pendulum(inertia))
    angle, acceleration = 0.7, 2.0
    torque = pin.rnea(model, model.createData(), np.array([angle]), np.array([1.3]), np.array([acceleration]))
    expected = (about_centre + MASS * LEVER**2) * acceleration + MASS * GRAVITY * LEVER * np.sin(angle)
    assert torque[0] == pytest.approx(expected)


def test_a_turned_frame_turns_the_inertia_with_it():
    """The link's frame stands a quarter turn about x behind the joint: its y axis is the joint's z axis."""
    body = {"mass_kg": MASS, "com_mm": [0, 0, 0], "inertia_kg_m2": [0.02, 0.07, 0.06, 0, 0, 0]}
    arm = {"name": "turned", "dh": {"joints": [{"a_mm": 0, "alpha_deg": 90, "d_mm": 0}]}, "links": [body]}
    model = pinocchio_model(RobotDescription.model_validate(arm))
    assert pin.rnea(model, model.createData(), np.zeros(1), np.zeros(1), np.ones(1))[0] == pytest.approx(0.07)
