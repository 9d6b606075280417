"""A simulator gets bodies, friction and rotors that can be; what had to be changed for it is said."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from armscope.motion.pipeline import MotionDiagnosis
from armscope.motion.simulated_bodies import as_comment, bodies, joint_numbers, not_in_a_file
from tests.motion.test_export import found

assert found  # the fixture


def test_a_comment_of_xml_has_no_two_dashes() -> None:
    assert "--" not in as_comment(["a--b", "c"])


def test_what_no_simulator_takes_is_mended_and_said(found: MotionDiagnosis) -> None:
    negative = found.model.joints.copy()
    negative[1, 3] = -0.2
    weightless = found.model.inertial.copy()
    weightless[10:20] = 0
    weightless[13] = 0.5
    odd = replace(found.model, joints=negative, inertial=weightless)
    numbers, notes = joint_numbers(odd)
    assert numbers[1, 2] == 0
    assert "joint 2: rotor inertia came out at -0.2" in notes[0]
    made, notes = bodies(odd)
    assert np.linalg.eigvalsh(made[1].inertia).min() > 0
    assert made[1].mass > 0
    assert any(note.startswith("link 2") for note in notes)
    assert not_in_a_file(replace(odd, gains=np.array([0, 0.1, 0]))) == ["gain of joint 2 +0.1"]
