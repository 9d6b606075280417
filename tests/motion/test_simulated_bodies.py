"""A simulator gets bodies, friction and rotors that can be; what had to be changed for it is said."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.motion.pipeline import MotionDiagnosis
from armscope.motion.simulated_bodies import as_comment, bodies, joint_numbers, not_in_a_file, stated_payloads
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


def test_a_payload_stated_throughout_is_in_the_last_link_and_payloads_that_differ_are_said(
    found: MotionDiagnosis,
) -> None:
    samples = found.selected.rows.samples
    two = [
        replace(each, signals=replace(each.signals, payload=np.full(len(each.signals.time), mass)))
        for each, mass in zip(samples, (2.0, 3.0), strict=False)
    ]
    assert stated_payloads(found.selected) == ()
    assert stated_payloads(replace(found.selected, rows=replace(found.selected.rows, samples=tuple(two)))) == (2.0, 3.0)
    (*_, without), silent = bodies(found.model)
    (*links, carrying), said = bodies(found.model, (2.0,))
    assert carrying.mass == pytest.approx(without.mass + 2.0)
    at = (carrying.mass * carrying.lever - without.mass * without.lever) / 2.0
    np.testing.assert_allclose(at, found.arm.point_load()[-9:-6], atol=1e-9)
    assert [each.mass for each in links] == [each.mass for each in bodies(found.model)[0][:-1]]
    assert not silent
    assert said == [
        "the 2 kg of payload_kg, stated in all samples, are in the last link, too; leave that column out where this "
        "file is the arm"
    ]
    (*_, changing), said = bodies(found.model, (0.0, 2.0))
    assert changing.mass == without.mass
    assert "payload_kg went from 0 to 2 kg: none of it is in this file; add what is carried" in said[0]
