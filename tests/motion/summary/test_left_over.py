"""What lasts is told where most of a joint's torque is such, once at each joint."""

from __future__ import annotations

from dataclasses import dataclass, replace
from types import SimpleNamespace
from typing import cast

import numpy as np
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
    # what follows nothing says less than what repeats, or differs by runs
    alone = LastingTorque(0, "time", 0.1, 0.01, 0.4)
    monkeypatch.setattr(module, "wandering_torques", lambda selected: (replace(own, driver="time", rms=2.0), alone))
    assert module.left_over(cast(SelectedCauses, Nothing())) == (other, own, alone)


def test_its_shares_are_of_what_friction_leaves_of_all_joints_as_rows_count(monkeypatch: pytest.MonkeyPatch) -> None:
    weights = SimpleNamespace(sigma=np.array([1.0, 2.0]), correlated=np.ones(2), row=np.ones((10, 2)))
    monkeypatch.setattr(module, "left_by_friction", lambda selected: np.tile([1.0, 6.0], (10, 1)))
    selected = cast(SelectedCauses, SimpleNamespace(weights=weights))
    found = module.shares_left_over(selected, [LastingTorque(1, "angle", 3.0, 0.2, 0.25)])
    assert found == {1: pytest.approx((3 / 2) ** 2 / (1 + (6 / 2) ** 2))}
