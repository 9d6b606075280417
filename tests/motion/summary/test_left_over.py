"""What lasts is told where most of a joint's torque is such, once at each joint."""

from __future__ import annotations

from dataclasses import dataclass
from typing import cast

import pytest

from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.summary import left_over as module
from armscope.motion.summary.lasting import LastingTorque


@dataclass
class Nothing:
    """A selection that nobody looks into."""


def test_the_joint_most_of_whose_torque_lasts_comes_first(monkeypatch: pytest.MonkeyPatch) -> None:
    """8 % of joint 2's torque, read at joint 3, was 2 % at joint 2 in the headline and 18 % at joint 3 in a notice."""
    own, other = LastingTorque(1, "angle", 1.0, 0.02, 0.9), LastingTorque(2, "torque of joint 2", 0.8, 0.18, 0.5)
    again = LastingTorque(2, "run", 0.5, 0.11, 0.3)
    monkeypatch.setattr(module, "lasting_torques", lambda selected: (own, other))
    monkeypatch.setattr(module, "friction_by_run", lambda selected: ())
    monkeypatch.setattr(module, "differing_runs", lambda selected: (again,))
    assert module.left_over(cast(SelectedCauses, Nothing())) == (other, own)
